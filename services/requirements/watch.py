"""Checks a trace against requirements: what is violated, unknown, or undecided when the trace ends.

Samples are numbered from 0 if the language counts them, otherwise they have times [ns].
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import chain, islice
from pathlib import Path

from cratous.services.requirements.applicability import with_asked
from cratous.services.requirements.arithmetic import Calculated, sources
from cratous.services.requirements.csv_trace import samples
from cratous.services.requirements.evaluation import FALSE, TRUE, Evaluation
from cratous.services.requirements.finished_trace import MOST, Columns, Whole, is_worth
from cratous.services.requirements.formula import horizon, signals
from cratous.services.requirements.outcome import Outcome, margins_of
from cratous.services.requirements.sampling import Finding, Row, Sample, Sampling
from cratous.services.requirements.specification import NotRead, Specification
from cratous.services.requirements.traces import doubts
from cratous.services.requirements.traces import rows as timed_rows
from cratous.spec.errors import BadInput


@dataclass(frozen=True)
class Watched:
    """The outcome of each requirement, and the faults of the samples."""

    outcomes: tuple[Outcome, ...]
    findings: tuple[Finding, ...]
    untested: tuple[str, ...] | None = None
    """Requirements `a implies b` for which a held at no sample; None: not determined."""


class Watch:
    """Evaluates the requirements of a specification on incoming rows.

    verdicts: receives a line `id:t,T`, `F` or `?` (unknown) for each verdict as it is decided.
    Raises BadInput for a requirement that is not read.
    """

    def __init__(self, spec: Specification, verdicts: list[str] | None = None) -> None:
        self.spec, self.verdicts = spec, verdicts
        self.count, self.last = 0, -1
        self.told = len(spec.requirements)
        """Number of requirements whose verdicts are listed."""
        self.needed: set[str] = set()
        names: set[str] = set()
        self._watched: list[tuple[Outcome, Evaluation]] = []
        self._reading: dict[str, list[int]] = {}
        """For each signal the numbers of the requirements that read it."""
        self._row: Sample = {}
        self.news: list[tuple[str, Outcome]] = []
        """First occurrences: requirements that became `violated` at a sample, or `unknown`; emptied
        by the reader.
        """
        for one in spec.requirements:
            judged = one.judged
            read = signals(judged)
            self.needed |= sources(read, spec.signals)
            names |= set(read)
            for name in read:
                self._reading.setdefault(name, []).append(len(self._watched))
            assert not isinstance(one.formula, NotRead)
            outcome = Outcome(one, horizon(judged), margins=margins_of(one.formula, spec))
            self._watched.append((outcome, Evaluation(judged, blames=True)))
        self.sampling = Sampling(spec, self.needed)
        self._names = self.needed | names
        self._calculated = Calculated(names, spec.signals)

    @property
    def outcomes(self) -> list[Outcome]:
        """The outcomes so far, in the order of the file."""
        return [outcome for outcome, _ in self._watched]

    def is_unauthenticated(self, outcome: Outcome) -> bool:
        """Whether it was evaluated on values from an unauthenticated source."""
        told, formula = self.sampling.unauthenticated, outcome.requirement.formula
        if not told or isinstance(formula, NotRead):
            return False
        return bool(told & sources(signals(formula), self.spec.signals))

    def rows(self, rows: Iterable[Row]) -> Iterator[int]:
        """Process rows with times; yields the time [ns] of each sample made."""
        for time, row in self.sampling.samples(rows):
            self._sample(time, self._calculated.row(row))
            yield time

    def sample(self, time: int, row: Sample) -> None:
        """Process one more sample of the recorded signals."""
        self._sample(time, self._calculated.row(row))

    def _sample(self, time: int, row: Sample) -> None:
        changed, self.last = self._changed(row), time
        for number, (outcome, evaluation) in enumerate(self._watched):
            same = number not in changed
            if not same:
                for margin in outcome.margins:
                    margin.add(row, time)
            for sample, verdict in evaluation.sample(time, row, same):
                if verdict == TRUE:
                    outcome.holds += 1
                else:
                    self._bad(outcome, sample, verdict, time)
                if self.verdicts is not None and number < self.told:
                    at = f"{sample / 1e9:.9g}" if self.spec.timed else str(sample)
                    self.verdicts.append(f"{outcome.name}:{at},{'F?T'[verdict]}")
            if outcome.violated and not outcome.blamed:
                outcome.blamed = evaluation.blamed
        self.count += 1

    def _changed(self, row: Sample) -> set[int]:
        """The numbers of the requirements with a signal that differs from the previous sample."""
        before, self._row = self._row, dict(row)
        if not before:
            return set(range(len(self._watched)))
        found: set[int] = set()
        for name, reading in self._reading.items():
            # NaN differs from itself
            if row.get(name) != before.get(name):
                found.update(reading)
        return found

    def _bad(self, outcome: Outcome, sample: int, verdict: int, time: int) -> None:
        outcome.add(sample, verdict, time)
        event = "violated" if verdict == FALSE else "unknown"
        if getattr(outcome, event) == 1:
            self.news.append((event, outcome))

    def all(self, samples: Iterable[tuple[int, Sample]]) -> None:
        """Process all samples of a finished trace, none of which was processed yet: by columns
        where that is faster (`finished_trace`), with the same outcome.
        """
        whole = ((time, self._calculated.row(row)) for time, row in samples)
        taken, kept = iter(whole), Columns(self._names)
        if self.verdicts is None:
            for time, row in islice(taken, MOST):
                kept.add(time, row)
        formulas = [evaluation.formula for _, evaluation in self._watched]
        if len(kept.times) < MOST and is_worth(formulas, len(kept.times)):
            columns = Whole(kept)
            for outcome, evaluation in self._watched:
                columns.fill(outcome, evaluation.formula)
            self.count, self.last = len(kept.times), kept.last if kept.times else -1
            return
        for time, row in chain(kept.samples(), taken):
            self._sample(time, row)

    def result(self) -> Watched:
        """The result if the trace ends here."""
        for outcome in self.outcomes:
            outcome.undecided = self.count - outcome.holds - outcome.violated - outcome.unknown
            outcome.whole = self.sampling.is_whole and self.sampling.has_begun
            outcome.until, outcome.lacks = self.last, self.sampling.lacks
            outcome.stops = self.sampling.stops
            outcome.unauthenticated = self.is_unauthenticated(outcome)
        findings = tuple(self.sampling.findings) if self.spec.timed else ()
        return Watched(tuple(self.outcomes), findings)


def watch(spec: Specification, trace: Path, verdicts: list[str] | None = None) -> Watched:
    """The outcome of each requirement over a trace: a CSV file, for a timed specification also a
    log.

    verdicts: as for `Watch`. An empty or non-finite cell is unknown. Raises BadInput for a
    requirement that is not read, a signal that the trace cannot have, and a bool that is neither 0
    nor 1.
    """
    watching = Watch(with_asked(spec), verdicts)
    watching.told = len(spec.requirements)
    if spec.timed:
        rows = timed_rows(trace, spec, watching.needed, watching.sampling.told_by)
        for doubt in doubts(trace):
            watching.sampling.find(doubt)
        watching.all(watching.sampling.samples(rows))
    else:
        watching.all(_counted(spec, trace, watching.needed))
    found = watching.result()
    own, asked = found.outcomes[: watching.told], found.outcomes[watching.told :]
    untested = tuple(one.name for one in asked if not one.holds)
    return replace(found, outcomes=own, untested=untested)


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
