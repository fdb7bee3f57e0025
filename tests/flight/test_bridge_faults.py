"""Faults of the bridge that a mission asks for: each happens, the same for the same seed, and the flight fits."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from flight_tools import meeting
from loading_tools import small

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.bridge.faults import MOST_WAITING, FaultyBridge
from cratous.judge import judge
from cratous.services.bus import Bus
from cratous.services.cli.job import Settings, run_mission
from cratous.services.flight import executive
from cratous.services.flight.dynamics import turn_radius_m
from cratous.services.flight.executive import SAFE_STATE
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.pipeline.plan import make_plan
from cratous.services.system_model.replay import replay
from cratous.spec.errors import BadInput
from cratous.spec.mission import FaultySimulation, Mission
from cratous.spec.mission.bridge_faults import BridgeFaults
from cratous.spec.mission.bridge_times import USUAL

FAULTS = {
    "loss": BridgeFaults(1, loss=0.4),
    "repeat": BridgeFaults(2, repeat=0.5),
    "reorder": BridgeFaults(3, reorder=0.5),
    "truncation": BridgeFaults(4, truncation=0.2),
    "corruption": BridgeFaults(5, corruption=0.2),
    "delay": BridgeFaults(6, delay_ms=5000),
    "forged": BridgeFaults(7, forged_modes=0.5),
    "cut": BridgeFaults(8, cut_ms=20_000),
    "reconnect": BridgeFaults(9, cut_ms=20_000, reconnect_ms=30_000),
    "stops_reading": BridgeFaults(10, stops_reading_ms=10_000),
    "reads_again": BridgeFaults(11, stops_reading_ms=10_000, reads_again_ms=40_000),
}
TOLD = ("MissionEnd", "LinkLossState", "AuthorityChange", "TruthState", "TaskProgress")


def flown(faults: BridgeFaults | None) -> tuple[Mission, list[Any]]:
    mission = replace(meeting(), simulation=replace(meeting().simulation, limit_ms=150_000))
    if faults is not None:
        simulation = FaultySimulation(limit_ms=150_000, bridge_faults=faults)
        mission = replace(mission, simulation=simulation)
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(log.append)
    fly(mission, make_plan(mission), bus)
    return mission, log


def said(log: list[Any]) -> list[str]:
    """All that is on the bus, but for what tells how late ICAROUS heard it."""
    return [repr(one.body) for one in log if type(one.body).__name__ != "UxasHeard"]


def came_down(faults: BridgeFaults, lines: int = 1) -> list[list[int]]:
    """The numbers that come down at each of 100 heartbeats, of so many lines sent at each."""
    with FaultyBridge((1,), faults) as bridge:
        found = []
        for beat in range(100):
            bridge.now_ms = 500 * beat
            for k in range(lines):
                bridge.to_icarous(1, tp.WaypointReached(lines * beat + k))
            found.append(
                [
                    one.record.index
                    for one in bridge.exchange()
                    if one.direction is tp.Direction.DOWN
                    and isinstance(one.record, tp.WaypointReached)
                ]
            )
        return found


def test_lines_are_repeated() -> None:
    found = came_down(FAULTS["repeat"])
    assert all(numbers in ([k], [k, k]) for k, numbers in enumerate(found))
    assert 30 < sum(len(numbers) == 2 for numbers in found) < 70


def test_lines_of_a_beat_change_places() -> None:
    found = came_down(FAULTS["reorder"], lines=5)
    assert all(sorted(n) == list(range(5 * k, 5 * k + 5)) for k, n in enumerate(found))
    assert any(numbers != sorted(numbers) for numbers in found)


def test_a_peer_that_does_not_read_gets_nothing_until_it_does() -> None:
    found = came_down(FAULTS["stops_reading"])
    assert found == [[k] if k < 20 else [] for k in range(100)]
    found = came_down(FAULTS["reads_again"])
    assert not any(found[20:80])
    assert found[80] == list(range(20, 81))
    assert found[81:] == [[k] for k in range(81, 100)]


def test_what_waits_for_a_peer_that_does_not_read_is_bounded() -> None:
    line = tp.Traffic("TRAFFIC", 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7)
    with FaultyBridge((1,), BridgeFaults(1, stops_reading_ms=0)) as bridge:
        sent = 0
        while bridge.to_icarous(1, line):
            sent += 1
            assert sent < 10_000
            bridge.exchange()
        assert not bridge.alive(1)
        assert MOST_WAITING < bridge.counters[tp.Direction.DOWN].bytes < MOST_WAITING + 300


@pytest.fixture(scope="module")
def usual() -> list[str]:
    return said(flown(None)[1])


@pytest.mark.parametrize("kind", FAULTS)
def test_each_fault_changes_the_flight_and_it_fits(kind: str, usual: list[str]) -> None:
    mission, log = flown(FAULTS[kind])
    found = replay(mission, True, log)
    assert found.finding is None, found.finding.text
    assert found.events["MissionEnd"] == 1
    # while nothing comes up that ICAROUS did not hear the bus has what was sent
    assert (said(log) != usual) == (kind != "reads_again")


@pytest.mark.parametrize(
    "faults",
    [
        BridgeFaults(3, loss=1.0),
        BridgeFaults(12, cut_ms=5000),
        BridgeFaults(15, stops_reading_ms=5000),
    ],
)
def test_a_flight_that_never_hears_uxas_again_is_safe_and_its_takeover_unknown(
    faults: BridgeFaults, tmp_path: Path
) -> None:
    simulation = FaultySimulation(limit_ms=150_000, bridge_faults=faults)
    report = run_mission(
        replace(meeting(), simulation=simulation), tmp_path, Settings(allow_unproved=True)
    )
    verdicts = {row["requirement"]: row["verdict"] for row in report["requirements"]}
    rows = [row for row in report["constraints"] if row["item"] == "authority over vehicle 1"]
    assert [(row["verdict"], "was never handed back" in row["note"]) for row in rows] == [
        ("unknown", True)
    ]
    assert "the link was declared down" in rows[0]["note"]
    assert (verdicts["G1"], verdicts["G2"], verdicts["G3"]) == ("holds", "holds", "violated")
    found = judge(tmp_path)
    assert found.of("G4") == "unknown"
    assert [one.line() for one in found.differences if one.guarantee == "G4"] == []


@pytest.mark.parametrize(
    ("faults", "known"),
    [
        (BridgeFaults(3, loss=1.0), False),
        (BridgeFaults(12, cut_ms=5000), True),
        (BridgeFaults(15, stops_reading_ms=5000), True),
    ],
)
def test_a_flight_that_never_hears_uxas_again_ends_in_the_declared_safe_state(
    faults: BridgeFaults, known: bool, tmp_path: Path
) -> None:
    """It flew straight on for ever, its task was called complete, and it ended at the limit."""
    simulation = FaultySimulation(limit_ms=900_000, bridge_faults=faults)
    mission = replace(meeting(), simulation=simulation)
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(log.append)
    result = fly(mission, make_plan(mission), bus)
    assert result.outcome == SAFE_STATE
    bodies = {name: [o.body for o in log if o.topic.endswith(name)] for name in TOLD}
    assert bodies["MissionEnd"][0].Outcome == SAFE_STATE
    modes = [(one.Time, one.Mode.name) for one in bodies["LinkLossState"]]
    assert [name for _, name in modes] == (["Finish", "Over"] if known else ["Loiter"])
    taken_ms = bodies["AuthorityChange"][0].Time
    assert modes[0][0] == taken_ms + USUAL.lost_link_after_ms + mission.simulation.heartbeat_ms
    assert result.end_ms == modes[-1][0] + USUAL.safe_state_after_ms
    places = [
        (one.North, one.East)
        for one in bodies["TruthState"]
        if one.VehicleID == 1 and one.Time >= modes[-1][0]
    ]
    radius_m = 1.1 * turn_radius_m(22.0, math.radians(30.0))
    middle = [sum(axis) / len(places) for axis in zip(*places, strict=True)]
    assert max(math.dist(place, middle) for place in places) < 2 * radius_m
    assert [one.Phase.name for one in bodies["TaskProgress"]][-1] == "Failed"
    assert not [one for one in bodies["TaskProgress"] if one.Phase.name == "Complete"]
    assert list(result.failed) == [1]
    assert replay(mission, True, log).finding is None


def test_vehicles_that_are_close_circle_apart_without_the_link(tmp_path: Path) -> None:
    """No circle beside another vehicle is permitted, so one flies aside first; they went round each other for ever."""
    data = yaml.safe_load(
        (Path(__file__).parents[2] / "examples/crossing/mission.yaml").read_text()
    )
    faults = {"seed": 1, "cut_s": 60}
    data |= {"link_loss": {"choice": "loiter", "after_s": 5}}
    data |= {"simulation": {"limit_s": 900, "bridge_faults": faults}}
    path = tmp_path / "mission.yaml"
    path.write_text(yaml.safe_dump({name: data[name] for name in data if name != "expect"}))
    report = run_mission(load(path), tmp_path, Settings(allow_unproved=True))
    assert report["flight"]["outcome"] == SAFE_STATE
    assert report["exit_code"] == 1
    assert "mission ended 'safe state'" in str(report["constraints"])
    verdicts = {row["requirement"]: row["verdict"] for row in report["requirements"]}
    assert (verdicts["G1"], verdicts["G2"], verdicts["G3"]) == ("holds", "holds", "violated")
    assert judge(tmp_path).of("G3") == "violated"


def test_the_kernel_decides_that_a_flight_ends_in_the_safe_state(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = list[tuple[int, ...]]()

    def no(*counts: int) -> bool:
        asked.append(counts)
        return False

    monkeypatch.setattr(executive, "ends_in_safe_state", no)
    simulation = FaultySimulation(limit_ms=260_000, bridge_faults=BridgeFaults(3, loss=1.0))
    mission = replace(meeting(), simulation=simulation)
    assert fly(mission, make_plan(mission), Bus(lmcp.full_names)).outcome == "limit"
    assert {(1, 0, 0, 0), (1, 1, 0, 0), (0, 1, 1, 0)} == set(asked)


def test_the_same_seed_gives_the_same_flight() -> None:
    assert said(flown(FAULTS["loss"])[1]) == said(flown(FAULTS["loss"])[1])


def test_a_connection_is_opened_anew() -> None:
    notes = [o.body.Note for o in flown(FAULTS["reconnect"])[1] if o.topic.endswith("BridgeStatus")]
    assert any("link lost" in note for note in notes)
    assert "connected again" in notes


@pytest.mark.parametrize(
    "section",
    [
        {"loss": 1.5},
        {"delay_s": 6},
        {"reconnect_s": 5},
        {"cut_s": 9, "reconnect_s": 9},
        {"reads_again_s": 2},
        {"gone": 1},
    ],
)
def test_what_cannot_be_is_refused(section: dict[str, float], tmp_path: Path) -> None:
    path = tmp_path / "mission.yaml"
    path.write_text(yaml.safe_dump({**small(), "simulation": {"bridge_faults": section}}))
    with pytest.raises(BadInput, match="bridge_faults"):
        load(path)


def test_it_is_told_in_the_notes_of_the_mission(tmp_path: Path) -> None:
    path = tmp_path / "mission.yaml"
    section = {"seed": 3, "loss": 0.5, "delay_s": 2, "cut_s": 9}
    path.write_text(yaml.safe_dump({**small(), "simulation": {"bridge_faults": section}}))
    mission = load(path)
    assert mission.simulation == FaultySimulation(
        bridge_faults=BridgeFaults(3, loss=0.5, delay_ms=2000, cut_ms=9000)
    )
    assert mission.notes[-1] == (
        "bridge faults are injected (seed 3): loss 0.5, delay up to 2 s, cut at 9 s"
    )
