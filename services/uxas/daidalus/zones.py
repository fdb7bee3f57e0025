"""Active zones for a diverting vehicle: padded polygons in a plane.

Zones that cannot be checked are ignored and named: a zone that is no polygon, and one that the
vehicle has already violated, from which any way out is better than none.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.services.loading.coordinates import Places
from cratous.services.loading.polygons import padded, polygon_problem
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_parts import zone as zone_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame, Position, Zone

CELL_DEG = 0.5
"""The plane's origin is the nearest point of a grid of this size, so that zones are converted rarely."""


class Surroundings(NamedTuple):
    """The plane, its zones, and remarks on zones that could not be converted exactly."""

    frame: Frame | None = None
    places: Places | None = None
    zones: tuple[Zone, ...] = ()
    missing: tuple[str, ...] = ()

    def position(self, place: Any) -> Position:
        """Position of a Location3D or Waypoint in the plane."""
        assert self.places is not None
        north, east = self.places.local(place.Latitude, place.Longitude)
        return Position(north, east, float(place.Altitude))

    def binding(self, here: Position) -> tuple[tuple[Zone, ...], tuple[str, ...]]:
        """The zones not violated at `here`, and the labels of the violated ones."""
        broken = [zone for zone in self.zones if first_bad_leg([here], [zone]) is not None]
        kept = tuple(zone for zone in self.zones if zone not in broken)
        return kept, tuple(zone.label for zone in broken)


def frame_at(location: Any) -> Frame:
    """The frame to which a location belongs."""
    latitude, longitude = (
        CELL_DEG * round(x / CELL_DEG) for x in (location.Latitude, location.Longitude)
    )
    return Frame(max(-89.5, min(89.5, latitude)), longitude)


def surroundings(frame: Frame, bodies: Iterable[Any], altitudes: str) -> Surroundings:
    """KeepInZones and KeepOutZones as polygons in the plane of a frame.

    altitudes: reference (AGL, MSL) of the vehicle's altitudes; a zone with altitudes of the other
    reference cannot be compared, and applies at every altitude.
    """
    places, zones, missing = Places(frame), [], []
    for body in bodies:
        kinds = {body.MaxAltitudeType.name}
        kinds |= {body.MinAltitudeType.name} if body.MinAltitude else set()
        if kinds != {altitudes} and (body.MinAltitude or body.MaxAltitude):
            missing.append(
                f"zone {body.ZoneID} binds at every altitude: its limits are not {altitudes}"
            )
            body = body.copy(MinAltitude=0.0, MaxAltitude=0.0)
        try:
            made = zone_of(Sent(body, f"zone {body.ZoneID}", 0), places, 0.0, [])
            problem = polygon_problem(made.vertices)
            if problem:
                raise BadInput(problem, item=f"zone {body.ZoneID}")
            zones.append(padded(made, "", f"zone {body.ZoneID}"))
        except BadInput as error:
            missing.append(f"zone {body.ZoneID} binds nobody: {error}")
    return Surroundings(frame, places, tuple(zones), tuple(missing))
