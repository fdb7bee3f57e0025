"""Campaigns of encounters: flown as a whole flight flies them, judged, the same by however many workers."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import seeded_faults
import yaml
from campaign_tools import loss_found
from seeded_faults import seeded

from cratous.judge.encounter import judge_encounter
from cratous.services.campaign.definition import Campaign, load_campaign
from cratous.services.campaign.encounters import states_of
from cratous.services.campaign.generators import mission_of
from cratous.services.campaign.outcomes import outcome_of
from cratous.services.campaign.runs import runs_of
from cratous.services.cli import main
from cratous.services.cli.encounter_flight import fly_run
from cratous.services.flight.encounter import Encounter, fly_encounter
from cratous.services.loading import load
from cratous.spec.errors import BadInput

GENERATOR = {"kind": "converging", "ranges": {"time_s": [35, 50]}}
PLACE = {"north_m": 500, "east_m": 0, "alt_m": 300}
HEAD = "name: trial\nkind: encounters\n"


def _written(folder: Path, generator: dict[str, Any], seed: int, **more: Any) -> Path:
    data, _ = mission_of(generator, "trial", seed)
    file = folder / "mission.yaml"
    file.write_text(yaml.safe_dump({**data, "simulation": {"limit_s": 60}, **more}))
    return file


def _campaign(folder: Path, text: str) -> Campaign:
    file = folder / "campaign.yaml"
    file.write_text(HEAD + text)
    return load_campaign(file, None, ())


SENSING = {
    "seed": 3,
    "sensors": [
        {"kind": "gps", "horizontal_m": 3, "vertical_m": 5, "velocity_m_s": 0.3},
        {"kind": "adsb", "horizontal_m": 10, "vertical_m": 8, "velocity_m_s": 1, "latency_s": 0.4, "drop_out": 0.2},
    ],
}  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "zones", "more"),
    [("converging", 0, {}), ("aimed", 2, {}), ("converging", 0, {"sensing": SENSING})],
)
def test_it_is_flown_as_a_whole_flight_is(
    tmp_path: Path, kind: str, zones: int, more: dict[str, Any]
) -> None:
    """To the millimetre, takeover and handback included."""
    from cratous.services.cli.job import new_bus, plan_and_check
    from cratous.services.flight.loop import fly

    generator = {**GENERATOR, "kind": kind, "zones_beside": zones}
    mission = load(_written(tmp_path, generator, 2, **more))
    alone = fly_encounter(mission)
    bus, whole = new_bus(), dict[int, tuple[float, ...]]()

    def tap(envelope: Any) -> None:
        name, body = envelope.topic.rpartition(".")[2], envelope.body
        if name == "TruthState" and body.VehicleID == 1:
            whole[body.Time] = (body.North, body.East, body.Altitude)

    bus.tap(tap)
    plan, _ = plan_and_check(mission, bus)
    result = fly(mission, plan, bus)
    assert alone.takeovers == result.takeovers == 1
    for now_ms, aircraft in alone.instants:
        apart = math.dist(dict(aircraft)[1].position, whole[now_ms])
        assert apart < 0.001, now_ms


def test_without_avoidance_well_clear_is_lost(tmp_path: Path) -> None:
    campaign = _campaign(
        tmp_path,
        "generator: {kind: head_on, ranges: {time_s: [30, 40]}}\nseeds: [1, 2]\n"
        "options: [{name: avoiding}, {name: bare, daa: false}]\n",
    )
    results = [fly_run(run.decides) for run in runs_of(campaign, "v", True)]
    verdicts = [result["requirements"]["G2"]["verdict"] for result in results]
    assert verdicts == ["holds", "violated"] * 2
    for result in results:
        assert result["judge"]["disagreements"] == []
        assert result["judge"]["guarantees"]["G2"] == result["requirements"]["G2"]["verdict"]
        assert result["end_ms"] == 60_000
        assert result["takeovers"] == (result["requirements"]["G2"]["verdict"] == "holds")


def _bent(folder: Path) -> tuple[Path, Encounter]:
    ranges = {"time_s": [30, 40], "bend_m": [60, 160]}
    file = _written(folder, {"kind": "random", "intruders": 0, "bends": 6, "ranges": ranges}, 1)
    return file, fly_encounter(load(file))


def test_points_are_judged_by_where_the_vehicle_was(tmp_path: Path) -> None:
    file, flown = _bent(tmp_path)
    assert flown.reached[1] >= 4
    (row,) = judge_encounter(file, states_of(flown), flown.reached)[-1:]
    assert (row.guarantee, row.verdict, row.checks) == ("G3", "holds", flown.reached[1])
    # the same flight does not pass what is moved away, nor more points than there are
    data = yaml.safe_load(file.read_text())
    data["tasks"][1]["points"][0]["east_m"] -= 200
    file.write_text(yaml.safe_dump(data))
    assert judge_encounter(file, states_of(flown), flown.reached)[-1].verdict == "violated"
    assert judge_encounter(file, states_of(flown), {1: 50})[-1].verdict == "unknown"
    assert judge_encounter(file, states_of(flown), {})[-1].verdict == "unknown"


def test_of_points_that_were_not_reached_nothing_is_said_to_hold(tmp_path: Path) -> None:
    campaign = _campaign(tmp_path, "generator: {kind: converging}\nseeds: [1, 1]\nduration_s: 2\n")
    (run,) = runs_of(campaign, "v", True)
    result = fly_run(run.decides)
    assert result["requirements"]["G3"]["verdict"] == "unknown"
    assert "no point was reached" in result["requirements"]["G3"]["note"]
    assert outcome_of(result, ("G2", "G3")) == "unknown"


def test_without_a_protected_vehicle_nothing_is_flown(tmp_path: Path) -> None:
    campaign = _campaign(
        tmp_path,
        "generator: {kind: converging}\nseeds: [1, 1]\n"
        "options: [{name: bare, set: {'vehicles[0].protected': false}}]\n",
    )
    (run,) = runs_of(campaign, "v", True)
    result = fly_run(run.decides)
    assert result["kind"] == "impossible"
    assert "a protected one" in result["why"][0]


@pytest.mark.parametrize("others", ["traffic: []", "'traffic[0].appears_s': 1000"])
def test_who_meets_nobody_is_no_disagreement(tmp_path: Path, others: str) -> None:
    campaign = _campaign(
        tmp_path,
        "generator: {kind: converging}\nseeds: [1, 1]\nduration_s: 2\n"
        f"options: [{{name: alone, set: {{{others}}}}}]\n",
    )
    (run,) = runs_of(campaign, "v", True)
    result = fly_run(run.decides)
    assert result["requirements"]["G2"]["verdict"] == "holds"
    assert result["judge"]["disagreements"] == []


def test_points_out_of_turn_are_violated(tmp_path: Path) -> None:
    file, flown = _bent(tmp_path)
    data = yaml.safe_load(file.read_text())
    data["tasks"][1:3] = reversed(data["tasks"][1:3])
    file.write_text(yaml.safe_dump(data))
    assert judge_encounter(file, states_of(flown), flown.reached)[-1].verdict == "violated"


def test_a_gap_in_what_was_seen_is_unknown(tmp_path: Path) -> None:
    file, flown = _bent(tmp_path)
    holed = flown._replace(instants=flown.instants[:50] + flown.instants[60:])
    row = judge_encounter(file, states_of(holed), flown.reached)[-1]
    assert (row.guarantee, row.verdict) == ("G3", "unknown")
    with pytest.raises(BadInput, match="nobody was seen"):
        judge_encounter(file, {}, {})
    with pytest.raises(BadInput, match="states"):
        judge_encounter(file, {1: [[0, 1.0]]}, {1: 0})


@pytest.mark.parametrize(
    ("more", "item"),
    [
        ({"relations": "p1"}, "relations"),
        ({"changes": [{"at_s": 1, "vehicle_lost": 1}]}, "changes"),
        ({"simulation": {"bridge_faults": {"seed": 1, "loss": 0.5}}}, "bridge_faults"),
        ({"tasks": [{"id": 1, "kind": "loiter", "points": [PLACE], "duration_s": 9}]}, "task 1"),
        ({"tasks": [{"id": 1, "kind": "must_fly", "points": [PLACE]}]}, "task 1"),
    ],
)
def test_what_an_encounter_does_not_fly_is_refused(
    tmp_path: Path, more: dict[str, Any], item: str
) -> None:
    with pytest.raises(BadInput, match="along points") as refused:
        fly_encounter(load(_written(tmp_path, GENERATOR, 1, **more)))
    assert item in str(refused.value)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("requirements: [G5]\n", "G5"),
        ("judge: false\n", "always judged"),
        ("duration_s: 0\n", "duration_s"),
        ("kind: missions\nduration_s: 9\n", "no duration"),
        ("generator: {kind: changes}\n", "no changes"),
    ],
)
def test_bad_campaigns_of_encounters_are_named(tmp_path: Path, text: str, named: str) -> None:
    base = "" if "generator" in text else "generator: {kind: aimed}\n"
    file = tmp_path / "campaign.yaml"
    head = HEAD.replace("kind: encounters\n", "") if "kind: missions" in text else HEAD
    file.write_text(head + base + text + "seeds: [1, 2]\n")
    with pytest.raises(BadInput, match=named):
        load_campaign(file, None, ())


def test_a_kind_and_a_duration_are_another_run(tmp_path: Path) -> None:
    one = _campaign(tmp_path, "generator: {kind: aimed}\nseeds: [1, 1]\n")
    others = replace(one, duration_s=61.0), replace(one, kind="missions")
    names = {run.id for c in (one, *others) for run in runs_of(c, "v", False)}
    assert len(names) == 3


@pytest.mark.long
def test_the_number_of_workers_changes_nothing_and_what_is_stored_is_not_flown_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("distributed")
    file = tmp_path / "campaign.yaml"
    file.write_text(f"{HEAD}generator: {{kind: converging, ranges: {{time_s: [35, 50]}}}}\n")
    texts = []
    for name, seeds, workers in (("one", "1-3", "1"), ("one", "1-8", "1"), ("two", "1-8", "2")):
        arguments = ["campaign", str(file), "--seeds", seeds, "--workers", workers]
        arguments += ["--reports", "1", "--allow-unproved", "-o", str(tmp_path / name)]
        assert main(arguments) in (0, 3)
        capsys.readouterr()
        texts.append((tmp_path / name / "campaign.json").read_bytes())
    assert texts[1] == texts[2]
    (mission,) = (tmp_path / "two" / "flights").iterdir()
    assert mission.suffix == ".yaml"
    assert load(mission).simulation.limit_ms == 60_000


def test_a_separation_that_is_too_small_is_refused_and_found(tmp_path: Path) -> None:
    """Five per cent less than the volume that is asked for: no proof vouches for it, and an encounter with two shows it."""
    campaign = _campaign(
        tmp_path,
        "generator: {kind: converging, intruders: 2, ranges: {time_s: [20, 50]}}\nseeds: [22, 22]\n"
        "options: [{name: narrow, set: {daa.buffer: 1.02}}]\n",
    )
    (asked,), (allowed,) = (list(runs_of(campaign, "v", allow)) for allow in (False, True))
    right = fly_run(allowed.decides)
    assert right["requirements"]["G2"]["verdict"] == "holds"
    with seeded("separation"):
        refused, wrong = fly_run(asked.decides), fly_run(allowed.decides)
    assert refused["kind"] == "refused"
    assert "not its file's" in refused["why"][0]
    assert not wrong["proved"]
    assert wrong["requirements"]["G2"]["verdict"] == "violated"
    assert wrong["judge"]["guarantees"]["G2"] == "violated"
    assert outcome_of(wrong, ("G2",)) == "violated"
    assert outcome_of({**right, "proved": False}, ("G2",)) == "unknown"


def test_zones_not_seen_after_a_takeover_are_found(tmp_path: Path) -> None:
    campaign = _campaign(
        tmp_path,
        "generator: {kind: converging, zones_beside: 2,\n"
        "            ranges: {time_s: [30, 50], zone_gap_m: [2, 25], zone_place: [-0.7, 0]}}\n"
        "duration_s: 50\nseeds: [1, 1]\n",
    )
    (run,) = runs_of(campaign, "v", True)
    right = fly_run(run.decides)
    with seeded("zone"):
        wrong = fly_run(run.decides)
    for result, verdict in ((right, "holds"), (wrong, "violated")):
        assert result["requirements"]["G1"]["verdict"] == verdict
        assert result["judge"]["guarantees"]["G1"] == verdict


def test_a_skipped_point_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file, _ = _bent(tmp_path)
    data = yaml.safe_load(file.read_text())
    data["tasks"][2]["points"][0]["east_m"] = -50.0  # the others lie to the right
    file.write_text(yaml.safe_dump(data))
    flown = fly_encounter(load(file))
    assert judge_encounter(file, states_of(flown), flown.reached)[-1].verdict == "holds"
    monkeypatch.setattr(
        seeded_faults, "is_skipped", lambda path: path[len(path) // 2].east_m == -50.0
    )
    with seeded("waypoint"):
        flown = fly_encounter(load(file))
    assert flown.reached[1] >= 4
    row = judge_encounter(file, states_of(flown), flown.reached)[-1]
    assert row.verdict == "violated"
    assert "point 3 of" in row.note


def test_a_file_of_states_is_an_encounter(tmp_path: Path, root: Path) -> None:
    """The first step of the file, in its own words: 150 kt north, one head-on and one from the right."""
    states = root / "examples" / "encounters" / "two_intruders.daa"
    wide = "{dthr_m: 1219.2, zthr_m: 137.16, tthr_s: 35, tcoa_s: 0}"
    vary = f"vary: [{{item: daa.well_clear, values: [{wide}]}}, {{item: daa.lookahead_s, values: [120]}}]"
    campaign = _campaign(
        tmp_path,
        f"missions: ['{states}']\nduration_s: 150\nseeds: [1, 1]\n{vary}\n"
        "options: [{name: avoiding}, {name: bare, daa: false}]\n",
    )
    avoiding, bare = (fly_run(run.decides) for run in runs_of(campaign, "v", True))
    assert avoiding["requirements"]["G2"]["verdict"] == "holds"
    assert bare["requirements"]["G2"]["verdict"] == "violated"
    run = next(runs_of(campaign, "v", True))
    data = yaml.safe_load(run.decides["mission"])
    assert run.mission == "two_intruders"
    assert data["vehicles"][0]["speed_m_s"] == pytest.approx(150 * 1852 / 3600, abs=1e-6)
    north, east = data["traffic"]
    assert north["position"]["north_m"] == pytest.approx(10 * 1852)
    assert north["velocity"]["north_m_s"] == pytest.approx(-180 * 1852 / 3600)
    assert north["velocity"]["down_m_s"] == pytest.approx(150 * 0.3048 / 60)
    assert east["velocity"]["east_m_s"] == pytest.approx(-200 * 1852 / 3600)
    assert east["position"]["alt_m"] == pytest.approx(5100 * 0.3048)


@pytest.mark.parametrize(
    ("kind", "text", "named"),
    [
        ("missions", None, "no whole mission"),
        (
            "encounters",
            "NAME sx sy sz vx vy vz time\nown 0 0 900 0 40 0 0\n",
            "no intruder in the first step",
        ),
        ("encounters", "nonsense\n", "states.daa"),
    ],
)
def test_bad_files_of_states_are_named(
    tmp_path: Path, root: Path, kind: str, text: str | None, named: str
) -> None:
    known = root / "examples" / "encounters" / "two_intruders.daa"
    (tmp_path / "states.daa").write_text(known.read_text() if text is None else text)
    file = tmp_path / "campaign.yaml"
    file.write_text(f"name: trial\nkind: {kind}\nmissions: [states.daa]\n")
    with pytest.raises(BadInput, match=named):
        load_campaign(file, None, ())


@pytest.mark.slow
def test_a_search_finds_an_encounter_and_its_file_shows_it_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ranges = "{kind: head_on, ranges: {time_s: [30, 40]}}"
    runs = "seeds: [5, 6]\noptions: [{name: bare, daa: false}]\n"
    out = loss_found(tmp_path, f"{HEAD}generator: {ranges}\n{runs}")
    assert "trial-bare-seed5, after 1 runs" in capsys.readouterr().out
    case = out / "found-G2.yaml"
    assert "in this encounter (flown without avoidance)" in case.read_text()
    mission = load(case)
    again = judge_encounter(case, states_of(fly_encounter(mission, daa=False)), {1: 0})
    assert [row.verdict for row in again if row.guarantee == "G2"] == ["violated"]
