"""Geofences: shapes are valid or refused, verdicts are exact, legs are judged at each point."""

from __future__ import annotations

import doctest
import itertools
import math
import random
from fractions import Fraction
from typing import Any, cast

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core import geofence
from cratous.core.geofence import Place, polygon, region
from cratous.core.geofence.arrays import boundary_against, contact, places_in_polygon
from cratous.core.geofence.distance import boundary_against as fold_against
from cratous.core.geofence.distance import edge_against, leg_within
from cratous.core.geofence.mission_legs import leg_ok
from cratous.core.geofence.planar import edges_of, locate, meets_boundary
from cratous.core.kernel import Vec2
from cratous.core.readings.exact import exact
from cratous.core.readings.exact.folds import folded
from cratous.services.mission.zones import exact_leg_ok
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, Zone, ZoneKind

SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10)]
COMB = [(0, 0), (9, 0), (9, 6), (7, 6), (7, 2), (5, 2), (5, 6), (3, 6), (3, 2), (1, 2), (1, 6), (0, 6)]  # fmt: skip
SQUARE_ROUND = [(-1, -1), (-1, 1), (1, 1), (1, -1)]
SMALL = st.integers(-6, 6)
POINT = st.tuples(SMALL, SMALL)


def star(rng: np.random.Generator, n: int, size: float = 1000.0) -> list[tuple[float, float]]:
    """A random star polygon: simple, either order."""
    angles = np.sort(rng.random(n)) * 2 * np.pi
    radii = rng.uniform(0.2, 1.0, n) * size
    corners = [(float(r * np.cos(a)), float(r * np.sin(a))) for r, a in zip(radii, angles, strict=True)]  # fmt: skip
    return corners if rng.random() < 0.5 else corners[::-1]


def exactly_placed(point: tuple[float, float], corners: list[tuple[float, float]]) -> int:
    """The definition on rationals, edge by edge, by winding: an oracle of another kind."""
    x, y = map(Fraction, point)
    winding = 0
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        ax, ay, bx, by = map(Fraction, (ax, ay, bx, by))
        turn = (bx - ax) * (y - ay) - (x - ax) * (by - ay)
        if turn == 0 and (x - ax) * (x - bx) + (y - ay) * (y - by) <= 0:
            return 0
        winding += (ay <= y < by and turn > 0) - (by <= y < ay and turn < 0)
    return 1 if winding else -1


def test_the_examples_of_the_docstrings_hold():
    found = doctest.testmod(geofence)
    assert found.attempted > 20
    assert found.failed == 0


# -- validity ---------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("corners", "kind", "vertices", "edges"),
    [
        ([], "few", (), ()),
        ([(0, 0), (9, 0)], "few", (1, 2), ()),
        ([(0, 0), (9, 0), (9, 9), (0, 0)], "repeated", (1, 4), ()),
        ([(0, 0), (9, 0), (9, 0), (0, 9)], "repeated", (2, 3), ()),
        ([(0, 0), (9, 0), (math.nan, 9)], "not finite", (3,), ()),
        ([(0, 0), (9, 0), (9, -math.inf)], "not finite", (3,), ()),
        ([(0, 0), (9, 0), (4, 0)], "spike", (2,), (1, 2)),
        ([(0, 0), (9, 0), (9, 9), (9, 4), (0, 4)], "spike", (3,), (2, 3)),
        ([(0, 0), (9, 9), (9, 0), (0, 9)], "crossing", (), (1, 3)),
        ([(0, 0), (9, 0), (9, 9), (5, 0), (0, 9)], "crossing", (), (1, 3)),
        ([(0, 0), (8, 0), (8, 8), (4, 0.0), (3, 8)], "crossing", (), (1, 3)),
    ],
)
def test_what_is_no_polygon_is_refused_with_its_place(corners, kind, vertices, edges):
    with pytest.raises(geofence.BadPolygon) as caught:
        polygon(corners, where="zones.yaml", item="zones[3].vertices")
    fault = caught.value.fault
    assert (fault.kind, fault.vertices, fault.edges) == (kind, vertices, edges)
    assert "zones.yaml: zones[3].vertices" in str(caught.value)
    assert caught.value.data()["error"] == fault.text


