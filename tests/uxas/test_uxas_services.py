"""Sensors, regions, leash, batches, task tracking: each alone on a bus."""

from __future__ import annotations

from math import atan, degrees, radians, sin, tan
from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import mission, response
from pipeline_tools import PIPELINE, Rig, loiter, must_fly, place, request, vehicle

from cratous.bridge import lmcp

SENSORS, REGION = "SensorManagerService", "OperatingRegionStateService"


# --- sensors -------------------------------------------------------------------------------------


def footprints(rig: Rig, **fields: Any) -> list[Any]:
    asked = lmcp.new("FootprintRequest", FootprintRequestID=8, **{"VehicleID": 1, **fields})
    rig.tell(lmcp.new("SensorFootprintRequests", RequestID=70, Footprints=[asked]))
    answer = rig.got("SensorFootprintResponse")[-1]
    assert answer.ResponseID == 70
    return list(answer.Footprints)


@pytest.mark.shows(
    SENSORS, "SensorFootprintRequests", "SensorFootprintResponse", "EntityConfiguration"
)
def test_footprints_of_camera_and_gimbal(tmp_path: Path) -> None:
    rig = Rig(tmp_path, SENSORS)
    rig.tell(vehicle(1)[0])
    (down,) = footprints(rig)
    half = tan(radians(25.0))
    assert (down.FootprintResponseID, down.CameraID, down.GimbalID) == (8, 2, 1)
    assert (down.GimbalElevation, down.AglAltitude, down.HorizontalFOV) == (-90.0, 300.0, 50.0)
    assert down.WidthCenter == pytest.approx(600 * half)
    assert down.HorizontalToCenter == pytest.approx(0.0, abs=1e-9)
    # the image is twice as wide as high
    assert down.HorizontalToLeadingEdge == pytest.approx(300 * half / 2)
    assert down.HorizontalToTrailingEdge == pytest.approx(-300 * half / 2)
    (steep,) = footprints(rig, AglAltitudes=[200.0], ElevationAngles=[-45.0])
    assert steep.SlantRangeToCenter == pytest.approx(200 / sin(radians(45)))
    tilt = degrees(atan(half / 2))
    assert steep.HorizontalToLeadingEdge == pytest.approx(200 / tan(radians(45 - tilt)))
    assert steep.HorizontalToTrailingEdge == pytest.approx(200 / tan(radians(45 + tilt)))
    assert steep.AchievedGSD == pytest.approx(steep.WidthCenter / 1000)


@pytest.mark.shows(SENSORS, "ElevationAngles")
def test_elevations_in_radians_if_the_configuration_says_so(tmp_path: Path) -> None:
    rig = Rig(tmp_path, SENSORS, **{SENSORS: 'ElevationAngles="radian"'})
    rig.tell(vehicle(1)[0])
    (made,) = footprints(rig, ElevationAngles=[radians(-60.0)])
    assert made.GimbalElevation == pytest.approx(-60.0)


def test_the_view_is_as_wide_as_the_sample_distance_allows(tmp_path: Path) -> None:
    rig = Rig(tmp_path, SENSORS)
    rig.tell(vehicle(1)[0])
    fine, coarse, finest = footprints(rig, GroundSampleDistances=[0.1, 5.0, 0.001])
    assert fine.AchievedGSD == pytest.approx(0.1, rel=1e-6)
    assert coarse.HorizontalFOV == 50.0
    assert finest.HorizontalFOV == 10.0  # as narrow as it goes; what is achieved says so
    assert finest.AchievedGSD > 0.05
    assert len(footprints(rig, AglAltitudes=[100.0, 200.0], ElevationAngles=[-90.0, -60.0])) == 4


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"VehicleID": 9}, "vehicle 9 has no configuration"),
        ({"EligibleWavelengths": ["LWIR"]}, "no camera for LWIR"),
        ({"ElevationAngles": [-10.0]}, "no ground in view"),
        ({"ElevationAngles": [10.0]}, "no ground in view"),
        ({"AglAltitudes": [-5.0]}, "no ground in view"),
    ],
)
@pytest.mark.shows(SENSORS, "ServiceStatus")
def test_what_sees_nothing_is_answered_and_named(
    tmp_path: Path, fields: dict[str, Any], words: str
) -> None:
    rig = Rig(tmp_path, SENSORS)
    rig.tell(vehicle(1)[0])
    assert footprints(rig, **fields) == []
    assert words in rig.reasons("Warning")[0]


