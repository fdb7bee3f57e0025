"""The relations between kernels and definitions in theorems, cached between runs."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from cratous.core.kernel.sources import digest
from cratous.core.ledger.package_home import Home
from cratous.proofs.engine import worker_processes
from cratous.proofs.ledger.proof_recall import Recall
from cratous.proofs.ledger.text_cache import named
from cratous.proofs.statements import decided, relations
from cratous.proofs.statements.decided import Decided, Group
from cratous.proofs.statements.relations import Relations

One = TypeVar("One")


class Kept:
    """The relations of theorems, cached in a folder; without a folder they are read anew.

    They are kept like proved theorems, under a hash of all that the statement depends on.
    """

    def __init__(self, folder: Path | None, home: Home) -> None:
        self.folder, self.home, self._recall = folder, home, Recall(None, home)

    def all(self, names: Iterable[str], jobs: int = 1) -> dict[str, Relations]:
        """The relations of those theorems whose statements can be read; jobs: processes."""
        files = {name: self._file(name) for name in names}
        found = {name: _restored(data) for name, file in files.items() if (data := _kept(file))}
        read = _anew(self._read, [name for name in files if name not in found], jobs)
        for name, one in read.items():
            said: dict[str, Any] = {part: sorted(getattr(one, part)) for part in PARTS}
            _keep(files[name], {**said, "statement": one.statement})
        return {name: found.get(name) or read[name] for name in files}

    def decided(
        self, wanted: Mapping[str, list[Group]], jobs: int = 1
    ) -> dict[str, frozenset[Decided]]:
        """For each theorem, which of the wanted uses its goals decide; empty for one without a key."""
        asked = {
            name: [(meant, sorted((*u, how) for u, how in hows.items())) for meant, hows in groups]
            for name, groups in wanted.items()
        }
        files = {name: self._file(name, json.dumps(groups)) for name, groups in asked.items()}
        found = {
            name: frozenset((str(a), str(b), int(c)) for a, b, c in data["decided"])
            for name, file in files.items()
            if (data := _kept(file))
        }
        names = [name for name in files if name not in found]
        # each in a process of its own: the solver's results may depend on what was stated before
        keys = [
            self._recall.key(name) for name in names
        ]  # computed here, since all keys read the same files
        tasks = [
            functools.partial(decided.decided, name, self.home.theorems, key, wanted[name])
            for name, key in zip(names, keys, strict=True)
        ]
        for number, one in _each_that_ends(tasks, jobs):
            found[names[number]] = frozenset() if one is None else one
            if one is not None:
                _keep(files[names[number]], {"decided": sorted(one)})
        return found

    def _read(self, name: str) -> Relations:
        return relations.relations(name, self.home.theorems)

    def _file(self, name: str, asked: str = "") -> Path | None:
        """The cache file for a theorem's relations, or for another question (`asked`); None where nothing is cached."""
        known = self._recall.key(name) if self.folder is not None else None
        if self.folder is None or known is None:
            return None
        wanted = digest([known, asked, *map(named, readers())])
        return self.folder / wanted[:2] / wanted


def readers() -> list[Path]:
    """The files that read statements: cached entries are valid for their present content."""
    return sorted(Path(relations.__file__).resolve().parent.glob("*.py"))


def _anew(make: Callable[[str], One], names: list[str], jobs: int) -> dict[str, One]:
    """The result of `make` for each theorem; with several processes, in small batches: some take far longer."""
    count = min(8 * jobs, len(names)) if jobs > 1 else min(1, len(names))
    tasks = [functools.partial(_each, make, names[k::count]) for k in range(count)]
    return {n: one for _, some in worker_processes.each(tasks, jobs) for n, one in some.items()}


def _each_that_ends(
    tasks: Sequence[Callable[[], One]], jobs: int
) -> Iterator[tuple[int, One | None]]:
    """Number and result of each task; None for one whose process reached its CPU time limit."""
    left = set(range(len(tasks)))
    try:
        for number, one in worker_processes.each(tasks, jobs):
            left.remove(number)
            yield number, one
    except worker_processes.Ended:
        for number in sorted(left):  # which task it was is unknown
            try:
                yield number, worker_processes.call(tasks[number])
            except worker_processes.Ended as error:
                if not error.out_of_time:
                    raise
                yield number, None


def _each(make: Callable[[str], One], names: list[str]) -> dict[str, One]:
    return {name: make(name) for name in names}


def _kept(file: Path | None) -> dict[str, Any] | None:
    try:
        found = None if file is None else json.loads(file.read_text(encoding="utf-8"))
        return found if isinstance(found, dict) else None
    except (OSError, ValueError):
        return None


def _keep(file: Path | None, said: Mapping[str, Any]) -> None:
    if file is None:
        return
    try:
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        part = file.with_name(f"{file.name}.{os.getpid()}")
        part.write_text(json.dumps(said), encoding="utf-8")
        part.replace(file)
    except OSError:
        pass  # a folder that cannot be written is no error


PARTS = ("definitions", "together", "follows", "leads", "lemmas", "uses", "plain")


def _restored(data: dict[str, Any]) -> Relations:
    together, follows, leads = (
        frozenset((str(a), str(b)) for a, b in data[part]) for part in PARTS[1:4]
    )
    lemmas = tuple(map(str, data["lemmas"]))
    uses, plain = (
        frozenset((str(a), str(b), str(c), int(d)) for a, b, c, d in data[part])
        for part in PARTS[5:]
    )
    definitions, statement = frozenset(map(str, data["definitions"])), str(data["statement"])
    return Relations(definitions, together, follows, leads, lemmas, uses, plain, statement)
