"""Tasks as they are flown outside: `cratous uxas` commands an aircraft of `cratous sim`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import PIPELINE, request, vehicle
from uxas_flight import Flight, fly
from uxas_tools import write_cfg

from cratous.bridge import lmcp
from cratous.services.simulator.world import Event

TASKS = "Task services"
BEGIN_S = 3.0


def line(number: int, *points: tuple[float, float]) -> Any:
    return lmcp.new(
        "LineSearchTask",
        TaskID=number,
        PointList=[lmcp.new("Location3D", Latitude=lat, Longitude=lon) for lat, lon in points],
    )


BEND = ((0.02, 0.0), (0.05, 0.0), (0.07, 0.03), (0.10, 0.03))
NEXT = ((0.11, 0.04), (0.13, 0.04))


def aircraft() -> list[Any]:
    """Configuration and state of vehicle 1 at 20 m/s; its camera looks at the horizon at first."""
    configuration, state = vehicle(1)
    gimbal, camera = configuration.PayloadConfigurationList
    gimbal = gimbal.copy(
        MinAzimuth=-180.0, MaxAzimuth=180.0, MaxAzimuthSlewRate=100.0, MaxElevationSlewRate=100.0
    )
    level = configuration.NominalFlightProfile.copy(VerticalSpeed=0.0)
    ahead = lmcp.new("GimbalState", PayloadID=1, Azimuth=0.0, Elevation=0.0)
    return [
        configuration.copy(NominalFlightProfile=level, PayloadConfigurationList=[gimbal, camera]),
        state.copy(u=20.0, Airspeed=20.0, EnergyAvailable=100.0, PayloadStateList=[ahead]),
    ]


def flown(folder: Path, *tasks: Any, seconds: float, more: Any = (), **attributes: str) -> Flight:
    """Vehicle 1 does tasks in their order, by a whole UxAS."""
    kinds = (*PIPELINE, "WaypointPlanManagerService")
    attributes = {"WaypointPlanManagerService": 'VehicleID="1"', **attributes}
    text = "".join(f'<Service Type="{kind}" {attributes.get(kind, "")}/>\n' for kind in kinds)
    events = [Event(0.1 * k, body, "") for k, body in enumerate(aircraft())]
    order = ".(" + " ".join(f"p{task.TaskID}" for task in tasks) + ")"
    asked = request(*(task.TaskID for task in tasks), TaskRelationships=order)
    said = [(1.0, task) for task in tasks] + [(BEGIN_S, asked), *more]
    return fly(write_cfg(folder, text), events, seconds, said)


@pytest.fixture(scope="module")
def bend(tmp_path_factory: pytest.TempPathFactory) -> Flight:
    """Two lines, one after the other."""
    folder = tmp_path_factory.mktemp("bend")
    return flown(folder, line(5, *BEND), line(6, *NEXT), seconds=1400.0)


@pytest.mark.shows(TASKS, "EntityState", "TaskActive", "TaskComplete")
def test_tasks_are_active_and_complete_with_the_states_that_say_so(bend: Flight) -> None:
    """The last task too: the path ends with a waypoint that bears none."""
    lives = list[tuple[str, int, float]]()
    listed: tuple[int, ...] = ()
    for body in bend.states(1):
        now = tuple(body.AssociatedTasks)
        lives += [("TaskComplete", task, body.Time) for task in listed if task not in now]
        lives += [("TaskActive", task, body.Time) for task in now if task not in listed]
        listed = now
    told = [
        (kind, body.TaskID, at)
        for kind, body, at in (
            (type(e.body).__name__, e.body, getattr(e.body, field))
            for _, e in bend.told
            for field in ("TimeTaskActivated", "TimeTaskCompleted")
            if hasattr(e.body, field) and hasattr(e.body, "TaskID")
            if type(e.body).__name__ in ("TaskActive", "TaskComplete")
        )
    ]
    assert [(kind, task) for kind, task, _ in told] == [
        ("TaskActive", 5), ("TaskComplete", 5), ("TaskActive", 6), ("TaskComplete", 6),
    ]  # fmt: skip
    assert told == lives
    last = bend.command(1).WaypointList[-1]
    assert not last.AssociatedTasks
    before = bend.command(1).WaypointList[-2]
    assert (before.AssociatedTasks, before.NextWaypoint) == ([6], last.Number)
    assert (before.Latitude, before.Longitude) == (last.Latitude, last.Longitude)
