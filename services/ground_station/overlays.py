"""GeoJSON (RFC 7946) as background of the map: coasts, roads, airspace, or other user data.

Points, lines and areas, also several in one geometry, with `label` or `name` from their properties.
They are displayed only: nothing is planned, flown or judged by them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.services.ground_station.near_origin import is_near
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import at_most, json_of
from cratous.spec.files.text_file import text_of
from cratous.spec.mission import Frame

MOST_BYTES = 32 << 20
MOST_PLACES = 200_000
"""Maximum number of positions in all files; more would make the map slow."""
DEPTH = {
    "Point": 0,
    "MultiPoint": 1,
    "LineString": 1,
    "MultiLineString": 2,
    "Polygon": 2,
    "MultiPolygon": 3,
}
"""Nesting depth of the coordinates of each geometry."""
FEATURES, SEVERAL = "FeatureCollection", "GeometryCollection"


class Shape(NamedTuple):
    """A point, line or outline: latitudes and longitudes [deg], whether it is an area, and its name."""

    places: tuple[tuple[float, float], ...]
    area: bool
    name: str


def overlays_of(paths: Sequence[Path]) -> tuple[Shape, ...]:
    """The shapes of some files. Raises BadInput with file and place."""
    found: list[Shape] = []
    for path in paths:
        text = text_of(path, MOST_BYTES, "a GeoJSON file")
        found += _shapes(json_of(text, str(path), MOST_BYTES), "", (str(path), "$"))
        at_most(
            sum(len(one.places) for one in found),
            MOST_PLACES,
            "too many places",
            str(path),
            "of them",
        )
    return tuple(found)


def in_frame(shapes: Sequence[Shape], frame: Frame) -> list[dict[str, Any]]:
    """The shapes as the page draws them: positions north and east [m] in a frame; shapes with a
    position too far away are omitted.
    """
    plane, told = Projection(frame), []
    for one in shapes:
        north, east = plane.to_local_many(*zip(*one.places, strict=True))
        places = [
            [round(float(n), 1), round(float(e), 1)] for n, e in zip(north, east, strict=True)
        ]
        if all(is_near(Vec2(*place)) for place in places):
            told.append({"places": places, "area": one.area, "name": one.name})
    return told


def _shapes(data: Any, name: str, place: tuple[str, str]) -> Iterator[Shape]:
    """The shapes of a GeoJSON object; place: file, and position in it."""
    kind = data.get("type") if isinstance(data, dict) else None
    kind = kind if isinstance(kind, str) else None
    file, item = place
    if kind in (FEATURES, SEVERAL):
        key = "features" if kind == FEATURES else "geometries"
        parts = data.get(key)
        if not isinstance(parts, list):
            raise BadInput(
                f"a {kind} without {key}", where=file, item=item, expected=f"a list of {key}"
            )
        for k, part in enumerate(parts):
            yield from _shapes(part, name, (file, f"{item}.{key}[{k}]"))
    elif kind == "Feature":
        said = data.get("properties")
        said = said if isinstance(said, dict) else {}
        name = str(said.get("label") or said.get("name") or "")[:60]
        if data.get("geometry") is not None:  # a feature without a geometry is permitted
            yield from _shapes(data["geometry"], name, (file, f"{item}.geometry"))
    elif kind in DEPTH:
        area = kind.endswith("Polygon")
        lines = _lines(data.get("coordinates"), DEPTH[kind], (file, f"{item}.coordinates"))
        yield from (Shape(line, area, name) for line in lines if line)
    else:
        raise BadInput(
            "no object of GeoJSON", where=file, item=item,
            expected=f"a {FEATURES}, a Feature or a geometry as its type", got=str(kind)[:40],
        )  # fmt: skip


def _lines(
    data: Any, depth: int, place: tuple[str, str]
) -> Iterator[tuple[tuple[float, float], ...]]:
    """The position lists in coordinates of that depth; a point is a list of one."""
    file, item = place
    if depth == 0:
        yield (_position(data, place),)
        return
    if not isinstance(data, list):
        raise BadInput("no list", where=file, item=item, expected="coordinates", got=str(data)[:40])
    inner = [(one, (file, f"{item}[{k}]")) for k, one in enumerate(data)]
    if depth == 1:
        yield tuple(_position(one, where) for one, where in inner)
        return
    for one, where in inner:
        yield from _lines(one, depth - 1, where)


def _position(data: Any, place: tuple[str, str]) -> tuple[float, float]:
    """Latitude and longitude [deg]."""
    numbers = isinstance(data, list) and len(data) >= 2
    if numbers and all(isinstance(x, int | float) and not isinstance(x, bool) for x in data):
        longitude, latitude = data[:2]
        if abs(latitude) <= 90 and abs(longitude) <= 360:
            return float(latitude), float(longitude)
    raise BadInput(
        "not a position", where=place[0], item=place[1],
        expected="[longitude, latitude] in degrees", got=str(data)[:40],
    )  # fmt: skip
