"""The own state: fixes of GPS, carried on by the inertial unit, which knows how far the vehicle has flown since.

The unit is taken to be exact over a step but for a drift, which is the noise of the filter. Before the first fix the vehicle
knows the state in which it starts as well as a fix would tell it.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.services.sensing.filter import (
    Estimate,
    Flown,
    Measured,
    later,
    measured,
    updated,
)
from cratous.spec.mission import Position, Velocity
from cratous.spec.mission.sensing import Sensor

DRIFT_M_S2 = 0.05
"""By how much the velocity of the inertial unit may drift in a second."""


class Own(NamedTuple):
    """The vehicle's knowledge of itself. estimate: of now; flown: its recent path by the inertial unit, oldest first: (time [ms],
    place, velocity)."""

    estimate: Estimate
    flown: tuple[tuple[int, Position, Velocity], ...]


def first(sensor: Sensor, now_ms: int, air: Flown) -> Own:
    """The estimate of the own state at the start, at now_ms [ms]."""
    start = measured(sensor, now_ms, air.position, air.velocity)
    return Own(Estimate(*start), ((now_ms, air.position, air.velocity),))


def moved(before: Own, now_ms: int, air: Flown, since_ms: int) -> Own:
    """After the vehicle has flown on: the inertial unit tells by how much.

    since_ms: when the oldest fix was made that has not come yet; what was flown before is let go of.
    """
    _, place, velocity = before.flown[-1]
    known = before.estimate
    grown = later(known, now_ms, DRIFT_M_S2)
    p, v, q, w = known.position, known.velocity, air.position, air.velocity
    carried = grown._replace(
        position=Position(
            p.north_m + q.north_m - place.north_m,
            p.east_m + q.east_m - place.east_m,
            p.alt_m + q.alt_m - place.alt_m,
        ),
        velocity=Velocity(
            v.north_m_s + w.north_m_s - velocity.north_m_s,
            v.east_m_s + w.east_m_s - velocity.east_m_s,
            v.down_m_s + w.down_m_s - velocity.down_m_s,
        ),
    )
    flown = (*before.flown, (now_ms, q, w))
    kept = tuple(one for one in flown if lasted(since_ms, one[0], 0))
    return Own(carried, kept)


def fixed(before: Own, fix: Measured) -> Own:
    """After a fix has come, which was made at a step since which the way is known: it is carried on by that way."""
    then = {one[0]: one for one in before.flown}.get(fix.at_ms)
    if then is None:
        return before
    now_ms, place, velocity = before.flown[-1]
    p, v = fix.position, fix.velocity
    carried = fix._replace(
        at_ms=now_ms,
        position=Position(*(a + b - c for a, b, c in zip(p, place, then[1], strict=True))),
        velocity=Velocity(*(a + b - c for a, b, c in zip(v, velocity, then[2], strict=True))),
    )
    return before._replace(estimate=updated(before.estimate, carried))
