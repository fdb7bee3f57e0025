"""AutomationDiagramDataService: the files of a planned request, and its picture."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.pipeline.world import World
from cratous.services.uxas.diagram import AutomationDiagramDataService

SERVICE = "AutomationDiagramDataService"


def place(north: float, east: float) -> Any:
    return lmcp.new("Location3D", Latitude=45 + north, Longitude=-121 + east)


def area(*corners: tuple[float, float]) -> Any:
    return lmcp.new("Polygon", BoundaryPoints=[place(*corner) for corner in corners])


SQUARE = ((0.0, 0.0), (0.0, 0.1), (0.1, 0.1), (0.1, 0.0))
WORLD = [
    lmcp.new("AirVehicleState", ID=400, Location=place(0.01, 0.01), Heading=90.0),
    lmcp.new("AirVehicleState", ID=500, Location=place(0.02, 0.01)),
    lmcp.new("LineSearchTask", TaskID=7, PointList=[place(0.03, 0.03), place(0.04, 0.05)]),
    lmcp.new("ImpactPointSearchTask", TaskID=8, SearchLocationID=31),
    lmcp.new("AngledAreaSearchTask", TaskID=9, SearchAreaID=32),
    lmcp.new("WatchTask", TaskID=10, WatchedEntityID=500, Label='"<x>&'),
    lmcp.new("PointOfInterest", PointID=31, Location=place(0.05, 0.06)),
    lmcp.new("AreaOfInterest", AreaID=32, Area=area(*((a / 2, b / 2) for a, b in SQUARE))),
    lmcp.new("KeepInZone", ZoneID=1, Boundary=area(*SQUARE)),
    lmcp.new("KeepOutZone", ZoneID=2, Boundary=lmcp.new("Circle", CenterPoint=place(0.07, 0.07), Radius=500.0)),
    lmcp.new("OperatingRegion", ID=5, KeepInAreas=[1], KeepOutAreas=[2, 99]),
]  # fmt: skip
ORIGINAL = lmcp.new(
    "AutomationRequest", EntityList=[400], TaskList=[7, 8, 9, 10, 77], OperatingRegion=5
)
REQUEST = lmcp.new(
    "UniqueAutomationRequest",
    RequestID=12,
    OriginalRequest=ORIGINAL,
    PlanningStates=[lmcp.new("PlanningState", EntityID=400, PlanningPosition=place(0.08, 0.01), PlanningHeading=45.0)],
)  # fmt: skip
WAYS = [lmcp.new("Waypoint", Number=k, Latitude=45 + k / 50, Longitude=-121.0) for k in (1, 2, 3)]
RESPONSE = lmcp.new(
    "UniqueAutomationResponse",
    ResponseID=12,
    OriginalResponse=lmcp.new(
        "AutomationResponse",
        MissionCommandList=[lmcp.new("MissionCommand", VehicleID=400, WaypointList=WAYS)],
    ),
)
NAMES = {
    "AreaOfInterest_Id_32.xml", "AutomationDiagram.svg", "EntityState_Id_400.xml", "PointOfInterest_Id_31.xml",
    "Task_Id_7.xml", "Task_Id_8.xml", "Task_Id_9.xml", "Task_Id_10.xml", "UniqueAutomationResponse_Id_12.xml",
    "WatchedEntity_Id_500.xml", "ZoneKeepIn_Id_1.xml", "ZoneKeepOut_Id_2.xml",
}  # fmt: skip


def run(folder: Path, *more: Any) -> list[Any]:
    """What the service says, with the world and these messages on its bus."""
    world, bus, said = World(), Bus(lmcp.full_names), []
    bus.add(world)
    bus.add(AutomationDiagramDataService("Diagram", world, folder, 100))
    bus.tap(lambda envelope: said.append(envelope) if envelope.source == "Diagram" else None)
    for body in (*WORLD, *more):
        bus.publish(body, "test")
    bus.run_until(0)
    return [envelope.body for envelope in said]


@pytest.mark.shows(SERVICE, "UniqueAutomationRequest", "UniqueAutomationResponse")
def test_each_response_gets_a_folder_of_its_own(tmp_path: Path) -> None:
    assert run(tmp_path, REQUEST, RESPONSE, REQUEST, RESPONSE) == []
    folder = tmp_path / "AutomationDiagramDataService"
    assert sorted(os.listdir(folder)) == [
        "0001_AutomationDiagram_ID0100",
        "0002_AutomationDiagram_ID0100",
    ]
    whole = folder / "0001_AutomationDiagram_ID0100"
    assert set(os.listdir(whole)) == NAMES
    (state,) = lmcp.xml.read_file(whole / "EntityState_Id_400.xml")
    assert state.Heading == 45.0  # what was planned from, not the newest state
    (response,) = lmcp.xml.read_file(whole / "UniqueAutomationResponse_Id_12.xml")
    assert response == RESPONSE


def test_a_response_is_passed_on_before_files_are_written_and_none_is_lost_at_the_end(
    tmp_path: Path,
) -> None:
    world, bus = World(), Bus(lmcp.full_names)
    bus.add(world)
    bus.add(AutomationDiagramDataService("Diagram", world, tmp_path, 100))
    for body in (*WORLD, REQUEST, RESPONSE):
        bus.publish(body, "test")
    bus.run()
    assert os.listdir(tmp_path) == []  # whoever waits for the response has it by now
    bus.remove("Diagram")
    assert set(os.listdir(next(tmp_path.rglob("0001_*")))) == NAMES


def test_the_picture_has_every_zone_task_vehicle_and_way(tmp_path: Path) -> None:
    run(tmp_path, REQUEST, RESPONSE)
    (path,) = tmp_path.rglob("AutomationDiagram.svg")
    root = etree.parse(path).getroot()
    texts = {node.text for node in root.iter("{*}text")}
    assert {"zone 1", "zone 2", "LineSearchTask 7", "vehicle 400", "vehicle 500"} <= texts
    assert {"PointOfInterest 31", "AreaOfInterest 32"} <= texts
    kinds = [node.get("class") for node in root.iter("{*}polygon")]
    assert sorted(kinds) == ["in", "out", "task"]
    lines = {node.get("class"): node.get("points") for node in root.iter("{*}polyline")}
    assert set(lines) == {"task", "way"}
    xy = [tuple(map(float, pair.split(","))) for pair in lines["way"].split()]
    assert len(xy) == 3
    assert xy[0][1] > xy[1][1] > xy[2][1]  # they go north, and north is up
    assert max(x for x, _ in xy) - min(x for x, _ in xy) < 0.5  # degrees of longitude converge
    assert all(0 <= x <= 1000 and 0 <= y <= 700 for x, y in xy)


def test_a_response_to_no_request_writes_nothing(tmp_path: Path) -> None:
    assert run(tmp_path, RESPONSE) == []
    assert os.listdir(tmp_path) == []


@pytest.mark.shows(SERVICE, "ServiceStatus")
def test_a_folder_that_cannot_be_written_is_said_and_nothing_is_half_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any, **__: Any) -> int:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    (said,) = run(tmp_path, REQUEST, RESPONSE)
    assert said.StatusType.name == "Error"
    assert "No space left on device" in said.Info[-1].Value
    assert os.listdir(tmp_path / "AutomationDiagramDataService") == []


def test_what_xml_cannot_hold_is_said_and_what_comes_after_is_written(tmp_path: Path) -> None:
    """A text of a client's keeps no other request from its files."""
    wrong = lmcp.new("WatchTask", TaskID=78, WatchedEntityID=500, Label="a\x01b")
    other = REQUEST.copy(RequestID=13, OriginalRequest=ORIGINAL.copy(TaskList=[78]))
    (said,) = run(tmp_path, wrong, other, RESPONSE.copy(ResponseID=13), REQUEST, RESPONSE)
    assert said.StatusType.name == "Error"
    assert "WatchTask.Label: text that XML cannot hold" in said.Info[-1].Value
    assert os.listdir(tmp_path / "AutomationDiagramDataService") == [
        "0001_AutomationDiagram_ID0100"
    ]
    assert set(os.listdir(next(tmp_path.rglob("0001_*")))) == NAMES
