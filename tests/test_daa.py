"""Detect and avoid: published vectors, degenerate encounters, histories, directives."""

from __future__ import annotations

import dataclasses
import math
from collections import deque
from pathlib import Path

import numpy as np
import pytest

from cratous.core.daa_bands import directive, grid, on_circle, region_of
from cratous.core.daa_climb import climb, height
from cratous.core.daa_engine import look, thresholds
from cratous.core.daa_frame import project
from cratous.core.daa_memory import BandMemory, Shown, m_of_n, resolved
from cratous.core.daa_reason import reasons_at
from cratous.core.daa_session import Session
from cratous.core.daa_state import ALT, HDIR, HS, UNKNOWN, VS, Aircraft, Band, Sigma
from cratous.core.daa_steps import piece_counts, straight_from, until, way_conflicts
from cratous.core.daa_turn import turn_offset, turned
from cratous.core.daa_uncertain import uncertain_span
from cratous.core.daa_volume import in_conflict
from cratous.core.daa_zones import contours, hazard_zone
from cratous.core.kernel import Vec2
from cratous.core.well_clear_interval import violation_interval_taumod
from cratous.services import conform
from cratous.services.conform.detect_and_avoid import LABELS
from cratous.spec import daa_meaning
from cratous.spec.daa import (
    CYLINDER,
    FAR,
    MID,
    NEAR,
    NONE,
    RECOVERY,
    TAUMOD,
    TCAS,
    TCAS_LEVELS,
    TCPA,
    TEP,
    Parameters,
    Volume,
)
from cratous.spec.daa_presets import preset
from cratous.spec.errors import BadInput


