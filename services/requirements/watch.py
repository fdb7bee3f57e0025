"""A trace held against requirements: what is violated, unknown, or not decided when the trace ends."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.services.requirements.c2po import NotRead, Specification
from cratous.services.requirements.csv_trace import samples
from cratous.services.requirements.evaluation import FALSE, TRUE, Evaluation
from cratous.services.requirements.formula import horizon, signals
from cratous.spec.errors import BadInput


@dataclass
class Outcome:
    """One requirement over a trace. Samples are counted from 0; first_*: -1 where there is none.

    undecided: samples whose verdict needs more than the trace has.
    """

    name: str
    horizon: int
    holds: int = 0
    violated: int = 0
    unknown: int = 0
    undecided: int = 0
    first_violated: int = -1
    decided_at: int = -1
    first_unknown: int = -1

    @property
    def verdict(self) -> str:
        """violated, unknown, undecided, or holds: the last only where every sample is decided."""
        if self.violated:
            return "violated"
        if self.unknown:
            return "unknown"
        return "undecided" if self.undecided or not self.holds else "holds"

    def data(self) -> dict[str, Any]:
        """For `--json`."""
        return {"verdict": self.verdict, **vars(self)}

    def add(self, sample: int, verdict: int, now: int) -> None:
        """A verdict more, decided by the sample `now`."""
        if verdict == TRUE:
            self.holds += 1
        elif verdict == FALSE:
            self.violated += 1
            if self.first_violated < 0:
                self.first_violated, self.decided_at = sample, now
        else:
            self.unknown += 1
            self.first_unknown = sample if self.first_unknown < 0 else self.first_unknown


def watch(spec: Specification, trace: Path, verdicts: list[str] | None = None) -> list[Outcome]:
    """The outcome of each requirement over a CSV trace; one row is one time step.

    verdicts: takes a line `id:t,T`, `F` or `?` (unknown) for each verdict as it comes. A cell that is empty or
    no finite number is unknown. Raises BadInput for a requirement that is not read, a signal without a
    column, and a bool that is neither 0 nor 1.
    """
    watched: list[tuple[Outcome, Evaluation]] = []
    bools: set[str] = set()
    needed: set[str] = set()
    for one in spec.requirements:
        if isinstance(one.formula, NotRead):
            raise one.formula
        needed |= set(signals(one.formula))
        watched.append((Outcome(one.name, horizon(one.formula)), Evaluation(one.formula)))
    bools = {name for name in needed if spec.types[name] == "bool"}
    count = 0
    for time, (line, row) in enumerate(samples(trace)):
        missing = sorted(needed - set(row))
        if missing:
            raise BadInput("a signal has no column", where=str(trace), item=missing[0])
        for name in sorted(bools):
            if row[name] not in (0.0, 1.0, None):
                raise BadInput(
                    "this is no truth value", where=f"{trace}:{line}", item=name,
                    expected="0 or 1", got=str(row[name]),
                )  # fmt: skip
        for outcome, evaluation in watched:
            for sample, verdict in evaluation.sample(time, row):
                outcome.add(sample, verdict, time)
                if verdicts is not None:
                    verdicts.append(f"{outcome.name}:{sample},{'F?T'[verdict]}")
        count += 1
    for outcome, _ in watched:
        outcome.undecided = count - outcome.holds - outcome.violated - outcome.unknown
    return [outcome for outcome, _ in watched]
