"""A manoeuvre keeps the difference between the predicted and the flown way from zones."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, WIDE, head_on
from shapely import LineString, Point, Polygon

from cratous.core.avoidance.drift import NONE, drift_of
from cratous.core.avoidance.manoeuvre import fly_to, smallest_turn, velocity_of
from cratous.core.avoidance.prediction import after
from cratous.core.avoidance.resolution import Choice, Scene, first_zone_s, resolve
from cratous.core.geofence.clearance import leg_keeps
from cratous.core.geofence.mission_legs import leg_ok
from cratous.services.flight.autopilot import Fly, decide
from cratous.services.flight.dynamics import GRAVITY_M_S2, AirState, Limits, advance, steer
from cratous.services.simulator.motion import Command, move
from cratous.services.simulator.motion import Motion as RolledMotion
from cratous.services.simulator.performance import Airframe, Profile
from cratous.services.simulator.world import STEP_S
from cratous.spec.mission import Position, Zone, ZoneKind

BANK_RAD = math.atan(ABILITY.turn_rate_rad_s * NORTH.speed_m_s / GRAVITY_M_S2)
LIMITS = Limits(15.0, 33.0, BANK_RAD, 4.0)
STEPS_S = (0.05, 0.1, 0.25, 0.5, 1.0)


def flown(choice: Choice, step_s: float, for_s: float, start: AirState) -> list[AirState]:
    """What the simulator flies of a manoeuvre, step by step."""
    v = velocity_of(choice.heading_rad, choice.speed_m_s, choice.climb_m_s)
    states = [start]
    for _ in range(round(for_s / step_s)):
        steered = steer(states[-1], decide(Fly(v), states[-1], LIMITS, step_s), LIMITS, step_s)
        states.append(advance(steered, step_s))
    return states


START = AirState(NORTH.position, NORTH.heading_rad, NORTH.speed_m_s, 0.0)


@given(
    st.floats(-math.pi, math.pi),
    st.one_of(st.just(22.0), st.floats(15.0, 33.0)),
    st.sampled_from(STEPS_S),
)
def test_the_flown_way_is_within_the_drift(heading: float, speed: float, step_s: float) -> None:
    able = ABILITY._replace(step_s=step_s)
    pieces = fly_to(NORTH, able, heading, speed, 0.0, 0.0, 40.0)
    drift = drift_of(NORTH, able, heading, speed, 0.0)
    choice = Choice("heading", heading, speed, 0.0, 0.0, True, None)
    around = [
        (LineString([p.position[:2], after(p, p.duration_s)[:2]]), drift.aside_m(p.start_s + p.duration_s))
        for p in pieces
    ]  # fmt: skip
    for here, there in itertools.pairwise(flown(choice, step_s, 20.0, START)):
        for share in (0.25, 0.5, 0.75, 1.0):
            at = Point(
                here.position.north_m + share * (there.position.north_m - here.position.north_m),
                here.position.east_m + share * (there.position.east_m - here.position.east_m),
            )
            assert any(line.distance(at) <= aside + 1e-6 for line, aside in around)


def test_the_flown_way_is_off_by_metres_in_a_turn() -> None:
    """Without the drift the same is false: it is not there for nothing, nor many times too wide."""
    pieces = fly_to(NORTH, ABILITY, math.pi, 22.0, 0.0, 0.0, 20.0)
    drift = drift_of(NORTH, ABILITY, math.pi, 22.0, 0.0)
    choice = Choice("heading", math.pi, 22.0, 0.0, 0.0, True, None)
    way = LineString([p.position[:2] for p in pieces])
    off = max(
        way.distance(Point(s.position[:2])) for s in flown(choice, ABILITY.step_s, 15.0, START)
    )
    assert off > drift.aside_m(20.0) / 3 > 5.0


@pytest.mark.parametrize(("turn_deg", "beyond_m"), [(5, 0.3), (30, 1.5), (60, 0.5)])
def test_an_autopilot_that_rolls_first_is_farther_off(turn_deg: float, beyond_m: float) -> None:
    """The simulator's: what the drift does not cover, and that it is less than two metres, stands in its text."""
    heading = math.radians(turn_deg)
    pieces = fly_to(NORTH, ABILITY, heading, 22.0, 0.0, 0.0, 20.0)
    aside_m = drift_of(NORTH, ABILITY, heading, 22.0, 0.0).aside_m(20.0)
    way = LineString(
        [*(p.position[:2] for p in pieces), after(pieces[-1], pieces[-1].duration_s)[:2]]
    )
    level = Profile(22.0, 0.0, 0.0, math.degrees(BANK_RAD), 0.0)
    airframe = Airframe(15.0, 33.0, (level,), (), (), level, level, False)
    state = RolledMotion(0.0, 0.0, 300.0, 0.0, 0.0, 0.0, 22.0, 22.0, 0.0, 0.0, 100.0, 0.0)
    north_m = east_m = off_m = 0.0
    for _ in range(round(10 / STEP_S)):
        state, _ = move(
            state, Command(heading, 300.0, 22.0, 0.0), airframe, (0.0, 0.0), 0.0, STEP_S
        )
        north_m, east_m = north_m + state.north_m_s * STEP_S, east_m + state.east_m_s * STEP_S
        off_m = max(off_m, way.distance(Point(north_m, east_m)))
    assert beyond_m < off_m - aside_m < 2.0


def test_a_half_turn_may_be_flown_to_the_other_side() -> None:
    """Which side is shorter is a matter of rounding, and the velocity that is told rounds too."""
    course = 2.530727415391778
    start = START._replace(heading_rad=course)
    choice = Choice("heading", course + math.pi, 22.0, 0.0, 0.0, True, None)
    turned = flown(choice, 0.25, 0.25, start)[-1].heading_rad - course
    assert smallest_turn(course, course + math.pi) * turned < 0


