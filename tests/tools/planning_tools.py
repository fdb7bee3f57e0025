"""Vehicles, tasks and missions of the planning tests, and what a flyable plan is."""

import math

import pytest
from mission_tools import plain_mission

from cratous.core.assignment.earliest_times import rows_hold
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import polyline_length_m
from cratous.services.planning.options import flyer_of
from cratous.spec.mission import (
    Camera,
    Daa,
    Frame,
    Position,
    Task,
    TaskKind,
    Vehicle,
    WellClear,
    Zone,
)

CAMERA = Camera()


def vehicle(number, north, east, heading=0.0, alt=700.0, cameras=(CAMERA,)):
    place = Position(north, east, alt)
    bank = math.radians(20)
    return Vehicle(
        number, f"UAV {number}", place, heading, 22.0, 18.0, 33.0, bank, 5.0, True, cameras
    )


def task(number, kind, *points, **more):
    return Task(number, kind, f"t{number}", tuple(Position(*p) for p in points), **more)


def box(number, kind, south, west, north, east):
    corners = ((south, west), (south, east), (north, east), (north, west))
    return Zone(number, kind, corners, 0.0, 5000.0)


TWO = (vehicle(1, 0.0, 0.0), vehicle(2, 0.0, 3000.0))
FOUR = (
    task(1, TaskKind.POINT_SEARCH, (3000.0, 0.0, 0.0)),
    task(2, TaskKind.POINT_SEARCH, (3000.0, 3000.0, 0.0)),
    task(3, TaskKind.MUST_FLY, (5000.0, 1500.0, 0.0)),
    task(4, TaskKind.LOITER, (2000.0, 1000.0, 0.0), duration_ms=120_000, radius_m=300.0),
)


def mission(tasks=FOUR, vehicles=TWO, **more):
    daa = Daa(WellClear(1000.0, 100.0, 30.0, 30.0))
    frame = Frame(45.0, -120.0)
    return plain_mission(vehicles, tasks, name="m", source="m.yaml", frame=frame, daa=daa, **more)


def assert_flyable(plan, of):
    """Chains hang together in place and time, legs obey zones, rows hold, turns are wide enough."""
    starts = {item.task_id: item.start_ms for item in plan.items}
    ends = {item.task_id: item.end_ms for item in plan.items}
    assert rows_hold(plan.rows, starts, ends)
    assert sorted(starts) == sorted(plan.chosen)
    for one in of.vehicles:
        at, clock = one.position, 0
        for item in plan.chain(one.id):
            wanted = of.task(item.task_id).eligible
            assert not wanted or one.id in wanted
            assert math.dist(item.transit[0], at) < 1e-6
            assert math.dist(item.transit[-1], item.path[0]) < 1e-6
            assert item.depart_ms == clock
            flown = polyline_length_m(item.transit) / item.speed_m_s * 1000
            assert item.arrive_ms - item.depart_ms == pytest.approx(flown, abs=1.01)
            assert item.start_ms == item.arrive_ms + item.wait_ms
            along = polyline_length_m(item.path) / item.speed_m_s * 1000
            assert item.end_ms - item.start_ms == pytest.approx(along, abs=1.01)
            assert first_bad_leg(item.transit + item.path, of.zones) is None
            assert (item.hold is not None) == (item.wait_ms > 0)
            if item.hold is not None:
                radius = item.hold.radius_m
                laps = item.wait_ms * item.speed_m_s / 1000 / (2 * math.pi * radius)
                assert laps == pytest.approx(round(laps), abs=1e-6)
                assert radius >= flyer_of(one).radius_m * 0.999
                centre = (item.hold.north_m, item.hold.east_m)
                assert math.dist(centre, item.path[0][:2]) == pytest.approx(radius)
            assert_turns_wide(item.transit + item.path[1:], one)
            at, clock = item.path[-1], item.end_ms


def assert_turns_wide(points, one):
    """At each corner the turn is no sharper than the chords of the tightest circle make it."""
    radius = flyer_of(one).radius_m
    for p, q, r in zip(points, points[1:], points[2:], strict=False):
        if math.dist(p[:2], q[:2]) < 1e-6 or math.dist(q[:2], r[:2]) < 1e-6:
            continue
        first = math.atan2(q[1] - p[1], q[0] - p[0])
        second = math.atan2(r[1] - q[1], r[0] - q[0])
        turn = abs(math.remainder(second - first, 2 * math.pi))
        # half of each chord's arc lies on this side of the corner
        chords = math.dist(p[:2], q[:2]) + math.dist(q[:2], r[:2])
        assert turn <= chords / 2 / radius * 1.02 + 1e-6
