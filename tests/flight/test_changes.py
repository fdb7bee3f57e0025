"""What becomes known in flight: the mission as known, new plans, and what is watched from when."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.cli.job import plan_and_check
from cratous.services.flight.loop import fly
from cratous.services.flight.replan_triggers import orders_missed
from cratous.services.loading import load
from cratous.services.monitor import Monitor
from cratous.spec.errors import BadInput
from cratous.spec.mission import Change, Mission, Zone, ZoneKind, changes
from cratous.spec.mission.changes import known_at, split, words
from cratous.spec.mission.guarantees import Outcome

POPUP = Path(__file__).resolve().parents[2] / "examples" / "popup" / "mission.yaml"


def flown(mission: Mission) -> tuple[Any, Monitor, list[Any]]:
    """The flight without avoidance, the monitor, and what was published of changes and plans."""
    mission, bus, said = replace(mission, instances=()), Bus(lmcp.full_names), []
    plan, checks = plan_and_check(mission, bus)
    assert {check.outcome for check in checks} == {Outcome.HOLDS}
    monitor = Monitor(mission, plan)
    bus.tap(monitor.tap)
    bus.tap(lambda e: said.append(e.body) if e.topic in TOPICS else None)
    return fly(mission, plan, bus, daa=False), monitor, said


TOPICS = ("cratous.MissionChange", "cratous.PlanAccepted")


def test_the_mission_is_known_piece_by_piece() -> None:
    mission = load(POPUP)
    at = [known_at(mission, ms) for ms in (0, 15_000, 60_000, 100_000)]
    assert [len(m.zones) for m in at] == [1, 2, 2, 2]
    assert [[v.id for v in m.vehicles] for m in at] == [[1, 2], [1, 2], [1], [1]]
    assert [[t.id for t in m.tasks] for m in at] == [[1, 2, 4], [1, 2, 4], [1, 2], [1, 2, 3]]
    assert [m.relations for m in at] == ["|(.(p1) p2 p4)"] * 2 + ["|(.(p1) p2)", "|(.(p1 p3) p2)"]
    # a task that was flown before it was withdrawn stays
    assert 4 in {t.id for t in known_at(mission, 60_000, [4]).tasks}
    due, left = split(mission.changes, 60_000)
    assert [words(change) for change in due] == [
        "keep-out zone 9 (fire) appears",
        "vehicle 2 is lost",
        "task 4 is removed",
    ]
    assert [change.kind for change in left] == [changes.TASK_ADDED]


@pytest.fixture(scope="module")
def popup() -> tuple[Any, Monitor, list[Any]]:
    return flown(load(POPUP))


def test_each_change_is_planned_for_and_its_reason_is_told(popup: Any) -> None:
    result, _, said = popup
    told = [body for body in said if type(body).__name__ == "MissionChange"]
    assert [body.Time for body in told] == [15_000, 60_000, 100_000]
    assert told[0].Consequence == "planned anew: the way of vehicle 1 breaks keep-out zone 9 (fire)"
    assert told[1].Consequence == (
        "planned anew: vehicle 2 leaves tasks 4, 2; task 2 to vehicle 1; task 4 left out"
    )
    assert result.outcome == "complete"
    assert result.replans == 3
    assert set(result.ends) == {1, 2, 3}
    accepted = [list(body.Tasks) for body in said if type(body).__name__ == "PlanAccepted"]
    assert accepted == [[1, 2, 4], [1, 2, 4], [1, 2], [1, 2, 3]]


def test_a_zone_is_watched_from_when_it_is_known(popup: Any) -> None:
    _, monitor, _ = popup
    details = monitor.details()
    assert not [v for v in details if v.outcome is Outcome.VIOLATED]
    fire = next(v for v in details if v.item == "zone: keep_out 9, flight of vehicle 1")
    always = next(v for v in details if v.item == "zone: keep_in 1, flight of vehicle 1")
    assert 0 < fire.checks < always.checks
    assert fire.margin is not None
    assert fire.margin > 0


def test_a_zone_beside_all_ways_leaves_the_plan_as_it_is() -> None:
    mission = load(POPUP)
    far = Zone(
        8, ZoneKind.KEEP_OUT, ((7000.0, 8000.0), (7000.0, 8500.0), (7500.0, 8500.0)), 0.0, 9e3
    )
    short = replace(
        mission,
        changes=(Change(2_000, changes.ZONE, zone=far),),
        tasks=tuple(t for t in mission.tasks if t.id == 3),
        relations="",
    )
    result, _, said = flown(short)
    told = [body for body in said if type(body).__name__ == "MissionChange"]
    assert [body.Consequence for body in told] == ["the plan holds as it is"]
    assert result.replans == 0
    assert result.outcome == "complete"


def test_without_a_plan_what_is_left_fails_by_name() -> None:
    mission = load(POPUP)
    ring = ((5000.0, 600.0), (5000.0, 1800.0), (6200.0, 1800.0), (6200.0, 600.0))
    short = replace(
        mission,
        changes=(Change(2_000, changes.ZONE, zone=Zone(8, ZoneKind.KEEP_OUT, ring, 0.0, 9e3)),),
        tasks=tuple(t for t in mission.tasks if t.id == 3),
        relations="",
    )
    result, monitor, said = flown(short)
    assert result.outcome == "failed"
    assert "keep-out zone 8" in result.failed[3]
    told = [body.Consequence for body in said if type(body).__name__ == "MissionChange"]
    assert told[0].startswith("no plan for what is left")
    verdicts = {v.requirement: v.outcome for v in monitor.verdicts()[:5]}
    # nobody began it, so nobody did who may not
    assert verdicts["G1"] is Outcome.HOLDS
    assert verdicts["G3"] is Outcome.VIOLATED
    # nothing holds that no kernel decided
    held = [v for v in monitor.details() if v.outcome is Outcome.HOLDS]
    assert "nobody began it" in {v.note for v in held}
    assert all(v.kernels for v in held)


@pytest.mark.parametrize(
    ("entry", "item"),
    [
        ({"at_s": 5, "vehicle_lost": 7}, "changes[4].vehicle_lost"),
        ({"at_s": 5, "task_removed": 77}, "changes[4].task_removed"),
        ({"at_s": 5}, "changes[4]"),
        ({"at_s": 5, "task_removed": 1, "vehicle_lost": 1}, "changes[4]"),
        ({"at_s": -5, "task_removed": 1}, "changes[4].at_s"),
        ({"at_s": 5, "zone": {"id": 1, "kind": "keep_out", "vertices": [[0, 0]]}}, "zone"),
    ],
)
def test_a_change_of_what_does_not_exist_is_refused(
    tmp_path: Path, entry: dict[str, Any], item: str
) -> None:
    data = yaml.safe_load(POPUP.read_text(encoding="utf-8"))
    data["changes"].append(entry)
    file = tmp_path / "mission.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    with pytest.raises(BadInput) as caught:
        load(file)
    assert item in str(caught.value)


@pytest.mark.parametrize(
    ("relations", "starts", "ends", "missed"),
    [
        ("~(p2 p1)", {1: 59_130}, {1: 60_000}, True),
        (".(p2 p1)", {1: 59_130}, {1: 60_000}, True),
        ("~(p2 p1)", {}, {}, False),
        ("~(p1 p2)", {1: 59_130}, {1: 60_000}, False),
        # another task had opened it
        ("~(|(p2 p4) p1)", {4: 100, 1: 59_130}, {}, False),
        ("~(+(p2 p4) p1)", {4: 100, 1: 59_130}, {}, False),
    ],
)
def test_an_order_that_a_late_task_finds_broken_is_told(
    relations: str, starts: dict[int, int], ends: dict[int, int], missed: bool
) -> None:
    known = replace(load(POPUP), changes=(), relations=relations)
    told = orders_missed(known, [Change(70_000, changes.TASK_ADDED, task=2)], starts, ends)
    assert bool(told) == missed
    if missed:
        assert told.endswith("cannot be kept any more: task 1 began at 59.13 s")
