"""Rows on a zone that moves, on tracks made by hand, by monitor and judge: when it is in force, how thin and fast it is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from flight_logs import both_of, log_of, mission_of

from cratous.services.monitor.moving_plan import check_in_time
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Mission
from cratous.spec.mission.plan import Hold
from cratous.spec.records import replace

ROW = "zone: keep_out 9, flight of vehicle 1"
END_MS = 20_000
GOOD, BAD = "holds", "violated"


def with_zone(root: Path, folder: Path, **fields: Any) -> Mission:
    """A zone 9 that moves, not where vehicle 1 is said to start."""
    zone = {"id": 9, "kind": "keep_out", "velocity_m_s": [-20, 0], "until_s": 60, **fields}
    away = {"position": {"north_m": 0, "east_m": 6000, "alt_m": 300}}
    data = yaml.safe_load((root / "tests/missions/on_failure.yaml").read_text())
    task = {**data["tasks"][0], "points": [{"north_m": 900, "east_m": 6000, "alt_m": 300}]}
    sections = {"on_failure": None, "landing_sites": None, "tasks": [task], "zones": [zone]}
    return mission_of(root, folder, vehicles=[{**data["vehicles"][0], **away}], **sections)


def box(south_m: float, north_m: float, east_m: float = 50) -> list[list[float]]:
    return [[south_m, -east_m], [north_m, -east_m], [north_m, east_m], [south_m, east_m]]


def northwards(now_ms: int) -> tuple[float, float, float]:
    return 0.02 * now_ms, 0.0, 300.0


def standing(_now_ms: int) -> tuple[float, float, float]:
    return 0.0, 0.0, 300.0


# the zone meets the vehicle half way: at 20 + 20 m/s from 1010 m on, at 25.25 s and later
FAR = box(1010, 1020)


@pytest.mark.parametrize(
    ("path", "zone", "expected"),
    [
        # they pass one another within a step: no sample is in it
        (northwards, {"vertices": box(802.1, 802.1001)}, GOOD),
        (northwards, {"vertices": box(602.1, 602.1001)}, BAD),
        (standing, {"vertices": box(352.1, 352.1001)}, BAD),
        # they touch at an instant: at 20 s the edge is where the vehicle is
        (standing, {"vertices": box(400, 500)}, BAD),
        (standing, {"vertices": box(400.001, 500)}, GOOD),
        # its edge along the way
        (northwards, {"vertices": [[700, 0], [800, 0], [800, 90], [700, 90]]}, BAD),
        (northwards, {"vertices": [[700, 0.001], [800, 0.001], [800, 90], [700, 90]]}, GOOD),
        # below its floor, at its floor
        (northwards, {"vertices": box(700, 800), "floor_m": 300.001}, GOOD),
        (northwards, {"vertices": box(700, 800), "floor_m": 300}, BAD),
        (northwards, {"vertices": box(700, 800), "ceiling_m": 300}, BAD),
        (northwards, {"vertices": box(700, 800), "ceiling_m": 299.999}, GOOD),
        # it begins upon the vehicle, and for a part of a step
        (northwards, {"vertices": box(0, 300), "from_s": 10}, BAD),
        (northwards, {"vertices": box(0, 201), "from_s": 10}, BAD),
        (northwards, {"vertices": box(150, 204), "velocity_m_s": [-20, 0], "from_s": 10.1}, BAD),
        (northwards, {"vertices": box(150, 204), "from_s": 10.1, "until_s": 10.2}, BAD),
        (northwards, {"vertices": box(320, 400), "from_s": 10.1, "until_s": 10.2}, GOOD),
        # it ends before they meet
        (northwards, {"vertices": box(601, 700), "until_s": 14.9}, GOOD),
        (northwards, {"vertices": box(601, 700), "until_s": 15.1}, BAD),
        (northwards, {"vertices": FAR}, GOOD),
    ],
)  # fmt: skip
def test_monitor_and_judge_say_the_same_of_a_zone_that_moves(
    root: Path, tmp_path: Path, path: Any, zone: dict[str, Any], expected: str
) -> None:
    mission = with_zone(root, tmp_path, **zone)
    log = log_of({1: path}, end_ms=END_MS, outcome="complete")
    assert both_of(mission, log, ROW, tmp_path) == (expected, expected)


# over (900, 6000), where the task's point is, from 200 s until 300 s
OVER = {"vertices": [[850, 5950], [850, 6050], [2850, 6050], [2850, 5950]], "from_s": 200, "until_s": 300}  # fmt: skip


def test_what_a_plan_does_between_its_ways_is_checked_too(root: Path, tmp_path: Path) -> None:
    mission = with_zone(root, tmp_path, **OVER)
    plan = make_plan(mission)
    (item,) = plan.items
    at = item.path[-1]

    def said(**fields: Any) -> str:
        made = replace(plan, items=(replace(item, **fields),))
        return "".join(check.outcome.value for check in check_in_time(mission, made))

    assert said() == GOOD
    # on the spot, or straight up, for a while
    # the path itself is after the zone's end: the wait alone meets it
    assert said(start_ms=320_000, end_ms=320_000) == "unknown"
    # so does the rim of a circle, the centre of which is beside the zone
    circle = Hold(at.north_m, at.east_m + 120.0, at.alt_m, 100.0, True)
    assert said(hold=circle, start_ms=320_000, end_ms=320_000) == "unknown"
    assert said(path=(at, at), end_ms=250_000) == "unknown"
    assert said(path=(at, at._replace(alt_m=400.0)), end_ms=250_000) == "unknown"
    assert said(path=(at, at), end_ms=199_000) == GOOD
    # after its last task, while another vehicle still has one
    other = replace(item, vehicle_id=2, end_ms=250_000)
    made = replace(plan, items=(item, other))
    assert [check.outcome.value for check in check_in_time(mission, made)] == ["unknown"]
    # before it departs, over the place where it starts
    there = replace(mission, vehicles=(replace(mission.vehicles[0], position=at),))
    late = {"depart_ms": 320_000, "arrive_ms": 350_000, "start_ms": 350_000, "end_ms": 350_000}
    made = replace(plan, items=(replace(item, transit=(), **late),))
    assert [check.outcome.value for check in check_in_time(there, made)] == ["unknown"]
