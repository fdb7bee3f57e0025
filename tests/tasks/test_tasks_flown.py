"""Searches in flight: cameras that zoom and look, and tasks served by their footprints."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from task_tools import area, mission

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.cli.job import plan_and_check
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.mission.sensor import look_on_line, sample_distance_m, zoomed
from cratous.services.monitor import Monitor
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Camera, Position, Task, View
from cratous.spec.mission.guarantees import Outcome

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "search" / "mission.yaml"
SMALL = ((0.0, 0.0), (0.0, 500.0), (400.0, 600.0), (450.0, 0.0))


def flown(task: Task, edit: Any = None) -> dict[str, Any]:
    of = mission(task)
    plan = make_plan(of)
    monitor, bus = Monitor(of, plan), Bus(lmcp.full_names)

    def tap(envelope: Any) -> None:
        if edit is not None:
            edit(envelope.body)
        monitor.tap(envelope)

    bus.tap(tap)
    fly(of, plan, bus)
    return {v.item: v for v in monitor.verdicts()}


def test_a_camera_zooms_in_as_far_as_asked_and_no_further() -> None:
    wide = Camera(pixels=640, zoom_rad=(0.1, 0.3), zooms=True)
    task = area(gsd_m=0.3)
    assert zoomed(wide, area(), 400.0) == wide
    fine = zoomed(wide, task, 400.0)
    assert sample_distance_m(fine, None, 400.0) == pytest.approx(0.3)
    steps = zoomed(replace(wide, zooms=False), task, 400.0)
    assert steps.hfov_rad == 0.3
    assert sample_distance_m(steps, None, 400.0) < 0.3
    assert zoomed(wide, area(gsd_m=0.01), 400.0) == wide


def test_a_camera_looks_at_the_line_where_its_view_does_whichever_way_it_is_flown() -> None:
    line = (Position(0.0, 0.0, 0.0), Position(2000.0, 0.0, 0.0))
    ahead = View(0.0, math.radians(-45), False)
    at = (1000.0, 30.0)
    assert look_on_line(at, 0.0, line, ahead, 300.0) == pytest.approx((1300, 0), abs=11)
    assert look_on_line(at, math.pi, line, ahead, 300.0) == pytest.approx((700, 0), abs=11)
    assert look_on_line(at, 0.0, line, None, 300.0) == pytest.approx((1000, 0), abs=11)
    assert look_on_line((1900.0, 0.0), 0.0, line, ahead, 300.0) == pytest.approx((2000, 0), abs=11)


def test_a_line_with_bends_is_covered_by_a_gimbal_that_cannot_look_down(tmp_path: Path) -> None:
    file = tmp_path / "mission.yaml"
    file.write_text(
        """
name: bends
frame: {latitude_deg: 45.3, longitude_deg: -121.0, terrain_m: 0}
vehicles:
  - {id: 1, position: {north_m: -1500, east_m: 0, alt_m: 300}, heading_deg: 0, speed_m_s: 24,
     min_speed_m_s: 15, max_speed_m_s: 30, max_bank_deg: 20, max_climb_m_s: 5, cameras: [
       {payload_id: 1, hfov_deg: 22, min_elevation_deg: -45, max_elevation_deg: -45}]}
tasks:
  - {id: 1, kind: line_search, points: [{north_m: 0, east_m: 0}, {north_m: 300, east_m: 1400},
     {north_m: 1400, east_m: 1700}, {north_m: 1460, east_m: 1710}, {north_m: 2900, east_m: 1450}]}
""",
        encoding="utf-8",
    )
    mission, bus = replace(load(file), instances=()), Bus(lmcp.full_names)
    plan, _ = plan_and_check(mission, bus)
    monitor = Monitor(mission, plan)
    bus.tap(monitor.tap)
    fly(mission, plan, bus, daa=False)
    (served,) = [v for v in monitor.details() if v.item == "task 1 served"]
    assert served.outcome is Outcome.HOLDS
    assert "footprint covered" in served.note


def test_an_area_is_served_by_the_footprints_of_its_flight() -> None:
    verdict = flown(area(SMALL))["task 1 served"]
    assert verdict.outcome is Outcome.HOLDS, verdict.note
    assert verdict.method == "square_within on footprints"
    assert "covered 100.00 %" in verdict.note


def test_an_area_whose_footprints_miss_a_part_is_not_served() -> None:
    def blind(body: Any) -> None:
        if body.type_name.endswith("AirVehicleState"):
            for payload in body.PayloadStateList:
                north = [(c.Latitude - 45.0) * 111_000 for c in payload.Footprint or ()]
                if north and max(north) > 300:
                    payload.Footprint = []

    verdict = flown(area(SMALL), blind)["task 1 served"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.margin < -1


def test_an_area_of_which_all_is_seen_near_the_horizon_is_not_served() -> None:
    to_horizon = ((0.5, -0.5), (0.5, 0.5), (-0.1, 0.5), (-0.1, -0.5))

    def ahead(body: Any) -> None:
        if body.type_name.endswith("AirVehicleState"):
            for payload in body.PayloadStateList:
                for corner, (north, east) in zip(payload.Footprint or (), to_horizon, strict=False):
                    corner.Latitude, corner.Longitude = 45.0 + north, -120.0 + east

    verdict = flown(area(SMALL), ahead)["task 1 served"]
    assert verdict.outcome is Outcome.VIOLATED
    assert "covered 0.00 %" in verdict.note


@pytest.mark.long
def test_the_example_is_flown_and_every_search_covered(tmp_path: Path) -> None:
    of = load(EXAMPLE)
    plan = make_plan(of)
    monitor, bus = Monitor(of, plan), Bus(lmcp.full_names)
    bus.tap(monitor.tap)
    fly(of, plan, bus)
    assert len(of.tasks) == 13
    bad = [v for v in monitor.verdicts() if v.outcome is not Outcome.HOLDS]
    assert bad == []
