"""Whether a recorded loss is excused: judged from the record, by the monitor, in the report."""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from mission_tools import must_fly, plain_mission, plain_vehicle

from cratous.bridge import lmcp
from cratous.core.daa.state import DIMENSIONS
from cratous.core.excuse.record import ACCELERATION_M_S2, Record, Scene, judge_loss, modelled
from cratous.core.excuse.state import FREE, NO_WAY, REFUSED, UNDECIDED, WAY_OUT
from cratous.services.certify.html import losses
from cratous.services.certify.rejudge import certify_again
from cratous.services.certify.verdicts import constraint_rows, requirement_rows
from cratous.services.cli import main as run_command
from cratous.services.mission.landing import MAX_ACCELERATION_M_S2
from cratous.services.monitor import Monitor
from cratous.spec.daa.parameters import Parameters
from cratous.spec.daa.presets import preset
from cratous.spec.mission import Daa, Position, Traffic, Vehicle, Velocity, WellClear
from cratous.spec.mission.guarantees import Outcome, exit_code
from cratous.spec.mission.plan import Plan

VOLUME = WellClear(400.0, 60.0, 10.0, 0.0)
FAST = (0.0, -150.0)


@pytest.fixture(scope="module")
def p() -> Parameters:
    return dataclasses.replace(preset("do_365b").parameters, lookahead_time_s=90.0)


def vehicle(number: int, protected: bool = True) -> Vehicle:
    return plain_vehicle(number, Position(0.0, 0.0, 300.0), protected)


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
    record = Record(scenes, **more)
    return judge_loss(record, loss_at(scenes), vehicle(1), 9, VOLUME, 15.0, 0.0)


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
    found = judge_loss(Record(scenes), loss_at(scenes), vehicle(1), 9, VOLUME, 15.0, 0.0)
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
    tasks = (must_fly(1, (10.0, 5000.0, 300.0)),)
    there = [s.time_ms for s in scenes if 9 in s.places]
    still = Velocity(0.0, 0.0, 0.0)
    others = tuple(
        Traffic(9, Position(0.0, 0.0, 0.0), still, ms) for ms in there[:1] if 9 not in numbers
    )
    mission = plain_mission(vehicles, tasks, daa=Daa(VOLUME, 15.0), traffic=others)
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


# -- a flight -----------------------------------------------------------------------------
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
    assert certify_again(tmp_path / "surprise").found == []
