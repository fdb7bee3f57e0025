"""How formulas are made: as a solver's terms, or at once as true or false where every value is known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol


class Logic(Protocol):
    """What formulas are made with; sums and comparisons are Python's own operators."""

    def number(self, name: str) -> Any:
        """The whole number of this name."""

    def truth(self, name: str) -> Any:
        """The truth value of this name."""

    def each(self, formulas: Sequence[Any]) -> Any:
        """All of them hold."""

    def some(self, formulas: Sequence[Any]) -> Any:
        """At least one of these formulas holds."""

    def one(self, formulas: Sequence[Any]) -> Any:
        """Exactly one of them holds."""

    def few(self, formulas: Sequence[Any]) -> Any:
        """At most one of these formulas holds."""

    def follows(self, premise: Any, formula: Any) -> Any:
        """The formula holds if the premise does."""

    def differ(self, numbers: Sequence[Any]) -> Any:
        """No two of these numbers are alike."""

    def laps(self, name: str, wait: Any, lap_ms: int) -> Any:
        """A number of laps of this length that may make up a wait."""


class Known:
    """Formulas of values that are known: each is true or false. KeyError for a name without a value."""

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
