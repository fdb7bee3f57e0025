"""Two vehicles whose planned paths cross at the same time and height, in many geometries.

With avoidance well clear is never lost and both missions complete; without it, it is lost. The
check here is the kernel's, over every step of the flight, on the messages alone.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import pytest
from flight_tools import VOLUME, flown, mission_within, of_type, vehicle

from cratous.bridge import lmcp
from cratous.core.kernel import Vec2
from cratous.core.well_clear import StandardThresholds, violation_within
from cratous.services.flight.loop import FlightResult
from cratous.spec.mission import Mission, Position, Task, TaskKind, Vehicle, WellClear
from cratous.spec.mission.plan import Plan, PlanItem

LEAD_M = 2600.0


def through_origin(vid: int, heading: float, speed: float, before_s: float) -> Vehicle:
    """A vehicle that is at the origin after before_s if it flies on."""
    north = -speed * before_s * math.cos(heading)
    east = -speed * before_s * math.sin(heading)
    return vehicle(vid, north, east, heading, speed)


def item(v: Vehicle, task_id: int, past_m: float = 2000.0) -> PlanItem:
    """Straight through the origin, then the task: 600 m straight on."""
    h, p = v.heading_rad, v.position
    at = [Position(d * math.cos(h), d * math.sin(h), p.alt_m) for d in (past_m, past_m + 600.0)]
    way_m = math.hypot(p.north_m - at[0].north_m, p.east_m - at[0].east_m)
    arrive = math.ceil(1000 * way_m / v.speed_m_s)
    end = arrive + math.ceil(1000 * 600 / v.speed_m_s)
    return PlanItem(
        task_id, 1, v.id, (p, at[0]), tuple(at), None, v.speed_m_s, 0, arrive, 0, arrive, end, h
    )


def crossing(
    angle_deg: float, speed_1: float, speed_2: float, t_s: float = 110.0
) -> tuple[Mission, Plan]:
    """Vehicle 1 flies north; 2 crosses it under the angle; both are at the origin at t_s."""
    one = through_origin(1, 0.0, speed_1, t_s)
    two = through_origin(2, math.radians(angle_deg), speed_2, t_s)
    tasks = tuple(Task(k, TaskKind.MUST_FLY, f"task {k}", ()) for k in (11, 12))
    mission = mission_within(900_000, (one, two), tasks, name="crossing")
    items = (item(one, 11), item(two, 12))
    span = max(i.end_ms for i in items)
    return mission, Plan("crossing", items, (), (1,), span, "MINMAX", 1, True)


def losses(log: list[Any], volume: WellClear = VOLUME, step_s: float = 0.25) -> list[int]:
    """Times [ms] of the steps in which some pair loses well clear."""
    lost = []
    states = of_type(log, "TruthState")
    for time, group in itertools.groupby(states, key=lambda s: s.Time):
        for a, b in itertools.combinations(list(group), 2):
            s = Vec2(a.North - b.North, a.East - b.East)
            v = Vec2(a.VelocityNorth - b.VelocityNorth, a.VelocityEast - b.VelocityEast)
            sz, vz = a.Altitude - b.Altitude, b.VelocityDown - a.VelocityDown
            limits = StandardThresholds(volume.dthr_m, volume.zthr_m, volume.tthr_s, volume.tcoa_s)
            if violation_within(s, v, sz, vz, limits, step_s):
                lost.append(time)
    return lost


def check(angle_deg: float, speed_1: float, speed_2: float) -> FlightResult:
    """Fly one geometry and assert everything that must hold."""
    mission, plan = crossing(angle_deg, speed_1, speed_2)
    result, log = flown(mission, plan)
    assert result.outcome == "complete"
    assert losses(log) == []
    assert result.takeovers >= 1
    owners = of_type(log, "AuthorityChange")
    for vid in (1, 2):
        # authority alternates, and ends where it began
        changes = [o.Owner.name for o in owners if o.VehicleID == vid]
        assert changes == ["ICAROUS", "UxAS"] * (len(changes) // 2)
    assert not of_type(log, "CommandDropped")
    return result


def test_takeover_keeps_well_clear_and_both_complete() -> None:
    mission, plan = crossing(90, 22, 22)
    result, log = flown(mission, plan)
    assert result.outcome == "complete"
    assert losses(log) == []
    reasons = [o.Reason for o in of_type(log, "AuthorityChange")]
    assert any(reason.startswith("traffic") for reason in reasons)
    assert any("handed back" in reason for reason in reasons)
    assert set(result.ends) == {11, 12}


def test_without_avoidance_well_clear_is_lost() -> None:
    mission, plan = crossing(90, 22, 22)
    result, log = flown(mission, plan, daa=False)
    assert result.outcome == "complete"
    assert losses(log)
    assert result.takeovers == 0


def test_a_bridge_over_which_nobody_takes_anything_changes_no_flight() -> None:
    """Who passes long after the other is flown by the same states to the last digit, with ICAROUS and without."""
    mission, _ = crossing(90, 22, 22)
    one, two = mission.vehicles[0], through_origin(2, math.radians(90), 22, 220.0)
    mission = replace(mission, vehicles=(one, two))
    items = (item(one, 11), item(two, 12))
    plan = Plan("apart", items, (), (1,), max(i.end_ms for i in items), "MINMAX", 1, True)
    flights = [flown(mission, plan, daa=daa) for daa in (True, False)]
    states = [
        [(s.VehicleID, s.Time, s.North, s.East, s.Altitude) for s in of_type(log, "TruthState")]
        for _, log in flights
    ]
    beats = [len(of_type(log, "Heartbeat")) for _, log in flights]
    assert [result.takeovers for result, _ in flights] == [0, 0]
    assert beats[0] > 500, "the bridge is there"
    assert beats[1] == 0
    assert states[0] == states[1]
    assert flights[0][0].ends == flights[1][0].ends


def test_only_the_one_that_gives_way_manoeuvres() -> None:
    mission, plan = crossing(90, 22, 22)
    _, log = flown(mission, plan)
    taken = {o.VehicleID for o in of_type(log, "AuthorityChange") if o.Owner.name == "ICAROUS"}
    assert taken == {2}


def test_same_inputs_same_messages_whatever_the_segments() -> None:
    mission, plan = crossing(60, 22, 25)

    def bytewise(data: bytes) -> list[bytes]:
        return [data[k : k + 7] for k in range(0, len(data), 7)]

    _, one = flown(mission, plan)
    _, two = flown(mission, plan, segmenter=bytewise)
    assert [lmcp.to_json(b) for b in one] == [lmcp.to_json(b) for b in two]


VARIANTS = [
    (sign * angle, speed_1, speed_2)
    for angle in (30, 60, 90, 120, 150, 180)
    for sign in (1, -1)
    if angle != 180 or sign == 1  # -180 is the same
    for speed_1, speed_2 in ((18, 28), (22, 22), (28, 18))
]
# every angle with one of the three speeds, in turn; the others are long
FLOWN = [
    variant if k % 3 == k // 3 % 3 else pytest.param(*variant, marks=pytest.mark.long)
    for k, variant in enumerate(VARIANTS)
]


@pytest.mark.slow
@pytest.mark.parametrize(("angle_deg", "speed_1", "speed_2"), FLOWN)
def test_every_geometry_holds(angle_deg: float, speed_1: float, speed_2: float) -> None:
    check(angle_deg, speed_1, speed_2)


@pytest.mark.slow
def test_unprotected_intruder_is_avoided_by_the_other() -> None:
    mission, plan = crossing(90, 22, 22)
    _, log = flown(replace(mission, instances=(1,)), plan)
    assert losses(log) == []
