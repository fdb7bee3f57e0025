"""The hold that ends a way is looked at, and nothing beyond it."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from flight_tools import flown, of_type
from icarous_tools import ABILITY, NORTH, VOLUME, WIDE

from cratous.core.authority.gate import Gate
from cratous.core.avoidance.manoeuvre import way_along
from cratous.core.avoidance.prediction import Intruder
from cratous.core.avoidance.resolution import Scene
from cratous.core.permit.remainder import STANDING, traffic_permits, zones_permit
from cratous.core.routing.polylines import Track
from cratous.services.flight.ahead import points_ahead
from cratous.services.flight.chain import Chain, Phase
from cratous.services.icarous.ending import with_hold
from cratous.services.icarous.messages import Sensed
from cratous.services.loading import load
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Position, Task, TaskKind, Velocity, Zone, ZoneKind

MISSION = Path(__file__).resolve().parents[1] / "missions" / "hovering_behind.yaml"
GOAL = Position(600.0, 0.0, 300.0)
HOLD_M = 2 * 1.1 * 22.0 / 0.26 + 22.0


def standing(north_m: float, east_m: float = 0.0, alt_m: float = 300.0) -> Intruder:
    return Intruder(9, Position(north_m, east_m, alt_m), STANDING)


def ahead(*others: Intruder, zones: tuple[Zone, ...] = (), horizon_s: float = 60.0) -> Any:
    scene = Scene(others, zones, WIDE, horizon_s)
    way = way_along(NORTH, (GOAL,), horizon_s)
    sensed = Sensed(0, NORTH, ABILITY, others, Gate(0, 0, False))
    return with_hold(way, sensed, scene, VOLUME, 1.1)


def wall(south_m: float) -> Zone:
    sides = ((south_m, -500.0), (south_m + 90, -500.0), (south_m + 90, 500.0), (south_m, 500.0))
    return Zone(1, ZoneKind.KEEP_OUT, sides, 0.0, 1000.0)


NEAR_M = 600.0 + WIDE.dthr_m + HOLD_M


@pytest.mark.parametrize(
    ("others", "holds"),
    [
        ((), True),
        ((standing(NEAR_M + 0.1),), True),
        ((standing(NEAR_M - 0.1),), False),  # in the way of the hold
        ((standing(NEAR_M - 0.1, alt_m=300 + WIDE.zthr_m + HOLD_M + 0.1),), True),  # above it
        ((standing(300.0, 180.0),), False),  # beside the way, within the cylinder
        ((standing(300.0, 195.0),), False),  # beside the way, and within that of the hold
        # comes through the hold later, or in so long that it is not looked at
        ((Intruder(9, Position(2000.0, 0.0, 300.0), Velocity(-30.0, 0.0, 0.0)),), False),
        ((Intruder(9, Position(4000.0, 0.0, 300.0), Velocity(-30.0, 0.0, 0.0)),), True),
    ],
)
def test_when_the_hold_is_permitted(others: tuple[Intruder, ...], holds: bool) -> None:
    pieces, volume = ahead(*others)
    assert (pieces[-1].velocity == STANDING) is holds
    assert pieces[-1].position == GOAL
    assert volume == (VOLUME if holds else WIDE)
    assert sum(piece.duration_s for piece in pieces) == pytest.approx(60.0)


@pytest.mark.parametrize(("gap_m", "holds"), [(HOLD_M + 0.1, True), (HOLD_M - 0.1, False)])
def test_the_hold_keeps_clear_of_zones(gap_m: float, holds: bool) -> None:
    zone = wall(GOAL.north_m + gap_m)
    assert zones_permit(GOAL, (zone,), HOLD_M) is holds
    assert (ahead(zones=(zone,)).pieces[-1].velocity == STANDING) is holds
    assert zones_permit(GOAL, (replace(zone, floor_m=301.0),), HOLD_M)
    inside = replace(zone, kind=ZoneKind.KEEP_IN)
    assert not zones_permit(GOAL, (inside,), HOLD_M)


def test_a_zone_with_padding_is_refused() -> None:
    with pytest.raises(ValueError, match="zone 1: padding"):
        zones_permit(GOAL, (replace(wall(900.0), padding_m=5.0),), HOLD_M)


def test_a_way_that_is_longer_than_is_looked_has_no_hold() -> None:
    pieces, volume = ahead(horizon_s=20.0)
    assert pieces[-1].velocity != STANDING
    assert volume == WIDE


def test_it_is_decided_on_the_very_numbers() -> None:
    way = way_along(NORTH, (GOAL,), 60.0)
    assert way.beyond is not None
    held = (*way.pieces, way.beyond._replace(velocity=STANDING))
    touching = standing(GOAL.north_m + 150.0 + 64.0)
    assert not traffic_permits(held, (touching,), VOLUME, 0.0, 64.0)
    just = math.nextafter(touching.position.north_m, math.inf)
    assert traffic_permits(held, (standing(just),), VOLUME, 0.0, 64.0)


@pytest.mark.parametrize("behind_m", [450.0, 700.0, 1100.0])
def test_a_drone_that_hovers_behind_the_goal_is_in_nobodys_way(behind_m: float) -> None:
    mission = load(MISSION)
    (drone,) = mission.traffic
    place = Position(1500.0 + behind_m, 0.0, 300.0)
    result, log = flown(replace(mission, traffic=(replace(drone, position=place),)))
    assert (result.outcome, result.takeovers) == ("complete", 0)
    assert result.end_ms < 70_000
    assert not of_type(log, "Conflict")


def test_the_way_is_told_to_its_end_or_farther_than_is_looked() -> None:
    mission = load(MISSION)
    tasks = tuple(
        Task(k, TaskKind.MUST_FLY, "", (Position(1500.0 + 300.0 * k, 0.0, 300.0),))
        for k in range(1, 6)
    )
    plan = make_plan(replace(mission, tasks=tasks, traffic=()))
    items = plan.chain(1)
    assert len(items) == 5
    first = items[0]
    chain = Chain(mission.vehicles[0], items, 0, Phase.TASK, Track(first.path), first.speed_m_s)
    end = first.path[-1]
    for asked_m in (0.0, 200.0, 700.0, 1e6):
        told = points_ahead(chain, 0, asked_m)
        beyond = told[told.index(end) :]
        length = sum(math.dist(a, b) for a, b in pairwise(beyond))
        assert length >= asked_m or told[-1] == items[-1].path[-1]
    assert told[-1] == items[-1].path[-1]
