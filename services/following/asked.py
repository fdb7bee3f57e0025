"""What a task that keeps to an entity asks for, read from its message."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.services.pipeline.places import RequestPlaces
from cratous.services.planning.flyers import MOMENT_MS
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, Task, TaskKind

VEHICLES_MOST = 8
"""A task of more vehicles at one time is refused."""
STANDOFF_MOST_M = 100_000.0
DURATION_MOST_MS = 86_400_000
DURATION = "Duration_ms"
"""The task parameter that says for how long an escort or a blockade is kept."""
ROUTE_MOST = 1024


class Asked(NamedTuple):
    """entity: its id; needed: vehicles at one time; standoff [m]; least: for how long without a break [ms], 0:
    until another plan; looks: a search task that it is for the camera, None: it looks at nothing; route: of
    the entity; protected: the place to keep the entity from."""

    kind: str
    entity: int
    needed: int
    standoff_m: float
    least_ms: int
    looks: Task | None
    route: tuple[Vec2, ...]
    protected: Vec2 | None

    @property
    def watches(self) -> bool:
        """It is served by what its cameras see."""
        return self.kind in ("WatchTask", "MultiVehicleWatchTask")


def asked_of(body: Any, places: RequestPlaces) -> Asked:
    """What a task's message asks for; BadInput names what cannot be."""
    kind, where = type(body).__name__, f"task {body.TaskID}"
    names = {"EscortTask": "SupportedEntityID", "BlockadeTask": "BlockedEntityID"}
    entity = getattr(body, names.get(kind, "WatchedEntityID"))
    needed = getattr(body, "NumberVehicles", 1)
    _within(needed, 1, VEHICLES_MOST, where, "NumberVehicles")
    standoff = float(getattr(body, "StandoffDistance", 0.0))
    _within(standoff, 0, STANDOFF_MOST_M, where, "StandoffDistance")
    dwell = getattr(body, "DwellTime", 0)
    _within(dwell, 0, DURATION_MOST_MS, where, "DwellTime")
    least = _duration(body, where)
    if kind in ("WatchTask", "MultiVehicleWatchTask"):
        least = max(dwell, least, MOMENT_MS)
    elif not least:
        least = dwell
    route: list[Vec2] = []
    prescribed = getattr(body, "PrescribedWaypoints", ())
    _within(len(prescribed), 0, ROUTE_MOST, where, "number of PrescribedWaypoints")
    for k, waypoint in enumerate(prescribed):
        pose = places.pose(waypoint, 0.0, where, f"PrescribedWaypoints[{k}]")
        route.append(Vec2(pose.north_m, pose.east_m))
    protected = getattr(body, "ProtectedLocation", None)
    kept = None
    if protected is not None:
        pose = places.pose(protected, 0.0, where, "ProtectedLocation")
        kept = Vec2(pose.north_m, pose.east_m)
    return Asked(
        kind, entity, needed, standoff, least, _looks(body, where), tuple(route), kept
    )  # fmt: skip


def unused_of(body: Any) -> list[str]:
    """What a task's message asks for and gets not, in words."""
    route = getattr(body, "RouteID", 0)
    said = f"RouteID {route} of task {body.TaskID} is not used: where the entity goes is PrescribedWaypoints, or straight on"
    return [said] if route else []


def _duration(body: Any, where: str) -> int:
    """The task's own duration [ms], 0 for none."""
    for pair in body.Parameters:
        if pair.Key == DURATION:
            value = int(pair.Value) if pair.Value.isascii() and pair.Value.isdigit() else 0
            _within(value, 1, DURATION_MOST_MS, where, f"Parameters: {DURATION}", pair.Value)
            return value
    return 0


def _looks(body: Any, where: str) -> Task | None:
    """The search that a SearchTask is for its cameras."""
    if not hasattr(body, "DesiredWavelengthBands"):
        return None
    gsd = float(body.GroundSampleDistance)
    _within(gsd, 0, math.inf, where, "GroundSampleDistance")
    bands = [band.name for band in body.DesiredWavelengthBands]
    return Task(
        id=body.TaskID,
        kind=TaskKind.POINT_SEARCH,
        label=where,
        points=(Position(0.0, 0.0, 0.0),),
        wavelength=bands[0] if len(bands) == 1 else "AllAny",
        gsd_m=gsd if math.isfinite(gsd) else 0.0,
    )


def _within(
    value: float, least: float, most: float, where: str, item: str, got: str | None = None
) -> None:
    if not least <= value <= most:
        raise BadInput(
            "out of range",
            where=where,
            item=item,
            expected=f"{least:g} to {most:g}",
            got=f"{value:g}" if got is None else got[:40],
        )