# --- regions, leash, batches, tracking -----------------------------------------------------------


@pytest.mark.shows(REGION, "KeepInZone", "KeepOutZone", "RemoveZones", "OperatingRegion")
def test_the_region_is_that_of_all_zones(tmp_path: Path) -> None:
    rig = Rig(tmp_path, REGION)
    rig.tell(
        lmcp.new("KeepInZone", ZoneID=3),
        lmcp.new("KeepOutZone", ZoneID=5),
        lmcp.new("KeepOutZone", ZoneID=4),
        lmcp.new("KeepOutZone", ZoneID=4),
        lmcp.new("RemoveZones", ZoneList=[5, 77]),
    )
    found = [(r.ID, r.KeepInAreas, r.KeepOutAreas) for r in rig.got("OperatingRegion")]
    assert found == [(0, [3], []), (0, [3], [5]), (0, [3], [4, 5]), (0, [3], [4])]


def test_a_request_without_a_region_keeps_out_of_all_zones_that_are_told(tmp_path: Path) -> None:
    box = lmcp.new("Rectangle", CenterPoint=place(0.02), Width=800.0, Height=800.0)
    zone = lmcp.new("KeepOutZone", ZoneID=8, MaxAltitude=9000.0, Boundary=box)
    farthest = []
    for names in (PIPELINE, (*PIPELINE, REGION)):
        (tmp_path / str(len(names))).mkdir()
        rig = Rig(tmp_path / str(len(names)), *names)
        rig.tell(*vehicle(1), zone, must_fly(5, 0.04), request(5))
        (command,) = rig.got("AutomationResponse")[0].MissionCommandList
        farthest.append(max(abs(w.Longitude) for w in command.WaypointList))
    assert farthest[0] < 0.001
    assert farthest[1] > 400 / 111_320
    rig.tell(lmcp.new("RemoveZones", ZoneList=[8]), request(5))
    (command,) = rig.got("AutomationResponse")[1].MissionCommandList
    assert max(abs(w.Longitude) for w in command.WaypointList) < 0.001


def test_a_zone_that_begins_and_ends_at_minus_one_is_taken_out(tmp_path: Path) -> None:
    rig = Rig(tmp_path, REGION)
    gone = lmcp.new("KeepOutZone", ZoneID=4, StartTime=-1, EndTime=-1)
    rig.tell(gone, lmcp.new("KeepOutZone", ZoneID=4), gone, lmcp.new("KeepOutZone", ZoneID=4))
    assert [r.KeepOutAreas for r in rig.got("OperatingRegion")] == [[4], [], [4]]


@pytest.mark.shows(REGION, "AdditionalPadding", "KeepInZone", "KeepOutZone")
def test_zones_are_padded_by_more_and_each_once(tmp_path: Path) -> None:
    rig = Rig(tmp_path, REGION, **{REGION: 'AdditionalPadding="25"'})
    zone = lmcp.new("KeepOutZone", ZoneID=4, Padding=10.0, Label="a")
    rig.tell(zone, lmcp.new("KeepInZone", ZoneID=5), zone)  # a zone may be told again, as it was
    padded = [z.Padding for z in rig.got("KeepOutZone") if z.Padding != 10.0]
    assert padded == [35.0, 35.0]
    assert [z.Padding for z in rig.got("KeepInZone")] == [0.0, 25.0]
    rig.tell(zone.copy(Padding=60.0))  # as another service of this kind pads it
    assert rig.got("KeepOutZone")[-1].Padding == 60.0
    # by less than is added: no service of this kind has done that
    rig.tell(zone.copy(Padding=12.0))
    assert [z.Padding for z in rig.got("KeepOutZone")][-2:] == [12.0, 37.0]
    rig.tell(zone.copy(Label="b"))  # another zone of this id
    assert [(z.Label, z.Padding) for z in rig.got("KeepOutZone")][-2:] == [("b", 10.0), ("b", 35.0)]
    assert [r.KeepOutAreas for r in rig.got("OperatingRegion")] == [[4], [4]]


