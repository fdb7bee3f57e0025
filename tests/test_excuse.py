"""Whether a way out existed: kernels against definitions, two judges against each other, the monitor."""

from __future__ import annotations

import dataclasses
import importlib.util
import json
import math
import random
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from cratous.bridge import lmcp
from cratous.core import excuse_bands, excuse_check
from cratous.core.daa_bands import grid
from cratous.core.daa_guide import evaluate
from cratous.core.daa_machine import machine
from cratous.core.daa_state import ALT, DIMENSIONS, Aircraft, Sigma
from cratous.core.excuse import both_say, is_excused, manoeuvre_judged, way_out
from cratous.core.excuse_judge import from_state, judged
from cratous.core.excuse_record import ACCELERATION_M_S2, Scene, judge_loss, modelled
from cratous.core.excuse_state import (
    FREE,
    NO_WAY,
    OPEN,
    REFUSED,
    UNDECIDED,
    WAY_OUT,
    Other,
    straight,
)
from cratous.core.kernel import Vec2
from cratous.services.certify.again import certify_again
from cratous.services.certify.html import losses
from cratous.services.certify.verdicts import constraint_rows, requirement_rows
from cratous.services.cli import main as run_command
from cratous.services.cli.daa import daa
from cratous.services.flight.dynamics import MAX_ACCELERATION_M_S2
from cratous.services.monitor import Monitor
from cratous.spec import daa_meaning, excuse
from cratous.spec.daa import Parameters
from cratous.spec.daa_presets import preset
from cratous.spec.errors import BadInput
from cratous.spec.guarantees import Outcome, exit_code
from cratous.spec.mission import Daa, Frame, Mission, Position, Task, TaskKind, Vehicle, WellClear
from cratous.spec.plan import Plan

