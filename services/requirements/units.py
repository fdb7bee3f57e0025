"""Units that a requirement may name, each an exact multiple of the SI unit of its dimension."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

# the degree is a unit of its own dimension: radians are no rational multiple of it
UNITS: dict[str, tuple[str, Fraction]] = {
    "1": ("number", Fraction(1)),
    "%": ("number", Fraction(1, 100)),
    "m": ("length", Fraction(1)),
    "km": ("length", Fraction(1000)),
    "ft": ("length", Fraction(3048, 10000)),
    "nmi": ("length", Fraction(1852)),
    "ns": ("time", Fraction(1, 10**9)),
    "us": ("time", Fraction(1, 10**6)),
    "ms": ("time", Fraction(1, 1000)),
    "s": ("time", Fraction(1)),
    "min": ("time", Fraction(60)),
    "h": ("time", Fraction(3600)),
    "Hz": ("rate", Fraction(1)),
    "m/s": ("speed", Fraction(1)),
    "km/h": ("speed", Fraction(1000, 3600)),
    "kn": ("speed", Fraction(1852, 3600)),
    "ft/min": ("speed", Fraction(3048, 600000)),
    "m/s^2": ("acceleration", Fraction(1)),
    "deg": ("angle", Fraction(1)),
    "deg/s": ("angular rate", Fraction(1)),
    "rad": ("angle in radians", Fraction(1)),
    "rad/s": ("angular rate in radians", Fraction(1)),
    "J": ("energy", Fraction(1)),
    "kWh": ("energy", Fraction(3_600_000)),
    "V": ("voltage", Fraction(1)),
    "degC": ("temperature", Fraction(1)),
}
"""Name -> (dimension, size in the dimension's SI unit)."""


@dataclass(frozen=True)
class Quantity:
    """A number with the name of its unit; text: as it is written."""

    value: Fraction
    unit: str
    text: str


def dimension(unit: str) -> str:
    """The dimension of a unit, as `length`."""
    return UNITS[unit][0]


def in_unit(quantity: Quantity, unit: str) -> Fraction:
    """The exact value of a quantity in another unit of its dimension."""
    return quantity.value * UNITS[quantity.unit][1] / UNITS[unit][1]
