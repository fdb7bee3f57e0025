"""Vehicles and missions with no more in them than a test asks for."""

from __future__ import annotations

from typing import Any

from cratous.spec.mission import Daa, Frame, Mission, Position, Task, Vehicle, WellClear


def plain_vehicle(number: int, at: Position, protected: bool = True) -> Vehicle:
    """Heading north at 20 m/s, without a camera."""
    return Vehicle(number, "", at, 0.0, 20.0, 15.0, 30.0, 0.5, 5.0, protected)


def plain_mission(vehicles: tuple[Vehicle, ...], tasks: tuple[Task, ...], **more: Any) -> Mission:
    """Vehicles and tasks, a frame and a volume of well clear; more: fields that are to be others."""
    fields: dict[str, Any] = {
        "name": "test",
        "source": "",
        "frame": Frame(45.0, -121.0),
        "daa": Daa(WellClear(100.0, 30.0, 10.0, 0.0)),
    }
    return Mission(vehicles=vehicles, tasks=tasks, **{**fields, **more})
