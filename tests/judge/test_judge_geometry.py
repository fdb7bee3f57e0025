"""The judge's own geometry: held against definitions, exact cases and shapely."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import assume, example, given
from hypothesis import strategies as st

from cratous.judge.coverage import area_m2, area_seen, footprints, line_seen, point_seen
from cratous.judge.earth import to_local
from cratous.judge.log import State
from cratous.judge.mission import Volume, Zone
from cratous.judge.plane import fault_of_ring, meet, squared_gap, turn, winding
from cratous.judge.separation import clear_by_course, clear_by_far, lost_on_leg, lost_within
from cratous.judge.zones import Fence

SMALL = st.integers(-6, 6).map(float)
POINT = st.tuples(SMALL, SMALL)
ROUGH = st.floats(-1000, 1000, allow_subnormal=False)
RING = st.lists(POINT, min_size=3, max_size=7, unique=True).filter(lambda r: not fault_of_ring(r))
SQUARE = [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0), (10.0, 0.0)]


@given(POINT, POINT, POINT)
def test_the_sign_of_a_turn_is_exact(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = (tuple(map(Fraction, p)) for p in (a, b, c))
    det = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    assert turn(a, b, c) == (det > 0) - (det < 0)


def test_a_turn_that_doubles_get_wrong():
    # the third point is off the line by the last bit of a double
    a, b = (0.5, 0.5), (12.0, 12.0)
    for off in (-1, 0, 1):
        c = (24.0, math.nextafter(24.0, off * math.inf) if off else 24.0)
        assert turn(a, b, c) == off


@given(RING, POINT)
def test_winding_agrees_with_shapely(ring, p):
    found, polygon, point = winding(ring, p), shapely.Polygon(ring), shapely.Point(p)
    if found is None:
        assert polygon.exterior.distance(point) == pytest.approx(0, abs=1e-9)
    else:
        assert (found != 0) == polygon.contains(point)
        assert found in (-1, 0, 1)


@given(POINT, POINT, POINT, POINT)
def test_segments_meet_as_shapely_says(p, q, a, b):
    one, two = (
        shapely.LineString([x, y]) if x != y else shapely.Point(x) for x, y in ((p, q), (a, b))
    )
    assert meet(p, q, a, b) == one.intersects(two)
    assert math.sqrt(squared_gap(p, q, a, b)) == pytest.approx(one.distance(two), abs=1e-9)


@given(st.lists(POINT, min_size=3, max_size=6))
def test_simple_polygons_are_those_of_shapely(ring):
    polygon = shapely.Polygon(ring)
    # shapely takes corners that stand twice in a row
    twice = len(set(ring)) < len(ring)
    assert (fault_of_ring(ring) == "") == (not twice and polygon.is_valid and polygon.area > 0)


def state(t, n, e, a):
    return State(t, float(n), float(e), float(a), 0.0, 0.0, 0.0)


@given(RING, POINT, POINT, st.booleans(), st.sampled_from([0.0, 1.0, 2.5]))
def test_legs_and_zones_agree_with_shapely(ring, p, q, keep_in, padding):
    zone = Zone(1, keep_in, tuple(ring), 0.0, 100.0, padding)
    leg = shapely.LineString([p, q]) if p != q else shapely.Point(p)
    polygon = shapely.Polygon(ring)
    gap = polygon.exterior.distance(leg)
    assume(abs(gap - padding) > 1e-9 or padding == 0)
    broken = Fence(zone).breaks(state(0, *p, 50), state(1000, *q, 50))
    if keep_in:
        assert broken == (not polygon.contains(leg) or gap <= padding)
    else:
        assert broken == (polygon.intersects(leg) or polygon.distance(leg) <= padding)


@given(st.lists(POINT, min_size=2, max_size=9), RING)
def test_what_a_fence_remembers_changes_nothing(way, ring):
    zone = Zone(1, True, tuple(ring), 0.0, 100.0)
    fence = Fence(zone)
    states = [state(k, *p, 50) for k, p in enumerate(way)]
    for before, after in pairwise(states):
        assert fence.breaks(before, after) == Fence(zone).breaks(before, after)


@pytest.mark.parametrize(
    ("p", "q", "breaks"),
    [
        ((-5, 5, 50), (15, 5, 50), True),  # through
        ((-5, 5, 101), (15, 5, 101), False),  # above
        ((-5, 5, 100), (15, 5, 100), True),  # at the ceiling, which belongs to it
        ((-5, 10, 50), (15, 10, 50), True),  # along an edge, which belongs to it
        ((-5, 5, 200), (25, 5, -100), True),  # down through it: at 5, 5 it is at 100
        ((-5, 5, 90), (25, 5, 390), False),  # above it when it comes to it
        ((10, 10, 100), (20, 20, 200), True),  # touches a corner at the ceiling
        ((9, 10, 101), (10, 9, 101), False),
    ],
)
def test_a_leg_breaks_a_keep_out_where_it_is_at_its_altitudes(p, q, breaks):
    fence = Fence(Zone(1, False, tuple(SQUARE), 0.0, 100.0))
    assert fence.breaks(state(0, *p), state(1000, *q)) == breaks


# ---- well clear ---------------------------------------------------------------------------------

VOLUME = Volume(4.0, 2.0, 3.0, 1.0)
EARLY = Volume(4.0, 2.0, 3.0, 5.0)
SPEED = st.integers(-3, 3)


def lost_at(s, v, t, volume):
    """The definition at one instant."""
    dthr, zthr, tthr, tcoa = map(Fraction, volume)
    n, e, z = (a + t * b for a, b in zip(s, v, strict=True))
    vertical = abs(z) <= zthr or (v[2] != 0 and 0 <= -z / v[2] <= tcoa)
    dot, vv = n * v[0] + e * v[1], v[0] ** 2 + v[1] ** 2
    if n * n + e * e <= dthr**2:
        return vertical
    if dot >= 0:
        return False
    closest = -dot / vv
    within = (n + closest * v[0]) ** 2 + (e + closest * v[1]) ** 2 <= dthr**2
    return vertical and within and 0 <= (dthr**2 - n * n - e * e) / dot <= tthr


@example((30, 0, 0), (-3, 0, 0), 9, VOLUME)
@example((30, 4, 0), (-3, 0, 0), 9, VOLUME)  # headed for a miss of just DTHR
@example((0, 0, 9), (0, 0, -1), 7, VOLUME)  # reaches ZTHR at the end
@example((0, 0, 9), (0, 0, -1), 4, EARLY)  # reaches TCOA at the end
@given(
    st.tuples(*[st.integers(-30, 30)] * 2, st.integers(-9, 9)),
    st.tuples(SPEED, SPEED, SPEED),
    st.integers(1, 9),
    st.sampled_from([VOLUME, EARLY]),
)
def test_lost_on_a_leg_is_lost_at_some_instant(s, v, span, volume):
    s, v = [Fraction(x) for x in s], [Fraction(x) for x in v]
    found = lost_within(s, v, Fraction(span), volume)
    instants = [lost_at(s, v, Fraction(k, 64), volume) for k in range(64 * span + 1)]
    if any(instants):
        assert found
    elif found:
        # less than a 64th of a second: then it is nearly lost somewhere
        wider = Volume(*(x + 0.2 for x in volume))
        assert any(lost_at(s, v, Fraction(k, 64), wider) for k in range(64 * span + 1))


@given(st.data())
def test_what_is_clear_by_far_is_clear(data):
    draw = [data.draw(ROUGH) for _ in range(12)]
    step = data.draw(st.integers(1, 5000))
    a0, b0 = state(0, *draw[:3]), state(0, *draw[3:6])
    a1, b1 = state(step, *draw[6:9]), state(step, *draw[9:])
    volume = Volume(data.draw(st.floats(0, 300)), data.draw(st.floats(0, 60)), 15.0, 5.0)
    if clear_by_far(a0, a1, b0, b1, volume):
        assert not lost_on_leg(a0, a1, b0, b1, volume)


NEAR = st.integers(-2000, 2000).map(float)


@given(
    *[st.tuples(NEAR, NEAR, st.integers(-40, 40).map(float))] * 2,
    st.tuples(*[st.integers(-60, 60)] * 2, st.integers(-3, 3)),
    st.sampled_from([250, 1000, 5000]),
)
def test_what_is_clear_by_its_course_is_clear(place, other, velocity, step):
    after = [x + v * step / 1000 for x, v in zip(place, velocity, strict=True)]
    legs = state(0, *place), state(step, *after), state(0, *other), state(step, *other)
    volume = Volume(150.0, 30.0, 15.0, 0.0)
    if clear_by_course(*legs, volume):
        assert not lost_on_leg(*legs, volume)


@pytest.mark.parametrize(
    ("north", "east", "speed"),
    [(-600, 150, 40), (-150, 0, -40), (-315, 0, 15), (-1e-160, 0, 1e-160)],
)
def test_what_is_at_the_edge_of_a_loss_is_left_to_rationals(north, east, speed):
    """A course that just touches DTHR, a start at DTHR, a leg whose loss begins with its end, and no course at all."""
    legs = [
        state(0, north, east, 0),
        state(1000, north + speed, east, 0),
        *[state(t, 0, 0, 0) for t in (0, 1000)],
    ]
    assert not clear_by_course(*legs, Volume(150.0, 30.0, 15.0, 0.0))
    for apart in (1 + 1e-6, 1 + 1e-12):
        volume = Volume(150.0 / apart, 30.0, 15.0 / apart, 0.0)
        assert not clear_by_course(*legs, volume) or not lost_on_leg(*legs, volume)


def test_well_clear_agrees_with_the_proved_kernel():
    from typing import Any

    from cratous.core.kernel import Vec2
    from cratous.core.well_clear import StandardThresholds, violation_within

    random, lost = np.random.default_rng(1), 0
    for k in range(800):
        volume = (VOLUME, EARLY)[k % 2]
        s = [Fraction(int(x)) for x in random.integers((-14, -14, -6), (15, 15, 7))]
        v = [Fraction(int(x)) for x in random.integers(-3, 4, 3)]
        sizes: Any = StandardThresholds(*map(Fraction, volume))
        place: Any = (Vec2(*s[:2]), Vec2(*v[:2]), s[2], v[2])
        theirs = violation_within(*place, sizes, Fraction(5))
        assert lost_within(s, v, Fraction(5), volume) == bool(theirs)
        lost += bool(theirs)
    assert 50 < lost < 750


# ---- footprints ---------------------------------------------------------------------------------

BOX = st.tuples(ROUGH, ROUGH, st.floats(20, 900), st.floats(20, 900), st.floats(0, 3)).map(
    lambda b: [
        (
            b[0] + x * math.cos(b[4]) - y * math.sin(b[4]),
            b[1] + x * math.sin(b[4]) + y * math.cos(b[4]),
        )
        for x, y in ((0, 0), (b[2], 0), (b[2], b[3]), (0, b[3]))
    ]
)


@given(st.lists(BOX, max_size=5), st.lists(st.tuples(ROUGH, ROUGH), min_size=2, max_size=5))
def test_the_seen_part_of_a_line_is_that_of_shapely(boxes, line):
    sure, may, whole = line_seen(footprints(boxes), line)
    seen = shapely.union_all([shapely.Polygon(b) for b in boxes])
    parts = [shapely.LineString(line[k : k + 2]) for k in range(len(line) - 1)]
    truth = sum(part.intersection(seen).length for part in parts if part.length)
    assert sure <= truth + 1e-6
    assert may >= truth - 1e-6
    assert whole == pytest.approx(sum(part.length for part in parts))


@given(st.lists(BOX, max_size=4), RING)
def test_the_seen_part_of_an_area_is_enclosed(boxes, ring):
    ring = [(40 * n, 40 * e) for n, e in ring]
    found = area_seen(footprints(boxes), ring)
    truth = shapely.Polygon(ring).intersection(
        shapely.union_all([shapely.Polygon(b) for b in boxes])
    )
    assert found.seen <= truth.area + 1e-3
    assert found.unseen <= area_m2(ring) - truth.area + 1e-3
    assert found.seen + found.unseen + found.open == pytest.approx(area_m2(ring), rel=1e-9)
    # what stays open is along the edges of footprints
    edges = sum(shapely.Polygon(b).length for b in boxes)
    assert found.open <= 4 * found.finest_m * (edges + 4)


@given(BOX, st.tuples(ROUGH, ROUGH))
def test_a_point_in_a_footprint(box, point):
    sure, may = point_seen(footprints([box]), point)
    polygon, place = shapely.Polygon(box), shapely.Point(point)
    if polygon.exterior.distance(place) > 2e-3:
        assert bool(sure[0]) == bool(may[0]) == polygon.contains(place)


def test_a_footprint_that_is_not_convex_is_no_proof_of_anything():
    crossed = [(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]
    dented = [(0.0, 0.0), (10.0, 0.0), (2.0, 2.0), (0.0, 10.0)]
    star = [(math.cos(0.8 * math.pi * k), math.sin(0.8 * math.pi * k)) for k in range(5)]
    for shape in (crossed, dented, star, [(0.0, 0.0), (5.0, 5.0), (9.0, 9.0)]):
        prints = footprints([shape])
        assert not prints.sure[0]
        sure, may = point_seen(prints, (shape[0][0], shape[0][1]))
        assert (bool(sure[0]), bool(may[0])) == (False, True)


@given(st.floats(-75, 75), st.floats(-180, 180), st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_places_are_those_of_proj(lat, lon, up, along):
    import pyproj

    projection = pyproj.Proj(proj="aeqd", ellps="WGS84", lat_0=lat, lon_0=lon)
    east, north = projection(lon + along, lat + up)
    found = to_local(lat, lon, lat + up, lon + along)
    assert found is not None
    assert found == pytest.approx((north, east), abs=1e-3)
