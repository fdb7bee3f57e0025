"""The way out of a zone that has appeared over a vehicle: short, flyable, and it keeps the others."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.services.planning.zone_exits import ARC_STEP_RAD, OUT_M, way_out
from cratous.spec.mission import Zone, ZoneKind
from cratous.spec.mission.plan import Pose

Corner = tuple[float, float]


def zone(vertices: Sequence[Corner], number: int = 7, kind: ZoneKind = ZoneKind.KEEP_OUT) -> Zone:
    return Zone(number, kind, tuple(vertices), 0.0, 1000.0)


def box(south: float, west: float, north: float, east: float, number: int = 7) -> Zone:
    return zone([(south, west), (south, east), (north, east), (north, west)], number)


SQUARE = box(-500.0, -500.0, 500.0, 500.0)


def test_none_is_needed_outside() -> None:
    assert way_out(Pose(900.0, 0.0, 300.0, 0.0), 100.0, (SQUARE,)) is None


def test_straight_on_where_the_edge_ahead_is_near() -> None:
    out = way_out(Pose(400.0, 0.0, 300.0, 0.0), 100.0, (SQUARE,))
    assert out is not None
    assert out.inside_m == pytest.approx(100.0 + OUT_M, abs=0.02)
    assert out.end[:2] == pytest.approx((522.5, 0.0), abs=0.01)
    assert first_bad_leg(out.points[-1:], (SQUARE,)) is None


def test_a_wall_before_the_nearest_edge_is_kept() -> None:
    wall = box(505.0, -300.0, 800.0, 300.0, 8)
    free = way_out(Pose(400.0, 0.0, 300.0, 0.0), 100.0, (SQUARE,))
    out = way_out(Pose(400.0, 0.0, 300.0, 0.0), 100.0, (SQUARE, wall))
    assert free is not None
    assert out is not None
    assert out.inside_m > free.inside_m
    assert first_bad_leg(out.points, (wall,)) is None
    assert first_bad_leg(out.points[-1:], (SQUARE, wall)) is None


def test_another_zone_beside_the_turn_is_kept() -> None:
    """East is the shortest way out, and a post stands in the turn there."""
    over, post = box(-500.0, -500.0, 500.0, 130.0), box(60.0, 20.0, 82.0, 40.0, 8)
    pose = Pose(0.0, 0.0, 300.0, 0.0)
    free, out = way_out(pose, 100.0, (over,)), way_out(pose, 100.0, (over, post))
    assert free is not None
    assert out is not None
    assert first_bad_leg(free.points, (post,)) is not None
    assert first_bad_leg(out.points, (post,)) is None


def test_another_zone_on_the_way_to_the_edge_is_kept() -> None:
    post = box(200.0, -20.0, 240.0, 20.0, 8)
    out = way_out(Pose(0.0, 0.0, 300.0, 0.0), 100.0, (SQUARE, post))
    assert out is not None
    assert first_bad_leg(out.points, (post,)) is None


def test_a_gap_beside_the_ways_across_the_edges_is_found() -> None:
    walls = (
        box(505.0, -700.0, 700.0, 200.0, 1), box(505.0, 300.0, 700.0, 700.0, 2),
        box(-700.0, -700.0, -500.5, 700.0, 3), box(-500.5, 500.5, 505.0, 700.0, 4),
        box(-500.5, -700.0, 505.0, -500.5, 5),
    )  # fmt: skip
    out = way_out(Pose(0.0, 0.0, 300.0, 0.0), 100.0, (SQUARE, *walls))
    assert out is not None
    assert first_bad_leg(out.points, walls) is None
    assert 200.0 < out.end.east_m < 300.0


def test_the_way_turns_until_straight_across_an_edge() -> None:
    """The nearest edge lies 7.5 degrees beside the even headings."""
    across, far = math.radians(22.5), 3000.0
    n, e = math.cos(across), math.sin(across)
    corners = [
        (a * n - b * e, a * e + b * n)
        for a, b in ((1000.0, far), (1000.0, -far), (-far, -far), (-far, far))
    ]
    out = way_out(Pose(0.0, 0.0, 300.0, 0.0), 100.0, (zone(corners),))
    assert out is not None
    wanted = 100.0 * across + 1000.0 - 100.0 * math.sin(across)
    assert out.inside_m == pytest.approx(wanted + OUT_M, abs=0.02)


def test_a_keep_in_is_entered_at_its_corner_where_that_is_nearest() -> None:
    corner = (300.0, 500.0)
    cage = zone([corner, (1300.0, 500.0), (1300.0, 1500.0), (300.0, 1500.0)], 9, ZoneKind.KEEP_IN)
    out = way_out(Pose(0.0, 0.0, 300.0, 0.0), 100.0, (cage,))
    assert out is not None
    # from the centre of the turn, 100 m east: its tangent to the corner
    ahead = math.sqrt(300.0**2 + 400.0**2 - 100.0**2)
    turn = math.atan2(400.0, 300.0) + math.atan2(100.0, ahead)
    assert out.inside_m == pytest.approx(100.0 * turn + ahead + OUT_M, abs=0.02)


def test_two_zones_over_a_vehicle_are_both_left() -> None:
    other = box(300.0, -900.0, 900.0, 900.0, 8)
    out = way_out(Pose(400.0, 0.0, 300.0, 0.0), 100.0, (SQUARE, other))
    assert out is not None
    assert first_bad_leg(out.points[-1:], (SQUARE, other)) is None
    # south over the other's edge the square still holds: the ways out lead over two edges
    assert out.inside_m > 500.0


def test_a_keep_in_beside_a_vehicle_is_entered() -> None:
    cage = zone(
        [(200.0, -500.0), (200.0, 500.0), (900.0, 500.0), (900.0, -500.0)], 9, ZoneKind.KEEP_IN
    )
    out = way_out(Pose(0.0, 0.0, 300.0, math.pi / 2), 100.0, (cage,))
    assert out is not None
    # a quarter turn to the left, and straight to the edge
    assert out.inside_m == pytest.approx(100 * math.pi / 2 + 100.0 + OUT_M, abs=0.02)
    assert first_bad_leg(out.points[-1:], (cage,)) is None


def test_nothing_is_found_where_others_shut_the_zone_in() -> None:
    walls = (
        box(500.5, -700.0, 700.0, 700.0, 1), box(-700.0, -700.0, -500.5, 700.0, 2),
        box(-500.5, 500.5, 500.5, 700.0, 3), box(-500.5, -700.0, 500.5, -500.5, 4),
    )  # fmt: skip
    assert way_out(Pose(0.0, 0.0, 300.0, 0.0), 100.0, (SQUARE, *walls)) is None


# against the best of many turns followed by straight ways, by code of its own ------------------


@st.composite
def convex(draw: st.DrawFn) -> list[Corner]:
    """Corners on an ellipse about somewhere near (0, 0), around it in order."""
    cuts = draw(st.lists(st.integers(1, 10), min_size=3, max_size=8))
    turns = [2 * math.pi * at / sum(cuts) for at in itertools.accumulate(cuts)]
    a, b = (draw(st.floats(150.0, 900.0)) for _ in range(2))
    n, e = (draw(st.floats(-0.5, 0.5)) for _ in range(2))
    return [(a * (math.cos(t) + n), b * (math.sin(t) + e)) for t in turns]


def sides(corners: Sequence[Corner], n: float, e: float) -> list[float]:
    """On which side of each edge a place is: all positive inside of corners that turn one way."""
    pairs = itertools.pairwise([*corners, corners[0]])
    return [(c - a) * (e - b) - (d - b) * (n - a) for (a, b), (c, d) in pairs]


def brute(corners: Sequence[Corner], heading: float, radius: float) -> float:
    """Shortest length from (0, 0) until outside, of turns by whole multiples of two degrees, then straight."""
    best = math.inf
    for side, k in itertools.product((1, -1), range(180)):
        turn = math.radians(2 * k)
        after = heading + side * turn
        n = side * radius * (math.sin(after) - math.sin(heading))
        e = side * radius * (math.cos(heading) - math.cos(after))
        if min(sides(corners, n, e)) <= 0:
            best = min(best, radius * turn)
            break
        ahead = sides(corners, n + math.cos(after), e + math.sin(after))
        leaves = [v / (v - w) for v, w in zip(sides(corners, n, e), ahead, strict=True) if w < v]
        best = min(best, radius * turn + min(leaves))
    return best


@settings(max_examples=60, deadline=None)
@given(convex(), st.floats(-math.pi, math.pi), st.floats(30.0, 250.0))
def test_it_is_as_short_as_the_best_of_many_ways_out(
    corners: list[Corner], heading: float, radius: float
) -> None:
    if min(sides(corners, 0.0, 0.0)) < 1.0:
        return
    over = zone(corners)
    out = way_out(Pose(0.0, 0.0, 300.0, heading), radius, (over,))
    assert out is not None
    # a turn that leads out is cut at the next of its legs
    assert out.inside_m <= brute(corners, heading, radius) + radius * ARC_STEP_RAD + OUT_M + 0.01
    assert first_bad_leg(out.points[-2:], ()) is None
    assert first_bad_leg(out.points[-1:], (over,)) is None
    legs = [math.dist(*leg) for leg in itertools.pairwise(out.points)]
    assert sum(legs) <= out.length_m + 1e-6


def test_a_shape_with_a_bay_is_left_through_it() -> None:
    """A U open to the north: from its bottom the way leads into the bay, not through the arms."""
    bay = zone([
        (-600.0, -600.0), (-600.0, 600.0), (600.0, 600.0), (600.0, 300.0), (0.0, 300.0),
        (0.0, -300.0), (600.0, -300.0), (600.0, -600.0),
    ])  # fmt: skip
    out = way_out(Pose(-100.0, 0.0, 300.0, 0.0), 100.0, (bay,))
    assert out is not None
    assert out.inside_m == pytest.approx(100.0 + OUT_M, abs=0.02)
