"""Vehicles of ours know each other's ways: what is told of them, and how they are predicted along it."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.bridge.text_protocol import (
    HardReset,
    Message,
    SoftReset,
    VelocityOfAnother,
    WayOfAnother,
)
from cratous.core.authority.gate import Gate
from cratous.core.avoidance.manoeuvre import way_along
from cratous.core.avoidance.prediction import Intruder, Piece, first_violation_s, later, meetings
from cratous.core.permit.remainder import hold_at, hold_permits, way_permits
from cratous.core.routing.polylines import Track
from cratous.services.flight.link_lines import way_of_another
from cratous.services.icarous import other_vehicles
from cratous.services.icarous.inbox import MOST_OTHERS, Told, hear
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.other_vehicles import LINK_LOST_MS, Ways, with_ways
from cratous.services.icarous.route_end import cylinder
from cratous.services.icarous.state import Config, State
from cratous.spec.mission import Daa, Position, Velocity

DAA = Daa(VOLUME, buffer=1.25)
CORNER = tuple(Position(n, e, 300.0) for n, e in ((2000.0, -600.0), (2000.0, 0.0), (5000.0, 0.0)))
"""East, and at 0 to the north."""
EAST = Intruder(2, Position(2000.0, -500.0, 300.0), Velocity(0.0, 20.0, 0.0), True)


def heard(lines: list[Message], told: Told | None = None) -> Told:
    told = told or Told()
    for line in lines:
        told = hear(told, line, PROJECTION, 0)
    return told


def reckoned(other: Intruder, told: Told) -> Intruder:
    sensed = Sensed(0, NORTH, ABILITY, (other,), Gate(0, 0, False))
    _, (one,) = with_ways((), told, sensed, DAA, 0.5)
    return one


TOLD = Told(others=((2, CORNER),))


def test_a_way_that_is_told_is_known_once_it_is_whole() -> None:
    lines = way_of_another(2, CORNER, PROJECTION)
    told = heard(lines)
    for place, meant in zip(told.way_of(2), CORNER, strict=True):
        assert math.dist(place, meant) < 0.01
    assert told.way_of(3) == ()
    assert heard(lines[:2], told).way_of(2) == ()
    assert heard([lines[0], lines[2]], told).way_of(2) == ()
    assert heard(way_of_another(2, (), PROJECTION), told).way_of(2) == ()
    assert heard(way_of_another(3, (), PROJECTION), told) == told
    assert heard([HardReset()], told).way_of(2) == ()
    assert heard([SoftReset()], told).way_of(2) == told.way_of(2)


def test_lines_of_two_vehicles_do_not_mix() -> None:
    lines = way_of_another(2, CORNER, PROJECTION)
    other = WayOfAnother(3, 3, 45.0, -120.0, 300.0, 1)
    assert heard([lines[0], other, *lines[1:]]).others == ()


BENT = (CORNER[0], CORNER[2], CORNER[1])


@example([True, True, False, False, False, True, False, False, False], False, 0)
@example([False, False, False, True, False, True, False, False, True], True, 1)
@given(st.lists(st.booleans(), min_size=9, max_size=9), st.booleans(), st.integers(0, 3))
def test_of_lines_that_are_lost_or_mixed_no_way_is_known(
    kept: list[bool], mixed: bool, at: int
) -> None:
    """A way of 2, a heartbeat, another one of 2, and one of 3 among its lines: each as it was told, or not at all."""
    old, new = (way_of_another(2, way, PROJECTION) for way in (CORNER, BENT))
    third = way_of_another(3, CORNER, PROJECTION)
    whole = [heard(lines).way_of(vid) for lines, vid in ((old, 2), (new, 2), (third, 3))]
    later_lines = [*new[:at], *third, *new[at:]] if mixed else [*new, *third]
    sent = [line for line, one in zip(later_lines, kept[3:], strict=True) if one]
    first = [line for line, one in zip(old, kept[:3], strict=True) if one]
    end = Instance(Config(1, DAA, PROJECTION, 500))
    state, _ = end.handle(
        State(told=heard(first)), Sensed(0, NORTH, ABILITY, (), Gate(0, 0, False))
    )
    told = heard(sent, state.told)
    assert told.way_of(2) in ((), *whole[:2])
    assert told.way_of(3) in ((), whole[2])
    if any(line in sent for line in new[1:]):
        assert told.way_of(2) in ((), whole[1]), "the former way is over with any line of the next"


def test_of_more_vehicles_than_there_can_be_the_last_are_known() -> None:
    told = Told()
    for vid in range(10, MOST_OTHERS + 12):
        place = way_of_another(vid, CORNER[:1], PROJECTION)
        told = heard([*place, VelocityOfAnother(vid + 5000, 20.0, 0.0, 0.0)], told)
    assert (len(told.others), len(told.steered)) == (MOST_OTHERS, MOST_OTHERS)
    assert (told.way_of(11), len(told.way_of(12))) == ((), 1)


def test_what_was_told_counts_no_more_while_uxas_is_not_heard() -> None:
    steered = Told(steered=((2, Velocity(-20.0, 0.0, 0.0)),))
    for told in (TOLD, steered):
        for silent_ms, known in ((LINK_LOST_MS, True), (LINK_LOST_MS + 1, False)):
            sensed = Sensed(silent_ms, NORTH, ABILITY, (EAST,), Gate(0, 0, False))
            _, (one,) = with_ways((), told, sensed, DAA, 0.5)
            assert bool(one.way) is known
            assert known or one == EAST


@pytest.mark.parametrize(
    ("course_deg", "along"), [(90, True), (110, True), (130, False), (180, False), (270, False)]
)
def test_one_that_flies_in_another_direction_than_its_way_is_predicted_straight_on(
    course_deg: float, along: bool
) -> None:
    """It crosses a way that is over, or flies it backwards."""
    course = math.radians(course_deg)
    v = Velocity(20.0 * math.cos(course), 20.0 * math.sin(course), 0.0)
    assert bool(reckoned(EAST._replace(velocity=v), TOLD).way) is along


def test_one_that_stands_is_taken_to_stand() -> None:
    still = EAST._replace(velocity=Velocity(0.0, 0.0, 0.0))
    for told in (TOLD, Told(steered=((2, Velocity(-20.0, 0.0, 0.0)),))):
        assert reckoned(still, told) == still


@pytest.mark.parametrize("speed", [0.0, 1e9])
@pytest.mark.parametrize("down", [-1e9, 0.0, 1e9])
def test_one_that_is_told_to_be_steered_as_nothing_flies_is_predicted_as_it_can(
    speed: float, down: float
) -> None:
    """No faster, slower or steeper than the airframe: it neither stops nor is gone at once."""
    one = reckoned(EAST, Told(steered=((2, Velocity(0.0, speed, down)),)))
    north, east, sinks = one.way[-1].velocity
    assert ABILITY.min_speed_m_s <= math.hypot(north, east) <= ABILITY.max_speed_m_s + 1e-9
    assert abs(sinks) <= ABILITY.max_climb_m_s
    assert len(one.way) < 200


def test_one_that_keeps_to_its_way_is_predicted_round_the_corner() -> None:
    one = reckoned(EAST, TOLD)
    assert [piece.velocity for piece in one.way] == [(0, 20, 0), (20, 0, 0)]
    assert later(one, 25.0).position == Position(2000.0, 0.0, 300.0)
    assert later(one, 35.0).position == Position(2200.0, 0.0, 300.0)
    assert later(one, 35.0).way[0].start_s == 0.0


def test_at_each_heartbeat_and_speed_it_is_predicted_on_the_same_way() -> None:
    """Legs are timed once per speed: what it is told of a faster or a later flight is its own."""
    way = (*CORNER[:2], Position(3000.0, 0.0, 330.0), Position(3000.0, 900.0, 330.0))
    sensed, told = Sensed(0, NORTH, ABILITY, (), Gate(0, 0, False)), Told(others=((2, way),))
    ways: Ways = ()
    for beat, speed in enumerate((20.0, 20.0, 25.0, 20.0, 25.0)):
        place = Position(2000.0, -500.0 + 10.0 * beat, 300.0)
        other = Intruder(2, place, Velocity(0.0, speed, 0.0), True)
        ways, (one,) = with_ways(ways, told, sensed._replace(intruders=(other,)), DAA, 0.5)
        legs_m = (500.0 - 10.0 * beat, 1000.0, 900.0)
        assert [p.duration_s for p in one.way] == pytest.approx([m / speed for m in legs_m])
        assert [p.velocity for p in one.way] == [
            pytest.approx(v) for v in ((0, speed, 0), (speed, 0, -0.03 * speed), (0, speed, 0))
        ]
        assert [p.start_s for p in one.way] == pytest.approx(
            [sum(legs_m[:k]) / speed for k in range(3)]
        )
        assert [p.position for p in one.way] == [
            pytest.approx(p) for p in (place, (2000, 0, 300), (3000, 0, 330))
        ]


def test_legs_of_many_routes_are_kept_and_those_at_changing_speeds_are_not() -> None:
    tracks = [Track(tuple(p._replace(alt_m=300.0 + k) for p in CORNER)) for k in range(90)]

    def flown(beats: int, faster_m_s: float) -> list[list[tuple[Piece, ...]]]:
        return [
            [other_vehicles._along(one, 10.0, at(20.0 + beat * faster_m_s)) for one in tracks]
            for beat in range(beats)
        ]

    def at(speed: float) -> Intruder:
        return EAST._replace(velocity=Velocity(0.0, speed, 0.0))

    first, second, third = flown(3, 0.0)
    assert first == second == third
    for one, other in zip(second, third, strict=True):
        assert one[1].velocity is other[1].velocity, "it was timed again"
    flown(10, 0.1)
    known = other_vehicles._timed
    assert len(known) == other_vehicles.MOST_TIMED
    assert not any(legs for (_, speed), (_, legs) in known.items() if speed != 20.0)


@pytest.mark.parametrize(
    ("off", "kept"), [((18.7, 0), True), ((18.8, 0), False), ((0, 3.7), True), ((0, 3.8), False)]
)
def test_one_that_leaves_its_way_is_predicted_straight_on(
    off: tuple[float, float], kept: bool
) -> None:
    """Half of what the buffer leaves: 18.75 m aside, 3.75 m in height."""
    place = EAST.position._replace(north_m=2000.0 + off[0], alt_m=300.0 + off[1])
    assert bool(reckoned(EAST._replace(position=place), TOLD).way) is kept


def test_where_it_is_on_its_way_is_not_looked_for_far_ahead() -> None:
    """The way comes by the same place again: it is there the first time."""
    loop = (
        *CORNER[:2],
        Position(2500.0, -300.0, 300.0),
        CORNER[0],
        Position(2000.0, -100.0, 300.0),
    )
    one = reckoned(EAST, Told(others=((2, loop),)))
    assert len(one.way) == 4


def test_what_is_told_decides_whether_a_loss_is_predicted() -> None:
    """It would cross the own way north, and turns north before it."""
    ahead = way_along(NORTH, (Position(5000.0, 300.0, 300.0),), 300.0).pieces
    places = ((2000.0, -1800.0), (2000.0, -600.0), (5000.0, -600.0))
    way = tuple(Position(*place, 300.0) for place in places)
    straight = Intruder(2, way[0], Velocity(0.0, 20.0, 0.0))
    told = reckoned(straight, Told(others=((2, way),)))
    assert first_violation_s(ahead, straight, VOLUME) is not None
    assert not way_permits(ahead, straight, VOLUME)
    assert first_violation_s(ahead, told, VOLUME) is None
    assert way_permits(ahead, told, VOLUME)


def test_after_its_way_it_is_within_a_circle_about_the_end() -> None:
    end = Position(2000.0, 0.0, 300.0)
    one = reckoned(EAST, Told(others=((2, (CORNER[0], end)),)))
    assert later(one, 100.0) == one._replace(position=end, velocity=Velocity(0, 0, 0), way=())
    small = cylinder(50.0, 30.0)
    for off_m, clear in ((60.0 + one.hold_m, True), (40.0 + one.hold_m, False)):
        hold = hold_at(end._replace(north_m=2000.0 + off_m), 30.0, 90.0)
        assert hold_permits(hold, one, small, 0.0, 0.0) is clear
        assert (first_violation_s((hold,), one, small) is None) is clear


def test_no_instant_is_left_out_where_ways_are_cut() -> None:
    one = reckoned(EAST, TOLD)
    own = tuple(
        Piece(7.0 * k, 7.0, Position(150.0 * k, 0, 300), Velocity(21, 0, 0)) for k in range(40)
    )
    runs = list(meetings(own, one))
    parts = [piece for run, _ in runs for piece in run]
    assert (parts[0].start_s, parts[-1].start_s + parts[-1].duration_s) == (0.0, 280.0)
    for before, behind in pairwise(parts):
        assert before.start_s + before.duration_s == pytest.approx(behind.start_s, abs=1e-9)
    for run, straight_on in runs:
        middle = run[0].start_s + run[0].duration_s / 2
        assert later(straight_on, middle).position == pytest.approx(later(one, middle).position)
    # in no order of time each piece is looked at for each leg
    assert runs == [(run[::-1], straight_on) for run, straight_on in meetings(own[::-1], one)]


@pytest.mark.parametrize(("was_deg", "turns"), [(85, True), (90, False), (95, False), (None, True)])
def test_one_that_is_steered_is_predicted_to_turn_there(was_deg: float | None, turns: bool) -> None:
    """To the south, from the east. One that has turned away since, or has not turned, is taken to fly straight on."""
    told = heard([*way_of_another(2, CORNER, PROJECTION), VelocityOfAnother(2, -20.0, 0.0, 0.0)])
    assert told.way_of(2) == ()
    sensed = Sensed(0, NORTH, ABILITY, (EAST,), Gate(0, 0, False))
    before = () if was_deg is None else ((2, math.radians(was_deg)),)
    _, (one,) = with_ways((), told, sensed, DAA, 0.5, before)
    assert bool(one.way) is turns
    if turns:
        assert one.way[-1].velocity == pytest.approx((-20.0, 0.0, 0.0))
        assert one.way[0].velocity.east_m_s > 19.0
    assert heard(way_of_another(2, CORNER, PROJECTION), told).steered == ()
