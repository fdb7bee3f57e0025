"""A Kalman filter for position and velocity of an aircraft in straight flight with slowly drifting velocity.

A sensor's errors are the same in north and east, and independent, so the six-dimensional filter separates
into three of two dimensions, position and velocity along an axis; both horizontal ones have the same
covariance. Its entries are those of a 2 by 2 matrix: position [m2], cross term, and velocity [m2/s2].
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from cratous.spec.mission import Position, Velocity
from cratous.spec.mission.sensing import Sensor


class Flown(NamedTuple):
    """The true position and velocity of an aircraft."""

    position: Position
    velocity: Velocity


class Cov(NamedTuple):
    """Covariance of position and velocity along an axis."""

    place: float
    both: float
    velocity: float


class Measured(NamedTuple):
    """A position and a velocity measured at an instant [ms], with the covariances of their errors."""

    at_ms: int
    position: Position
    velocity: Velocity
    wide: Cov
    high: Cov


class Estimate(NamedTuple):
    """Estimated state of an aircraft at an instant [ms], with covariances along north and east, and in
    altitude.
    """

    at_ms: int
    position: Position
    velocity: Velocity
    wide: Cov
    high: Cov


def measured(sensor: Sensor, at_ms: int, position: Position, velocity: Velocity) -> Measured:
    """A sensor's measurement with its error covariances."""
    speed = sensor.velocity_m_s**2
    wide, high = Cov(sensor.horizontal_m**2, 0.0, speed), Cov(sensor.vertical_m**2, 0.0, speed)
    return Measured(at_ms, position, velocity, wide, high)


def begun(first: Measured) -> Estimate:
    """The estimate after a first measurement."""
    return Estimate(*first)


def later(known: Estimate, at_ms: int, manoeuvre_m_s2: float) -> Estimate:
    """The estimate predicted to a later instant: straight flight, with grown covariance."""
    dt_s = (at_ms - known.at_ms) / 1000
    p, v = known.position, known.velocity
    place = Position(
        p.north_m + v.north_m_s * dt_s, p.east_m + v.east_m_s * dt_s, p.alt_m - v.down_m_s * dt_s
    )
    wide, high = (_grown(c, dt_s, manoeuvre_m_s2) for c in (known.wide, known.high))
    return Estimate(at_ms, place, v, wide, high)


def _grown(cov: Cov, dt: float, manoeuvre: float) -> Cov:
    """Covariance growth by white acceleration noise: after one second the velocity has changed by
    `manoeuvre`.
    """
    q = manoeuvre**2
    return Cov(
        cov.place + 2 * dt * cov.both + dt**2 * cov.velocity + q * dt**3 / 3,
        cov.both + dt * cov.velocity + q * dt**2 / 2,
        cov.velocity + q * dt,
    )


def updated(known: Estimate, seen: Measured) -> Estimate:
    """The estimate after a measurement of the same instant."""
    wide, to_place, to_velocity = _corrected(known.wide, seen.wide)
    high, up_place, up_velocity = _corrected(known.high, seen.high)
    p, v, q, w = known.position, known.velocity, seen.position, seen.velocity
    north, east = (
        (q.north_m - p.north_m, w.north_m_s - v.north_m_s),
        (
            q.east_m - p.east_m,
            w.east_m_s - v.east_m_s,
        ),
    )
    up = q.alt_m - p.alt_m, v.down_m_s - w.down_m_s
    place = Position(
        p.north_m + _times(to_place, north),
        p.east_m + _times(to_place, east),
        p.alt_m + _times(up_place, up),
    )
    velocity = Velocity(
        v.north_m_s + _times(to_velocity, north),
        v.east_m_s + _times(to_velocity, east),
        v.down_m_s - _times(up_velocity, up),
    )
    return Estimate(known.at_ms, place, velocity, wide, high)


Row = tuple[float, float]


def _times(row: Row, off: Row) -> float:
    return row[0] * off[0] + row[1] * off[1]


def _corrected(p: Cov, r: Cov) -> tuple[Cov, Row, Row]:
    """The covariance after a measurement with independent position and velocity errors, and the rows of the
    gain.
    """
    a, b, c = p
    det = (a + r.place) * (c + r.velocity) - b * b
    place, velocity = a * (c + r.velocity) - b * b, c * (a + r.place) - b * b
    to_place = place / det, b * r.place / det
    to_velocity = b * r.velocity / det, velocity / det
    after = Cov(place * r.place / det, b * r.place * r.velocity / det, velocity * r.velocity / det)
    return after, to_place, to_velocity


def folded(known: Estimate, seen: Iterable[Measured], manoeuvre_m_s2: float) -> Estimate:
    """The estimate after measurements, in order of time."""
    for one in seen:
        known = updated(later(known, one.at_ms, manoeuvre_m_s2), one)
    return known


def deviations(cov: Cov) -> tuple[float, float]:
    """Standard deviations of position [m] and velocity [m/s]."""
    return math.sqrt(cov.place), math.sqrt(cov.velocity)
