"""Positions and motion for a standalone ICAROUS: the own vehicle from POSTN, others from OBJCT and from
vehicles that report their own state directly.

A vehicle's own report is used where its OBJCT has been missing for 2 s, as long as the report is not too old
to be kept, and with an uncertainty for its age: since then, the vehicle may have turned, accelerated and
climbed as hard as the own airframe can.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from cratous.bridge.text_protocol import OwnPosition, Traffic
from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import EXACT, Intruder, Spread
from cratous.services.flight.dynamics import Limits, ability_at
from cratous.services.icarous.other_vehicles import LINK_LOST_MS
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Position, Velocity

TRAFFIC_KEPT_MS = 5000
"""An aircraft not heard of for this long is no longer extrapolated [ms]."""
MOST_TRAFFIC = 500
"""Most other aircraft that are kept."""
EARLY_MS = 2000
"""Most that a vehicle's own time may be ahead of this one's [ms]: UxAS may be late."""


class Seen(NamedTuple):
    """Another aircraft, as last described by OBJCT at the time of the last POSTN [ms], or as reported by
    itself at its own time.
    """

    position: Position
    velocity: Velocity
    at_ms: int


SeenBy = Mapping[int, Seen]


def seen_at(line: Traffic, now_ms: int, projection: Projection) -> Seen:
    """The aircraft that an OBJCT line describes."""
    place = Position(*projection.to_local(line.lat_deg, line.long_deg), line.alt_m)
    return Seen(place, Velocity(line.north_mps, line.east_mps, line.down_mps), now_ms)


def told_by_itself(line: OwnPosition, projection: Projection) -> Seen:
    """A vehicle's own report."""
    place = Position(*projection.to_local(line.lat_deg, line.long_deg), line.alt_abs_m)
    velocity = Velocity(line.north_mps, line.east_mps, line.down_mps)
    return Seen(place, velocity, round(1000 * line.time_s))


def another_time(seen: Seen, now_ms: int) -> bool:
    """Whether a vehicle's own report is too early or too old relative to now_ms [ms]."""
    early = lasted(now_ms, seen.at_ms, EARLY_MS + 1)
    return early or lasted(seen.at_ms, now_ms, TRAFFIC_KEPT_MS)


def kept(seen: SeenBy, now_ms: int) -> dict[int, Seen]:
    """The aircraft whose latest state is not older than TRAFFIC_KEPT_MS at now_ms [ms]."""
    return {vid: s for vid, s in seen.items() if not lasted(s.at_ms, now_ms, TRAFFIC_KEPT_MS)}


def by_themselves(objects: SeenBy, direct: SeenBy, now_ms: int) -> frozenset[int]:
    """The aircraft that report their own state and of which OBJCT is missing or stale at now_ms [ms]."""

    def stale(vid: int) -> bool:
        return vid not in objects or lasted(objects[vid].at_ms, now_ms, LINK_LOST_MS)

    return frozenset(vid for vid in direct if stale(vid))


def intruders(
    objects: SeenBy, direct: SeenBy, now_ms: int, ability: Ability, cooperating: Iterable[int]
) -> tuple[Intruder, ...]:
    """All other aircraft, extrapolated in straight flight to now_ms [ms]."""
    selves = by_themselves(objects, direct, now_ms)
    used = {**objects, **{vid: direct[vid] for vid in selves}}
    found, ours = [], frozenset(cooperating)
    for vid, (p, v, at_ms) in sorted(used.items()):
        t_s = (now_ms - at_ms) / 1000
        here = Position(
            p.north_m + v.north_m_s * t_s,
            p.east_m + v.east_m_s * t_s,
            p.alt_m - v.down_m_s * t_s,
        )
        spread = spread_of(abs(t_s), v, ability) if vid in selves else EXACT
        found.append(Intruder(vid, here, v, vid in ours, spread=spread))
    return tuple(found)


def spread_of(age_s: float, v: Velocity, ability: Ability) -> Spread:
    """Largest deviation from straight flight after age_s [s], if an aircraft manoeuvres as hard as the own
    airframe can.
    """
    speed = max(math.hypot(v.north_m_s, v.east_m_s), ability.min_speed_m_s)
    across = speed * ability.turn_rate_rad_s
    wide_m = math.hypot(across, ability.acceleration_m_s2) * age_s**2 / 2
    return Spread(wide_m, 0.0, (ability.max_climb_m_s + abs(v.down_m_s)) * age_s, 0.0)


def changes(
    gone: Iterable[int], before: frozenset[int], now: frozenset[int], told: Iterable[int]
) -> list[tuple[str, str]]:
    """Log entries (severity, text) for changes since the last heartbeat: aircraft lost, and changes of
    source.

    before, now: aircraft known by their own reports; told: aircraft that UxAS reports.
    """
    why = f"not heard of for {TRAFFIC_KEPT_MS} ms, no longer avoided"
    found = [("WARN", f"vehicle {vid}: {why}") for vid in sorted(gone)]
    word = "UxAS does not tell it; avoided by its own word"
    found += [("WARN", f"vehicle {vid}: {word}") for vid in sorted(now - before)]
    again = (before - now).intersection(told)
    return found + [("INFO", f"vehicle {vid}: UxAS tells it again") for vid in sorted(again)]


def flying(
    line: OwnPosition, projection: Projection, limits: Limits, floor_m: float, step_s: float
) -> tuple[Motion, Ability]:
    """The own motion, and the airframe's ability at its speed. floor_m, step_s: as in `Ability`."""
    north, east = projection.to_local(line.lat_deg, line.long_deg)
    speed = math.hypot(line.north_mps, line.east_mps)
    course = math.atan2(line.east_mps, line.north_mps)
    ability = ability_at(speed, limits, floor_m, step_s)
    return Motion(Position(north, east, line.alt_abs_m), course, speed, -line.down_mps), ability
