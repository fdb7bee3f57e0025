"""Places, distances and contact for arrays of points and legs: numpy in, numpy out, exact.

Every result is that of the proved folds on the real numbers that the doubles represent: a compiled filter decides
nearly all (`core.readings.exact.folds`), the exact kernels the rest. Broadcasting as in numpy.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from cratous.core.geofence import distance as geofence_distance
from cratous.core.geofence import planar
from cratous.core.geofence.planar import crosses_ray, on_segment, segments_meet
from cratous.core.geofence.regions import layer_place
from cratous.core.geofence.shapes import Place, Polygon, Region
from cratous.core.readings.exact import exactly
from cratous.core.readings.exact.folds import folded

AT_ONCE = 1 << 20
"""Maximum number of point-edge pairs held in memory at a time."""


def _pairs(
    decide: Callable[[list[np.ndarray]], np.ndarray],
    items: tuple[np.ndarray, ...],
    columns: list[np.ndarray],
) -> np.ndarray:
    """Apply `decide` to columns of shape (points, 1), in blocks of points."""
    size, step = columns[0].size, max(1, AT_ONCE // max(1, items[0].size))
    parts = [
        decide([column[k : k + step, None] for column in columns]) for k in range(0, size, step)
    ]
    return np.concatenate(parts)


def _location(items: tuple[Any, ...], columns: list[np.ndarray]) -> np.ndarray:
    """The fold `locate` on every pair of a point and an edge, by the exact kernels."""

    def decide(point: list[np.ndarray]) -> np.ndarray:
        on = exactly(on_segment)(*point, *items).any(axis=1)
        odd = np.logical_xor.reduce(exactly(crosses_ray)(*point, *items), axis=1)
        return np.where(on, 0, np.where(odd, 1, -1))

    return _pairs(decide, items, columns)


def _contact(items: tuple[Any, ...], columns: list[np.ndarray]) -> np.ndarray:
    def decide(leg: list[np.ndarray]) -> np.ndarray:
        return np.asarray(exactly(segments_meet)(*leg, *items).any(axis=1))

    return _pairs(decide, items, columns)


def _nearness(items: tuple[Any, ...], columns: list[np.ndarray]) -> np.ndarray:
    def decide(point: list[np.ndarray]) -> np.ndarray:
        found = exactly(geofence_distance.edge_against)(*point[:2], *items, point[2])
        least: np.ndarray = found.min(axis=1)
        return least

    return _pairs(decide, items, columns)


_LOCATE = folded(planar.locate, rest=_location)
_MEETS = folded(planar.meets_boundary, rest=_contact)
_AGAINST = folded(geofence_distance.boundary_against, rest=_nearness)


def places_in_polygon(x: Any, y: Any, shape: Polygon) -> np.ndarray:
    """The place of each point: int8 of -1, 0, 1, in the broadcast shape of x and y."""
    found: np.ndarray = _LOCATE(shape.columns, x, y)
    return found


def contact(px: Any, py: Any, qx: Any, qy: Any, shape: Polygon) -> np.ndarray:
    """True for each leg that has a point in common with the boundary."""
    found: np.ndarray = _MEETS(shape.columns, px, py, qx, qy)
    return found


def boundary_against(x: Any, y: Any, buffer_m: Any, shape: Polygon) -> np.ndarray:
    """-1, 0, 1 as the boundary is nearer to each point than the buffer, at the buffer, or farther."""
    found: np.ndarray = _AGAINST(shape.columns, x, y, buffer_m)
    return found


def places_in_region(x: Any, y: Any, alt_m: Any, shape: Region) -> np.ndarray:
    """The place of each point in a polygon with holes between floor and ceiling."""
    found = places_in_polygon(x, y, shape.outline)
    for hole in shape.holes:
        # the exact kernels' results are integers, so these are `both_places` and `outside_place`
        found = np.minimum(found, -places_in_polygon(x, y, hole))
    if shape.layered:
        layer = exactly(layer_place)(alt_m, shape.floor, shape.ceiling)
        found = np.minimum(found, layer.astype(np.int8))
    return found


__all__ = ["Place", "boundary_against", "contact", "places_in_polygon", "places_in_region"]
