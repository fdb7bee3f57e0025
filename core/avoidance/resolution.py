"""Resolution manoeuvres: candidates are generated, and the kernels decide each of them.

Candidates: headings to the left and right of the course in steps of 5 degrees, flown with the real turn rate; if none
is free of conflict, level changes (climb or descend past the intruder's layer) and changes of speed, also together
with turns. If the scene prefers another kind of manoeuvre, flight on course comes first, then manoeuvres of that kind
with turns of up to 60 degrees. Each segment of each candidate is checked against every intruder by `violation_within`
and against every zone by `leg_keeps`. The candidate that deviates least from the course is chosen (ties to the
right); a manoeuvre already begun is kept as long as it is free, unless one nearer to the course by more than 10
degrees has become free (hysteresis). If none is free, the one with the latest first violation is flown, and the
choice records that.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from cratous.core.avoidance.drift import NONE, Drift, Off, drift_of
from cratous.core.avoidance.manoeuvre import Ability, Motion, fly_to, smallest_turn
from cratous.core.avoidance.prediction import (
    Intruder,
    Piece,
    after,
    first_violation_s,
    meets,
    violated_s,
)
from cratous.core.geofence.clearance import leg_keeps
from cratous.core.kernel import driver
from cratous.spec.mission import Resolution, WellClear, Zone

STEP_DEG = 5
KEEP_RAD = math.radians(10)
TURNS_DEG = (0, 30, -30, 60, -60, 90, -90, 135, -135, 180)
SMALL_TURNS_DEG = TURNS_DEG[:5]
"""Turns off the course combined with changes of altitude and of speed; those used where such a change is preferred."""


class Choice(NamedTuple):
    """A manoeuvre: heading [rad], speed [m/s], climb [m/s] for climb_for_s [s].

    clear: free of conflict over the look-ahead; if not, first_violation_s says when it loses well
    clear or meets a zone.
    """

    kind: str
    heading_rad: float
    speed_m_s: float
    climb_m_s: float
    climb_for_s: float
    clear: bool
    first_violation_s: float | None


class Scene(NamedTuple):
    """What a manoeuvre is checked against: traffic, zones, the buffered volume, and the look-ahead. here: present
    deviation of the vehicle from its assumed position; first: the preferred kind of manoeuvre.
    """

    intruders: tuple[Intruder, ...]
    zones: tuple[Zone, ...]
    volume: WellClear
    lookahead_s: float
    here: Off = NONE.here
    first: Resolution = Resolution.HEADING


@driver(checked_by=("keep_out_leg_ok", "keep_in_leg_ok", "locate", "comes_within"))
def first_zone_s(
    pieces: Sequence[Piece], zones: Sequence[Zone], chunk_s: float, drift: Drift = NONE
) -> float | None:
    """When the first zone is, or within the drift may be, violated [s], or None; early by at most chunk_s on a long
    segment.
    """
    for piece in pieces:
        t = 0.0
        while t < piece.duration_s:
            step = min(chunk_s, piece.duration_s - t)
            p, q = after(piece, t), after(piece, t + step)
            aside_m = drift.aside_m(piece.start_s + t + step)
            rise_m = drift.rise_m(piece.start_s + t + step)
            for zone in zones:
                if not leg_keeps(p, q, zone, aside_m, rise_m):
                    return piece.start_s + t
            t += step
    return None


@driver(checked_by=("violation_within",))
def first_conflict_s(pieces: Sequence[Piece], scene: Scene) -> float | None:
    """When a trajectory first loses well clear of any intruder [s], or None."""
    times = (first_violation_s(pieces, other, scene.volume) for other in scene.intruders)
    return min((t for t in times if t is not None), default=None)


def turn_back_s(now: Motion, ability: Ability) -> float:
    """The least look-ahead for zones [s]: time to fly a half circle, plus one radius."""
    return (math.pi + 1) / ability.turn_rate_rad_s


@driver(
    checked_by=("violation_within", "keep_out_leg_ok", "keep_in_leg_ok", "locate", "comes_within")
)
def keeps_clear(now: Motion, ability: Ability, scene: Scene, choice: Choice) -> bool:
    """True iff a manoeuvre, including the drift of its turn, is free of traffic and zones over the whole look-ahead."""
    pieces = _pieces(now, ability, choice, scene.lookahead_s)
    if any(meets(pieces, other, scene.volume) for other in scene.intruders):
        return False
    drift = drift_of(now, ability, *choice[1:4], scene.here)
    return first_zone_s(pieces, scene.zones, turn_back_s(now, ability), drift) is None


@driver(
    checked_by=(
        "violation_within", "violation", "keep_out_leg_ok", "keep_in_leg_ok", "locate", "comes_within",
    )
)  # fmt: skip
def resolve(
    now: Motion,
    ability: Ability,
    scene: Scene,
    course_rad: float,
    speed_m_s: float,
    held: Choice | None,
) -> Choice:
    """The manoeuvre to fly now, at speed_m_s if possible; `held` is the one flown until now.

    A heading is free of zones if it keeps the drift of its turn from them. One that is free of traffic over the whole
    look-ahead but meets a zone in it is used if no heading is free of both and the zone is farther away than the
    flight time of a half circle: the choice is renewed long before. If there is no such heading either, the vehicle
    is already near a zone: the zone itself counts then, without drift.
    """
    near_s = turn_back_s(now, ability)
    fallback: tuple[tuple[float, float], Choice] | None = None
    later: Choice | None = None
    close: Choice | None = None
    for candidate in _candidates(now, ability, scene, course_rad, speed_m_s, held):
        pieces = _pieces(now, ability, candidate, scene.lookahead_s)
        traffic_s = first_conflict_s(pieces, scene)
        drift = drift_of(now, ability, *candidate[1:4], scene.here)
        zone_s = first_zone_s(pieces, scene.zones, near_s, drift) if scene.zones else None
        if traffic_s is None and zone_s is None:
            return candidate._replace(clear=True)
        if traffic_s is None and zone_s is not None and zone_s >= near_s:
            later = later or candidate._replace(clear=True, first_violation_s=None)
            continue
        if zone_s is not None:
            zone_s = first_zone_s(pieces, scene.zones, near_s)
        if traffic_s is None and (zone_s is None or zone_s >= near_s):
            close = close or candidate._replace(clear=True, first_violation_s=None)
            continue
        first = min(t for t in (traffic_s, zone_s) if t is not None)
        # a zone met before a turn back could avoid it counts as the worst case
        until_s = -1.0 if zone_s is not None and zone_s < near_s else first
        most_s = math.inf
        if fallback is not None:
            if until_s < fallback[0][0]:
                continue
            most_s = -fallback[0][1] if until_s == fallback[0][0] else math.inf
        lost_s = _lost_s(pieces, scene, most_s) if first <= 1.0 else 0.0
        rank = (until_s, -lost_s)
        if fallback is None or rank > fallback[0]:
            fallback = (rank, candidate._replace(first_violation_s=first))
    found = later or close
    if found is not None:
        return found
    assert fallback is not None, "there is always a candidate"
    return fallback[1]


def _lost_s(pieces: Sequence[Piece], scene: Scene, most_s: float) -> float:
    """The approximate duration of the losses of well clear, summed over intruders up to most_s [s]."""
    lost_s = 0.0
    for other in scene.intruders:
        lost_s += violated_s(pieces, other, scene.volume)
        if lost_s >= most_s:
            break
    return lost_s


def _pieces(now: Motion, ability: Ability, choice: Choice, horizon_s: float) -> tuple[Piece, ...]:
    return fly_to(
        now,
        ability,
        choice.heading_rad,
        choice.speed_m_s,
        choice.climb_m_s,
        choice.climb_for_s,
        horizon_s,
    )


def _headings(course_rad: float, held: Choice | None) -> Iterator[float]:
    """Course, then 5 degrees right, left, 10 right ...; the held one before its own neighbours."""
    kept = False
    for k in range(180 // STEP_DEG + 1):
        off = math.radians(k * STEP_DEG)
        if held is not None and not kept:
            away = abs(smallest_turn(course_rad, held.heading_rad))
            if away <= off + KEEP_RAD:
                kept = True
                yield held.heading_rad
        yield course_rad + off
        if 0 < k < 180 // STEP_DEG:
            yield course_rad - off


def _candidates(
    now: Motion,
    ability: Ability,
    scene: Scene,
    course_rad: float,
    speed: float,
    held: Choice | None,
) -> Iterator[Choice]:
    level = Choice("heading", course_rad, speed, 0.0, 0.0, False, None)
    if scene.first is not Resolution.HEADING:
        yield level
        if held is not None and held.kind == scene.first:
            yield held
        yield from of_kind(scene.first, now, ability, scene, level)
    for heading in _headings(course_rad, held):
        yield level._replace(heading_rad=heading)
    yield from _changes(now, ability, scene, level, TURNS_DEG)


def of_kind(
    kind: Resolution, now: Motion, ability: Ability, scene: Scene, level: Choice
) -> tuple[Choice, ...]:
    """Changes of altitude, or of speed, together with small turns off the heading of `level`, the smallest first."""
    changes = _changes(now, ability, scene, level, SMALL_TURNS_DEG)
    return tuple(one for one in changes if one.kind == kind)


def _changes(
    now: Motion, ability: Ability, scene: Scene, level: Choice, turns_deg: Sequence[int]
) -> Iterator[Choice]:
    """Changes of altitude and of speed, combined with turns."""
    _, course_rad, speed, *_ = level
    # past the layer of the volume, twice, so that the climb itself does not end at its edge
    climb_for_s = 2 * scene.volume.zthr_m / ability.max_climb_m_s if ability.max_climb_m_s else 0
    climbs = [ability.max_climb_m_s, -ability.max_climb_m_s] if climb_for_s else []
    if now.position.alt_m - ability.max_climb_m_s * climb_for_s < ability.floor_m:
        climbs = climbs[:1]
    for turn in map(math.radians, turns_deg):
        for climb in climbs:
            yield Choice("altitude", course_rad + turn, speed, climb, climb_for_s, False, None)
        for other in (ability.min_speed_m_s, ability.max_speed_m_s):
            if abs(other - speed) > 0.5:
                yield Choice("speed", course_rad + turn, other, 0.0, 0.0, False, None)
