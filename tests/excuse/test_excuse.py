"""Whether a way out existed: kernels against definitions, two judges against each other."""

from __future__ import annotations

import dataclasses
import json
import math
import random
from pathlib import Path

import daa_scenes
import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.daa.bands import manoeuvres
from cratous.core.daa.grid import grid
from cratous.core.daa.guidance import evaluate
from cratous.core.daa.records import Intruders, Looking, Regaining
from cratous.core.daa.state import ALT, DIMENSIONS, Aircraft, Sigma
from cratous.core.excuse import bands as excuse_bands
from cratous.core.excuse import exhaustive_check as excuse_check
from cratous.core.excuse.judgement import from_state, judged
from cratous.core.excuse.state import (
    FREE,
    NO_WAY,
    OPEN,
    REFUSED,
    UNDECIDED,
    WAY_OUT,
    Other,
    straight,
)
from cratous.core.excuse.way_out import both_say, is_excused, manoeuvre_judged, way_out
from cratous.core.kernel import Vec2
from cratous.core.readings.machine.compiled import machine
from cratous.core.well_clear.thresholds import Thresholds
from cratous.services.cli.daa import daa
from cratous.spec import excuse
from cratous.spec.daa import meaning as daa_meaning
from cratous.spec.daa.parameters import Parameters
from cratous.spec.daa.presets import preset
from cratous.spec.errors import BadInput

ENCOUNTER = Path(__file__).parents[2] / "examples/encounters/two_intruders.daa"


# -- the folds ---------------------------------------------------------------------------
@given(st.lists(st.tuples(st.booleans(), st.booleans(), st.booleans()), max_size=6))
def test_a_manoeuvre_is_judged_by_all_of_its_pieces(pieces: list[tuple[bool, bool, bool]]) -> None:
    flown = excuse.Flown(False, False)
    for piece in pieces:
        flown = excuse.flown_step(flown, *piece)
    assert manoeuvre_judged(pieces) == excuse.judged(flown)
    if any(known and lost and surely for known, lost, surely in pieces):
        assert manoeuvre_judged(pieces) == REFUSED
    assert (manoeuvre_judged(pieces) == FREE) == all(k and not x for k, x, _ in pieces)


@given(st.lists(st.integers(-3, 3), max_size=6))
def test_one_free_manoeuvre_is_a_way_out_and_none_at_all_is_no_excuse(answers: list[int]) -> None:
    tried = excuse.Tried(False, False, False)
    for one in answers:
        tried = excuse.tried_step(tried, one)
    said = way_out([(one,) for one in answers])
    assert said == excuse.answer(tried)
    assert (said == WAY_OUT) == (FREE in answers)
    assert (said == NO_WAY) == (len(answers) > 0 and all(a == REFUSED for a in answers))


@pytest.mark.parametrize("one", [-2, -1, 0, 1, 2])
@pytest.mark.parametrize("other", [-2, -1, 0, 1, 2])
def test_only_what_both_say_is_said(one: int, other: int) -> None:
    said = both_say(one, other)
    assert excuse.agreed(one, other, said)
    assert is_excused(said) == (one == other == -1)


# -- from one state -----------------------------------------------------------------------
def scene(rng: random.Random) -> tuple[Aircraft, tuple[float, ...]]:
    """An ownship, and another that comes more or less towards it."""
    own = Aircraft("own", 0, 0, 2000, 0, rng.uniform(20, 200), rng.choice((0, 0, 5, -5)))
    far, at, speed = (
        rng.choice((300, 1500, 4000, 12000)),
        rng.uniform(0, 6.28),
        rng.uniform(50, 250),
    )
    course = at + math.pi + rng.gauss(0, 0.15)
    return own, (
        far * math.sin(at), far * math.cos(at), 2000 + rng.gauss(0, 60),
        speed * math.sin(course), speed * math.cos(course), rng.gauss(0, 2),
    )  # fmt: skip


def near(p: Parameters) -> tuple[int, tuple[float, ...]]:
    volume = p.alerters[0].levels[-1].volume
    return volume.kind, volume[1:]