@pytest.mark.parametrize(
    ("corners", "words"),
    [
        (None, "no vertices"),
        (7, "no vertices"),
        ([(0, 0), (1, 0), 5], "vertex 3 is no pair"),
        ([(0, 0), (1, "a"), (5, 5)], "vertex 2 is no pair"),
        ([(0, 0), (1, 0, 3), (5, 5)], "vertex 2 has 3 coordinates"),
        ([(0, 0), (2**53 + 1, 0), (5, 5)], "vertex 2 is no pair of doubles"),
        ([(38.1, -77.2), (38.2, -77.2), (38.2, -77.3)], "degrees where metres are meant"),
    ],
)
def test_what_are_no_vertices_is_refused(corners, words):
    with pytest.raises(BadInput, match=words):
        polygon(corners)


def test_degrees_may_be_meant():
    shape = polygon([(38.1, -77.2), (38.2, -77.2), (38.2, -77.3)], metres=False)
    assert geofence.place((38.15, -77.22), shape) is Place.INSIDE


@given(st.lists(POINT, min_size=3, max_size=7))
@settings(max_examples=300, deadline=None)
def test_validity_agrees_with_another_system(corners):
    ours = geofence.fault_of([(float(x), float(y)) for x, y in corners]) is None
    ring = shapely.LinearRing(corners) if len(set(corners)) >= 3 else None
    theirs = ring is not None and ring.is_valid and len(set(corners)) == len(corners)
    assert ours == (theirs and shapely.Polygon(corners).is_valid)
    if ours:
        area = polygon(corners, metres=False).signed_area
        assert abs(area) == Fraction(shapely.Polygon(corners).area)
        assert polygon(corners[::-1], metres=False).signed_area == -area


# -- points -----------------------------------------------------------------------------------
@pytest.mark.parametrize("seed", range(4))
def test_places_of_arrays_are_those_of_the_definition(seed):
    rng = np.random.default_rng(seed)
    corners = star(rng, int(rng.integers(3, 30)))
    shape = polygon(corners)
    here = np.array(corners)
    share = rng.random((40, 1))
    on = here[rng.integers(0, len(here), 40)] * (1 - share) + share * here[0]
    points = np.concatenate([rng.uniform(-1000, 1000, (60, 2)), here, (here + here[0]) / 2, on])
    # in line with vertices, where rays pass through them
    points = np.concatenate([points, np.c_[rng.uniform(-1000, 1000, len(here)), here[:, 1]]])
    found = geofence.places(points, shape)
    wanted = [exactly_placed(tuple(p), corners) for p in points.tolist()]
    assert found.tolist() == wanted
    again = geofence.places(points, polygon(corners[::-1]))
    assert np.array_equal(found, again)
    one_by_one = [exact(locate, shape.edges, Vec2(*p)) for p in points.tolist()]
    assert found.tolist() == one_by_one


def test_arrays_are_exact_where_doubles_are_not():
    # the edge through the origin: a point with tiny coordinates on it, and one ulp off it
    shape = polygon([(-3.0 * 2**30, -1.0 * 2**30), (3.0 * 2**30, 1.0 * 2**30), (0, 2.0**31)])
    tiny = 2.0**-60
    points = [
        (3 * tiny, tiny),
        (3 * tiny, math.nextafter(tiny, 1)),
        (3 * tiny, math.nextafter(tiny, 0)),
    ]
    assert geofence.places(points, shape).tolist() == [0, 1, -1]
    huge = polygon([(0, 0), (2.0**900, 0), (0, 2.0**900)])
    assert geofence.places([(2.0**899, 2.0**899), (2.0**899, 2.0**898)], huge).tolist() == [0, 1]


