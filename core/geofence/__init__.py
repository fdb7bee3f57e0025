"""Geofences for programs outside of this project: checked shapes, exact verdicts, typed results.

Coordinates are metres in one plane, (x, y) or (north, east); altitudes are MSL [m]. Every verdict
is that of a proved kernel on the real numbers that the given doubles are: no tolerance, no gate,
either order of the vertices. A polygon's boundary is `Place.BOUNDARY`; a keep-out forbids it, and a
keep-in does not allow it. Meaning: `cratous.spec.geofence`; proofs: `cratous prove --only
'geofence*'`; guide: docs/guides/geofence.md.

>>> from cratous.core import geofence
>>> field = geofence.polygon([(0, 0), (100, 0), (100, 80), (0, 80)])
>>> geofence.place((50, 40), field)
<Place.INSIDE: 1>
>>> geofence.places([(50, 40), (100, 40), (150, 40)], field)
array([ 1,  0, -1], dtype=int8)

Broadcasting. `points` has the shape (..., 2), or (..., 3) with the altitude; results have the shape
(...). Legs are two arrays of points whose leading shapes are broadcast against each other.
`places_in_each` adds one axis at the end for the zones. Buffers are broadcast against the points.

What cannot be judged is refused with a `BadInput` that names the vertex, edge or element.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from cratous.core.geofence import arrays
from cratous.core.geofence.distance import AT, FARTHER, NEARER, boundary_distance
from cratous.core.geofence.legs import Shape, Stretch, passage, regions_of, spans
from cratous.core.geofence.motion import seen_from
from cratous.core.geofence.recovery import recovery
from cratous.core.geofence.regions import narrowed_place, widened_place
from cratous.core.geofence.shapes import (
    BadPolygon,
    Place,
    Polygon,
    Region,
    polygon,
    region,
)
from cratous.core.geofence.validity import Fault, fault_of
from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact
from cratous.spec.errors import BadInput

__all__ = [
    "AT", "FARTHER", "NEARER", "BadPolygon", "Fault", "Place", "Polygon", "Region", "Stretch",
    "against_buffer", "buffered_places", "contact", "fault_of", "leg_places", "leg_stays_inside",
    "leg_stays_outside", "place", "places", "places_in_each", "polygon", "recovery_point", "region",
    "squared_distance", "times_inside",
]  # fmt: skip


# -- points -----------------------------------------------------------------------------
def _points(points: Any, where: str, item: str, space: bool) -> np.ndarray:
    """Points as doubles of shape (..., 2) or (..., 3), finite."""
    wanted = "(..., 3): x, y, altitude" if space else "(..., 2) or (..., 3): x, y, altitude"
    try:
        given = np.asarray(points)
        found = given.astype(np.float64, copy=False)
    except (TypeError, ValueError, OverflowError) as error:
        raise BadInput(
            "no array of numbers", where=where, item=item, expected=wanted, got=repr(points)[:80]
        ) from error
    if given.dtype.kind not in "iuf":
        raise BadInput(
            "no real numbers", where=where, item=item, expected=wanted, got=str(given.dtype)
        )
    fits = found.ndim >= 1 and found.shape[-1] in ((3,) if space else (2, 3))
    if not fits:
        raise BadInput(
            "points of the wrong shape",
            where=where,
            item=item,
            expected=wanted,
            got=str(found.shape),
        )
    finite = np.isfinite(found)
    if not finite.all():
        at = tuple(np.argwhere(~finite)[0].tolist())
        name = f"{item}[{', '.join(map(str, at))}]"
        raise BadInput(
            "not finite", where=where, item=name, expected="a number", got=str(found[at])
        )
    if given.dtype.kind in "iu" and np.any(np.abs(found) > 2.0**53):
        raise BadInput(
            "an integer that may be no double", where=where, item=item, expected="at most 2^53"
        )
    return found


def _altitudes(points: np.ndarray) -> np.ndarray:
    return points[..., 2] if points.shape[-1] == 3 else np.zeros(points.shape[:-1])


def _shape(value: Any, where: str) -> Shape:
    if isinstance(value, Polygon | Region):
        return value
    raise BadInput(
        "no shape",
        where=where,
        item="shape",
        expected="what `polygon` or `region` gives",
        got=type(value).__name__,
    )


def places(points: Any, shape: Shape) -> np.ndarray:
    """The place of each point, as int8: 1 inside, 0 on the boundary, -1 outside.

    points: (..., 2), or (..., 3) with altitudes, which a region with a floor or a ceiling needs.

    >>> zone = region([(0, 0), (100, 0), (100, 80)], floor_m=50, ceiling_m=120)
    >>> places([(60, 20, 100), (60, 20, 120), (60, 20, 121)], zone)
    array([ 1,  0, -1], dtype=int8)
    """
    shape = _shape(shape, "places")
    layered = isinstance(shape, Region) and shape.layered
    found = _points(points, "places", "points", layered)
    x, y = found[..., 0], found[..., 1]
    if isinstance(shape, Polygon):
        return arrays.places_in_polygon(x, y, shape)
    return arrays.places_in_region(x, y, _altitudes(found), shape)


def place(point: Any, shape: Shape) -> Place:
    """The place of one point.

    >>> triangle = polygon([(0, 0), (3, 1), (0, 1)])
    >>> place((1.5, 0.5), triangle)
    <Place.BOUNDARY: 0>
    >>> place((1.5, 0.5000000000000001), triangle)
    <Place.INSIDE: 1>
    """
    found = places(point, shape)
    if found.shape != ():
        raise BadInput(
            "one point is wanted", where="place", item="point", got=f"{found.size} points"
        )
    return Place(int(found))


def places_in_each(points: Any, shapes: Sequence[Shape]) -> np.ndarray:
    """The places of points (...) in each of several zones: int8 of shape (..., zones).

    The greatest along the last axis is the place in the union of the zones, the least that in
    their intersection.

    >>> left, right = polygon([(0, 0), (2, 0), (2, 2)]), polygon([(1, 0), (4, 0), (4, 3)])
    >>> places_in_each([(1.5, 0.25), (3, 1)], [left, right])
    array([[ 1,  1],
           [-1,  1]], dtype=int8)
    """
    if not shapes:
        raise BadInput("no zones", where="places_in_each", item="shapes", expected="one or more")
    return np.stack([places(points, shape) for shape in shapes], axis=-1)


# -- distances --------------------------------------------------------------------------
def _buffer(buffer_m: Any, where: str) -> np.ndarray:
    try:
        found = np.asarray(buffer_m, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise BadInput(
            "no buffer", where=where, item="buffer_m", expected="0 m or more", got=repr(buffer_m)
        ) from error
    if not np.all(np.isfinite(found) & (found >= 0)):
        raise BadInput(
            "a buffer is negative or not finite",
            where=where,
            item="buffer_m",
            expected="0 m or more",
            got=str(buffer_m),
        )
    return found


def against_buffer(points: Any, shape: Polygon, buffer_m: Any) -> np.ndarray:
    """The boundary against a buffer: -1 (NEARER), 0 (AT), 1 (FARTHER) for each point.

    >>> square = polygon([(0, 0), (10, 0), (10, 10), (0, 10)])
    >>> against_buffer([(5, 1), (5, 2), (5, 3), (13, 14)], square, [2, 2, 2, 5])
    array([-1,  0,  1,  0], dtype=int8)
    """
    found = _points(points, "against_buffer", "points", False)
    width = _buffer(buffer_m, "against_buffer")
    return arrays.boundary_against(found[..., 0], found[..., 1], width, _flat(shape))


def _flat(shape: Any) -> Polygon:
    if isinstance(shape, Polygon):
        return shape
    raise BadInput(
        "no polygon", item="shape", expected="what `polygon` gives", got=type(shape).__name__
    )


def buffered_places(points: Any, shape: Polygon, buffer_m: Any, *, inwards: bool) -> np.ndarray:
    """The places in a polygon that is widened, or with `inwards` narrowed, by a buffer.

    The widened polygon's boundary are the points outside that are just the buffer away, its
    corners rounded; the narrowed one's are those inside.

    >>> square = polygon([(0, 0), (10, 0), (10, 10), (0, 10)])
    >>> buffered_places([(13, 14), (12, 5), (5, 5)], square, 5, inwards=False)
    array([0, 1, 1], dtype=int8)
    >>> buffered_places([(13, 14), (5, 5)], square, 4, inwards=True)
    array([-1,  1], dtype=int8)
    """
    near = against_buffer(points, shape, buffer_m)
    there = np.broadcast_to(places(points, shape), near.shape)
    pairs = [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1)]
    combine = narrowed_place if inwards else widened_place
    table = np.array([combine(a, b) for a, b in pairs], dtype=np.int8).reshape(3, 3)
    found: np.ndarray = table[there + 1, near + 1]
    return found


def squared_distance(point: Any, shape: Polygon) -> Fraction:
    """The exact square of the distance from a point to the boundary [m^2].

    >>> squared_distance((1, 1), polygon([(0, 0), (3, 1), (3, -5)]))
    Fraction(2, 5)
    """
    found = _points(point, "squared_distance", "point", False)
    if found.ndim != 1:
        raise BadInput(
            "one point is wanted", where="squared_distance", item="point", got=str(found.shape)
        )
    ratio = exact(boundary_distance, _flat(shape).edges, Vec2(float(found[0]), float(found[1])))
    return Fraction(ratio.num) / Fraction(ratio.den)


def recovery_point(
    point: Any, shape: Polygon, distance_m: float, *, inside: bool
) -> tuple[float, float] | None:
    """The nearest point that is inside a polygon (or outside of it) by a distance [m], exactly proved.

    It is strictly inside, or outside, and no point of the boundary is nearer to it than distance_m
    (kernels `locate` and `boundary_against`); the point itself if that is true of it. How near it is
    is computed on doubles: it is a nearest one but for rounding, about a billionth of the largest
    coordinate. None: no point inside is that far from the boundary, or only by less than that rounding.

    >>> square = polygon([(0, 0), (10, 0), (10, 10), (0, 10)])
    >>> [round(value, 6) for value in recovery_point((1, 5), square, 3, inside=True)]
    [3.0, 5.0]
    >>> [round(value, 6) for value in recovery_point((9, 5), square, 4, inside=False)]
    [14.0, 5.0]
    >>> recovery_point((1, 5), square, 6, inside=True) is None
    True
    """
    found = _points(point, "recovery_point", "point", False)
    width = _buffer(distance_m, "recovery_point")
    if found.ndim != 1 or width.ndim:
        raise BadInput(
            "one point and one distance are wanted",
            where="recovery_point",
            item="point",
            got=f"{found.shape}, {width.shape}",
        )
    wanted = Place.INSIDE if inside else Place.OUTSIDE
    return recovery(float(found[0]), float(found[1]), _flat(shape), float(width), wanted)


# -- legs -------------------------------------------------------------------------------
def contact(starts: Any, ends: Any, shape: Polygon) -> np.ndarray:
    """True for each leg that has a point in common with the polygon's boundary.

    >>> contact((1, 1), [(5, 5), (12, 1)], polygon([(0, 0), (10, 0), (10, 10), (0, 10)]))
    array([False,  True])
    """
    p = _points(starts, "contact", "starts", False)
    q = _points(ends, "contact", "ends", False)
    return arrays.contact(p[..., 0], p[..., 1], q[..., 0], q[..., 1], _flat(shape))


def _leg(
    p: Any, q: Any, shapes: Shape | Iterable[Shape], where: str, motion: Any = None
) -> tuple[Stretch, ...]:
    """motion: the shapes' velocity, and when p and q are passed; all rational."""
    if not isinstance(shapes, Polygon | Region):
        shapes = tuple(shapes)
        if not shapes:
            raise BadInput("no zones", where=where, item="shapes", expected="one or more")
        for shape in shapes:
            _shape(shape, where)
    regions = regions_of(shapes)
    space = any(shape.layered for shape in regions)
    ends = []
    for item, point in (("p", p), ("q", q)):
        found = _points(point, where, item, space)
        if found.ndim != 1:
            raise BadInput("one point is wanted", where=where, item=item, got=str(found.shape))
        ends.append(tuple(map(Fraction, found.tolist())))
    if len(ends[0]) != len(ends[1]):
        raise BadInput(
            "one end has an altitude", where=where, expected="both or neither", got=f"{p}, {q}"
        )
    if motion is not None:
        velocity, *times = motion
        for k, (end, at) in enumerate(zip(ends, times, strict=True)):
            here: Any = seen_from(Vec2(*end[:2]), Vec2(*velocity), at)  # type: ignore[arg-type]
            ends[k] = (*here, *end[2:])
    return passage(ends[0], ends[1], regions)