@pytest.mark.shows(
    "LoiterLeash",
    "SafeHeadingAction",
    "RoutePlanRequest",
    "RoutePlanResponse",
    "VehicleActionCommand",
    "EntityState",
    "EntityConfiguration",
    "VehicleID",
    "LeadDistance",
    "RadiusBuffer",
    "ServiceStatus",
)
def test_a_vehicle_on_the_leash_loiters_at_the_end_of_a_safe_route(tmp_path: Path) -> None:
    attributes = 'VehicleID="1" LeadDistance="2000" RadiusBuffer="50"'
    planner = "RoutePlannerVisibilityService"
    rig = Rig(tmp_path, "LoiterLeash", planner, LoiterLeash=attributes)
    action = lmcp.new("SafeHeadingAction", VehicleID=1, DesiredHeading=0.0)
    rig.tell(action)
    assert not rig.got("RoutePlanRequest")  # where it is is not known
    rig.tell(*vehicle(1), *vehicle(2), action, action.copy(VehicleID=2))
    (asked,) = rig.got("RoutePlanRequest")
    north = asked.RouteRequests[0].EndLocation.Latitude
    assert north * 110_574 == pytest.approx(2000, rel=1e-3)
    (command,) = rig.got("VehicleActionCommand")
    (made,) = command.VehicleActionList
    assert command.VehicleID == 1
    assert made.Location.Latitude == pytest.approx(north, abs=1e-7)
    assert made.Radius == pytest.approx(400 / (9.80665 * tan(radians(30))) + 50)
    # the point ahead is forbidden: it loiters where it is
    box = lmcp.new("Rectangle", CenterPoint=place(north), Width=500.0, Height=500.0)
    rig.tell(
        lmcp.new("KeepOutZone", ZoneID=8, MaxAltitude=9000.0, Boundary=box),
        lmcp.new("OperatingRegion", ID=3, KeepOutAreas=[8]),
        action.copy(OperatingRegion=3, UseSpeed=True, Speed=17.0, LoiterRadius=300.0),
    )
    (made,) = rig.got("VehicleActionCommand")[1].VehicleActionList
    assert (made.Location.Latitude, made.Airspeed, made.Radius) == (0.0, 17.0, 300.0)
    assert len(rig.reasons("Warning")) == 1


def test_all_of_the_leash_s_circle_keeps_out_of_the_zones(tmp_path: Path) -> None:
    attributes = 'VehicleID="1" LeadDistance="2000"'
    rig = Rig(tmp_path, "LoiterLeash", "RoutePlannerVisibilityService", LoiterLeash=attributes)
    action = lmcp.new(
        "SafeHeadingAction", VehicleID=1, DesiredHeading=0.0, OperatingRegion=3, LoiterRadius=300.0
    )
    north = 2000 / 110_574
    beside = lmcp.new("Rectangle", CenterPoint=place(north, 0.0035), Width=300.0, Height=900.0)
    zone = lmcp.new("KeepOutZone", ZoneID=8, MaxAltitude=9000.0, Boundary=beside)
    region = lmcp.new("OperatingRegion", ID=3, KeepOutAreas=[8])
    rig.tell(*vehicle(1), zone, region, action)
    # the point ahead is 240 m from the zone: free, but 300 m around it are not
    (made,) = rig.got("VehicleActionCommand")[0].VehicleActionList
    assert made.Location.Latitude < north - 0.0005
    assert rig.got("RoutePlanResponse")[0].RouteResponses[0].RouteCost > 0
    # a smaller circle fits there; and one below the zone
    rig.tell(action.copy(LoiterRadius=200.0))
    (made,) = rig.got("VehicleActionCommand")[1].VehicleActionList
    assert made.Location.Latitude == pytest.approx(north, abs=1e-6)
    rig.tell(zone.copy(MinAltitude=1000.0), action)
    (made,) = rig.got("VehicleActionCommand")[2].VehicleActionList
    assert made.Location.Latitude == pytest.approx(north, abs=1e-6)
    # around the vehicle itself there is no room either: it says so
    rig.tell(zone, action.copy(LoiterRadius=5000.0))
    assert rig.got("VehicleActionCommand")[3].VehicleActionList[0].Location.Latitude == 0.0
    assert "breaks keep-out zone 8" in rig.reasons("Warning")[-1]


