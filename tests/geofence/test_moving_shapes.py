"""Times in moving shapes against shapes that are moved, and recovery points against buffers of another library."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cratous.core import geofence
from cratous.core.geofence import Place, polygon, region
from cratous.spec.errors import BadInput

COMB = [(0, 0), (9, 0), (9, 6), (7, 6), (7, 2), (5, 2), (5, 6), (3, 6), (3, 2), (1, 2), (1, 6), (0, 6)]  # fmt: skip
SMALL = st.integers(-12, 12)
PAIR = st.tuples(SMALL, SMALL)


def moved(corners, velocity, at: Fraction):
    return [(x + at * velocity[0], y + at * velocity[1]) for x, y in corners]


def winds(point, corners) -> int:
    """1 inside, 0 on the boundary, -1 outside, by winding on rationals."""
    x, y = point
    found = 0
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        turn = (bx - ax) * (y - ay) - (x - ax) * (by - ay)
        if turn == 0 and (x - ax) * (x - bx) + (y - ay) * (y - by) <= 0:
            return 0
        found += (ay <= y < by and turn > 0) - (by <= y < ay and turn < 0)
    return 1 if found else -1


@settings(max_examples=150, deadline=None)
@given(PAIR, PAIR, st.tuples(st.integers(-3, 3), st.integers(-3, 3)), st.integers(0, 4))
def test_times_in_a_moving_comb_are_those_of_the_moved_comb(p, q, velocity, begin):
    end = begin + 4
    spans = geofence.times_inside(
        p, q, polygon(COMB), begin_s=begin, end_s=end, velocity_m_s=velocity
    )
    for k in range(65):
        share = Fraction(k, 64)
        at = begin + share * 4
        here = tuple(a + share * (b - a) for a, b in zip(p, q, strict=True))
        inside = winds(here, moved(COMB, velocity, at)) >= 0
        assert inside == any(first <= at <= last for first, last in spans)


def test_a_moving_region_keeps_its_layer_and_bad_velocities_are_refused():
    gate = region([(10, 0), (20, 0), (20, 10), (10, 10)], ceiling_m=100)
    found = geofence.times_inside((0, 5, 70), (60, 5, 190), gate, end_s=60, velocity_m_s=(0.5, 0))
    assert found == ()  # at 20 s, on entry, it is at 110 m
    found = geofence.times_inside((0, 5, 50), (60, 5, 170), gate, end_s=60, velocity_m_s=(0.5, 0))
    assert found == ((20, 25),)
    # a leg on the spot is met by the polygon that comes
    here = geofence.times_inside((30, 5, 9), (30, 5, 9), gate, end_s=60, velocity_m_s=(1, 0))
    assert here == ((10, 20),)
    for wrong in ((1, 2, 3), 5, (math.nan, 0), ((1, 0), (2, 0))):
        with pytest.raises(BadInput):
            geofence.times_inside((0, 5, 9), (9, 5, 9), gate, velocity_m_s=wrong)


def star(rng: np.random.Generator) -> list[tuple[float, float]]:
    n = int(rng.integers(3, 14))
    angles = (np.arange(n) + rng.uniform(0.1, 0.9, n)) * 2 * np.pi / n
    radii = rng.uniform(100, 1000, n)
    return [(float(r * np.cos(a)), float(r * np.sin(a))) for r, a in zip(radii, angles, strict=True)]  # fmt: skip


@pytest.mark.parametrize("inside", [True, False])
@pytest.mark.parametrize("seed", range(40))
def test_recovery_points_are_proved_and_nearest(seed, inside):
    rng = np.random.default_rng(seed)
    corners, d = star(rng), float(rng.uniform(0, 150))
    shape, other = polygon(corners), shapely.Polygon(corners)
    point = tuple(rng.uniform(-1200, 1200, 2).tolist())
    found = geofence.recovery_point(point, shape, d, inside=inside)
    # polygons for arcs lie within the arcs: fine enough that the figures agree to centimetres
    grown = other.buffer(-d if inside else d, quad_segs=2048)
    if found is None:
        assert inside
        assert grown.buffer(-1e-3).is_empty
        return
    wanted = Place.INSIDE if inside else Place.OUTSIDE
    assert geofence.place(found, shape) is wanted
    assert geofence.against_buffer(found, shape, d) >= 0
    target = grown if inside else shapely.box(-9e3, -9e3, 9e3, 9e3).difference(grown)
    assert math.dist(found, point) == pytest.approx(target.distance(shapely.Point(point)), abs=0.02)


@settings(max_examples=100, deadline=None)
@given(PAIR, st.integers(0, 4), st.booleans())
def test_recovery_points_of_a_comb(point, d, inside):
    """Whole numbers: feet, crossings and vertices lie on each other."""
    shape, other = polygon(COMB), shapely.Polygon(COMB)
    found = geofence.recovery_point(point, shape, d, inside=inside)
    grown = other.buffer(-d if inside else d, quad_segs=512)
    if inside and d > 1:
        assert found is None
        return
    assume(not (inside and d == 1))  # its base is just two wide: a segment, which `grown` may lose
    assert found is not None
    target = grown if inside else shapely.box(-99, -99, 99, 99).difference(grown)
    assert math.dist(found, point) == pytest.approx(target.distance(shapely.Point(point)), abs=1e-3)


def test_the_only_point_is_found_and_a_point_far_enough_stays():
    square = polygon([(0, 0), (10, 0), (10, 10), (0, 10)])
    assert geofence.recovery_point((2, 2), square, 5, inside=True) == (5.0, 5.0)
    assert geofence.recovery_point((2, 2), square, 5.001, inside=True) is None
    assert geofence.recovery_point((4, 6), square, 4, inside=True) == (4.0, 6.0)
    assert geofence.recovery_point((14, 5), square, 4, inside=False) == (14.0, 5.0)
    comb = geofence.recovery_point((4, 1), polygon(COMB), 1, inside=True)
    assert comb == (4.0, 1.0)
    for wrong in ({"point": (1, 2, 3, 4)}, {"distance_m": -1}, {"distance_m": [1, 2]}):
        with pytest.raises(BadInput):
            geofence.recovery_point(
                **{"point": (1, 2), "shape": square, "distance_m": 1, "inside": True} | wrong
            )


def test_a_polygon_with_many_vertices_is_answered_soon():
    corners = [(1000 * math.cos(k / 100 * math.pi), 1000 * math.sin(k / 100 * math.pi)) for k in range(200)]  # fmt: skip
    shape = polygon(corners)
    assert geofence.recovery_point((0, 10), shape, 1001, inside=True) is None
    found = geofence.recovery_point((3, 4), shape, 200, inside=False)
    assert found is not None
    assert math.hypot(*found) == pytest.approx(1200, abs=1)
