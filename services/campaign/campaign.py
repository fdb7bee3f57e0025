"""Conducts a campaign: stored runs are not flown again, a lost attempt costs only itself."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from cratous.services.campaign.definition import Campaign
from cratous.services.campaign.engine import Attempt, Engine
from cratous.services.campaign.outcomes import Row, outcome_of, row_of
from cratous.services.campaign.runs import Ids, Run, runs_of
from cratous.services.campaign.store import Store
from cratous.spec.errors import Refused

Tell = Callable[[str], None]


@dataclass
class Course:
    """Progress of a campaign: all runs, stored before, flown now, attempts lost now."""

    total: int
    stored: int = 0
    flown: int = 0
    lost: int = 0
    outcomes: dict[str, int] = field(default_factory=dict)
    began: float = field(default_factory=time.monotonic)

    def count(self, outcome: str) -> None:
        """Count one more run with a known outcome."""
        self.outcomes[outcome] = self.outcomes.get(outcome, 0) + 1

    def line(self) -> str:
        """One line of text: progress, speed, and remaining time."""
        known = self.stored + self.flown
        spent = time.monotonic() - self.began
        parts = [f"{known} of {self.total} runs"]
        if self.flown and spent:
            each = spent / self.flown
            parts.append(f"{60 / each:.0f} a minute")
            parts.append(f"{duration(each * (self.total - known))} left")
        parts += [f"{count} {name}" for name, count in sorted(self.outcomes.items())]
        parts += [f"{self.lost} attempts lost"] * bool(self.lost)
        return ", ".join(parts)


def duration(seconds: float) -> str:
    """A remaining time in words."""
    minutes = round(seconds / 60)
    if minutes < 2:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 120 else f"{minutes / 60:.1f} h"


class Conduct:
    """One campaign with its store; `fly` flies missing runs, `rows` returns all results."""

    def __init__(
        self, campaign: Campaign, store: Store, function: str, version: str, allow_unproved: bool
    ) -> None:
        """function: `module:name` of the function that flies a run; version: digest of the flying code."""
        self._campaign, self._store = campaign, store
        self._function, self._version = function, version
        self._allow_unproved = allow_unproved
        self._ids: Ids = {}
        self._again: deque[Attempt] = deque()
        self._tries: dict[str, int] = {}

    def runs(self) -> Iterator[Run]:
        """All its runs, in order."""
        return runs_of(self._campaign, self._version, self._allow_unproved, self._ids)

    def task(self, run: Run, **more: Any) -> Attempt:
        """The task of a run, as a worker receives it."""
        limits = self._campaign.limits
        return {
            "id": run.id, "function": self._function, "version": self._version,
            "memory_mb": limits.memory_mb, "time_s": limits.time_s,
            "run": {**run.decides, "name": run.name, **more},
        }  # fmt: skip

    def fly(
        self, engine: Engine, course: Course, tell: Tell, runs: Iterable[Run] | None = None
    ) -> None:
        """Fly the runs that are not stored, of all runs or of some.

        Raises Refused if a worker refuses to fly, BadInput if a result cannot be stored.
        """
        missing = self._missing(course, self.runs() if runs is None else runs)

        def feed() -> Attempt | None:
            return self._again.popleft() if self._again else next(missing, None)

        for answer in engine(feed):
            if answer is not None:
                self._take(answer.task, answer.answer, answer.died, course)
            tell(course.line())

    def _missing(self, course: Course, runs: Iterable[Run]) -> Iterator[Attempt]:
        for run in runs:
            if run.id in self._tries:
                course.total -= 1  # the same run under two names
                continue
            result = self._store.result(run.id)
            if result is not None:
                course.stored += 1
                course.count(outcome_of(result, self._campaign.requirements))
                continue
            self._tries[run.id] = 0
            yield self.task(run)

    def _take(self, task: Attempt, answer: dict[str, Any], died: int, course: Course) -> None:
        """Store the result of an attempt, or schedule another attempt."""
        run = task["id"]
        lost = ["its worker died"] * died + ([answer["lost"]] if "lost" in answer else [])
        for why in lost:
            self._store.lose(run, why)
            course.lost += 1
        self._tries[run] += len(lost)
        if "result" in answer:
            result = answer["result"]
            if result["kind"] == "refused":
                raise Refused(result["why"][0])
            self._store.keep(run, result)
            course.flown += 1
            course.count(outcome_of(result, self._campaign.requirements))
        elif self._tries[run] < self._campaign.limits.attempts:
            self._again.append(task)
        else:
            course.count(outcome_of(None, ()))

    def rows(self, runs: Iterable[Run] | None = None) -> Iterator[Row]:
        """All runs, or some, with their results, in order; a run without a result is lost."""
        for run in self.runs() if runs is None else runs:
            yield row_of(run, self._store.result(run.id), self._campaign.requirements)
