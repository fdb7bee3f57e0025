"""Flights of which not everything can be done: the rest goes on, and every task is accounted for."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from cratous.bridge import lmcp
from cratous.judge import judge
from cratous.services.bus import Bus
from cratous.services.campaign.changed_missions import changing_mission
from cratous.services.cli.job import Settings, plan_and_check, refuse_bad_plan, run_mission
from cratous.services.flight.chain import Phase
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.executive_state import Config, first_state
from cratous.services.flight.loop import fly
from cratous.services.flight.task_transitions import _may_begin, begin
from cratous.services.loading import load
from cratous.services.mission.frames import Projection
from cratous.services.monitor import Monitor
from cratous.services.pipeline.plan import make_plan
from cratous.spec.constraint_rows import AFTER_START
from cratous.spec.errors import NoPlan
from cratous.spec.mission import Change, Mission, Position
from cratous.spec.mission.changes import VEHICLE_JOINS, VEHICLE_LOST

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "partial" / "mission.yaml"
POPUP = ROOT / "examples" / "popup" / "mission.yaml"
LOST = ROOT / "tests" / "missions" / "lost_vehicle.yaml"


def flown(mission: Mission) -> tuple[Any, dict[str, str], list[Any]]:
    """The flight without avoidance, the monitor's rows, and what was published of tasks and changes."""
    mission, bus, said = replace(mission, instances=()), Bus(lmcp.full_names), []
    plan, checks = plan_and_check(mission, bus)
    refuse_bad_plan(checks)
    monitor = Monitor(mission, plan)
    bus.tap(monitor.tap)
    kinds = ("TaskProgress", "MissionChange", "PlanAccepted")
    bus.tap(lambda e: said.append(e.body) if e.topic.split(".")[-1] in kinds else None)
    result = fly(mission, plan, bus, daa=False)
    return result, {v.item: str(v.outcome) for v in monitor.details()}, said


def failures(said: list[Any], phase: str = "Failed") -> list[tuple[int, int, int]]:
    """(task, vehicle, instant) of each failure told, or of another phase."""
    told = [body for body in said if type(body).__name__ == "TaskProgress"]
    return [(b.TaskID, b.VehicleID, b.Time) for b in told if b.Phase.name == phase]


def test_the_example_does_what_can_be_done_and_names_the_rest() -> None:
    result, rows, said = flown(load(EXAMPLE))
    assert set(result.ends) == {2, 5}
    first = [(1, 0, 0), (3, 2, 30_000), (4, 1, 30_000), (6, 1, 60_000)]
    assert [one for one in failures(said) if one in first] == first
    # of the first the reason is another with every plan, and the last one holds
    assert [one for one in failures(said) if one not in first] == [(1, 0, 30_000), (1, 0, 60_000)]
    assert set(result.failed) == {1, 3, 4, 6}
    assert "not beside task 2" in result.failed[1]
    assert "vehicle 2: it was lost at 30.00 s" in result.failed[3]
    assert "it must wait for what is not done: `.(p3 p4)`" in result.failed[4]
    assert "its path breaks keep-out zone 9" in result.failed[6]
    for task in range(1, 7):
        assert rows[f"task {task} served"] == ("holds" if task in (2, 5) else "violated")
        assert rows[f"eligibility: task {task} in flight"] == "holds", "nobody began it who may not"
    told = [body.Consequence for body in said if type(body).__name__ == "MissionChange"]
    assert "task 3 (no vehicle can do it" in told[0]
    assert "what waits for it: 4" in told[0]
    assert "task 6 (no vehicle can do it" in told[1]
    accepted = [list(body.Tasks) for body in said if type(body).__name__ == "PlanAccepted"]
    assert accepted == [[2, 3, 4, 5, 6], [2, 5, 6], [2, 5]]


