"""Units of requirements, each an exact multiple of the SI unit of its dimension, and products of
them.

A product is written without spaces, as `m^2`, `m*kn` or `J/m^2`; a `/` divides by the next unit
only.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

# the degree has a dimension of its own: it is no rational multiple of the radian
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


BASES = ("length", "time", "angle", "angle in radians", "energy", "voltage", "temperature")
MADE = {"speed": ("m", "s"), "acceleration": ("m", "s^2"), "angular rate": ("deg", "s"),
        "angular rate in radians": ("rad", "s"), "rate": ("1", "s")}  # fmt: skip
"""Dimensions that are quotients: (numerator unit, denominator unit)."""
NONE = ("", "1")
"""Unit of dimensionless numbers, and of numbers in languages without units."""
HIGHEST = 9
"""Maximum power of a unit."""
PART = re.compile(r"([A-Za-z%]+|1)(?:\^([0-9]+))?")


class NoUnit(ValueError):
    """A computed number has no unit, or none that can be written; the reason in words."""


@dataclass(frozen=True)
class Quantity:
    """A number with the name of its unit; text: as written."""

    value: Fraction
    unit: str
    text: str


def dimension(unit: str) -> str:
    """The dimension of a unit, as `length`; without a name of its own as `length^2/time`."""
    if unit in UNITS:
        return UNITS[unit][0]
    powers: dict[str, int] = {}
    for name, power in _powers(unit).items():
        for base, times in _bases(name).items():
            powers[base] = powers.get(base, 0) + times * power
    powers = {base: power for base, power in powers.items() if power}
    if not powers:
        return "number"
    for known, (over, under) in MADE.items():
        if powers == _powers_of({over: 1}, {under: 1}):
            return known
    return _text(powers)


def in_unit(quantity: Quantity, unit: str) -> Fraction:
    """The exact value of a quantity in another unit of its dimension."""
    return quantity.value * factor(quantity.unit) / factor(unit)


@cache
def factor(unit: str) -> Fraction:
    """Size of a unit in the SI unit of its dimension."""
    if unit in UNITS:
        return UNITS[unit][1]
    found = Fraction(1)
    for name, power in _powers(unit).items():
        found *= UNITS[name][1] ** power
    return found


def of_text(text: str) -> str:
    """The canonical form of a unit; NoUnit if the text is none."""
    return text if text in UNITS else _text(_powers(text))


def product(one: str, other: str, sign: str = "*") -> str:
    """The unit of a product or, with `/`, of a quotient; NoUnit if there is none."""
    if other in NONE and (sign == "/" or one not in NONE):
        return one or other
    if one in NONE and (sign == "*" or other in NONE):
        return other or one
    found = dict(_powers(one))
    for name, power in _powers(other).items():
        found[name] = found.get(name, 0) + (power if sign == "*" else -power)
    if "degC" in found:
        raise NoUnit("a temperature in degC is counted from no absolute zero, so it has no product")
    return _text({name: power for name, power in found.items() if power})


def root(unit: str) -> str:
    """The unit of a square root; NoUnit if there is none."""
    if unit in NONE:
        return unit
    powers = _powers(unit)
    if any(power % 2 for power in powers.values()):
        raise NoUnit("the root of this has no unit")
    return _text({name: power // 2 for name, power in powers.items()})


def _text(powers: Mapping[str, int]) -> str:
    if any(abs(power) > HIGHEST for power in powers.values()):
        raise NoUnit(f"a unit has a power above {HIGHEST}")
    over = [_raised(name, power) for name, power in sorted(powers.items()) if power > 0]
    under = [_raised(name, -power) for name, power in sorted(powers.items()) if power < 0]
    found = "/".join(("*".join(over) or "1", *under))
    return {"1/s": "Hz"}.get(found, found)


def _raised(name: str, power: int) -> str:
    return name if power == 1 else f"{name}^{power}"


@cache
def _powers(unit: str) -> Mapping[str, int]:
    """The powers of the elementary units of a unit; NoUnit if it is none."""
    found: dict[str, int] = {}
    sign = 1
    for part in re.split(r"([*/])", "1/s" if unit == "Hz" else unit):
        if part in ("*", "/"):
            sign = 1 if part == "*" else -1
            continue
        said = PART.fullmatch(part)
        if said is None or said[1] not in UNITS:
            raise NoUnit(f"there is no such unit: {unit[:40]}")
        power = int(said[2] or 1)
        if not 1 <= power <= HIGHEST:
            raise NoUnit(f"a unit has a power from 1 to {HIGHEST}: {unit[:40]}")
        if said[1] != "1":
            found[said[1]] = found.get(said[1], 0) + sign * power
    return {name: power for name, power in found.items() if power}


def _bases(name: str) -> Mapping[str, int]:
    """The dimension's base dimensions, of a unit that is no quotient."""
    base = UNITS[name][0]
    if base in BASES:
        return {base: 1}
    if base == "number":
        return {}
    over, under = MADE[base]
    return _powers_of({over: 1}, {under: 1})


def _powers_of(over: Mapping[str, int], under: Mapping[str, int]) -> dict[str, int]:
    """The base dimensions of a quotient of products of elementary units."""
    found: dict[str, int] = {}
    for units, sign in ((over, 1), (under, -1)):
        for unit, times in units.items():
            for name, power in _powers(unit).items():
                base = UNITS[name][0]
                if base != "number":
                    found[base] = found.get(base, 0) + sign * times * power
    return found
