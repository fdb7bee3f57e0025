"""Foxglove views of messages: positions, routes and zones on the map, vehicles in the 3D view.

A state gives a `foxglove.LocationFix` (`/vehicles/<id>/fix`) and the vehicle's arrow and number in
a `foxglove.SceneUpdate` (`/vehicles/scene`, frame `map`: east, north, up [m] from the first
position of any vehicle). A mission command, alone or in a response, gives its route, a zone its
boundary as `foxglove.GeoJSON` (`/vehicles/<id>/route`, `/zones/<id>`). Field names and units are
Foxglove's; a message with non-finite numbers, or a zone without a shape, gives nothing.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from cratous.services.logs.entry import RAW
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Frame

STATE, COMMAND = "afrl.cmasi.EntityState", "afrl.cmasi.MissionCommand"
RESPONSE = "afrl.cmasi.AutomationResponse"
ZONE, KEEP_OUT = "afrl.cmasi.AbstractZone", "afrl.cmasi.KeepOutZone"
LOCATION_FIX, SCENE, GEO_JSON = "foxglove.LocationFix", "foxglove.SceneUpdate", "foxglove.GeoJSON"
_ARROW_M = 60.0
_BLUE, _WHITE = (0.1, 0.4, 0.9, 1.0), (1.0, 1.0, 1.0, 1.0)
_PARTS = ("arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts", "models")


class View(NamedTuple):
    """A message for Foxglove: topic, name of the schema, content."""

    topic: str
    schema: str
    data: dict[str, Any]


def _object(**properties: dict[str, Any]) -> dict[str, Any]:
    return {"type": "object", "properties": properties}


def _array(items: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items}


_NUMBER, _INTEGER, _TEXT = {"type": "number"}, {"type": "integer"}, {"type": "string"}
_TIME = {"title": "time", **_object(sec=_INTEGER, nsec=_INTEGER)}
_DURATION = {"title": "duration", **_object(sec=_INTEGER, nsec=_INTEGER)}
_VECTOR = _object(x=_NUMBER, y=_NUMBER, z=_NUMBER)
_POSE = _object(position=_VECTOR, orientation=_object(x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER))
_COLOR = _object(r=_NUMBER, g=_NUMBER, b=_NUMBER, a=_NUMBER)
_ARROW = _object(
    pose=_POSE,
    shaft_length=_NUMBER,
    shaft_diameter=_NUMBER,
    head_length=_NUMBER,
    head_diameter=_NUMBER,
    color=_COLOR,
)
_LABEL = _object(
    pose=_POSE,
    billboard={"type": "boolean"},
    font_size=_NUMBER,
    scale_invariant={"type": "boolean"},
    color=_COLOR,
    text=_TEXT,
)
_ENTITY = _object(
    timestamp=_TIME,
    frame_id=_TEXT,
    id=_TEXT,
    lifetime=_DURATION,
    frame_locked={"type": "boolean"},
    metadata=_array(_object(key=_TEXT, value=_TEXT)),
    **{part: _array({"type": "object"}) for part in _PARTS}
    | {"arrows": _array(_ARROW), "texts": _array(_LABEL)},
)
_FIX = _object(
    timestamp=_TIME,
    frame_id=_TEXT,
    latitude={**_NUMBER, "description": "degrees"},
    longitude={**_NUMBER, "description": "degrees"},
    altitude={**_NUMBER, "description": "metres"},
    position_covariance=_array(_NUMBER),
    position_covariance_type=_INTEGER,
)
_DELETION = _object(timestamp=_TIME, type=_INTEGER, id=_TEXT)

SCHEMAS: dict[str, dict[str, Any]] = {
    LOCATION_FIX: {"title": LOCATION_FIX, **_FIX},
    SCENE: {
        "title": SCENE,
        **_object(deletions=_array(_DELETION), entities=_array(_ENTITY)),
    },
    GEO_JSON: {"title": GEO_JSON, **_object(geojson=_TEXT)},
}


class Views:
    """Creates the views of the messages of one log, in order."""

    def __init__(self) -> None:
        self._frame: tuple[Projection, float] | None = None

    def of(self, data: Any, names: tuple[str, ...], time_ns: int) -> Iterator[View]:
        """The views of a message in its JSON form; names: its full type name and those of its base types."""
        if not isinstance(data, dict) or RAW in data:
            return
        if STATE in names:
            yield from self._state(data, time_ns)
        elif COMMAND in names:
            yield from _route(data)
        elif RESPONSE in names:
            for command in data.get("MissionCommandList", ()):
                yield from _route(command)
        elif ZONE in names:
            yield from _zone(data, KEEP_OUT in names)

    def _state(self, data: dict[str, Any], time_ns: int) -> Iterator[View]:
        place = place_of(data.get("Location"))
        if place is None:
            return
        latitude, longitude, altitude = place
        number, stamp = data.get("ID", 0), _stamp(time_ns)
        fix = {
            "timestamp": stamp,
            "frame_id": f"vehicle_{number}",
            "latitude": latitude,
            "longitude": longitude,
            "altitude": altitude,
            "position_covariance": [0.0] * 9,
            "position_covariance_type": 0,
        }
        yield View(f"/vehicles/{number}/fix", LOCATION_FIX, fix)
        if self._frame is None:
            self._frame = Projection(Frame(latitude, longitude)), altitude
        projection, zero_m = self._frame
        north_m, east_m = projection.to_local(latitude, longitude)
        heading = data.get("Heading", 0.0)
        if _finite(north_m, east_m, heading):
            at = east_m, north_m, altitude - zero_m
            yield View("/vehicles/scene", SCENE, _scene(number, stamp, at, heading))


def _scene(
    number: int, stamp: dict[str, int], at: tuple[float, float, float], heading_deg: float
) -> dict[str, Any]:
    """The arrow and the number of a vehicle at (east, north, up) [m]."""
    half = math.radians(90.0 - heading_deg) / 2  # Foxglove measures from east, anticlockwise
    turned = {"x": 0.0, "y": 0.0, "z": math.sin(half), "w": math.cos(half)}
    level = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    arrow = {
        "pose": {"position": dict(zip("xyz", at, strict=True)), "orientation": turned},
        "shaft_length": 0.6 * _ARROW_M,
        "shaft_diameter": 0.2 * _ARROW_M,
        "head_length": 0.4 * _ARROW_M,
        "head_diameter": 0.5 * _ARROW_M,
        "color": dict(zip("rgba", _BLUE, strict=True)),
    }
    above = {"x": at[0], "y": at[1], "z": at[2] + _ARROW_M}
    label = {
        "pose": {"position": above, "orientation": level},
        "billboard": True,
        "font_size": 14.0,
        "scale_invariant": True,
        "color": dict(zip("rgba", _WHITE, strict=True)),
        "text": str(number),
    }
    entity: dict[str, Any] = {
        "timestamp": stamp,
        "frame_id": "map",
        "id": f"vehicle {number}",
        "lifetime": {"sec": 0, "nsec": 0},  # until the next one
        "frame_locked": False,
        "metadata": [],
        **{part: [] for part in _PARTS},
    }
    return {"deletions": [], "entities": [{**entity, "arrows": [arrow], "texts": [label]}]}


def _route(data: dict[str, Any]) -> Iterator[View]:
    way = [place_of(waypoint) for waypoint in data.get("WaypointList", ())]
    points = [[place[1], place[0]] for place in way if place is not None]
    if len(points) > 1:
        number = data.get("VehicleID", 0)
        shape = {"type": "LineString", "coordinates": points}
        yield _drawn(f"/vehicles/{number}/route", shape, f"route of {number}", "#1a66e6")


def _zone(data: dict[str, Any], keep_out: bool) -> Iterator[View]:
    corners = corners_of(data.get("Boundary"))
    if len(corners) > 2:
        number, kind = data.get("ZoneID", 0), "keep out" if keep_out else "keep in"
        ring = [[longitude, latitude] for latitude, longitude in [*corners, corners[0]]]
        shape = {"type": "Polygon", "coordinates": [ring]}
        color = "#cc2222" if keep_out else "#228822"
        yield _drawn(f"/zones/{number}", shape, f"{kind} {number}", color)


def _drawn(topic: str, shape: dict[str, Any], name: str, color: str) -> View:
    feature = {
        "type": "Feature",
        "geometry": shape,
        "properties": {"name": name, "style": {"color": color, "weight": 2, "fillOpacity": 0.1}},
    }
    return View(topic, GEO_JSON, {"geojson": json.dumps(feature, separators=(",", ":"))})


def corners_of(shape: Any) -> list[tuple[float, float]]:
    """(latitude, longitude) [deg] of the corners of a Polygon, Rectangle or Circle; empty for other shapes."""
    if not isinstance(shape, dict):
        return []
    places = [place_of(point) for point in shape.get("BoundaryPoints", ())]
    if places:
        return [place[:2] for place in places if place is not None]
    centre = place_of(shape.get("CenterPoint"))
    names = ("Radius",) if "Radius" in shape else ("Width", "Height")
    sizes = [shape.get(name, 0.0) for name in names]
    turn = shape.get("Rotation", 0.0)
    if centre is None or not _finite(*sizes, turn) or min(sizes) <= 0:
        return []
    from cratous.services.loading.polygons import circle, rectangle  # importing it compiles kernels

    if len(sizes) == 1:
        local = circle((0.0, 0.0), sizes[0], outside=False)
    else:
        local = rectangle((0.0, 0.0), sizes[0], sizes[1], math.radians(turn))
    projection = Projection(Frame(*centre[:2]))
    return [projection.to_geodetic(*corner) for corner in local]


def place_of(data: Any) -> tuple[float, float, float] | None:
    """Latitude, longitude [deg] and altitude [m]; None unless all are numbers."""
    if not isinstance(data, dict):
        return None
    found = tuple(data.get(name, 0.0) for name in ("Latitude", "Longitude", "Altitude"))
    # a non-number is text in the JSON form
    return (found[0], found[1], found[2]) if _finite(*found) else None


def _finite(*values: Any) -> bool:
    return all(isinstance(value, int | float) and math.isfinite(value) for value in values)


def _stamp(time_ns: int) -> dict[str, int]:
    sec, nsec = divmod(time_ns, 1_000_000_000)
    return {"sec": sec, "nsec": nsec}
