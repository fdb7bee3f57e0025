"""Routes in bulk: what is compiled is what CPython computes, and every leg obeys the kernels."""

import math

import numpy as np
import pytest

from cratous.core.geofence import mission_leg_arrays as leg_arrays
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.geofence.planar import edges_of, locate
from cratous.core.kernel import Vec2
from cratous.core.readings.machine.compiled import machine
from cratous.core.readings.tiered import swift
from cratous.core.routing import bulk as routing
from cratous.core.routing.bulk import FOUND
from cratous.core.routing.visibility import Roadmap, route, routes
from cratous.core.tasks import coverage_arrays
from cratous.core.tasks import footprints as sight
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Position, Zone, ZoneKind
from cratous.spec.mission.plan import Pose

WALL = Zone(
    1, ZoneKind.KEEP_OUT, ((900.0, -200.0), (900.0, 1000.0), (1100.0, 1000.0), (1100.0, -200.0)),
    0.0, 600.0,
)  # fmt: skip
ROOM = Zone(
    2, ZoneKind.KEEP_IN, ((-4e3, -4e3), (-4e3, 4e3), (4e3, 4e3), (4e3, -4e3)), -10.0, 5000.0
)  # fmt: skip
ZONES = (WALL, ROOM)


def poses(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    found = rng.uniform(-3000, 3000, (2, count, 4))
    found[:, :, 2] = rng.choice([400.0, 500.0], (2, count))
    found[:, :, 3] /= 1000
    return found[0], found[1]


def arguments(roadmap: Roadmap, starts: np.ndarray, ends: np.ndarray):
    count = len(starts)
    out = routing.Routed(
        np.zeros(count, np.int64), np.zeros(count), np.zeros(count, np.int64),
        np.zeros((count, routing.LINKS_MOST + 2, 4)),
    )  # fmt: skip
    rings, sizes = roadmap.ring_arrays
    seen = np.zeros((len(rings), rings.shape[1], rings.shape[1]), np.int8)
    table = leg_arrays.table(roadmap.zones)
    turning, points = routing.Turning(100.0, 0.2, 0.5), routing.Rings(rings, sizes, seen)
    return (starts, ends, turning, table, points), out


def searched(count: int, seed: int):
    """Routes that CPython found, and twice what it was given, to find them another way."""
    starts, ends = poses(count, seed)
    starts[:, 2] = 400.0
    roadmap = roadmaps(ZONES, 100.0)[0]
    given, found = arguments(roadmap, starts, ends)
    routing.route_many(*given, found)
    return found, *arguments(roadmap, starts, ends)


def test_compiled_routes_are_those_of_cpython_bit_by_bit():
    plain, given, fast = searched(60, 1)
    machine(routing.route_many)(*given, fast)
    for one, other in zip(plain, fast, strict=True):
        assert np.array_equal(one, other)
    assert set(plain[0]) > {FOUND}, "some ends lie in the wall"
    assert (plain[2][plain[0] == FOUND] > 1).any(), "some routes go around it"


def test_direct_routes_are_those_of_the_whole_search_and_no_others():
    whole, given, direct = searched(80, 3)
    routing.direct_many(*given[:4], direct)
    taken = direct.codes == FOUND
    assert set(direct.codes) == {FOUND, routing.NOT_DIRECT}
    assert np.array_equal(taken, (whole.codes == FOUND) & (whole.links == 1))
    for one, other in zip(direct, whole, strict=True):
        assert np.array_equal(one[taken], other[taken])


def test_routes_in_bulk_are_the_routes_one_by_one_and_obey_the_kernels():
    starts, ends = poses(150, 2)
    roadmap = roadmaps(ZONES, 100.0)[0]
    found = routes(starts, ends, 100.0, roadmap, 0.2)
    for k in range(len(starts)):
        one = route(Pose(*starts[k]), Pose(*ends[k]), 100.0, roadmap, 0.2)
        assert bool(one.points) == (found.codes[k] == FOUND)
        if one.points:
            assert one.length_m == found.metres[k]
            assert first_bad_leg(one.points, ZONES) is None
            climb_m = abs(one.points[-1].alt_m - one.points[0].alt_m)
            assert climb_m <= 0.2 * one.length_m + 1.0
        else:
            assert one.reason


def test_leg_arrays_say_what_the_kernels_say_leg_by_leg():
    rng = np.random.default_rng(5)
    broken = 0
    for _ in range(200):
        path = [Position(*p) for p in rng.uniform(-1500, 1500, (2, 3)).tolist()]
        path = [p._replace(alt_m=abs(p.alt_m)) for p in path]
        long = [*path] * 6
        short, bulk = first_bad_leg(path, ZONES), first_bad_leg(long, ZONES)
        assert (short is None) == (bulk is None)
        if short is not None and bulk is not None:
            assert short[1] == bulk[1]
            broken += 1
    assert 10 < broken < 200
    with pytest.raises(ValueError, match="padding"):
        leg_arrays.table((Zone(3, ZoneKind.KEEP_OUT, WALL.vertices, 0.0, 1.0, padding_m=2.0),))


@pytest.mark.parametrize("compiled", [False, True])
def test_points_in_footprints_are_those_of_the_kernel(compiled: bool):
    rng = np.random.default_rng(6)
    angles = np.sort(rng.uniform(0, 2 * math.pi, (12, 4)), axis=1)
    middles = rng.uniform(-200, 200, (12, 1, 2))
    quads = middles + 150 * np.stack([np.cos(angles), np.sin(angles)], axis=2)
    points = rng.uniform(-400, 400, (200, 2))
    points[:12] = quads[:, 0]
    found = np.zeros(len(points), np.bool_)
    run = machine(sight.points_in_quads) if compiled else sight.points_in_quads
    run(points, quads, found)
    for point, seen in zip(points, found, strict=True):
        assert seen == any(locate(edges_of(quad.tolist()), Vec2(*point)) >= 0 for quad in quads)


def test_the_nearest_point_of_a_line_is_found_although_most_are_passed_over():
    rng = np.random.default_rng(7)
    line = np.cumsum(rng.uniform(-5, 7, (400, 2)), axis=0)
    apart = float(np.hypot(*np.diff(line, axis=0).T).max())
    wanted = rng.uniform(-300, 900, (80, 2))
    found = np.zeros(len(wanted), np.int64)
    sight.nearest_on_line(wanted, line, apart, found)
    gaps = np.hypot(*(wanted[:, None] - line[None]).transpose(2, 0, 1))
    assert np.allclose(gaps[np.arange(80), found], gaps.min(axis=1))


def test_compiled_squares_are_those_of_cpython():
    corners = np.array([(0.0, 0.0), (30.0, 400.0), (390.0, 280.0), (200.0, 150.0), (310.0, 20.0)])
    edges = np.hstack([corners, np.roll(corners, -1, axis=0)])
    plain, fast = np.zeros((2, 40 * 40, 2))
    given = (edges, 0.0, 0.0, 39, 40, 10.0)
    count = coverage_arrays.grid_squares(*given, plain)
    assert machine(coverage_arrays.grid_squares)(*given, fast) == count > 500
    assert np.array_equal(plain, fast)
    quads = np.array([[(50.0, 50.0), (300.0, 80.0), (280.0, 260.0), (60.0, 240.0)]])
    seen, compiled = np.zeros((2, count), np.bool_)
    coverage_arrays.mark_seen(plain[:count], 5.0, quads, seen)
    machine(coverage_arrays.mark_seen)(plain[:count].copy(), 5.0, quads, compiled)
    assert np.array_equal(seen, compiled)
    assert seen.any()


def test_much_work_is_compiled_and_little_is_not():
    assert swift(leg_arrays.leg_zone, 0) is leg_arrays.leg_zone
    assert swift(leg_arrays.leg_zone, 100_000) is not leg_arrays.leg_zone
