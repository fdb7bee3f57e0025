"""Evaluates a finished trace formula by formula over whole columns: the same verdicts as sample by
sample.

The loops are those of `core.requirements.whole_trace`, as machine code where the work is large
enough; otherwise the samples are processed one by one (`watch.Watch.sample`).
"""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from cratous.services.requirements.evaluation import FALSE, TRUE, in_order
from cratous.services.requirements.formula import (
    MAX_TIME,
    Always,
    Formula,
    Join,
    Not,
    Reaches,
    children,
    parts,
)
from cratous.services.requirements.sampling import Sample
from cratous.services.requirements.violating_parts import Part, why

if TYPE_CHECKING:
    import numpy as np

    from cratous.services.requirements.outcome import Margin, Outcome

MOST = 1_000_000
"""Maximum number of samples stored; also the maximum queue length when processed one by one."""
KEPT, WORTH = 100_000, 2_000_000
"""Operators times samples from which loops are compiled: with cached machine code, and without."""
NAN = float("nan")


class Columns:
    """Samples stored by column. times: of each; values: by signal, NaN if it has none."""

    def __init__(self, names: Iterable[str]) -> None:
        self.times = array("q")
        self.values = {name: array("d") for name in sorted(names)}
        self.last = -MAX_TIME - 1

    def add(self, time: int, row: Sample) -> None:
        """Add a sample. Raises BadInput for a time that is not later, as `Evaluation.sample` does."""
        self.last = in_order(time, self.last)
        self.times.append(time)
        for name, column in self.values.items():
            value = row.get(name)
            column.append(NAN if value is None else value)

    def samples(self) -> Iterable[tuple[int, Sample]]:
        """The samples one by one; missing values are NaN."""
        for k, time in enumerate(self.times):
            yield time, {name: column[k] for name, column in self.values.items()}


def is_worth(formulas: Iterable[Formula], samples: int) -> bool:
    """Whether machine code evaluates this number of samples faster than the interpreter."""
    work = sum(1 for formula in formulas for _ in parts(formula)) * samples
    if not KEPT < work <= WORTH:
        return work > WORTH
    from cratous.core.readings.machine.compiled import is_kept
    from cratous.core.requirements import whole_trace as loops

    used = (loops.reached, loops.not_of, loops.joined, loops.until_of, loops.since_of)
    return all(is_kept(loop) for loop in used)


class Whole:
    """Evaluates formulas over complete columns."""

    def __init__(self, columns: Columns) -> None:
        import numpy as np

        self.times = np.frombuffer(columns.times, np.int64)
        self.values = {n: np.frombuffer(c, np.float64) for n, c in columns.values.items()}
        self.count = len(self.times)
        self.at_once = np.arange(self.count)

    def fill(self, outcome: Outcome, formula: Formula) -> None:
        """Fill an empty outcome with a formula's verdict counts and margins."""
        found = self._parts(formula)
        verdict, known = found[id(formula)]  # in the form of `core.requirements.whole_trace`
        decided = known < self.count
        for name, word in (("holds", TRUE), ("violated", FALSE)):
            setattr(outcome, name, int(((verdict == word) & decided).sum()))
        outcome.unknown = int(((verdict == 1) & decided).sum())
        if outcome.violated:
            k = int(((verdict == FALSE) & decided).argmax())
            outcome.first_violated = int(self.times[k])
            outcome.decided_at = int(self.times[known[k]])
            outcome.blamed = tuple(self._why(formula, found, k, int(known[k])))
        if outcome.unknown:
            outcome.first_unknown = int(self.times[((verdict == 1) & decided).argmax()])
        for margin in outcome.margins:
            self._measure(margin)

    def _why(
        self, formula: Formula, found: Mapping[int, np.ndarray], k: int, at: int
    ) -> list[Part]:
        def verdict(part: Formula) -> int | None:
            word, known = found[id(part)][:, k]
            return int(word) if known <= at else None

        return why(formula, verdict)

    def _measure(self, margin: Margin) -> None:
        import numpy as np

        with np.errstate(invalid="ignore", over="ignore"):
            between = self._side(margin.left) - self._side(margin.right)
        known = np.isfinite(between)
        if not known.any():
            return
        low = int(np.where(known, between, np.inf).argmin())
        high = int(np.where(known, between, -np.inf).argmax())
        margin.least, margin.at = float(between[low]), int(self.times[low])
        margin.greatest, margin.greatest_at = float(between[high]), int(self.times[high])

    def _side(self, side: str | float) -> np.ndarray:
        import numpy as np

        return self.values[side] if isinstance(side, str) else np.array([side], np.float64)

    def _parts(self, formula: Formula) -> dict[int, np.ndarray]:
        found: dict[int, np.ndarray] = {}
        for part in parts(formula):
            found[id(part)] = self._found(part, [found[id(child)] for child in children(part)])
        return found

    def _found(self, part: Formula, below: list[np.ndarray]) -> np.ndarray:
        import numpy as np

        from cratous.core.readings.machine.compiled import machine
        from cratous.core.requirements import whole_trace as loops

        found = np.empty((2, self.count), np.int64)
        if isinstance(part, Join):
            machine(loops.joined)(*below, part.is_and, found)
            return found
        if isinstance(part, Always | Reaches | Not):
            found[1] = below[0][1] if isinstance(part, Not) else self.at_once
            if isinstance(part, Always):
                found[0] = part.verdict
            elif isinstance(part, Reaches):
                machine(loops.reached)(self._side(part.left), self._side(part.right), found[0])
            else:
                machine(loops.not_of)(below[0][0], found[0])
            return found
        loop = loops.since_of if part.past else loops.until_of
        machine(loop)(self.times, *below, part.low, part.high, found)
        return found
