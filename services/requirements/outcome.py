"""The result of one requirement over a trace, and how close its comparisons came to their bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from cratous.services.requirements.evaluation import FALSE, TRUE
from cratous.services.requirements.formula import Formula, Reaches, parts
from cratous.services.requirements.sampling import Sample
from cratous.services.requirements.specification import Requirement, Specification
from cratous.services.requirements.violating_parts import Part

SPARE = "so with too little to spare to exclude what lies between samples"
TOLD_BY = "as told by an unauthenticated source"


@dataclass
class Outcome:
    """One requirement over a trace. Instants: sample numbers, or times [ns]; -1 if there is none.

    undecided: samples whose verdict needs more than the trace has; decided_at: when the first
    violation became known; whole: the trace is not known to be incomplete; until: the last sample;
    lacks: why nothing holds, apart from a missing end; stops: how the log ends in that case;
    unauthenticated: some values came from unauthenticated sources; margins: one per comparison;
    blamed: the parts of the formula that cause the first violation.
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
    until: int = -1
    lacks: str = ""
    stops: str = "the flight was cut off"
    unauthenticated: bool = False
    margins: list[Margin] = field(default_factory=list)
    blamed: tuple[Part, ...] = ()

    @property
    def name(self) -> str:
        """The requirement's name."""
        return self.requirement.name

    @property
    def verdict(self) -> str:
        """violated, unknown, undecided, or holds: the last only if there is a sample and all are decided."""
        if self.violated:
            return "violated"
        if self.unknown or not self.whole or not (self.holds or self.undecided):
            return "unknown"
        return "undecided" if self.undecided else "holds"

    @property
    def so_far(self) -> str:
        """For an incomplete trace without violated or unknown samples: until when it was checked
        and what held, in words; otherwise empty.
        """
        if self.whole or self.violated or self.unknown or self.until < 0:
            return ""
        until = f"until {self.until / 1e9:g} s"
        undecided = ""
        if self.undecided or not self.holds:
            undecided = f"; {self.holds} samples hold and {self.undecided} are undecided"
        if self.lacks:
            return f"violated at no sample {until}, but {self.lacks}, so nothing holds{undecided}"
        why = f"{until}, where {self.stops}; what came after is unseen{undecided}"
        # past-time formulas are decided at each sample by what was flown
        at_each = not undecided and not self.horizon
        return f"held at each sample {why}" if at_each else f"holds so far, {why}"

    def add(self, sample: int, verdict: int, now: int) -> None:
        """Add a verdict, decided by the sample `now`."""
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
    """How close a comparison came to its bound: least and greatest left - right, where known.

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
        """Add the margin of one more sample."""
        left = row.get(self.left) if isinstance(self.left, str) else self.left
        right = row.get(self.right) if isinstance(self.right, str) else self.right
        if left is None or right is None or not math.isfinite(left - right):
            return
        if left - right < self.least:
            self.least, self.at = left - right, now
        if left - right > self.greatest:
            self.greatest, self.greatest_at = left - right, now


def margins_of(formula: Formula, spec: Specification) -> list[Margin]:
    """One per comparison of numbers, whichever side is written first."""
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
