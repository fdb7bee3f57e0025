"""The results of a mutation run, with counts."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from cratous.proofs.mutation.results import VERDICTS, PremiseResult, Result

ENOUGH = Fraction(98, 100)
"""The least share of the viable mutants that must be killed."""


@dataclass(frozen=True)
class MutationReport:
    """All results, in the order of targets and source; premises of the theorems that were used.

    judged: the theorems whose premises were judged, including those that have none.
    """

    results: tuple[Result, ...]
    premises: tuple[PremiseResult, ...]
    judged: tuple[str, ...] = ()

    def count(self, verdict: str, kind: str = "") -> int:
        """The number of mutants with this verdict, of one kind (kernel, definition or fold) or of all."""
        return sum(r.verdict == verdict and kind in ("", r.kind) for r in self.results)

    def of(self, verdict: str) -> tuple[Result, ...]:
        """The mutants with this verdict."""
        return tuple(r for r in self.results if r.verdict == verdict)

    @property
    def viable(self) -> int:
        """Mutants that can be run and are not proved equivalent."""
        return sum(self.count(v) for v in ("killed", "survived", "undecided"))

    @property
    def score(self) -> Fraction:
        """The share killed among the viable ones; 1 where there are none."""
        return Fraction(self.count("killed"), self.viable) if self.viable else Fraction(1)

    @property
    def line(self) -> str:
        """One line for the terminal."""
        if not self.results:
            return "no mutant was judged"
        counts = ", ".join(f"{self.count(v)} {v}" for v in VERDICTS)
        return f"{len(self.results)} mutants: {counts}; {percent(self.score)} killed"

    @property
    def holds(self) -> bool:
        """True iff no kernel or fold has a survivor and 98 % of the viable mutants are killed."""
        loose = any(r.kind != "definition" for r in self.of("survived"))
        return not loose and self.score >= ENOUGH


def percent(part: Fraction) -> str:
    """A percentage for people, rounded down: 99.96 % is not 100 %."""
    tenths = part * 1000 // 1
    return f"{tenths // 10}.{tenths % 10} %"
