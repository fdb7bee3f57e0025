"""The time that each part of a run of the prover takes."""

from __future__ import annotations

import multiprocessing
import time
from dataclasses import dataclass, field
from pathlib import Path

from cratous.proofs.engine.cache import Answer, Cache

THEOREMS = "stating theorems, solving and running them"
COMPILING = "compiling the readings"
COMPARING = "comparing the readings"
STATEMENTS = "reading what they relate"
GOALS = "what their goals decide"
SECOND = "cvc5"
REST = "the rest"


class TimedCache(Cache):
    """A solver cache that also sums the solver's time for new answers."""

    def __init__(self, folder: Path | None) -> None:
        super().__init__(folder)
        self._spent = multiprocessing.Value("d", 0.0)

    @property
    def seconds(self) -> float:
        """CPU seconds of the solver [s], in this process and in those forked from it."""
        return float(self._spent.value)

    def put(self, key: str, rlimit: int, answer: Answer) -> None:
        """Store an answer."""
        with self._spent.get_lock():
            self._spent.value += answer.seconds
        super().put(key, rlimit, answer)


@dataclass
class Phases:
    """Wall seconds of each part, in the order in which they ended."""

    seconds: dict[str, float] = field(default_factory=dict)
    since: float = field(default_factory=time.monotonic)

    def ended(self, part: str) -> None:
        """Add the time since the last call to this part."""
        now = time.monotonic()
        self.seconds[part] = self.seconds.get(part, 0.0) + now - self.since
        self.since = now

    def line(self, solver: float) -> str:
        """One line: the whole without the compiler, then each part; solver: z3's CPU seconds [s]."""
        whole = sum(self.seconds.values())
        apart = self.seconds.get(COMPILING, 0.0)
        parts = (f"{part} {taken:.1f} s" for part, taken in self.seconds.items())
        return (
            f"{whole - apart:.1f} s and {apart:.1f} s of compiling: {', '.join(parts)}; "
            f"z3 {solver:.1f} s of CPU"
        )