def test_points_broadcast_and_give_their_shape():
    shape = polygon(SQUARE)
    grid = np.stack(np.meshgrid(np.arange(-1.0, 12), np.arange(-1.0, 12)), axis=-1)
    assert geofence.places(grid, shape).shape == (13, 13)
    assert (geofence.places(grid, shape) == 1).sum() == 81
    assert (geofence.places(grid, shape) == 0).sum() == 40
    assert geofence.places(np.empty((0, 2)), shape).shape == (0,)
    each = geofence.places_in_each(grid, [shape, polygon(COMB)])
    assert each.shape == (13, 13, 2)
    near = geofence.against_buffer(grid, shape, np.ones((13, 1)))
    assert near.shape == (13, 13)
    starts, ends = np.full((4, 1, 2), 5), np.array([[20, 20], [5, 5], [10, 10]])
    assert geofence.contact(starts, ends, shape).tolist() == [[True, False, True]] * 4


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([1.0, 2.0, 3.0, 4.0], "wrong shape"),
        (3.0, "wrong shape"),
        ([[math.nan, 1.0]], r"points\[0, 0\]: not finite"),
        ([[0.0, 1.0], [2.0, math.inf]], r"points\[1, 1\]: not finite"),
        ([["a", "b"]], "no array of numbers"),
        ([[True, False]], "no real numbers"),
        ([[2**53 + 2, 0]], "no double"),
    ],
)
def test_what_are_no_points_is_refused(points, words):
    with pytest.raises(BadInput, match=words):
        geofence.places(points, polygon(SQUARE))


def test_misuse_is_refused():
    square = polygon(SQUARE)
    for call in (
        lambda: geofence.places((1, 1), SQUARE),
        lambda: geofence.place([(1, 1), (2, 2)], square),
        lambda: geofence.places((1, 1), region(SQUARE, floor_m=0)),
        lambda: geofence.against_buffer((1, 1), square, -1),
        lambda: geofence.against_buffer((1, 1), square, math.nan),
        lambda: geofence.against_buffer((1, 1), region(SQUARE), 1),
        lambda: geofence.against_buffer([(1, 1), (2, 2)], square, [1, 2, 3]),
        lambda: geofence.squared_distance([(1, 1), (2, 2)], square),
        lambda: geofence.places_in_each((1, 1), []),
        lambda: geofence.leg_places((1, 1), (2, 2), []),
        lambda: geofence.leg_places((1, 1), (2, 2, 3), square),
        lambda: geofence.leg_places((1, 1), (2, 2), [SQUARE]),
        lambda: geofence.times_inside((1, 1), (2, 2), square, begin_s=5, end_s=1),
        lambda: region(SQUARE, floor_m=10, ceiling_m=10),
        lambda: region(SQUARE, floor_m=math.nan),
        lambda: region(SQUARE, holes=[[(1, 1)]]),
    ):
        with pytest.raises(BadInput):
            call()


# -- distances --------------------------------------------------------------------------------
@pytest.mark.parametrize("seed", range(3))
def test_distances_are_exact(seed):
    rng = np.random.default_rng(seed)
    corners = star(rng, 9)
    shape, ring = polygon(corners), shapely.Polygon(corners).exterior
    for point in rng.uniform(-1200, 1200, (20, 2)).tolist():
        squared = geofence.squared_distance(point, shape)
        assert math.isclose(math.sqrt(squared), ring.distance(shapely.Point(point)), rel_tol=1e-9)
        # the doubles around the root decide as the rationals do
        root = math.sqrt(squared)
        for d in (math.nextafter(root, 0), root, math.nextafter(root, math.inf)):
            sign = (squared > Fraction(d) ** 2) - (squared < Fraction(d) ** 2)
            assert int(geofence.against_buffer(point, shape, d)) == sign


def test_buffers_round_corners_and_meet_at_their_boundary():
    square = polygon(SQUARE)
    points = [
        (13, 14),
        (13, 14.5),
        (12.9, 14),
        (5, 15),
        (5, 5),
        (5, 10),
        (3, 5),
        (2.9, 5),
        (3.1, 5),
    ]
    wide = geofence.buffered_places(points, square, 5, inwards=False)
    assert wide.tolist() == [0, -1, 1, 0, 1, 1, 1, 1, 1]
    narrow = geofence.buffered_places(points, square, 3, inwards=True)
    assert narrow.tolist() == [-1, -1, -1, -1, 1, -1, 0, -1, 1]
    assert geofence.buffered_places((5, 10), square, 0, inwards=True) == 0
    assert geofence.buffered_places((5, 10), square, 0, inwards=False) == 0


