"""Squares of an area and lanes over it: what covers, what is seen, what is too many."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest
from task_tools import ELL, FIELD

from cratous.core.tasks import sweep
from cratous.core.tasks.coverage import (
    area_m2,
    disc,
    look,
    seen_squares,
    share_covered,
    square_array,
    square_side_m,
    squares,
)
from cratous.core.tasks.sweep import Strip, edge_headings, sector, square_spiral, strips, swath


@pytest.mark.parametrize("corners", [FIELD, ELL, disc((50.0, -20.0), 200.0), FIELD[::-1]])
def test_the_squares_are_those_that_touch_the_area(corners: Any) -> None:
    from shapely import Polygon, box

    shape, side = Polygon(corners), 35.0
    found = set(squares(corners, side))
    low = np.min(corners, axis=0)
    counts = np.ceil((np.max(corners, axis=0) - low) / side).astype(int)
    for i in range(counts[0]):
        for j in range(counts[1]):
            x, y = low[0] + (i + 0.5) * side, low[1] + (j + 0.5) * side
            square = box(x - side / 2, y - side / 2, x + side / 2, y + side / 2)
            if square.intersection(shape).area > 1e-6:
                assert (x, y) in found
            elif not square.buffer(1e-6).intersects(shape):
                assert (x, y) not in found
    assert area_m2(corners) == pytest.approx(shape.area)


def test_a_square_is_seen_only_if_one_footprint_holds_all_of_it() -> None:
    from shapely import Polygon, box

    side = 20.0
    centres = np.array(squares(((0.0, 0.0), (0.0, 400.0), (400.0, 400.0), (400.0, 0.0)), side))
    rng = np.random.default_rng(3)
    for _ in range(20):
        turn, middle = rng.uniform(0, 6), rng.uniform(100, 300, 2)
        corners = [
            (
                float(middle[0] + 120 * math.cos(turn + a)),
                float(middle[1] + 90 * math.sin(turn + a)),
            )
            for a in (0.3, 1.9, 3.4, 5.0)
        ]
        for footprint in (corners, corners[::-1]):
            seen = set(seen_squares(centres, side, footprint))
            for k, (x, y) in enumerate(centres):
                square = box(x - 10, y - 10, x + 10, y + 10)
                assert (k in seen) == Polygon(footprint).buffer(1e-9).covers(square)


@pytest.mark.parametrize("corners", [ELL, FIELD])
def test_no_square_in_a_footprint_is_skipped_whatever_lies_beside_it(corners: Any) -> None:
    """Rows are searched for the first square that may lie within: all others are asked one by one here."""
    rng = np.random.default_rng(7)
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    side_m = float((high - low).max()) / 40
    centres = square_array(tuple((float(n), float(e)) for n, e in corners), side_m)
    seen, wanted = np.zeros(len(centres), np.bool_), np.zeros(len(centres), np.bool_)
    half = side_m / 2
    for _ in range(12):
        middle, size = rng.uniform(low, high), rng.uniform(1.0, 9.0, 2) * side_m
        turn = rng.uniform(0.0, 0.4)
        east, north = (
            np.array([-math.sin(turn), math.cos(turn)]),
            np.array([math.cos(turn), math.sin(turn)]),
        )
        quad = [
            middle + a * size[0] * north + b * size[1] * east
            for a, b in ((-1, -1), (-1, 1), (1, 1), (1, -1))
        ]
        look(centres, side_m, [quad], seen)
        at = [np.add(centres, (a, b)) for a in (-half, half) for b in (-half, half)]
        inside = [
            (np.abs((c - middle) @ north) <= size[0]) & (np.abs((c - middle) @ east) <= size[1])
            for c in at
        ]
        wanted |= np.logical_and.reduce(inside)
    assert (seen == wanted).all()
    assert 0 < seen.sum() < len(seen)


def test_what_is_not_seen_counts_in_full() -> None:
    corners = ((0.0, 0.0), (0.0, 1000.0), (1000.0, 1000.0), (1000.0, 0.0))
    side = square_side_m(corners)
    centres = np.array(squares(corners, side))
    half = ((0.0, 0.0), (0.0, 1000.0), (500.0, 1000.0), (500.0, 0.0))
    left = len(centres) - len(seen_squares(centres, side, half))
    assert share_covered(left, side, area_m2(corners)) == pytest.approx(0.5)


@pytest.mark.parametrize("heading", [0.0, 0.7, 2.4, 4.0])
@pytest.mark.parametrize("corners", [FIELD, ELL])
def test_strips_cover_the_polygon(heading: float, corners: Any) -> None:
    from shapely import LineString, Polygon, unary_union

    parts = strips(corners, heading, 90.0)
    wide = [LineString(s).buffer(45.001, cap_style="flat") for s in parts]
    assert Polygon(corners).difference(unary_union(wide)).area < 1.0


@pytest.mark.parametrize("width", [90.0, 250.0, 1500.0])
def test_square_spirals_and_sectors_cover_their_extent(width: float) -> None:
    from shapely import LineString, Point, box, unary_union

    def covered(parts: list[Strip]) -> Any:
        return unary_union([LineString(s).buffer(width / 2, cap_style="square") for s in parts])

    square = covered(square_spiral((10.0, 20.0), 500.0, width, 0.0))
    assert box(-490, -480, 510, 520).difference(square).area < 1.0
    passes = sector((10.0, 20.0), 500.0, width, 0.4)
    assert Point(10, 20).buffer(499).difference(covered(passes)).area < 1.0
    assert len(passes) >= 3
    assert all(LineString(s).distance(Point(10, 20)) < 1e-6 for s in passes)


def test_too_many_lanes_are_no_lanes() -> None:
    assert strips(FIELD, 0.0, 1.0) == []
    assert square_spiral((0.0, 0.0), 1000.0, 1.0, 0.0) == []
    assert sector((0.0, 0.0), 1000.0, 1.0, 0.0) == []


def test_a_swath_leaves_out_what_is_in_view_too_shortly() -> None:
    diamond = ((100.0, 0.0), (0.0, 100.0), (-100.0, 0.0), (0.0, -100.0))
    found = swath(diamond, 0.3, 50.0)
    assert found is not None
    assert 60 < found.right_m <= 90
    assert swath(diamond, 0.3, 500.0) is None


def test_headings_are_those_of_the_edges() -> None:
    assert edge_headings(ELL, math.radians(20)) == pytest.approx([math.pi / 2, 0.0])
    assert len(edge_headings(disc((0.0, 0.0), 100.0), math.radians(20))) <= 9


def row_of(own: list[tuple[float, float]], y: float) -> tuple[float, float]:
    """The range ahead of a convex polygon at an offset to the right, edge by edge."""
    along = []
    for (x1, y1), (x2, y2) in zip(own, (*own[1:], own[0]), strict=True):
        if min(y1, y2) <= y <= max(y1, y2):
            t = (y - y1) / (y2 - y1) if y1 != y2 else 0.0
            along += [x1 + t * (x2 - x1), x2 if y1 == y2 else x1 + t * (x2 - x1)]
    return (min(along), max(along)) if along else (0.0, 0.0)


def test_rows_of_a_footprint_are_those_found_edge_by_edge_to_the_last_bit() -> None:
    chance = random.Random(5)
    square = [(-50.0, -80.0), (-50.0, 80.0), (120.0, 80.0), (120.0, -80.0)]
    for case in range(300):
        angles = sorted(chance.uniform(0, 2 * math.pi) for _ in range(chance.choice([3, 4, 6])))
        own = [(200 * math.cos(a) + 30, 150 * math.sin(a)) for a in angles]
        own = own if case % 3 else square
        row = sweep._rows(own)
        for y in [*(chance.uniform(-200, 200) for _ in range(20)), *(corner[1] for corner in own)]:
            assert row(y) == row_of(own, y)
