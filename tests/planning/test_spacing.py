"""Which points of a path go out as waypoints, against what shapely and plain arithmetic say of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Polygon

from cratous.services.planning.spacing import near, spaced
from cratous.spec.mission import Position, Zone, ZoneKind

LEAST_M, OFF_M = 100.0, 20.0
ROUNDING_M = 1e-6


def arc(radius_m: float, degrees: int, step: int = 5, alt_m: float = 300.0) -> list[Position]:
    """Points on a circle that begins to the north."""
    turns = [math.radians(k) for k in range(0, degrees + 1, step)]
    return [Position(radius_m * math.sin(t), radius_m * (1 - math.cos(t)), alt_m) for t in turns]


def zone(*corners: tuple[float, float]) -> Zone:
    return Zone(1, ZoneKind.KEEP_OUT, corners, 0.0, 1_000.0)


def away_m(p: Position, a: Position, b: Position) -> float:
    """From a leg, on the ground [m]."""
    return float(LineString([a[:2], b[:2]]).distance(LineString([p[:2], p[:2]])))


def bad(points: Sequence[Position], a: int, b: int, zones: Sequence[Zone]) -> bool:
    """Whether a leg may not stand for the points between."""
    p, q = points[a], points[b]
    low, high = sorted((p.alt_m, q.alt_m))
    off = any(
        away_m(point, p, q) > OFF_M - ROUNDING_M or not low <= point.alt_m <= high
        for point in points[a + 1 : b]
    )
    leg = LineString([p[:2], q[:2]])
    return off or any(leg.intersects(Polygon(z.vertices).buffer(ROUNDING_M)) for z in zones)


steps = st.tuples(st.floats(1, 90), st.floats(-0.6, 0.6), st.sampled_from([0.0, 0.0, 0.0, 4.0]))


@given(st.lists(steps, min_size=1, max_size=40), st.floats(-200, 400), st.floats(-200, 400))
def test_what_is_left_out_is_near_and_moves_the_path_by_little(
    legs: list[tuple[float, float, float]], north_m: float, east_m: float
) -> None:
    points, heading = [Position(0.0, 0.0, 300.0)], 0.0
    for length, turn, climb in legs:
        heading += turn
        n, e, alt = points[-1]
        points.append(
            Position(n + length * math.cos(heading), e + length * math.sin(heading), alt + climb)
        )
    corners = [(north_m + i, east_m + j) for i, j in ((0, 0), (0, 60), (60, 60), (60, 0))]
    zones = [zone(*corners)]
    kept = spaced(points, LEAST_M, OFF_M, zones)
    at = [points.index(p) for p in kept]
    assert at == sorted(set(at))
    assert (at[0], at[-1]) == (0, len(points) - 1)
    for a, b in itertools.pairwise(at):
        p, q = points[a], points[b]
        for point in points[a + 1 : b]:
            assert away_m(point, p, q) <= OFF_M + ROUNDING_M
            assert min(p.alt_m, q.alt_m) <= point.alt_m <= max(p.alt_m, q.alt_m)
        if b > a + 1:
            inside = Polygon(corners).buffer(-ROUNDING_M)
            assert not LineString([p[:2], q[:2]]).intersects(inside)
        # nearer than it has to be only where one point more could not be left out
        if b < len(points) - 1 and math.dist(p[:2], q[:2]) < LEAST_M - ROUNDING_M:
            assert bad(points, a, b + 1, zones)
    if len(at) > 2 and math.dist(points[at[-2]][:2], points[-1][:2]) < LEAST_M - ROUNDING_M:
        assert bad(points, at[-3], at[-1], zones)


def test_along_a_straight_line_points_are_as_far_apart_as_asked() -> None:
    points = [Position(30.0 * k, 0.0, 300.0) for k in range(12)]
    kept = spaced(points, LEAST_M, OFF_M, ())
    assert [p.north_m for p in kept] == [0.0, 120.0, 330.0], "240 is nearer than 100 to the end"
    assert spaced(points[:1], LEAST_M, OFF_M, ()) == tuple(points[:1])
    assert spaced(points[:2], LEAST_M, OFF_M, ()) == tuple(points[:2])
    assert spaced([points[0]] * 3, LEAST_M, OFF_M, ()) == (points[0], points[0])


def test_a_bend_is_not_cut_by_more_than_is_said() -> None:
    """Whatever least distance is asked for: lanes stay lanes."""
    bend = arc(150.0, 180)
    path = [Position(-2_000.0, 0.0, 300.0), *bend, Position(-2_000.0, 300.0, 300.0)]
    kept = spaced(path, 100_000.0, 30.0, ())
    assert 3 < len(kept) < len(path)
    for p in path:
        assert min(away_m(p, a, b) for a, b in itertools.pairwise(kept)) <= 30.0 + ROUNDING_M


def test_no_leg_that_comes_of_it_crosses_a_zone() -> None:
    """The zone lies in the bend, so near that a chord would cut its corner."""
    bend = arc(150.0, 90)
    middle = bend[len(bend) // 2]
    inward = (middle.north_m - 2.0, middle.east_m + 2.0)
    there = zone(inward, (inward[0] - 40.0, inward[1]), (inward[0], inward[1] + 40.0))
    free, held = (spaced(bend, 120.0, 30.0, zones) for zones in ((), (there,)))
    shape = Polygon(there.vertices)
    assert LineString([p[:2] for p in free]).intersects(shape)
    assert not LineString([p[:2] for p in held]).intersects(shape)
    assert len(held) < len(bend), "the zone keeps only what it has to"


def test_a_climb_keeps_the_points_at_which_it_begins_and_ends() -> None:
    points = [Position(20.0 * k, 0.0, 300.0 + (40.0 if k == 3 else 0.0)) for k in range(8)]
    assert points[3] in spaced(points, 1_000.0, OFF_M, ())
    climbing = [p._replace(alt_m=300.0 + k) for k, p in enumerate(points)]
    assert spaced(climbing, 1_000.0, OFF_M, ()) == (climbing[0], climbing[-1])


@pytest.mark.parametrize(("apart_m", "is_near"), [(99.0, True), (100.0, False), (101.0, False)])
def test_near_is_less_than_the_least_distance(apart_m: float, is_near: bool) -> None:
    p = Position(0.0, 0.0, 0.0)
    assert near(p, Position(0.6 * apart_m, 0.8 * apart_m, 500.0), LEAST_M) is is_near
