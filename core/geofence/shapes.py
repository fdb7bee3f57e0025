"""Polygons and regions as checked values: what is constructed here is valid, or refused with the reason.

Coordinates are metres in one plane (north and east of the mission's frame, or any x and y); altitudes are MSL [m].
Topology: `spec.geofence`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from cratous.core.geofence.planar import edges_of, twice_area
from cratous.core.geofence.validity import Fault, box_of, fault_of
from cratous.core.kernel import Vec2
from cratous.spec.errors import BadInput

SMALLEST_M = 1.0
"""A polygon smaller than this in both directions is assumed to have its corners in degrees [m]."""
UNBOUNDED_M = 2.0**1000
"""Represents no ceiling; its negative, no floor."""


class Place(IntEnum):
    """The place of a point: in the open part, on the boundary, outside the closed part."""

    OUTSIDE = -1
    BOUNDARY = 0
    INSIDE = 1


class BadPolygon(BadInput):
    """Vertices that do not form a polygon; `fault` has the kind and the numbers of vertices or edges."""

    def __init__(self, fault: Fault, *, where: str, item: str, got: str) -> None:
        self.fault = fault
        expected = "a simple polygon, edges meeting only at shared corners"
        super().__init__(fault.text, where=where, item=item, expected=expected, got=got)


@dataclass(frozen=True)
class Polygon:
    """A simple polygon, constructed by `polygon`. vertices: (x, y) [m] in order, not closed."""

    vertices: tuple[tuple[float, float], ...]

    @cached_property
    def edges(self) -> tuple[tuple[Vec2, Vec2], ...]:
        """The closed chain of edges."""
        return edges_of(self.vertices)

    @cached_property
    def columns(self) -> tuple[np.ndarray, ...]:
        """The edges as four arrays: x and y of their first ends, x and y of their second ends."""
        here = np.array(self.vertices, dtype=np.float64)
        there = np.roll(here, -1, axis=0)
        return tuple(np.ascontiguousarray(c) for c in (*here.T, *there.T))

    @cached_property
    def signed_area(self) -> Fraction:
        """The exact area, positive if the vertices turn from +x towards +y [m^2]."""
        edges = [
            tuple(Vec2(*map(Fraction, p)) for p in edge)  # type: ignore[arg-type]
            for edge in self.edges
        ]
        return Fraction(twice_area(edges, edges[0][0])) / 2


@dataclass(frozen=True)
class Region:
    """A polygon with holes, between floor and ceiling, constructed by `region`.

    outline, holes: polygons; a hole may reach beyond the outline, and holes may overlap. floor_m, ceiling_m: MSL [m],
    or None for no bound.
    """

    outline: Polygon
    holes: tuple[Polygon, ...] = ()
    floor_m: float | None = None
    ceiling_m: float | None = None

    @property
    def layered(self) -> bool:
        """True iff altitudes matter."""
        return self.floor_m is not None or self.ceiling_m is not None

    @property
    def floor(self) -> float:
        """The floor, far below everything if there is none [m]."""
        return -UNBOUNDED_M if self.floor_m is None else self.floor_m

    @property
    def ceiling(self) -> float:
        """The ceiling, far above everything if there is none [m]."""
        return UNBOUNDED_M if self.ceiling_m is None else self.ceiling_m


def _corner(k: int, corner: Any, where: str, item: str) -> tuple[float, float]:
    def bad(what: str, expected: str = "(x, y)") -> BadInput:
        text, name = f"vertex {k + 1} {what}", f"{item}[{k}]"
        return BadInput(text, where=where, item=name, expected=expected, got=repr(corner))

    try:
        parts = tuple(corner)
        values = tuple(float(part) for part in parts)
    except (TypeError, ValueError, OverflowError) as error:
        raise bad("is no pair of numbers") from error
    if len(values) != 2:
        raise bad(f"has {len(values)} coordinates")
    if any(value != part for value, part in zip(values, parts, strict=True) if part == part):
        raise bad("is no pair of doubles", "numbers that doubles can hold")
    return values[0], values[1]


def polygon(
    vertices: Iterable[Sequence[float]],
    *,
    metres: bool = True,
    where: str = "",
    item: str = "vertices",
) -> Polygon:
    """A checked polygon from (x, y) pairs in order, either orientation, not closed.

    metres: the coordinates are metres, and corners all within one metre are taken for degrees and refused; with False
    any unit is accepted. where, item: the place, for messages. Raises BadPolygon with the faulty vertex or edge,
    BadInput for values that are not pairs of numbers.
    """
    try:
        listed = list(vertices)
    except TypeError as error:
        raise BadInput(
            "no vertices", where=where, item=item, expected="(x, y) pairs", got=repr(vertices)
        ) from error
    corners = tuple(_corner(k, corner, where, item) for k, corner in enumerate(listed))
    fault = fault_of(corners)
    if fault is not None:
        at = [corners[k - 1] for k in fault.vertices[-1:]]
        got = f"{at[0]}" if at else fault.text
        raise BadPolygon(fault, where=where, item=item, got=got)
    if metres:
        low_x, high_x, low_y, high_y = box_of(corners)
        if high_x - low_x < SMALLEST_M and high_y - low_y < SMALLEST_M:
            raise BadInput(
                "degrees where metres are meant",
                where=where,
                item=item,
                expected=f"metres: no zone is smaller than {SMALLEST_M:g} m both ways",
                got=f"corners within {max(high_x - low_x, high_y - low_y):g} of each other, "
                f"the first {corners[0]}",
            )
    return Polygon(corners)


def region(
    outline: Polygon | Iterable[Sequence[float]],
    *,
    holes: Iterable[Polygon | Iterable[Sequence[float]]] = (),
    floor_m: float | None = None,
    ceiling_m: float | None = None,
    metres: bool = True,
    where: str = "",
) -> Region:
    """A checked region: an outline without its holes, between floor and ceiling.

    Polygons may be given as such or as their vertices. Raises BadInput as `polygon` does, and for
    a floor that is not below the ceiling.
    """

    def made(shape: Any, item: str) -> Polygon:
        if isinstance(shape, Polygon):
            return shape
        return polygon(shape, metres=metres, where=where, item=item)

    for name, value in (("floor_m", floor_m), ("ceiling_m", ceiling_m)):
        if value is not None and not (math.isfinite(value) and abs(value) < UNBOUNDED_M):
            expected = "a number, or None for no bound"
            raise BadInput("not finite", where=where, item=name, expected=expected, got=str(value))
    if floor_m is not None and ceiling_m is not None and not floor_m < ceiling_m:
        raise BadInput(
            "the region has no height",
            where=where,
            item="ceiling_m",
            expected=f"above the floor of {floor_m:g} m",
            got=f"{ceiling_m:g} m",
        )
    found = tuple(made(hole, f"holes[{k}]") for k, hole in enumerate(holes))
    bounds = [None if value is None else float(value) for value in (floor_m, ceiling_m)]
    return Region(made(outline, "outline"), found, bounds[0], bounds[1])
