"""In units in which every number is whole a permit says what it says of the doubles."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core.avoidance.prediction import Intruder
from cratous.core.avoidance.prediction import Piece as Flown
from cratous.core.kernel import Vec2
from cratous.core.permit.pieces import Growth, Meeting, Piece, permitted
from cratous.core.permit.remainder import way_permits
from cratous.core.permit.whole_numbers import in_whole_numbers
from cratous.core.readings.exact import exact
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, Velocity, WellClear

PLACES, SPEEDS = st.floats(-2000, 2000), st.floats(-40, 40) | st.just(1.3e-15)
LENGTHS, TIMES, RATES = st.floats(0, 300), st.floats(0, 60), st.floats(0, 2)
GROWTHS = st.builds(Growth, LENGTHS, RATES, st.floats(0, 0.1) | st.just(0.0))
VELOCITIES = st.builds(Vec2, SPEEDS, SPEEDS)
PIECES = st.lists(st.builds(Piece, VELOCITIES, SPEEDS, TIMES, LENGTHS), min_size=1, max_size=4)
MEETINGS = st.builds(
    Meeting, st.builds(Vec2, PLACES, PLACES), PLACES, VELOCITIES, SPEEDS, GROWTHS, GROWTHS,
    LENGTHS, LENGTHS,
)  # fmt: skip
STEADY = Growth(0.0, 0.0, 0.0)


@settings(max_examples=200, deadline=None)
@given(PIECES, MEETINGS)
def test_the_verdict_is_that_of_the_doubles(pieces: list[Piece], met: Meeting) -> None:
    moved, whole = in_whole_numbers([tuple(piece) for piece in pieces], met)
    flat = [x for v, *rest in moved for x in (*v, *rest)]
    assert all(isinstance(x, int) for x in flat)
    assert exact(permitted, moved, whole) == exact(permitted, pieces, met)


def test_touching_is_told_from_the_next_double() -> None:
    found = []
    for east in (150.0, math.nextafter(150.0, 151.0)):
        flight = [(Vec2(22.0, 0.0), 0.0, 60.0, 0.0)]
        met = Meeting(Vec2(-660.0, east), 0.0, Vec2(0.0, 0.0), 0.0, STEADY, STEADY, 150.0, 30.0)
        found.append(exact(permitted, *in_whole_numbers(flight, met)))
    assert found == [False, True]


def test_units_are_powers_of_two() -> None:
    flight = [(Vec2(0.5, 0.25), 0.0, 0.125, 3.0)]
    met = Meeting(Vec2(8.0, 0.75), 1.0, Vec2(0.0, 0.0), 0.0, STEADY, STEADY, 150.0, 30.0)
    moved, whole = in_whole_numbers(flight, met)
    (v, _, time, rho), length = moved[0], whole.s.x // 8
    assert (v.x, v.y, time, rho, whole.s.y) == (4, 2, 1, 3 * length, 3 * length // 4)
    # an eighth of a second, and of a metre a second: a unit of length is what is flown in it
    assert length == 8 * 8


@pytest.mark.parametrize("wrong", [math.inf, math.nan])
def test_what_is_not_finite_is_refused(wrong: float) -> None:
    pieces = (Flown(0.0, 60.0, Position(wrong, 0.0, 300.0), Velocity(22.0, 0.0, 0.0)),)
    other = Intruder(2, Position(0.0, 0.0, 300.0), Velocity(0.0, 22.0, 0.0))
    with pytest.raises((BadInput, ValueError)):
        way_permits(pieces, other, WellClear(150.0, 30.0, 15.0, 0.0))
