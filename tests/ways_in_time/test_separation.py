"""Whether zones together separate two places, against the pieces into which shapely cuts the plane."""

from __future__ import annotations

import math
import random

import pytest
from shapely import Point, Polygon
from shapely.ops import unary_union

from cratous.core.geofence.separation import separating
from cratous.spec.mission import Position, Zone, ZoneKind


def zone(number, corners, kind=ZoneKind.KEEP_OUT, floor=0.0, ceiling=1000.0):
    return Zone(number, kind, tuple(corners), floor, ceiling)


def box(number, south, west, north, east, **more):
    corners = ((south, west), (south, east), (north, east), (north, west))
    return zone(number, corners, **more)


A, B = Position(0.0, 0.0, 300.0), Position(1000.0, 0.0, 300.0)
RING = (
    box(1, 800, -200, 850, 200), box(2, 1150, -200, 1200, 200),
    box(3, 800, -200, 1200, -150), box(4, 800, 150, 1200, 200),
)  # fmt: skip


def test_a_ring_of_walls_separates_until_one_of_them_is_gone_or_low():
    assert separating(A, B, RING, 300.0, 300.0) == (1, 2, 3, 4)
    assert separating(B, A, RING, 100.0, 900.0) == (1, 2, 3, 4)
    for k in range(4):
        assert separating(A, B, RING[:k] + RING[k + 1 :], 300.0, 300.0) == ()
    low = (*RING[:3], box(4, 800, 150, 1200, 200, ceiling=400.0))
    assert separating(A, B, low, 300.0, 300.0) == (1, 2, 3, 4)
    assert separating(A, B, low, 300.0, 500.0) == ()
    # both inside, or both outside
    assert separating(B, Position(900.0, 50.0, 300.0), RING, 300.0, 300.0) == ()
    assert separating(A, Position(0.0, 900.0, 300.0), RING, 300.0, 300.0) == ()


def test_a_wall_across_a_keep_in_separates_and_one_that_ends_before_does_not():
    inside = box(9, -500, -500, 2000, 500, kind=ZoneKind.KEEP_IN)
    assert separating(A, B, (inside, box(1, 400, -500, 450, 500)), 300.0, 300.0) == (1, 9)
    assert separating(A, B, (inside, box(1, 400, -499, 450, 500)), 300.0, 300.0) == ()


def test_walls_that_touch_in_one_point_or_along_an_edge_separate():
    left = zone(1, ((500.0, -2000.0), (500.0, 0.0), (400.0, -2000.0)))
    right = zone(2, ((500.0, 0.0), (600.0, 2000.0), (500.0, 2000.0)))
    inside = box(9, -500, -2000, 2000, 2000, kind=ZoneKind.KEEP_IN)
    assert separating(A, B, (left, right, inside), 300.0, 300.0) == (1, 2, 9)
    beside = box(1, 400, -2000, 450, 0), box(2, 400, 0, 450, 2000)
    assert separating(A, B, (*beside, inside), 300.0, 300.0) == (1, 2, 9)


@pytest.mark.parametrize("seed", range(10))
def test_it_agrees_with_the_pieces_of_the_plane(seed):
    draw = random.Random(seed)
    zones = []
    for number in range(1, 10):
        north, east, turn = draw.uniform(-900, 900), draw.uniform(-900, 900), draw.uniform(0, 7)
        long, wide = draw.uniform(300, 900), draw.uniform(20, 120)
        corners = [
            (north + a * math.cos(turn) - b * math.sin(turn), east + a * math.sin(turn) + b * math.cos(turn))
            for a, b in ((-long, -wide), (long, -wide), (long, wide), (-long, wide))
        ]  # fmt: skip
        zones.append(zone(number, corners))
    free = Polygon([(-9e3, -9e3), (-9e3, 9e3), (9e3, 9e3), (9e3, -9e3)]).difference(
        unary_union([Polygon(one.vertices) for one in zones])
    )
    parts = getattr(free, "geoms", [free])
    places = [
        Position(draw.uniform(-1500, 1500), draw.uniform(-1500, 1500), 300.0) for _ in range(6)
    ]
    for p in places:
        for q in places:
            at = [
                [k for k, part in enumerate(parts) if part.contains(Point(x[:2]))] for x in (p, q)
            ]
            if all(at):
                apart = bool(separating(p, q, zones, 300.0, 300.0))
                assert apart == (at[0] != at[1])
