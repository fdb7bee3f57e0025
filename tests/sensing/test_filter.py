"""The filter against a Kalman filter of six dimensions, written with matrices, and the own state between fixes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.authority.gate import Gate
from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Spread
from cratous.services.icarous.messages import Sensed
from cratous.services.sensing import own_state as own_state
from cratous.services.sensing.filter import (
    Estimate,
    Flown,
    Measured,
    begun,
    deviations,
    folded,
    later,
    measured,
)
from cratous.services.sensing.surveillance import (
    Carrier,
    Shown,
    Surveillance,
    arrived,
    exactly,
    stepped,
)
from cratous.services.sensing.surveillance import given as given_to
from cratous.spec.mission import Position, Velocity
from cratous.spec.mission.sensing import Sensing, Sensor, SensorKind

Matrix = np.ndarray
EVERY = st.floats(0.1, 50)
PLACE = st.tuples(*[st.floats(-2000, 2000)] * 3).map(lambda p: Position(*p))
SPEED = st.tuples(*[st.floats(-40, 40)] * 3).map(lambda v: Velocity(*v))
SEEN = st.tuples(st.integers(0, 3000), EVERY, EVERY, EVERY, PLACE, SPEED)


def state_of(position: Position, velocity: Velocity) -> Matrix:
    """North, east, up; north, east, up."""
    return np.array([*position, velocity[0], velocity[1], -velocity[2]])


def by_matrices(seen: list[Measured], at_ms: int, manoeuvre: float) -> tuple[Matrix, Matrix]:
    """State and covariance: the textbook's prediction, and the update in information form."""

    def noise(one: Measured) -> Matrix:
        places = [one.wide.place, one.wide.place, one.high.place]
        return np.diag([*places, one.wide.velocity, one.wide.velocity, one.high.velocity])

    def moved(x: Matrix, p: Matrix, dt: float) -> tuple[Matrix, Matrix]:
        eye, zero = np.eye(3), np.zeros((3, 3))
        f = np.block([[eye, dt * eye], [zero, eye]])
        q = manoeuvre**2 * np.block(
            [[dt**3 / 3 * eye, dt**2 / 2 * eye], [dt**2 / 2 * eye, dt * eye]]
        )
        return f @ x, f @ p @ f.T + q

    first = seen[0]
    x, p, now = state_of(first.position, first.velocity), noise(first), first.at_ms
    for one in seen[1:]:
        x, p = moved(x, p, (one.at_ms - now) / 1000)
        there = np.linalg.inv(p) + np.linalg.inv(noise(one))
        seen_x = state_of(one.position, one.velocity)
        x = np.linalg.solve(there, np.linalg.solve(p, x) + np.linalg.solve(noise(one), seen_x))
        p, now = np.linalg.inv(there), one.at_ms
    return moved(x, p, (at_ms - now) / 1000)


def made(rows: list[tuple[int, float, float, float, Position, Velocity]]) -> list[Measured]:
    """Measurements, one after the other, each so many ms after the one before."""
    found, at = [], 0
    for gap, wide, high, fast, place, velocity in rows:
        at += gap
        found.append(measured(Sensor(SensorKind.ADSB, wide, high, fast), at, place, velocity))
    return found


@given(st.lists(SEEN, min_size=1, max_size=6), st.integers(0, 4000), st.floats(0.05, 5))
def test_it_is_the_filter_of_six_dimensions(
    rows: list[tuple[int, float, float, float, Position, Velocity]], gap: int, manoeuvre: float
) -> None:
    seen = made(rows)
    at = seen[-1].at_ms + gap
    found = later(folded(begun(seen[0]), seen[1:], manoeuvre), at, manoeuvre)
    x, p = by_matrices(seen, at, manoeuvre)
    assert state_of(found.position, found.velocity) == pytest.approx(x, rel=1e-5, abs=1e-3)
    for cov, k in ((found.wide, 0), (found.wide, 1), (found.high, 2)):
        assert tuple(cov) == pytest.approx((p[k, k], p[k, k + 3], p[k + 3, k + 3]), rel=1e-5)
    assert deviations(found.high) == pytest.approx(np.sqrt([p[2, 2], p[5, 5]]), rel=1e-5)
    # north tells nothing of east or up
    assert abs(p[0, 1]) + abs(p[0, 2]) + abs(p[0, 4]) == pytest.approx(0, abs=1e-6)


