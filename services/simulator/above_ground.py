"""Conversion of received altitudes above ground to altitudes above mean sea level, by the terrain's height.

The height at the object's own place counts: a waypoint's, a loiter's centre, for a flight director action the
vehicle's position on receipt or the waypoint that it belongs to. Between two places the ground is not
followed.
"""

from __future__ import annotations

from math import isfinite, radians
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cratous.services.simulator.terrain import Terrain

Below = tuple[float, float]
"""Latitude and longitude [rad] of the ground for a message without a place of its own."""
PLACES = ("Location", "Starepoint")


def above_sea(body: Any, terrain: Terrain, below: Below) -> Any:
    """A message with all its altitudes above mean sea level; the same object if they are already. Raises
    BadInput for a corrupt tile.
    """
    own = _own_place(body)
    below = below if own is None else own
    changed: dict[str, Any] = {}
    if _is_above_ground(body):
        changed = {"Altitude": body.Altitude + terrain.elevation(*below), "AltitudeType": "MSL"}
    for name in PLACES:
        place = getattr(body, name, None)
        if place is not None and (new := above_sea(place, terrain, below)) is not place:
            changed[name] = new
    for name in ("WaypointList", "VehicleActionList"):
        parts = getattr(body, name, ())
        new_parts = [above_sea(part, terrain, below) for part in parts]
        if any(new is not part for new, part in zip(new_parts, parts, strict=True)):
            changed[name] = new_parts
    return body.copy(**changed) if changed else body


def _own_place(body: Any) -> Below | None:
    latitude, longitude = getattr(body, "Latitude", None), getattr(body, "Longitude", None)
    if latitude is None or longitude is None or not isfinite(latitude + longitude):
        return None
    return radians(latitude), radians(longitude)


def _is_above_ground(body: Any) -> bool:
    """Whether an object has an altitude above ground of its own; 0 in a flight director action means none."""
    kind = getattr(body, "AltitudeType", None)
    if kind is None or kind.name != "AGL" or not isfinite(body.Altitude):
        return False
    return _own_place(body) is not None or bool(body.Altitude)
