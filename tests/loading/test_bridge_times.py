"""`bridge.lost_link_after_s` and `bridge.safe_state_after_s`: loaded, bounded, listed, logged, and read by the judge."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from cratous.judge.fields import Node
from cratous.judge.mission import from_log
from cratous.judge.mission_file import read as judge_read
from cratous.services.certify import rejudge
from cratous.services.loading import load
from cratous.services.logs.records import from_data, to_data
from cratous.services.parameters.listing import parameters_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import LivePlanningMission, Mission, TimedBridgeMission
from cratous.spec.mission.bridge_times import USUAL, BridgeTimes


def written(root: Path, folder: Path, **more: Any) -> Path:
    data = yaml.safe_load((root / "examples/crossing/mission.yaml").read_text())
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump({**data, **more}))
    return path


def test_the_times_are_those_of_the_file_and_of_its_log(root: Path, tmp_path: Path) -> None:
    path = written(root, tmp_path, bridge={"lost_link_after_s": 2.5, "safe_state_after_s": 45})
    mission = load(path)
    assert mission.bridge_times == BridgeTimes(2500, 45_000)
    assert not mission.live_planning
    again = from_data(Mission, to_data(mission))
    assert isinstance(again, TimedBridgeMission)
    assert again == mission
    for judged in (judge_read(path), from_log(Node(to_data(mission), "log", "mission"))):
        assert (judged.lost_link_after_ms, judged.safe_state_after_ms) == (2500, 45_000)


@pytest.mark.parametrize("name", ["lost_link_after_ms", "safe_state_after_ms"])
@pytest.mark.parametrize("time_ms", [-1, 0])
def test_a_log_with_times_that_are_none_is_refused(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, time_ms: int
) -> None:
    path = written(root, tmp_path, bridge={"lost_link_after_s": 2.5, "safe_state_after_s": 45})
    mission = to_data(load(path))
    meta = {"mission": {**mission, "bridge": {**mission["bridge"], name: time_ms}}, "plan": {}}
    monkeypatch.setattr(rejudge, "read_meta", lambda log: meta)
    with pytest.raises(BadInput) as wrong:
        rejudge.subject(tmp_path / "log.jsonl")
    assert (wrong.value.item, wrong.value.expected) == ("Mission.bridge", "times of more than 0 ms")
    assert "log.jsonl, meta" in wrong.value.where
    with pytest.raises(BadInput, match=name):
        from_log(Node(meta["mission"], "log", "mission"))


def test_a_mission_without_them_is_the_one_that_it_was(root: Path, tmp_path: Path) -> None:
    path = written(root, tmp_path, bridge={"lost_link_after_s": 30, "safe_state_after_s": 120})
    mission = load(path)
    assert type(mission) is Mission
    assert mission.bridge_times == USUAL
    for judged in (judge_read(path), from_log(Node(to_data(mission), "log", "mission"))):
        usual = USUAL.lost_link_after_ms, USUAL.safe_state_after_ms
        assert (judged.lost_link_after_ms, judged.safe_state_after_ms) == usual


@pytest.mark.parametrize("times", [{}, {"safe_state_after_s": 60}])
def test_they_go_with_live_planning(root: Path, tmp_path: Path, times: dict[str, Any]) -> None:
    mission = load(written(root, tmp_path, bridge={"uxas_route_planner": True, **times}))
    assert isinstance(mission, LivePlanningMission)
    assert mission.live_planning
    assert mission.bridge_times.safe_state_after_ms == (60_000 if times else 120_000)
    assert from_data(Mission, to_data(mission)) == mission


@pytest.mark.parametrize(
    ("more", "item", "what"),
    [
        ({"bridge": {"lost_link_after_s": 0.5}}, "bridge.lost_link_after_s", "1"),
        ({"bridge": {"lost_link_after_s": 3601}}, "bridge.lost_link_after_s", "3600"),
        ({"bridge": {"safe_state_after_s": 29}}, "bridge.safe_state_after_s", "30"),
        ({"bridge": {"safe_state_after_s": 1e9}}, "bridge.safe_state_after_s", "3600"),
        (
            {"bridge": {"lost_link_after_s": 1}, "simulation": {"heartbeat_ms": 1000}},
            "bridge.lost_link_after_s",
            "2 heartbeats",
        ),
        (
            {"bridge": {"lost_link_after_s": 9}, "link_loss": {"choice": "loiter"}},
            "bridge.lost_link_after_s",
            "no section link_loss beside it",
        ),
    ],
)
def test_what_says_nothing_is_refused(
    root: Path, tmp_path: Path, more: dict[str, Any], item: str, what: str
) -> None:
    with pytest.raises(BadInput) as wrong:
        load(written(root, tmp_path, **more))
    assert item in str(wrong.value)
    assert what in str(wrong.value)


def test_they_are_listed_with_bounds_and_defaults(root: Path, tmp_path: Path) -> None:
    path = written(root, tmp_path, bridge={"safe_state_after_s": 45})
    rows = {row.name: row for row in parameters_of(load(path), path)}
    safe, lost = rows["bridge.safe_state_after_s"], rows["bridge.lost_link_after_s"]
    assert (safe.value, safe.default, safe.low, safe.high) == (45, 120, 30, 3600)
    assert (lost.value, lost.default, lost.low, lost.high) == (30, 30, 1, 3600)
    assert safe.origin != lost.origin
