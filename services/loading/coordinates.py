"""Converts positions as users write them (degrees or metres) to the mission frame."""

from __future__ import annotations

from typing import Any

from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame, Position


class Places:
    """Converts positions for one frame; the projection is created when first needed."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._projection: Any = None
        self.terrain_m = frame.terrain_m

    def local(self, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
        """North and east [m] of a position in WGS-84 degrees."""
        if self._projection is None:
            from cratous.services.mission.frames import Projection

            self._projection = Projection(self._frame)
        north_m, east_m = self._projection.to_local(latitude_deg, longitude_deg)
        return float(north_m), float(east_m)

    def horizontal(self, data: dict[str, Any]) -> tuple[float, float]:
        """North and east [m] of a mapping with north_m and east_m, or with degrees."""
        if "latitude_deg" in data:
            return self.local(float(data["latitude_deg"]), float(data["longitude_deg"]))
        return float(data["north_m"]), float(data["east_m"])

    def position(self, data: dict[str, Any]) -> Position:
        """A point; without alt_m it is on the ground."""
        north_m, east_m = self.horizontal(data)
        return Position(north_m, east_m, float(data.get("alt_m", self._frame.terrain_m)))

    def vertex(self, data: Any) -> tuple[float, float]:
        """A corner: [north_m, east_m] or a mapping in degrees."""
        if isinstance(data, list):
            return float(data[0]), float(data[1])
        return self.horizontal(data)


def msl(altitude_m: float, kind: str, terrain_m: float, where: str, item: str) -> float:
    """An altitude above mean sea level [m]; kind: MSL or AGL (over flat terrain)."""
    if kind == "MSL":
        return altitude_m
    if kind == "AGL":
        return altitude_m + terrain_m
    raise BadInput("unknown altitude type", where=where, item=item, expected="AGL or MSL", got=kind)