def leg_places(p: Any, q: Any, shapes: Shape | Iterable[Shape]) -> tuple[Stretch, ...]:
    """The places of the straight leg p-q in the union of the shapes, stretch by stretch.

    >>> gate = polygon([(10, 0), (20, 0), (20, 10), (10, 10)])
    >>> [(str(s.begin), str(s.end), s.place.name) for s in leg_places((0, 5), (40, 5), gate)]
    ... # doctest: +NORMALIZE_WHITESPACE
    [('0', '1/4', 'OUTSIDE'), ('1/4', '1/4', 'BOUNDARY'), ('1/4', '1/2', 'INSIDE'),
     ('1/2', '1/2', 'BOUNDARY'), ('1/2', '1', 'OUTSIDE')]
    """
    return _leg(p, q, shapes, "leg_places")


def leg_stays_inside(p: Any, q: Any, shapes: Shape | Iterable[Shape]) -> bool:
    """True iff every point of the leg is strictly inside at least one of the shapes (keep-ins).

    >>> west = polygon([(0, 0), (6, 0), (6, 9), (0, 9)])
    >>> east = polygon([(5, 0), (9, 0), (9, 9), (5, 9)])
    >>> leg_stays_inside((1, 1), (8, 8), [west, east]), leg_stays_inside((1, 1), (8, 8), west)
    (True, False)
    """
    found = _leg(p, q, shapes, "leg_stays_inside")
    return all(stretch.place is Place.INSIDE for stretch in found)


