"""Differences between two missions, field by field: what a format could not represent."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from typing import Any, NamedTuple

from cratous.services.exporting.messages import payloads_of
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Loiter, Mission, Position, Task, TaskKind, Vehicle, Zone

WRITTEN_M = 1e-3
"""Accuracy with which positions written in degrees are recovered [m]."""
OF_FILES = frozenset({"source", "notes", "frame", "seed"})
"""Fields of a mission that concern its file. The frames may differ; positions are compared in one of them."""


class Difference(NamedTuple):
    """A field, and its values in the two missions."""

    item: str
    wanted: Any
    got: Any

    @property
    def text(self) -> str:
        """The difference in words."""
        return f"{self.item}: {_words(self.wanted)}; read again it would be {_words(self.got)}"


def differences(mission: Mission, again: Mission) -> list[Difference]:
    """What of a mission was not recovered in another one, which may have its own frame."""
    wanted, got = _spelt_out(mission), _spelt_out(_in_frame_of(mission, again))
    terrain = mission.frame.terrain_m, again.frame.terrain_m
    found = list(apart("frame.terrain_m", *terrain))
    for field in fields(Mission):
        if field.name not in OF_FILES:
            found += apart(field.name, getattr(wanted, field.name), getattr(got, field.name))
    # of records that only some missions have
    found += apart("bridge", mission.bridge_times, again.bridge_times)
    found += apart("bridge.uxas_route_planner", mission.live_planning, again.live_planning)
    return found


def apart(item: str, a: Any, b: Any, unsaid: frozenset[str] = frozenset()) -> Iterator[Difference]:
    """Fields that differ by more than the rounding of degrees and 32-bit floats; unsaid: names of
    fields to ignore.
    """
    if is_dataclass(a) and is_dataclass(b):
        for name in dict.fromkeys(field.name for one in (a, b) for field in fields(one)):
            if name not in unsaid:
                values = getattr(a, name, None), getattr(b, name, None)
                yield from apart(f"{item}.{name}", *values, unsaid)
    elif isinstance(a, tuple) and isinstance(b, tuple) and len(a) == len(b):
        names = [f".{name}" for name in getattr(a, "_fields", ())]
        for k, pair in enumerate(zip(a, b, strict=True)):
            yield from apart(f"{item}{names[k] if names else f'[{k}]'}", *pair, unsaid)
    elif isinstance(a, float) and isinstance(b, (int, float)) and not isinstance(b, bool):
        if abs(a - b) > WRITTEN_M * max(1.0, abs(a) / 1000):
            yield Difference(item, a, b)
    elif (a.value if isinstance(a, Enum) else a) != (b.value if isinstance(b, Enum) else b):
        yield Difference(item, a, b)


def spelt_out(task: Task) -> Task:
    """A loiter given only by centre and radius as a circle."""
    if task.kind is not TaskKind.LOITER or task.loiter is not None:
        return task
    return replace(task, loiter=Loiter(task.points[0], task.radius_m))


def _spelt_out(mission: Mission) -> Mission:
    """The mission with the defaults that readers fill in."""
    return replace(
        mission,
        vehicles=tuple(_filled_in(vehicle) for vehicle in mission.vehicles),
        tasks=tuple(spelt_out(task) for task in mission.tasks),
        zones=tuple(replace(z, label=z.label or f"zone {z.id}") for z in mission.zones),
    )


def _filled_in(vehicle: Vehicle) -> Vehicle:
    pairs = zip(vehicle.cameras, payloads_of(vehicle), strict=True)
    cameras = tuple(replace(camera, camera_id=seen.PayloadID) for camera, (_, seen) in pairs)
    return replace(vehicle, cruise_m=vehicle.cruise_alt_m, cameras=cameras)


def _in_frame_of(mission: Mission, again: Mission) -> Mission:
    """The second mission with its positions in the frame of the first."""
    here, there = Projection(mission.frame), Projection(again.frame)

    def move(north_m: float, east_m: float) -> tuple[float, float]:
        return here.to_local(*there.to_geodetic(north_m, east_m))

    moved: Mission = _moved(again, move)
    return moved


def _moved(value: Any, move: Callable[[float, float], tuple[float, float]]) -> Any:
    if isinstance(value, Position):
        return Position(*move(value.north_m, value.east_m), value.alt_m)
    if isinstance(value, Zone):
        return replace(value, vertices=tuple(move(*vertex) for vertex in value.vertices))
    if is_dataclass(value) and not isinstance(value, type):
        names = [field.name for field in fields(value)]
        return replace(value, **{name: _moved(getattr(value, name), move) for name in names})
    return tuple(_moved(part, move) for part in value) if type(value) is tuple else value


def _words(value: Any) -> str:
    if value is None or value == () or value == "":
        return "nothing"
    if isinstance(value, tuple) and is_dataclass(value[0]):
        return f"{len(value)} of them"
    if is_dataclass(value):
        return f"a {type(value).__name__}"
    return f"{value:g}" if isinstance(value, float) else str(value)[:80]
