"""Cached texts that are determined by the product's files alone.

The findings of the lint of decisions, for example, depend on the bytes of the files and on the versions only; where
all are the same, so is the text. CI begins with an empty folder.
"""

from __future__ import annotations

import functools
import hashlib
import json
import os
import platform
from collections.abc import Callable
from pathlib import Path

from cratous.core import ledger as gate
from cratous.core.kernel.sources import ROOT, digest, place
from cratous.core.ledger.package_home import Home

PARTS = ("spec", "core", "proofs", "services", "bridge")
INPUTS = (".py", ".lark")


def named(file: Path) -> str:
    """A file's path with the hash of its bytes."""
    return f"{place(file)}={hashlib.sha256(file.read_bytes()).hexdigest()}"


@functools.cache
def product(home: Home) -> str:
    """One hash over every file of the product, and of the home, that could affect a text."""
    files = {file for part in PARTS for file in (ROOT / part).rglob("*") if file.suffix in INPUTS}
    files.add(ROOT / "proofs" / "lint" / "decisions.json")
    if not home.product:
        files |= set(home.root.rglob("*.py"))
    versions = [gate.solver_version(), gate.compiler(), platform.python_version()]
    return digest([home.name, *(named(f) for f in sorted(files, key=place)), *versions])


class Remembered:
    """Cached texts in a folder; without a folder each is computed."""

    def __init__(self, folder: Path | None, home: Home) -> None:
        self.folder, self.home = folder, home

    def text(self, what: str, inputs: str, make: Callable[[], str]) -> str:
        """The result of `make`, taken from the cache where files and inputs are the same.

        what: names the text; inputs: what it depends on beside the files.
        """
        if self.folder is None:
            return make()
        key = digest([what, inputs, product(self.home)])
        file = self.folder / what
        try:
            data = json.loads(file.read_text(encoding="utf-8"))
            if data["key"] == key and isinstance(data["text"], str):
                return str(data["text"])
        except (OSError, ValueError, KeyError, TypeError):
            pass
        text = make()
        try:
            self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            part = file.with_name(f"{what}.{os.getpid()}")
            part.write_text(json.dumps({"key": key, "text": text}), encoding="utf-8")
            part.replace(file)
        except OSError:
            pass  # a folder that cannot be written is no error
        return text
