"""Which footprints count for a search (G3): those of the simulator's own gimbals and cameras, from where they were."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from mission_tools import plain_mission
from task_tools import vehicle

from cratous.bridge import lmcp
from cratous.judge import searches, views
from cratous.services.exporting.messages import configuration_of
from cratous.services.mission import required_views
from cratous.services.mission.frames import Projection
from cratous.services.mission.required_views import middle
from cratous.services.monitor.counted_footprints import looks_of
from cratous.services.monitor.coverage import CoverageWatch
from cratous.services.simulator.motion import Motion
from cratous.services.simulator.payload import gimbals_of, states
from cratous.spec.mission import Camera, Frame, Mission, Position, Task, TaskKind, View

ROAD = (Position(-900.0, 0.0, 0.0), Position(2500.0, 0.0, 0.0))
PLANE = Projection(Frame(37.1, -76.4))
HEIGHT_M = 300.0


def down(elevation_deg: float) -> View:
    return View(0.0, math.radians(elevation_deg))


def watched(*views: View, camera: Camera | None = None, **asked: Any) -> Mission:
    """A road that vehicle 1 searches."""
    view = views[0] if views else None
    road = Task(1, TaskKind.LINE_SEARCH, "road", ROAD, view=view, views=views[1:], **asked)
    flyer = vehicle((camera or Camera(),), HEIGHT_M)
    return plain_mission((flyer,), (road,), frame=Frame(37.1, -76.4))


def state(mission: Mission, north_m: float, elevation_deg: float, fov_deg: float = 45.0) -> Any:
    """What the simulator tells of the vehicle as it flies north with its gimbal at an elevation."""
    latitude, longitude = PLANE.to_geodetic(north_m, 0.0)
    place = (math.radians(latitude), math.radians(longitude), HEIGHT_M)
    motion = Motion(*place, 0.0, 0.0, 0.0, 22.0, 22.0, 0.0, 0.0, 100.0, 0.0)
    (gimbal,) = gimbals_of(configuration_of(mission.vehicles[0]), "here")
    (camera,) = gimbal.cameras
    gimbal = gimbal._replace(
        elevation_deg=elevation_deg, cameras=(camera._replace(fov_deg=fov_deg),)
    )
    at = lmcp.new("Location3D", Latitude=latitude, Longitude=longitude, Altitude=HEIGHT_M)
    told = [one for one in states((gimbal,), motion, 0.0) if type(one).__name__ == "CameraState"]
    number = mission.vehicles[0].cameras[0].payload_id
    told = [one.copy(PayloadID=number) for one in told]
    return lmcp.new("AirVehicleState", ID=1, Location=at, PayloadStateList=told)


def seen(mission: Mission, north_m: float, elevation_deg: float, fov_deg: float = 45.0) -> float:
    """How much of the road one look sees."""
    watch = CoverageWatch(mission)
    watch.state(state(mission, north_m, elevation_deg, fov_deg), [1])
    share = watch.fraction(1)
    assert share is not None
    return share


def test_a_look_ahead_at_the_whole_road_sees_nothing_of_it_where_the_task_asks_for_one_down() -> (
    None
):
    mission = watched(down(-90))
    told = state(mission, -2200, -13.4)
    (look,) = looks_of(told, mission.vehicles[0].cameras, PLANE)
    assert max(n for n, _ in look.corners) > 50_000  # to the horizon, over all of the road
    assert seen(mission, -2200, -13.4) == 0
    assert seen(mission, -1285, -38) == 0


def test_a_look_down_on_the_road_sees_what_is_below() -> None:
    mission = watched(down(-90))
    assert seen(mission, 0, -90) == pytest.approx(180 / 3400, abs=0.01)
    assert seen(mission, 0, -70) > 0.05
    assert seen(mission, 0, -62) > 0.05
    assert seen(mission, 0, -58) == 0


def test_the_view_asked_for_may_be_flat_and_then_a_steep_one_does_not_count() -> None:
    mission = watched(down(-30))
    assert seen(mission, 0, -35) > 0.05
    assert seen(mission, 0, -70) == 0
    assert seen(watched(down(-30), down(-90)), 0, -70) > 0.05


def test_without_a_view_any_look_counts_that_is_not_near_the_horizon() -> None:
    mission = watched()
    assert seen(mission, -200, -30) > 0.2
    assert seen(mission, -200, -45) > 0.1
    assert seen(mission, -1000, -18) == 0  # its upper edge lies at a fifth of a degree
    assert seen(mission, -1000, -13.4) == 0
    assert seen(mission, -3000, -8, fov_deg=2) > 0.05  # narrow enough to end before the horizon
    assert seen(mission, -4000, -5, fov_deg=2) == 0


def test_a_ground_sample_distance_bounds_how_far_away_is_seen() -> None:
    # straight down, 640 pixels of 45 degrees are 0.39 m each; 45 degrees ahead they are 0.55 m
    fine = Camera(pixels=640)
    assert seen(watched(camera=fine, gsd_m=0.39), 0, -90) > 0.04
    assert seen(watched(camera=fine, gsd_m=0.39), 0, -45) == 0
    assert seen(watched(camera=fine, gsd_m=0.56), 0, -45) > 0.1
    assert seen(watched(camera=fine, gsd_m=0.3), 0, -90) == 0


def test_a_camera_for_another_wavelength_or_of_nobody_sees_nothing() -> None:
    mission = watched(camera=Camera(wavelength="EO"), wavelength="LWIR")
    assert seen(mission, 0, -90) == 0
    assert seen(watched(camera=Camera(wavelength="EO"), wavelength="EO"), 0, -90) > 0.04
    mission = watched(down(-90))
    strange = state(mission, 0, -90)
    strange.PayloadStateList[0].PayloadID = 9
    watch = CoverageWatch(mission)
    watch.state(strange, [1])
    assert watch.fraction(1) == 0


def test_a_camera_is_known_by_its_own_id_too() -> None:
    mission = watched(down(-90), camera=replace(Camera(), camera_id=7))
    told = state(mission, 0, -90)
    told.PayloadStateList[0].PayloadID = 7
    watch = CoverageWatch(mission)
    watch.state(told, [1])
    assert (watch.fraction(1) or 0) > 0.04


@pytest.mark.parametrize("elevation_deg", [-90, -60, -35])
def test_the_middle_of_an_image_is_where_its_diagonals_cross(elevation_deg: float) -> None:
    mission = watched()
    (look,) = looks_of(state(mission, 0, elevation_deg), mission.vehicles[0].cameras, PLANE)
    centre = middle(look.corners)
    assert centre is not None
    away = HEIGHT_M / math.tan(math.radians(-elevation_deg))
    # the simulator's Earth is a sphere, the mission's frame lies on an ellipsoid
    assert centre == pytest.approx((away, 0), rel=5e-3, abs=1)
    assert middle([(0, 0), (1, 1), (2, 2), (3, 3)]) is None


def test_the_judge_counts_by_the_same_bounds() -> None:
    assert math.degrees(required_views.FLATTEST_RAD) == pytest.approx(views.FLATTEST_DEG)
    assert math.degrees(required_views.OFF_VIEW_RAD) == pytest.approx(views.OFF_VIEW_DEG)
    assert required_views.COARSER == searches.COARSER