def test_straight_flight_has_no_drift() -> None:
    drift = drift_of(NORTH, ABILITY, NORTH.heading_rad, 22.0, 0.0)
    assert drift.aside_m(60.0) == 0.0


@given(st.floats(0.1, math.pi), st.floats(0.0, 1.0))
def test_what_is_still_to_be_turned_is_owed_and_no_more(turn: float, share: float) -> None:
    """A turn that is kept clear remains so as it is flown."""
    whole = drift_of(NORTH, ABILITY, turn, 22.0, 0.0)
    rest = drift_of(NORTH._replace(heading_rad=share * turn), ABILITY, turn, 22.0, 0.0)
    done_s = share * turn / ABILITY.turn_rate_rad_s
    assert whole.aside_m(done_s) + rest.aside_m(60.0) == pytest.approx(whole.aside_m(60.0))


SIDE = st.floats(-100.0, 100.0)
SQUARE = ((0.0, 0.0), (40.0, 0.0), (55.0, 30.0), (40.0, 40.0), (0.0, 40.0))


@given(SIDE, SIDE, SIDE, SIDE, st.floats(0.0, 30.0), st.sampled_from(list(ZoneKind)))
def test_a_leg_keeps_a_margin_as_shapely_has_it(
    a: float, b: float, c: float, d: float, margin: float, kind: ZoneKind
) -> None:
    zone = Zone(1, kind, SQUARE, 0.0, 1000.0)
    if 0.0 < math.hypot(c - a, d - b) < 1e-100:
        return  # shapely takes so short a leg to be somewhere else
    leg, shape = LineString([(a, b), (c, d)]), Polygon(SQUARE)
    off = shape.exterior.distance(leg)
    if abs(off - margin) < 1e-6:
        return
    inside = shape.contains(leg)
    wanted = off > margin and inside == (kind is ZoneKind.KEEP_IN)
    p, q = Position(a, b, 300.0), Position(c, d, 300.0)
    assert leg_keeps(p, q, zone, margin) == wanted
    assert leg_keeps(p, q, zone, 0.0) == leg_ok(p, q, zone)


@pytest.mark.parametrize(("ceiling_m", "rise_m", "kept"), [(299.0, 0.9, True), (299.0, 1.1, False)])
def test_a_margin_in_height(ceiling_m: float, rise_m: float, kept: bool) -> None:
    below = Zone(1, ZoneKind.KEEP_OUT, SQUARE, 0.0, ceiling_m)
    p, q = Position(-50.0, 20.0, 300.0), Position(100.0, 20.0, 300.0)
    assert leg_keeps(p, q, below, 1.0, rise_m) is kept


def test_a_zone_with_padding_is_refused() -> None:
    zone = Zone(1, ZoneKind.KEEP_OUT, SQUARE, 0.0, 1000.0, padding_m=5.0)
    for margin_m in (0.0, 1.0):
        with pytest.raises(ValueError, match="zone 1: padding"):
            leg_keeps(NORTH.position, NORTH.position, zone, margin_m)


def beside(gap_m: float, side: int) -> Zone:
    """A keep-out beside the way north."""
    near, far = side * gap_m, side * 2000.0
    sides = ((-300.0, near), (900.0, near), (900.0, far), (-300.0, far))
    return Zone(1, ZoneKind.KEEP_OUT, sides, 0.0, 1000.0)


@settings(max_examples=40, deadline=None)
@given(
    st.floats(5.0, 250.0),
    st.sampled_from((1, -1)),
    st.floats(1500.0, 2500.0),
    st.sampled_from(STEPS_S),
)
def test_a_manoeuvre_chosen_anew_each_heartbeat_keeps_off_a_zone_beside(
    gap_m: float, side: int, north_m: float, step_s: float
) -> None:  # fmt: skip
    zone, state, held, other = beside(gap_m, side), START, None, head_on(north_m)
    able = ABILITY._replace(step_s=step_s)
    beat_s = max(0.5, step_s)
    for _ in range(round(20 / beat_s)):
        now = NORTH._replace(
            position=state.position, heading_rad=state.heading_rad, speed_m_s=state.speed_m_s
        )
        rate = GRAVITY_M_S2 * math.tan(BANK_RAD) / state.speed_m_s
        scene = Scene((other,), (zone,), WIDE, 60.0)
        held = resolve(now, able._replace(turn_rate_rad_s=rate), scene, 0.0, 22.0, held)
        way = flown(held, step_s, beat_s, state)
        for p, q in itertools.pairwise(way):
            assert leg_ok(p.position, q.position, zone)
        state = way[-1]
        p, v = other.position, other.velocity
        moved = Position(p.north_m + v.north_m_s * beat_s, p.east_m + v.east_m_s * beat_s, p.alt_m)
        other = other._replace(position=moved)


def test_inside_of_the_margin_the_zone_itself_counts() -> None:
    """Hemmed in, with an intruder in front: what the zones themselves allow is flown, and not a zone entered."""
    low = ABILITY._replace(max_climb_m_s=0.0, min_speed_m_s=22.0, max_speed_m_s=22.0)
    corridor = (beside(0.01, 1), beside(230.0, -1))
    others = (head_on(2400.0),)
    choice = resolve(NORTH, low, Scene(others, corridor, WIDE, 60.0), 0.0, 22.0, None)
    pieces = fly_to(NORTH, low, choice.heading_rad, 22.0, 0.0, 0.0, 60.0)
    assert first_zone_s(pieces, corridor, 60.0, NONE) is None
    drift = drift_of(NORTH, low, choice.heading_rad, 22.0, 0.0)
    assert first_zone_s(pieces, corridor, 60.0, drift) == 0.0
