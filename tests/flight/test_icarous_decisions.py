"""Detection, resolution and return of one ICAROUS instance; who acts, and when."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME, WIDE, head_on

from cratous.core.authority.cycle import patience
from cratous.core.authority.gate import Gate
from cratous.core.avoidance.manoeuvre import along, fly_to, velocity_of
from cratous.core.avoidance.prediction import Intruder, Piece, after, first_violation_s
from cratous.core.avoidance.resolution import Scene, first_conflict_s, resolve
from cratous.core.geofence.mission_legs import leg_ok
from cratous.services.icarous.foresight import predicted, way_back_is_free
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.permits import NONE
from cratous.services.icarous.proposal import describe
from cratous.services.icarous.return_to_path import PERSIST_MS as FREE_MS
from cratous.services.icarous.return_to_path import goal_index
from cratous.services.icarous.route_end import Ahead
from cratous.services.icarous.state import Config, Met, State
from cratous.services.icarous.traffic_monitor import (
    PERSIST_MS,
    last_time_s,
    most_urgent,
    nearest,
    threats,
    turning,
)
from cratous.spec.mission import Daa, Position, Velocity, WellClear, Zone, ZoneKind


def straight(duration_s: float = 60.0) -> tuple[Piece, ...]:
    return (Piece(0.0, duration_s, NORTH.position, velocity_of(0.0, 22.0, 0.0)),)


def test_time_of_the_first_violation() -> None:
    # closing at 44 m/s; tau_mod = (range^2 - DTHR^2) / (range v) <= TTHR from this range on
    v, d, tau = 44.0, VOLUME.dthr_m, VOLUME.tthr_s
    entry = (tau * v + math.sqrt((tau * v) ** 2 + 4 * d * d)) / 2
    found = first_violation_s(straight(), head_on(2500.0), VOLUME, halvings=20)
    assert found == pytest.approx((2500.0 - entry) / v, abs=1e-3)


def test_no_violation_beyond_reach_or_in_another_layer() -> None:
    assert first_violation_s(straight(), head_on(9000.0), VOLUME) is None
    other = head_on(2500.0)
    other = other._replace(position=other.position._replace(alt_m=340.0))
    assert first_violation_s(straight(), other, VOLUME) is None


@given(
    st.floats(-3000, 3000),
    st.floats(-3000, 3000),
    st.floats(-40, 40),
    st.floats(-40, 40),
)
def test_pieces_of_one_flight_find_what_the_whole_finds(
    north: float, east: float, vn: float, ve: float
) -> None:
    """Cutting a straight flight into pieces changes neither whether nor (much) when."""
    other = Intruder(9, Position(north, east, 300.0), Velocity(vn, ve, 0.0))
    whole = first_violation_s(straight(), other, VOLUME, halvings=20)
    v = velocity_of(0.0, 22.0, 0.0)
    cut = tuple(Piece(k * 1.0, 1.0, Position(22.0 * k, 0.0, 300.0), v) for k in range(60))
    pieces = first_violation_s(cut, other, VOLUME, halvings=20)
    if whole is not None and pieces is not None:
        assert whole == pytest.approx(pieces, abs=1e-2)
    elif whole != pieces:
        # only at the very edge of the volume may rounding tell them apart
        grown = WellClear(150.001, 30.0, 15.001, 0.0)
        shrunk = WellClear(149.999, 30.0, 14.999, 0.0)
        assert first_violation_s(straight(), other, grown) is not None
        assert first_violation_s(straight(), other, shrunk) is None


@given(st.floats(-math.pi, math.pi), st.floats(15, 33), st.floats(-4, 4))
def test_manoeuvre_is_connected_and_within_the_limits(
    heading: float, speed: float, climb: float
) -> None:
    pieces = fly_to(NORTH, ABILITY, heading, speed, climb, 10.0, 60.0)
    assert sum(p.duration_s for p in pieces) == pytest.approx(60.0)
    for a, b in itertools.pairwise(pieces):
        assert after(a, a.duration_s) == pytest.approx(b.position, abs=1e-9)
        assert a.start_s + a.duration_s == pytest.approx(b.start_s)
        turn = math.remainder(
            math.atan2(b.velocity.east_m_s, b.velocity.north_m_s)
            - math.atan2(a.velocity.east_m_s, a.velocity.north_m_s),
            2 * math.pi,
        )
        assert abs(turn) <= ABILITY.turn_rate_rad_s * 0.5 + 1e-6
    v = pieces[-1].velocity
    assert math.hypot(v.north_m_s, v.east_m_s) == pytest.approx(speed)


def test_along_passes_the_points_in_time() -> None:
    points = (Position(440.0, 0.0, 300.0), Position(440.0, 220.0, 320.0))
    pieces = along(NORTH, points, 60.0)
    assert pieces[1].start_s == pytest.approx(20.0)
    assert pieces[2].position == pytest.approx(points[1])
    assert pieces[2].velocity.down_m_s == 0.0
    assert sum(p.duration_s for p in pieces) == pytest.approx(60.0)


@settings(max_examples=60, deadline=None)
@given(
    st.floats(0, 2 * math.pi),
    st.floats(15, 30),
    st.floats(35, 60),
    st.floats(-200, 200),
)
def test_a_clear_choice_is_clear_and_the_nearest_to_the_course(
    course: float, speed: float, meet_s: float, miss_m: float
) -> None:
    """Whatever comes from wherever, far enough away: the choice holds when it is checked again."""
    at = Position(22.0 * meet_s, miss_m, 300.0)
    v = velocity_of(course, speed, 0.0)
    start = Position(at.north_m - v.north_m_s * meet_s, at.east_m - v.east_m_s * meet_s, 300.0)
    other = Intruder(9, start, v)
    scene = Scene((other,), (), WIDE, 60.0)
    choice = resolve(NORTH, ABILITY, scene, 0.0, 22.0, None)
    flown = fly_to(
        NORTH,
        ABILITY,
        choice.heading_rad,
        choice.speed_m_s,
        choice.climb_m_s,
        choice.climb_for_s,
        60.0,
    )
    if choice.clear:
        assert first_conflict_s(flown, scene) is None
    else:
        assert first_conflict_s(flown, scene) == pytest.approx(choice.first_violation_s)
    if choice.clear and choice.kind == "heading":
        for k in range(round(abs(math.degrees(choice.heading_rad)) / 5)):
            for side in (1, -1):
                nearer = fly_to(NORTH, ABILITY, side * math.radians(5 * k), 22.0, 0.0, 0.0, 60.0)
                assert first_conflict_s(nearer, scene) is not None


def test_no_conflict_no_deviation() -> None:
    choice = resolve(NORTH, ABILITY, Scene((), (), WIDE, 60.0), 0.3, 22.0, None)
    assert (choice.heading_rad, choice.clear) == (0.3, True)


def test_manoeuvre_keeps_off_a_zone_beside() -> None:
    """A wall to the right: the turn goes left, though a turn to the right would come first."""
    wall = Zone(
        1,
        ZoneKind.KEEP_OUT,
        ((-200.0, 40.0), (3000.0, 40.0), (3000.0, 2000.0), (-200.0, 2000.0)),
        0.0,
        1000.0,
    )
    scene = Scene((head_on(2000.0),), (wall,), WIDE, 60.0)
    choice = resolve(NORTH, ABILITY, scene, 0.0, 22.0, None)
    assert choice.clear
    assert math.remainder(choice.heading_rad, 2 * math.pi) < 0
    pieces = fly_to(NORTH, ABILITY, choice.heading_rad, 22.0, 0.0, 0.0, 60.0)
    assert all(leg_ok(p.position, after(p, p.duration_s), wall) for p in pieces)


def test_between_walls_it_climbs() -> None:
    walls = tuple(
        Zone(
            k,
            ZoneKind.KEEP_OUT,
            ((-900.0, a), (4000.0, a), (4000.0, b), (-900.0, b)),
            0.0,
            1000.0,
        )
        for k, a, b in ((1, 30.0, 2000.0), (2, -2000.0, -30.0))
    )
    behind = Intruder(8, Position(-1500.0, 0.0, 300.0), Velocity(30.0, 0.0, 0.0))
    scene = Scene((head_on(2400.0), behind), walls, WIDE, 60.0)
    choice = resolve(NORTH, ABILITY, scene, 0.0, 22.0, None)
    assert (choice.kind, choice.clear) == ("altitude", True)


def test_when_nothing_is_free_it_says_so() -> None:
    ring = tuple(
        Intruder(
            20 + k,
            Position(300 * math.cos(a), 300 * math.sin(a), 300.0),
            velocity_of(a + math.pi, 22.0, 0.0),
        )
        for k, a in enumerate(math.radians(30 * k) for k in range(12))
    )
    stuck = ABILITY._replace(max_climb_m_s=0.0)
    choice = resolve(NORTH, stuck, Scene(ring, (), WIDE, 60.0), 0.0, 22.0, None)
    assert not choice.clear
    assert "no manoeuvre is free" in describe(choice)


# ---- who acts, and when --------------------------------------------------------------------------


LIMITS = nearest(ABILITY, WIDE, 500)
AHEAD = Ahead(straight(), (WIDE,))


def seen(own: int, other: Intruder, since_ms: int | None, in_turn: bool = False) -> bool:
    """Whether vehicle `own` acts now on a threat first seen at since_ms (None: just now)."""
    before = threats(own, AHEAD, (other,), (), since_ms or 0, LIMITS)
    now_ms = 10_000
    found = threats(
        own,
        AHEAD,
        (other,),
        before if since_ms is not None else (),
        now_ms,
        LIMITS,
        frozenset({other.id}) if in_turn else frozenset(),
    )
    assert found
    return most_urgent(found) is not None


def test_a_far_threat_must_persist() -> None:
    far = head_on(2900.0)
    assert not seen(2, far, None)
    assert seen(2, far, 10_000 - PERSIST_MS)


def test_a_near_threat_counts_at_once() -> None:
    assert seen(2, head_on(1900.0), None)


def test_the_one_with_the_right_of_way_waits_until_the_last_time() -> None:
    far, near = head_on(2900.0, 9, True), head_on(1900.0, 9, True)
    assert seen(12, far, 0)
    assert not seen(2, far, 0)
    assert seen(2, near, None)


def test_an_intruder_in_a_turn_is_given_time_to_turn_past() -> None:
    near, very_near = head_on(1900.0), head_on(1100.0)
    assert not seen(2, near, None, in_turn=True)
    assert seen(2, very_near, None, in_turn=True)
    assert seen(2, near, 0, in_turn=True)


def test_last_time_is_the_derivation() -> None:
    assert last_time_s(ABILITY, WIDE, 500) == pytest.approx(math.pi / 2 / 0.26 + 18.75 + 1.0)


def test_persistence_doubles_with_relapses() -> None:
    assert [patience(k, FREE_MS) for k in (0, 1, 2, 9)] == [1500, 3000, 6000, 24000]


def test_goal_is_ahead_and_not_too_near() -> None:
    line = tuple(Position(100.0 * k, 0.0, 300.0) for k in range(10))
    assert goal_index(NORTH, 85.0, line, 1) == 3
    past = NORTH._replace(position=Position(450.0, 300.0, 300.0))
    assert goal_index(past, 85.0, line, 1) == 5
    assert goal_index(NORTH._replace(position=Position(2000.0, 0.0, 300.0)), 85.0, line, 1) == 9


# ---- what is predicted of whom -------------------------------------------------------------------

CONFIG = Config(1, Daa(VOLUME), PROJECTION, 500)
WAY = (Position(-1000.0, 0.0, 300.0), Position(100.0, 0.0, 300.0), Position(100.0, 900.0, 300.0))


@pytest.mark.parametrize(
    ("next_index", "north_m", "east_m", "pieces"),
    [
        (0, 0.0, 0.0, -1),  # not on its way to a waypoint yet: straight on
        (1, 0.0, 0.0, 2),  # along both legs that are left
        (1, 0.0, 29.9, 2),
        (1, 0.0, -30.1, -1),  # off the path
        (1, 89.1, 0.0, 1),  # the next waypoint is as good as reached: 10.9 m at 22 m/s
        (1, 88.9, 0.0, 2),
        (2, 101.0, 895.0, 1),  # but the last one is flown to
        (2, 100.0, 899.9, 0),  # at the last one: it holds there
        (3, 100.0, 943.9, 0),  # just past the last: it holds
        (3, 100.0, 944.1, -1),
        (3, 0.0, 0.0, -1),  # far past the last
    ],
)
def test_which_way_is_predicted(
    next_index: int, north_m: float, east_m: float, pieces: int
) -> None:
    state = State(told=Told(waypoints=WAY, next_index=next_index))
    now = NORTH._replace(position=Position(north_m, east_m, 300.0))
    found = predicted(
        CONFIG, state, Sensed(0, now, ABILITY, (), Gate(0, 0, False)), Scene((), (), WIDE, 60.0)
    )
    if pieces < 0:  # straight on, and no hold
        straight = Piece(0.0, 60.0, now.position, velocity_of(0.0, 22.0, 0.0))
        assert found == Ahead((straight,), (WIDE,), off_plan=next_index > 0)
    else:
        assert len(found.pieces) == pieces
        assert len(found.holds) == 1


@pytest.mark.parametrize(
    ("before_rad", "now_rad", "turns"),
    [
        (1.0, 1.0099, False),
        (1.0, 1.0101, True),
        (1.0, 0.9899, True),
        (math.pi - 0.001, -math.pi + 0.001, False),  # across south
    ],
)
def test_who_turns(before_rad: float, now_rad: float, turns: bool) -> None:
    found = turning(((9, now_rad), (8, 0.0)), ((9, before_rad),), 0.5)
    assert found == (frozenset({9}) if turns else frozenset())


def test_a_waypoint_passed_abeam_is_no_goal() -> None:
    bend = tuple(Position(500.0, east, 300.0) for east in (0.0, 900.0, 1800.0))
    assert goal_index(NORTH, 85.0, bend, 0) == 1  # the way on leads off at a right angle
    assert goal_index(NORTH._replace(position=Position(500.0, -1.0, 300.0)), 0.3, bend, 0) == 0
    assert goal_index(NORTH._replace(position=Position(500.0, -1.0, 300.0)), 0.4, bend, 0) == 1


# ---- when it hands back --------------------------------------------------------------------------

LONG = (Position(-1000.0, 0.0, 300.0), Position(6000.0, 0.0, 300.0))


@pytest.mark.parametrize(
    ("avoided", "in_turn", "late_s", "free", "lasting"),
    [
        ((9,), (), 0.0, False, False),  # met again in two minutes, twice the look-ahead
        ((), (), 0.0, True, False),  # it has not taken over for that one: there is time
        ((8,), (), 0.0, True, False),
        ((9,), (9,), 0.0, True, True),  # a straight line says nothing of one that turns
        ((), (9,), 0.0, True, True),
        ((), (), 30.0, True, True),  # passes behind
        ((9,), (), 30.0, True, True),
        ((9,), (), 12.1, True, True),
        ((), (), 12.1, True, True),
        ((), (), 12.0, True, False),
        ((9,), (), 12.0, False, False),  # nearest 186.7 m, where 187.5 m are kept
    ],
)
def test_who_was_avoided_is_not_met_again(
    avoided: tuple[int, ...], in_turn: tuple[int, ...], late_s: float, free: bool, lasting: bool
) -> None:
    """A way that is free for good meets nobody again, avoided or not."""
    meets_s = 120.0
    other = Intruder(
        9,
        Position(22.0 * meets_s, -22.0 * (meets_s + late_s), 300.0),
        Velocity(0.0, 22.0, 0.0),
    )
    met = tuple(Met(intruder, NONE) for intruder in avoided)
    state = State(told=Told(waypoints=LONG, next_index=1), goal=1, met=met)
    sensed = Sensed(0, NORTH, ABILITY, (other,), Gate(0, 0, False))
    assert way_back_is_free(CONFIG, state, sensed, frozenset(in_turn)) is free
    assert way_back_is_free(CONFIG, state, sensed, frozenset(in_turn), True) is lasting


def test_a_way_that_meets_a_zone_beyond_the_look_ahead_is_not_free_for_good() -> None:
    """UxAS goes around it: it flies another way than the one that was looked at."""
    corners = ((2e3, -100.0), (2e3, 100.0), (22e2, 100.0), (22e2, -100.0))
    zone = Zone(1, ZoneKind.KEEP_OUT, corners, 0.0, 1000.0)
    sensed = Sensed(0, NORTH, ABILITY, (), Gate(0, 0, False))
    for zones in ((), (zone,)):
        told = Told(waypoints=LONG, next_index=1, zones=zones)
        state = State(told=told, goal=1)
        assert way_back_is_free(CONFIG, state, sensed, frozenset())
        assert way_back_is_free(CONFIG, state, sensed, frozenset(), True) is (zones == ())
