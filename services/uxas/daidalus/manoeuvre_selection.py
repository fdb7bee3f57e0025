"""Selects the manoeuvre that resolves a conflict: kernels check each candidate against bands and
zones.

A candidate's value must lie in no band (`heading_blocked`, `value_blocked`), and the path flown to
it and onwards, including wind, must respect every zone (`first_bad_leg`). If no value is outside
all bands, values in FAR bands are allowed, then those in MID bands: less severe than what they
avoid. Of the valid candidates, the closest to the wanted value is taken, with a distance to the
bands if there is room; if there is none, the reasons say for each severity what prevents it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from cratous.core.avoidance.manoeuvre import Ability, Motion, fly_to
from cratous.core.avoidance.prediction import after
from cratous.core.avoidance.resolution import turn_back_s
from cratous.core.contracts.responses import heading_blocked, value_blocked
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.services.daa.intervals import SERIES
from cratous.services.uxas.daidalus.states import Wind
from cratous.spec.mission import Position, Zone

KINDS = {"Heading": "hdir", "GroundSpeed": "hs", "VerticalSpeed": "vs", "Altitude": "alt"}
ROOM = {"Heading": 5.0, "GroundSpeed": 10.0, "VerticalSpeed": 5.0, "Altitude": 20.0}
"""Distance to the bands, if there is room [deg, m/s, m/s, m]; the values of OpenUxAS."""
SEVERITIES = (("FAR", "MID", "NEAR"), ("MID", "NEAR"), ("NEAR",))
"""Sets of regions to avoid, most preferred first."""
RESUME_REGIONS = SEVERITIES[1]


class Band(NamedTuple):
    """An interval of one dimension and its region."""

    low: float
    high: float
    region: str


class Flight(NamedTuple):
    """Current state of the vehicle relative to the air: position in the plane, heading [deg],
    airspeed and climb rate [m/s]; wind; performance; target altitude [m]; and its climb rate for
    altitude changes [m/s].
    """

    position: Position
    heading: float
    speed: float
    climb: float
    wind: Wind
    ability: Ability
    goal_alt: float
    rate: float


class Manoeuvre(NamedTuple):
    """The command: heading [deg], airspeed and climb rate [m/s], and altitude [m]; the chosen kind
    and value; the regions that it avoids.
    """

    kind: str
    value: float
    heading: float
    speed: float
    climb: float
    altitude: float
    avoids: tuple[str, ...]

    def text(self) -> str:
        """The manoeuvre in words, including the less severe bands that it does not avoid."""
        unit = {"Heading": "deg", "Altitude": "m"}.get(self.kind, "m/s")
        left = [r for r in SEVERITIES[0] if r not in self.avoids]
        in_spite = f", in {' and '.join(left)} bands, as no other is free" if left else ""
        return f"{self.kind} {self.value:g} {unit}{in_spite}"


class Found(NamedTuple):
    """The manoeuvre, or None with the reasons."""

    manoeuvre: Manoeuvre | None
    why: tuple[str, ...] = ()


def bands(message: Any, kind: str) -> tuple[Band, ...]:
    """The conflict bands for a kind of manoeuvre in WellClearViolationIntervals."""
    _, field, intervals, regions, *_ = SERIES[KINDS[kind]]
    pairs = zip(getattr(message, intervals), getattr(message, regions), strict=False)
    ends = ((getattr(one, field), region) for one, region in pairs)
    return tuple(Band(low, high, region.name) for (low, high), region in ends)


def blocked(kind: str, value: float, found: Iterable[Band], avoids: tuple[str, ...]) -> bool:
    """True if a value lies in a band whose region must be avoided."""
    inside = heading_blocked if kind == "Heading" else value_blocked
    return any(inside(value, b.low, b.high) for b in found if b.region in avoids)


def path(now: Flight, m: Manoeuvre, horizon: float) -> list[Position]:
    """The corners of a manoeuvre's ground track: a turn as short chords, then straight."""
    rise = m.altitude - now.position.alt_m
    lasts = abs(rise / m.climb) if m.climb else 0.0
    motion = Motion(now.position, math.radians(now.heading), now.speed, now.climb)
    climb = math.copysign(m.climb, rise)
    heading = math.radians(m.heading)
    pieces = fly_to(motion, now.ability, heading, m.speed, climb, lasts, horizon)
    ends = [(0.0, now.position)]
    ends += [(p.start_s + p.duration_s, after(p, p.duration_s)) for p in pieces]
    return [
        Position(p.north_m + t * now.wind.north, p.east_m + t * now.wind.east, p.alt_m)
        for t, p in ends
    ]


def zone_met(now: Flight, m: Manoeuvre, zones: tuple[Zone, ...], horizon: float) -> Zone | None:
    """A zone that a manoeuvre's path would violate, or None."""
    if not zones:
        return None
    bad = first_bad_leg(path(now, m, horizon), zones)
    return None if bad is None else bad[1]