@pytest.mark.shows(
    "BatchSummaryService",
    "BatchSummaryRequest",
    "TaskAutomationRequest",
    "TaskAutomationResponse",
    "BatchSummaryResponse",
    "KeepOutZone",
    "EntityState",
    "EntityConfiguration",
)
def test_each_vehicle_is_tried_for_each_task_and_summed_up(tmp_path: Path) -> None:
    rig = Rig(tmp_path, *PIPELINE, "BatchSummaryService")
    box = lmcp.new("Rectangle", CenterPoint=place(0.01), Width=300.0, Height=300.0)
    rig.tell(
        *vehicle(1),
        *vehicle(2, 0.05),
        loiter(5),
        loiter(6, 0.03, EligibleEntities=[2]),
        lmcp.new("KeepOutZone", ZoneID=8, MaxAltitude=9000.0, Boundary=box),
    )
    rig.tell(lmcp.new("BatchSummaryRequest", RequestID=7, Vehicles=[1, 2], TaskList=[5, 6]))
    assert len(rig.got("TaskAutomationRequest")) == 4
    assert all(u.SandBoxRequest for u in rig.got("UniqueAutomationRequest"))
    (summary,) = rig.got("BatchSummaryResponse")
    assert summary.ResponseID == 7
    five, six = summary.Summaries
    assert [(v.VehicleID, v.DestinationTaskID) for v in five.PerformingVehicles] == [(1, 5), (2, 5)]
    one, two = five.PerformingVehicles
    assert (one.ROZIDs, one.ConflictsWithROZ) == ([8], True)  # it does not bind, but is met
    assert (two.ROZIDs, two.ConflictsWithROZ) == ([], False)
    assert one.TimeOnTask == pytest.approx(60_000, rel=0.01)  # along the legs between its waypoints
    assert one.TimeToArrive > 50_000
    unable, able = six.PerformingVehicles
    assert (unable.TimeToArrive, unable.TimeOnTask, unable.WaypointList) == (-1, -1, [])
    assert able.TimeOnTask == pytest.approx(60_000, rel=0.01)
    assert not rig.got("AutomationResponse")
    assert not rig.said.has("fails at")
    rig.tell(lmcp.new("BatchSummaryRequest", RequestID=9))
    assert rig.got("BatchSummaryResponse")[1].Summaries == []
    rig.tell(lmcp.new("BatchSummaryRequest", RequestID=10, TaskList=[5]))  # all vehicles
    (every,) = rig.got("BatchSummaryResponse")[2].Summaries
    assert [v.VehicleID for v in every.PerformingVehicles] == [1, 2]


@pytest.mark.shows(
    "TaskTrackerService",
    "Task",
    "AutomationResponse",
    "MissionCommand",
    "EntityState",
    "RemoveTasks",
)
def test_the_tracker_tells_what_becomes_of_tasks(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "TaskTrackerService")

    def told() -> list[str]:
        return [line.partition("task ")[2] for line in rig.said if "TaskTracker" in line][1:]

    flies = lmcp.new("AirVehicleState", ID=1, AssociatedTasks=[9])
    rig.tell(loiter(9), response(mission(5)), flies, mission(5), flies)
    rig.tell(lmcp.new("AirVehicleState", ID=1), flies.copy(ID=3))
    assert told() == [
        "9 is known",
        "9 is assigned (vehicle 1)",
        "9 is active (vehicle 1)",
        "9 is done (vehicle 1)",
        "9 is active (vehicle 3)",
    ]
    rig.tell(lmcp.new("RemoveTasks", TaskList=[9]))
    assert rig.bus.state("TaskTrackerService") == {}
