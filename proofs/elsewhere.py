"""Solver answers from other machines: they indicate what is proved, and prove nothing here.

A worker proves a theorem of the same files and returns each answer of its solver. These answers are kept in a
separate folder and are used only where nothing is written and nothing is vouched for. A theorem that needs one of
them is *said to be proved elsewhere*; one that is not proved with them is decided here without them.
"""

from __future__ import annotations

import os
import re
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import astuple
from functools import partial
from pathlib import Path
from typing import Any

from cratous.core.ledger.package_home import Home
from cratous.proofs import ledger
from cratous.proofs.engine import prover, solver_memory, worker_processes
from cratous.proofs.engine.cache import Answer, Cache
from cratous.proofs.engine.theorem_files import home_folder
from cratous.proofs.phases import TimedCache
from cratous.spec.errors import BadInput

KEY = re.compile("[0-9a-f]{64}")
LOOK_S = 1.0
"""Seconds between two checks whether the parent process still exists."""


class Told(Cache):
    """A cache that records what was read from it and written to it: `answers`, by question and budget."""

    def __init__(self, folder: Path | None) -> None:
        super().__init__(folder)
        self.answers: dict[tuple[str, int], Answer] = {}

    def get(self, key: str, rlimit: int) -> Answer | None:
        """The stored answer, or None."""
        found = super().get(key, rlimit)
        if found is not None:
            self.answers[key, rlimit] = found
        return found

    def put(self, key: str, rlimit: int, answer: Answer) -> None:
        """Store an answer."""
        self.answers[key, rlimit] = answer
        super().put(key, rlimit, answer)


class Beside(TimedCache):
    """This machine's answers, supplemented by those of other machines; new answers go to this machine's cache.

    taken: the number of answers used from others. Their `unknown` is ignored: the question is asked here.
    """

    def __init__(self, own: Path | None, others: Path) -> None:
        super().__init__(own)
        self._others = Cache(others)
        self.taken = 0

    def get(self, key: str, rlimit: int) -> Answer | None:
        """The answer of this machine, else that of another."""
        found = super().get(key, rlimit)
        if found is None:
            found = self._others.get(key, rlimit)
            if found is not None and found.result == "unknown":
                return None
            self.taken += found is not None
        return found


def answered(name: str, home: Home, folder: Path | None) -> dict[str, Any]:
    """Prove a theorem for another machine: `proved`, and all `answers` on the way, as plain data.

    folder: this machine's own cache. Raises what stating the theorem raises.
    """
    solver_memory.keep()
    asked = partial(_answered, name, home_folder(home), folder, os.getpid())
    try:
        # a fresh process, so that the statement is the same as on the machine that asks
        return worker_processes.call(asked)
    except worker_processes.Ended:  # the process of a question was ended
        return {"proved": False, "answers": []}


def _answered(name: str, theorems: Path, folder: Path | None, parent: int) -> dict[str, Any]:
    threading.Thread(target=_end_with, args=(parent,), daemon=True).start()
    cache = Told(folder)
    theorem = prover.prove_file(name, folder=theorems, cache=cache)
    rows = [[*question, *astuple(answer)] for question, answer in cache.answers.items()]
    return {"proved": theorem.proved, "answers": rows}


def _end_with(parent: int) -> None:
    """End this process once its parent is gone, since nobody waits for the result."""
    while os.getppid() == parent:
        time.sleep(LOOK_S)
    os._exit(1)


def kept(result: Any, folder: Path, who: str) -> bool:
    """Store answers from another machine in `folder`; returns whether the theorem was proved there.

    Raises BadInput, naming `who`, if the result does not have the form that `answered` returns.
    """
    cache = Cache(folder)
    try:
        for key, rlimit, *rest in result["answers"]:
            answer = Answer(*rest)
            kinds = [type(value) for value in (key, rlimit, *rest)]
            if kinds != [str, int, str, int, float, str, str] or not KEY.fullmatch(key):
                raise ValueError(key)
            cache.put(key, rlimit, answer)
        return result["proved"] is True
    except (LookupError, TypeError, ValueError):
        raise BadInput(
            "these are no answers to what was asked", where=who, expected="answers of a solver",
            got=str(result)[:100],
        ) from None  # fmt: skip


def said_proved(
    names: Iterable[str], home: Home, cache: Beside, *, jobs: int, tell: Callable[[str], None]
) -> list[str]:
    """The theorems that are proved only with answers from other machines."""
    lean: set[str] = set()

    def hear(progress: ledger.Progress) -> None:
        tell(progress.name)
        if progress.theorem is not None and progress.theorem.proved and progress.written:
            lean.add(progress.name)

    ledger.prove_theorems(
        names, folder=home_folder(home), jobs=jobs, cache=cache, tell=hear,
        write=lambda *_: cache.taken,  # in the theorem's own process, where the answers were used
    )  # fmt: skip
    return sorted(lean)


def sources(home: Home) -> Iterator[Path]:
    """The files that a proof of this home depends on beside the product's own, in order."""
    from cratous.core.kernel.sources import ROOT

    yield from sorted((ROOT / "proofs").rglob("*.py"))
    if not home.product:
        yield from sorted(home.root.rglob("*.py"))
