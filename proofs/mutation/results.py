"""The verdicts on one mutant and on one premise."""

from __future__ import annotations

from dataclasses import dataclass

VERDICTS = ("killed", "survived", "equivalent", "undecided", "stillborn")


@dataclass(frozen=True)
class Result:
    """The verdict on one mutant. by: the theorem that is refuted; note: witness, or where it is equal."""

    target: str
    kind: str
    operator: str
    place: str
    diff: str
    verdict: str
    by: str = ""
    note: str = ""

    @property
    def line(self) -> str:
        """One line: place, what changed, and what is known of it."""
        return f"{self.place}: {self.diff}" + (f" ({self.note})" if self.note else "")


@dataclass(frozen=True)
class PremiseResult:
    """A theorem without one of its premises, and with that premise weakened.

    dropped, weakened: `matters` (refuted), `unused` (still proved), `undecided`, or `-` (no weaker form was tried).
    """

    theorem: str
    premise: str
    dropped: str
    weakened: str
