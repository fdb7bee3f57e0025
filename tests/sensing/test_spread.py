"""How far an aircraft may be from its prediction, in the prediction and in the permits: no place of it is missed."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.avoidance.prediction import (
    EXACT,
    Intruder,
    Piece,
    Spread,
    after,
    first_violation_s,
    later,
    meetings,
)
from cratous.core.kernel import Vec2
from cratous.core.permit.remainder import way_permits
from cratous.core.well_clear import violation
from cratous.services.icarous.traffic_monitor import courses, loose_courses, turning
from cratous.spec.mission import Position, Velocity, WellClear

VOLUME = WellClear(150.0, 30.0, 15.0, 0.0)
OWN = (
    Piece(0.0, 20.0, Position(0.0, 0.0, 300.0), Velocity(22.0, 0.0, 0.0)),
    Piece(20.0, 40.0, Position(440.0, 0.0, 300.0), Velocity(0.0, 22.0, 0.0)),
)
UNIT = st.floats(-1, 1)
ANGLE = st.floats(0, 2 * math.pi)
SPREAD = st.builds(
    Spread, st.floats(0.1, 80), st.floats(0.01, 4), st.floats(0.1, 30), st.floats(0.01, 2),
    st.sampled_from([30.0, 60.0, math.inf]),
)  # fmt: skip
OTHER = st.builds(
    Intruder,
    st.just(9),
    st.builds(Position, st.floats(-800, 1800), st.floats(-900, 1500), st.floats(230, 370)),
    st.builds(Velocity, st.floats(-30, 30), st.floats(-30, 30), st.floats(-2, 2)),
    cooperates=st.just(False),
    way=st.just(()),
    hold_m=st.just(0.0),
    spread=SPREAD,
)


def true_one(other: Intruder, a: float, b: float, share: float, up: float) -> Intruder:
    """One that is off by so much of the spread as it begins, and of its growth."""
    p, v, s = other.position, other.velocity, other.spread
    place = Position(
        p.north_m + share * s.wide_m * math.cos(a), p.east_m + share * s.wide_m * math.sin(a),
        p.alt_m + up * s.high_m,
    )  # fmt: skip
    fast = Velocity(
        v.north_m_s + share * s.wide_m_s * math.cos(b), v.east_m_s + share * s.wide_m_s * math.sin(b),
        v.down_m_s - up * s.high_m_s,
    )  # fmt: skip
    return other._replace(position=place, velocity=fast, spread=EXACT)


@given(OTHER, ANGLE, ANGLE, st.floats(0, 1), UNIT)
def test_where_one_of_the_spread_is_met_it_is_seen(
    other: Intruder, a: float, b: float, share: float, up: float
) -> None:
    grows_s = other.spread.steady_s
    true = true_one(other, a, b, share, up)
    known = tuple(piece for piece in OWN if piece.start_s + piece.duration_s <= grows_s)
    said = first_violation_s(known, other, VOLUME) is not None
    clear = way_permits(known, other, VOLUME)
    for piece in known:
        for k in range(9):
            at = piece.duration_s * k / 8
            p, q = after(piece, at), later(true, piece.start_s + at).position
            s, sz = Vec2(p.north_m - q.north_m, p.east_m - q.east_m), p.alt_m - q.alt_m
            v, w = piece.velocity, true.velocity
            rel = Vec2(v.north_m_s - w.north_m_s, v.east_m_s - w.east_m_s)
            climb = w.down_m_s - v.down_m_s
            if violation(s, rel, sz, climb, 150.0, 30.0, 15.0, 0.0):
                assert said
            if math.hypot(*s) < 149.999 and abs(sz) < 29.999:
                assert not clear


@given(OTHER, st.lists(st.floats(0, 90), min_size=2, max_size=2))
def test_a_spread_grows_until_it_is_steady(other: Intruder, times: list[float]) -> None:
    soon, late = sorted(times)
    one = other.spread
    assert tuple(one.after(late)) == pytest.approx(tuple(one.after(soon).after(late - soon)))
    at = min(late, one.steady_s)
    assert one.after(late).wide_m == pytest.approx(one.wide_m + at * one.wide_m_s)
    assert later(other, late).spread == one.after(late)
    for run, straight_on in meetings(OWN, other):
        start = run[0].start_s
        now, then = straight_on.spread.after(start), one.after(start)
        assert (now.wide_m, now.high_m) == pytest.approx((then.wide_m, then.high_m))
        assert now.wide_m_s == (one.wide_m_s if start < one.steady_s else 0.0)
        place = after(Piece(0, 0, *straight_on[1:3]), start)
        assert tuple(place) == pytest.approx(tuple(later(other, start).position))


def test_one_that_is_exact_is_met_as_before_and_one_that_is_not_sooner() -> None:
    other = Intruder(9, Position(900.0, 0.0, 300.0), Velocity(-10.0, 0.0, 0.0))
    exact = first_violation_s(OWN, other, VOLUME)
    spread = first_violation_s(OWN, other._replace(spread=Spread(30, 1, 10, 0.5)), VOLUME)
    assert exact is not None
    assert spread is not None
    assert spread < exact
    beside = other._replace(position=Position(440.0, 60.0, 345.0))
    assert way_permits(OWN[:1], beside, VOLUME)
    assert not way_permits(OWN[:1], beside._replace(spread=Spread(1, 0, 16, 0)), VOLUME)
    assert way_permits(OWN[:1], beside._replace(spread=Spread(1, 0, 14, 0)), VOLUME)


def test_a_course_that_is_off_by_no_more_than_is_known_is_no_turn() -> None:
    east = Intruder(9, Position(0.0, 0.0, 300.0), Velocity(0.0, 20.0, 0.0))
    other = east._replace(velocity=Velocity(1.0, 20.0, 0.0))
    assert turning(courses((other,)), courses((east,)), 0.5) == {9}
    known = other._replace(spread=Spread(5.0, 1.0, 5.0, 0.5))
    assert turning(courses((known,)), courses((east,)), 0.5, loose_courses((known,))) == frozenset()
    assert loose_courses((east,)) == ()