@pytest.fixture(scope="module")
def p() -> Parameters:
    return dataclasses.replace(preset("do_365b").parameters, lookahead_time_s=90.0)


def test_the_two_judges_try_the_same_manoeuvres_and_say_the_same(p: Parameters) -> None:
    rng = random.Random(3)
    kind, limits = near(p)
    manoeuvres = different = 0
    answers = set()
    for _ in range(12):
        own, state = scene(rng)
        others = [Other("i", straight(state, 90.0), kind, limits)]
        bands, check = (j.judge(p, own, others, 90.0) for j in (excuse_bands, excuse_check))
        one = {(t.dimension, round(t.value, 5)): t.answer for t in bands[1]}
        two = {(t.dimension, round(t.value, 5)): t.answer for t in check[1]}
        assert one.keys() == two.keys()
        manoeuvres += len(one)
        different += sum(one[key] != two[key] for key in one)
        assert bands[0] == check[0]
        answers.add(bands[0])
    assert answers == {WAY_OUT, NO_WAY}
    # the pieces of a turn differ: its tangents at steps, its chords at ticks
    assert different < 0.002 * manoeuvres


def test_on_straight_traffic_the_answers_are_those_of_the_bands(p: Parameters) -> None:
    rng = random.Random(4)
    kind, limits = near(p)
    for _ in range(6):
        own, state = scene(rng)
        tried = excuse_bands.judge(p, own, [Other("i", straight(state, 90.0), kind, limits)], 90.0)[
            1
        ]
        for dimension in range(ALT):
            g = grid(p, own, dimension)
            safe_r, safe_l = np.ones(len(g.right), np.bool_), np.ones(len(g.left), np.bool_)
            intruder = Intruders(
                np.array([state]), np.array([kind]), np.array([[*limits, *[0.0] * 6]]),
                np.array([90.0]), np.zeros((1, 2), np.int64),
            )  # fmt: skip
            machine(evaluate)(
                manoeuvres(g, g.step_s), intruder, np.array([0]),
                Regaining(0.0, 0.0, 0.0, False), Looking(90.0, True, 0.0, False, True), safe_r, safe_l,
            )  # fmt: skip
            mine = [t.answer == FREE for t in tried if t.dimension == DIMENSIONS[dimension]]
            width_r, width_l = g.high - g.own, g.own - g.low
            right = [bool(x) for k, x in enumerate(safe_r) if k * g.step <= width_r + 1e-9]
            left = [bool(x) for k, x in enumerate(safe_l) if k > 0 and k * g.step <= width_l + 1e-9]
            assert mine == right + left


def test_every_answer_holds_at_sampled_instants(p: Parameters) -> None:
    rng = random.Random(5)
    kind, limits = near(p)
    seen = {FREE: 0, REFUSED: 0}
    for _ in range(3):
        own, state = scene(rng)
        other = Other("i", straight(state, 90.0), kind, limits)
        ways, _ = excuse_bands.manoeuvres(p, own, 90.0)
        tried = excuse_bands.judge(p, own, [other], 90.0)[1]
        for (_, _, pieces), one in list(zip(ways, tried, strict=True))[::37]:
            seen[one.answer] += 1
            for begin, end, x, y, z, vx, vy, vz in pieces.tolist():
                q = other.pieces[0]
                there = [q[2 + k] + begin * q[5 + k] for k in range(3)]
                s, v = Vec2(x - there[0], y - there[1]), Vec2(vx - q[5], vy - q[6])
                for t in np.linspace(0, end - begin, 9)[1:-1].tolist():
                    lost = daa_meaning.violated_at(
                        kind, s, v, z - there[2], vz - q[7], Thresholds(*limits), t
                    )
                    if lost:
                        assert one.answer == REFUSED
                        assert one.at_s is not None
                        assert one.at_s <= begin + t
    assert min(seen.values()) > 0


