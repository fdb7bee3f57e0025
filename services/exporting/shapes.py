"""A mission's geometry as points, lines and areas in WGS-84, for map formats."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import MISSING, fields
from math import degrees
from typing import Any, NamedTuple

from cratous.services.loading.yaml_daa import DEFAULT_WELL_CLEAR
from cratous.services.mission.frames import Projection, compass
from cratous.spec.errors import BadInput
from cratous.spec.mission import (
    AREAS,
    Daa,
    Mission,
    Position,
    Task,
    TaskKind,
    Traffic,
    Vehicle,
    Zone,
)
from cratous.spec.mission.plan import Plan

POINT, LINE, AREA = "Point", "LineString", "Polygon"
Place = tuple[float, float, float]
"""Longitude and latitude [degrees], altitude [m MSL]."""
SAID_OF_MISSION = {
    "name", "source", "notes", "frame", "vehicles", "tasks", "zones", "traffic", "instances", "daa",
}  # fmt: skip
"""The last two are compared with their defaults."""
SAID_OF_TASK = {
    "id", "kind", "label", "points", "eligible", "duration_ms", "radius_m", "standoff_m", "gsd_m",
    "wavelength", "pattern", "extent_m", "priority",
}  # fmt: skip
SAID_OF_VEHICLE = {
    "id", "label", "position", "heading_rad", "speed_m_s", "min_speed_m_s", "max_speed_m_s",
    "max_bank_rad", "max_climb_m_s", "protected", "cruise_m", "power_w",
}  # fmt: skip

SAID_OF_TRAFFIC = {"id", "position", "velocity", "appears_ms", "vanishes_ms"}


class Shape(NamedTuple):
    """One map object. places: of an area its corners, counter-clockwise, closed by the first one;
    properties: plain data, with units in the names.
    """

    form: str
    places: tuple[Place, ...]
    properties: dict[str, Any]


def shapes(mission: Mission, plan: Plan | None = None) -> list[Shape]:
    """Starts of vehicles and traffic, tasks, zones, and the routes of a plan; BadInput for a shape
    that crosses the 180th meridian.
    """
    plane = Projection(mission.frame)
    return [
        *(_vehicle(one, plane) for one in mission.vehicles),
        *(_traffic(one, plane) for one in mission.traffic),
        *(_task(one, plane) for one in mission.tasks),
        *(_zone(one, plane) for one in mission.zones),
        *(_routes(plan, mission, plane) if plan else ()),
    ]


def unsaid(mission: Mission) -> list[str]:
    """Fields of a mission with non-default values that no shape represents."""
    found = list(_others(mission, "", SAID_OF_MISSION))
    guarded = tuple(vehicle.id for vehicle in mission.vehicles if vehicle.protected)
    found += ["instances"] * (mission.instances != guarded)
    found += ["daa"] * (mission.daa != Daa(DEFAULT_WELL_CLEAR))
    for k, vehicle in enumerate(mission.vehicles):
        found += _others(vehicle, f"vehicles[{k}].", SAID_OF_VEHICLE)
    for k, one in enumerate(mission.traffic):
        found += _others(one, f"traffic[{k}].", SAID_OF_TRAFFIC)
    for k, task in enumerate(mission.tasks):
        found += _others(task, f"tasks[{k}].", SAID_OF_TASK)
    return found


def _others(value: Any, before: str, said: set[str]) -> Iterator[str]:
    for field in fields(value):
        default = field.default if field.default_factory is MISSING else field.default_factory()
        if field.name not in said and getattr(value, field.name) != default:
            yield f"{before}{field.name}"


def _places(points: Iterable[Position], plane: Projection, item: str) -> tuple[Place, ...]:
    found = []
    for point in points:
        latitude, longitude = plane.to_geodetic(point.north_m, point.east_m)
        found.append((longitude, latitude, point.alt_m))
    # whole turns by which longitudes differ from those continuous with the frame's origin
    turns = {round((longitude - plane.frame.longitude_deg) / 360) for longitude, *_ in found}
    if len(turns) > 1:
        raise BadInput(
            "a shape that crosses the 180th meridian cannot be told in this format",
            item=item,
            expected="places on one side of it",
        )
    return tuple(found)


def _said(**values: Any) -> dict[str, Any]:
    """The properties that have a value."""
    return {name: value for name, value in values.items() if value not in (None, "", (), [])}


def _vehicle(vehicle: Vehicle, plane: Projection) -> Shape:
    places = _places([vehicle.position], plane, f"vehicle {vehicle.id}")
    properties = _said(
        kind="vehicle",
        id=vehicle.id,
        label=vehicle.label,
        altitude_msl_m=vehicle.position.alt_m,
        cruise_altitude_msl_m=vehicle.cruise_alt_m,
        heading_deg=compass(vehicle.heading_rad),
        speed_m_s=vehicle.speed_m_s,
        min_speed_m_s=vehicle.min_speed_m_s,
        max_speed_m_s=vehicle.max_speed_m_s,
        max_bank_deg=degrees(vehicle.max_bank_rad),
        max_climb_m_s=vehicle.max_climb_m_s,
        protected=vehicle.protected,
        power_w=vehicle.power_w,
    )
    return Shape(POINT, places, properties)


def _traffic(one: Traffic, plane: Projection) -> Shape:
    gone_s = None if one.vanishes_ms is None else one.vanishes_ms / 1000
    properties = _said(
        kind="traffic",
        id=one.id,
        label=f"traffic {one.id}",
        altitude_msl_m=one.position.alt_m,
        north_m_s=one.velocity.north_m_s,
        east_m_s=one.velocity.east_m_s,
        down_m_s=one.velocity.down_m_s,
        appears_s=one.appears_ms / 1000,
        vanishes_s=gone_s,
    )
    return Shape(POINT, _places([one.position], plane, f"traffic {one.id}"), properties)


def _task(task: Task, plane: Projection) -> Shape:
    corners, form = list(task.points), POINT
    if task.kind is TaskKind.LINE_SEARCH:
        form = LINE
    elif task.kind in AREAS and task.kind is not TaskKind.PATTERN_SEARCH:
        corners, form = _ring(task.points), AREA
    places = _places(corners, plane, f"task {task.id}")
    properties = _said(
        kind=task.kind.value,
        id=task.id,
        label=task.label,
        **_altitudes(places),
        eligible=list(task.eligible),
        priority=task.priority or None,
        duration_s=task.duration_ms / 1000 if task.duration_ms else None,
        radius_m=task.radius_m or None,
        standoff_m=task.standoff_m or None,
        ground_sample_distance_m=task.gsd_m or None,
        wavelength=task.wavelength,
        pattern=task.pattern.value if task.pattern else None,
        extent_m=task.extent_m or None,
    )
    return Shape(form, places, properties)


def _zone(zone: Zone, plane: Projection) -> Shape:
    ring = _ring([Position(*vertex, 0.0) for vertex in zone.vertices])
    properties = _said(
        kind=zone.kind.value,
        id=zone.id,
        label=zone.label or f"zone {zone.id}",
        floor_msl_m=zone.floor_m,
        ceiling_msl_m=zone.ceiling_m,
        padding_m=zone.padding_m or None,
    )
    return Shape(AREA, _places(ring, plane, f"zone {zone.id}"), properties)


def _routes(plan: Plan, mission: Mission, plane: Projection) -> Iterator[Shape]:
    """The route of each planned vehicle through its tasks; loiters before a task are properties."""
    for vehicle in mission.vehicles:
        chain = plan.chain(vehicle.id)
        points = [vehicle.position, *(p for i in chain for p in (*i.transit, *i.path))]
        points = [p for k, p in enumerate(points) if not k or p != points[k - 1]]
        if chain and points[1:]:
            places = _places(points, plane, f"the route of vehicle {vehicle.id}")
            properties = _said(
                kind="route",
                id=vehicle.id,
                label=f"route of {vehicle.label}",
                **_altitudes(places),
                speed_m_s=chain[0].speed_m_s,
                tasks=[
                    {
                        "id": item.task_id,
                        "arrives_s": item.arrive_ms / 1000,
                        "waits_s": item.wait_ms / 1000,
                        "starts_s": item.start_ms / 1000,
                        "ends_s": item.end_ms / 1000,
                    }
                    for item in chain
                ],
            )
            yield Shape(LINE, places, properties)


def _altitudes(places: Sequence[Place]) -> dict[str, Any]:
    """A single altitude if constant, otherwise one for each point [m MSL]."""
    altitudes = [altitude for *_, altitude in places]
    if len(set(altitudes)) == 1:
        return {"altitude_msl_m": altitudes[0]}
    return {"altitudes_msl_m": altitudes}


def _ring(points: Sequence[Position]) -> list[Position]:
    """Corners of a simple polygon, counter-clockwise seen from above, closed."""
    from shapely import Polygon
    from shapely.geometry.polygon import orient

    flat = orient(Polygon([(point.east_m, point.north_m) for point in points]), 1.0)
    heights = {(point.east_m, point.north_m): point.alt_m for point in points}
    return [Position(y, x, heights[(x, y)]) for x, y in flat.exterior.coords]
