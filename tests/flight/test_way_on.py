"""What UxAS flies back on is what ICAROUS has looked at: the same waypoint, and whichever turn is taken."""

from __future__ import annotations

import functools
import math
from dataclasses import replace
from pathlib import Path

import pytest
import yaml
from flight_tools import flown, meeting
from hypothesis import given, settings
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.core.authority.gate import Gate
from cratous.core.avoidance.prediction import Intruder
from cratous.core.routing.polylines import Track
from cratous.services.campaign.generators import mission_of
from cratous.services.flight.chain import Phase
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.executive import Executive
from cratous.services.flight.executive_state import Config, State, first_state
from cratous.services.flight.inflight_routes import Ways
from cratous.services.flight.messages import Begin, Left, SetOut, Suspend, Tick
from cratous.services.icarous import state as icarous
from cratous.services.icarous.foresight import way_back_is_free
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.permits import NONE
from cratous.services.icarous.return_to_path import rejoining, way_on
from cratous.services.loading import load
from cratous.services.mission.frames import Projection
from cratous.services.pipeline.plan import make_plan
from cratous.spec.authority.link_end import SUSPEND
from cratous.spec.mission import Daa, Position, Velocity

RADIUS_M = 80.0
WAYPOINTS = tuple(
    Position(north, east, 300.0) for north, east in ((-900, 0), (0, 0), (1000, 0), (2000, 500))
)
PAST = NORTH._replace(position=Position(1400.0, -600.0, 300.0))
"""The second waypoint, at 1000 m, has been passed abeam."""


@functools.cache
def under_way() -> tuple[Executive, State]:
    """The executive with a vehicle that has just set out to its task."""
    mission = replace(meeting(), traffic=())
    actor = Executive(Config(mission, Projection(mission.frame), (1,)))
    start = AirState(Position(0.0, 0.0, 300.0), 0.0, 22.0, 0.0)
    state = first_state(mission, make_plan(mission))
    for message in (Begin(0, ((1, start),)), SetOut(), Tick(250, ((1, start),))):
        state, _ = actor.handle(state, message)
    return actor, state


def test_no_waypoint_is_passed_over_that_is_to_be_flown() -> None:
    told = Told(waypoints=WAYPOINTS, next_index=1)
    assert way_on(told, PAST, RADIUS_M) == WAYPOINTS[3:]
    to_be_flown = replace(told, resume=WAYPOINTS[2]._replace(east_m=0.4))
    assert way_on(to_be_flown, PAST, RADIUS_M) == WAYPOINTS[2:]
    at_once = replace(told, resume=WAYPOINTS[1])
    assert way_on(at_once, PAST, RADIUS_M) == WAYPOINTS[1:]


def test_a_path_that_was_left_between_two_waypoints_is_resumed_there() -> None:
    left = Position(300.0, 0.0, 300.0)
    told = Told(waypoints=WAYPOINTS, next_index=2, resume=left)
    assert way_on(told, PAST, RADIUS_M) == (left, *WAYPOINTS[2:])


@settings(max_examples=40, deadline=None)
@given(
    st.floats(0, 3000), st.floats(-1500, 1500), st.floats(-math.pi, math.pi), st.floats(0.0, 2000.0)
)
def test_it_is_the_waypoint_that_the_executive_chooses(
    north: float, east: float, heading: float, flown_m: float
) -> None:
    """Both ends reckon for themselves: the way that UxAS flies joins where ICAROUS has looked."""
    points = tuple(Position(1000.0 * k, 200.0 * (k % 2), 300.0) for k in range(5))
    chain = under_way()[1].chain(1).enter(Phase.TRANSIT, Track(points), 0)
    chain = replace(chain, s_m=flown_m)
    air = AirState(Position(north, east, 300.0), heading, chain.speed_m_s, 0.0)
    back = Ways((), 0.25).back(chain, air)
    assert back is not None
    passed = sum(s <= flown_m for s in chain.track.s_m)
    now = NORTH._replace(position=air.position, heading_rad=heading, speed_m_s=air.speed_m_s)
    radius_m = air.speed_m_s**2 / (9.80665 * math.tan(chain.vehicle.max_bank_rad))
    told = Told(waypoints=points, next_index=passed, resume=points[-1])
    ahead = way_on(told, now, radius_m)
    joined = back.track.at(back.join_m)
    assert math.dist(joined[:2], ahead[0][:2]) < 0.01


def test_left_and_right_are_both_looked_at_where_they_are_alike() -> None:
    target, beyond = Position(-1000.0, 1.0, 300.0), Position(0.0, 1.0, 300.0)
    ways = rejoining(NORTH, RADIUS_M, target, beyond)
    sides = {math.copysign(1.0, way[3].east_m) for way in ways}
    assert sides == {1.0, -1.0}
    (one,) = rejoining(NORTH, RADIUS_M, Position(2000.0, 0.0, 300.0), Position(2500.0, 0.0, 300.0))
    assert one[-1] == Position(2000.0, 0.0, 300.0)


@pytest.mark.parametrize("side", [1, -1])
def test_the_way_back_is_free_only_if_it_is_on_either_side(side: int) -> None:
    """Something stands in the turn to one side; UxAS may turn to that one."""
    waypoints = (
        Position(-1500.0, 0.0, 300.0),
        Position(-1000.0, 0.0, 300.0),
        Position(3e3, 0, 3e2),
    )
    told = Told(waypoints=waypoints, next_index=1, resume=waypoints[1])
    state = icarous.State(told=told, met=(icarous.Met(9, NONE),))
    config = icarous.Config(1, Daa(VOLUME), PROJECTION, 500)
    beside = Intruder(9, Position(-200.0, 340.0 * side, 300.0), Velocity(0.0, 0.0, 0.0))
    for others, free in (((beside,), False), ((), True)):
        sensed = Sensed(0, NORTH, ABILITY, others, Gate(0, 0, False))
        assert way_back_is_free(config, state, sensed, frozenset()) is free


def test_on_the_way_to_a_task_its_begin_is_told() -> None:
    actor, state = under_way()
    state, out = actor.handle(state, Suspend(1, 500, SUSPEND))
    (left,) = [said for said in out if isinstance(said, Left)]
    assert state.chain(1).phase is Phase.TRANSIT
    item = state.chain(1).item
    assert item is not None
    assert math.dist(left.position[:2], item.path[0][:2]) < 1.0


def test_what_was_permitted_is_not_taken_over_again(tmp_path: Path) -> None:
    """Others fly straight on, tasks lie where the way bends: before, UxAS went back to the waypoint of a task that
    ICAROUS had passed over, and lost half a second later what was said to be free."""
    generator = {"kind": "aimed", "intruders": 3, "bends": 4, "zones_beside": 2}
    data, _ = mission_of(generator, "bends", 4)
    file = tmp_path / "mission.yaml"
    file.write_text(yaml.safe_dump(data))
    result, _ = flown(load(file))
    assert (result.outcome, result.takeovers) == ("complete", 1)
