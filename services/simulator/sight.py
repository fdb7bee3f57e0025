"""Visibility over terrain: where a ray meets the ground, and whether terrain hides one place from another.

Rays are straight over a flat earth, like those of footprints without terrain, and end at the horizon of the
sea. Along a ray the ground is sampled at most half of the finest post spacing apart (or a 20,000th of its
length).
"""

from __future__ import annotations

from math import cos, hypot

import numpy as np

from cratous.services.simulator.earth import EQUATOR_M, Place, bound_pi, horizon_m
from cratous.services.simulator.motion import Motion
from cratous.services.simulator.terrain import Numbers, Terrain
from cratous.services.simulator.tiles import HIGHEST_M

MOST_SAMPLES = 20_000
BLOCK = 256
NEAR_M = 0.01
"""Accuracy of the intersection with the ground, along the ground [m]."""
GRAZING_M = 0.1
"""Ground that exceeds a line of sight by less than this does not hide [m]."""


class _Line:
    """A ray from a place in a horizontal unit direction (north, east). falling: descent per metre."""

    def __init__(
        self, terrain: Terrain, m: Motion, way: tuple[float, float], falling: float
    ) -> None:
        self.terrain, self.m, self.falling = terrain, m, falling
        self.north, self.east = way[0] / EQUATOR_M, way[1] / (EQUATOR_M * cos(m.lat_rad))

    def place(self, along_m: float) -> tuple[float, float]:
        return self.m.lat_rad + self.north * along_m, self.m.lon_rad + self.east * along_m

    def above_m(self, along_m: float) -> float:
        return self.m.alt_m - self.falling * along_m - self.terrain.elevation(*self.place(along_m))

    def all_above_m(self, along_m: Numbers) -> Numbers:
        lat = self.m.lat_rad + self.north * along_m
        lon = self.m.lon_rad + self.east * along_m
        return self.m.alt_m - self.falling * along_m - self.terrain.elevations(lat, lon)

    def first_below_m(
        self, begin_m: float, end_m: float, by_m: float
    ) -> tuple[float, float] | None:
        """The two samples between which it goes below the ground by more than by_m [m]; None if it does not."""
        step = max(self.terrain.step_m, (end_m - begin_m) / MOST_SAMPLES)
        before = begin_m
        while before < end_m:
            along = np.minimum(before + step * np.arange(1, BLOCK + 1), end_m)
            below = self.all_above_m(along) < -by_m
            if below.any():
                first = int(below.argmax())
                return float(along[first - 1]) if first else before, float(along[first])
            before = float(along[-1])
        return None


def meets(terrain: Terrain, m: Motion, ray: tuple[float, float, float]) -> Place:
    """Where a ray (north, east, down) first meets the terrain, or the ground at the horizon if it does not."""
    north, east, below = ray
    level = hypot(north, east)
    here = terrain.elevation(m.lat_rad, m.lon_rad)
    # straight down to a millimetre in a kilometre
    if m.alt_m <= here or (level <= 1e-6 * below):
        return m.lat_rad, m.lon_rad, here
    line = _Line(terrain, m, (north / level, east / level), below / level)
    far = horizon_m(m.alt_m - min(0.0, here))
    # nothing can be met above the highest ground
    begin = max(0.0, (m.alt_m - HIGHEST_M) / line.falling) if line.falling > 0 else 0.0
    found = None
    if begin < far and (line.falling > 0 or m.alt_m <= HIGHEST_M):
        found = line.first_below_m(begin, far, 0.0)
    at = far
    if found is not None:
        low, at = found
        while at - low > NEAR_M:
            middle = (low + at) / 2
            low, at = (low, middle) if line.above_m(middle) < 0 else (middle, at)
    place = line.place(at)
    return *place, terrain.elevation(*place)


def in_sight(terrain: Terrain, m: Motion, place: Place) -> bool:
    """Whether no terrain lies between a vehicle and a place."""
    north = (place[0] - m.lat_rad) * EQUATOR_M
    east = bound_pi(place[1] - m.lon_rad) * EQUATOR_M * cos(m.lat_rad)
    away = hypot(north, east)
    if away <= terrain.step_m:
        return True
    line = _Line(terrain, m, (north / away, east / away), (m.alt_m - place[2]) / away)
    return line.first_below_m(0.0, away - terrain.step_m / 2, GRAZING_M) is None
