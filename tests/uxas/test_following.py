"""Tasks that keep to what moves, flown in the simulator: `cratous uxas` commands the aircraft of `cratous sim`.

What was flown is judged here from the states alone, with distances and footprints of its own.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from following_tools import ENTITY, aircraft, escort, escorted, moving, refused
from pipeline_tools import PIPELINE, Rig, must_fly, place, request
from uxas_flight import Flight, fly, local
from uxas_tools import write_cfg

from cratous.bridge import lmcp
from cratous.services.mission.sensor import sees
from cratous.services.simulator.world import Event

TASKS = "Task services"
DWELL_MS = 60_000
RADIUS_M = 1.1 * 20**2 / (9.80665 * math.tan(math.radians(30)))
"""The tightest planned turn, and the narrowest circle; that of a second vehicle is 150 m wider."""


def flown(
    folder: Path,
    task: Any,
    *others: Any,
    vehicles: tuple[int, ...] = (1,),
    seconds: float,
    entity: Any = None,
    **more: Any,
) -> Flight:
    """The vehicles do the task, and then others, by a whole UxAS."""
    kinds = (*PIPELINE, *(f"Way{v}" for v in vehicles))
    text = "".join(
        f'<Service Type="WaypointPlanManagerService" VehicleID="{kind[3:]}"/>\n'
        if kind.startswith("Way")
        else f'<Service Type="{kind}"/>\n'
        for kind in kinds
    )
    bodies = [
        *(entity or moving()),
        *(b for k, v in enumerate(vehicles) for b in aircraft(v, 0.001 * k)),
    ]
    events = [Event(0.1 * k, body, "") for k, body in enumerate(bodies)]
    numbers = [one.TaskID for one in (task, *others)]
    more = more or {"TaskRelationships": ".(" + " ".join(f"p{n}" for n in numbers) + ")"}
    said = [(1.0, one) for one in (task, *others)]
    said.append((3.0, request(*numbers, vehicles=vehicles, **more)))
    return fly(write_cfg(folder, text), events, seconds, said)


def apart_m(flight: Flight, number: int, begin_s: float, end_s: float) -> list[float]:
    """How far a vehicle was from the entity, level, while both were told of."""
    where = {body.Time: body.Location for body in flight.states(ENTITY)}
    return [
        math.dist(*local([where[b.Time], b.Location], place(0.03)))
        for b in flight.states(number)
        if b.Time in where and 1000 * begin_s <= b.Time <= 1000 * end_s
    ]


def watched(
    flight: Flight, number: int, begin_ms: int, end_ms: int, near_m: float = 2 * RADIUS_M
) -> list[bool]:
    """Of each state of a vehicle whether it watched the entity: near it, with it in a footprint."""
    where = {body.Time: body.Location for body in flight.states(ENTITY)}
    found = []
    for body in flight.states(number):
        if body.Time in where and begin_ms <= body.Time <= end_ms:
            prints = [p.Footprint for p in body.PayloadStateList if hasattr(p, "Footprint")]
            here, at, *quad = local(
                [body.Location, where[body.Time], *(p for one in prints for p in one)], place(0.03)
            )
            near = math.dist(here, at) < near_m + 1
            found.append(near and sees(tuple(tuple(p) for p in quad), tuple(at)))
    return found


@pytest.mark.shows(TASKS, "TaskActive", "TaskComplete", "VehicleActionCommand")
def test_what_moves_is_watched_until_its_dwell_is_over_and_the_plan_goes_on(
    tmp_path: Path,
) -> None:
    task = lmcp.new("WatchTask", TaskID=5, WatchedEntityID=ENTITY, DwellTime=DWELL_MS)
    flight = flown(tmp_path, task, must_fly(6, 0.03, 0.01), seconds=480.0)
    told = [(type(e.body).__name__, e.body.TaskID) for _, e in flight.told if "Task" in e.topic
            and type(e.body).__name__ in ("TaskActive", "TaskComplete")]  # fmt: skip
    assert told == [
        ("TaskActive", 5), ("TaskComplete", 5), ("TaskActive", 6), ("TaskComplete", 6),
    ]  # fmt: skip
    end = flight.of("TaskComplete")[0].TimeTaskCompleted
    assert all(watched(flight, 1, end - DWELL_MS, end)), "for the whole dwell, without a break"
    first = watched(flight, 1, 0, end)
    count = len(watched(flight, 1, end - DWELL_MS, end))
    assert count < len(first)
    assert not first[-count - 2], "and it is complete as soon as that is over"
    moved = local([s.Location for s in flight.states(ENTITY)], place(0.03))
    assert math.dist(moved[0], moved[-1]) > 2_000


@pytest.mark.parametrize("count", [2, 3])
def test_as_many_vehicles_as_are_asked_for_watch_at_one_time(tmp_path: Path, count: int) -> None:
    task = lmcp.new(
        "MultiVehicleWatchTask",
        TaskID=5,
        WatchedEntityID=ENTITY,
        DwellTime=DWELL_MS,
        NumberVehicles=2,
    )
    able = tuple(range(1, count + 1))
    flight = flown(tmp_path, task, vehicles=able, seconds=480.0)
    (complete,) = flight.of("TaskComplete")
    end, involved = complete.TimeTaskCompleted, complete.EntitiesInvolved
    assert len(set(involved)) == 2
    assert set(involved) <= set(able)
    for number in involved:
        assert all(watched(flight, number, end - DWELL_MS, end, 2 * (RADIUS_M + 150)))
        assert not flight.states(number)[-1].AssociatedTasks
    one, two = (
        {b.Time: b.Location for b in flight.states(number) if end - DWELL_MS <= b.Time <= end}
        for number in involved
    )
    nearest = min(math.dist(*local([one[t], two[t]], place(0.03))) for t in one if t in two)
    assert nearest > 50, "their circles are apart"


def test_an_escort_stays_about_an_entity_that_turns_where_its_route_does(tmp_path: Path) -> None:
    corner = lmcp.new("Waypoint", Number=1, NextWaypoint=2, Latitude=0.04, Longitude=0.002)
    last = corner.copy(Number=2, Longitude=0.05)
    task = lmcp.new(
        "EscortTask", TaskID=5, SupportedEntityID=ENTITY, PrescribedWaypoints=[corner, last],
        StandoffDistance=150.0, Parameters=[lmcp.new("KeyValuePair", Key="Duration_ms", Value="60000")],
    )  # fmt: skip
    flight = flown(tmp_path, task, seconds=400.0)
    (complete,) = flight.of("TaskComplete")
    end_ms = complete.TimeTaskCompleted
    assert max(apart_m(flight, 1, end_ms / 1000 - 60, end_ms / 1000)) <= 150 + 2 * RADIUS_M + 1
    where = {body.Time: body.Location for body in flight.states(ENTITY)}
    east_m = [
        local([body.Location], where[body.Time])[0].y
        for body in flight.states(1)
        if body.Time in where and end_ms - 60_000 <= body.Time <= end_ms
    ]
    assert 100 < sum(east_m) / len(east_m) < 200, "StandoffDistance ahead, on its way"


@pytest.mark.parametrize(("standoff_m", "north_m"), [(200.0, 200.0), (-200.0, -200.0)])
def test_an_escort_is_ahead_or_behind_on_the_line_that_it_names(
    tmp_path: Path, standoff_m: float, north_m: float
) -> None:
    """The entity heads east and goes north along the line: its first place is where it stands."""
    rig = Rig(tmp_path)
    line = lmcp.new(
        "LineOfInterest", LineID=7, Line=[place(0.02, 0.002), place(0.03, 0.002), place(0.1, 0.002)]
    )
    task = escort(RouteID=7, StandoffDistance=standoff_m)
    rig.tell(*aircraft(1, 0.0), *moving(1.0, course=90.0), line, task, request(5))
    assert not rig.reasons("Warning")
    rig.tell(aircraft(1, 0.03)[1].copy(AssociatedTasks=[5], CurrentWaypoint=99, Mode="Waypoint"))
    (command,) = rig.got("VehicleActionCommand")
    circle = command.VehicleActionList[0]
    (centre,) = local([circle.Location], place(0.03, 0.002))
    assert centre.x == pytest.approx(north_m, abs=10)
    assert centre.y == pytest.approx(0, abs=1)
    assert circle.Radius == pytest.approx(RADIUS_M, abs=0.1)


def test_an_escort_goes_by_the_plan_of_what_it_escorts_where_no_line_is_named(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path)
    ways = [lmcp.new("Waypoint", Number=k, Latitude=0.03 + k, Longitude=0.002) for k in (0, 1)]
    plan = lmcp.new("MissionCommand", VehicleID=ENTITY, WaypointList=ways)
    rig.tell(*aircraft(1, 0.0), *moving(1.0, course=90.0))
    rig.tell(lmcp.new("AutomationResponse", MissionCommandList=[plan]))
    rig.tell(escort(StandoffDistance=300.0), request(5))
    (option,) = rig.got("TaskPlanOptions")[0].Options
    (end,) = local([option.EndLocation], place(0.03, 0.002))
    assert end.y == pytest.approx(0, abs=5), "north of it, from the south"


def test_who_usually_flies_slower_than_what_it_escorts_flies_faster_if_it_can(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path)
    rig.tell(*aircraft(1, 0.0), *moving(22.0), escort(), request(5))
    (command,) = rig.got("AutomationResponse")[0].MissionCommandList
    speeds = [w.Speed for w in command.WaypointList]
    begins = next(k for k, w in enumerate(command.WaypointList) if w.AssociatedTasks)
    assert set(speeds[: begins + 1]) == {20}, "the way there is flown as usual, to its end"
    assert speeds[begins + 1 :] == pytest.approx([1.25 * 22] * (len(speeds) - begins - 1))
    rig.tell(aircraft(1, 0.03)[1].copy(AssociatedTasks=[5], CurrentWaypoint=99, Mode="Waypoint"))
    (circle,) = [c.VehicleActionList[0] for c in rig.got("VehicleActionCommand")]
    assert circle.Airspeed == pytest.approx(1.25 * 22)
    assert circle.Radius == pytest.approx(RADIUS_M * (1.25 * 22 / 20) ** 2, abs=0.1)


def test_one_who_flies_faster_for_it_stays_with_what_is_faster_than_he_usually_flies(
    tmp_path: Path,
) -> None:
    task = escort(Parameters=[lmcp.new("KeyValuePair", Key="Duration_ms", Value="60000")])
    flight = flown(tmp_path, task, entity=moving(21.0, 180.0), seconds=260.0)
    (complete,) = flight.of("TaskComplete")
    end_s = complete.TimeTaskCompleted / 1000
    wide_m = RADIUS_M * (1.25 * 21 / 20) ** 2
    assert max(apart_m(flight, 1, end_s - 60, end_s)) <= 100 + 2 * wide_m + 1


def test_one_vehicle_does_two_tasks_on_one_entity_one_after_the_other(tmp_path: Path) -> None:
    """The way to the second circle is listed in a state, however near the first one was left."""
    half_a_minute = [lmcp.new("KeyValuePair", Key="Duration_ms", Value="30000")]
    tasks = [escort(TaskID=number, Parameters=half_a_minute) for number in (5, 6)]
    flight = flown(tmp_path, *tasks, seconds=400.0)
    assert [body.TaskID for body in flight.of("TaskActive")] == [5, 6]
    assert [body.TaskID for body in flight.of("TaskComplete")] == [5, 6]


def test_a_blockade_is_between_the_entity_and_what_is_protected_and_ends_with_another_plan(
    tmp_path: Path,
) -> None:
    task = lmcp.new(
        "BlockadeTask", TaskID=5, BlockedEntityID=ENTITY, StandoffDistance=400.0, NumberVehicles=2,
        ProtectedLocation=place(0.08, 0.002),
    )  # fmt: skip
    flight = flown(tmp_path, task, vehicles=(1, 2), seconds=450.0)
    assert not flight.of("TaskComplete"), "nothing but another plan ends it"
    assert {body.EntityID for body in flight.of("TaskActive")} == {1, 2}
    for number in (1, 2):
        ahead = [
            local([body.Location], flight.states(ENTITY)[k].Location)[0]
            for k, body in enumerate(flight.states(number))
            if body.Time > 350_000
        ]
        assert min(p.x for p in ahead) > 0, "ahead of it, on the side of what is protected"
        assert max(math.hypot(*p) for p in ahead) < 1_200


@pytest.mark.parametrize(
    ("task", "reason"),
    [
        (escort(StandoffDistance=-1e6), "out of range"),
        (escort(StandoffDistance=math.nan), "StandoffDistance: wrong value; expected a number"),
        (escort(DwellTime=-5), "DwellTime"),
        (
            escort(Parameters=[lmcp.new("KeyValuePair", Key="Duration_ms", Value="soon")]),
            "expected 1 to 8.64e+07; got soon",
        ),
        (
            escort(Parameters=[lmcp.new("KeyValuePair", Key="Duration_ms", Value="9" * 5_000)]),
            "expected 1 to 8.64e+07; got 9999",
        ),
        (
            escort(PrescribedWaypoints=[lmcp.new("Waypoint", Latitude=99.0)]),
            "PrescribedWaypoints[0]: not a place",
        ),
        (escort(SupportedEntityID=77), "an entity of which no message has told"),
        (
            lmcp.new("BlockadeTask", TaskID=5, BlockedEntityID=ENTITY, NumberVehicles=9),
            "expected 1 to 8; got 9",
        ),
    ],
)
def test_what_cannot_be_asked_for_is_refused_with_what_and_where(
    tmp_path: Path, task: Any, reason: str
) -> None:
    said = refused(tmp_path, task, *moving())
    assert any(reason in text for text in said), said


def test_who_cannot_keep_up_or_see_is_not_offered_and_why_is_said(tmp_path: Path) -> None:
    fast = refused(tmp_path / "fast", escort(), *moving(31.0))
    assert any("moves at 31.0 m/s, and it flies 30 m/s" in text for text in fast), fast
    task = lmcp.new("WatchTask", TaskID=5, WatchedEntityID=ENTITY, DesiredWavelengthBands=["LWIR"])
    blind = refused(tmp_path / "blind", task, *moving())
    assert any("no camera" in text for text in blind), blind
    pair = lmcp.new("BlockadeTask", TaskID=5, BlockedEntityID=ENTITY, NumberVehicles=2)
    alone = refused(tmp_path / "alone", pair, *moving())
    assert any("task 5" in text for text in alone), alone


def zone_around(latitude: float, longitude: float, radius_m: float = 300.0) -> Any:
    area = lmcp.new("Circle", CenterPoint=place(latitude, longitude), Radius=radius_m)
    return lmcp.new("KeepOutZone", ZoneID=3, Boundary=area, MaxAltitude=1000.0)


def test_no_circle_about_an_entity_in_a_zone_is_offered_or_flown(tmp_path: Path) -> None:
    region = lmcp.new("OperatingRegion", ID=4, KeepOutAreas=[3])
    (tmp_path / "rig").mkdir()
    rig = Rig(tmp_path / "rig")
    rig.tell(*aircraft(1, 0.0), *moving(0.5), zone_around(0.031, 0.002), region, escort())
    rig.tell(request(5, OperatingRegion=4))
    assert any("its circle about entity 9 breaks" in text for text in rig.reasons("Warning"))
    (answer,) = rig.got("AutomationResponse")
    assert any("its circle about entity 9 breaks" in pair.Value for pair in answer.Info), (
        answer.Info
    )
    # a zone that the entity comes into while it is escorted: the aircraft keeps out of it
    rig = Rig(tmp_path / "rig")
    rig.tell(*aircraft(1, 0.02), *moving(5.0), zone_around(0.05, 0.002), region, escort())
    rig.tell(request(5, OperatingRegion=4))
    assert not rig.reasons(), rig.reasons()
    rig.tell(
        aircraft(1, 0.029)[1].copy(AssociatedTasks=[5], CurrentWaypoint=99, Time=1, Mode="Waypoint")
    )
    told = len(rig.got("VehicleActionCommand"))
    assert told == 1
    (command,) = rig.got("VehicleActionCommand")
    circling = aircraft(1, 0.045)[1].copy(CurrentCommand=command.CommandID, Mode="Loiter", Time=2)
    rig.tell(moving(5.0)[1].copy(Location=place(0.05, 0.002), Time=2), circling)
    assert len(rig.got("VehicleActionCommand")) == told
    assert any("does not follow: " in text for text in rig.reasons("Warning"))


@pytest.mark.parametrize(
    ("south_m", "zone_m", "begins_m", "ends_m"),
    [(3000, 0, 3 * RADIUS_M, 0), (250, 0, 1.5 * RADIUS_M, -1.5 * RADIUS_M), (3000, 20, 10, -10)],
    ids=["far", "near", "no room"],
)
def test_the_way_in_ends_at_the_rim_or_goes_through_it_where_there_is_no_room_before(
    tmp_path: Path, south_m: float, zone_m: float, begins_m: float, ends_m: float
) -> None:
    """begins_m, ends_m: outside of the rim; zone_m: about a place one radius outside of it."""
    degree_m = local([place(1.0)], place(0.0))[0].x
    at = place(0.03 - south_m / degree_m, 0.002)
    zone = zone_around(0.03 - 2 * RADIUS_M / degree_m, 0.002, zone_m or 1.0)
    region = lmcp.new("OperatingRegion", ID=4, KeepOutAreas=[3] if zone_m else [])
    rig = Rig(tmp_path)
    rig.tell(aircraft(1, 0.0)[0], aircraft(1, 0.0)[1].copy(Location=at), *moving(0.0))
    rig.tell(zone, region, escort(), request(5, OperatingRegion=4))
    (option,) = rig.got("TaskPlanOptions")[0].Options
    for end, out_m in ((option.StartLocation, begins_m), (option.EndLocation, ends_m)):
        (found,) = local([end], place(0.03, 0.002))
        assert found == pytest.approx((-RADIUS_M - out_m, 0), abs=5)


def test_who_flies_by_another_s_command_ends_the_task_undone(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    rig.tell(*aircraft(1, 0.02), *moving(5.0), escort(), request(5))
    listed = aircraft(1, 0.029)[1].copy(
        AssociatedTasks=[5], CurrentWaypoint=99, Time=1, Mode="Waypoint"
    )
    rig.tell(listed)
    (command,) = rig.got("VehicleActionCommand")
    ours = listed.copy(AssociatedTasks=[], Mode="Loiter", CurrentCommand=command.CommandID, Time=2)
    rig.tell(ours)
    assert len(rig.got("VehicleActionCommand")) == 2
    rig.tell(ours.copy(CurrentCommand=7, Time=3), ours.copy(Time=4))
    assert len(rig.got("VehicleActionCommand")) == 2
    assert any("task 5 ends undone" in text for text in rig.reasons("Warning"))
    rig.tell(request(5))
    assert rig.got("AutomationResponse")[-1].MissionCommandList, "and it can be asked for again"


def test_nobody_counts_as_there_when_the_entity_or_he_was_not_heard(tmp_path: Path) -> None:
    """An entity that fell silent: the dwell does not go on, whatever the vehicle says."""
    rig, state = escorted(tmp_path)
    for time_ms in range(2000, 30_000, 1000):
        rig.tell(state.copy(Time=time_ms))
    assert not rig.got("TaskComplete")
    for time_ms in range(30_000, 41_000, 1000):
        rig.tell(moving(1.0)[1].copy(Time=time_ms), state.copy(Time=time_ms))
    (complete,) = rig.got("TaskComplete")
    assert complete.TimeTaskCompleted == 40_000


def test_what_stands_still_is_looked_at_as_a_point_and_followed_once_it_moves(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path)
    task = lmcp.new("WatchTask", TaskID=5, WatchedEntityID=ENTITY)
    rig.tell(*aircraft(1, 0.0), *moving(0.0), task, request(5))
    assert len(rig.got("TaskPlanOptions")[0].Options) > 1, "passes from all sides"
    rig.tell(aircraft(1, 0.0)[1].copy(AssociatedTasks=[5]))
    (look,) = rig.got("VehicleActionCommand")
    assert [type(a).__name__ for a in look.VehicleActionList] == ["GimbalStareAction"]
    rig.tell(moving(5.0)[1], request(5))
    assert len(rig.got("TaskPlanOptions")[1].Options) == 2, "at its usual and at its greatest speed"
    rig.tell(aircraft(1, 0.0)[1].copy(AssociatedTasks=[5], Mode="Waypoint", CurrentWaypoint=99))
    told = rig.got("VehicleActionCommand")[1].VehicleActionList
    assert [type(a).__name__ for a in told] == ["LoiterAction", "GimbalStareAction"]
