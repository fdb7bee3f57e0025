"""Dubins paths, legs against zones, routes around zones, and the mission frame."""

import math

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from cratous.core.geofence.mission_legs import first_bad_leg, leg_ok
from cratous.core.geofence.planar import (
    edges_of,
    keep_in_leg_ok,
    keep_out_leg_ok,
    locate,
    meets_boundary,
)
from cratous.core.kernel import Vec2
from cratous.core.routing.dubins import (
    cut,
    cut_length_m,
    dubins,
    dubins_paths,
    polyline_length_m,
    pose_after,
    turn_radius_m,
)
from cratous.core.routing.dubins_words import NOTHING_M
from cratous.core.routing.visibility import Roadmap, circle, route
from cratous.services.mission.frames import RESOLUTION_M, Projection, scale_error
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Frame, Position, Zone, ZoneKind
from cratous.spec.mission.plan import Pose

COORDINATE = st.floats(-2000, 2000)
POSES = st.builds(Pose, COORDINATE, COORDINATE, st.just(500.0), st.floats(-7, 7))


def box(number, kind, south, west, north, east, floor=0.0, ceiling=5000.0):
    corners = ((south, west), (south, east), (north, east), (north, west))
    return Zone(number, kind, corners, floor, ceiling)


@given(POSES, POSES, st.floats(20, 300))
def test_every_dubins_word_ends_in_the_wanted_pose(start, end, radius):
    paths = dubins_paths(start, end, radius)
    assert paths == sorted(paths, key=lambda path: path.length_m)
    for path in paths:
        pose = start
        for kind, length in zip(path.kinds, path.lengths_m, strict=True):
            pose = pose_after(pose, kind, length, radius)
        assert math.dist(pose[:2], end[:2]) < 1e-3
        assert abs(math.remainder(pose.heading_rad - end.heading_rad, 2 * math.pi)) < 1e-6


@given(POSES, POSES, st.floats(20, 300), st.floats(0.1, 3))
def test_a_cut_path_leaves_the_arcs_by_no_more_than_allowed(start, end, radius, error):
    path = dubins(start, end, radius)
    points = cut(path, end, error)
    assert points[0] == Position(*start[:3])
    assert points[-1] == Position(*end[:3])
    length = polyline_length_m(points)
    assert length <= path.length_m + 1e-3
    assert length == pytest.approx(cut_length_m(path, error), abs=1e-3)
    assert path.length_m - length < 0.2 * path.length_m * error / radius + 1e-3 + 2 * error


def test_a_straight_way_is_straight_and_a_way_back_is_a_loop():
    here = Pose(0.0, 0.0, 100.0, 0.0)
    assert dubins(here, Pose(1000.0, 0.0, 100.0, 0.0), 100.0).length_m == pytest.approx(1000.0)
    half_turn = dubins(here, Pose(0.0, 200.0, 100.0, math.pi), 100.0)
    assert half_turn.length_m == pytest.approx(math.pi * 100.0)
    # from a pose to the same place with opposite heading: three arcs, 7 pi / 3 radii
    back = dubins(here, Pose(0.0, 0.0, 100.0, math.pi), 100.0)
    assert back.length_m == pytest.approx(7 * math.pi / 3 * 100.0)


@given(POSES, POSES, POSES, st.floats(20, 300))
def test_a_detour_is_never_shorter(start, via, end, radius):
    direct = dubins(start, end, radius).length_m
    around = dubins(start, via, radius).length_m + dubins(via, end, radius).length_m
    assert direct <= around + 1e-6


def test_turn_radius_of_a_level_turn():
    assert turn_radius_m(22.0, math.radians(20)) == pytest.approx(135.6, abs=0.1)


def test_legs_are_judged_with_boundary_altitude_and_padding():
    out = box(1, ZoneKind.KEEP_OUT, 0.0, 0.0, 100.0, 100.0, 0.0, 200.0)
    low, high = 150.0, 250.0
    touching = Position(100.0, -50.0, low), Position(100.0, 150.0, low)
    assert not leg_ok(*touching, out)
    assert leg_ok(*(p._replace(alt_m=high) for p in touching), out)
    assert leg_ok(Position(101.0, -50.0, low), Position(101.0, 150.0, low), out)
    keep_in = box(2, ZoneKind.KEEP_IN, 0.0, 0.0, 100.0, 100.0, 0.0, 200.0)
    assert leg_ok(Position(1.0, 1.0, low), Position(99.0, 99.0, low), keep_in)
    assert not leg_ok(Position(0.0, 1.0, low), Position(99.0, 99.0, low), keep_in)
    padded = Zone(3, ZoneKind.KEEP_OUT, out.vertices, 0.0, 200.0, padding_m=5.0)
    with pytest.raises(ValueError, match="padding"):
        leg_ok(*touching, padded)
    path = (Position(-50.0, -50.0, low), Position(-50.0, 50.0, low), Position(50.0, 50.0, low))
    assert first_bad_leg(path, (out,)) == (1, out)
    assert first_bad_leg((Position(50.0, 50.0, low),), (out,)) == (0, out)


HERE = Pose(0.0, 0.0, 500.0, 0.0)


