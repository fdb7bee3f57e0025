"""Of a line or an area that zones cover in part the rest is planned, flown, and said with its share."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.judge import judge
from cratous.services.bus import Bus
from cratous.services.cli.job import Settings, refuse_bad_plan, run_mission
from cratous.services.cli.plan_lines import left_out_lines
from cratous.services.loading import load
from cratous.services.monitor.plan_check import PART, WHOLE, check_plan
from cratous.services.pipeline.plan import make_plan
from cratous.spec.errors import NoPlan
from cratous.spec.mission import Mission, Position, Zone, ZoneKind
from cratous.spec.mission.guarantees import Outcome
from cratous.spec.mission.plan import PartialPlan, in_part_of, left_out_of

MISSIONS = Path(__file__).resolve().parents[1] / "missions"


def wall(south: float, north: float, half_m: float = 3500.0) -> Zone:
    corners = ((south, -half_m), (south, half_m), (north, half_m), (north, -half_m))
    return Zone(12, ZoneKind.KEEP_OUT, corners, 0.0, 10_000.0, 0.0)


def line_with(*zones: Zone) -> Mission:
    """The line from north 1000 m to 5000 m, then a point beyond it."""
    return replace(load(MISSIONS / "line_cut.yaml"), zones=zones, changes=())


def test_the_part_of_a_line_outside_of_a_zone_is_planned_and_told() -> None:
    mission, bus, said = line_with(wall(2000, 3500)), Bus(lmcp.full_names), []
    bus.tap(lambda e: said.append(e.body))
    plan = make_plan(mission, bus)
    (part,) = in_part_of(plan)
    assert (part.task_id, part.zones, left_out_of(plan)) == (7, (12,), ())
    assert part.outside == pytest.approx(1 - 1500 / 4000, abs=0.005)
    assert part.outside - 0.1 < part.share < part.outside + 0.15
    # what comes after it goes on
    assert [item.task_id for item in plan.items] == [7, 8]
    assert all(first_bad_leg(item.path, mission.zones) is None for item in plan.items)
    checks = {check.item: check for check in check_plan(mission, plan)}
    assert checks[WHOLE].outcome is Outcome.VIOLATED
    assert checks[PART].outcome is Outcome.HOLDS
    assert "in part: task 7 (planned: " in checks[WHOLE].note
    refuse_bad_plan(list(checks.values()))
    (told,) = left_out_lines(plan)
    assert told.startswith(
        f"in part: task 7 (planned: {1000 * part.share // 1 / 10:.1f} % of it; 62."
    )
    assert "outside of keep-out zone 12" in told
    answer = next(b for b in said if type(b).__name__ == "AutomationResponse")
    assert any(pair.Value.startswith("in part: task 7") for pair in answer.Info)
    status = [
        b for b in said if type(b).__name__ == "ServiceStatus" and b.StatusType.name == "Warning"
    ]
    facts = [{pair.Key: pair.Value for pair in body.Info} for body in status]
    assert [(f["TaskID"], f["zones"], float(f["share"])) for f in facts] == [
        ("7", "12", pytest.approx(part.share, abs=1e-4))
    ]


def test_what_a_camera_sees_from_beside_the_zone_is_the_whole_line() -> None:
    plan = make_plan(line_with(wall(2000, 2030, 100)))
    assert not isinstance(plan, PartialPlan)
    assert [item.task_id for item in plan.items] == [7, 8]


@pytest.mark.parametrize("zone", [wall(500, 6000), wall(900, 4900)])
def test_a_line_of_which_no_part_can_be_flown_is_left_out_as_a_whole(zone: Zone) -> None:
    """Within the zone, or up to a rest that is too short to turn to and from."""
    with pytest.raises(NoPlan, match="breaks keep-out zone 12") as error:
        make_plan(line_with(zone))
    assert "in part" not in str(error.value)


def test_a_keep_in_leaves_the_part_within_it() -> None:
    corners = ((-2000.0, -3000.0), (-2000.0, 3000.0), (3000.0, 3000.0), (3000.0, -3000.0))
    keep_in = Zone(12, ZoneKind.KEEP_IN, corners, 0.0, 10_000.0, 0.0)
    mission = line_with(keep_in)
    near = replace(mission.tasks[1], points=(Position(1000.0, 1500.0, 400.0),))
    plan = make_plan(replace(mission, tasks=(mission.tasks[0], near)))
    (part,) = in_part_of(plan)
    assert part.outside == pytest.approx(0.5, abs=0.01)
    assert "keep-in zone 12" in part.text


def test_a_vehicle_that_can_do_all_of_it_goes_before_one_that_can_do_a_part() -> None:
    mission = line_with(replace(wall(2000, 3500), ceiling_m=500.0))
    (low,) = mission.vehicles
    place = Position(-3000.0, 4000.0, 700.0)
    high = replace(low, id=2, position=place, label="high", cruise_m=700.0)
    plan = make_plan(
        replace(mission, vehicles=(low, high), relations="p7", tasks=mission.tasks[:1])
    )
    assert not isinstance(plan, PartialPlan)
    assert [item.vehicle_id for item in plan.items] == [2]


def run(mission: Mission, folder: Path) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    report = run_mission(mission, folder, Settings(allow_unproved=True))
    return report, {row["item"]: row for row in report["constraints"]}


def test_a_zone_that_appears_on_a_line_leaves_the_rest_to_fly(tmp_path: Path) -> None:
    report, rows = run(load(MISSIONS / "line_cut.yaml"), tmp_path)
    row, after = rows["task 7 served"], rows["task 8 served"]
    assert (row["verdict"], after["verdict"], report["exit_code"]) == ("violated", "holds", 1)
    assert report["flight"]["outcome"] == "failed", "what was asked for is not all done"
    assert "49.8 % of it lies outside of keep-out zone 12" in row["note"]
    (outside,) = row["evidence"]["outside_zones"]
    assert outside["share"] == pytest.approx(0.5, abs=0.01)
    assert {key: outside[key] for key in ("vehicles", "zones")} == {"vehicles": [1], "zones": [12]}
    (end,) = (one for one in report["flight"]["served"] if one["task"] == 7)
    assert end["phase"] == "Complete"
    assert "in part: task 7 (planned: " in end["note"]
    assert 0.4 < end["served"] < 0.65
    zone = next(row for item, row in rows.items() if item.startswith("zone: keep_out 12, flight"))
    assert zone["verdict"] == "holds"
    found = judge(tmp_path)
    assert [one.line() for one in found.disagreements] == []
    (said,) = (row.note for row in found.rows if row.item == "task 7 served")
    assert "about 50 % of it lies in zone 12" in said


def test_the_part_of_an_area_outside_of_a_zone_is_flown(tmp_path: Path) -> None:
    mission = load(MISSIONS / "area_cut.yaml")
    plan = make_plan(mission)
    (part,) = in_part_of(plan)
    whole_m2, zone_m2 = 2000 * 2000, 800 * 800
    assert part.outside == pytest.approx(1 - zone_m2 / whole_m2, abs=0.01)
    assert part.outside < part.share < 0.95
    report, rows = run(mission, tmp_path)
    row = rows["task 7 served"]
    assert (row["verdict"], report["exit_code"]) == ("violated", 1)
    assert row["margin"] == pytest.approx(100 * part.share - 99, abs=1.5)
    assert [one.line() for one in judge(tmp_path).disagreements] == []
