"""What is left out of the look-ahead cannot come near: leaving it out changes no answer."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, VOLUME

from cratous.core.authority.gate import Gate
from cratous.core.avoidance.manoeuvre import Motion, way_along
from cratous.core.avoidance.prediction import (
    EXACT,
    Intruder,
    Piece,
    Spread,
    _first_of_straight,
    first_violation_s,
    meetings,
    ways_out_of_reach,
)
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.other_vehicles import to_their_ends, with_ways
from cratous.spec.mission import Daa, Position, Velocity

PLACES = st.builds(
    Position,
    st.floats(-4000, 4000),
    st.floats(-4000, 4000),
    st.sampled_from((300.0, 320.0, 500.0)),
)
WAYS = st.lists(PLACES, min_size=2, max_size=7)
SPREADS = st.sampled_from((EXACT, Spread(50.0, 1.0, 10.0, 0.2, 20.0), Spread(80.0, 2.0, 5.0, 0.1)))


def flown(points: list[Position], speed_m_s: float, horizon_s: float) -> tuple[Piece, ...]:
    now = Motion(points[0], 0.3, speed_m_s, 0.0)
    return way_along(now, points[1:], horizon_s).pieces


def without_leaving_out(pieces: tuple[Piece, ...], other: Intruder) -> float | None:
    """Every run of pieces and leg is asked about."""
    found = (_first_of_straight(run, leg, VOLUME, 6) for run, leg in meetings(pieces, other))
    return next((at_s for at_s in found if at_s is not None), None)


@given(WAYS, WAYS, SPREADS, st.sampled_from((60.0, 180.0)), st.sampled_from((18.0, 45.0)))
def test_no_loss_is_left_out(
    own: list[Position], its: list[Position], spread: Spread, horizon_s: float, speed: float
) -> None:
    pieces, way = flown(own, 25.0, horizon_s), flown(its, speed, 120.0)
    velocity = way[0].velocity if way else Velocity(speed, 0.0, 0.0)
    other = Intruder(2, its[0], velocity, True, way, 150.0 if way else 0.0, spread)
    found = without_leaving_out(pieces, other)
    assert first_violation_s(pieces, other, VOLUME) == found
    if pieces and ways_out_of_reach(pieces, other, VOLUME):
        assert found is None


def test_pieces_that_are_over_as_the_intruder_begins_meet_nobody() -> None:
    over = (Piece(0.0, 0.0, Position(0.0, 0.0, 300.0), Velocity(25.0, 0.0, 0.0)),)
    begun = (Piece(0.0, 10.0, Position(5.0, 0.0, 300.0), Velocity(25.0, 0.0, 0.0)),)
    for way, spread in ((begun, EXACT), ((), Spread(50.0, 1.0, 10.0, 0.2, 20.0))):
        other = Intruder(2, Position(5.0, 0.0, 300.0), begun[0].velocity, True, way, 0.0, spread)
        assert first_violation_s(over, other, VOLUME) is None


def test_ways_far_apart_are_out_of_reach_as_wholes() -> None:
    """So that the test above is one of something."""
    own = flown([Position(0.0, 0.0, 300.0), Position(5000.0, 0.0, 300.0)], 25.0, 180.0)
    for east_m, out in ((500.0, False), (8000.0, True)):
        way = flown([Position(0.0, east_m, 300.0), Position(9000.0, east_m, 300.0)], 25.0, 300.0)
        other = Intruder(2, way[0].position, way[0].velocity, True, way, 100.0)
        assert ways_out_of_reach(own, other, VOLUME) is out


@given(st.lists(PLACES, min_size=2, max_size=30, unique=True), st.floats(1.0, 200.0))
def test_a_way_for_a_while_is_the_begin_of_that_to_its_end(
    way: list[Position], until_s: float
) -> None:
    first, then = way[0], way[1]
    course = math.atan2(then.east_m - first.east_m, then.north_m - first.north_m)
    v = Velocity(25.0 * math.cos(course), 25.0 * math.sin(course), 0.0)
    sensed = Sensed(0, NORTH, ABILITY, (Intruder(2, first, v, True),), Gate(0, 0, False))
    told, daa = Told(others=((2, tuple(way)),)), Daa(VOLUME, buffer=1.25)
    _, whole = with_ways((), told, sensed, daa, 0.5)
    ways, begun = with_ways((), told, sensed, daa, 0.5, (), until_s)
    legs, all_legs = begun[0].way, whole[0].way
    assert legs == all_legs[: len(legs)]
    if len(legs) < len(all_legs):
        assert legs[-1].start_s + legs[-1].duration_s > until_s - 1e-9
    assert to_their_ends(ways, begun) == whole
