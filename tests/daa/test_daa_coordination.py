"""Implicit coordination: sides that fit together, bands that keep to them, how both fly."""

from __future__ import annotations

import dataclasses
import math
import random
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from daa_pairs import NUMBERS, VECTORS, coordinating, meeting
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from cratous.core.daa.coordination import (
    horizontal_side,
    repels,
    repels_vertically,
    step_is_repulsive,
)
from cratous.core.daa.session import Instant, Session
from cratous.core.daa.state import ALT, HDIR, HS, VS, Aircraft
from cratous.core.daa.urgency import coordination
from cratous.core.kernel import Vec2
from cratous.services.conform import cases
from cratous.spec.daa import coordination as daa_coordination
from cratous.spec.daa.parameters import (
    FIXED,
    NEAR,
    NMAC_HALF_HEIGHT_M,
    NMAC_RADIUS_M,
    NONE,
    RECOVERY,
    Level,
    Parameters,
    Spread,
)
from cratous.spec.daa.presets import preset

SIZE = (NMAC_RADIUS_M, NMAC_HALF_HEIGHT_M)
STILL = Vec2(0.0, 0.0)


def back(v: Vec2) -> Vec2:
    return Vec2(-v.x, -v.y)


def goes_above(s: Vec2, v: Vec2, sz: float, vz: float, first: bool) -> int:
    own = Aircraft("a" if first else "c", *s, sz, *v, vz)
    other = Aircraft("b", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    on = Parameters(conflict_crit=True, urgency_strategy=FIXED, most_urgent_aircraft="b")
    found = coordination(on, own, [other])
    assert found is not None
    assert found.horizontal == horizontal_side(s, v)
    return found.vertical


def plane(v: Vec2) -> daa_coordination.Plane:
    return daa_coordination.Plane(*v)


@pytest.fixture(scope="module")
def p() -> Parameters:
    return dataclasses.replace(preset("do_365b").parameters, hysteresis_time_s=0.0)


# -- sides --------------------------------------------------------------------------------
@given(VECTORS, VECTORS, NUMBERS, NUMBERS, st.booleans())
@example(STILL, STILL, 0.0, 0.0, True)
@example(Vec2(0.0, 9000.0), Vec2(0.0, -200.0), 0.0, 0.0, False)
@example(STILL, Vec2(1.0, 0.0), 0.0, -2.0, True)
def test_two_aircraft_choose_sides_that_fit_together(
    s: Vec2, v: Vec2, sz: float, vz: float, first: bool
) -> None:
    hand = horizontal_side(s, v)
    assert hand == horizontal_side(back(s), back(v)) in (1, -1)
    above = goes_above(s, v, sz, vz, first)
    below = goes_above(back(s), back(v), -sz, -vz, not first)
    assert above == -below in (1, -1)


def test_sides_are_where_they_are_expected() -> None:
    north, crossing = Vec2(0.0, 100.0), Vec2(100.0, 0.0)
    # the intruder is ahead and to the right, or to the left
    assert horizontal_side(Vec2(-300.0, -5000.0), north) == 1
    assert horizontal_side(Vec2(300.0, -5000.0), north) == -1
    assert horizontal_side(Vec2(0.0, -5000.0), north) == 1
    # above now, but below when they pass, and no cylinder in between
    apart = Vec2(-5000.0, -2000.0)
    assert goes_above(apart, crossing, 100.0, -10.0, True) == -1
    assert goes_above(apart, crossing, 100.0, 0.0, True) == 1
    # through the cylinder: stays above
    assert goes_above(Vec2(-5000.0, 0.0), crossing, 500.0, -10.05, True) == 1
    assert goes_above(apart, crossing, 0.0, 0.0, True) == 1
    assert goes_above(apart, crossing, 0.0, 0.0, False) == -1


# -- what repels ---------------------------------------------------------------------------
def least_apart(s: Vec2, v: Vec2) -> float:
    """The least distance to come, by its own formula [m]."""
    vv, sv = v.x * v.x + v.y * v.y, s.x * v.x + s.y * v.y
    t = -sv / vv if sv < 0 else 0.0
    return math.hypot(s.x + t * v.x, s.y + t * v.y)


@settings(max_examples=300)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_velocities_that_repel_keep_the_distance_alone_and_together(seed: int, close: bool) -> None:
    rng = random.Random(seed)

    def some(size: float) -> Vec2:
        return Vec2(rng.uniform(-size, size), rng.uniform(-size, size))

    s, own, other = some(300.0 if close else 9000.0), some(200.0), some(200.0)
    v = Vec2(own.x - other.x, own.y - other.y)
    side = horizontal_side(s, v)
    mine = [w for w in (some(200.0) for _ in range(40))
            if repels(s, v, Vec2(w.x - other.x, w.y - other.y), side)]  # fmt: skip
    theirs = [w for w in (some(200.0) for _ in range(40))
              if repels(back(s), back(v), Vec2(w.x - own.x, w.y - own.y), side)]  # fmt: skip
    before = least_apart(s, v)
    for a in mine:
        assert least_apart(s, Vec2(a.x - other.x, a.y - other.y)) >= before - 1e-6
    for a in mine[:6]:
        for b in theirs[:6]:
            w = Vec2(a.x - b.x, a.y - b.y)
            assert least_apart(s, w) >= before - 1e-6
            passed = daa_coordination.on_the_side(plane(s), plane(w), side)
            assert passed > 0 or s.x * w.x + s.y * w.y >= 0
    if s.x * v.x + s.y * v.y < -1.0:
        assert repels(s, v, Vec2(side * s.y, -side * s.x), side), "there is always one"


@given(VECTORS, NUMBERS, NUMBERS, NUMBERS, st.sampled_from([1, -1]))
def test_who_repels_vertically_climbs_to_its_side(
    v: Vec2, vz: float, mine: float, theirs: float, side: int
) -> None:
    one = repels_vertically(v, vz, v, mine, side)
    other = repels_vertically(back(v), -vz, back(v), -theirs, -side)
    assert not one or side * mine > side * vz
    if one and other and abs(mine - vz) > 1e-9:
        assert side * (mine + theirs - vz) > side * vz


# -- bands ----------------------------------------------------------------------------------
def both(p: Parameters, own: Aircraft, other: Aircraft) -> tuple[Instant, Instant]:
    """What each of two aircraft is told that coordinate with each other."""
    return (
        Session(coordinating(p, other.id)).step(0.0, own, [other]),
        Session(coordinating(p, own.id)).step(0.0, other, [own]),
    )


@settings(max_examples=40)
@given(st.integers(0, 2**32 - 1))
def test_bands_of_both_never_offer_opposing_sides(p: Parameters, seed: int) -> None:
    own, other = meeting(random.Random(seed))
    mine, theirs = both(p, own, other)
    one, two = mine.seen.coordination, theirs.seen.coordination
    assert one is not None
    assert two is not None
    assert (one.id, two.id) == ("intruder", "own")
    assert one.horizontal == two.horizontal
    assert one.vertical == -two.vertical
    offered = 0
    for instant, found in ((mine, one), (theirs, two)):
        vs = instant.guidance[VS]
        for band in vs.bands:
            if band.region in (NONE, RECOVERY):
                # nothing on the wrong side of the own vertical speed
                nearer = band.low if found.vertical > 0 else band.high
                assert found.vertical * (nearer - vs.own) >= -1e-9, vs.bands
        for dimension in (HDIR, HS):
            raw = instant.raw[dimension]
            assert raw is not None
            g, there = raw.grid, instant.seen.traffic.states[0]
            for path, safe in ((g.right, raw.safe_r), (g.left, raw.safe_l)):
                rows = [r for r in range(1, 4) if raw.state[r]] + [4] * bool(
                    raw.recovery.computed and not raw.recovery.saturated
                )
                for k in range(1, len(path)):
                    if not any(safe[r, k] for r in rows):
                        continue
                    offered += 1
                    t = k * g.step_s
                    s = plane(Vec2(*(path[k, :2] - there[:2] - t * there[3:5])))
                    v = plane(Vec2(*(path[k, 3:5] - there[3:5])))
                    assert daa_coordination.on_the_side(s, v, found.horizontal) > 0
    assume(offered)


def test_both_flying_what_repels_keep_farther_apart(p: Parameters) -> None:
    """Both turn as long as each step repels, then fly straight on: nothing is proved of turns at one
    time, each step of which is judged against the other flying straight; so they are flown here."""
    rng, flown, gained = random.Random(2), 0, 0.0
    for _ in range(40):
        own, other = meeting(rng)
        paths = []
        for instant, a, b in zip(both(p, own, other), (own, other), (other, own), strict=True):
            raw, found = instant.raw[HDIR], instant.seen.coordination
            assert raw is not None
            assert found is not None
            g, there = raw.grid, np.array(b[1:7])
            turns = []
            for path in (g.right, g.left):
                k = 0
                while k + 1 < 31 and step_is_repulsive(
                    path, k + 1, g.step_s, there, found.horizontal, 0
                ):
                    k += 1
                turns.append((k, path))
            k, path = max(turns, key=lambda turn: turn[0])
            paths.append((k, path, g.step_s, a))
        if not all(k for k, *_ in paths):
            continue
        flown += 1

        def place(flight: tuple, t: float) -> np.ndarray:
            k, path, step_s, _ = flight
            j = min(int(t / step_s), k)
            rest = t - j * step_s
            way = path[j, 8:10] if j < k else path[k, 3:5]
            return np.asarray(path[j, :2] + rest * way)

        times = np.arange(0.0, 150.0, 0.5)
        apart = min(float(np.hypot(*(place(paths[0], t) - place(paths[1], t)))) for t in times)
        s = Vec2(own.east_m - other.east_m, own.north_m - other.north_m)
        v = Vec2(own.ve_m_s - other.ve_m_s, own.vn_m_s - other.vn_m_s)
        # sampled twice a second, they are at most so much nearer in between
        before = least_apart(s, v)
        assert apart >= before
        gained += apart - before
    assert flown >= 30
    assert gained / flown > 500


def bands_of(p: Parameters, own: Aircraft, others: list[Aircraft]):
    instant = Session(p).step(0.0, own, others)
    return [g._replace(peripheral={}) for g in instant.guidance], instant


def test_without_a_most_urgent_aircraft_bands_are_those_without_criteria(p: Parameters) -> None:
    rng = random.Random(3)
    for strategy in ({}, {"urgency_strategy": FIXED, "most_urgent_aircraft": "elsewhere"}):
        on = dataclasses.replace(p, conflict_crit=True, recovery_crit=True, **strategy)
        for _ in range(4):
            own, other = meeting(rng)
            found, instant = bands_of(on, own, [other])
            assert found == bands_of(p, own, [other])[0]
            assert instant.seen.coordination is None


def test_on_published_encounters_the_default_strategy_changes_nothing(shared: Path) -> None:
    file = shared / "vectors" / "daidalus" / "open-encounters.jsonl.gz"
    compared = 0
    for _, case in islice(cases(file), 0, 200, 10):
        if case["config"] not in ("DO_365B_no_SUM", "nom_b", "CD3D"):
            continue
        name = {"DO_365B_no_SUM": "do_365b"}.get(case["config"], case["config"].lower())
        without = preset(name).parameters
        on = dataclasses.replace(without, conflict_crit=True, recovery_crit=True)
        said = case["out"]
        all_ = [said["own"], *(t["state"] for t in said["traffic"])]
        own, *others = (Aircraft(a["id"], *a["s"], *a["v"]) for a in all_)
        assert bands_of(on, own, others)[0] == bands_of(without, own, others)[0]
        compared += 1
    assert compared >= 10


def test_a_criterion_counts_in_its_bands_only(p: Parameters) -> None:
    own = Aircraft("own", 0.0, 0.0, 3000.0, 0.0, 100.0, 0.0)
    other = Aircraft("intruder", 100.0, 9000.0, 3000.0, 0.0, -100.0, 0.0)
    plain = bands_of(p, own, [other])[1]
    only = bands_of(coordinating(p, "intruder", True, False), own, [other])[1]
    late = bands_of(coordinating(p, "intruder", False, True), own, [other])[1]
    assert only.guidance[ALT] == late.guidance[ALT] == plain.guidance[ALT]
    for k, raw in enumerate(plain.raw):
        assert raw is not None
        assert only.raw[k] is not None
        # a criterion frees nothing, and that of recovery leaves conflict bands alone
        assert not (only.raw[k].safe_r[1:4] & ~raw.safe_r[1:4]).any()
        assert (late.raw[k].safe_r[1:4] == raw.safe_r[1:4]).all()
        assert (late.raw[k].safe_l[1:4] == raw.safe_l[1:4]).all()
    turned = only.guidance[HDIR]
    assert turned.bands != plain.guidance[HDIR].bands
    assert not any(b.region in (NONE, RECOVERY) and b.high <= math.pi for b in turned.bands)


def test_a_change_at_once_has_to_repel_by_itself() -> None:
    p = dataclasses.replace(preset("cd3d").parameters, hysteresis_time_s=0.0)
    own = Aircraft("own", 0.0, 0.0, 3000.0, 0.0, 100.0, 0.0)
    other = Aircraft("intruder", 100.0, 30000.0, 3000.0, 0.0, -100.0, 0.0)
    raw = bands_of(coordinating(p, "intruder"), own, [other])[1].raw[HDIR]
    assert raw is not None
    assert raw.grid.step_s == 0
    free = [raw.safe_r[NEAR], raw.safe_l[NEAR]]
    assert not free[0][0], "to fly on is no manoeuvre that repels"
    assert not free[0].any()
    assert free[1].any()


def test_a_spread_alert_counts_what_does_not_repel(p: Parameters) -> None:
    own = Aircraft("own", 0.0, 0.0, 3000.0, 0.0, 100.0, 0.0)
    far = Aircraft("intruder", 20000.0, 90000.0, 3000.0, 0.0, -100.0, 0.0)
    levels: tuple[Level, ...] = p.alerters[0].levels
    wide = (*levels[:-1], levels[-1]._replace(spread=Spread(0.2)))
    spread = dataclasses.replace(p, alerters=(p.alerters[0]._replace(levels=wide),))
    assert Session(spread).step(0.0, own, [far]).alerts[0].level == 0
    assert Session(coordinating(spread, "intruder")).step(0.0, own, [far]).alerts[0].level == 3
