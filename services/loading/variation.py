"""Seeded variants of a mission: different geometry, same scenario.

A *crossing* has two vehicles that reach one point at the same time and altitude. A variant draws
the angle between their courses, the course of the first, both speeds and the time to the crossing;
each vehicle starts that far before the point, and its own tasks rotate with it about the point.
"""

from __future__ import annotations

from dataclasses import replace
from math import atan2, cos, radians, sin
from random import Random
from typing import Any

from cratous.services.loading.document import Document
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Position, Task, Vehicle


def vary(mission: Mission, document: Document, seed: int) -> Mission:
    """Variant `seed` (> 0) of a mission, drawn as specified by its `variation` section; BadInput if it has none."""
    data = document.data.get("variation")
    key = ("variation",)
    if data is None:
        raise BadInput(
            "this mission has no variants",
            where=document.where(key),
            item="variation",
            expected="a variation section, or --seed 0",
            got=f"--seed {seed}",
        )
    known = [vehicle.id for vehicle in mission.vehicles]
    for number in data["vehicles"]:
        if number not in known:
            raise BadInput(
                "a vehicle that does not exist",
                where=document.where((*key, "vehicles")),
                item="variation.vehicles",
                expected=", ".join(map(str, known)),
                got=str(number),
            )
    for name in ("angle_deg", "speed_m_s", "time_to_crossing_s"):
        low, high = data[name]
        if low > high:
            raise BadInput(
                "an empty range",
                where=document.where((*key, name)),
                item=f"variation.{name}",
                expected="lower bound, then upper bound",
                got=f"{low:g}, {high:g}",
            )
    return _crossing(mission, data, Random(seed))


def _crossing(mission: Mission, data: dict[str, Any], random: Random) -> Mission:
    at = (float(data["at"]["north_m"]), float(data["at"]["east_m"]))
    first_rad = random.uniform(0.0, radians(360.0))
    side = random.choice((-1.0, 1.0))
    angle_rad = radians(random.uniform(*data["angle_deg"]))
    time_s = random.uniform(*data["time_to_crossing_s"])
    courses = (first_rad, first_rad + side * angle_rad)
    speeds = [random.uniform(*data["speed_m_s"]) for _ in courses]
    vehicles = {vehicle.id: vehicle for vehicle in mission.vehicles}
    turns: dict[int, float] = {}
    for number, course, speed in zip(data["vehicles"], courses, speeds, strict=True):
        turns[number] = course - vehicles[number].heading_rad
        vehicles[number] = _moved(vehicles[number], at, course, speed, time_s)
    return replace(
        mission,
        vehicles=tuple(vehicles[vehicle.id] for vehicle in mission.vehicles),
        tasks=tuple(_turned_task(task, at, turns) for task in mission.tasks),
    )


def _moved(
    vehicle: Vehicle, at: tuple[float, float], course_rad: float, speed_m_s: float, time_s: float
) -> Vehicle:
    """The vehicle `time_s` before the point, on the given course."""
    back = speed_m_s * time_s
    return replace(
        vehicle,
        position=Position(
            at[0] - back * cos(course_rad), at[1] - back * sin(course_rad), vehicle.position.alt_m
        ),
        heading_rad=atan2(sin(course_rad), cos(course_rad)),
        speed_m_s=speed_m_s,
    )


def _turned_task(task: Task, at: tuple[float, float], turns: dict[int, float]) -> Task:
    """The task rotated about the point with the only vehicle that may do it; other tasks stay."""
    if len(task.eligible) != 1 or task.eligible[0] not in turns:
        return task
    turn = turns[task.eligible[0]]

    def turned(point: Position) -> Position:
        north, east = point.north_m - at[0], point.east_m - at[1]
        return Position(
            at[0] + north * cos(turn) - east * sin(turn),
            at[1] + north * sin(turn) + east * cos(turn),
            point.alt_m,
        )

    loiter, start, sweep = task.loiter, task.start_point, task.sweep_rad
    if loiter is not None:
        loiter = replace(loiter, centre=turned(loiter.centre), axis_rad=loiter.axis_rad + turn)
    return replace(
        task,
        points=tuple(turned(point) for point in task.points),
        loiter=loiter,
        start_point=None if start is None else turned(start),
        sweep_rad=None if sweep is None else sweep + turn,
    )
