"""Content of other tools' files before it becomes a mission: routes, fences, intruders. WGS-84
degrees, SI units.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import NamedTuple

from cratous.services.parameters.parameter_file import Given
from cratous.spec.errors import BadInput

_PLAIN = re.compile(r"[-+]?[0-9]*\.?[0-9]*([eE][-+]?[0-9]+)?")
ALT_M, LEAST_ALT_M = 30_000.0, -500.0
"""Limits of altitudes in a mission file [m]."""


class Place(NamedTuple):
    """A point of a route; alt_m: above the ground at home if above_ground, otherwise above mean sea level."""

    latitude_deg: float
    longitude_deg: float
    alt_m: float
    above_ground: bool


class Way(NamedTuple):
    """A flight plan: its points in order from the start; speed_m_s: None if it has none."""

    label: str
    places: tuple[Place, ...]
    speed_m_s: float | None
    where: str


class Fence(NamedTuple):
    """A zone: corners are (latitude, longitude); floor and ceiling [m], None: unlimited."""

    label: str
    keep_out: bool
    corners: tuple[tuple[float, float], ...]
    floor_m: float | None
    ceiling_m: float | None
    above_ground: bool
    where: str


class Intruder(NamedTuple):
    """An aircraft in straight flight. place: None if given by its offset from home: north_m, east_m."""

    id: int
    place: Place | None
    north_m: float
    east_m: float
    alt_m: float
    velocity: tuple[float, float, float]
    """North, east, down [m/s]."""
    appears_s: float
    where: str


class Parts(NamedTuple):
    """Content of one or several files. parameters: of a parameter file; notes: what was not imported, in words."""

    ways: tuple[Way, ...] = ()
    fences: tuple[Fence, ...] = ()
    intruders: tuple[Intruder, ...] = ()
    parameters: Mapping[str, Given] | None = None
    notes: tuple[str, ...] = ()


class Reading(NamedTuple):
    """The user's options. areas: kind of areas without one ("keep_in", "keep_out", ""); alt_m: of
    routes without altitude; origin: latitude and longitude for tables in metres.
    """

    areas: str = ""
    alt_m: float | None = None
    origin: tuple[float, float] | None = None


def number(text: object, where: str, item: str, low: float, high: float) -> float:
    """A finite number in a range. Raises BadInput."""
    # Python also accepts 1_0, and digits of other scripts
    odd = isinstance(text, bool) or (isinstance(text, str) and not _PLAIN.fullmatch(text.strip()))
    try:
        value = math.nan if odd else float(text)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        value = math.nan
    if not low <= value <= high:
        what = "not a number" if math.isnan(value) else "out of range"
        got = str(text)[:60]
        raise BadInput(what, where=where, item=item, expected=f"{low:g} to {high:g}", got=got)
    return value


def whole(text: object, where: str, item: str, high: int) -> int:
    """An integer from 0 to high. Raises BadInput."""
    value = number(text, where, item, 0, high)
    if value != int(value):
        raise BadInput("not a whole number", where=where, item=item, got=str(text)[:60])
    return int(value)


def latitude(text: object, where: str, item: str = "latitude") -> float:
    """A latitude [deg north]; BadInput outside of -89 to 89."""
    return number(text, where, item, -89, 89)


def longitude(text: object, where: str, item: str = "longitude") -> float:
    """A longitude [deg east]; BadInput outside of -180 to 180."""
    return number(text, where, item, -180, 180)


def altitude(text: object, where: str, item: str = "altitude") -> float:
    """An altitude [m]; BadInput outside of LEAST_ALT_M to ALT_M."""
    return number(text, where, item, LEAST_ALT_M, ALT_M)
