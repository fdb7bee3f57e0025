"""The hold that ends a way is looked at, and nothing beyond it."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from flight_tools import flown, of_type
from icarous_tools import ABILITY, NORTH, VOLUME, WIDE
from mission_tools import must_fly

from cratous.core.authority.gate import Gate
from cratous.core.avoidance.manoeuvre import way_along
from cratous.core.avoidance.prediction import (
    EXACT,
    STANDING,
    Intruder,
    Spread,
    first_violation_s,
    meetings,
)
from cratous.core.avoidance.resolution import Scene
from cratous.core.permit.remainder import (
    _hold_permits,
    hold_at,
    hold_permits,
    out_of_reach_of,
    zones_permit,
)
from cratous.core.routing.polylines import Track
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.remaining_path import points_ahead
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.route_end import TRACKING_S, WIDEST, Ahead, horizon_s, with_hold
from cratous.services.loading import load
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import (
    Position,
    Velocity,
    WellClear,
    Zone,
    ZoneKind,
)

MISSION = Path(__file__).resolve().parents[1] / "missions" / "hovering_behind.yaml"
GOAL = Position(600.0, 0.0, 300.0)
RADIUS_M = 1.1 * 22.0 / 0.26
HOLD_M = RADIUS_M + TRACKING_S * 22.0
RISE_M = TRACKING_S * 4.0


def standing(north_m: float, east_m: float = 0.0, alt_m: float = 300.0) -> Intruder:
    return Intruder(9, Position(north_m, east_m, alt_m), STANDING)


def ahead(*others: Intruder, zones: tuple[Zone, ...] = (), lookahead_s: float = 60.0) -> Ahead:
    scene = Scene(others, zones, WIDE, lookahead_s)
    way = way_along(NORTH, (GOAL,), horizon_s(scene))
    sensed = Sensed(0, NORTH, ABILITY, others, Gate(0, 0, False))
    return with_hold(way, sensed, scene, VOLUME, 1.1)


def wall(south_m: float) -> Zone:
    sides = ((south_m, -500.0), (south_m + 90, -500.0), (south_m + 90, 500.0), (south_m, 500.0))
    return Zone(1, ZoneKind.KEEP_OUT, sides, 0.0, 1000.0)


BEHIND = (wall(600.0 + HOLD_M + 1.0),)
"""No way leads straight on past the goal."""
# straight behind, as far from the middle of either circle as the cylinder reaches
NEAR_M = 600.0 + math.sqrt((WIDE.dthr_m + HOLD_M) ** 2 - RADIUS_M**2)
ABOVE_M = 300 + WIDE.zthr_m + RISE_M
ARRIVAL_S = 600.0 / 22.0


@pytest.mark.parametrize(
    ("other", "first_s"),
    [
        (standing(5000.0), None),
        (standing(600.0 + 400.0, 400.0), None),
        (standing(600.0, 3 * RADIUS_M), None),  # in the way of the hold on one side alone
        (standing(600.0, -3 * RADIUS_M), None),
        (standing(600.0, 2 * RADIUS_M), ARRIVAL_S),  # in the way itself
        (standing(600.0, -2 * RADIUS_M), ARRIVAL_S),
        # in the way of both, and the way straight on leads past it
        (standing(600.0, 2.05 * RADIUS_M), None),
        (standing(600.0, 0.0, ABOVE_M + 0.1), None),  # above it
        (standing(600.0, 0.0, ABOVE_M - 0.1), None),  # above the way straight on
        # comes through the hold later, or in so long that it is not looked at
        (Intruder(9, Position(2000.0, 0.0, 300.0), Velocity(-30.0, 0.0, 0.0)), 30.0),
        (Intruder(9, Position(4000.0, 0.0, 300.0), Velocity(-30.0, 0.0, 0.0)), None),
    ],
)
def test_the_way_and_the_hold_are_looked_at(other: Intruder, first_s: float | None) -> None:
    found = ahead(other).first_s(other)
    if first_s is None:
        assert found is None
    else:
        assert found is not None
        assert found <= first_s + 5.0


@pytest.mark.parametrize(("off_m", "clear"), [(0.1, True), (-0.1, False)])
def test_where_the_hold_ends(off_m: float, clear: bool) -> None:
    slow = WellClear(VOLUME.dthr_m, VOLUME.zthr_m, 0.0, 0.0)  # so that the way itself is clear
    other = standing(NEAR_M + off_m)
    found = ahead(other, zones=BEHIND)
    assert (found._replace(volumes=(slow,)).first_s(other) is None) is clear
    assert len(found.holds) == (1 if clear else 2)
    assert sum(piece.duration_s for piece in found.pieces) == pytest.approx(ARRIVAL_S)
    assert all(hold.piece.start_s == pytest.approx(ARRIVAL_S) for hold in found.holds)


COMES = Intruder(9, Position(2000.0, 0.0, 300.0), Velocity(-30.0, 0.0, 0.0))
# over the hold it is above its layer, and in the layer only when it is far past it
SINKS = Intruder(9, Position(2040.0, 0.0, 530.0), Velocity(-38.4, 0.0, 4.0))


@pytest.mark.parametrize(
    ("other", "first_s"),
    [
        (standing(NEAR_M + 0.1), None),
        (standing(NEAR_M - 0.1), ARRIVAL_S),
        (COMES, (2000.0 - NEAR_M) / 30.0),
        (SINKS, ARRIVAL_S),  # not permitted, and no instant is found: from the beginning on
    ],
)
def test_when_the_hold_is_too_near(other: Intruder, first_s: float | None) -> None:
    """Asked of the holds alone: the way to them has a volume of its own."""
    found = ahead(other, zones=BEHIND)._replace(volumes=()).first_s(other)
    if first_s is None or found is None:
        assert found is first_s
    else:  # early by at most a 64th of the hold, never late
        assert first_s - (60.0 - ARRIVAL_S) / 64 <= found <= first_s + 1e-9
    if other is SINKS:
        wide = WellClear(WIDE.dthr_m + HOLD_M, WIDE.zthr_m + RISE_M, 0.0, 0.0)
        holds = [hold.piece for hold in ahead(other, zones=BEHIND).holds]
        assert all(first_violation_s((hold,), other, wide) is None for hold in holds)


def test_a_zone_near_the_hold_makes_it_wider() -> None:
    clear = ahead(zones=(wall(GOAL.north_m + HOLD_M + 0.1),))
    assert [hold.radius_m for hold in clear.holds] == pytest.approx([HOLD_M])
    (wide,) = ahead(zones=(wall(GOAL.north_m + HOLD_M - 0.1),)).holds
    assert wide.piece.position == GOAL
    assert wide.radius_m == pytest.approx(2 * WIDEST * RADIUS_M + TRACKING_S * 22.0)


@pytest.mark.parametrize(("gap_m", "holds"), [(HOLD_M + 0.1, True), (HOLD_M - 0.1, False)])
def test_zones_permit_a_disc(gap_m: float, holds: bool) -> None:
    zone = wall(GOAL.north_m + gap_m)
    assert zones_permit(GOAL, (zone,), HOLD_M) is holds
    assert zones_permit(GOAL, (replace(zone, floor_m=301.0),), HOLD_M)
    inside = replace(zone, kind=ZoneKind.KEEP_IN)
    assert not zones_permit(GOAL, (inside,), HOLD_M)


def test_a_zone_with_padding_is_refused() -> None:
    with pytest.raises(ValueError, match="zone 1: padding"):
        zones_permit(GOAL, (replace(wall(900.0), padding_m=5.0),), HOLD_M)


def test_a_way_that_is_longer_than_is_looked_has_no_hold() -> None:
    # it ends while thresholds of time reach past what is looked at: the mission's own are kept
    soon = ahead(lookahead_s=20.0)
    assert (soon.holds, soon.volumes[0]) == ((), VOLUME)
    assert sum(piece.duration_s for piece in soon.pieces) == pytest.approx(20.0)
    later = ahead(lookahead_s=ARRIVAL_S - WIDE.tthr_s - 0.1)
    assert (later.holds, later.volumes) == ((), (WIDE,))


@pytest.mark.parametrize("start_s", [0.0, 12.5])
def test_it_is_decided_on_the_very_numbers(start_s: float) -> None:
    hold = hold_at(GOAL, start_s, 60.0)
    touching = standing(GOAL.north_m + 150.0 + 64.0)
    assert not hold_permits(hold, touching, VOLUME, 64.0, 3.0)
    just = math.nextafter(touching.position.north_m, math.inf)
    assert hold_permits(hold, standing(just), VOLUME, 64.0, 3.0)
    assert not hold_permits(hold, standing(GOAL.north_m, 0.0, 333.0), VOLUME, 64.0, 3.0)
    above = standing(GOAL.north_m, 0.0, math.nextafter(333.0, math.inf))
    assert hold_permits(hold, above, VOLUME, 64.0, 3.0)


def test_a_hold_that_moves_is_refused() -> None:
    moving = hold_at(GOAL, 0.0, 60.0)._replace(velocity=Velocity(1.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="does not stand"):
        hold_permits(moving, standing(5000.0), VOLUME, 64.0, 3.0)


def test_who_flies_through_before_the_hold_begins_is_in_nobodys_way() -> None:
    other = Intruder(9, Position(1000.0, 0.0, 300.0), Velocity(-40.0, 0.0, 0.0))
    assert not hold_permits(hold_at(GOAL, 0.0, 60.0), other, VOLUME, 64.0, 3.0)
    assert not hold_permits(hold_at(GOAL, 10.0, 60.0), other, VOLUME, 64.0, 3.0)
    assert hold_permits(hold_at(GOAL, 16.0, 60.0), other, VOLUME, 64.0, 3.0)


@pytest.mark.parametrize("behind_m", [405.0, 450.0, 700.0, 1100.0])
def test_a_drone_that_hovers_behind_the_goal_is_in_nobodys_way(behind_m: float) -> None:
    mission = load(MISSION)
    (drone,) = mission.traffic
    place = Position(1500.0 + behind_m, 0.0, 300.0)
    result, log = flown(replace(mission, traffic=(replace(drone, position=place),)))
    assert (result.outcome, result.takeovers) == ("complete", 0)
    assert result.end_ms < 70_000
    assert not of_type(log, "Conflict")


@pytest.mark.parametrize(("north_m", "east_m"), [(1500, 250), (1500, -250), (1500, 195), (1420, 200), (1650, 250)])  # fmt: skip
def test_a_drone_that_hovers_beside_the_goal_is_in_nobodys_way(
    north_m: float, east_m: float
) -> None:
    """A circle on the other side keeps clear of it, or the way straight on; the mission ends at the goal."""
    mission = load(MISSION)
    (drone,) = mission.traffic
    place = Position(float(north_m), float(east_m), 300.0)
    result, log = flown(replace(mission, traffic=(replace(drone, position=place),)))
    assert (result.outcome, result.takeovers) == ("complete", 0)
    assert result.end_ms < 70_000
    assert not of_type(log, "Conflict")


@pytest.mark.parametrize("east_m", [250.0, -195.0])
def test_one_that_circles_beside_it_is_led_away_once(east_m: float) -> None:
    """Another vehicle still flies: this one circles at its goal, towards the drone or not, and keeps clear of it."""
    mission = load(MISSION)
    (drone,), (first,), (task,) = mission.traffic, mission.vehicles, mission.tasks
    place = Position(1500.0, east_m, 300.0)
    other = replace(first, id=2, position=Position(0.0, 8000.0, 300.0))
    later = replace(must_fly(2, (3000.0, 8000.0, 300.0)), eligible=(2,))
    whole = replace(
        mission,
        vehicles=(first, other),
        tasks=(replace(task, eligible=(1,)), later),
        traffic=(replace(drone, position=place),),
    )
    result, log = flown(whole)
    assert (result.outcome, result.takeovers) == ("complete", 1)
    # it circles in a layer of its own
    level = [
        one for one in of_type(log, "TruthState")
        if one.VehicleID == 1 and abs(one.Altitude - 300.0) <= 30.0
    ]  # fmt: skip
    assert max(one.Time for one in level) > 75_000
    assert min(math.dist((one.North, one.East), (1500.0, east_m)) for one in level) > 187.5


def test_a_hold_must_be_clear_of_everybody() -> None:
    """One on each side: neither circle is, and the way straight on is barred."""
    pair = (standing(600.0, 3 * RADIUS_M), standing(600.0, -3 * RADIUS_M))
    assert len(ahead(*pair, zones=BEHIND).holds) == 2
    assert any(ahead(*pair, zones=BEHIND).meets(one) for one in pair)
    assert not any(ahead(*pair).meets(one) for one in pair)


def test_the_way_is_told_to_its_end_or_farther_than_is_looked() -> None:
    mission = load(MISSION)
    tasks = tuple(must_fly(k, (1500.0 + 300.0 * k, 0.0, 300.0)) for k in range(1, 6))
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


def test_the_end_of_a_way_beside_a_zone_is_flown() -> None:
    """The line of flight goes on into a zone, where the vehicle never flies: it would circle before it."""
    mission = load(MISSION)
    zone = replace(wall(1500.0 + 200.0), padding_m=0.0)
    result, log = flown(replace(mission, traffic=(), zones=(zone,)))
    assert (result.outcome, result.takeovers) == ("complete", 0)
    assert not of_type(log, "Conflict")


def test_a_hold_out_of_reach_of_a_path_is_one_that_is_permitted() -> None:
    """What is skipped is what the kernels permit, asked leg by leg."""
    rng, skipped, asked = random.Random(5), 0, 0
    for _ in range(400):
        speed, at = (
            rng.uniform(15, 40),
            Position(rng.uniform(-9e3, 9e3), rng.uniform(-9e3, 9e3), 300.0),
        )
        points = tuple(
            Position(at.north_m + rng.uniform(-900, 900), at.east_m + rng.uniform(-900, 900), 300.0)
            for _ in range(4)
        )
        motion = NORTH._replace(position=at, speed_m_s=speed)
        way = way_along(motion, points, 90.0).pieces
        spread = rng.choice(
            (EXACT, Spread(rng.uniform(0, 50), 2.0, 10.0, 0.5, rng.choice((20.0, math.inf))))
        )
        other = Intruder(9, at, way[0].velocity, True, way, rng.choice((0.0, 200.0)), spread)
        place = Position(rng.uniform(-3e3, 3e3), rng.uniform(-3e3, 3e3), 300.0)
        hold, radius_m = (
            hold_at(place, rng.uniform(0, 30), rng.uniform(31, 60)),
            rng.uniform(0, 400),
        )
        permitted = all(
            _hold_permits(part, straight_on, WIDE, radius_m, RISE_M)
            for run, straight_on in meetings((hold,), other)
            for part in run
        )
        asked += 1
        if out_of_reach_of(hold, other, WIDE.dthr_m + radius_m):
            skipped += 1
            assert permitted
        assert hold_permits(hold, other, WIDE, radius_m, RISE_M) == permitted
    assert asked / 4 < skipped < asked


def test_a_hold_just_within_reach_of_a_path_is_asked_about() -> None:
    way = way_along(NORTH, (GOAL,), 90.0).pieces
    other = Intruder(9, NORTH.position, way[0].velocity, True, way, 100.0, Spread(20.0, 1.0))
    for beyond_m, far in ((0.5, False), (1.5, True)):
        aside_m = WIDE.dthr_m + HOLD_M + 100.0 + 20.0 + 60.0 + beyond_m
        hold = hold_at(Position(300.0, aside_m, 300.0), 20.0, 60.0)
        assert out_of_reach_of(hold, other, WIDE.dthr_m + HOLD_M) is far
