"""A later request with a task that an earlier one had: what was made for it is not made anew."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, loiter, must_fly, place, request, vehicle

from cratous.bridge import lmcp
from cratous.services.loading.ground import GroundVehicle
from cratous.services.loading.uxas_frame import BESIDE_DEG
from cratous.services.planning import inputs, options
from cratous.spec.mission import Daa, Frame, Mission, Position, Task, TaskKind, Vehicle, WellClear
from cratous.spec.mission.plan import Pose


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """The tasks for which options are made, in order."""
    found: list[int] = []
    expand = inputs.expand

    def counted(mission: Any, tasks: Any, zones: Any, **more: Any) -> Any:
        found.extend(task.id for task in tasks)
        return expand(mission, tasks, zones, **more)

    monkeypatch.setattr(inputs, "expand", counted)
    return found


def moved(number: int, latitude: float, longitude: float = 0.0) -> Any:
    return vehicle(number)[1].copy(Location=place(latitude, longitude))


def offered(rig: Rig) -> Any:
    """The last options of the task, without the request's number."""
    return rig.got("TaskPlanOptions")[-1].copy(CorrespondingAutomationRequestID=0)


def test_options_are_made_once_however_the_vehicle_has_moved(
    tmp_path: Path, made: list[int]
) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), must_fly(5), must_fly(6), request(5))
    first = offered(rig)
    rig.tell(moved(1, -0.005, 0.003), request(5))
    assert made == [5]
    assert offered(rig) == first
    assert all(a.MissionCommandList for a in rig.got("AutomationResponse"))
    rig.tell(request(5, 6))
    assert made == [5, 6]


def test_a_plan_from_options_that_were_there_is_the_one_from_new_ones(tmp_path: Path) -> None:
    plans = []
    for earlier in (False, True):
        folder = tmp_path / str(earlier)
        folder.mkdir()
        rig = Rig(folder)
        rig.tell(*vehicle(1), must_fly(5), *([request(5)] if earlier else []))
        rig.tell(moved(1, -0.005, 0.003), request(5))
        (command,) = rig.got("AutomationResponse")[-1].MissionCommandList
        plans.append([(w.Latitude, w.Longitude, w.Altitude, w.Speed) for w in command.WaypointList])
    assert len(plans[0]) == len(plans[1])
    for one, other in zip(*plans, strict=True):
        assert one == pytest.approx(other, abs=1e-6)


@pytest.mark.parametrize(
    "changed",
    [
        loiter(5, 0.021),
        vehicle(1)[0].copy(NominalSpeed=21.0),
        lmcp.new(
            "KeepOutZone", ZoneID=3, MaxAltitude=1000.0,
            Boundary=lmcp.new("Circle", CenterPoint=place(0.05), Radius=50.0),
        ),
        moved(1, -3 * BESIDE_DEG),
    ],
    ids=["task", "vehicle", "zone", "frame"],
)  # fmt: skip
def test_options_are_made_anew_where_what_they_depend_on_is_another(
    tmp_path: Path, made: list[int], changed: Any
) -> None:
    rig = Rig(tmp_path)
    region = lmcp.new("OperatingRegion", ID=4, KeepOutAreas=[3])
    far = lmcp.new(
        "KeepOutZone", ZoneID=3, MaxAltitude=1000.0,
        Boundary=lmcp.new("Circle", CenterPoint=place(0.05), Radius=60.0),
    )  # fmt: skip
    rig.tell(*vehicle(1), far, region, loiter(5), request(5, OperatingRegion=4))
    rig.tell(changed, request(5, OperatingRegion=4))
    assert made == [5, 5]


def test_the_frame_stays_where_a_camera_looks_far(tmp_path: Path, made: list[int]) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), loiter(5), request(5))
    seen = lmcp.new("CameraState", PayloadID=1, Centerpoint=place(0.8), Footprint=[place(0.8)])
    rig.tell(moved(1, 0.0).copy(PayloadStateList=[seen]), request(5))
    assert made == [5]


def test_where_there_are_no_zones_no_circle_is_held_against_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    drawn: list[Any] = []
    monkeypatch.setattr(options, "first_bad_leg", lambda path, zones: drawn.append(path))
    rooms = options.hold_rooms(Pose(0.0, 0.0, 300.0, 0.0), 100.0, ())
    assert [(room.clockwise, room.radius_m) for room in rooms] == [(True, 200.0), (False, 200.0)]
    assert not drawn


def test_options_of_who_flew_are_not_those_of_one_who_drives() -> None:
    task = Task(5, TaskKind.MUST_FLY, "pass", points=(Position(0.0, 500.0, 100.0),))
    place = Pose(0.0, 0.0, 100.0, 0.0)
    volume, offered, before = WellClear(150.0, 30.0, 15.0, 0.0), [], None
    for kind in (Vehicle, GroundVehicle):
        who = kind(1, "one", Position(*place[:3]), 0.0, 20.0, 15.0, 30.0, 0.5, 0.0, False)
        mission = Mission("m", "m", Frame(0.0, 0.0), (who,), (task,), Daa(volume), relations="p5")
        now = inputs.Inputs(mission, {1: place})
        if before is not None:
            now.take_over(before)
        offered.append(len(now.options_of(5)))
        before = now
    assert offered[0] > 0
    assert offered[1] == 0
