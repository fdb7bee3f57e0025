"""Cameras in planning: footprints, gimbals, coverage, and paths for a wanted view."""

import math
from dataclasses import replace

import pytest
from planning_tools import CAMERA, TWO, assert_turns_wide, mission, task, vehicle

from cratous.services.mission.sensor import coverage, footprint, sees
from cratous.services.planning import options as planned
from cratous.services.planning.options import expand
from cratous.services.planning.smoothing import line_path
from cratous.spec.mission import Camera, Position, TaskKind, View

DOWN_LEFT = View(math.radians(-90), math.radians(-60))


def test_the_footprint_straight_down_is_a_rectangle():
    here = Position(0.0, 0.0, 1000.0)
    quad = footprint(here, 0.0, CAMERA, (0.0, 0.0))
    half = 1000.0 * math.tan(CAMERA.hfov_rad / 2)
    assert sorted({round(e, 6) for _, e in quad}) == [round(-half, 6), round(half, 6)]
    assert max(n for n, _ in quad) == pytest.approx(half / CAMERA.aspect, rel=1e-6)
    assert sees(quad, (0.0, half - 1))
    assert not sees(quad, (0.0, half + 1))


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5])
def test_the_boresight_of_a_slanted_view_is_in_the_footprint(heading):
    here = Position(100.0, -50.0, 700.0)
    for bearing in range(0, 360, 30):
        target = (
            100.0 + 400 * math.cos(math.radians(bearing)),
            -50.0 + 400 * math.sin(math.radians(bearing)),
        )
        quad = footprint(here, heading, CAMERA, target)
        assert sees(quad, target)
        far = max(quad, key=lambda p: math.dist(p, here[:2]))
        assert math.dist(far, here[:2]) > 400


def test_there_is_no_footprint_where_a_corner_looks_above_the_horizon():
    here = Position(0.0, 0.0, 100.0)
    assert footprint(here, 0.0, CAMERA, (5000.0, 0.0)) is None
    assert footprint(here, 0.0, CAMERA, (0.0, 0.0), terrain_m=100.0) is None


def test_a_gimbal_stops_at_its_limits():
    fixed = Camera(min_azimuth_rad=0.0, max_azimuth_rad=0.0)
    here = Position(0.0, 0.0, 700.0)
    behind = (-400.0, 0.0)
    assert not sees(footprint(here, 0.0, fixed, behind), behind)
    assert sees(footprint(here, math.pi, fixed, behind), behind)


def test_a_flight_elsewhere_covers_nothing():
    line = task(1, TaskKind.LINE_SEARCH, (0.0, 0.0, 0.0), (2000.0, 0.0, 0.0))
    over = (Position(-100.0, 0.0, 700.0), Position(2100.0, 0.0, 700.0))
    far = tuple(p._replace(east_m=5000.0) for p in over)
    half = (Position(-100.0, 0.0, 700.0), Position(1000.0, 0.0, 700.0))
    assert coverage(over, line, CAMERA) == 1.0
    assert coverage(far, line, CAMERA) == 0.0
    assert 0.5 < coverage(half, line, CAMERA) < 0.75


@pytest.mark.parametrize("view", [None, DOWN_LEFT, View(math.radians(35), math.radians(-60))])
def test_a_crooked_line_is_covered_by_a_flyable_path(view):
    points = [(300.0 * k, 250.0 * (-1) ** k * (k % 3), 0.0) for k in range(12)]
    line = task(1, TaskKind.LINE_SEARCH, *points, view=view)
    made = line_path(line, CAMERA, 150.0, 700.0, 0.0)
    assert made.coverage >= 0.99
    assert coverage(made.points, line, CAMERA) >= 0.99
    assert_turns_wide(made.points, TWO[0])


