"""Kernels of detect and avoid against their definitions at sampled instants."""

from __future__ import annotations

import math

import numpy as np
import pytest
from daa_scenes import head_on

from cratous.core.daa.climb import climb, height
from cratous.core.daa.engine import look
from cratous.core.daa.frame import project
from cratous.core.daa.grid import grid
from cratous.core.daa.state import HDIR
from cratous.core.daa.steps import piece_counts, straight_from, until, way_conflicts
from cratous.core.daa.turn import turn_offset, turned
from cratous.core.daa.uncertainty import Uncertainty, uncertain_span
from cratous.core.daa.volume import in_conflict
from cratous.core.daa.zones import contours, hazard_zone
from cratous.core.kernel import Vec2
from cratous.core.well_clear.interval import violation_interval_taumod
from cratous.core.well_clear.thresholds import Thresholds
from cratous.spec.daa import meaning as daa_meaning
from cratous.spec.daa.parameters import CYLINDER, TAUMOD, TCPA, TEP, Parameters, Volume
from cratous.spec.daa.presets import preset


@pytest.fixture(scope="module")
def p() -> Parameters:
    return preset("do_365b").parameters


def test_steps_against_sampled_instants():
    rng = np.random.default_rng(5)
    found = 0
    for _ in range(300):
        s, v = Vec2(*rng.normal(size=2) * 3000), Vec2(*rng.normal(size=2) * 100)
        sz, vz = rng.normal() * 200, rng.normal() * 5
        volume = Thresholds(1222.0, 137.0, 35.0, 0.0, 0.0)
        kind = int(rng.integers(0, 4))
        at, begin, end = rng.uniform(0, 20), rng.uniform(0, 20), rng.uniform(20, 60)
        red = in_conflict(kind, s, v, sz, vz, volume, straight_from(at, begin), end - at)
        lost = any(
            daa_meaning.lost_from_step(
                daa_meaning.violated_at(kind, s, v, sz, vz, volume, t), t, at, begin, end
            )
            for t in np.linspace(0, 60, 121)
        )
        found += lost
        assert red or not lost
        blocked = piece_counts(at, begin, end) and in_conflict(kind, s, v, sz, vz, volume, 0, 2.0)
        on_piece = any(
            daa_meaning.lost_on_piece(
                daa_meaning.violated_at(kind, s, v, sz, vz, volume, t), t, 2.0, at, begin, end
            )
            for t in np.linspace(0, 2, 9)
        )
        assert blocked or not on_piece
    assert found > 20
    assert way_conflicts([(False,), (True,), (False,)])
    assert not way_conflicts([(False,)] * 4)
    assert until(180, 55, 30, False) == 85
    assert until(180, 55, 30, True) == 55


def test_turn_steps_are_the_trajectory(p: Parameters):
    own, _ = head_on()
    g = grid(p, own, HDIR)
    c, s = math.cos(g.step), math.sin(g.step)
    v = Vec2(g.right[0, 3], g.right[0, 4])
    for k in range(1, len(g.right)):
        w = turned(v, c, s)
        offset = turn_offset(v, w)
        there = g.right[k - 1, :2] + np.array(offset) / p.turn_rate_rad_s
        assert g.right[k, :2] == pytest.approx(there, abs=1e-6)
        assert g.right[k, 3:5] == pytest.approx(tuple(w), abs=1e-9)
        v = w


@pytest.mark.parametrize("vz", [0.0, 4.0, -4.0])
@pytest.mark.parametrize("target", [1000.0, 1001.0, 1005.0, 1500.0, 300.0])
def test_a_climb_is_flown(vz: float, target: float):
    phases = climb(1000.0, vz, target, 2.5, 2.0)
    assert 0 <= phases.t1_s <= phases.t2_s <= phases.t3_s
    z, dt = 1000.0, 0.001
    for k in range(int(phases.t3_s / dt)):
        z += height(1000.0, vz, target, 2.0, phases, (k + 0.5) * dt).vz_m_s * dt
    assert z == pytest.approx(target, abs=0.05)


def test_uncertainty_covers_sampled_true_states():
    rng = np.random.default_rng(9)
    lost = missed = 0
    limits = Thresholds(1222.0, 137.0, 35.0, 0.0, 0.0)
    for _ in range(300):
        s, v = Vec2(*rng.normal(size=2) * 3000), Vec2(*rng.normal(size=2) * 80)
        sz, vz, es, ez, ev, ew = *(rng.normal(size=2) * (150, 5)), 80.0, 40.0, 5.0, 2.0
        span = uncertain_span(s, v, sz, vz, Uncertainty(es, ez, ev, ew), limits, 0.0, 60.0)
        for _ in range(10):
            d, e = rng.normal(size=2), rng.normal(size=2)
            d, e = d / np.hypot(*d) * es * rng.random(), e / np.hypot(*e) * ev * rng.random()
            dz, dw = rng.uniform(-ez, ez), rng.uniform(-ew, ew)
            true = (Vec2(s.x + d[0], s.y + d[1]), Vec2(v.x + e[0], v.y + e[1]), sz + dz, vz + dw)
            first, last = violation_interval_taumod(*true, limits, 0.0, 60.0)
            if first <= last:
                lost += 1
                missed += not (span.first_s <= first + 1e-6 and last <= span.last_s + 1e-6)
    assert lost > 200
    assert missed == 0


@pytest.mark.parametrize("kind", [TAUMOD, TCPA, TEP, CYLINDER])
def test_hazard_zones_are_where_the_volume_is_violated(kind: int):
    from shapely import Point, Polygon

    own, other = head_on()
    other = other._replace(ve_m_s=40.0)
    volume = Volume(kind, 1200.0, 100.0, 30.0 if kind != CYLINDER else 0.0)
    shape = Polygon(hazard_zone(own, other, volume).points)
    assert shape.is_valid
    limits = Thresholds(volume.dthr_m, volume.zthr_m, volume.tthr_s, 0.0, 0.0)
    v = Vec2(own.ve_m_s - other.ve_m_s, own.vn_m_s - other.vn_m_s)
    rng = np.random.default_rng(2)
    inside = 0
    for x, y in rng.uniform(-7000, 7000, (1200, 2)):
        lost = in_conflict(kind, Vec2(-x, -y), v, 0.0, 0.0, limits, 0.0, 0.0)
        inside += lost
        if abs(shape.exterior.distance(Point(x, y))) > 5.0:
            assert shape.contains(Point(x, y)) == lost, (x, y)
    assert inside > 10


def test_contours_hold_the_conflict_ahead(p: Parameters):
    own, other = head_on()
    seen = look(p, own, [other])
    shapes = contours(p, seen, 0)
    assert len(shapes) == 1
    first = seen.times[0][1].first_s
    assert any(math.hypot(e - 0.0, n - first * 100.0) < 1.0 for e, n in shapes[0].points)
    assert contours(p, look(p, own, [other._replace(alt_m=9000.0)]), 0) == []


def test_projection():
    at = project(0.6, -2.0, 0.6, -2.0, 30.0, 40.0)
    assert at == pytest.approx((0.0, 0.0, 30.0, 40.0))
    minute = math.pi / 180 / 60
    assert project(0.0, 0.0, minute, 0.0, 0.0, 0.0).north_m == pytest.approx(1852.0, abs=1e-3)
    over = project(0.0, math.pi - 1e-6, 0.0, -math.pi + 1e-6, 0.0, 0.0)
    assert over.east_m == pytest.approx(2e-6 * 6366707, rel=1e-6)
