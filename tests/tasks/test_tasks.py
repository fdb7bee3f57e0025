"""Options of tasks: areas and patterns, standoffs, views, lines and loiters; why there is none."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import pytest
from task_tools import ELL, area, keep_out, mission, options, pattern, point, vehicle

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import polyline_length_m
from cratous.core.routing.polylines import Track
from cratous.services.pipeline.plan import make_plan
from cratous.spec.errors import NoPlan
from cratous.spec.mission import Camera, Loiter, Pattern, Position, Task, TaskKind, Vehicle, View
from cratous.spec.mission.plan import in_part_of

# ---- areas and patterns --------------------------------------------------------------------------


@pytest.mark.parametrize(
    "task",
    [
        area(),
        area(ELL, sweep_rad=0.5, start_point=Position(-600.0, 50.0, 0.0)),
        area(view=View(math.radians(90), math.radians(-70), True)),
        pattern(Pattern.SPIRAL),
        pattern(Pattern.SQUARE),
        pattern(Pattern.SECTOR, 400.0),
        pattern(Pattern.SWEEP, 400.0),
    ],
    ids=lambda task: f"{task.kind}-{task.pattern}-{task.sweep_rad}-{task.view is not None}",
)
def test_ways_over_an_area_cover_it_and_are_few(task: Task) -> None:
    found, dropped = options(task)
    assert 1 <= len(found) <= 4
    for option in found:
        assert option.coverage >= 0.99
        assert option.view_elevation_rad is not None
        length = polyline_length_m(option.path)
        assert option.duration_ms == pytest.approx(length / 25.0 * 1000, abs=1)
        assert first_bad_leg(option.path, ()) is None
        if task.start_point is not None:
            assert option.path[0][:2] == task.start_point[:2]
    assert all(d.reason for d in dropped)
    durations = [option.duration_ms for option in found]
    assert max(durations) < 1.7 * min(durations)


def test_a_zone_in_the_area_drops_its_lanes_with_the_reason() -> None:
    zone = keep_out(400.0, 200.0, 700.0, 500.0)
    found, dropped = options(area(), zones=(zone,))
    assert all(first_bad_leg(option.path, (zone,)) is None for option in found)
    assert any("breaks keep-out zone 7" in d.reason for d in dropped)
    (part,) = in_part_of(make_plan(mission(area(), zones=(keep_out(300.0, 100.0, 800.0, 700.0),))))
    assert 0 < part.outside < part.share < 0.99
    with pytest.raises(NoPlan, match="breaks keep-out zone 7"):
        make_plan(mission(area(), zones=(keep_out(-900.0, -900.0, 3000.0, 3000.0),)))


def test_turns_go_around_zones_beside_the_area() -> None:
    free, _ = options(area())
    box_zone = keep_out(1500.0, -300.0, 1900.0, 900.0)
    found, _ = options(area(), zones=(box_zone,))
    assert found
    assert all(first_bad_leg(option.path, (box_zone,)) is None for option in found)
    assert min(o.duration_ms for o in found) >= min(o.duration_ms for o in free)


def test_a_turn_that_would_lead_through_a_zone_is_routed_around_it() -> None:
    down = View(0.0, -math.pi / 2, True)
    lanes, zone = area(sweep_rad=0.0, view=down), keep_out(1150.0, 200.0, 1250.0, 300.0)
    free, _ = options(lanes)
    through = {o.label: o for o in free if first_bad_leg(o.path, (zone,)) is not None}
    assert 0 < len(through) < len(free)
    found = {o.label: o for o in options(lanes, zones=(zone,))[0]}
    assert through.keys() <= found.keys(), "routed, not dropped"
    for label, option in found.items():
        assert first_bad_leg(option.path, (zone,)) is None
        if label in through:
            assert option.duration_ms > through[label].duration_ms


@pytest.mark.parametrize(
    ("task", "who", "words"),
    [
        (area(), vehicle(()), "no camera for wavelength AllAny"),
        (area(wavelength="LWIR"), vehicle((Camera(wavelength="EO"),)), "no camera for wavelength"),
        (area(gsd_m=0.1), vehicle(), "names no resolution"),
        (area(gsd_m=0.1), vehicle((Camera(pixels=640),)), "m a pixel from 400 m, and 0.1 m are"),
        (area(), vehicle((Camera(hfov_rad=0.02),)), "leaves no lane"),
        (area(view=View(0.0, 0.1, True)), vehicle(), "does not look down"),
        (
            point(
                standoff_m=400.0,
                duration_ms=90_000,
                loiter=Loiter(Position(0.0, 0.0, 400.0), 200.0, "racetrack", 0.0, 400.0),
            ),
            vehicle(),
            "standoff is 400 m",
        ),
        (
            Task(
                1,
                TaskKind.LOITER,
                "",
                (Position(0.0, 0.0, 400.0),),
                duration_ms=60_000,
                loiter=Loiter(Position(0.0, 0.0, 400.0), 30.0),
            ),
            vehicle(),
            "wider than the loiter's 30 m",
        ),
        (
            Task(
                1,
                TaskKind.LOITER,
                "",
                (Position(0.0, 0.0, 400.0),),
                duration_ms=10**12,
                loiter=Loiter(Position(0.0, 0.0, 400.0), 200.0),
            ),
            vehicle(),
            "laps, and no more than 10000 are planned",
        ),
    ],
)
def test_why_no_vehicle_can(task: Task, who: Vehicle, words: str) -> None:
    found, dropped = options(task, who)
    assert found == ()
    assert any(words in d.reason for d in dropped)


# ---- points, lines, loiters ----------------------------------------------------------------------


def test_a_standoff_is_kept_by_every_option() -> None:
    found, _ = options(point(standoff_m=300.0, duration_ms=10_000))
    assert found
    for option in found:
        track = Track(option.path)
        gaps = [
            math.dist(track.at(track.length_m * k / 200)[:2], (500.0, 300.0)) for k in range(201)
        ]
        assert min(gaps) >= 300.0
        assert option.coverage >= 0.99


def test_a_standoff_goes_before_the_tilt_of_a_view() -> None:
    task = point(standoff_m=400.0, view=View(0.0, -1.0, True))
    found, _ = options(task)
    assert found
    for option in found:
        assert min(math.dist(p[:2], task.points[0][:2]) for p in option.path) >= 400.0
        height_m, away_m = 400.0, 400.0 + 25.0
        assert option.view_elevation_rad == pytest.approx(-math.atan2(height_m, away_m))


def test_a_wedge_gives_looks_within_it_every_twenty_degrees() -> None:
    view = View(math.radians(90), math.radians(-60), True, math.radians(80))
    found, _ = options(point(view=view))
    away = 400.0 / math.tan(math.radians(60))
    looks = set()
    for option in found:
        middle = option.path[len(option.path) // 2]
        assert math.dist(middle[:2], (500.0, 300.0)) == pytest.approx(away, rel=1e-6)
        looks.add(round(math.degrees(math.atan2(300.0 - middle[1], 500.0 - middle[0]))))
    assert looks == {50, 70, 90, 110, 130}
    many = point(view=view, views=(replace(view, azimuth_rad=3.0), replace(view, azimuth_rad=5.0)))
    assert 0 < len(options(many)[0]) <= 60


def test_each_view_of_a_line_is_a_pair_of_offset_routes() -> None:
    line = (Position(0.0, 0.0, 0.0), Position(2500.0, 0.0, 0.0))
    left, right = (View(math.radians(a), math.radians(-60)) for a in (-90, 90))
    task = Task(1, TaskKind.LINE_SEARCH, "", line, view=left, views=(right,))
    found, _ = options(task)
    away = 400.0 / math.tan(math.radians(60))
    sides = {o.label: o.path[len(o.path) // 2].east_m for o in found}
    assert sides["forward, view 1"] == pytest.approx(away, abs=1)
    assert sides["forward, view 2"] == pytest.approx(-away, abs=1)
    assert sides["backward, view 1"] == pytest.approx(-away, abs=1)
    assert len(found) == 4


def test_a_camera_that_cannot_look_down_sees_a_line_from_its_sides_ahead_and_back() -> None:
    line = Task(1, TaskKind.LINE_SEARCH, "", (Position(0.0, 0.0, 0.0), Position(3000.0, 0.0, 0.0)))
    found, _ = options(line, vehicle((Camera(min_elevation_rad=math.radians(-45)),)))
    assert not [o for o in options(line)[0] if "view" in o.label]
    along = [o for o in found if o.label.endswith(("view 3", "view 4"))]
    assert len(along) == 4
    assert {round(p.east_m) for o in along for p in o.path} == {0}
    beside = [o for o in found if o.label.endswith(("view 1", "view 2"))]
    assert len(beside) == 4
    away_m = 400.0 / math.tan(0.95 * math.radians(45))
    for option in beside:
        assert option.coverage is not None
        assert option.coverage >= 0.99
        assert {round(abs(p.east_m)) for p in option.path} == {round(away_m)}


@pytest.mark.parametrize("shape", ["circular", "racetrack", "figure_eight"])
@pytest.mark.parametrize("direction", ["any", "clockwise", "counter_clockwise"])
def test_loiters_have_their_shape_and_last_as_long_as_asked(shape: str, direction: str) -> None:
    centre = Position(500.0, 300.0, 400.0)
    loiter = Loiter(centre, 150.0, shape, 0.6, 500.0, direction)
    task = Task(1, TaskKind.LOITER, "", (centre,), duration_ms=200_000, loiter=loiter)
    found, _ = options(task)
    assert len(found) == (16 if direction == "any" else 8)
    c, s = math.cos(0.6), math.sin(0.6)
    along = 150.0 + (250.0 if shape != "circular" else 0.0)
    for option in found:
        assert polyline_length_m(option.path) == pytest.approx(5000.0, abs=1e-3)
        own = [(p[0] - 500.0, p[1] - 300.0) for p in option.path]
        assert max(abs(n * c + e * s) for n, e in own) == pytest.approx(along, abs=1.0)
        assert max(abs(e * c - n * s) for n, e in own) == pytest.approx(150.0, abs=1.0)
        for (p, q), (_, r) in pairwise(pairwise(option.path)):
            turn = math.atan2(r[1] - q[1], r[0] - q[0]) - math.atan2(q[1] - p[1], q[0] - p[0])
            limit = 2 * math.asin(
                min(1.0, max(math.dist(p[:2], q[:2]), math.dist(q[:2], r[:2])) / 300)
            )
            assert abs(math.remainder(turn, 2 * math.pi)) <= limit + 1e-6
    turns = {option.label.split(",")[1].split()[0] for option in found}
    assert turns == {"any": {"left", "right"}, "clockwise": {"right"}}.get(direction, {"left"})
