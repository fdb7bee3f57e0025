"""What the tests of tasks that keep to what moves share: who flies, what moves, an escort of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pipeline_tools import Rig, place, request, vehicle

from cratous.bridge import lmcp

ENTITY = 9


def aircraft(number: int, latitude: float, speed: float = 20.0) -> list[Any]:
    """Configuration and state of an aircraft whose camera turns freely."""
    configuration, state = vehicle(number, latitude)
    gimbal, camera = configuration.PayloadConfigurationList
    gimbal = gimbal.copy(
        MinAzimuth=-180.0, MaxAzimuth=180.0, MaxAzimuthSlewRate=100.0, MaxElevationSlewRate=100.0
    )
    level = configuration.NominalFlightProfile.copy(VerticalSpeed=0.0, Airspeed=speed)
    return [
        configuration.copy(
            NominalFlightProfile=level,
            NominalSpeed=speed,
            MinimumSpeed=5.0,
            PayloadConfigurationList=[gimbal, camera],
        ),
        state.copy(u=speed, Airspeed=speed, EnergyAvailable=100.0),
    ]


def moving(speed: float = 6.0, course: float = 0.0) -> list[Any]:
    """An entity near the ground that flies straight on."""
    configuration, state = aircraft(ENTITY, 0.03, speed)
    low = place(0.03, 0.002).copy(Altitude=1.0)
    return [configuration, state.copy(Location=low, Heading=course)]


def refused(folder: Path, task: Any, *more: Any, vehicles: tuple[int, ...] = (1,)) -> list[str]:
    """What is said of a request with this task."""
    folder.mkdir(exist_ok=True)
    rig = Rig(folder)
    rig.tell(*(b for v in vehicles for b in aircraft(v, 0.001 * v)), *more, task)
    rig.tell(request(5, vehicles=vehicles))
    return rig.reasons() + rig.reasons("Warning")


def escort(**more: Any) -> Any:
    return lmcp.new("EscortTask", **{"TaskID": 5, "SupportedEntityID": ENTITY, **more})


def escorted(folder: Path) -> tuple[Rig, Any]:
    """An aircraft that escorts for ten seconds, told to circle; and its state there."""
    rig = Rig(folder)
    task = escort(Parameters=[lmcp.new("KeyValuePair", Key="Duration_ms", Value="10000")])
    rig.tell(*aircraft(1, 0.029), *moving(1.0), task, request(5))
    state = aircraft(1, 0.0301)[1].copy(
        Location=place(0.0301, 0.002), Mode="Waypoint", CurrentWaypoint=99
    )
    rig.tell(state.copy(AssociatedTasks=[5], Time=1000))
    (command,) = rig.got("VehicleActionCommand")
    return rig, state.copy(Mode="Loiter", CurrentCommand=command.CommandID)
