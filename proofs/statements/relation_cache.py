"""What theorems relate, kept from one run to the next."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from cratous.core.kernel.sources import digest
from cratous.core.ledger.package_home import Home
from cratous.proofs.engine import worker_processes
from cratous.proofs.ledger.proof_recall import Recall
from cratous.proofs.ledger.text_cache import named
from cratous.proofs.statements import relations
from cratous.proofs.statements.relations import Relations


class Kept:
    """The relations of theorems, in a folder from one run to the next; without one they are read anew.

    They are kept as proved theorems are, under a hash of all that the statement depends on.
    """

    def __init__(self, folder: Path | None, home: Home) -> None:
        self.folder, self.home, self._recall = folder, home, Recall(None, home)

    def all(self, names: Iterable[str], jobs: int = 1) -> dict[str, Relations]:
        """The relations of these theorems, whose statements can be read; jobs: processes."""
        files = {name: self._file(name) for name in names}
        found = {name: _kept(file) for name, file in files.items()}
        rest = [name for name, one in found.items() if one is None]
        # with several at once, a few in each process: some take far longer than others
        count = min(8 * jobs, len(rest)) if jobs > 1 else min(1, len(rest))
        parts = [rest[k::count] for k in range(count)]
        tasks = [functools.partial(self._read, part) for part in parts]
        read = {n: one for _, some in worker_processes.each(tasks, jobs) for n, one in some.items()}
        for name, one in read.items():
            _keep(files[name], one)
        return {name: one or read[name] for name, one in found.items()}

    def _read(self, names: Iterable[str]) -> dict[str, Relations]:
        return {name: relations.relations(name, self.home.theorems) for name in names}

    def _file(self, name: str) -> Path | None:
        """Where the relations of a theorem are kept; None where nothing is."""
        known = self._recall.key(name) if self.folder is not None else None
        if self.folder is None or known is None:
            return None
        wanted = digest([known, *map(named, readers())])
        return self.folder / wanted[:2] / wanted


def readers() -> list[Path]:
    """The files that read statements: what is kept holds for them as they are."""
    return sorted(Path(relations.__file__).resolve().parent.glob("*.py"))


def _kept(file: Path | None) -> Relations | None:
    try:
        return None if file is None else _restored(json.loads(file.read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _keep(file: Path | None, found: Relations) -> None:
    if file is None:
        return
    said: dict[str, Any] = {part: sorted(getattr(found, part)) for part in PARTS}
    try:
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        part = file.with_name(f"{file.name}.{os.getpid()}")
        part.write_text(json.dumps({**said, "statement": found.statement}), encoding="utf-8")
        part.replace(file)
    except OSError:
        pass  # a folder that cannot be written is no error


PARTS = ("definitions", "together", "follows", "leads", "lemmas", "uses")


def _restored(data: dict[str, Any]) -> Relations:
    together, follows, leads = (
        frozenset((str(a), str(b)) for a, b in data[part]) for part in PARTS[1:4]
    )
    lemmas = tuple(map(str, data["lemmas"]))
    uses = frozenset((str(a), str(b), str(c), int(d)) for a, b, c, d in data["uses"])
    definitions, statement = frozenset(map(str, data["definitions"])), str(data["statement"])
    return Relations(definitions, together, follows, leads, lemmas, uses, statement)
