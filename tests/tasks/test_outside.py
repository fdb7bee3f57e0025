"""The share of a line or an area outside of zones, against shapely; never more than there is."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import LineString, Polygon

from cratous.core.tasks.outside import area_outside, points_outside
from cratous.spec.mission import Zone, ZoneKind

AREA = ((1000.0, -1000.0), (1000.0, 900.0), (2900.0, 1100.0), (3000.0, -1000.0))
corner = st.integers(-500, 3500)
size = st.integers(30, 2500)


def zone(kind: ZoneKind, n: float, e: float, high: float, wide: float, number: int = 1) -> Zone:
    corners = ((n, e), (n, e + wide), (n + high, e + wide / 2), (n + high, e))
    return Zone(number, kind, corners, 0.0, 1000.0, 0.0)


@settings(max_examples=40, deadline=None)
@given(st.sampled_from(list(ZoneKind)), corner, corner, size, size)
def test_an_area_against_shapely(kind: ZoneKind, n: int, e: int, high: int, wide: int) -> None:
    one = zone(kind, float(n), float(e - 1500), float(high), float(wide))
    area, shape = Polygon(AREA), Polygon(one.vertices)
    left = area.difference(shape) if kind is ZoneKind.KEEP_OUT else area.intersection(shape)
    share = area_outside(AREA, 400.0, (one,))
    assert share <= left.area / area.area + 1e-9
    # what is lost to squares on the zone's outline and the area's own
    edge = area.intersection(shape.boundary).length + left.boundary.length
    assert share >= left.area / area.area - 3 * 10.0 * (edge + 100.0) / area.area


@settings(max_examples=40, deadline=None)
@given(st.sampled_from(list(ZoneKind)), corner, corner, size, size)
def test_a_line_against_shapely(kind: ZoneKind, n: int, e: int, high: int, wide: int) -> None:
    one = zone(kind, float(n), float(e - 1500), float(high), float(wide))
    line = LineString([(0, -300), (3000, 700)])
    step = 1.0
    points = [
        (p.x, p.y)
        for p in (line.interpolate(k * step) for k in range(math.floor(line.length / step)))
    ]
    shape = Polygon(one.vertices)
    left = line.difference(shape) if kind is ZoneKind.KEEP_OUT else line.intersection(shape)
    share = points_outside(points, 400.0, (one,))
    assert share == pytest.approx(left.length / line.length, abs=4 * step / line.length)


def test_altitudes_and_several_zones() -> None:
    out = replace(zone(ZoneKind.KEEP_OUT, 900.0, -1100.0, 2500.0, 9000.0), ceiling_m=300.0)
    assert area_outside(AREA, 400.0, (out,)) == 1.0
    assert area_outside(AREA, 300.0, (out,)) == 0.0
    assert points_outside([(1500.0, 0.0)], 400.0, (out,)) == 1.0
    assert points_outside([(1500.0, 0.0)], 300.0, (out,)) == 0.0
    inside = replace(zone(ZoneKind.KEEP_IN, -5000.0, -9000.0, 20000.0, 40000.0), ceiling_m=300.0)
    assert area_outside(AREA, 300.0, (inside,)) == 0.0
    assert area_outside(AREA, 200.0, (inside,)) == 1.0
    south = zone(ZoneKind.KEEP_OUT, 900.0, -1100.0, 600.0, 9000.0, 2)
    north = zone(ZoneKind.KEEP_OUT, 2500.0, -1100.0, 600.0, 9000.0, 3)
    both = area_outside(AREA, 400.0, (south, north))
    assert 0.4 < both < 0.55
    assert both < min(area_outside(AREA, 400.0, (south,)), area_outside(AREA, 400.0, (north,)))