def test_a_task_left_out_is_taken_up_again_when_it_can_be_done() -> None:
    mission = load(LOST)
    back = Change(40_000, VEHICLE_JOINS, vehicle=2)
    result, rows, said = flown(replace(mission, changes=(*mission.changes, back)))
    assert (failures(said), failures(said, "Waiting")) == ([], [(2, 0, 20_000)])
    assert set(result.ends) == {1, 2}
    assert (result.outcome, result.failed) == ("complete", {})
    assert rows["task 2 served"] == "holds"


def test_a_choice_that_was_begun_is_not_made_again() -> None:
    """Vehicle 1 is lost within its task of a `+`: the other choice may not be begun any more."""
    popup = load(POPUP)
    line, tower = replace(popup.tasks[0], eligible=(1,)), replace(popup.tasks[1], eligible=(2,))
    far = replace(popup.tasks[2], points=(Position(7500.0, 8500.0, 400.0),))
    lost = Change(190_000, VEHICLE_LOST, vehicle=1)
    of = replace(
        popup, tasks=(line, tower, far), relations="|(+(p1 p3) p2)", changes=(lost,), zones=()
    )
    result, rows, _ = flown(of)
    assert result.starts.keys() == {1, 2}
    assert result.ends.keys() == {2}
    assert rows["flight: no task of another choice of the relations"] == "holds"
    assert rows["task 1 served"] == "violated"


def test_a_task_that_was_begun_and_failed_opens_nothing() -> None:
    """Of `~(|(p1 p2) p3)` p1 was begun and failed, and p2 is not begun: p3 waits for p2."""
    mission = replace(load(POPUP), changes=(), relations="~(|(p1 p2) p3)")
    plan = make_plan(mission)
    config = Config(mission, Projection(mission.frame), ())
    state = begin(config, replace(first_state(mission, plan), aircraft=at_starts(mission)), [])
    who = next(item.vehicle_id for item in plan.items if item.task_id == 3)
    items = tuple(item for item in plan.items if item.task_id == 3)
    chain = replace(state.chain(who), items=items, k=0, phase=Phase.TRANSIT)
    begun = state.begun(1, 1000)
    assert _may_begin(begun, chain, 900_000) == (None, True)
    row, may = _may_begin(begun.has_failed(1, "lost"), chain, 900_000)
    assert (row is not None and row.kind, may) == (AFTER_START, False)
    again = begun.has_failed(1, "lost").begun(2, 2000)
    assert _may_begin(again, chain, 900_000) == (None, True)


def at_starts(mission: Mission) -> tuple[tuple[int, AirState], ...]:
    return tuple(
        (v.id, AirState(v.position, v.heading_rad, v.speed_m_s, 0.0)) for v in mission.vehicles
    )


@pytest.mark.long
@pytest.mark.parametrize("seed", range(1, 201))
def test_every_task_of_a_mission_with_changes_is_accounted_for(seed: int, tmp_path: Path) -> None:
    """No internal error, no row that the independent judge contradicts, no task without a word."""
    file = tmp_path / "mission.yaml"
    file.write_text(yaml.safe_dump(changing_mission("changes", seed, 6)), encoding="utf-8")
    try:
        report = run_mission(load(file), tmp_path, Settings(allow_unproved=True))
    except NoPlan:
        return  # nothing can be done: the reasons are told
    found = judge(tmp_path)
    assert [one.line() for one in found.disagreements] == []
    rows = {r["item"]: r for r in report["constraints"] if r["requirement"] == "G3"}
    served = {entry["task"]: entry for entry in report["flight"]["served"]}
    assert report["flight"]["unserved"] == []
    for item, row in rows.items():
        if not item.startswith("task "):
            continue
        assert row["verdict"] in ("holds", "violated"), row
        entry = served[int(item.split()[1])]
        if row["verdict"] == "violated" and entry["phase"] == "Complete":
            # a search flown to its end, of which zones or the wind left too little to see: how much is told
            assert "the footprint covered" in row["note"], row
        elif row["verdict"] == "violated":
            assert (entry["phase"], bool(entry["note"])) == ("Failed", True), entry
        else:
            assert entry["phase"] == "Complete"
    unserved = any(row["verdict"] == "violated" for row in rows.values())
    assert not unserved or report["exit_code"] == 1
