"""Parameters of a task that follows an entity, read from its message."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.pipeline.source import Known
from cratous.services.planning.performance_classes import MOMENT_MS
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, Task, TaskKind

VEHICLES_MOST = 8
"""Most vehicles that a task may require at one time."""
STANDOFF_MOST_M = 100_000.0
DURATION_MOST_MS = 86_400_000
DURATION = "Duration_ms"
"""Task parameter with the duration of an escort or a blockade [ms]."""
ROUTE_MOST, TOLD_MOST = 1024, 4096
"""Limits of PrescribedWaypoints, and of points on the entity's line or plan; beyond them the task is refused."""
RANGE_MOST_M = 1_000_000.0


class Tower(NamedTuple):
    """A radio tower: position north and east [m], and range [m]."""

    at: Vec2
    range_m: float


class Asked(NamedTuple):
    """Parameters of a task.

    entity: its id; needed: vehicles at one time; standoff_m: standoff distance; least_ms: required duration
    without a break, 0: until another plan; looks: equivalent search task for the camera, None for no camera;
    route: of the entity; protected: place to keep the entity away from; tower: radio tower of a relay;
    stands: place supported by a relay that has no entity (entity 0).
    """

    kind: str
    entity: int
    needed: int
    standoff_m: float
    least_ms: int
    looks: Task | None
    route: tuple[Vec2, ...]
    protected: Vec2 | None
    tower: Tower | None = None
    stands: Vec2 | None = None

    @property
    def watches(self) -> bool:
        """Whether the task is served by what the cameras see."""
        return self.kind in ("WatchTask", "MultiVehicleWatchTask")


def asked_of(body: Any, places: RequestPlaces, tower: Tower | None = None) -> Asked:
    """The parameters in a task's message; BadInput for values out of range. tower: of a relay."""
    kind, where = type(body).__name__, f"task {body.TaskID}"
    names = {
        "EscortTask": "SupportedEntityID",
        "BlockadeTask": "BlockedEntityID",
        "CommRelayTask": "SupportedEntityID",
    }
    entity = getattr(body, names.get(kind, "WatchedEntityID"))
    needed = getattr(body, "NumberVehicles", 1)
    within(needed, 1, VEHICLES_MOST, where, "NumberVehicles")
    standoff = float(getattr(body, "StandoffDistance", 0.0))
    # a negative distance is behind the entity
    least_m = -STANDOFF_MOST_M if kind == "EscortTask" else 0
    within(standoff, least_m, STANDOFF_MOST_M, where, "StandoffDistance")
    dwell = getattr(body, "DwellTime", 0)
    within(dwell, 0, DURATION_MOST_MS, where, "DwellTime")
    least = milliseconds(body, DURATION, DURATION_MOST_MS, 0)
    if kind in ("WatchTask", "MultiVehicleWatchTask"):
        least = max(dwell, least, MOMENT_MS)
    elif not least:
        least = dwell
    route: list[Vec2] = []
    prescribed = getattr(body, "PrescribedWaypoints", ())
    within(len(prescribed), 0, ROUTE_MOST, where, "number of PrescribedWaypoints")
    for k, waypoint in enumerate(prescribed):
        pose = places.pose(waypoint, 0.0, where, f"PrescribedWaypoints[{k}]")
        route.append(Vec2(pose.north_m, pose.east_m))
    protected = getattr(body, "ProtectedLocation", None)
    kept = None
    if protected is not None:
        pose = places.pose(protected, 0.0, where, "ProtectedLocation")
        kept = Vec2(pose.north_m, pose.east_m)
    return Asked(
        kind, entity, needed, standoff, least, _looks(body, where), tuple(route), kept,
        tower, _stands(body, places, where),
    )  # fmt: skip


def _stands(body: Any, places: RequestPlaces, where: str) -> Vec2 | None:
    """The place that a relay supports, if it supports no entity."""
    if type(body).__name__ != "CommRelayTask" or body.SupportedEntityID:
        return None
    if body.DestinationLocation is None:
        raise BadInput(
            "it supports nothing", where=where, item="SupportedEntityID, DestinationLocation",
            expected="an entity, or a place", got="neither",
        )  # fmt: skip
    pose = places.pose(body.DestinationLocation, 0.0, where, "DestinationLocation")
    return Vec2(pose.north_m, pose.east_m)