def test_a_late_fix_is_carried_on_by_the_way_flown_since() -> None:
    gps = Sensor(SensorKind.GPS, 2.0, 3.0, 0.2, latency_ms=500)

    def at(t_ms: int) -> Flown:
        """A half circle in 10 s at 20 m/s."""
        turn = math.pi * t_ms / 10_000
        radius = 200 / math.pi
        place = Position(radius * math.sin(turn), radius * (1 - math.cos(turn)), 300.0)
        return Flown(place, Velocity(20 * math.cos(turn), 20 * math.sin(turn), 0.0))

    own = own_state.first(gps, 0, at(0))
    for now in range(250, 10_001, 250):
        own = own_state.moved(own, now, at(now), now - gps.latency_ms)
        if now >= 500:
            then = at(now - 500)
            own = own_state.fixed(own, measured(gps, now - 500, *then))
        assert own.estimate.position == pytest.approx(at(now).position, abs=1e-6)
        assert own.estimate.velocity == pytest.approx(at(now).velocity, abs=1e-6)
    assert isinstance(own.estimate, Estimate)
    # 39 fixes tell more than one
    assert deviations(own.estimate.wide)[0] < 1.0
    assert len(own.flown) == 3


@pytest.mark.parametrize("latency_ms", [0, 100, 250, 700, 1300])
def test_a_fix_that_is_used_later_than_it_comes_still_corrects_the_own_state(
    latency_ms: int,
) -> None:
    gps = Sensor(SensorKind.GPS, 3.0, 5.0, 0.3, latency_ms=latency_ms)
    sensing = Sensing((gps, Sensor(SensorKind.ADSB, 10.0, 8.0, 1.0)))
    carrier, now = Carrier(1, sensing, 60.0, 0, 250, frozenset({1})), Surveillance()
    for time_ms in range(0, 60_001, 250):
        air = Flown(Position(0.022 * time_ms, 0.0, 300.0), Velocity(22.0, 0.0, 0.0))
        now = stepped(carrier, now, time_ms, {1: air})
        if time_ms % 1000 == 0:  # the heartbeat, at which no fix of 100 ms comes just then
            now = arrived(carrier, now, time_ms)
    assert now.own is not None
    # sixty fixes of 3 m and 0.3 m/s; a minute of the drift alone would be 22 m
    assert deviations(now.own.estimate.wide)[0] < 1.0
    assert math.dist(now.own.estimate.position[:2], (1320.0, 0.0)) < 4.0
    assert len(now.own.flown) <= 2 + (latency_ms + 1000) // 250, "nothing is kept for ever"


@pytest.mark.parametrize(
    ("off", "low", "high"), [(0.0, 30.0, 30.0), (2.0, 28.0, 32.0), (9.0, 25.0, 35.0)]
)
def test_the_speed_that_is_sensed_is_moved_into_the_limits_by_no_more_than_its_bound(
    off: float, low: float, high: float
) -> None:
    carrier = Carrier(1, Sensing(()), 60.0, 0, 250, frozenset())
    fast = Flown(Position(0.0, 0.0, 300.0), Velocity(18.0, 24.0, 0.0))
    seen = (Shown(1, 1, exactly(0, fast), Spread(wide_m_s=off)),)
    for limits, wanted in (((15.0, 25.0), low), ((35.0, 40.0), high)):
        ability = Ability(0.2, *limits, 5.0, 2.0, 0.0)
        true = Sensed(0, Motion(fast.position, 0.0, 20.0, 0.0), ability, (), Gate(0, 0, False))
        assert given_to(carrier, seen, true).motion.speed_m_s == pytest.approx(wanted)
