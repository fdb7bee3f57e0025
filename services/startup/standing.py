"""The ledger's gate for processes that have to be up quickly: what was found clean is not sought again.

`core.ledger.require` computes every part of every kernel's key anew, which takes seconds. All of them
follow from the files of core, spec and proofs, from the versions of solver and compiler, and from how
the kernels are registered; where the digest of just these was found clean before, it is clean again.
Whether the code that runs is that of its files is asked every time. Only a clean standing is kept, in
the product's private cache; anything else goes through the whole gate, which names what is wrong.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import sys
from pathlib import Path

from cratous.core import ledger
from cratous.core.files.private_cache import private_cache
from cratous.core.kernel import REGISTRY, Entry
from cratous.core.kernel.sources import ROOT, altered, position
from cratous.core.ledger import Standing

FOLDERS = ("core", "spec", "proofs")
"""Where everything lies that a key is made of."""


def require(*, allow_unproved: bool = False) -> Standing:
    """As `core.ledger.require`: the standing, or Refused; a clean one is remembered."""
    entries = ledger.load_all()
    ours_alone = len(entries) == len(REGISTRY)
    if not ours_alone:
        return ledger.require(allow_unproved=allow_unproved)
    file = private_cache() / "standing" / f"{_digest(entries)}.json"
    known = _read(file)
    if known is not None and not any(altered(entry.function) for entry in entries.values()):
        return known
    found = ledger.require(allow_unproved=allow_unproved)
    if not found.problems:
        _write(file, found)
    return found


def _digest(entries: dict[str, Entry]) -> str:
    """One SHA-256 over all that the gate reads; files by name and content."""
    sha = hashlib.sha256()

    def add(data: bytes) -> None:
        sha.update(str(len(data)).encode() + b":" + data)

    tools = (sys.version, str(sys.flags.optimize), ledger.solver_version(), ledger.compiler())
    for text in tools:
        add(text.encode())
    for name, entry in entries.items():
        add(repr((name, entry.kind, entry.implements, entry.supports, entry.uses)).encode())
        add(position(entry.function).encode())
    files = [file for folder in FOLDERS for file in sorted((ROOT / folder).rglob("*.py"))]
    for file in (*files, ledger.LEDGER):
        add(file.relative_to(ROOT).as_posix().encode())
        add(file.read_bytes() if file.is_file() else b"missing")
    return sha.hexdigest()


def _read(file: Path) -> Standing | None:
    with contextlib.suppress(OSError, ValueError, KeyError, TypeError):
        data = json.loads(file.read_text(encoding="utf-8"))
        kernels, theorems, assumed = (data[n] for n in ("kernels", "theorems", "assumptions"))
        if all(type(number) is int for number in (kernels, theorems, assumed)):
            return Standing(kernels, theorems, assumed, ())
    return None


def _write(file: Path, found: Standing) -> None:
    """A cache that cannot be written costs time, nothing else."""
    data = {
        "kernels": found.kernels,
        "theorems": found.theorems,
        "assumptions": found.assumptions,
    }
    with contextlib.suppress(OSError):
        file.parent.mkdir(mode=0o700, exist_ok=True)
        part = file.with_suffix(f".{os.getpid()}")
        part.write_text(json.dumps(data), encoding="utf-8")
        part.replace(file)
