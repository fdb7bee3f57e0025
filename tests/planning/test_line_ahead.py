"""Lines of UxAS tasks, looked at straight down or from before each place."""

from __future__ import annotations

from math import radians, tan
from pathlib import Path

import pytest
from pipeline_tools import request, vehicle

from cratous.bridge import lmcp
from cratous.services.loading.uxas import mission_of
from cratous.services.loading.uxas_cfg import Configuration, Sent
from cratous.services.planning.options import expand
from cratous.services.planning.targets import Angles, chosen_view


@pytest.mark.parametrize(
    ("least_deg", "gsd_m", "ahead"), [(-90.0, 0.0, True), (-60.0, 0.0, False), (-90.0, 0.5, False)]
)
def test_a_line_may_be_looked_at_from_before_it(
    tmp_path: Path, least_deg: float, gsd_m: float, ahead: bool
) -> None:
    """Where cameras can do both and no view is asked for; the path that ends earlier is then flown."""
    ways = [lmcp.new("Location3D", Latitude=n) for n in (0.03, 0.05)]
    line = lmcp.new("LineSearchTask", TaskID=5, PointList=ways, GroundSampleDistance=gsd_m)
    configuration, state = vehicle(1)
    gimbal, _ = configuration.PayloadConfigurationList
    gimbal.MinElevation = least_deg
    cfg = Configuration(
        tmp_path / "cfg.xml",
        {},
        (),
        tuple(Sent(body, "x", 0) for body in (configuration, state, line, request(5))),
        (),
    )
    mission = mission_of(cfg, "x")
    (task,) = mission.tasks
    assert (task.view, bool(task.views)) == (None, ahead)
    if gsd_m:
        return
    options, _ = expand(mission, [task], ())
    labels = {option.label for option in options}
    assert ("forward, view 2" in labels) == (ahead or least_deg > -85)
    if ahead:
        down, off = (next(o for o in options if o.label == f"forward, view {k}") for k in (1, 2))
        assert chosen_view(task, Angles(down.view_elevation_rad, down.view_azimuth_rad)) is None
        assert (
            chosen_view(task, Angles(off.view_elevation_rad, off.view_azimuth_rad)) == task.views[0]
        )
        early_m = 300 / tan(radians(60))  # flown 300 m above the ground
        assert down.end.north_m - off.end.north_m == pytest.approx(early_m, abs=1)
        assert down.start.north_m - off.start.north_m == pytest.approx(early_m, abs=1)
