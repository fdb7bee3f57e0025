"""Construction of formulas: as a solver's terms, or evaluated directly where all values are known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol


class Logic(Protocol):
    """Operations for constructing formulas; sums and comparisons are Python's own operators."""

    def number(self, name: str) -> Any:
        """The integer variable of this name."""

    def truth(self, name: str) -> Any:
        """The Boolean variable of this name."""

    def each(self, formulas: Sequence[Any]) -> Any:
        """All of these formulas hold."""

    def some(self, formulas: Sequence[Any]) -> Any:
        """At least one of these formulas holds."""

    def one(self, formulas: Sequence[Any]) -> Any:
        """Exactly one of these formulas holds."""

    def few(self, formulas: Sequence[Any]) -> Any:
        """At most one of these formulas holds."""

    def follows(self, premise: Any, formula: Any) -> Any:
        """The premise implies the formula."""

    def differ(self, numbers: Sequence[Any]) -> Any:
        """These numbers are pairwise different."""

    def laps(self, name: str, wait: Any, lap_ms: int) -> Any:
        """A number of laps of lap_ms [ms] that may make up a wait."""


class Known:
    """Formulas over known values, evaluated at once. KeyError for a name without a value."""

    def __init__(self, numbers: Mapping[str, int], truths: Mapping[str, bool]) -> None:
        self._numbers, self._truths = numbers, truths

    def number(self, name: str) -> int:
        return self._numbers[name]

    def truth(self, name: str) -> bool:
        return self._truths[name]

    def each(self, formulas: Sequence[bool]) -> bool:
        return all(formulas)

    def some(self, formulas: Sequence[bool]) -> bool:
        return any(formulas)

    def one(self, formulas: Sequence[bool]) -> bool:
        return sum(formulas) == 1

    def few(self, formulas: Sequence[bool]) -> bool:
        return sum(formulas) <= 1

    def follows(self, premise: bool, formula: bool) -> bool:
        return formula or not premise

    def differ(self, numbers: Sequence[int]) -> bool:
        return len(set(numbers)) == len(numbers)

    def laps(self, name: str, wait: int, lap_ms: int) -> int:
        # of all numbers that are not too many, the most laps can make up the longest wait
        return wait // max(lap_ms, 1)
