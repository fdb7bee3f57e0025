"""Vehicles and missions with no more in them than a test asks for."""

from __future__ import annotations

from typing import Any

from cratous.spec.mission import Daa, Frame, Mission, Position, Task, TaskKind, Vehicle, WellClear


def plain_vehicle(number: int, at: Position, protected: bool = True) -> Vehicle:
    """Heading north at 20 m/s, without a camera."""
    return Vehicle(number, "", at, 0.0, 20.0, 15.0, 30.0, 0.5, 5.0, protected)


def must_fly(number: int, at: tuple[float, float, float], **more: Any) -> Task:
    """A point (north, east, altitude) [m] that has to be flown through; more: fields of the task."""
    return Task(number, TaskKind.MUST_FLY, points=(Position(*at),), **{"label": "", **more})


def plain_mission(vehicles: tuple[Vehicle, ...], tasks: tuple[Task, ...], **more: Any) -> Mission:
    """Vehicles and tasks, a frame and a volume of well clear; more: fields that are to be others."""
    fields: dict[str, Any] = {
        "name": "test",
        "source": "",
        "frame": Frame(45.0, -121.0),
        "daa": Daa(WellClear(100.0, 30.0, 10.0, 0.0)),
    }
    return Mission(vehicles=vehicles, tasks=tasks, **{**fields, **more})


FRAME_TEXT = "frame: {latitude_deg: 45.3, longitude_deg: -121.0, terrain_m: 0}\n"
"""The frame of missions that are written as YAML."""


def flown_text(name: str, *vehicles: str) -> str:
    """The head of a mission in YAML that is flown in steps of 0.5 s, down to its vehicles."""
    head = f"name: {name}\n{FRAME_TEXT}simulation: {{step_ms: 500, heartbeat_ms: 1000}}\n"
    return f"{head}vehicles:\n{''.join(vehicles)}"


def vehicle_text(
    number: int, east_m: int, alt_m: int, slowest: object = 18, fastest: object = 35
) -> str:
    """A vehicle in YAML that flies north at 25 m/s, with its least and greatest speed [m/s]."""
    place = f"{{north_m: 0, east_m: {east_m}, alt_m: {alt_m}}}"
    speeds = f"speed_m_s: 25, min_speed_m_s: {slowest}, max_speed_m_s: {fastest}"
    limits = "max_bank_deg: 35, max_climb_m_s: 5"
    return f"  - {{id: {number}, position: {place}, heading_deg: 0, {speeds}, {limits}}}\n"
