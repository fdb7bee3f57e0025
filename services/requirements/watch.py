"""A trace held against requirements: what is violated, unknown, or not decided when the trace ends.

Samples are numbered from 0 where the language counts them, and bear times where it has times [ns].
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from cratous.services.requirements.csv_trace import samples
from cratous.services.requirements.evaluation import FALSE, TRUE, Evaluation
from cratous.services.requirements.formula import Formula, Reaches, horizon, parts, signals
from cratous.services.requirements.sampling import Finding, Row, Sample, Sampling
from cratous.services.requirements.specification import NotRead, Requirement, Specification
from cratous.services.requirements.to_blame import Part
from cratous.services.requirements.traces import doubts
from cratous.services.requirements.traces import rows as timed_rows
from cratous.spec.errors import BadInput


@dataclass
class Outcome:
    """One requirement over a trace. Instants: numbers of samples, or times [ns]; -1 where there is none.

    undecided: samples whose verdict needs more than the trace has; decided_at: when the first violation was
    known; whole: nothing of the trace is known to be missing; margins: of each comparison; blamed: the parts of the
    formula that are to blame for the first violation.
    """

    requirement: Requirement
    horizon: int
    holds: int = 0
    violated: int = 0
    unknown: int = 0
    undecided: int = 0
    first_violated: int = -1
    decided_at: int = -1
    first_unknown: int = -1
    whole: bool = True
    margins: list[Margin] = field(default_factory=list)
    blamed: tuple[Part, ...] = ()

    @property
    def name(self) -> str:
        """The requirement's name."""
        return self.requirement.name

    @property
    def verdict(self) -> str:
        """violated, unknown, undecided, or holds: the last only where every sample is decided."""
        if self.violated:
            return "violated"
        if self.unknown or not self.whole:
            return "unknown"
        return "undecided" if self.undecided or not self.holds else "holds"

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


@dataclass
class Margin:
    """How near a comparison came to its bound: least and greatest left - right, where it was known.

    unit: of both sides; at, greatest_at: instants.
    """

    left: str | float
    right: str | float
    unit: str
    least: float = math.inf
    at: int = -1
    greatest: float = -math.inf
    greatest_at: int = -1

    def add(self, row: Sample, now: int) -> None:
        """A sample more."""
        left = row.get(self.left) if isinstance(self.left, str) else self.left
        right = row.get(self.right) if isinstance(self.right, str) else self.right
        if left is None or right is None or not math.isfinite(left - right):
            return
        if left - right < self.least:
            self.least, self.at = left - right, now
        if left - right > self.greatest:
            self.greatest, self.greatest_at = left - right, now


@dataclass(frozen=True)
class Watched:
    """The outcome of each requirement, and what is wrong with the samples."""

    outcomes: tuple[Outcome, ...]
    findings: tuple[Finding, ...]


class Watch:
    """Requirements of a specification over rows as they come.

    verdicts: takes a line `id:t,T`, `F` or `?` (unknown) for each verdict as it is decided. Raises BadInput
    for a requirement that is not read.
    """

    def __init__(self, spec: Specification, verdicts: list[str] | None = None) -> None:
        self.spec, self.verdicts = spec, verdicts
        self.count = 0
        self.needed: set[str] = set()
        self._watched: list[tuple[Outcome, Evaluation]] = []
        for one in spec.requirements:
            if isinstance(one.formula, NotRead):
                raise one.formula
            self.needed |= set(signals(one.formula))
            outcome = Outcome(one, horizon(one.formula), margins=_margins(one.formula, spec))
            self._watched.append((outcome, Evaluation(one.formula, blames=True)))
        self.sampling = Sampling(spec, self.needed)

    @property
    def outcomes(self) -> list[Outcome]:
        """The outcomes so far, in the order of the file."""
        return [outcome for outcome, _ in self._watched]

    def rows(self, rows: Iterable[Row]) -> Iterator[int]:
        """Take rows with times; the time [ns] of each sample that is taken."""
        for time, row in self.sampling.samples(rows):
            self.sample(time, row)
            yield time

    def sample(self, time: int, row: Sample) -> None:
        """Take one sample more."""
        for outcome, evaluation in self._watched:
            for margin in outcome.margins:
                margin.add(row, time)
            for sample, verdict in evaluation.sample(time, row):
                outcome.add(sample, verdict, time)
                if self.verdicts is not None:
                    at = f"{sample / 1e9:.9g}" if self.spec.timed else str(sample)
                    self.verdicts.append(f"{outcome.name}:{at},{'F?T'[verdict]}")
            outcome.blamed = outcome.blamed or evaluation.blamed
        self.count += 1

    def result(self) -> Watched:
        """What can be said where the trace ends here."""
        for outcome in self.outcomes:
            outcome.undecided = self.count - outcome.holds - outcome.violated - outcome.unknown
            outcome.whole = self.sampling.is_whole
        findings = tuple(self.sampling.findings) if self.spec.timed else ()
        return Watched(tuple(self.outcomes), findings)


def watch(spec: Specification, trace: Path, verdicts: list[str] | None = None) -> Watched:
    """The outcome of each requirement over a trace: a CSV file, for a timed specification also a log.

    verdicts: as for `Watch`. A cell that is empty or no finite number is unknown. Raises BadInput for a
    requirement that is not read, a signal that the trace cannot have, and a bool that is neither 0 nor 1.
    """
    watching = Watch(spec, verdicts)
    if spec.timed:
        rows = timed_rows(trace, spec, watching.needed)
        for doubt in doubts(trace):
            watching.sampling.find(doubt)
        for _ in watching.rows(rows):
            pass
    else:
        for time, row in _counted(spec, trace, watching.needed):
            watching.sample(time, row)
    return watching.result()


def _margins(formula: Formula, spec: Specification) -> list[Margin]:
    """One for each comparison of numbers, whichever side is written first."""
    found: dict[frozenset[str | float], Margin] = {}
    for part in parts(formula):
        if isinstance(part, Reaches):
            named = [s for s in (part.left, part.right) if isinstance(s, str)]
            if spec.signals[named[0]].kind != "bool":
                left, right = part.left, part.right
                if not isinstance(left, str):
                    left, right = right, left
                unit = spec.signals[named[0]].unit
                found.setdefault(frozenset((left, right)), Margin(left, right, unit))
    return list(found.values())


def _counted(spec: Specification, trace: Path, needed: set[str]) -> Iterator[tuple[int, Sample]]:
    """The samples of a CSV trace; one row is one time step."""
    bools = sorted(name for name in needed if spec.types[name] == "bool")
    for time, (line, row) in enumerate(samples(trace)):
        missing = sorted(needed - set(row))
        if missing:
            raise BadInput("a signal has no column", where=str(trace), item=missing[0])
        for name in bools:
            if row[name] not in (0.0, 1.0, None):
                raise BadInput(
                    "this is no truth value", where=f"{trace}:{line}", item=name,
                    expected="0 or 1", got=str(row[name]),
                )  # fmt: skip
        yield time, row