def load_scenes():
    import importlib.util

    file = Path(__file__).with_name("daa_scenes.py")
    spec = importlib.util.spec_from_file_location("daa_scenes", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def p() -> Parameters:
    return preset("do_365b").parameters


@pytest.fixture
def vectors(shared: Path) -> Path:
    return shared / "vectors"


def head_on(distance_m: float = 15000.0) -> tuple[Aircraft, Aircraft]:
    own = Aircraft("own", 0, 0, 2000, 0, 100, 0)
    return own, Aircraft("i", 200, distance_m, 2000, 0, -100, 0)


# -- against published vectors -----------------------------------------------------------
KINDS = (
    "alert level", "violation times", "time to corrective volume", "resolution", "bands",
    "recovery", "last time to manoeuvre", "resolution shown",
)  # fmt: skip

ALLOWED = {("open-encounters-SUM", "bands"): 3, ("open-scenarios", "resolution shown"): 2}


@pytest.mark.parametrize(
    "name", ["open-encounters", "open-encounters-SUM", "open-scenarios", "open-sequences"]
)
def test_published_vectors(name: str, vectors: Path):
    judge = conform.suite("detect-and-avoid")
    result = conform.run(judge, vectors / "daidalus" / f"{name}.jsonl.gz", 0)
    tally = judge.__self__.tally
    for kind in KINDS:
        compared = tally[f"{kind}/compared"]
        if kind == "last time to manoeuvre" and name == "open-sequences":
            assert compared == 0
            continue
        assert compared > 400
        allowed = ALLOWED.get((name, kind), 0)
        assert tally[f"{kind}/ours"] <= allowed, kind
        others = sum(tally[f"{kind}/{label}"] for label in LABELS[1:-1])
        assert others <= 0.005 * compared, kind
    assert result.failed <= sum(n for (of, _), n in ALLOWED.items() if of == name)


def test_a_changed_vector_fails(vectors: Path):
    file = vectors / "daidalus" / "open-encounters.jsonl.gz"
    case = next(c for _, c in conform.cases(file))
    assert conform.suite("detect-and-avoid")(case).status == "passed"
    case["out"]["traffic"][0]["alert"] = 3
    case["out"]["hdir"]["bands"][1][1] += 0.02
    result = conform.suite("detect-and-avoid")(case)
    assert result.status == "failed"
    assert "alert level expected 3, got 0" in result.text
    assert "hdir: bands expected" in result.text


# -- degenerate encounters ---------------------------------------------------------------
def test_random_and_degenerate_encounters():
    answered, refused = load_scenes().run(400, seed=3)
    assert answered + refused == 400
    assert answered > 300


@pytest.mark.parametrize(
    ("change", "item"),
    [
        ({"east_m": math.nan}, "i.east_m"),
        ({"vu_m_s": math.inf}, "i.vu_m_s"),
        ({"id": "own"}, "own"),
    ],
)
def test_states_that_cannot_be_used_are_refused(p: Parameters, change: dict, item: str):
    own, other = head_on()
    with pytest.raises(BadInput) as error:
        Session(p).step(0.0, own, [other._replace(**change)])
    assert error.value.item == item


def test_an_own_value_out_of_range_is_said(p: Parameters):
    own, other = head_on()
    instant = Session(p).step(0.0, own._replace(alt_m=-50.0, vn_m_s=2.0), [other])
    by_name = {g.dimension: g for g in instant.guidance}
    assert by_name["alt"].bands == (Band(p.min_alt_m, p.max_alt_m, UNKNOWN),)
    assert "own alt -50 is outside of" in by_name["alt"].why
    assert by_name["hs"].why
    assert not by_name["vs"].why


# -- kernels against their definitions -----------------------------------------------------
def test_steps_against_sampled_instants():
    rng = np.random.default_rng(5)
    found = 0
    for _ in range(300):
        s, v = Vec2(*rng.normal(size=2) * 3000), Vec2(*rng.normal(size=2) * 100)
        sz, vz = rng.normal() * 200, rng.normal() * 5
        volume = (1222.0, 137.0, 35.0, 0.0, 0.0)
        kind = int(rng.integers(0, 4))
        at, begin, end = rng.uniform(0, 20), rng.uniform(0, 20), rng.uniform(20, 60)
        red = in_conflict(kind, s, v, sz, vz, *volume, straight_from(at, begin), end - at)
        lost = any(
            daa_meaning.lost_from_step(
                daa_meaning.violated_at(kind, s, v, sz, vz, *volume, t), t, at, begin, end
            )
            for t in np.linspace(0, 60, 121)
        )
        found += lost
        assert red or not lost
        blocked = piece_counts(at, begin, end) and in_conflict(kind, s, v, sz, vz, *volume, 0, 2.0)
        on_piece = any(
            daa_meaning.lost_on_piece(
                daa_meaning.violated_at(kind, s, v, sz, vz, *volume, t), t, 2.0, at, begin, end
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
        z += height(1000.0, vz, target, 2.0, *phases, (k + 0.5) * dt).vz_m_s * dt
    assert z == pytest.approx(target, abs=0.05)


# -- bands ------------------------------------------------------------------------------
def test_bands_have_reasons(p: Parameters):
    own, other = head_on()
    session = Session(p)
    instant = session.step(0.0, own, [other])
    assert instant.alerts[0].level == 2
    for d, g in enumerate(instant.guidance):
        raw = instant.raw[d]
        assert raw is not None
        for band in g.bands:
            if band.region not in (MID, NEAR) or band.high - band.low < 3 * raw.grid.step:
                continue
            middle = (band.low + band.high) / 2
            if d == HDIR:
                middle = raw.grid.own + (middle - raw.grid.own + math.pi) % (2 * math.pi) - math.pi
            reasons = reasons_at(p, instant.seen, raw, middle)
            assert reasons[0].region == band.region, (g, band)
            assert reasons[0].intruder == "i"


def test_relative_bands(p: Parameters):
    own, other = head_on()
    near = dataclasses.replace(p, below_relative_hs_m_s=10.0, above_relative_hs_m_s=-1.0)
    g = Session(near).step(0.0, own, [other], (HS,)).guidance[0]
    assert g.bands[0].low == pytest.approx(90.0)
    assert g.bands[-1].high == pytest.approx(p.max_hs_m_s)


def test_bank_angle_and_slow_flight(p: Parameters):
    own, _ = head_on()
    banked = dataclasses.replace(p, turn_rate_rad_s=0.0, bank_angle_rad=math.radians(30))
    rate = 9.80665 * math.tan(math.radians(30)) / 100.0
    assert grid(banked, own, HDIR).step_s == pytest.approx(p.step_hdir_rad / rate)
    slow = dataclasses.replace(p, hdir_bands_below_min_as=1)
    assert grid(slow, own._replace(vn_m_s=1.0), HDIR).step_s == 0.0
    assert grid(slow, own, HDIR).step_s > 0


def test_nothing_downward_is_offered_in_a_terminal_conflict(p: Parameters):
    own, other = head_on(3000.0)
    area = dataclasses.replace(p, dta_logic=-1, dta_alerter=2)
    instant = Session(area).step(0.0, own, [other], inside=(True, True))
    assert instant.alerts[0].alerter == 2
    g = {g.dimension: g for g in instant.guidance}
    for name in ("vs", "alt"):
        lower = [b for b in g[name].bands if b.high <= g[name].own - 30]
        assert all(b.region == NEAR for b in lower), g[name].bands
        assert g[name].down is None
    assert not g["hdir"].recovery.computed


def test_directives():
    bands = (Band(0, 10, NEAR), Band(10, 20, NONE), Band(20, 30, NEAR), Band(30, 40, RECOVERY))
    assert directive(bands, 25.0, MID, False) == (30, 20, True)
    assert directive(bands, 22.0, MID, False) == (30, 20, False)
    assert directive((Band(0, 40, NEAR),), 22.0, MID, False) == (None, None, False)
    assert region_of(bands, 20.0, False) == NONE
    around = on_circle([Band(6.0, 6.5, NEAR), Band(6.5, 6.0 + 2 * math.pi, NONE)])
    assert [b.region for b in around] == [NEAR, NONE, NEAR]
    way = directive(around, 6.2, MID, True)
    assert way.up == pytest.approx(6.5 - 2 * math.pi)
    assert way.down == pytest.approx(6.0)


def test_tcas_thresholds_follow_the_altitude():
    volume = Volume(TCAS, 0.0, 0.0)
    assert thresholds(volume, 2000.0) == Volume(TAUMOD, 0.55 * 1852, 600 * 0.3048, 25.0, 25.0)
    assert [x.tau_s for x in TCAS_LEVELS] == sorted(x.tau_s for x in TCAS_LEVELS)
    # a level ends with its altitude, which belongs to it
    assert thresholds(volume, 1000 * 0.3048).tthr_s == 0.0
    assert thresholds(volume, math.nextafter(1000 * 0.3048, 1e9)).tthr_s == 15.0
    assert thresholds(volume, 2350 * 0.3048).tthr_s == 15.0


def test_below_min_airspeed_directions_are_flown_at_it_unless_they_are_at_once(p: Parameters):
    slow = Aircraft("own", 0, 0, 2000, 0, 2.0, 0)
    grids = {
        way: grid(dataclasses.replace(p, hdir_bands_below_min_as=way), slow, HDIR)
        for way in (-1, 0, 1)
    }
    speeds = {way: np.hypot(g.right[:, 3], g.right[:, 4]) for way, g in grids.items()}
    for found in speeds.values():
        assert found == pytest.approx(p.min_airspeed_m_s)
    assert grids[-1].step_s == grids[0].step_s > grids[1].step_s == 0.0
    assert np.array_equal(grids[-1].right, grids[0].right)


def test_every_region_needs_a_level(p: Parameters):
    own, other = head_on()
    seen = look(p, own, [other, other._replace(id="nobody", alerter=0)])
    assert not seen.traffic.mapped[FAR].any()
    assert seen.traffic.mapped[MID].tolist() == [True, False]
    assert seen.levels == (2, 0)
    assert VS != ALT


def test_a_spread_raises_the_level(p: Parameters):
    own, other = head_on(9000.0)
    aside = other._replace(east_m=2500.0, north_m=9000.0)
    assert look(p, own, [aside]).levels == (0,)
    alerter = p.alerters[0]
    levels = [
        x._replace(spread=x.spread._replace(hdir_rad=math.radians(20))) for x in alerter.levels
    ]
    wide = dataclasses.replace(p, alerters=(alerter._replace(levels=tuple(levels)),))
    assert look(wide, own, [aside]).levels[0] > 0
    assert look(wide, own, [aside._replace(alt_m=5000.0)]).levels == (0,)


def test_uncertainty_adds_alerts_and_removes_none():
    p = preset("do_365b_sum").parameters
    rng = np.random.default_rng(8)
    more = 0
    for _ in range(200):
        own = Aircraft("own", 0, 0, 2000, *(rng.normal(size=3) * (80, 80, 4)))
        other = Aircraft("i", *(rng.normal(size=3) * 3500), *(rng.normal(size=3) * (80, 80, 4)))
        other = other._replace(alt_m=2000 + rng.normal() * 150)
        plain = look(p, own, [other])
        vague = other._replace(
            sigma=Sigma(*(np.abs(rng.normal(size=8)) * (80, 80, 0, 30, 4, 4, 0, 2)))
        )
        seen = look(p, own, [vague])
        assert seen.levels[0] >= plain.levels[0]
        for known, sure in zip(seen.times[0], plain.times[0], strict=True):
            if sure.first_s is not None:
                assert known.first_s <= sure.first_s + 1e-9
                assert known.last_s >= sure.last_s - 1e-9
        more += seen.levels[0] > plain.levels[0]
    assert more > 5


def test_uncertainty_covers_sampled_true_states():
    rng = np.random.default_rng(9)
    lost = missed = 0
    limits = (1222.0, 137.0, 35.0, 0.0, 0.0)
    for _ in range(300):
        s, v = Vec2(*rng.normal(size=2) * 3000), Vec2(*rng.normal(size=2) * 80)
        sz, vz, es, ez, ev, ew = *(rng.normal(size=2) * (150, 5)), 80.0, 40.0, 5.0, 2.0
        span = uncertain_span(s, v, sz, vz, es, ez, ev, ew, *limits, 0.0, 60.0)
        for _ in range(10):
            d, e = rng.normal(size=2), rng.normal(size=2)
            d, e = d / np.hypot(*d) * es * rng.random(), e / np.hypot(*e) * ev * rng.random()
            dz, dw = rng.uniform(-ez, ez), rng.uniform(-ew, ew)
            true = (Vec2(s.x + d[0], s.y + d[1]), Vec2(v.x + e[0], v.y + e[1]), sz + dz, vz + dw)
            first, last = violation_interval_taumod(*true, *limits, 0.0, 60.0)
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
    limits = (volume.dthr_m, volume.zthr_m, volume.tthr_s, 0.0, 0.0)
    v = Vec2(own.ve_m_s - other.ve_m_s, own.vn_m_s - other.vn_m_s)
    rng = np.random.default_rng(2)
    inside = 0
    for x, y in rng.uniform(-7000, 7000, (1200, 2)):
        lost = in_conflict(kind, Vec2(-x, -y), v, 0.0, 0.0, *limits, 0.0, 0.0)
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


# -- history ----------------------------------------------------------------------------
def test_m_of_n():
    assert m_of_n(deque([3, 2, 0, 0]), 2) == 2
    assert m_of_n(deque([3, 3, 0, 0]), 2) == 3
    assert m_of_n(deque([1]), 2) == 0


def test_alerts_persist_and_need_two_of_four():
    shown = Shown(2, 4)
    assert shown.update(0, 0.0, 4.0) == 0
    assert shown.update(3, 1.0, 4.0) == 0
    assert shown.update(3, 2.0, 4.0) == 3
    assert [shown.update(0, t, 4.0) for t in (3.0, 4.0, 5.0)] == [3, 3, 3]
    assert shown.update(0, 6.0, 4.0) == 0


def test_history_ends_with_a_gap(p: Parameters):
    own, other = head_on()
    far = other._replace(north_m=90000.0)
    session = Session(p)
    assert session.step(0.0, own, [far], ()).alerts[0].level == 0
    assert session.step(1.0, own, [other], ()).alerts[0].level == 0
    assert session.step(100.0, own, [other], ()).alerts[0].level == 2
    assert session.step(99.0, own, [far], ()).alerts[0].level == 0


def test_bands_need_two_of_four():
    memory = BandMemory(2, 4)
    free, red = (Band(0, 10, NONE),), (Band(0, 5, NEAR), Band(5, 10, NONE))
    assert memory.filtered(free) == free
    assert memory.filtered(red) == free
    assert memory.filtered(red) == red
    recovering = memory.filtered((Band(0, 10, RECOVERY),))
    assert recovering == (Band(0, 5, NEAR), Band(5, 10, NONE))
    assert resolved(recovering, True) == (Band(0, 5, NEAR), Band(5, 10, RECOVERY))


def test_a_band_history_begins_with_m_copies():
    memory = BandMemory(3, 4)
    free, red = (Band(0, 10, NONE),), (Band(0, 10, NEAR),)
    assert [memory.filtered(b)[0].region for b in (free, red, red, red)] == [NONE, NONE, NONE, NEAR]


def test_a_conflict_band_is_held():
    memory = BandMemory(0, 0, persistence_s=4.0)
    free, red = (Band(0, 10, NONE),), (Band(0, 5, NEAR), Band(5, 10, NONE))
    mild = (Band(0, 6, MID), Band(6, 10, NONE))
    assert memory.shown(red, False, 2.0, 0.0) == red
    assert memory.shown(free, False, 2.0, 1.0) == red
    assert memory.shown(mild, False, 2.0, 2.0) == (
        Band(0, 5, NEAR), Band(5, 6, MID), Band(6, 10, NONE)
    )  # fmt: skip
    assert memory.shown(free, True, 2.0, 3.0) == (Band(0, 5, NEAR), Band(5, 10, RECOVERY))
    assert memory.shown(free, False, 2.0, 4.0) == free
    around = BandMemory(0, 0, persistence_s=4.0, turn=2 * math.pi)
    ahead = (Band(0, 1, NEAR), Band(1, 6, NONE), Band(6, 2 * math.pi, NEAR))
    assert around.shown(ahead, False, 0.5, 0.0) == ahead
    assert around.shown((Band(0, 2 * math.pi, NONE),), False, 0.5, 1.0) == ahead


def test_before_a_slow_turn_the_true_speed_is_flown(p: Parameters):
    own = Aircraft("own", 0, 0, 2000, 0, 1.0, 0)
    g = grid(p, own, HDIR)
    assert g.right[0, 3:5] == pytest.approx([0.0, p.min_airspeed_m_s])
    assert g.right[0, 6:8] == pytest.approx([0.0, 1.0])


def test_projection():
    at = project(0.6, -2.0, 0.6, -2.0, 30.0, 40.0)
    assert at == pytest.approx((0.0, 0.0, 30.0, 40.0))
    minute = math.pi / 180 / 60
    assert project(0.0, 0.0, minute, 0.0, 0.0, 0.0).north_m == pytest.approx(1852.0, abs=1e-3)
    over = project(0.0, math.pi - 1e-6, 0.0, -math.pi + 1e-6, 0.0, 0.0)
    assert over.east_m == pytest.approx(2e-6 * 6366707, rel=1e-6)
