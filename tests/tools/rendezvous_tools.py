"""What the tests of rendezvous share: who meets, where, and how far they are."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from following_tools import aircraft
from pipeline_tools import PIPELINE, Rig, place, request
from uxas_flight import Flight, fly, local
from uxas_tools import write_cfg

from cratous.bridge import lmcp
from cratous.services.simulator.world import Event

PLACES = ((0.04, 0.0), (0.04, 0.004), (0.045, 0.01))


def meeting(*entities: int, needed: int | None = None, **more: Any) -> Any:
    """A rendezvous of entities, each at a place of its own, northward."""
    states = [
        lmcp.new(
            "PlanningState", EntityID=entity, PlanningPosition=place(*PLACES[k]),
            PlanningHeading=0.0,
        )
        for k, entity in enumerate(entities)
    ]  # fmt: skip
    count = len(entities) if needed is None else needed
    values = {"NumberOfParticipants": count, "RendezvousStates": states}
    return lmcp.new("RendezvousTask", **{"TaskID": 5, **values, **more})


def told(folder: Path, task: Any, *more: Any, vehicles: int = 2, **limits: float) -> Rig:
    """What is said of a request with this task."""
    rig = Rig(folder)
    for vehicle in range(1, vehicles + 1):
        configuration, state = aircraft(vehicle, 0.001 * vehicle)
        rig.tell(configuration.copy(**{"MinimumSpeed": 15.0, **limits}), state)
    rig.tell(*more, task, request(5, vehicles=tuple(range(1, vehicles + 1))))
    return rig


def coming(folder: Path, slowest: float = 15.0, **more: Any) -> tuple[Rig, list[Any]]:
    """Two vehicles on their way to their run-ins, and states of theirs on these."""
    rig = told(folder, meeting(1, 2, **more), MinimumSpeed=slowest)
    states = []
    for vehicle, (latitude, longitude) in zip((1, 2), PLACES, strict=False):
        waypoints = next(
            c.WaypointList
            for c in rig.got("AutomationResponse")[-1].MissionCommandList
            if vehicle == c.VehicleID
        )
        mine = [w.Number for w in waypoints if w.AssociatedTasks]
        states.append(
            aircraft(vehicle, 0.0)[1].copy(
                Location=place(latitude - 0.006, longitude), AssociatedTasks=[5],
                Mode="Waypoint", CurrentWaypoint=mine[1], Time=1000,
            )
        )  # fmt: skip
    return rig, states


def under_way(folder: Path) -> tuple[Rig, list[Any]]:
    """Two vehicles on their run-ins, at one time, and their states then."""
    rig, states = coming(folder)
    rig.tell(*states)
    assert not rig.reasons("Warning")
    return rig, states


def sent_on(rig: Rig) -> int:
    """The vehicle that the last command sends on in its plan, 0 for a command of another kind."""
    last = rig.got("VehicleActionCommand")[-1]
    goes = type(last.VehicleActionList[-1]).__name__ == "GoToWaypointAction"
    return int(last.VehicleID) if goes else 0


def waiting(rig: Rig, one: Any) -> Any:
    """The state of the first vehicle as it waits, at the beginning of its run-in."""
    rig.tell(one.copy(CurrentWaypoint=one.CurrentWaypoint - 1))
    command = rig.got("VehicleActionCommand")[-1]
    assert type(command.VehicleActionList[-1]).__name__ == "LoiterAction"
    first = next(
        w
        for c in rig.got("AutomationResponse")[-1].MissionCommandList
        for w in c.WaypointList
        if c.VehicleID == 1 and w.AssociatedTasks
    )
    there = place(first.Latitude, first.Longitude)
    return one.copy(Mode="Loiter", CurrentCommand=command.CommandID, Location=there, Heading=0.0)


def flown(
    folder: Path,
    *tasks: Any,
    at: dict[int, float],
    seconds: float,
    wind: tuple[float, ...] = (),
    east: float = 0.002,
) -> Flight:
    """Vehicles, which begin at latitudes, each so far east of the one before [deg], do tasks."""
    kinds = "".join(f'<Service Type="{kind}"/>\n' for kind in PIPELINE)
    kinds += "".join(f'<Service Type="WaypointPlanManagerService" VehicleID="{v}"/>\n' for v in at)
    bodies = list[Any]()
    for k, (vehicle, latitude) in enumerate(at.items()):
        configuration, state = aircraft(vehicle, latitude)
        there = place(latitude, east * k)
        bodies += [configuration.copy(MinimumSpeed=15.0), state.copy(Location=there)]
    if wind:
        # its speed, and where it comes from
        bodies.insert(0, lmcp.new("WeatherReport", WindSpeed=wind[0], WindDirection=wind[1]))
    events = [Event(0.1 * k, body, "") for k, body in enumerate(bodies)]
    said = [(1.0, one) for one in tasks]
    numbers = [one.TaskID for one in tasks]
    said.append(
        (
            3.0,
            request(
                *numbers,
                vehicles=tuple(at),
                TaskRelationships=".(" + " ".join(f"p{n}" for n in numbers) + ")",
            ),
        )
    )
    return fly(write_cfg(folder, kinds), events, seconds, said)


def passed_s(flight: Flight, vehicle: int, at: tuple[float, float]) -> tuple[float, float]:
    """When a vehicle was nearest to a place [s], and how near [m]."""
    states = flight.states(vehicle)
    away = [math.hypot(*p) for p in local([s.Location for s in states], place(*at))]
    k = min(range(len(away)), key=away.__getitem__)
    return states[k].Time / 1000, away[k]
