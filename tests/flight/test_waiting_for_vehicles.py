"""Tasks whose vehicle joins later: they wait for it by name, and are not said to have failed before it is there."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.cli.job import plan_and_check
from cratous.services.cli.plan_lines import left_out_lines
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.monitor import Monitor
from cratous.spec.mission import Change, Mission, Zone, ZoneKind
from cratous.spec.mission.changes import VEHICLE_JOINS, VEHICLE_LOST, ZONE, ZoneEnd
from cratous.spec.mission.plan import left_out_of

MISSION = Path(__file__).resolve().parents[1] / "missions" / "lost_vehicle.yaml"
NOT_ITS = "vehicle 1: the task does not name it eligible"
NOT_YET = f"no vehicle that may do it is there yet: {NOT_ITS}; vehicle 2: it joins only at 30.00 s"
JOINS = Change(30_000, VEHICLE_JOINS, vehicle=2)


def mission_with(*changes: Change, **more: Any) -> Mission:
    return replace(load(MISSION), changes=changes, instances=(), **more)


def flown(mission: Mission) -> tuple[list[tuple[str, str]], dict[str, str], Any]:
    """The phases of task 2 with their notes, how each assumption stands, and the plan at first."""
    bus, said = Bus(lmcp.full_names), list[tuple[str, str]]()
    plan, _ = plan_and_check(mission, bus)
    monitor = Monitor(mission, plan)
    bus.tap(monitor.tap)

    def hear(envelope: Any) -> None:
        body = envelope.body
        if envelope.topic.endswith("TaskProgress") and body.TaskID == 2:
            said.append((body.Phase.name, body.Note))

    bus.tap(hear)
    fly(mission, plan, bus, daa=False)
    return said, {row["name"]: row["state"] for row in monitor.assumptions()}, plan


def test_a_task_whose_vehicle_is_not_there_yet_waits_for_it_and_is_flown() -> None:
    said, states, plan = flown(mission_with(JOINS))
    (left,) = left_out_of(plan)
    assert (left.task_id, left.reason, left.waits) == (2, NOT_YET, True)
    assert left_out_lines(plan)[0] == f"waits for a vehicle: task 2 ({NOT_YET})"
    assert said[0] == ("Waiting", f"waits, as vehicle 2 joins at 30.00 s: {NOT_YET}")
    phases = [phase for phase, _ in said]
    assert "Failed" not in phases
    assert phases[-1] == "Complete"
    assert states["settled tasks"] == "held"


def test_a_task_fails_once_nobody_is_to_come_any_more() -> None:
    """The one that joins is not the one that is needed."""
    lost = Change(10_000, VEHICLE_LOST, vehicle=2)
    here = load(MISSION)
    other = replace(
        here.vehicles[1], id=3, position=here.vehicles[1].position._replace(east_m=9000)
    )
    joins = Change(30_000, VEHICLE_JOINS, vehicle=3)
    said, states, _ = flown(mission_with(lost, joins, vehicles=(*here.vehicles, other)))
    lost_s = "vehicle 2: it was lost at 10.00 s"
    told = [one for one in said if one[0] in ("Waiting", "Failed")]
    assert [phase for phase, _ in told] == ["Waiting", "Failed"]
    assert told[0][1].startswith("waits, as vehicle 3 joins at 30.00 s: no vehicle can do it: ")
    assert told[1][1].startswith("left out: no vehicle can do it: ")
    assert all(lost_s in note for _, note in told)
    assert states["settled tasks"] == "held"


@pytest.mark.parametrize("limit_ms", [20_000, 600_000])
def test_a_task_that_waits_for_the_end_of_a_zone_is_flown_after_it_or_fails_with_its_reason(
    limit_ms: int,
) -> None:
    corners = ((2300.0, 5800.0), (2300.0, 6200.0), (2700.0, 6200.0), (2700.0, 5800.0))
    zone = Zone(9, ZoneKind.KEEP_OUT, corners, 0.0, 5000.0)
    mission = mission_with(Change(5_000, ZONE, zone=zone), ZoneEnd(40_000, "zone_ends", zone_id=9))
    simulation = replace(mission.simulation, limit_ms=limit_ms)
    said, states, _ = flown(replace(mission, simulation=simulation))
    (waits,) = [note for phase, note in said if phase == "Waiting" and note]
    assert waits.startswith("waits, as zone 9 ends at 40.00 s: ")
    assert states["settled tasks"] == "held"
    reason = waits.partition(": ")[2]
    assert said[-1] == (
        ("Complete", "") if limit_ms > 40_000 else ("Failed", f"left out: {reason}")
    )
