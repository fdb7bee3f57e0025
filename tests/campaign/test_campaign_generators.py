"""Missions that are made: they are missions, they meet as they say, and they fly alone to the same digest."""

from __future__ import annotations

import json
from math import atan2, degrees, hypot
from pathlib import Path
from typing import Any

import pytest

from cratous.services.campaign.definition import Campaign, load_campaign
from cratous.services.campaign.generators import KINDS, mission_of
from cratous.services.campaign.runs import Run, runs_of
from cratous.services.campaign.search import Search
from cratous.services.cli import main
from cratous.services.cli.campaign_flight import fly_run
from cratous.services.loading import load
from cratous.services.loading.document import parse_document
from cratous.spec.errors import BadInput
from cratous.spec.mission.changes import TASK_ADDED as ADDED
from cratous.spec.mission.changes import VEHICLE_LOST as LOST
from cratous.spec.mission.changes import ZONE


def made(generator: dict[str, Any], seeds: range) -> list[Run]:
    return list(runs_of(Campaign("made", generator=generator, seeds=seeds), "v", True))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("cooperative", [False, True])
def test_they_load_and_meet(kind: str, cooperative: bool, tmp_path: Path) -> None:
    data = {"kind": kind, "intruders": 2, "cooperative": cooperative, "zones_beside": 1}
    refused: list[str] = []
    for run in made(data, range(1, 9)):
        file = tmp_path / f"{run.name}.yaml"
        file.write_text(run.decides["mission"])
        try:
            mission = load(file)
        except BadInput as error:  # a draw may be no mission; a campaign counts it apart
            refused.append(error.what)
            continue
        assert (len(mission.vehicles), len(mission.traffic)) == ((3, 0) if cooperative else (1, 2))
        time_s = run.drawn["time_s"]
        own = mission.vehicles[0]
        assert own.position.north_m + own.speed_m_s * time_s == pytest.approx(0, abs=0.1)
        for k, other in enumerate(mission.traffic, 1):
            north = other.position.north_m + other.velocity.north_m_s * time_s
            east = other.position.east_m + other.velocity.east_m_s * time_s
            if kind == "random":
                expected = hypot(run.drawn[f"area_m[{2 * k - 1}]"], run.drawn[f"area_m[{2 * k}]"])
            else:
                expected = abs(run.drawn[f"miss_m[{k}]"])
            assert hypot(north, east) == pytest.approx(expected, abs=0.1)
            course = degrees(atan2(other.velocity.east_m_s, other.velocity.north_m_s))
            assert (course - run.drawn[f"angle_deg[{k}]"]) % 360 == pytest.approx(0, abs=0.01) or (
                course - run.drawn[f"angle_deg[{k}]"]
            ) % 360 == pytest.approx(360, abs=0.01)
    assert all(cooperative and "start inside each other's" in what for what in refused)
    assert len(refused) <= 4


def test_missions_with_changes_are_missions(tmp_path: Path) -> None:
    seen: set[str] = set()
    for seed in range(1, 61):
        data, draw = mission_of({"kind": "changes", "most_changes": 6}, "c", seed)
        assert mission_of({"kind": "changes"}, "c", seed)[0] == data
        file = tmp_path / f"{seed}.yaml"
        file.write_text(json.dumps(data))
        mission = load(file)
        assert 1 <= len(mission.changes) <= 6
        assert draw.drawn["changes"] == len(mission.changes)
        seen |= {change.kind for change in mission.changes} | {task.kind for task in mission.tasks}
    assert {LOST, ADDED, ZONE, "line_search", "area_search"} <= seen


@pytest.mark.parametrize(
    ("generator", "item"),
    [
        ({"kind": "changes", "intruders": 2}, "intruders"),
        ({"kind": "aimed", "most_changes": 3}, "most_changes"),
    ],
)
def test_an_item_of_another_kind_is_refused(
    generator: dict[str, Any], item: str, tmp_path: Path
) -> None:
    file = tmp_path / "campaign.yaml"
    file.write_text(json.dumps({"name": "c", "generator": generator, "seeds": [1, 2]}))
    with pytest.raises(BadInput, match="has no such item") as error:
        load_campaign(file, None, ())
    assert error.value.item == f"generator.{item}"


def test_a_zone_lies_beside_or_across() -> None:
    for seed in range(1, 20):
        data, draw = mission_of({"kind": "aimed", "zones_beside": 1, "zones_across": 1}, "z", seed)
        beside, across = ([east for _, east in zone["vertices"]] for zone in data["zones"])
        nearest = min(abs(min(beside)), abs(max(beside)))
        assert nearest == pytest.approx(draw.drawn["zone_gap_m[1]"])
        assert min(beside) * max(beside) > 0
        assert min(across) < 0 < max(across)


def test_another_range_leaves_the_other_draws() -> None:
    _, draw = mission_of({"kind": "converging"}, "a", 7)
    _, other = mission_of({"kind": "converging", "ranges": {"time_s": [50, 60]}}, "a", 7)
    assert 50 <= other.drawn.pop("time_s") <= 60
    assert other.drawn.items() <= draw.drawn.items()


def test_an_impossible_mission_says_why() -> None:
    ranges = {"zone_place": [-1, -1], "zone_gap_m": [0, 0], "zone_size_m": [400, 400]}
    (run,) = made({"kind": "aimed", "zones_across": 1, "ranges": ranges}, range(1, 2))
    found = fly_run(run.decides)
    assert found["kind"] == "impossible"
    assert "inside keep-out zone" in found["why"][0]
    assert "cratous-" not in found["why"][0], "no path of a machine"


