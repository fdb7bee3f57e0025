"""From where an area is seen whose task leaves that open: tilted, as far as is sharp enough."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from task_tools import FIELD, area, keep_out, options, vehicle

from cratous.core.tasks.coverage import look
from cratous.core.tasks.sweep import Swath, swath
from cratous.services.mission.sensor import sample_distance_m
from cratous.services.planning import area_ways
from cratous.services.planning.area_views import ASIDE_DEG, best_view, brought_view
from cratous.services.planning.targets import Angles, flown_camera, flown_view, target_from
from cratous.spec.mission import Camera, Position, View

DOWN = -math.pi / 2
AROUND = Camera(hfov_rad=math.radians(45), pixels=1024)


@pytest.mark.parametrize("degrees", [0, 7, 78, 120, 200, 258, 323])
def test_a_swath_is_as_wide_and_deep_for_every_heading(degrees: int) -> None:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    box = ((-80.0, -200.0), (120.0, -200.0), (120.0, 100.0), (-80.0, 100.0))
    found = swath([(x * c - y * s, x * s + y * c) for x, y in box], math.radians(degrees), 50.0)
    assert found == pytest.approx((-200.0, 100.0, -80.0, 120.0), abs=0.01)


def test_a_swath_ends_where_the_footprint_is_too_short() -> None:
    """A trapezoid, wide ahead: at its slanted sides it is 30 m long where it is wider by 30 m in 200."""
    footprint = ((100.0, -150.0), (100.0, 150.0), (-100.0, 120.0), (-100.0, -120.0))
    found = swath(footprint, 0.0, 30.0)
    assert found == pytest.approx((-145.5, 145.5, 70.0, 100.0), abs=0.01)
    assert swath(footprint, 0.0, 200.5) is None


def test_lanes_are_fewer_with_a_view_that_is_the_same_there_and_back() -> None:
    who = vehicle((AROUND,))
    free, _ = options(area(), who)
    down, _ = options(area(view=View(0.0, DOWN, True)), who)
    assert min(o.duration_ms for o in free) < 0.8 * min(o.duration_ms for o in down)
    for option in free:
        assert option.coverage is not None
        assert option.coverage >= 0.99
        view = flown_view(area(), Angles(option.view_elevation_rad, option.view_azimuth_rad), ())
        assert view is not None
        assert view.inertial
        assert math.radians(-75.01) < view.elevation_rad < math.radians(-44.99)
        aside = math.degrees(view.azimuth_rad - option.start.heading_rad) % 180
        assert min(abs(aside - one) for one in (*ASIDE_DEG, 180.0)) == pytest.approx(0, abs=1e-6)


def test_a_footprint_aslant_to_the_lanes_covers_a_wider_strip() -> None:
    """Of a square footprint it is the diagonal, less what is too short; the way over the area is shorter for it."""
    box = ((-100.0, -100.0), (100.0, -100.0), (100.0, 100.0), (-100.0, 100.0))
    straight, aslant = swath(box, 0.0, 20.0), swath(box, math.radians(45), 20.0)
    assert straight is not None
    assert aslant is not None
    assert straight.width_m == pytest.approx(200.0, abs=0.01)
    assert aslant.width_m == pytest.approx(200 * math.sqrt(2) - 20, abs=0.01)
    task, who = (
        area(((0.0, 0.0), (0.0, 4000.0), (3000.0, 4000.0), (3000.0, 0.0))),
        vehicle((AROUND,)),
    )
    found, _ = options(task, who)
    best = min(found, key=lambda one: one.duration_ms)
    aside = math.degrees(best.view_azimuth_rad - best.start.heading_rad) % 90
    assert 15 < aside < 75
    assert best.coverage is not None
    assert best.coverage >= 0.99


@pytest.mark.parametrize("wanted_m", [0.3, 0.36, 0.45, 0.6])
def test_a_tilted_view_is_as_sharp_as_the_task_asks(wanted_m: float) -> None:
    """At 400 m above ground it is 0.32 m a pixel straight down: too coarse for the first without zooming."""
    camera = replace(AROUND, zoom_rad=(math.radians(22),))
    task, who = area(gsd_m=wanted_m), vehicle((camera,))
    found, _ = options(task, who)
    assert found
    for option in found:
        made_for = Angles(option.view_elevation_rad, option.view_azimuth_rad)
        view, near = brought_view(task, *made_for), flown_camera(camera, task, 400.0, made_for)
        assert sample_distance_m(near, view, 400.0) <= wanted_m + 1e-9
        assert option.coverage is not None
        assert option.coverage >= 0.99


def test_a_camera_that_zooms_in_looks_shallower_at_the_same_sharpness() -> None:
    """Half the field of view from twice as far shows as wide a strip, and a deeper one."""
    camera = replace(AROUND, zoom_rad=(math.radians(16),))
    box = ((0.0, 0.0), (0.0, 5000.0), (5000.0, 5000.0), (5000.0, 0.0))
    asked = area(box, gsd_m=0.33)
    wide, _ = options(asked, vehicle((AROUND,)))
    found, _ = options(asked, vehicle((camera,)))
    assert min(o.duration_ms for o in found) < 0.8 * min(o.duration_ms for o in wide)
    best = min(found, key=lambda one: one.duration_ms)
    made_for = Angles(best.view_elevation_rad, best.view_azimuth_rad)
    assert flown_camera(camera, asked, 400.0, made_for).hfov_rad == camera.zoom_rad[0]
    assert best.view_elevation_rad is not None
    assert math.radians(-60) < best.view_elevation_rad <= math.radians(-20)
    slant_m = 400 / math.sin(-best.view_elevation_rad)
    across_m = 2 * slant_m * math.tan(camera.zoom_rad[0] / 2) / camera.pixels
    along_m = across_m / math.sin(-best.view_elevation_rad)
    assert best.label.endswith(f", {along_m:.2g} m a pixel along the view")


def _best(metres: dict[float, float], camera: Camera = AROUND, aside: float = 0.0) -> float:
    """The tilt that is taken if the way is so long with each at an angle to the lanes [deg, m]."""

    def swath_of(view: View) -> Swath | None:
        far = metres.get(round(math.degrees(view.elevation_rad)), 0.0)
        off = math.degrees(view.azimuth_rad - 0.5) - aside
        there = far and (abs(off) < 1 or view.elevation_rad == DOWN)
        return Swath(-far / 2, far / 2, 0.0, 0.0) if there else None

    view = best_view(area(), camera, 400.0, 0.5, swath_of, lambda seen: seen.width_m)
    if view is None:
        return -90.0
    assert math.degrees(view.azimuth_rad - 0.5) == pytest.approx(aside)
    return round(math.degrees(view.elevation_rad))


def test_of_views_with_as_short_a_way_the_steepest_is_taken() -> None:
    assert _best({-90: 9000.0, -75: 7000.0, -60: 5000.0, -55: 5000.0, -45: 4990.0}) == -60
    assert _best({-90: 2000.0, -60: 2000.0}) == -90
    assert _best({-60: 7000.0, -45: 3000.0}) == -45, "straight down covers nothing"
    assert _best({-90: 7000.0, -60: 5000.0}, aside=45.0) == -60
    assert _best({-90: 3000.0, -30: 500.0}) == -90, (
        "shallower than 45 degrees only for a sample distance"
    )


def test_a_camera_that_cannot_look_back_or_up_is_not_tilted() -> None:
    metres = {-90: 3000.0, -60: 2000.0}
    assert _best(metres, replace(AROUND, min_azimuth_rad=-1.0, max_azimuth_rad=1.0)) == -90
    assert _best(metres, replace(AROUND, max_elevation_rad=math.radians(-70))) == -90


def test_a_camera_that_cannot_look_straight_down_looks_the_same_way_there_and_back() -> None:
    """Ahead of the aircraft alone each turn would be longer by how far it looks."""
    shy = replace(AROUND, min_elevation_rad=math.radians(-45), max_elevation_rad=0.0)
    assert _best({-90: 400.0, -45: 400.0}, shy) == -45
    found, _ = options(area(), vehicle((shy,)))
    ahead, _ = options(area(), vehicle((replace(shy, max_azimuth_rad=2.0),)))
    assert min(o.duration_ms for o in found) < 0.9 * min(o.duration_ms for o in ahead)


def test_ways_that_zones_forbid_are_not_counted_among_those_offered() -> None:
    free, _ = options(area(), vehicle((AROUND,)))
    first, second = free[0].path[:2]
    n, e = (first.north_m + second.north_m) / 2, (first.east_m + second.east_m) / 2
    found, dropped = options(
        area(), vehicle((AROUND,)), zones=(keep_out(n - 40, e - 40, n + 40, e + 40),)
    )
    assert free[0].label in {one.label for one in dropped if "breaks" in one.reason}
    assert len(found) == len(free) == 4


def test_where_zones_leave_no_room_beside_the_area_it_is_seen_from_above() -> None:
    north, east = (max(corner[k] for corner in FIELD) for k in (0, 1))
    walls = (
        keep_out(north + 300.0, -3000.0, north + 5000.0, 6000.0),
        replace(keep_out(-5000.0, -3000.0, -300.0, 6000.0), id=2),
        replace(keep_out(-5000.0, east + 300.0, 9000.0, east + 5000.0), id=3),
        replace(keep_out(-5000.0, -6000.0, 9000.0, -300.0), id=4),
    )
    found, dropped = options(area(), vehicle((AROUND,)), zones=walls)
    assert found
    assert any("deg down" in one.label for one in dropped)


def test_the_camera_looks_where_the_option_was_planned() -> None:
    made_for, here = Angles(math.radians(-45), math.radians(90)), Position(100.0, 200.0, 400.0)
    for heading in (0.0, 1.0, 4.0):
        there = target_from(here, heading, area(), made_for, (AROUND,), 0.0)
        assert there == pytest.approx((100.0, 600.0, 0.0)), "from north, whatever the heading"
    below = target_from(here, 0.0, area(), Angles(DOWN, 0.0), (AROUND,), 0.0)
    assert below == pytest.approx((100.0, 200.0, 0.0))
    asked = area(view=View(0.0, math.radians(-45), True))
    there = target_from(here, 1.0, asked, made_for, (AROUND,), 0.0)
    assert there == pytest.approx((500.0, 200.0, 0.0)), "the task's view, where it asks for one"


def test_what_few_footprints_see_all_of_is_not_measured_with_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The share is the same; measuring it took most of the time of a request with large areas."""
    asked = [0]

    def counted(centres: Any, side_m: float, quads: Any, seen: Any) -> None:
        asked[-1] += len(quads)
        look(centres, side_m, quads, seen)

    monkeypatch.setattr(area_ways, "look", counted)
    who, box = vehicle((AROUND,)), ((0.0, 0.0), (1000.0, 0.0), (1000.0, 800.0), (0.0, 800.0))
    whole = [one.coverage for one in options(area(box), who)[0]]
    asked.append(0)
    monkeypatch.setattr(area_ways, "FEW", 0)
    assert [one.coverage for one in options(area(box), who)[0]] == whole
    assert 2 * asked[1] < asked[0]
