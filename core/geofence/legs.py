"""A straight leg through regions: its places, with the parameters at which they change, exact.

A leg p-q is p + t (q - p), 0 <= t <= 1, in the plane or in space. The parameters at which it may change its place are
those of `core.geofence.passages`; between two neighbouring ones the place is constant
(`geofence_location_is_constant_between_crossings`, `geofence_layer_is_constant_between_crossings`), so that one point
between them represents all. Everything is computed on rationals: the parameters are fractions, and so are the times.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from cratous.core.geofence.distance import Ratio
from cratous.core.geofence.passages import crossing, foot, level
from cratous.core.geofence.planar import Seen, location_result, location_step, segments_meet
from cratous.core.geofence.regions import layer_place, outside_place, place_in_all, place_in_any
from cratous.core.geofence.shapes import Place, Polygon, Region
from cratous.core.kernel import Vec2, driver

Shape = Polygon | Region
Exact = tuple[Fraction, ...]


@dataclass(frozen=True)
class Stretch:
    """Part of a leg with one place: from parameter `begin` to `end`, which may be equal.

    A stretch on the boundary contains both of its ends; any other contains an end only at an end of the leg.
    """

    begin: Fraction
    end: Fraction
    place: Place


def _at(p: Exact, q: Exact, t: Fraction) -> Exact:
    return tuple(a + t * (b - a) for a, b in zip(p, q, strict=True))


def _plane(p: Exact) -> Vec2:
    return Vec2(p[0], p[1])  # type: ignore[arg-type]


def _rational(edge: tuple[Vec2, Vec2]) -> tuple[Vec2, Vec2]:
    a, b = (Vec2(Fraction(v.x), Fraction(v.y)) for v in edge)  # type: ignore[arg-type]
    return a, b


def _met(p: Exact, q: Exact, shape: Polygon) -> list[tuple[Vec2, Vec2]]:
    """The edges that the leg meets; the others do not affect its places."""
    a, b = _plane(p), _plane(q)
    low_x, high_x, low_y, high_y = min(a.x, b.x), max(a.x, b.x), min(a.y, b.y), max(a.y, b.y)
    near = [
        (c, d)
        for c, d in shape.edges
        if min(c.x, d.x) <= high_x
        and max(c.x, d.x) >= low_x
        and min(c.y, d.y) <= high_y
        and max(c.y, d.y) >= low_y
    ]
    return [edge for edge in map(_rational, near) if segments_meet(a, b, *edge)]


def _place_in(m: Vec2, shape: Polygon) -> int:
    """`locate` on rationals; edges beside the ray contribute nothing and are left out."""
    seen = Seen(False, False)
    for a, b in shape.edges:
        if (a.y >= m.y or b.y >= m.y) and (a.y <= m.y or b.y <= m.y):
            seen = location_step(seen, *_rational((a, b)), m)
    return location_result(seen)


def _as_region(shape: Shape) -> Region:
    return Region(shape) if isinstance(shape, Polygon) else shape


def place_of_rational(point: Exact, shape: Region) -> int:
    """The place of one point on rationals."""
    m = _plane(point)
    places = [(_place_in(m, shape.outline),)]
    places += [(outside_place(_place_in(m, hole)),) for hole in shape.holes]
    if shape.layered:
        floor, ceiling = Fraction(shape.floor), Fraction(shape.ceiling)
        places.append((layer_place(point[2], floor, ceiling),))  # type: ignore[arg-type]
    return int(place_in_all(places))


def _parameters(p: Exact, q: Exact, regions: Sequence[Region]) -> list[Fraction]:
    """0, 1, and between them every parameter at which the place may change."""
    found: set[Fraction] = {Fraction(0), Fraction(1)}

    def add(ratio: Ratio) -> None:
        if ratio.den != 0:
            t = Fraction(ratio.num) / Fraction(ratio.den)
            if 0 < t < 1:
                found.add(t)

    a, b = _plane(p), _plane(q)
    for shape in regions:
        for ring in (shape.outline, *shape.holes):
            for edge in _met(p, q, ring):
                at = crossing(a, b, *edge)
                add(at)
                if at.den == 0:
                    for end in edge:
                        add(foot(a, b, end))
        for bound in (shape.floor_m, shape.ceiling_m):
            if bound is not None:
                add(level(p[2], q[2], Fraction(bound)))  # type: ignore[arg-type]
    return sorted(found)


@driver(checked_by=("location_step", "layer_place", "crossing", "foot", "level", "place_in_any"))
def passage(p: Exact, q: Exact, regions: Sequence[Region]) -> tuple[Stretch, ...]:
    """The places of a leg in the union of regions, stretch by stretch.

    p, q: rationals, (x, y) or (x, y, altitude); an altitude is needed by a region with a floor or
    a ceiling.
    """
    stops = _parameters(p, q, regions)

    def place(t: Fraction) -> Place:
        point = _at(p, q, t)
        return Place(place_in_any([(place_of_rational(point, shape),) for shape in regions]))

    pieces = [Stretch(Fraction(0), Fraction(0), place(Fraction(0)))]
    for begin, end in pairwise(stops):
        pieces.append(Stretch(begin, end, place((begin + end) / 2)))
        pieces.append(Stretch(end, end, place(end)))
    merged = pieces[:1]
    for piece in pieces[1:]:
        last = merged[-1]
        if piece.place == last.place:
            merged[-1] = Stretch(last.begin, piece.end, piece.place)
        else:
            merged.append(piece)
    return tuple(merged)


def spans(stretches: Iterable[Stretch], least: Place) -> tuple[tuple[Fraction, Fraction], ...]:
    """The spans of parameters with at least this place, neighbouring ones joined."""
    found: list[tuple[Fraction, Fraction]] = []
    joined = False
    for stretch in stretches:
        if stretch.place >= least:
            if joined:
                found[-1] = (found[-1][0], stretch.end)
            else:
                found.append((stretch.begin, stretch.end))
        joined = stretch.place >= least
    return tuple(found)


def regions_of(shapes: Shape | Iterable[Shape]) -> tuple[Region, ...]:
    """One shape or several, as regions."""
    if isinstance(shapes, Polygon | Region):
        return (_as_region(shapes),)
    return tuple(_as_region(shape) for shape in shapes)
