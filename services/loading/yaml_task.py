"""One entry under `tasks` of a mission file as a `Task`."""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from typing import Any

from cratous.services.loading.coordinates import Places
from cratous.services.loading.polygons import circle, rectangle
from cratous.spec.errors import BadInput
from cratous.spec.mission import SEARCHES, Loiter, Pattern, Position, Task, TaskKind, View

FITS = {
    "rectangle": (TaskKind.AREA_SEARCH,),
    "circle": (TaskKind.AREA_SEARCH,),
    "sweep_deg": (TaskKind.AREA_SEARCH, TaskKind.PATTERN_SEARCH),
    "start": (TaskKind.AREA_SEARCH, TaskKind.PATTERN_SEARCH),
    "pattern": (TaskKind.PATTERN_SEARCH,),
    "extent_m": (TaskKind.PATTERN_SEARCH,),
    "standoff_m": (TaskKind.POINT_SEARCH,),
    "loiter": (TaskKind.LOITER, TaskKind.POINT_SEARCH),
    "radius_m": (TaskKind.LOITER,),
    "duration_s": (TaskKind.LOITER, TaskKind.POINT_SEARCH),
    "view": (TaskKind.LINE_SEARCH, TaskKind.POINT_SEARCH, TaskKind.AREA_SEARCH),
    "views": (TaskKind.LINE_SEARCH, TaskKind.POINT_SEARCH, TaskKind.AREA_SEARCH),
    "wavelength": SEARCHES,
    "ground_sample_distance_m": SEARCHES,
}
"""Entries that apply to these task kinds only; for other kinds they are refused, not ignored."""

WhereKey = Callable[[tuple[str | int, ...]], str]


def yaml_task(data: dict[str, Any], places: Places, where: WhereKey, number: int) -> Task:
    """The task; BadInput for an entry that does not apply to its kind."""
    kind = TaskKind(data["kind"])
    shapes = [name for name in ("points", "rectangle", "circle") if name in data]

    def refused(what: str, name: str, expected: str, got: str) -> BadInput:
        place = where(("tasks", number, name) if name in data else ("tasks", number))
        return BadInput(
            what, where=place, item=f"tasks[{number}].{name}", expected=expected, got=got
        )

    for name, kinds in FITS.items():
        if name in data and kind not in kinds:
            raise refused(
                f"a {kind} task has no {name}", name, "it under " + " or ".join(kinds), f"{kind}"
            )
    if "sweep_deg" in data and data.get("pattern", "sweep") != "sweep":
        raise refused(
            f"a {data['pattern']} has no sweep_deg", "sweep_deg", "it under pattern: sweep", "it"
        )
    if len(shapes) != 1:
        raise refused(
            f"a {kind} task says where in one way",
            (*shapes, "points")[0],
            "points" + (", rectangle or circle" if kind is TaskKind.AREA_SEARCH else ""),
            " and ".join(shapes) or "nothing",
        )
    if "view" in data and "views" in data:
        raise refused("view and views say it twice", "views", "one of them", "both")
    points = _points(data, places)
    views = tuple(_view(v) for v in data.get("views", [data["view"]] if "view" in data else []))
    sweep, start = data.get("sweep_deg"), data.get("start")
    return Task(
        id=int(data["id"]),
        kind=kind,
        label=data.get("label", f"task {data['id']}"),
        points=points,
        eligible=tuple(int(vehicle) for vehicle in data.get("eligible", [])),
        duration_ms=round(float(data.get("duration_s", 0)) * 1000),
        radius_m=float(data.get("radius_m", 0.0)),
        view=views[0] if views else None,
        wavelength=data.get("wavelength", "AllAny"),
        views=views[1:],
        standoff_m=float(data.get("standoff_m", 0.0)),
        loiter=_loiter(data, places, points[0]) if "loiter" in data else None,
        gsd_m=float(data.get("ground_sample_distance_m", 0.0)),
        sweep_rad=None if sweep is None else radians(float(sweep)),
        start_point=None if start is None else places.position(start),
        pattern=Pattern(data["pattern"]) if "pattern" in data else None,
        extent_m=float(data.get("extent_m", 0.0)),
        priority=int(data.get("priority", 0)),
    )


def _points(data: dict[str, Any], places: Places) -> tuple[Position, ...]:
    """The points, or the corners of a rectangle or of a polygon around a circle."""
    if "points" in data:
        return tuple(places.position(point) for point in data["points"])
    if "rectangle" in data:
        shape = data["rectangle"]
        centre = places.horizontal(shape["centre"])
        turn = radians(float(shape.get("rotation_deg", 0.0)))
        corners = rectangle(centre, float(shape["width_m"]), float(shape["height_m"]), turn)
    else:
        shape = data["circle"]
        corners = circle(places.horizontal(shape["centre"]), float(shape["radius_m"]), outside=True)
    return tuple(Position(north, east, places.terrain_m) for north, east in corners)


def _view(data: dict[str, Any]) -> View:
    return View(
        radians(float(data["azimuth_deg"])),
        radians(float(data["elevation_deg"])),
        data.get("inertial", False),
        radians(float(data.get("azimuth_extent_deg", 0.0))),
    )


def _loiter(data: dict[str, Any], places: Places, point: Position) -> Loiter:
    shape = data["loiter"]
    return Loiter(
        centre=places.position(shape["centre"]) if "centre" in shape else point,
        radius_m=float(shape.get("radius_m", data.get("radius_m", 0.0))),
        shape=shape.get("shape", "circular"),
        axis_rad=radians(float(shape.get("axis_deg", 0.0))),
        length_m=float(shape.get("length_m", 0.0)),
        direction=shape.get("direction", "any"),
    )
