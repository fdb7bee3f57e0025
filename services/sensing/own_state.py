"""The own state: GPS fixes, propagated by the inertial unit, which measures the motion since.

The unit is assumed exact over a step except for a drift, which is the noise of the filter. Before the first
fix the vehicle knows its initial state with the accuracy of a fix.
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
"""Drift of the inertial unit's velocity per second [m/s2]."""


class Own(NamedTuple):
    """The vehicle's knowledge of itself. estimate: for now; flown: its recent path by the inertial unit,
    oldest first: (time [ms], position, velocity).
    """

    estimate: Estimate
    flown: tuple[tuple[int, Position, Velocity], ...]


def first(sensor: Sensor, now_ms: int, air: Flown) -> Own:
    """The initial estimate of the own state at now_ms [ms]."""
    start = measured(sensor, now_ms, air.position, air.velocity)
    return Own(Estimate(*start), ((now_ms, air.position, air.velocity),))


def moved(before: Own, now_ms: int, air: Flown, since_ms: int) -> Own:
    """The own state after further flight, as measured by the inertial unit.

    since_ms: time of the oldest fix still in transit; the path before it is dropped.
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
    """The own state after a fix, propagated from its time to now along the recorded path; ignored if that is
    missing.
    """
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
