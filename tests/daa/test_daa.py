"""Detect and avoid: published vectors, degenerate encounters, bands, directives."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import daa_scenes
import numpy as np
import pytest
from daa_scenes import head_on

from cratous.core.daa.bands import directive, on_circle, region_of
from cratous.core.daa.engine import look, thresholds
from cratous.core.daa.grid import grid
from cratous.core.daa.reasons import reasons_at
from cratous.core.daa.session import Session
from cratous.core.daa.state import ALT, HDIR, HS, UNKNOWN, VS, Aircraft, Band, Sigma
from cratous.services import conform
from cratous.services.conform.detect_and_avoid import LABELS
from cratous.spec.daa.parameters import (
    FAR,
    MID,
    NEAR,
    NONE,
    RECOVERY,
    TAUMOD,
    TCAS,
    TCAS_LEVELS,
    Parameters,
    Volume,
)
from cratous.spec.daa.presets import preset
from cratous.spec.errors import BadInput


@pytest.fixture(scope="module")
def p() -> Parameters:
    return preset("do_365b").parameters


@pytest.fixture
def vectors(shared: Path) -> Path:
    return shared / "vectors"


# -- against published vectors -----------------------------------------------------------
KINDS = (
    "alert level", "violation times", "time to corrective volume", "resolution", "bands",
    "recovery", "last time to manoeuvre", "resolution shown",
)  # fmt: skip
ALLOWED = {("open-encounters-SUM", "bands"): 3, ("open-scenarios", "resolution shown"): 2}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("open-encounters", marks=pytest.mark.slow),
        "open-encounters-SUM",
        "open-scenarios",
        "open-sequences",
    ],
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
    answered, refused = daa_scenes.run(400, seed=3)
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