def horizons(now: Flight, lookahead: float) -> tuple[float, ...]:
    """Horizons for zones [s]: the look-ahead time; then, for use if all paths violate a zone within
    it, the time in which the vehicle could turn back, which is re-evaluated at every instant.
    """
    motion = Motion(now.position, 0.0, now.speed, 0.0)
    return lookahead, turn_back_s(motion, now.ability)


def made(now: Flight, kind: str, value: float, avoids: tuple[str, ...], limits: Any) -> Manoeuvre:
    """The manoeuvre to a value; other values stay unchanged, including a climb towards the target
    altitude, which the bands assume to continue.
    """
    heading, speed, climb, altitude = now.heading, now.speed, 0.0, now.position.alt_m
    if (now.goal_alt - altitude) * now.climb > 0:
        climb, altitude = now.climb, now.goal_alt
    if kind == "Heading":
        heading = value
    elif kind == "GroundSpeed":
        speed = value
    elif kind == "VerticalSpeed":
        far = now.position.alt_m + value * limits.LookAheadTime
        low, high = _limits("Altitude", limits)
        climb, altitude = value, min(max(far, low), high) if value else now.position.alt_m
    else:
        climb, altitude = now.rate, value
    return Manoeuvre(kind, value, heading, speed, abs(climb), altitude, avoids)


def divert(
    now: Flight,
    kind: str,
    wanted: float,
    message: Any,
    limits: Any,
    zones: tuple[Zone, ...],
) -> Found:
    """The valid manoeuvre of a kind closest to a wanted value.

    message: WellClearViolationIntervals; limits: DAIDALUSConfiguration.
    """
    found, why = bands(message, kind), []
    for avoids in SEVERITIES:
        values = [
            v
            for v in candidates(kind, wanted, found, limits)
            if not blocked(kind, v, found, avoids)
        ]
        if not values:
            why.append(f"{kind}: every value lies in a {' or '.join(avoids)} band")
            continue
        # values with a margin first, so that the vehicle does not fly along the edge of a band
        roomy = [v for v in values if _has_room(kind, v, found, avoids)]
        met: dict[str, None] = {}
        for horizon in horizons(now, limits.LookAheadTime):
            for value in dict.fromkeys([*roomy, *values]):
                m = made(now, kind, value, avoids, limits)
                zone = zone_met(now, m, zones, horizon)
                if zone is None:
                    return Found(m, tuple(why))
                met[zone.label] = None
        why.append(
            f"{kind}: {len(values)} values are outside of {' and '.join(avoids)} bands, but each "
            f"meets {' or '.join(met)}"
        )
    return Found(None, tuple(why))


def still_good(
    now: Flight,
    m: Manoeuvre,
    message: Any,
    zones: tuple[Zone, ...],
    traffic: bool,
) -> bool:
    """True if the manoeuvre being flown is still valid; traffic: check bands too, not only zones."""
    if traffic and blocked(m.kind, m.value, bands(message, m.kind), m.avoids):
        return False
    return zone_met(now, m, zones, horizons(now, 0.0)[1]) is None


def candidates(kind: str, wanted: float, found: Iterable[Band], limits: Any) -> list[float]:
    """Values to try, closest to the wanted one first: that value, a grid, and values beside band edges."""
    values = {wanted, *_grid(kind, wanted, limits)}
    for band in found:
        for edge, sign in ((band.low, -1.0), (band.high, 1.0)):
            values |= {edge + sign * ROOM[kind], edge + sign * ROOM[kind] / 10}
    if kind == "Heading":
        turned = {v % 360.0 for v in values}
        return sorted({0.0 if v == 360.0 else v for v in turned}, key=lambda v: _turn(v, wanted))
    low, high = _limits(kind, limits)
    within = {v for v in values if v == min(max(v, low), high)}
    return sorted(within, key=lambda v: (abs(v - wanted), -v))


def _turn(value: float, wanted: float) -> tuple[float, float]:
    """Size of the turn, right turns before left turns."""
    right = (value - wanted) % 360.0
    return min(right, 360.0 - right), right


def _has_room(kind: str, value: float, found: tuple[Band, ...], avoids: tuple[str, ...]) -> bool:
    near = [value - 0.9 * ROOM[kind], value + 0.9 * ROOM[kind]]
    if kind == "Heading":
        near = [v % 360.0 for v in near]
    return not any(blocked(kind, v, found, avoids) for v in near)


def _limits(kind: str, limits: Any) -> tuple[float, float]:
    name = {"GroundSpeed": "GroundSpeed", "VerticalSpeed": "VerticalSpeed"}.get(kind, "Altitude")
    return getattr(limits, f"Min{name}"), getattr(limits, f"Max{name}")


def _grid(kind: str, wanted: float, limits: Any) -> Iterator[float]:
    if kind == "Heading":
        yield from (wanted + 5.0 * k for k in range(72))
        return
    low, high = _limits(kind, limits)
    step = {
        "GroundSpeed": limits.GroundSpeedStep,
        "VerticalSpeed": limits.VerticalSpeedStep,
        "Altitude": limits.AltitudeStep,
    }[kind]
    yield from (low + step * k for k in range(min(2000, int((high - low) / step) + 1)))