@given(*[POINT] * 4, st.integers(0, 5))
@settings(max_examples=300, deadline=None)
def test_a_leg_is_within_a_buffer_as_the_nearest_pair_is(p, q, a, b, d):
    ours = leg_within(*[Vec2(*map(float, v)) for v in (p, q, a, b)], float(d))
    theirs = shapely.LineString([p, q]).distance(shapely.LineString([a, b]))
    if abs(theirs - d) > 1e-9:
        assert ours == (theirs < d)


def test_folds_over_arrays_are_the_folds():
    rng = np.random.default_rng(5)
    # a small grid: contacts and ties everywhere
    for _ in range(20):
        corners = [tuple(map(float, c)) for c in rng.integers(-3, 4, (5, 2))]
        edges = edges_of(corners)
        shape = geofence.Polygon(tuple(corners))
        x, y, u, v = rng.integers(-4, 5, (4, 50)).astype(float)
        rows = list(zip(x.tolist(), y.tolist(), u.tolist(), v.tolist(), strict=True))
        wanted = [locate(edges, Vec2(a, b)) for a, b, _, _ in rows]
        assert places_in_polygon(x, y, shape).tolist() == wanted
        met = [meets_boundary(edges, Vec2(a, b), Vec2(c, d)) for a, b, c, d in rows]
        assert contact(x, y, u, v, shape).tolist() == met
        signs = [fold_against(edges, Vec2(a, b), abs(c)) for a, b, c, _ in rows]
        assert boundary_against(x, y, np.abs(u), shape).tolist() == signs
        # without a way for many at once, the open ones are decided one by one
        assert folded(fold_against)(shape.columns, x, y, np.abs(u)).tolist() == signs
    with pytest.raises(BadInput, match=r"p\.x\[3\]"):
        folded(locate)(shape.columns, [0.0, 1.0, 2.0, math.nan], 0.0)
    assert edge_against(Vec2(0.0, 0.0), Vec2(3.0, 4.0), Vec2(3.0, 4.0), 5.0) == 0


# -- regions ----------------------------------------------------------------------------------
def test_holes_and_layers():
    ring = region(SQUARE, holes=[[(4, 4), (6, 4), (6, 6), (4, 6)]], floor_m=50, ceiling_m=120)
    places = {
        (2, 2, 80): 1, (5, 5, 80): -1, (4, 5, 80): 0, (0, 5, 80): 0, (2, 2, 50): 0, (2, 2, 120): 0,
        (2, 2, 49.999): -1, (2, 2, 120.001): -1, (5, 5, 50): -1, (4, 5, 130): -1, (11, 5, 80): -1,
    }  # fmt: skip
    assert geofence.places(list(places), ring).tolist() == list(places.values())
    for point, wanted in places.items():
        (only,) = geofence.leg_places(point, point, ring)
        assert only.place == wanted
    # a hole may reach beyond the outline: what is beyond is outside all the same
    cut = region(SQUARE, holes=[[(8, 4), (14, 4), (14, 6), (8, 6)]])
    assert geofence.places([(12, 5), (9, 5), (10, 5), (7, 5)], cut).tolist() == [-1, -1, -1, 1]


# -- legs -------------------------------------------------------------------------------------
def test_a_leg_through_a_comb_goes_in_and_out():
    comb = polygon(COMB)
    stretches = geofence.leg_places((-1, 4), (10, 4), comb)
    assert [s.place for s in stretches[::2]] == [Place.OUTSIDE, Place.INSIDE] * 3 + [Place.OUTSIDE]
    assert all(s.place is Place.BOUNDARY and s.begin == s.end for s in stretches[1::2])
    times = geofence.times_inside((-1, 4), (10, 4), comb, begin_s=0, end_s=11)
    assert times == ((1, 2), (4, 6), (8, 10))
    # along edges: the boundary is not inside
    along = geofence.leg_places((-1, 6), (10, 6), comb)
    assert [s.place for s in along] == [Place.OUTSIDE, Place.BOUNDARY] * 3 + [Place.OUTSIDE]
    assert geofence.times_inside((-1, 6), (10, 6), comb, boundary=False) == ()
    assert geofence.leg_stays_outside((2, 3), (2, 9), comb)
    assert not geofence.leg_stays_outside((2, 2), (2, 9), comb)


