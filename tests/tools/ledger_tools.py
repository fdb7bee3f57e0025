"""A copy of the product with its ledger, for tests that change it; the gate and the prover on it."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

PARTS = ("spec", "core", "proofs", "bridge", "services")
CHECK = """
import sys
from cratous.core import ledger
try:
    print(ledger.require().line)
except Exception as error:
    print(type(error).__name__, error)
    sys.exit(1)
"""
RESEAL = """
from cratous.core import ledger
from cratous.core.ledger import records
folder = ledger.PRODUCT.records
data, keys = ledger.read(folder), ledger.Keys()
{edit}
for name, entry in ledger.load_all().items():
    record = data["kernels"][name]
    record["key"] = keys.of(entry, record["theorems"], data["theorems"])
for kind in records.KINDS:
    data[kind] = {{name: records.sealed(name, record) for name, record in data[kind].items()}}
records.write(records.texts(data), folder)
"""


def copied(root: Path, home: Path) -> Path:
    """A copy of the product as it would be installed, with its ledger.

    Byte code comes along: it serves each file until that is changed, and is not written anew.
    """
    for part in PARTS:
        # what another process is writing just now has a number at its end
        half_written = shutil.ignore_patterns("*.pyc.*")
        shutil.copytree(root / part, home / "cratous" / part, ignore=half_written)
    for name in ("__init__.py", "__main__.py"):
        shutil.copy(root / "src" / "cratous" / name, home / "cratous")
    return home


def prove(home: Path, *options: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "cratous", "prove", *options],
        cwd=home,
        env={**os.environ, "PYTHONPATH": str(home), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=600,
    )


def check(home: Path, first: str = "") -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(home), "PYTHONDONTWRITEBYTECODE": "1"}
    # from another folder and without the checkout's editable install on the path
    code = f"import sys; sys.path.insert(0, {str(home)!r})\n" + first + CHECK
    return subprocess.run(
        [sys.executable, "-c", code],
        cwd=home,
        env=environment,
        capture_output=True,
        text=True,
        timeout=900,
    )


@contextlib.contextmanager
def restored(*files: Path) -> Iterator[None]:
    """Whatever is done to the files: afterwards they are as they were."""
    before = {file: file.read_text() for file in files}
    try:
        yield
    finally:
        for file, text in before.items():
            file.write_text(text)