@given(POSES, POSES, st.floats(-1500, 500), st.floats(-1500, 500), st.floats(200, 1200))
@example(HERE, HERE._replace(heading_rad=3.8e-10), 500.0, 500.0, 200.0)
@settings(max_examples=60, deadline=None)
def test_a_route_obeys_the_kernels_or_does_not_exist(start, end, south, west, side):
    zone = box(1, ZoneKind.KEEP_OUT, south, west, south + side, west + side)
    found = None
    for roadmap in roadmaps((zone,), 100.0):
        found = route(start, end, 100.0, roadmap)
        if found.points:
            break
    if not found.points:
        # a start or end in the zone, or so near to it that no turn fits; else there is a way
        assert found.reason
        assume(first_bad_leg(circle(start, 200.0, True), (zone,)) is None)
        assume(first_bad_leg(circle(start, 200.0, False), (zone,)) is None)
        assume(first_bad_leg(circle(end, 200.0, True), (zone,)) is None)
        assume(first_bad_leg(circle(end, 200.0, False), (zone,)) is None)
        for pose in (start, end):
            assume(first_bad_leg((Position(*pose[:3]),), (zone,)) is None)
        pytest.fail(f"no route although both ends are free: {found.reason}")
    assert first_bad_leg(found.points, (zone,)) is None
    assert found.points[0] == Position(*start[:3])
    assert found.points[-1] == Position(*end[:3])
    # a piece of a word that is shorter than NOTHING_M counts, but is no leg: a word has three
    assert found.length_m == pytest.approx(polyline_length_m(found.points), abs=3 * NOTHING_M)


def test_a_wall_is_flown_around_by_the_nearer_side():
    wall = box(1, ZoneKind.KEEP_OUT, 900.0, -200.0, 1100.0, 3000.0)
    start, end = Pose(0.0, 0.0, 500.0, 0.0), Pose(2000.0, 0.0, 500.0, 0.0)
    found = route(start, end, 100.0, roadmaps((wall,), 100.0)[0])
    assert 2000.0 < found.length_m < 2200.0
    assert min(p.east_m for p in found.points) < -200.0


def test_no_way_is_said_with_the_zone():
    wall = box(7, ZoneKind.KEEP_OUT, 900.0, -3000.0, 1100.0, 3000.0)
    room = box(8, ZoneKind.KEEP_IN, -500.0, -2000.0, 3000.0, 2000.0)
    start, end = Pose(0.0, 0.0, 500.0, 0.0), Pose(2000.0, 0.0, 500.0, 0.0)
    found = route(start, end, 100.0, roadmaps((wall, room), 100.0)[0])
    assert found.points == ()
    assert "keep-out zone 7" in found.reason


def test_a_climb_takes_the_length_that_it_needs():
    start, end = Pose(0.0, 0.0, 100.0, 0.0), Pose(500.0, 0.0, 400.0, 0.0)
    found = route(start, end, 100.0, Roadmap(()), max_slope=0.2)
    assert found.length_m >= 300.0 / 0.2 - 5
    for p, q in zip(found.points, found.points[1:], strict=False):
        run = math.dist(p[:2], q[:2])
        assert q.alt_m - p.alt_m <= 0.2 * run * 1.01 + 1e-9


@given(
    st.floats(-80, 80), st.floats(-180, 180), st.floats(-30_000, 30_000), st.floats(-30_000, 30_000)
)
@settings(max_examples=50, deadline=None)
def test_the_frame_goes_there_and_back(lat, lon, north, east):
    projection = Projection(Frame(lat, lon))
    there = projection.to_geodetic(north, east)
    back = projection.to_local(*there)
    assert math.dist(back, (north, east)) < RESOLUTION_M
    distance = math.hypot(north, east)
    exact = projection.geodesic_m((lat, lon), there)
    assert exact == pytest.approx(distance, abs=RESOLUTION_M)


@given(st.floats(-70, 70), COORDINATE, COORDINATE, COORDINATE, COORDINATE)
@settings(max_examples=50, deadline=None)
def test_the_error_of_the_frame_is_within_its_bound(lat, n1, e1, n2, e2):
    scale = 20.0
    one, two = (n1 * scale, e1 * scale), (n2 * scale, e2 * scale)
    assume(math.dist(one, two) > 100)
    projection = Projection(Frame(lat, 10.0))
    exact = projection.geodesic_m(projection.to_geodetic(*one), projection.to_geodetic(*two))
    bound = scale_error(max(math.hypot(*one), math.hypot(*two)))
    assert abs(math.dist(one, two) - exact) <= bound * exact + 1e-3


def test_many_points_at_once_are_the_same():
    projection = Projection(Frame(45.0, -120.0))
    lats, lons = projection.to_geodetic_many([0.0, 500.0], [100.0, -100.0])
    assert (lats[1], lons[1]) == projection.to_geodetic(500.0, -100.0)
    norths, easts = projection.to_local_many(lats, lons)
    assert norths[1] == pytest.approx(500.0, abs=1e-6)
    assert easts[0] == pytest.approx(100.0, abs=1e-6)


SMALL = st.integers(-6, 6).map(float)


@given(
    st.lists(st.tuples(SMALL, SMALL), min_size=3, max_size=7, unique=True),
    st.tuples(SMALL, SMALL),
    st.tuples(SMALL, SMALL),
    st.sampled_from(ZoneKind),
)
@settings(max_examples=400)
def test_leaving_edges_out_changes_no_verdict(vertices, p, q, kind):
    zone = Zone(1, kind, tuple(vertices), 0.0, 100.0)
    edges, a, b = edges_of(vertices), Vec2(*p), Vec2(*q)
    holds = keep_out_leg_ok if kind is ZoneKind.KEEP_OUT else keep_in_leg_ok
    wanted = holds(locate(edges, a), meets_boundary(edges, a, b), 50.0, 50.0, 0.0, 100.0)
    assert leg_ok(Position(*p, 50.0), Position(*q, 50.0), zone) == wanted
