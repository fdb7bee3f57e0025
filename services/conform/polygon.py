"""Suite `polygon`: location of a point, and proximity to the boundary, by the exact reading of
folds.

A case gives `polygon` (a list of [x, y], either order, not closed), `point` [x, y], or [x, y, z]
with `floor` and `ceiling` (kind `contain3d`), and the truth `exact`: `location` (inside, outside or
boundary), and with `buffer` also `near` (some point of the boundary is nearer than the buffer) and
`dist2`, the squared distance as a fraction. In space `location2d` and `near2d` are those in the
plane. Everything is judged with both vertex orders, for any polygon. Moving polygons and recovery
points are not covered.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from cratous.core.geofence.distance import boundary_against, boundary_distance
from cratous.core.geofence.planar import edges_of, locate
from cratous.core.geofence.regions import both_places, layer_place
from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact
from cratous.services.conform import Result, failed, not_covered, passed
from cratous.services.conform.values import (
    identity,
    not_negative,
    number,
    numbers,
    truth,
    vector,
)
from cratous.spec.errors import BadInput

WORDS = {-1: "outside", 0: "boundary", 1: "inside"}
COVERED = {"contain2d": 2, "contain3d": 3}
CLOSE = 1e-9
"""Relative error permitted in a distance given as a double."""

Check = tuple[str, str, str]
"""What was compared, the expected and the actual result."""


def judge(case: dict[str, Any]) -> Result:
    """Run one case of the suite; the results of its checks."""
    name = identity(case)
    size = _dimensions(case)
    kind = str(case.get("kind", "contain3d" if size == 3 else "contain2d"))
    if kind not in COVERED:
        return not_covered(name, kind)
    told = case.get("exact")
    known = isinstance(told, dict) and "location" in told
    if not known and "dist_to_boundary" not in case:
        return not_covered(name, "no exact location given")
    corners = case.get("polygon")
    if not isinstance(corners, list) or len(corners) < 3:
        raise BadInput("not a polygon", item="polygon", expected="a list of 3 or more [x, y]")
    vertices = [numbers(c, f"polygon[{k}]", 2) for k, c in enumerate(corners)]
    point = vector(case, "point", COVERED[kind])
    checks = 0
    for order, ring in (("as given", vertices), ("reversed", vertices[::-1])):
        edges = edges_of([(a, b) for a, b in ring])
        for what, wanted, got in _checks(case, edges, point):
            checks += 1
            if got != wanted:
                text = f"{what}: expected {wanted}, got {got} (vertices {order}); "
                text += f"point {point!r}, {len(vertices)} vertices"
                label = f"{wanted} taken for {got}"
                return failed(
                    name, label if what == "location" else f"{what}: {label}", text, checks
                )
    return passed(name, checks)


def _dimensions(case: dict[str, Any]) -> int:
    point = case.get("point")
    return len(point) if isinstance(point, list) else 2


def _checks(case: dict[str, Any], edges: Any, point: tuple[float, ...]) -> Iterator[Check]:
    """Everything that the case states and the kernels decide."""
    told = case.get("exact") or {}
    at = Vec2(point[0], point[1])
    where = exact(locate, edges, at)
    if "location" in told:
        place = where
        if len(point) == 3:
            layer = exact(layer_place, point[2], number(case, "floor"), number(case, "ceiling"))
            place = both_places(where, layer)
        yield "location", _location(told, "location"), WORDS[place]
    if "location2d" in told:
        yield "location in the plane", _location(told, "location2d"), WORDS[where]
    for name in ("near", "near2d"):
        if name in told:
            verdict = exact(boundary_against, edges, at, not_negative(case, "buffer"))
            yield "near the boundary", _yes(truth(told, name)), _yes(verdict < 0)
    if "dist2" in told or "dist_to_boundary" in case:
        ratio = exact(boundary_distance, edges, at)
        squared = Fraction(ratio.num) / Fraction(ratio.den)
        if "dist2" in told:
            yield "squared distance", str(_fraction(told["dist2"])), str(squared)
        else:
            wanted = not_negative(case, "dist_to_boundary")
            close = math.isclose(math.sqrt(squared), wanted, rel_tol=CLOSE)
            yield "distance", f"{wanted!r}", f"{wanted if close else math.sqrt(squared)!r}"


def _yes(value: bool) -> str:
    return "yes" if value else "no"


def _location(told: dict[str, Any], name: str) -> str:
    """`inside`, `outside`, `boundary`; also -1, 0, 1."""
    wanted = told[name]
    if isinstance(wanted, int) and not isinstance(wanted, bool):
        wanted = WORDS.get(wanted)
    if wanted not in WORDS.values():
        raise BadInput(
            "no location",
            item=f"exact.{name}",
            expected=", ".join(WORDS.values()),
            got=repr(told[name]),
        )
    return str(wanted)


def _fraction(value: Any) -> Fraction:
    """A fraction written "a/b", or as two numbers in a list."""
    try:
        if isinstance(value, list):
            top, bottom = value
            return Fraction(int(top), int(bottom))
        return Fraction(value)
    except (TypeError, ValueError, ZeroDivisionError, OverflowError) as error:
        raise BadInput(
            "no fraction", item="exact.dist2", expected='"a/b"', got=repr(value)[:60]
        ) from error