def leg_stays_outside(p: Any, q: Any, shapes: Shape | Iterable[Shape]) -> bool:
    """True iff no point of the leg is in any of the shapes, boundaries included (keep-outs).

    >>> tower = region([(0, 0), (10, 0), (10, 10), (0, 10)], ceiling_m=120)
    >>> leg_stays_outside((-10, 5, 100), (30, 5, 220), tower)
    True
    >>> leg_stays_outside((-10, 5, 100), (30, 5, 160), tower)
    False
    """
    found = _leg(p, q, shapes, "leg_stays_outside")
    return all(stretch.place is Place.OUTSIDE for stretch in found)


def times_inside(
    p: Any,
    q: Any,
    shapes: Shape | Iterable[Shape],
    *,
    begin_s: float = 0,
    end_s: float = 1,
    boundary: bool = True,
    velocity_m_s: tuple[float, float] = (0, 0),
) -> tuple[tuple[Fraction, Fraction], ...]:
    """When a straight flight is in the union of the shapes: (entry, exit) pairs, exact [s].

    p, q: where it is at begin_s and at end_s. boundary: the boundary counts as inside; without it
    the spans are those of the open part, of which entry and exit are the bounds. velocity_m_s: of all
    shapes, (x, y) [m/s]; they are where their vertices say at the time 0.

    >>> gate = polygon([(10, 0), (20, 0), (20, 10), (10, 10)])
    >>> [(str(a), str(b)) for a, b in times_inside((0, 5), (30, 5), gate, end_s=60)]
    [('20', '40')]
    >>> found = times_inside((0, 5), (60, 5), gate, end_s=60, velocity_m_s=(0.5, 0))
    >>> [(str(a), str(b)) for a, b in found]
    [('20', '40')]
    """
    if not (np.isfinite(begin_s) and np.isfinite(end_s) and begin_s <= end_s):
        raise BadInput(
            "no span of time",
            where="times_inside",
            item="end_s",
            expected="begin_s <= end_s",
            got=f"{begin_s} to {end_s}",
        )
    first, length = Fraction(begin_s), Fraction(end_s) - Fraction(begin_s)
    least = Place.BOUNDARY if boundary else Place.INSIDE
    v = _points(velocity_m_s, "times_inside", "velocity_m_s", False)
    if v.shape != (2,):
        raise BadInput(
            "one velocity is wanted", where="times_inside", item="velocity_m_s", got=str(v.shape)
        )
    motion = tuple(map(Fraction, v.tolist())), first, first + length
    found = spans(_leg(p, q, shapes, "times_inside", motion), least)
    return tuple((first + length * a, first + length * b) for a, b in found)
