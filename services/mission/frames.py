"""The mission frame and WGS-84: an azimuthal equidistant projection centred on the frame.

Distances and bearings from the origin are exact; a distance between two other points at most d from the
origin is wrong by a factor of at most 1 + (d / R)^2 / 6 + ..., with R the smallest radius of curvature of the
ellipsoid. `scale_error` bounds it, so that margins can account for it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property, lru_cache
from threading import get_ident
from typing import TYPE_CHECKING, Any

from cratous.spec.mission import Frame, Position, Velocity

if TYPE_CHECKING:
    import numpy as np

LEAST_RADIUS_M = 6_335_439.0
"""Smallest radius of curvature of WGS-84: along the meridian, at the equator."""

RESOLUTION_M = 3e-4
"""PROJ treats coordinates that differ by less than about 1e-9 degrees as equal; this is that distance [m]."""


def scale_error(distance_m: float) -> float:
    """Bound on the relative error of local distances within distance_m of the origin.

    The tangential scale of the projection at distance d on a sphere is (d/R) / sin(d/R), which stays below 1
    + (d/R)^2 / 5 for d <= R; the first term, (d/R)^2 / 6, dominates.
    """
    x = distance_m / LEAST_RADIUS_M
    return x * x / 6 if x < 0.01 else x * x / 5


class Projection:
    """Conversion between the mission frame and WGS-84 degrees, there and back within 0.1 mm."""

    def __init__(self, frame: Frame, sphere_m: float | None = None) -> None:
        """sphere_m: the radius [m] of a sphere that replaces the ellipsoid."""
        self.frame, self._sphere_m = frame, sphere_m

    @cached_property
    def _projection(self) -> Any:
        place = self.frame.latitude_deg, self.frame.longitude_deg
        return _projection_of(get_ident(), *place, self._sphere_m)

    def to_local(self, lat_deg: float, lon_deg: float) -> tuple[float, float]:
        """(north, east) [m] of a latitude and longitude [deg]."""
        east, north = self._projection(lon_deg, lat_deg)
        return float(north), float(east)

    def to_geodetic(self, north_m: float, east_m: float) -> tuple[float, float]:
        """(latitude, longitude) [deg] of a point of the mission frame [m]."""
        lon, lat = self._projection(east_m, north_m, inverse=True)
        return float(lat), float(lon)

    def to_local_many(
        self, lat_deg: Sequence[float], lon_deg: Sequence[float]
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same as `to_local` for arrays of equal length."""
        import numpy as np

        east, north = self._projection(np.asarray(lon_deg, float), np.asarray(lat_deg, float))
        return north, east

    def to_geodetic_many(
        self, north_m: Sequence[float], east_m: Sequence[float]
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same as `to_geodetic` for arrays of equal length."""
        import numpy as np

        lon, lat = self._projection(
            np.asarray(east_m, float), np.asarray(north_m, float), inverse=True
        )
        return lat, lon

    def geodesic_m(self, a: tuple[float, float], b: tuple[float, float]) -> float:
        """Length of the geodesic between two (latitude, longitude) points [m]."""
        import pyproj

        return float(pyproj.Geod(ellps="WGS84").inv(a[1], a[0], b[1], b[0])[2])


@lru_cache(64)
def _projection_of(
    thread: int, latitude_deg: float, longitude_deg: float, sphere_m: float | None
) -> Any:
    """The projection of a frame; making one takes longer than using it. thread: each has its own."""
    import pyproj

    shape = {"ellps": "WGS84"} if sphere_m is None else {"R": sphere_m}
    return pyproj.Proj(proj="aeqd", **shape, lat_0=latitude_deg, lon_0=longitude_deg)


def place_and_velocity(p: Position, v: Velocity) -> dict[str, float]:
    """The message fields for an aircraft's position [m] and velocity [m/s]."""
    return {
        "North": p.north_m, "East": p.east_m, "Altitude": p.alt_m,
        "VelocityNorth": v.north_m_s, "VelocityEast": v.east_m_s, "VelocityDown": v.down_m_s,
    }  # fmt: skip


def compass(heading_rad: float) -> float:
    """A heading in degrees clockwise from north, in [0, 360)."""
    degrees = math.degrees(heading_rad) % 360.0
    # the remainder of a heading just below zero rounds to 360 itself
    return 0.0 if degrees == 360.0 else degrees
