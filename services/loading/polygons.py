"""Polygons of zones: validity, padding, and circles as polygons.

The proved kernels (`core.geofence.validity`) decide on validity. The padded outline is computed by
shapely (mitred corners) and then checked like any other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, pi, sin

from cratous.core.geofence.validity import fault_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Zone, ZoneKind

Corner = tuple[float, float]
CIRCLE_CORNERS = 64
MITRE_LIMIT = 5.0


def polygon_problem(vertices: Sequence[Corner]) -> str:
    """Why these corners are no simple polygon, in words; empty if they are one."""
    fault = fault_of(vertices)
    return "" if fault is None else fault.text


def padded(zone: Zone, where: str, item: str) -> Zone:
    """The effective zone: a keep-out enlarged, a keep-in reduced by its padding.

    The result has padding 0. BadInput if nothing remains, or if it splits into several parts.
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
    # a hole in an enlarged keep-out is filled: this forbids more, never less
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


def hard_zones(zones: Sequence[Zone]) -> tuple[Zone, ...]:
    """The zones with padding applied. BadInput if a zone splits into several parts."""
    return tuple(padded(zone, "", f"zone {zone.id}") for zone in zones)


def one_region(zones: Sequence[Zone], where: str, item: str) -> Zone:
    """The union of overlapping keep-in zones as one region.

    Their paddings are applied. BadInput if they do not join, leave a hole, or differ in altitude.
    """
    from shapely import Polygon, union_all

    first = zones[0]
    hard = [padded(zone, where, item) for zone in zones]
    layers = {(zone.floor_m, zone.ceiling_m) for zone in zones}
    whole = union_all([Polygon(zone.vertices) for zone in hard])
    names = ", ".join(str(zone.id) for zone in zones)
    simple = isinstance(whole, Polygon) and not whole.interiors
    corners = tuple((float(x), float(y)) for x, y in whole.exterior.coords[:-1]) if simple else ()
    if not simple or len(layers) > 1 or polygon_problem(corners):
        raise BadInput(
            f"the keep-in zones {names} do not make one region",
            where=where,
            item=item,
            expected="keep-in zones of one floor and ceiling that overlap and leave no hole",
            got="different altitudes" if len(layers) > 1 else "separate pieces or a hole",
        )
    return replace(first, vertices=corners, padding_m=0.0, label=f"zones {names}")


def rectangle(centre: Corner, width_m: float, height_m: float, rotation_rad: float) -> list[Corner]:
    """Corners (north, east); width is east-west before a rotation from north towards east."""
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
