"""One parameter of a mission: its value, origin and formula."""

from __future__ import annotations

from typing import Any, NamedTuple

GIVEN, DEFAULT, DERIVED, FIXED = "given", "default", "derived", "fixed"
"""Set in the mission; its default; derived from vehicle and mission; the same for all missions."""


class Parameter(NamedTuple):
    """name: as in the mission file, or of the derived value; vehicle: its id, 0 for the whole mission; value,
    unit; default, low, high: of parameters that may be given, None where there is none; origin: one of
    GIVEN, DEFAULT, DERIVED, FIXED; how: the formula or a description, in words.
    """

    name: str
    vehicle: int
    value: float | bool
    unit: str
    default: float | bool | None
    low: float | None
    high: float | None
    origin: str
    how: str

    @property
    def range_text(self) -> str:
        """The range in words, or "-"."""
        if self.low is None and self.high is None:
            return "-"
        low = "" if self.low is None else f"{self.low:g}"
        return f"{low} to {'' if self.high is None else f'{self.high:g}'}".strip()

    def data(self) -> dict[str, Any]:
        """The parameter as plain data, for JSON."""
        return self._asdict()
