"""Conversion of one request's places: messages carry degrees, the mission's frame metres.

A place or pose that was sent from here is read back exactly, so that messages lose no precision; any other is
read from the message.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.services.loading.coordinates import Places
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_parts import heading, point
from cratous.services.mission.frames import Projection, compass
from cratous.services.pipeline.outside import Outside
from cratous.services.planning.routes import Routes
from cratous.services.planning.spacing import TOLERANCE, spaced
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.mission.plan import Pose

_Spot = tuple[float, float, float, str]


def _spot(location: Any) -> _Spot:
    """The fields of a Location3D."""
    kind = location.AltitudeType.name
    return location.Latitude, location.Longitude, location.Altitude, kind


def read_pose(location: Any, heading_deg: float, places: Places, where: str, item: str) -> Pose:
    """A Location3D and a heading as a pose of a frame; BadInput for an invalid place or heading."""
    position = point(location, places, Sent(None, where, 0), item)
    return Pose(*position, heading(heading_deg, where, f"heading at {item}"))


class Way(NamedTuple):
    """The ends of a route, as `Routes` takes them: it leads from `end` to `start`."""

    end: Pose
    start: Pose


class RequestPlaces:
    """Positions of one mission: conversion to and from messages, and routes between them."""

    def __init__(self, mission: Mission, finder: Routes) -> None:
        """finder: routes of the mission's vehicles around its zones; it caches what is found."""
        self.mission = mission
        self.projection = Projection(mission.frame)
        self._finder = finder
        self._places = Places(mission.frame)
        self._points: dict[_Spot, Position] = {}
        self._poses: dict[tuple[_Spot, float], Pose] = {}

    def routes_of(self, ways: Sequence[Way]) -> Routes:
        """Routes of the mission's vehicles; route k belongs to ways[k]."""
        return self._finder.between(ways)

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones in force, against which routes are checked."""
        return self._finder.zones

    def location(self, point: Position | Pose) -> Any:
        """A point as Location3D (degrees, metres MSL)."""
        lat, lon = self.projection.to_geodetic(point.north_m, point.east_m)
        made = lmcp.new("Location3D", Latitude=lat, Longitude=lon, Altitude=point.alt_m)
        self._points[_spot(made)] = Position(*point[:3])
        return made

    def sent(self, pose: Pose) -> tuple[Any, float]:
        """A pose as Location3D and compass heading [deg]."""
        made, heading_deg = self.location(pose), compass(pose.heading_rad)
        self._poses[_spot(made), heading_deg] = pose
        return made, heading_deg

    def ends(self, start: Pose, end: Pose) -> dict[str, Any]:
        """The ends of a route, as the four fields that messages have for them."""
        (place, heading_deg), (last, last_deg) = self.sent(start), self.sent(end)
        return {
            "StartLocation": place,
            "StartHeading": heading_deg,
            "EndLocation": last,
            "EndHeading": last_deg,
        }

    def exact(self, location: Any, heading_deg: float) -> Pose | None:
        """The pose that was sent as this Location3D and heading, None if none was."""
        return None if location is None else self._poses.get((_spot(location), heading_deg))

    def pose(self, location: Any, heading_deg: float, where: str, item: str) -> Pose:
        """A Location3D and a heading as a pose of the frame; BadInput for an invalid place or heading."""
        exact = self.exact(location, heading_deg)
        if exact is not None:
            return exact
        known = None if location is None else self._points.get(_spot(location))
        if known is None:
            return read_pose(location, heading_deg, self._places, where, item)
        return Pose(*known, heading(heading_deg, where, f"heading at {item}"))

    def spaced(
        self, points: Sequence[Position], radius_m: float, outside: Outside | None
    ) -> Sequence[Position]:
        """The points of a path to send as waypoints. radius_m: the vehicle's turn radius."""
        if outside is None or not outside.separation_m:
            return points
        least_m = max(outside.separation_m, radius_m)
        return spaced(points, least_m, TOLERANCE * radius_m, self._finder.kept_clear(radius_m))

    def waypoints(
        self, points: Sequence[Position], first: int, speed_m_s: float, tasks: Sequence[int]
    ) -> list[Any]:
        """Waypoints numbered from `first`, each leading to the next."""
        lats, lons = self.projection.to_geodetic_many(
            [p.north_m for p in points], [p.east_m for p in points]
        )
        return [
            lmcp.new(
                "Waypoint",
                Latitude=float(lat),
                Longitude=float(lon),
                Altitude=point.alt_m,
                Number=first + k,
                NextWaypoint=first + k + 1,
                Speed=speed_m_s,
                AssociatedTasks=list(tasks),
            )
            for k, (point, lat, lon) in enumerate(zip(points, lats, lons, strict=True))
        ]