def tower_of(body: Any, places: RequestPlaces, world: Known) -> Tower:
    """The radio tower of a relay, from its configuration and its state, if any; BadInput if it is unknown."""
    where, number = f"task {body.TaskID}", body.TowerID
    known = {n: world.get("configuration", n) for n in world.ids("configuration")}
    towers = {n: c for n, c in known.items() if type(c).__name__ == "RadioTowerConfiguration"}
    if number not in towers:
        raise BadInput(
            f"task {body.TaskID} uses a radio tower of which no message has told",
            where=where, item="TowerID",
            expected="one of " + (", ".join(map(str, sorted(towers))) or "none"),
            got=str(number),
        )  # fmt: skip
    range_m, state = float(towers[number].Range), world.get("state", number)
    within(range_m, 1, RANGE_MOST_M, where, f"Range of tower {number}")
    at = towers[number].Position if state is None else state.Location
    pose = places.pose(at, 0.0, where, f"place of tower {number}")
    return Tower(Vec2(pose.north_m, pose.east_m), range_m)


def route_named(body: Any, world: Known) -> tuple[Any, Sequence[Any]]:
    """The message with the route of a task's entity, and the route's points; None and () if there is none.

    RouteID names a line; for an escort with RouteID 0, the entity's own plan is its route.
    """
    number = getattr(body, "RouteID", 0)
    if number:
        line = world.get("line", number)
        return line, () if line is None else line.Line
    if type(body).__name__ != "EscortTask":
        return None, ()
    plan = world.get("mission", body.SupportedEntityID)
    return plan, () if plan is None else plan.WaypointList


def unused_of(body: Any, world: Known) -> list[str]:
    """Parameters of a task's message that are not used, in words."""
    said, of = [], f"of task {body.TaskID} is not used"
    route = getattr(body, "RouteID", 0)
    if route and route_named(body, world)[0] is None:
        text = "no such line was told of; the entity goes along PrescribedWaypoints, or straight on"
        said.append(f"RouteID {route} {of}: {text}")
    if getattr(body, "DestinationLocation", None) is not None and body.SupportedEntityID:
        text = f"entity {body.SupportedEntityID} is supported where its states say that it is"
        said.append(f"DestinationLocation {of}: {text}")
    return said


def milliseconds(body: Any, key: str, most: int, default: int) -> int:
    """A duration parameter of a task message [ms], from 1 to `most`; `default` if it is not given."""
    for pair in body.Parameters:
        if pair.Key == key:
            text = pair.Value
            value = int(text) if text.isascii() and text.isdigit() and len(text) < 10 else 0
            within(value, 1, most, f"task {body.TaskID}", f"Parameters: {key}", text)
            return value
    return default


def _looks(body: Any, where: str) -> Task | None:
    """The search task equivalent to a SearchTask's camera requirements; None for other tasks."""
    if not hasattr(body, "DesiredWavelengthBands"):
        return None
    gsd = float(body.GroundSampleDistance)
    within(gsd, 0, math.inf, where, "GroundSampleDistance")
    bands = [band.name for band in body.DesiredWavelengthBands]
    return Task(
        id=body.TaskID,
        kind=TaskKind.POINT_SEARCH,
        label=where,
        points=(Position(0.0, 0.0, 0.0),),
        wavelength=bands[0] if len(bands) == 1 else "AllAny",
        gsd_m=gsd if math.isfinite(gsd) else 0.0,
    )


def within(
    value: float, least: float, most: float, where: str, item: str, got: str | None = None
) -> None:
    """BadInput for a value out of range."""
    if not least <= value <= most:
        raise BadInput(
            "out of range",
            where=where,
            item=item,
            expected=f"{least:g} to {most:g}",
            got=f"{value:g}" if got is None else got[:40],
        )