def test_the_view_of_a_point_is_from_the_wanted_side():
    wanted = View(math.radians(90), math.radians(-60))
    point = task(1, TaskKind.POINT_SEARCH, (2000.0, 0.0, 0.0), view=wanted)
    of = mission((point,))
    options, dropped = expand(of, of.tasks, ())
    assert len(options) == 18
    assert dropped == ()
    for option in options:
        middle = option.path[1]
        away = math.dist(middle[:2], (2000.0, 0.0))
        assert away == pytest.approx(700.0 / math.tan(math.radians(60)))
        # the target lies to the right of the direction of flight
        bearing = math.atan2(-middle.east_m, 2000.0 - middle.north_m)
        turn = math.remainder(bearing - option.start.heading_rad, 2 * math.pi)
        assert turn == pytest.approx(math.pi / 2, abs=1e-9)


SEARCHED = (
    task(1, TaskKind.POINT_SEARCH, (2000.0, 0.0, 0.0), gsd_m=2.0, wavelength="EO"),
    task(2, TaskKind.LINE_SEARCH, (0.0, 500.0, 0.0), (900.0, 500.0, 0.0), view=DOWN_LEFT),
    task(
        3, TaskKind.AREA_SEARCH, *((n, e, 0.0) for n, e in ((0, 0), (0, 500), (500, 500), (500, 0)))
    ),
)
FIRST = vehicle(1, 0.0, 0.0, cameras=(replace(CAMERA, wavelength="EO", pixels=400),))
(SEES,) = FIRST.cameras
COARSE = replace(SEES, pixels=100)
OTHERS = {
    "hfov_rad": replace(SEES, hfov_rad=0.5),
    "aspect": replace(SEES, aspect=1.0),
    "min_elevation_rad": replace(SEES, min_elevation_rad=-1.0),
    "max_elevation_rad": replace(SEES, max_elevation_rad=-1.5),
    "azimuth_rad": replace(SEES, min_azimuth_rad=0.0, max_azimuth_rad=0.0),
    "wavelength": replace(SEES, wavelength="LWIR"),
    "pixels": COARSE,
    "zoom_rad": replace(COARSE, zoom_rad=(0.1,)),
}


def ways(options, vehicle_id):
    """What is offered to a vehicle, but for the numbers of the options."""
    return [replace(one, option_id=0) for one in options if vehicle_id in one.vehicles]


def test_vehicles_that_differ_in_the_ids_of_cameras_share_what_is_computed(monkeypatch):
    asked = []
    really = planned._options
    monkeypatch.setattr(planned, "_options", lambda *given: asked.append(given) or really(*given))
    other = vehicle(2, 0.0, 3000.0, cameras=(replace(SEES, payload_id=7, camera_id=8),))
    both, dropped = expand(mission(SEARCHED, (FIRST, other)), SEARCHED, ())
    assert len(asked) == len(SEARCHED)
    for one in (FIRST, other):
        assert {option.flyer.cameras for option in ways(both, one.id)} == {one.cameras}
        alone, not_offered = expand(mission(SEARCHED, (one,)), SEARCHED, ())
        assert ways(both, one.id) == ways(alone, one.id)
        assert [d for d in dropped if one.id in d.vehicles] == list(not_offered)
    assert {option.task_id for option in both} == {1, 2, 3}


@pytest.mark.parametrize("what", [*OTHERS, "speed_m_s", "cruise", "max_bank_rad"])
def test_a_vehicle_that_differs_in_anything_else_has_options_of_its_own(what):
    other = vehicle(2, 0.0, 3000.0, cameras=(OTHERS.get(what, SEES),))
    if what == "cruise":
        other = vehicle(2, 0.0, 3000.0, alt=650.0, cameras=(SEES,))
    elif what not in OTHERS:
        other = replace(other, **{what: 0.9 * getattr(other, what)})
    first = replace(FIRST, cameras=(COARSE,)) if what == "zoom_rad" else FIRST
    both, dropped = expand(mission(SEARCHED, (first, other)), SEARCHED, ())
    for one in (first, other):
        alone, not_offered = expand(mission(SEARCHED, (one,)), SEARCHED, ())
        assert ways(both, one.id) == ways(alone, one.id)
        assert [d for d in dropped if one.id in d.vehicles] == list(not_offered)
    offered = [
        [(o.task_id, o.path, o.duration_ms, o.view_elevation_rad) for o in ways(both, number)]
        for number in (1, 2)
    ]
    assert offered[0] != offered[1], "it would not be noticed if it had the other's"