def test_a_result_is_the_same_in_any_folder() -> None:
    """Reasons quote the relations; the folder that a run is flown in is no part of what comes of it."""
    (run,) = made({"kind": "head_on"}, range(3, 4))
    mission = run.decides["mission"] + "\nrelations: p1_[0-1000]\n"
    one, two = (fly_run({**run.decides, "mission": mission}) for _ in range(2))
    assert one == two
    assert one["kind"] == "no plan"
    assert "`p1_[0-1000]`" in one["why"][0]
    assert "mission.yaml" not in one["why"][0]


CASES = {
    "much": {"some": {"keep_in": True, "zones_beside": 1, "ranges": {"room_m": [700, 700]}}},
    "volume": {
        "small": {"set": {"daa.well_clear.dthr_m": 60}, "ranges": {"time_s": [30, 40]}},
        "large": {"intruders": 2, "ranges": {"time_s": [50, 60]}},
    },
}


def test_each_seed_draws_one_of_the_cases(tmp_path: Path) -> None:
    seen = set()
    for run in made({"kind": "aimed", "cases": CASES}, range(1, 13)):
        data, which = parse_document(run.decides["mission"], "m").data, run.drawn["volume"]
        seen.add(which)
        assert run.drawn["much"] == "some"
        assert (which == "small") == (30 <= run.drawn["time_s"] <= 40) == ("daa" in data)
        assert len(data["traffic"]) == {"small": 1, "large": 2}[which]
        keep_out, keep_in = data["zones"]
        assert (keep_out["kind"], keep_in["kind"]) == ("keep_out", "keep_in")
        way = data["tasks"][0]["points"][0]["north_m"]
        (south, west), _, (north, east), _ = keep_in["vertices"]
        assert (west, east) == (-700, 700)
        assert -south == north == pytest.approx(way + 700, abs=0.01)
    assert seen == {"small", "large"}


def test_an_intruder_that_would_start_too_near_is_drawn_anew() -> None:
    generator = {"kind": "overtaking", "intruders": 2}
    drawn_anew = 0
    for seed in range(1, 13):
        (usual, before), (far, draw) = (
            mission_of({**generator, **more}, "a", seed) for more in ({}, {"apart_m": 1100})
        )
        own = far["vehicles"][0]["position"]["north_m"]
        for one in (t["position"] for t in far["traffic"]):
            assert hypot(one["north_m"] - own, one["east_m"]) > 1100
        drawn_anew += usual["traffic"] != far["traffic"]
        same = {name for name in draw.drawn if not name.startswith(("angle", "speed"))}
        assert all(draw.drawn[name] == before.drawn[name] for name in same)
    assert drawn_anew > 3


def test_where_no_intruder_starts_so_far_away_the_campaign_is_refused() -> None:
    with pytest.raises(BadInput, match="seed 3") as error:
        made({"kind": "aimed", "apart_m": 90_000}, range(3, 4))
    assert error.value.item == "generator.apart_m"


@pytest.mark.parametrize(
    ("more", "item"), [({"cases": CASES}, "cases"), ({"apart_m": 9}, "apart_m")]
)
def test_a_search_is_in_one_space_and_draws_nothing_anew(more: dict[str, Any], item: str) -> None:
    campaign = Campaign("made", generator={"kind": "aimed", **more}, seeds=range(1, 2))
    with pytest.raises(BadInput, match="a search ") as error:
        Search(campaign, "G2", "v", True)
    assert error.value.item == f"generator.{item}"


@pytest.mark.parametrize(
    ("cases", "wrong"),
    [
        ("x: {a: {intruders: 2}}, y: {b: {intruders: 3}}", "cases.y"),
        ("x: {a: {set: {daa: {}}}}, y: {b: {set: {daa.buffer: 2}}}", "cases.y"),
        ("x: {a: {ranges: {time_s: [1, 2]}}}, y: {b: {ranges: {time_s: [3, 4]}}}", "cases.y"),
        ("time_s: {a: {intruders: 2}}", "cases.time_s"),
        (
            "x: {a: {set: {daa.buffer: 2}}, b: {set: {daa.buffer: 3}}}, y: {a: {set: {daa.buff: 1}}}",
            "",
        ),
    ],
)
def test_each_thing_says_something_else(tmp_path: Path, cases: str, wrong: str) -> None:
    file = tmp_path / "campaign.yaml"
    file.write_text(f"name: a\nseeds: [1, 2]\ngenerator: {{kind: aimed, cases: {{{cases}}}}}\n")
    if not wrong:
        assert load_campaign(file, None, ()).generator is not None
        return
    with pytest.raises(BadInput) as error:
        load_campaign(file, None, ())
    assert error.value.item == f"generator.{wrong}"


def test_one_flies_alone_to_the_same_digest(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], root: Path
) -> None:
    file = root / "examples" / "campaigns" / "aimed-1000.yaml"
    (run,) = runs_of(load_campaign(file, range(6, 7), ()), "v", True)
    assert run.drawn["volume"] == "small-cylinder"
    assert "seed: 6" in run.decides["mission"], "errors of its own"
    found = fly_run(run.decides)
    file = tmp_path / "mission.yaml"
    file.write_text(run.decides["mission"])
    main(["run", str(file), "--allow-unproved", "--json", "--out", str(tmp_path / "out")])
    alone = json.loads(capsys.readouterr().out)
    assert found["log"] == alone["digest"]
    assert found["mission_hash"] == alone["mission_hash"]
    assert found["judge"]["disagreements"] == []
    assert found["takeovers"] == alone["takeovers"] >= 1
