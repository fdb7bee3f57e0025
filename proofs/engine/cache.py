"""Solver answers from earlier runs, by the hash of the question.

A private folder below the product's cache (`CRATOUS_CACHE`), one small file for each question. The name holds the
structural hash of the question, the solver's version, the budget and the strategy; a file that is damaged, or is
about another question, counts as absent. Only answers without a model are kept: a counterexample is computed anew
each time. An answer cut short by a time limit is not kept either.
"""

from __future__ import annotations

import functools
import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path

from cratous.core.files.private_cache import private_cache
from cratous.core.kernel.sources import digest
from cratous.core.ledger.key_parts import solver_version
from cratous.core.ledger.keys import Keys

ASKING = (
    "proofs.engine.prover._ask",
    "proofs.engine.smtlib.question",
    "proofs.engine.obligation_hash.Hasher.key",
)
"""The functions that determine how a question is put to the solver and how its answer is read."""


@functools.cache
def _strategy() -> str:
    return Keys().asking(ASKING).digest


@dataclass(frozen=True)
class Answer:
    """Result (sat, unsat or unknown), effort in solver resources, CPU seconds, and the logic that answered.

    ended: which time limit ended the question, where that is why there is no answer.
    """

    result: str
    rlimit: int
    seconds: float
    logic: str
    ended: str = ""


class Cache:
    """Answers by question; without a folder nothing is kept."""

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self.hits = 0
        self._salt = (solver_version(), _strategy() if folder else "")

    def name(self, key: str, rlimit: int) -> str:
        """The file name of a question."""
        return digest([key, str(rlimit), *self._salt])

    def get(self, key: str, rlimit: int) -> Answer | None:
        """The stored answer, or None."""
        if self.folder is None:
            return None
        name = self.name(key, rlimit)
        try:
            data = json.loads((self.folder / name[:2] / name).read_text(encoding="utf-8"))
            if data.pop("question") != [key, rlimit, *self._salt]:
                return None
            answer = Answer(**data)
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            return None
        if answer.result not in ("sat", "unsat", "unknown") or answer.ended:
            return None
        self.hits += 1
        return answer

    def put(self, key: str, rlimit: int, answer: Answer) -> None:
        """Store an answer; a folder that cannot be written is no error.

        An answer cut short by a time limit is not stored: with more time there may be another.
        """
        if self.folder is None or answer.ended:
            return
        name = self.name(key, rlimit)
        file = self.folder / name[:2] / name
        data = {"question": [key, rlimit, *self._salt], **asdict(answer)}
        try:
            file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            part = file.with_name(f"{name}.{os.getpid()}")
            part.write_text(json.dumps(data), encoding="utf-8")
            part.replace(file)
        except OSError:
            return


def standard() -> Cache:
    """The cache of this user and machine."""
    return Cache(private_cache() / "proofs")