def test_what_is_not_known_of_another_is_never_an_excuse(p: Parameters) -> None:
    own, state = Aircraft("own", 0, 0, 2000, 0, 50, 0), (0.0, 9000.0, 2000.0, 0.0, -200.0, 0.0)
    kind, limits = near(p)
    whole = straight(state, 90.0)
    early, late = whole.copy(), whole.copy()
    early[0, 1] = 1.0
    late[0, 0], late[0, 3] = 1.0, late[0, 3] - 200.0
    assert judged(p, own, [Other("i", whole, kind, limits)], 90.0).answer != UNDECIDED
    for rows in (early, late, whole[:0]):
        # far enough that nothing is lost where it is known
        far = rows.copy()
        far[:, 3] += 50000
        said = judged(p, own, [Other("i", far, kind, limits)], 90.0)
        assert (said.answer, said.by_bands, said.by_check) == (UNDECIDED, OPEN, OPEN)
        assert "not known" in said.why


def test_an_own_value_out_of_range_or_an_unsure_state_is_undecided(p: Parameters) -> None:
    hover = Aircraft("own", 0, 0, 2000, 0, 2.0, 0)
    close = Aircraft("i", 300, 300, 2000, 100, 100, 0)
    said = from_state(p, hover, [close])
    assert said.answer == UNDECIDED
    assert "own hs 2 is outside of" in said.why
    sigma = Sigma(s_ew_m=100.0, s_ns_m=100.0)
    sum_ = preset("do_365b_sum").parameters
    said = from_state(sum_, hover._replace(vn_m_s=100.0), [close._replace(sigma=sigma)])
    assert said.answer == UNDECIDED
    assert "known only within bounds: i" in said.why
    assert from_state(sum_, hover._replace(vn_m_s=100.0), [close]).answer == NO_WAY


def test_nobody_in_the_way_leaves_every_manoeuvre_free(p: Parameters) -> None:
    own = Aircraft("own", 0, 0, 2000, 0, 100, 0)
    said = from_state(p, own, [])
    assert said.answer == WAY_OUT
    assert all(t.answer == FREE for t in said.bands + said.check)
    blind = Aircraft("i", 100, 100, 2000, 0, 0, 0, alerter=0)
    p_all = dataclasses.replace(p, ownship_centric_alerting=False)
    assert from_state(p_all, own, [blind]).answer == WAY_OUT


def test_degenerate_states_are_answered_or_refused(p: Parameters) -> None:
    rng = random.Random(11)
    short = dataclasses.replace(p, lookahead_time_s=20.0, step_hdir_rad=math.radians(10),
                                step_alt_m=500.0, step_vs_m_s=5.0, step_hs_m_s=30.0)  # fmt: skip
    for _ in range(60):
        own, others = daa_scenes.scene(rng)
        try:
            said = from_state(short, own, others)
        except BadInput:
            assert any(o.id == own.id for o in others)
            continue
        assert said.answer in (WAY_OUT, UNDECIDED, NO_WAY)
        assert bool(said.why) == (said.answer == UNDECIDED)
        for one in said.bands + said.check:
            facts = [x for x in (one.at_s, one.apart_m, one.above_m) if x is not None]
            assert all(math.isfinite(x) for x in (one.value, *facts))
            assert (len(facts) == 3) == (one.answer == REFUSED)
    with pytest.raises(BadInput):
        from_state(short, own._replace(east_m=math.nan), [])


# -- the command line ---------------------------------------------------------------------
def test_the_command_names_who_refuses_and_a_free_value() -> None:
    run = CliRunner().invoke(daa, ["excuse", str(ENCOUNTER), "--time", "40"], standalone_mode=False)
    assert run.exit_code == 0, run.output
    assert "a way out" in run.output
    assert "free: " in run.output
    run = CliRunner().invoke(
        daa, ["excuse", str(ENCOUNTER), "--time", "120", "--json"], standalone_mode=False
    )
    (said,) = json.loads(run.output)
    assert (said["answer"], said["by_bands"], said["by_check"]) == ("no way out",) * 3
    assert {row["answer"] for row in said["bands"] + said["check"]} == {REFUSED}
