"""Polygons of zones: is it one, what does its padding make of it, and circles as polygons.

Whether edges meet is decided by the kernels on exact rationals. The padded outline itself is
computed (with mitred corners, by shapely) and then held against the rules like any other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from math import cos, pi, sin

from cratous.core.polygon import edges_of, on_segment, segments_meet
from cratous.spec.errors import BadInput
from cratous.spec.mission import Zone, ZoneKind

Corner = tuple[float, float]
CIRCLE_CORNERS = 64
MITRE_LIMIT = 5.0


def polygon_problem(vertices: Sequence[Corner]) -> str:
    """Why these corners are no simple polygon, in words; empty if they are."""
    count = len(vertices)
    if count < 3:
        return f"{count} vertices, and a polygon has at least 3"
    if any(value - value != 0 for corner in vertices for value in corner):
        return "a vertex is not finite"
    first: dict[Corner, int] = {}
    for k, corner in enumerate(vertices):
        if corner in first:
            return f"vertex {k + 1} repeats vertex {first[corner] + 1}"
        first[corner] = k
    edges = edges_of([(Fraction(x), Fraction(y)) for x, y in vertices])  # type: ignore[misc]
    for i in range(count):
        a, b = edges[i]
        c = edges[(i + 1) % count][1]
        if on_segment(c, a, b) or on_segment(a, b, c):
            return f"a spike at vertex {(i + 1) % count + 1}: the outline turns back on itself"
    for i in range(count):
        for j in range(i + 2, count):
            if (j + 1) % count != i and segments_meet(*edges[i], *edges[j]):
                return f"{_edge(i, count)} meets {_edge(j, count)}"
    return ""


def _edge(k: int, count: int) -> str:
    return f"edge {k + 1} (vertex {k + 1} to {(k + 1) % count + 1})"


def padded(zone: Zone, where: str, item: str) -> Zone:
    """The zone as it binds: a keep-out widened, a keep-in narrowed, by its padding.

    The result has no padding left to apply. BadInput if nothing remains, or if it falls apart.
    """
    if zone.padding_m == 0:
        return zone
    from shapely import MultiPolygon, Polygon

    keep_out = zone.kind == ZoneKind.KEEP_OUT
    outline = Polygon(zone.vertices).buffer(
        zone.padding_m if keep_out else -zone.padding_m,
        join_style="mitre",
        mitre_limit=MITRE_LIMIT,
    )
    if outline.is_empty or isinstance(outline, MultiPolygon):
        raise BadInput(
            f"the padding of {zone.padding_m:g} m leaves "
            + ("nothing" if outline.is_empty else "separate pieces")
            + f" of zone {zone.id}",
            where=where,
            item=item,
            expected="one region",
            got=f"{zone.padding_m:g} m",
        )
    # a hole in a widened keep-out is closed: the shape then forbids more, never less
    corners = tuple((float(x), float(y)) for x, y in outline.exterior.coords[:-1])
    problem = polygon_problem(corners)
    if problem:
        raise BadInput(
            f"zone {zone.id} with its padding is not a valid polygon: {problem}",
            where=where,
            item=item,
            expected="a simple polygon",
            got=f"padding {zone.padding_m:g} m",
        )
    return replace(zone, vertices=corners, padding_m=0.0)


def rectangle(centre: Corner, width_m: float, height_m: float, rotation_rad: float) -> list[Corner]:
    """Corners (north, east); width is east-west before the rotation from north towards east."""
    turn_cos, turn_sin = cos(rotation_rad), sin(rotation_rad)
    corners = []
    for n_sign, e_sign in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        north, east = n_sign * height_m / 2, e_sign * width_m / 2
        corners.append(
            (
                centre[0] + north * turn_cos - east * turn_sin,
                centre[1] + north * turn_sin + east * turn_cos,
            )
        )
    return corners


def circle(centre: Corner, radius_m: float, *, outside: bool) -> list[Corner]:
    """A polygon around the circle (outside, for a keep-out) or within it (for a keep-in)."""
    reach = radius_m / cos(pi / CIRCLE_CORNERS) if outside else radius_m
    step = 2 * pi / CIRCLE_CORNERS
    return [
        (centre[0] + reach * cos(k * step), centre[1] + reach * sin(k * step))
        for k in range(CIRCLE_CORNERS)
    ]
