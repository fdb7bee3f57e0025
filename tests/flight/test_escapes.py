"""A zone that appears before a vehicle: a turn as tight as it can that keeps it is flown; where none does, that is said."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from flight_tools import meeting, of_type
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.services.flight import task_transitions
from cratous.services.flight.autopilot import Follow, decide, track_progress
from cratous.services.flight.dynamics import (
    AirState,
    Steering,
    advance,
    limits_of,
    steer,
    turn_radius_m,
    wrap,
)
from cratous.services.flight.executive_state import Config, State, first_state
from cratous.services.flight.messages import Say
from cratous.services.mission.escapes import escapes
from cratous.services.mission.frames import Projection
from cratous.services.monitor.avoidable import Appeared, avoidable
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Position, Zone, ZoneKind

DT_S = 0.25
VEHICLE = meeting().vehicles[0]
LIMITS = limits_of(VEHICLE)
RADIUS_M = turn_radius_m(VEHICLE.speed_m_s, VEHICLE.max_bank_rad)


def wall(at_m: float, half_m: float = 2000.0) -> Zone:
    """A wall to the north of the origin."""
    corners = ((at_m, -half_m), (at_m, half_m), (at_m + 400.0, half_m), (at_m + 400.0, -half_m))
    return Zone(7, ZoneKind.KEEP_OUT, corners, 0.0, 1000.0)


def north(heading_rad: float = 0.0) -> AirState:
    """A vehicle at the origin that flies to the north."""
    return AirState(Position(0.0, 0.0, 300.0), heading_rad, VEHICLE.speed_m_s, 0.0)


@settings(deadline=None, max_examples=20)
@given(st.floats(-3.0, 3.0), st.integers(0, 2000))
def test_the_points_of_a_turn_are_those_of_the_aircraft(heading: float, number: int) -> None:
    ways = list(escapes(north(heading).pose, VEHICLE.speed_m_s, VEHICLE, (), DT_S))
    way = ways[number % len(ways)]
    at = north(heading)
    side = math.copysign(1.0, way.turn_rad)
    most = abs(way.turn_rad)
    turned = 0.0
    for point in way.points[1:]:
        if turned >= most - 1e-9:
            break
        steered = steer(at, Steering(at.heading_rad + side, way.speed_m_s, 0.0), LIMITS, DT_S)
        turned += abs(wrap(steered.heading_rad - at.heading_rad))
        at = advance(steered, DT_S)
        assert math.dist(at.position, point) < 1e-6
    assert turned == pytest.approx(most, abs=1e-6)


def ended(zones: tuple[Zone, ...]) -> tuple[State, list[Any]]:
    """What the executive says where a vehicle has nothing left to fly, with these zones."""
    mission = replace(meeting(), traffic=())
    config = Config(mission, Projection(mission.frame), (1,))
    state = first_state(mission, replace(make_plan(mission), items=()))
    state = replace(state, zones=zones, aircraft=((1, north()),))
    out: list[Any] = []
    state = task_transitions.begin(config, state, out)
    return state, [said.body for said in out if isinstance(said, Say)]


def flown(state: State, steps: int) -> list[Position]:
    """Where the autopilot brings it."""
    chain, at = state.chain(1), north()
    command, places = Follow(chain.track, chain.speed_m_s), [at.position]
    for _ in range(steps):
        command, _ = track_progress(command, at, DT_S)
        at = advance(steer(at, decide(command, at, LIMITS, DT_S), LIMITS, DT_S), DT_S)
        places.append(at.position)
    return places


@pytest.mark.parametrize("more_m", [2.0, 6.0, 30.0])
def test_a_turn_that_is_just_tight_enough_is_flown(more_m: float) -> None:
    """The usual ways turn with 1.1 times the tightest radius: the wall is nearer than that."""
    zone = wall(RADIUS_M + more_m)
    state, said = ended((zone,))
    assert of_type(said, "MissionChange") == []
    assert first_bad_leg(state.chain(1).track.points, (zone,)) is None
    assert first_bad_leg(flown(state, 60), (zone,)) is None


def test_a_wall_that_no_turn_keeps_is_crossed_as_little_as_can_be_and_that_is_said() -> None:
    zone = wall(0.6 * RADIUS_M)
    state, said = ended((zone,))
    (told,) = of_type(said, "MissionChange")
    assert told.Consequence == task_transitions.NO_WAY_OUT
    places = flown(state, 60)
    deepest_m = max(p.north_m for p in places) - 0.6 * RADIUS_M
    assert 0.0 < deepest_m < 0.45 * RADIUS_M
    assert first_bad_leg(places[-2:], (zone,)) is None


@pytest.mark.parametrize("more_m", [-0.4 * RADIUS_M, -0.1 * RADIUS_M, 5.0, 60.0])
def test_whether_a_way_was_left_is_told_with_what_was_tried(more_m: float) -> None:
    slow = replace(VEHICLE, min_speed_m_s=VEHICLE.speed_m_s)  # it cannot slow down
    zone = wall(RADIUS_M + more_m)
    seen = Appeared(1000, north().pose, VEHICLE.speed_m_s)
    text, data = avoidable(seen, slow, zone, (zone,), DT_S)
    assert data["appeared_ms"] == 1000
    assert data["away_m"] == pytest.approx(RADIUS_M + more_m, abs=0.01)
    if more_m < 0:
        # no turn with that radius stays on this side of a wall that is nearer, whatever is tried
        assert data["way_kept"] is None
        assert f"none of {data['ways_tried']} ways tried from there keeps the zones" in text
    else:
        assert data["way_kept"] in text
        assert "would have kept the zones" in text


def test_who_can_slow_down_has_a_way_where_no_turn_at_its_speed_is_tight_enough() -> None:
    zone, seen = wall(0.85 * RADIUS_M), Appeared(0, north().pose, VEHICLE.speed_m_s)
    fast = replace(VEHICLE, min_speed_m_s=VEHICLE.speed_m_s)
    assert avoidable(seen, fast, zone, (zone,), DT_S)[1]["way_kept"] is None
    assert avoidable(seen, VEHICLE, zone, (zone,), DT_S)[1]["way_kept"] is not None
    state, said = ended((zone,))
    assert of_type(said, "MissionChange") == []
    assert state.chain(1).speed_m_s < VEHICLE.speed_m_s
    assert first_bad_leg(flown(state, 60), (zone,)) is None


def test_who_stands_has_no_way_to_turn() -> None:
    assert list(escapes(north().pose, 0.0, VEHICLE, (wall(60.0),), DT_S)) == []
