"""A flight that ends in the declared safe state: monitor and judge check by positions that each vehicle circled."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import yaml
from flight_tools import meeting
from ground_tools import Flown, flown_of

from cratous.bridge import lmcp
from cratous.judge import safe_state as judge_safe_state
from cratous.judge.mission import Mission as JudgedMission
from cratous.services.flight import executive
from cratous.services.icarous.route_end import TURN_MARGIN
from cratous.services.loading import load
from cratous.services.monitor import Monitor, safe_state
from cratous.services.pipeline.plan import make_plan
from cratous.services.system_model.replay import replay
from cratous.spec.mission import FaultySimulation, Zone, ZoneKind
from cratous.spec.mission.bridge_faults import BridgeFaults
from cratous.spec.mission.bridge_times import USUAL

ROW = "circle of vehicle 1 at the end"
Bodies = Callable[[str, dict[str, Any], int], dict[str, Any] | None]


@pytest.fixture(scope="module")
def circles() -> Flown:
    faults = BridgeFaults(12, cut_ms=5000)
    simulation = FaultySimulation(limit_ms=900_000, bridge_faults=faults)
    return flown_of(replace(meeting(), simulation=simulation))


def changed(flight: Flown, change: Bodies) -> list[Any]:
    """The log with changed messages; None leaves one out."""
    found = []
    for one in flight.log:
        name = one.topic.rpartition(".")[2]
        fields = {f: getattr(one.body, f) for f in FIELDS.get(name, ())}
        new = change(name, fields, flight.result.end_ms) if fields else fields
        if new is not None:
            body = lmcp.new(name, **new) if fields and new != fields else one.body
            found.append(SimpleNamespace(topic=one.topic, time_ms=one.time_ms, body=body))
    return found


FIELDS = {
    "TruthState": ("VehicleID", "Time", "North", "East", "Altitude", "Heading", "VelocityNorth", "VelocityEast", "VelocityDown"),
    "LinkLossState": ("VehicleID", "Time", "Mode", "Chosen", "Heard", "Reason"),
    "GateState": ("VehicleID", "Time", "Owner", "Epoch", "Offered"),
    "MissionEnd": ("Time", "Outcome"),
}  # fmt: skip


def straight(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    """In the last 20 s it flies straight on."""
    if name != "TruthState" or body["VehicleID"] != 1 or body["Time"] <= end_ms - 20_000:
        return body
    far_m = 22.0 * (body["Time"] - end_ms + 20_000) / 1000
    return {**body, "North": body["North"] + far_m, "VelocityNorth": 22.0, "VelocityEast": 0.0}


def not_said(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any] | None:
    return None if name == "LinkLossState" else body


def straight_and_said_fast(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    """A greater speed than it can fly allows no wider circle."""
    body = straight(name, body, end_ms)
    if name == "TruthState" and body["Time"] > end_ms - 20_000:
        return {**body, "VelocityEast": 2000.0}
    return body


def triangle(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    """No two places are farther apart than the diameter, and not all are within the radius of the middle."""
    start_ms = end_ms - 130_000
    if name != "TruthState" or body["VehicleID"] != 1 or body["Time"] < start_ms:
        return body
    speed_m_s, side_m = 22.0, 187.0
    turns, along_m = divmod((body["Time"] - start_ms) * speed_m_s / 1000 + 1e-6, side_m)
    rad = [k * math.tau / 3 for k in range(int(turns) % 3 + 1)]
    far_m = [side_m] * (len(rad) - 1) + [along_m]
    north = sum(m * math.cos(r) for m, r in zip(far_m, rad, strict=True))
    east = sum(m * math.sin(r) for m, r in zip(far_m, rad, strict=True))
    going = {
        "VelocityNorth": speed_m_s * math.cos(rad[-1]),
        "VelocityEast": speed_m_s * math.sin(rad[-1]),
    }
    return {**body, "North": north, "East": east, **going}


def said_late(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    return {**body, "Time": end_ms - 60_000} if name == "LinkLossState" else body


def said_to_end(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    """It is said to circle first, and to fly on after that."""
    if name != "LinkLossState":
        return body
    return {**body, "Mode": "Finish" if body["Mode"].name in ("Over", "Loiter") else "Loiter"}


def not_seen(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any] | None:
    gap = name == "TruthState" and end_ms - 60_000 < body["Time"] < end_ms - 50_000
    return None if gap else body


def not_seen_at_all(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any] | None:
    return None if name == "TruthState" and body["VehicleID"] == 1 else body


def nobody(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any] | None:
    return None if name == "GateState" else body


def other_end(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    return {**body, "Outcome": "complete"} if name == "MissionEnd" else body


def test_the_circles_are_seen_in_the_positions(circles: Flown, tmp_path: Path) -> None:
    found = circles.verdicts()[ROW]
    assert (found.requirement, found.outcome.value) == ("G5", "holds")
    assert found.checks > 400
    assert found.margin is not None
    assert 15 < found.margin <= safe_state.MARGIN_M
    assert circles.judged(tmp_path)[ROW] == "holds"


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (straight, "violated"),
        (straight_and_said_fast, "violated"),
        (triangle, "unknown"),
        (not_said, "violated"),
        (said_late, "violated"),
        (said_to_end, "violated"),
        (nobody, "violated"),
        (not_seen, "unknown"),
        (not_seen_at_all, "unknown"),
        (other_end, None),
    ],
)
def test_monitor_and_judge_agree_on_what_is_no_circle(
    circles: Flown, change: Bodies, expected: str | None, tmp_path: Path
) -> None:
    log = changed(circles, change)
    found = circles.verdicts(log).get(ROW)
    assert (None if found is None else found.outcome.value) == expected
    assert circles.judged(tmp_path, log).get(ROW) == expected


def test_a_failure_that_the_mission_does_not_ask_about_removes_no_row(
    circles: Flown, tmp_path: Path
) -> None:
    body = lmcp.new("FailureState", VehicleID=1, Time=circles.result.end_ms, Failure="Ended")
    forged = SimpleNamespace(topic="cratous.FailureState", time_ms=body.Time, body=body)
    log = [*circles.log[:-1], forged, circles.log[-1]]
    assert circles.verdicts(log)[ROW].outcome.value == "holds"
    assert circles.judged(tmp_path, log)[ROW] == "holds"


@pytest.mark.parametrize(("since_s", "expected"), [(0, "violated"), (1, "holds")])
def test_a_zone_that_the_circle_breaks(
    circles: Flown, since_s: int, expected: str, tmp_path: Path
) -> None:
    """since_s: 0: around the place at the end; 1: around a place outside of the circle."""
    last = [one for one in circles.told("TruthState") if one.VehicleID == 1][-1]
    north, east = last.North + 1000 * since_s, last.East
    ring = tuple((north + a, east + b) for a, b in ((-9, -9), (9, -9), (9, 9), (-9, 9)))
    zone = Zone(7, ZoneKind.KEEP_OUT, ring, 0.0, 1000.0)
    flight = circles._replace(mission=replace(circles.mission, zones=(zone,)))
    assert flight.verdicts()[ROW].outcome.value == expected
    assert flight.judged(tmp_path)[ROW] == expected


def test_what_cannot_bank_flies_no_circle(circles: Flown, tmp_path: Path) -> None:
    """A log can say that: it was an internal error."""
    flat = tuple(replace(one, max_bank_rad=0.0) for one in circles.mission.vehicles)
    plan = make_plan(circles.mission)
    mission = replace(circles.mission, vehicles=flat)
    monitor = Monitor(mission, plan)
    for one in circles.log:
        monitor.tap(one)
    assert [v.outcome.value for v in monitor.verdicts() if v.item == ROW] == ["violated"]
    assert circles._replace(mission=mission).judged(tmp_path)[ROW] == "violated"


def sooner(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    """It is said to circle only in the last 32 s, longer than this mission asks for and shorter than usual."""
    if name == "LinkLossState" and body["Mode"].name in ("Over", "Loiter"):
        return {**body, "Time": end_ms - 32_000}
    return body


def test_the_mission_says_how_long_the_silence_and_the_circle_last(
    root: Path, tmp_path: Path
) -> None:
    data = yaml.safe_load((root / "examples/crossing/mission.yaml").read_text())
    del data["expect"]
    data |= {"bridge": {"lost_link_after_s": 6, "safe_state_after_s": 31}}
    data |= {"simulation": {"limit_s": 900, "bridge_faults": {"seed": 1, "cut_s": 25}}}
    path = tmp_path / "mission.yaml"
    path.write_text(yaml.safe_dump(data))
    flight = flown_of(load(path))
    assert flight.result.outcome == safe_state.SAFE_STATE
    modes = flight.told("LinkLossState")
    first, last = modes[0], [one for one in modes if one.Mode.name == "Over"][-1]
    assert first.Time - first.Heard in range(6000, 8001)
    assert flight.result.end_ms - last.Time in range(31_000, 31_501)
    assert any("6 s of silence" in note for note in flight.mission.notes)
    item = f"circle of vehicle {last.VehicleID} at the end"
    assert flight.verdicts()[item].outcome.value == flight.judged(tmp_path)[item] == "holds"
    log = changed(flight, sooner)
    usual = flight._replace(mission=replace(flight.mission, bridge=USUAL))
    assert flight.verdicts(log)[item].outcome.value == flight.judged(tmp_path, log)[item] == "holds"
    assert (
        usual.verdicts(log)[item].outcome.value == usual.judged(tmp_path, log)[item] == "violated"
    )


@pytest.fixture(scope="module")
def unfailing(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Flown:
    data = yaml.safe_load((root / "examples/crossing/mission.yaml").read_text())
    del data["expect"]
    data |= {"on_failure": {"choice": "hold"}}
    data |= {"simulation": {"limit_s": 900, "bridge_faults": {"seed": 1, "cut_s": 25}}}
    path = tmp_path_factory.mktemp("unfailing") / "mission.yaml"
    path.write_text(yaml.safe_dump(data))
    return flown_of(load(path))


def test_without_the_link_vehicles_circle_also_where_the_mission_says_what_follows_a_failure(
    unfailing: Flown, tmp_path: Path
) -> None:
    """Nothing was flown by them without the link, and the flight ended at its limit."""
    assert unfailing.result.outcome == safe_state.SAFE_STATE
    assert not unfailing.told("FailureState")
    assert {one.Mode.name for one in unfailing.told("LinkLossState")} == {"Finish", "Over"}
    verdicts, judged = unfailing.verdicts(), unfailing.judged(tmp_path)
    for vehicle in (1, 2):
        for item in (
            f"circle of vehicle {vehicle} at the end",
            f"what vehicle {vehicle} does after a failure",
        ):
            assert (verdicts[item].outcome.value, judged[item]) == ("holds", "holds"), item
    assert replay(unfailing.mission, True, unfailing.log).finding is None


def too_soon(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    """UxAS was heard just before."""
    return {**body, "Heard": body["Time"] - 500} if name == "LinkLossState" else body


def other_choice(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any]:
    return {**body, "Chosen": "Loiter"} if name == "LinkLossState" else body


def out_of_order(name: str, body: dict[str, Any], end_ms: int) -> dict[str, Any] | None:
    """The first mode is that of an end."""
    left_out = name == "LinkLossState" and str(getattr(body["Mode"], "name", "")) == "Finish"
    return None if left_out else body


@pytest.mark.parametrize("change", [too_soon, other_choice, out_of_order])
def test_what_is_flown_without_the_link_has_a_reason_before_a_failure(
    unfailing: Flown, change: Bodies, tmp_path: Path
) -> None:
    log, item = changed(unfailing, change), "what vehicle 1 does after a failure"
    assert unfailing.verdicts(log)[item].outcome.value == "violated"
    assert unfailing.judged(tmp_path, log)[item] == "violated"


def test_forged_failures_are_no_way_out_of_the_row(unfailing: Flown, tmp_path: Path) -> None:
    end_ms = unfailing.result.end_ms
    forged = [
        SimpleNamespace(
            topic="cratous.FailureState",
            time_ms=end_ms,
            body=lmcp.new("FailureState", VehicleID=k, Time=end_ms, Failure="Ended"),
        )
        for k in (1, 2)
    ]
    log = [*unfailing.log[:-1], *forged, unfailing.log[-1]]
    verdicts, judged = unfailing.verdicts(log), unfailing.judged(tmp_path, log)
    for item in (ROW, ROW.replace("1", "2"), "what vehicle 1 does after a failure"):
        assert (verdicts[item].outcome.value, judged[item]) == ("violated", "violated"), item


def test_what_is_compared_is_what_is_flown() -> None:
    assert executive.SAFE_STATE == safe_state.SAFE_STATE == judge_safe_state.SAFE_STATE
    assert TURN_MARGIN == safe_state.WIDER == judge_safe_state.WIDER
    assert JudgedMission.lost_link_after_ms == USUAL.lost_link_after_ms
    assert JudgedMission.safe_state_after_ms == USUAL.safe_state_after_ms
    assert safe_state.MARGIN_M == judge_safe_state.MARGIN_M