ENCOUNTER = Path(__file__).parents[1] / "examples/encounters/two_intruders.daa"


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
            machine(evaluate)(
                g.right, g.left, g.step_s, g.step_s, g.targets, g.rate_m_s, g.accel_m_s2, 1.0,
                np.array([state]), np.array([0]), np.array([kind]),
                np.array([[*limits, *[0.0] * 6]]), np.array([90.0]), np.zeros((1, 2), np.int64), 0.0, 0.0,
                0.0, False, 90.0,
                True, 0.0, False, True, safe_r, safe_l,
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
                    lost = daa_meaning.violated_at(kind, s, v, z - there[2], vz - q[7], *limits, t)
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


# -- a record -----------------------------------------------------------------------------
VOLUME = WellClear(400.0, 60.0, 10.0, 0.0)
FAST = (0.0, -150.0)


def vehicle(number: int, protected: bool = True) -> Vehicle:
    at = Position(0.0, 0.0, 300.0)
    return Vehicle(number, "", at, 0.0, 20.0, 15.0, 30.0, 0.5, 5.0, protected)


def head_on(appears_ms: int, until_ms: int = 40000, begin_ms: int = 0) -> list[Scene]:
    """Vehicle 1 flies north at 20 m/s; traffic 9 comes south at 150 m/s and meets it at 20 s."""
    scenes = []
    for ms in range(begin_ms, until_ms + 1, 250):
        places = {1: (0.0, 0.02 * ms, 300.0)}
        if ms >= appears_ms:
            places[9] = (5.0, 400.0 - 0.15 * (ms - 20000), 300.0)
        scenes.append(Scene(ms, places))
    return scenes


def loss_at(scenes: list[Scene]) -> int:
    """The first step in which tau_mod comes down to TTHR, by its definition."""
    for k, s in enumerate(scenes):
        if 9 in s.places:
            gap = s.places[9][1] - s.places[1][1]
            tau = (VOLUME.dthr_m**2 - gap * gap - 25) / (-gap * 170)
            if gap * gap + 25 <= VOLUME.dthr_m**2 or tau - 0.25 <= VOLUME.tthr_s:
                return k
    raise AssertionError


def judge(scenes: list[Scene], **more: Any) -> Any:
    return judge_loss(scenes, loss_at(scenes), vehicle(1), 9, VOLUME, 15.0, 0.0, **more)


def test_traffic_that_pops_up_too_near_excuses_and_every_manoeuvre_says_why() -> None:
    scenes = head_on(9000)
    found = judge(scenes)
    assert (found.answer, found.excused, found.why) == (NO_WAY, True, "")
    assert found.moments[0].time_ms == 9000
    for moment in found.moments:
        for tried in (moment.judgement.bands, moment.judgement.check):
            assert {t.dimension for t in tried} == set(DIMENSIONS)
            assert all((t.answer, t.by) == (REFUSED, "9") for t in tried)
            assert all(t.at_s is not None and t.at_s <= 15 for t in tried)


def test_traffic_that_was_there_before_leaves_a_way_out() -> None:
    found = judge(head_on(0))
    assert (found.answer, found.excused) == (WAY_OUT, False)
    free = [t for t in found.moments[-1].judgement.bands if t.answer == FREE]
    assert free


def test_what_the_record_does_not_say_excuses_nothing() -> None:
    scenes = head_on(8500)
    # the record ends with the loss: what the other flew then is not known
    short = judge(scenes[: loss_at(scenes) + 2])
    assert (short.answer, short.excused) == (UNDECIDED, False)
    # it had been seen before: a gap of the record, not an aircraft that came to be
    gap = [Scene(s.time_ms, {**s.places, 9: (0.0, 9e4, 300.0)} if s.time_ms < 500 else s.places)
           for s in scenes]  # fmt: skip
    found = judge(gap)
    assert (found.answer, found.why) == (UNDECIDED, "the record has a gap before the loss")
    assert judge(scenes, earlier=frozenset({9})).why == "the record has a gap before the loss"
    # the record begins in the middle of the flight, with the other there already
    late = judge(head_on(9000, begin_ms=9000))
    assert (late.answer, late.why) == (UNDECIDED, "the record begins at 9 s")


def test_the_own_values_must_be_those_of_the_model() -> None:
    scenes = [
        Scene(s.time_ms, {**s.places, 1: (0.0, 0.04 * s.time_ms, 300.0)}) for s in head_on(9000)
    ]
    found = judge_loss(scenes, loss_at(scenes), vehicle(1), 9, VOLUME, 15.0, 0.0)
    assert found.answer == UNDECIDED
    assert "own hs 40 is outside of [15, 30]" in found.why


def test_a_third_that_is_lost_already_is_no_excuse() -> None:
    scenes = [
        Scene(s.time_ms, {**s.places, 5: (10.0, 0.02 * s.time_ms, 300.0)}) for s in head_on(0)
    ]
    assert judge(scenes).answer == WAY_OUT


def test_the_model_flies_as_the_simulator() -> None:
    assert ACCELERATION_M_S2 == MAX_ACCELERATION_M_S2
    p = modelled(vehicle(1), 30.1, 5.0, 20.0, 0.0, 15.0)
    assert (p.min_hs_m_s, p.max_hs_m_s, p.max_vs_m_s) == (15.0, 30.1, 5.0)
    assert (p.min_alt_m, p.max_alt_m) == (0.0, 95.0)


# -- the monitor --------------------------------------------------------------------------
@dataclass
class Envelope:
    topic: str
    time_ms: int
    body: Any


def verdicts(scenes: list[Scene], numbers: tuple[int, ...] = (1,)) -> list[Any]:
    vehicles = tuple(vehicle(n) for n in numbers)
    tasks = (Task(1, TaskKind.MUST_FLY, "", (Position(10.0, 5000.0, 300.0),)),)
    mission = Mission("m", "", Frame(45.0, -121.0), vehicles, tasks, Daa(VOLUME, 15.0))
    monitor = Monitor(mission, Plan("m", (), (), (1,), 3000, "MINMAX", 1, True))
    for s in scenes:
        for number, (east, north, up) in s.places.items():
            body = lmcp.new("TruthState", VehicleID=number, Time=s.time_ms, North=north, East=east,
                            Altitude=up)  # fmt: skip
            monitor.tap(Envelope(lmcp.full_names(body)[0], s.time_ms, body))
    body = lmcp.new("MissionEnd", Time=scenes[-1].time_ms, Outcome="complete")
    monitor.tap(Envelope(lmcp.full_names(body)[0], scenes[-1].time_ms, body))
    return [v for v in monitor.verdicts() if v.requirement == "G2" and v.item]


def test_the_monitor_excuses_with_evidence_and_the_report_shows_it() -> None:
    (found,) = verdicts(head_on(9000))
    assert found.outcome is Outcome.EXCUSED
    assert exit_code([found.outcome]) == 3
    assert "no way out existed: " in found.note
    assert found.method == "violation_within, way_out"
    (loss,) = found.evidence["losses"]
    assert (loss["own"], loss["other"], loss["answer"]) == (1, 9, "no way out")
    assert all(i[1] == i[2] > 400 and i[3] == i[4] > 400 for i in loss["instants"])
    assert len(loss["manoeuvres"]) == loss["instants"][0][1]
    assert {row[3] for row in loss["manoeuvres"]} == {"9"}
    json.dumps(found.evidence, allow_nan=False)
    rows = constraint_rows([found], "flight")
    assert rows[0]["evidence"] == found.evidence
    assert requirement_rows(rows)[1]["verdict"] == "excused"
    (shown,) = losses({"constraints": rows})
    assert [g["dimension"] for g in shown["groups"]] == list(DIMENSIONS)
    assert sum(g["count"] for g in shown["groups"]) == len(loss["manoeuvres"])
    assert shown["tried"][0] == shown["tried"][1] > 0


def test_the_monitor_names_the_way_out_that_there_was() -> None:
    (found,) = verdicts(head_on(0))
    assert found.outcome is Outcome.VIOLATED
    assert "vehicle 1 had a way out at " in found.note
    assert found.evidence["losses"][0]["way_out"]["manoeuvre"]


def test_a_loss_whose_end_is_not_recorded_is_not_excused() -> None:
    scenes = head_on(8500)
    (found,) = verdicts(scenes[: loss_at(scenes) + 2])
    assert found.outcome is Outcome.VIOLATED
    assert "no evidence that no way out existed" in found.note


def test_of_two_protected_vehicles_neither_may_have_had_a_way_out() -> None:
    # 9 is protected too, but outside of its own model: nothing can be said of its ways out
    (found,) = verdicts(head_on(9000), (1, 9))
    assert found.outcome is Outcome.VIOLATED
    assert [x["answer"] for x in found.evidence["losses"]] == ["no way out", "undecided"]


def test_an_excused_loss_does_not_excuse_the_next_one() -> None:
    scenes = head_on(9000, 120000)
    # after a while the same traffic is in front again, and in good time
    again = [
        Scene(s.time_ms, {**s.places, 9: (5.0, 400.0 - 0.15 * (s.time_ms - 100000), 300.0)}
              if s.time_ms > 60000 else s.places)
        for s in scenes
    ]  # fmt: skip
    (found,) = verdicts(again)
    assert found.outcome is Outcome.VIOLATED
    assert [x["answer"] for x in found.evidence["losses"]] == ["no way out", "a way out"]


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


SURPRISE = """
name: surprise
frame: {latitude_deg: 37.1, longitude_deg: -76.4, terrain_m: 0}
vehicles:
  - {id: 1, position: {north_m: 0, east_m: 0, alt_m: 300}, heading_deg: 0, speed_m_s: 22,
     min_speed_m_s: 15, max_speed_m_s: 33, max_bank_deg: 30, max_climb_m_s: 5}
tasks:
  - {id: 1, kind: must_fly, points: [{north_m: 1800, east_m: 0, alt_m: 300}]}
traffic:
  - {id: 9, position: {north_m: 2400, east_m: 10, alt_m: 300}, velocity: {north_m_s: -120, east_m_s: 0},
     appears_s: APPEARS}
relations: "p1"
daa: {well_clear: {dthr_m: 400, zthr_m: 60, tthr_s: 10, tcoa_s: 0}, lookahead_s: 20}
"""


def test_a_flight_is_excused_and_certified_again_from_its_log(tmp_path: Path) -> None:
    file = tmp_path / "mission.yaml"
    file.write_text(SURPRISE.replace("APPEARS", "5"))
    code = run_command(["run", str(file), "--out", str(tmp_path), "--allow-unproved", "--quiet"])
    assert code == 3
    report = json.loads((tmp_path / "surprise" / "report.json").read_text())
    (row,) = [r for r in report["constraints"] if r["requirement"] == "G2"]
    assert row["verdict"] == "excused"
    assert row["evidence"]["losses"][0]["answer"] == "no way out"
    assert "Losses of well clear" in (tmp_path / "surprise" / "report.html").read_text()
    _, differences = certify_again(tmp_path / "surprise")
    assert differences == []


# -- degenerate states --------------------------------------------------------------------
def load_scenes() -> Any:
    file = Path(__file__).with_name("daa_scenes.py")
    spec = importlib.util.spec_from_file_location("daa_scenes", file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_degenerate_states_are_answered_or_refused(p: Parameters) -> None:
    rng, scenes = random.Random(11), load_scenes()
    short = dataclasses.replace(p, lookahead_time_s=20.0, step_hdir_rad=math.radians(10),
                                step_alt_m=500.0, step_vs_m_s=5.0, step_hs_m_s=30.0)  # fmt: skip
    for _ in range(60):
        own, others = scenes.scene(rng)
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
