"""Predicted losses of well clear, and whether the own vehicle must act on them.

The own trajectory is checked against each intruder with the exact-in-time kernel, on thresholds widened by
the mission's buffer. A predicted loss must persist before it counts, so that an intruder that is merely
turning past does not interrupt a task, unless the loss is so near that waiting would preclude an escape.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.authority.gate import gives_way
from cratous.core.authority.right_of_way import must_act
from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.manoeuvre import Ability, smallest_turn
from cratous.core.avoidance.prediction import Intruder
from cratous.core.avoidance.way_ahead import turns
from cratous.services.icarous.route_end import Ahead
from cratous.spec.mission import WellClear

PERSIST_MS = 2000
"""A predicted loss counts after this long [ms]: four heartbeats."""


TURNING_RAD_S = 0.02
"""An intruder that turns faster than this does not count as flying straight on [rad/s]: about 1 deg/s."""

Tracks = tuple[tuple[int, float], ...]
"""Last seen courses of the intruders: (id, course [rad])."""


class Threat(NamedTuple):
    """A predicted loss of well clear: intruder, time to it [s], and when it was first predicted [ms]."""

    intruder_id: int
    first_violation_s: float
    since_ms: int
    ours_to_act: bool


class Nearest(NamedTuple):
    """Limits of the time to a predicted loss [s]: see `last_time_s` and `hard_limit_s`."""

    last_s: float
    hard_s: float


def nearest(ability: Ability, volume: WellClear, heartbeat_ms: int) -> Nearest:
    """Both limits at the vehicle's present motion."""
    return Nearest(last_time_s(ability, volume, heartbeat_ms), hard_limit_s(ability, heartbeat_ms))


def last_time_s(ability: Ability, volume: WellClear, heartbeat_ms: int) -> float:
    """The shortest time to a predicted loss at which the vehicle with the right of way still waits [s].

    Derivation: whatever the geometry, a turn of 90 degrees takes the own velocity out of the line of the
    encounter; it takes (pi / 2) / turn rate. The other vehicle may need TTHR of the volume for its own turn
    to show in the prediction, since the volume reaches TTHR ahead of contact. One heartbeat passes until the
    prediction is renewed, one until the command acts:

        T_last = (pi / 2) / turn_rate + TTHR + 2 heartbeats

    Example: 22 m/s, 30 degrees of bank: 0.257 rad/s, 6.1 s; TTHR 18.75 s; 1 s: 25.9 s.
    """
    return (math.pi / 2) / ability.turn_rate_rad_s + volume.tthr_s + 2 * heartbeat_ms / 1000


def hard_limit_s(ability: Ability, heartbeat_ms: int) -> float:
    """The shortest time to a predicted loss at which waiting is permitted at all [s]: the turn and two
    heartbeats.
    """
    return (math.pi / 2) / ability.turn_rate_rad_s + 2 * heartbeat_ms / 1000


def courses(intruders: tuple[Intruder, ...]) -> Tracks:
    """The present course of every intruder, (id, course [rad])."""
    return tuple(
        (other.id, math.atan2(other.velocity.east_m_s, other.velocity.north_m_s))
        for other in intruders
    )


def turning(now: Tracks, before: Tracks, dt_s: float, loose: Tracks = ()) -> frozenset[int]:
    """The intruders in a turn: their course has changed since the last heartbeat by more than its
    uncertainty.

    loose: uncertainty of the course [rad], for those whose course is not known exactly.
    """
    was, off = dict(before), dict(loose)
    turned = {
        other: max(0.0, abs(smallest_turn(was[other], course)) - off.get(other, 0.0))
        for other, course in now
        if other in was
    }
    return frozenset(other for other, turn in turned.items() if turns(turn, TURNING_RAD_S, dt_s))


def loose_courses(intruders: tuple[Intruder, ...]) -> Tracks:
    """Bound of the course error [rad] by intruder, for those whose course is uncertain."""
    found = []
    for other in intruders:
        v, off = other.velocity, other.spread.wide_m_s
        if off:
            found.append((other.id, math.atan2(off, math.hypot(v.north_m_s, v.east_m_s))))
    return tuple(found)


def threats(
    own_id: int,
    ahead: Ahead,
    intruders: tuple[Intruder, ...],
    before: tuple[Threat, ...],
    now_ms: int,
    limits: Nearest,
    in_turn: frozenset[int] = frozenset(),
) -> tuple[Threat, ...]:
    """All predicted losses, by intruder. before: the result of the last heartbeat.

    An intruder in a turn does not follow its straight-line prediction, so its threat must persist unless the
    loss is nearer than hard_s.
    """
    since = {threat.intruder_id: threat.since_ms for threat in before}
    found = []
    for other in intruders:
        first = ahead.first_s(other)
        if first is None:
            continue
        seen_ms = since.get(other.id, now_ms)
        ours = must_act(
            first,
            limits.last_s,
            limits.hard_s,
            PERSIST_MS / 1000,
            lasted(seen_ms, now_ms, PERSIST_MS),
            other.id in in_turn,
            gives_way(own_id, other.id, other.cooperates),
        )
        found.append(Threat(other.id, first, seen_ms, ours))
    return tuple(found)


def most_urgent(found: tuple[Threat, ...]) -> Threat | None:
    """The threat to act on: the nearest one that requires own action; None if there is none."""
    ours = [threat for threat in found if threat.ours_to_act]
    return min(ours, key=lambda t: (t.first_violation_s, t.intruder_id), default=None)
