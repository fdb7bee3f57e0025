"""The ledger's gate: whatever could change a kernel's meaning is caught, with its name."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cratous.core import ledger

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


@pytest.fixture(scope="module")
def product(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the product as it would be installed."""
    home = tmp_path_factory.mktemp("product")
    for part in PARTS:
        shutil.copytree(
            root / part, home / "cratous" / part, ignore=shutil.ignore_patterns("__pycache__")
        )
    shutil.copy(root / "src" / "cratous" / "__init__.py", home / "cratous")
    return home


def _check(home: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(home), "PYTHONDONTWRITEBYTECODE": "1"}
    # from another folder and without the checkout's editable install on the path
    code = f"import sys; sys.path.insert(0, {str(home)!r})\n" + CHECK
    return subprocess.run(
        [sys.executable, "-c", code],
        cwd=home,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )


def test_the_committed_ledger_vouches_for_the_committed_code():
    standing = ledger.check()
    assert [f"{p.name}: {p.what}" for p in standing.problems] == []
    assert standing.theorems >= 30
    assert standing.assumptions == 0


ATTACKS = {
    "a callee's source": (
        "core/well_clear.py",
        "if ss <= dd:",
        "if ss < dd:",
        "horizontal_violation: changed since the proof: its source",
    ),
    "a constant": ("core/gate.py", "return Gate(1, gate.epoch + 1, False)",
                   "return Gate(1, gate.epoch + 0, False)", "gate_takeover: changed"),
    "a definition": ("spec/well_clear.py", "return dot(s, v) < 0", "return dot(s, v) <= 0",
                     "its definition in spec"),
    "a theorem weakened to true": (
        "proofs/theorems/violation_is_symmetric.py", "c.show(c.same(ours, theirs))",
        "c.show(c.same(ours, ours))", "violation: changed since the proof: its theorems"),
    "a theorem's sentence": (
        "proofs/theorems/violation_is_symmetric.py", "Well clear is symmetric", "All is well",
        "its theorems"),
    "the prover": ("proofs/prover.py", '"unsat": "proved"', '"sat": "proved"', "the prover"),
    "the compiler's flags": ("core/compiled.py", "fastmath=False", "fastmath=True",
                             "the compiler flags"),
    "a fold's start": ("core/timing.py", "start=True", "start=False",
                       "schedule_holds: changed since the proof: its source"),
    "a driver": ("core/legs.py", "if zone.padding_m != 0:", "if zone.padding_m < 0:", "leg_ok: changed"),
    "the ledger file": ("core/ledger.json", '"status": "proved"', '"status": "Proved"',
                        "was edited"),
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(ATTACKS))
def test_attack_is_caught(name: str, product: Path) -> None:
    place, old, new, wanted = ATTACKS[name]
    file = product / "cratous" / place
    original = file.read_text()
    assert old in original, f"{old!r} is not in {place}: this attack needs an update"
    file.write_text(original.replace(old, new))
    try:
        done = _check(product)
    finally:
        file.write_text(original)
    assert done.returncode == 1, done.stdout + done.stderr
    assert "Refused" in done.stdout
    assert wanted in done.stdout


def test_comments_and_layout_change_nothing(product: Path) -> None:
    file = product / "cratous" / "core" / "well_clear.py"
    original = file.read_text()
    file.write_text(original.replace("    if ss <= dd:", "    # a remark\n    if  ss<=dd :"))
    try:
        done = _check(product)
    finally:
        file.write_text(original)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_kernel_without_a_proof_is_refused(product: Path) -> None:
    file = product / "cratous" / "core" / "unproved.py"
    file.write_text(
        '"""One more kernel."""\n\nfrom cratous.core.kernel import kernel\n\n\n'
        '@kernel(implements="schedule.later_of")\ndef unproved(a: int, b: int) -> int:\n'
        '    """A sum."""\n    return a + b\n'
    )
    try:
        done = _check(product)
    finally:
        file.unlink()
    assert done.returncode == 1
    assert "unproved: it is not in the ledger" in done.stdout


def test_no_ledger_no_flight(tmp_path: Path) -> None:
    standing = ledger.check(tmp_path / "none.json")
    assert len(standing.problems) == standing.kernels


def test_a_broken_ledger_is_an_error_not_a_crash(tmp_path: Path) -> None:
    file = tmp_path / "ledger.json"
    file.write_text(json.dumps({"kernels": {}}))
    with pytest.raises(ledger.Refused, match="cannot be read"):
        ledger.read(file)