def test_entry_times_are_rational():
    triangle = polygon([(0, 0), (3, 1), (0, 3)])
    found = geofence.times_inside((-1, 0.5), (4, 1), triangle, end_s=7)
    assert found == ((Fraction(7, 5), Fraction(5)),)


def test_climbing_legs_are_judged_at_each_point():
    tower = region(SQUARE, floor_m=0, ceiling_m=100)
    assert geofence.leg_stays_outside((-10, 5, 0), (20, 5, 400), tower)
    assert not geofence.leg_stays_outside((-10, 5, 0), (20, 5, 300), tower)
    assert geofence.times_inside((-10, 5, 0), (20, 5, 240), tower, end_s=30) == (
        (Fraction(10), Fraction(25, 2)),
    )
    assert geofence.leg_stays_inside((1, 1, 1), (9, 9, 99), tower)
    assert not geofence.leg_stays_inside((1, 1, 1), (9, 9, 100), tower)


def test_unions_of_keep_ins_may_be_crossed():
    west, east = (
        polygon([(0, 0), (6, 0), (6, 9), (0, 9)]),
        polygon([(5, 0), (9, 0), (9, 9), (5, 9)]),
    )
    assert geofence.leg_stays_inside((1, 1), (8, 8), (west, east))
    beside = polygon([(6, 0), (9, 0), (9, 9), (6, 9)])
    # a shared edge belongs to neither open part
    assert not geofence.leg_stays_inside((1, 1), (8, 8), (west, beside))
    assert geofence.leg_stays_outside((10, 1), (10, 8), (west, east))


@pytest.mark.parametrize("seed", range(3))
def test_stretches_are_what_dense_points_see(seed):
    rng = random.Random(seed)
    for _ in range(15):
        corners = [tuple(c) for c in np.array(star(np.random.default_rng(rng.randrange(10**6)), 7, 6.0)).round()]  # fmt: skip
        if geofence.fault_of(corners) is not None:
            continue
        shape = polygon(corners)
        p, q = [(rng.randint(-7, 7), rng.randint(-7, 7)) for _ in range(2)]
        stretches = geofence.leg_places(p, q, shape)
        assert stretches[0].begin == 0
        assert stretches[-1].end == 1
        for one, other in itertools.pairwise(stretches):
            assert one.end == other.begin
            assert one.place != other.place
        for k in range(61):
            t = Fraction(k, 60)
            point = (p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]))
            places = {s.place for s in stretches if s.begin <= t <= s.end}
            assert exactly_placed(point, corners) in places


def test_a_leg_of_a_mission_is_judged_as_on_rationals() -> None:
    """In whole parts of a metre: touches, numbers that are no multiple of a unit, and very small ones."""
    rng, exact, seen = random.Random(1), Fraction, set()
    for _ in range(400):
        unit = rng.choice([1.0, 0.1, 1e-7, 333.3])
        points = [(rng.randrange(-3, 4) * unit, rng.randrange(-3, 4) * unit) for _ in range(6)]
        if rng.random() < 0.5:
            points[2:] = [(north * 7 * unit, east * 7 * unit) for north, east in SQUARE_ROUND]
        kind, low, high = (
            rng.choice(list(ZoneKind)),
            rng.choice([0.1, 0.2, 1e-300]),
            rng.choice([0.3, 9.0]),
        )
        zone = Zone(1, kind, tuple(points[2:]), 0.1, 0.1 * 3)
        p, q = Position(*points[0], low), Position(*points[1], high)
        corners: list[tuple[Any, Any]] = [(exact(n), exact(e)) for n, e in zone.vertices]
        floor, ceiling = exact(zone.floor_m), exact(zone.ceiling_m)
        on_rationals: Any = Zone(1, kind, tuple(corners), *cast(Any, (floor, ceiling)))
        ends: Any = [Position(*cast(Any, map(exact, end))) for end in (p, q)]
        right = leg_ok(*ends, on_rationals)
        assert exact_leg_ok(p, q, zone) == right
        seen.add((kind, right))
    assert len(seen) == 4
