"""One parameter of a mission: its value, where that comes from, and how."""

from __future__ import annotations

from typing import Any, NamedTuple

GIVEN, DEFAULT, DERIVED, FIXED = "given", "default", "derived", "fixed"
"""Written in the mission; left out there; follows from vehicle and mission; the same for all missions."""


class Parameter(NamedTuple):
    """name: as the mission file has it, or of what is derived; vehicle: whose, 0 for the whole mission; value, unit;
    default, low, high: of what may be given, None where there is none; origin: one of GIVEN, DEFAULT,
    DERIVED, FIXED; how: the formula, or what it is, in words."""

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
        """From what to what, or "-"."""
        if self.low is None and self.high is None:
            return "-"
        low = "" if self.low is None else f"{self.low:g}"
        return f"{low} to {'' if self.high is None else f'{self.high:g}'}".strip()

    def data(self) -> dict[str, Any]:
        """The parameter as plain data, for JSON."""
        return self._asdict()
