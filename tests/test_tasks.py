"""Searches of areas and patterns, standoffs, views and loiters: options, drops, flights, input."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from cratous.bridge import lmcp
from cratous.core.coverage import (
    area_m2,
    disc,
    outline,
    seen_squares,
    share_covered,
    square_side_m,
    squares,
)
from cratous.core.dubins import polyline_length_m
from cratous.core.following import Track
from cratous.core.legs import first_bad_leg
from cratous.core.sweep import Strip, edge_headings, sector, square_spiral, strips, swath
from cratous.services.bus import Bus
from cratous.services.cli.job import plan_and_check
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.loading.places import Places
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_tasks import Interests
from cratous.services.loading.uxas_tasks import task as read_task
from cratous.services.monitor import Monitor
from cratous.services.planning import make_plan
from cratous.services.planning.options import expand
from cratous.services.sensor import look_on_line, sample_distance_m, zoomed
from cratous.spec.errors import BadInput, NoPlan
from cratous.spec.guarantees import Outcome
from cratous.spec.mission import (
    Camera,
    Daa,
    Frame,
    Loiter,
    Mission,
    Pattern,
    Position,
    Task,
    TaskKind,
    Vehicle,
    View,
    WellClear,
    Zone,
    ZoneKind,
)

FIELD = ((0.0, 0.0), (900.0, -200.0), (1300.0, 600.0), (700.0, 1100.0), (-100.0, 700.0))
ELL = ((0.0, 0.0), (0.0, 300.0), (100.0, 300.0), (100.0, 100.0), (300.0, 100.0), (300.0, 0.0))
EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "search" / "mission.yaml"


def vehicle(cameras: tuple[Camera, ...] = (Camera(),), alt: float = 400.0) -> Vehicle:
    at = Position(-1500.0, 0.0, alt)
    return Vehicle(1, "", at, 0.0, 25.0, 18.0, 33.0, math.radians(35), 5.0, True, cameras)


def area(corners: Any = FIELD, **more: Any) -> Task:
    points = tuple(Position(n, e, 0.0) for n, e in corners)
    return Task(1, TaskKind.AREA_SEARCH, "", points, **more)


def pattern(kind: Pattern, extent: float = 700.0) -> Task:
    at = (Position(500.0, 300.0, 0.0),)
    return Task(1, TaskKind.PATTERN_SEARCH, "", at, pattern=kind, extent_m=extent)


def point(**more: Any) -> Task:
    return Task(1, TaskKind.POINT_SEARCH, "", (Position(500.0, 300.0, 0.0),), **more)


def mission(task: Task, who: Vehicle | None = None, zones: tuple[Zone, ...] = ()) -> Mission:
    daa = Daa(WellClear(100.0, 30.0, 10.0, 0.0))
    frame = Frame(45.0, -120.0)
    return Mission("m", "m.yaml", frame, (who or vehicle(),), (task,), daa, zones=zones)


def options(task: Task, who: Vehicle | None = None, zones: tuple[Zone, ...] = ()) -> Any:
    of = mission(task, who, zones)
    return expand(of, of.tasks, zones)


def keep_out(south: float, west: float, north: float, east: float) -> Zone:
    corners = ((south, west), (south, east), (north, east), (north, west))
    return Zone(7, ZoneKind.KEEP_OUT, corners, -100.0, 5000.0)


def test_a_standoff_goes_before_the_tilt_of_a_view() -> None:
    task = point(standoff_m=400.0, view=View(0.0, -1.0, True))
    found, _ = options(task)
    assert found
    for option in found:
        assert min(math.dist(p[:2], task.points[0][:2]) for p in option.path) >= 400.0
        height_m, away_m = 400.0, 400.0 + 25.0
        assert option.view_elevation_rad == pytest.approx(-math.atan2(height_m, away_m))


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


# ---- squares -------------------------------------------------------------------------------------


@pytest.mark.parametrize("corners", [FIELD, ELL, disc((50.0, -20.0), 200.0), FIELD[::-1]])
def test_the_squares_are_those_that_touch_the_area(corners: Any) -> None:
    from shapely import Polygon, box

    shape, side = Polygon(corners), 35.0
    found = set(squares(corners, side))
    low = np.min(corners, axis=0)
    counts = np.ceil((np.max(corners, axis=0) - low) / side).astype(int)
    for i in range(counts[0]):
        for j in range(counts[1]):
            x, y = low[0] + (i + 0.5) * side, low[1] + (j + 0.5) * side
            square = box(x - side / 2, y - side / 2, x + side / 2, y + side / 2)
            if square.intersection(shape).area > 1e-6:
                assert (x, y) in found
            elif not square.buffer(1e-6).intersects(shape):
                assert (x, y) not in found
    assert area_m2(corners) == pytest.approx(shape.area)


def test_a_square_is_seen_only_if_one_footprint_holds_all_of_it() -> None:
    from shapely import Polygon, box

    side = 20.0
    centres = np.array(squares(((0.0, 0.0), (0.0, 400.0), (400.0, 400.0), (400.0, 0.0)), side))
    rng = np.random.default_rng(3)
    for _ in range(20):
        turn, middle = rng.uniform(0, 6), rng.uniform(100, 300, 2)
        corners = [
            (
                float(middle[0] + 120 * math.cos(turn + a)),
                float(middle[1] + 90 * math.sin(turn + a)),
            )
            for a in (0.3, 1.9, 3.4, 5.0)
        ]
        for footprint in (corners, corners[::-1]):
            seen = set(seen_squares(centres, side, footprint))
            for k, (x, y) in enumerate(centres):
                square = box(x - 10, y - 10, x + 10, y + 10)
                assert (k in seen) == Polygon(footprint).buffer(1e-9).covers(square)


def test_what_is_not_seen_counts_in_full() -> None:
    corners = ((0.0, 0.0), (0.0, 1000.0), (1000.0, 1000.0), (1000.0, 0.0))
    side = square_side_m(corners)
    centres = np.array(squares(corners, side))
    half = ((0.0, 0.0), (0.0, 1000.0), (500.0, 1000.0), (500.0, 0.0))
    left = len(centres) - len(seen_squares(centres, side, half))
    assert share_covered(left, side, area_m2(corners)) == pytest.approx(0.5)


# ---- lanes and patterns --------------------------------------------------------------------------


@pytest.mark.parametrize("heading", [0.0, 0.7, 2.4, 4.0])
@pytest.mark.parametrize("corners", [FIELD, ELL])
def test_strips_cover_the_polygon(heading: float, corners: Any) -> None:
    from shapely import LineString, Polygon, unary_union

    parts = strips(corners, heading, 90.0)
    wide = [LineString(s).buffer(45.001, cap_style="flat") for s in parts]
    assert Polygon(corners).difference(unary_union(wide)).area < 1.0


@pytest.mark.parametrize("width", [90.0, 250.0, 1500.0])
def test_square_spirals_and_sectors_cover_their_extent(width: float) -> None:
    from shapely import LineString, Point, box, unary_union

    def covered(parts: list[Strip]) -> Any:
        return unary_union([LineString(s).buffer(width / 2, cap_style="square") for s in parts])

    square = covered(square_spiral((10.0, 20.0), 500.0, width, 0.0))
    assert box(-490, -480, 510, 520).difference(square).area < 1.0
    passes = sector((10.0, 20.0), 500.0, width, 0.4)
    assert Point(10, 20).buffer(499).difference(covered(passes)).area < 1.0
    assert len(passes) >= 3
    assert all(LineString(s).distance(Point(10, 20)) < 1e-6 for s in passes)


def test_too_many_lanes_are_no_lanes() -> None:
    assert strips(FIELD, 0.0, 1.0) == []
    assert square_spiral((0.0, 0.0), 1000.0, 1.0, 0.0) == []
    assert sector((0.0, 0.0), 1000.0, 1.0, 0.0) == []


def test_a_swath_leaves_out_what_is_in_view_too_shortly() -> None:
    diamond = ((100.0, 0.0), (0.0, 100.0), (-100.0, 0.0), (0.0, -100.0))
    found = swath(diamond, 0.3, 50.0)
    assert found is not None
    assert 60 < found.right_m <= 90
    assert swath(diamond, 0.3, 500.0) is None


def test_headings_are_those_of_the_edges() -> None:
    assert edge_headings(ELL, math.radians(20)) == pytest.approx([math.pi / 2, 0.0])
    assert len(edge_headings(disc((0.0, 0.0), 100.0), math.radians(20))) <= 9


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
    with pytest.raises(NoPlan, match="breaks keep-out zone 7"):
        make_plan(mission(area(), zones=(keep_out(300.0, 100.0, 800.0, 700.0),)))


def test_turns_go_around_zones_beside_the_area() -> None:
    free, _ = options(area())
    box_zone = keep_out(1500.0, -300.0, 1900.0, 900.0)
    found, _ = options(area(), zones=(box_zone,))
    assert found
    assert all(first_bad_leg(option.path, (box_zone,)) is None for option in found)
    assert min(o.duration_ms for o in found) >= min(o.duration_ms for o in free)


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


# ---- flown ---------------------------------------------------------------------------------------


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


SMALL = ((0.0, 0.0), (0.0, 500.0), (400.0, 600.0), (450.0, 0.0))


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


@pytest.mark.slow
def test_the_example_is_flown_and_every_search_covered(tmp_path: Path) -> None:
    of = load(EXAMPLE)
    plan = make_plan(of)
    monitor, bus = Monitor(of, plan), Bus(lmcp.full_names)
    bus.tap(monitor.tap)
    fly(of, plan, bus)
    assert len(of.tasks) == 13
    bad = [v for v in monitor.verdicts() if v.outcome is not Outcome.HOLDS]
    assert bad == []


# ---- input ---------------------------------------------------------------------------------------

AREA = {"id": 1, "kind": "area_search", "points": [{"north_m": n, "east_m": e} for n, e in FIELD]}
CIRCLE = {"centre": {"north_m": 0, "east_m": 0}, "radius_m": 100}
SPIRAL = {
    "id": 1,
    "kind": "pattern_search",
    "pattern": "spiral",
    "extent_m": 500,
    "points": [{"north_m": 0, "east_m": 0}],
}


def places(*corners: tuple[float, float]) -> list[dict[str, float]]:
    return [{"north_m": n, "east_m": e} for n, e in corners]


def written(folder: Path, task: dict[str, Any]) -> Path:
    data = {
        "name": "m",
        "frame": {"latitude_deg": 45, "longitude_deg": -120},
        "vehicles": [
            {
                "id": 1,
                "position": {"north_m": 0, "east_m": 0, "alt_m": 300},
                "heading_deg": 0,
                "speed_m_s": 20,
                "cameras": [{"payload_id": 1}],
            }
        ],
        "tasks": [{k: v for k, v in task.items() if v is not None}],
    }
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("task", "item", "words"),
    [
        ({**AREA, "points": places((0, 0), (1, 1))}, "tasks[0].points", "at least 3"),
        ({**AREA, "points": places((0, 0), (100, 0), (200, 0))}, "tasks[0].points", "spike"),
        (
            {**AREA, "points": places((0, 0), (100, 100), (100, 0), (0, 100))},
            "tasks[0].points",
            "meets edge",
        ),
        ({**AREA, "circle": CIRCLE}, "tasks[0].points", "says where in one way"),
        ({**AREA, "points": None}, "tasks[0].points", "got nothing"),
        (
            {**AREA, "points": None, "circle": {**CIRCLE, "radius_m": 0}},
            "tasks[0].circle.radius_m",
            "more than 0",
        ),
        (
            {
                **AREA,
                "points": None,
                "rectangle": {"centre": CIRCLE["centre"], "width_m": 0, "height_m": 5},
            },
            "tasks[0].rectangle.width_m",
            "more than 0",
        ),
        ({**AREA, "pattern": "spiral"}, "tasks[0].pattern", "has no pattern"),
        ({**AREA, "duration_s": 5}, "tasks[0].duration_s", "has no duration_s"),
        ({**SPIRAL, "pattern": "zigzag"}, "tasks[0].pattern", "one of spiral, square"),
        ({**SPIRAL, "pattern": None}, "tasks[0].pattern", "needs a pattern"),
        ({**SPIRAL, "extent_m": None}, "tasks[0].extent_m", "needs an extent"),
        ({**SPIRAL, "extent_m": 0}, "tasks[0].extent_m", "more than 0"),
        ({**SPIRAL, "sweep_deg": 10}, "tasks[0].sweep_deg", "spiral has no sweep_deg"),
        ({**SPIRAL, "points": places((0, 0), (1, 1))}, "tasks[0].points", "has one point"),
        (
            {"id": 1, "kind": "must_fly", "points": places((0, 0)), "standoff_m": 4},
            "tasks[0].standoff_m",
            "has no standoff_m",
        ),
    ],
)
def test_bad_tasks_are_refused(tmp_path: Path, task: dict[str, Any], item: str, words: str) -> None:
    with pytest.raises(BadInput) as caught:
        load(written(tmp_path, task))
    error = caught.value
    assert error.item == item
    assert words in str(error)
    assert str(tmp_path) in error.where
    assert error.expected
    assert error.got


def test_all_entries_of_a_task_are_read(tmp_path: Path) -> None:
    entry = {
        **AREA,
        "points": None,
        "circle": CIRCLE,
        "sweep_deg": 30,
        "start": {"north_m": 9, "east_m": 8},
        "views": [
            {"azimuth_deg": 90, "elevation_deg": -60, "azimuth_extent_deg": 40},
            {"azimuth_deg": 0, "elevation_deg": -90},
        ],
        "ground_sample_distance_m": 0.5,
    }
    task = load(written(tmp_path, entry)).tasks[0]
    assert area_m2(outline(task)) == pytest.approx(math.pi * 100**2, rel=2e-3)
    assert area_m2(outline(task)) > math.pi * 100**2
    assert task.sweep_rad == pytest.approx(math.radians(30))
    assert task.start_point == Position(9.0, 8.0, 0.0)
    assert task.view is not None
    assert task.view.azimuth_extent_rad == pytest.approx(math.radians(40))
    assert len(task.views) == 1
    assert task.gsd_m == 0.5


# ---- OpenUxAS messages ---------------------------------------------------------------------------


def place(north_deg: float = 45.0, east_deg: float = -120.0) -> Any:
    return lmcp.new("Location3D", Latitude=north_deg, Longitude=east_deg, Altitude=0.0)


def square_shape() -> Any:
    return lmcp.new("Rectangle", CenterPoint=place(), Width=300.0, Height=500.0, Rotation=90.0)


INTERESTS = Interests()
for _kind, _fields in (
    ("PointOfInterest", {"PointID": 5, "Location": place(45.01)}),
    ("LineOfInterest", {"LineID": 6, "Line": [place(), place(45.02)]}),
    ("AreaOfInterest", {"AreaID": 7, "Area": square_shape()}),
):
    INTERESTS.add(Sent(lmcp.new(_kind, **_fields), "interest.xml", 0))


def read(kind: str, **fields: Any) -> Task:
    body = lmcp.new(kind, TaskID=1, **fields)
    frame = Frame(45.0, -120.0)
    return read_task(Sent(body, "task.xml", 0), Places(frame), (vehicle(),), [], INTERESTS)


def test_impact_tasks_are_read() -> None:
    angled = read("AngledAreaSearchTask", SearchAreaID=7, SweepAngle=30.0, StartPoint=place(44.99))
    assert angled.kind is TaskKind.AREA_SEARCH
    assert angled.sweep_rad == pytest.approx(math.radians(30))
    assert angled.start_point is not None
    assert area_m2(outline(angled)) == pytest.approx(150_000)
    spiral = read("PatternSearchTask", SearchLocationID=5, Pattern="Sector", Extent=400.0)
    assert spiral.pattern is Pattern.SECTOR
    assert spiral.points[0].north_m == pytest.approx(1111, abs=2)
    assert len(read("ImpactLineSearchTask", LineID=6).points) == 2
    action = lmcp.new(
        "LoiterAction", LoiterType="Racetrack", Radius=200.0, Length=500.0, Axis=90.0,
        Direction="Clockwise", Duration=9000, Location=place(),
    )  # fmt: skip
    watched = read("ImpactPointSearchTask", SearchLocationID=5, DesiredAction=action, DwellTime=10)
    assert watched.loiter is not None
    assert (watched.loiter.shape, watched.loiter.direction) == ("racetrack", "clockwise")
    assert watched.duration_ms == 9000
    given = read("ImpactPointSearchTask", SearchLocation=place(), StandoffDistance=50.0)
    assert given.standoff_m == 50.0
    assert read("AreaSearchTask", SearchArea=square_shape()).kind is TaskKind.AREA_SEARCH


def hover(**more: Any) -> Any:
    fields = {"LoiterType": "Circular", "Duration": 1000, "Location": place(), **more}
    return lmcp.new("LoiterAction", **fields)


@pytest.mark.parametrize(
    ("kind", "fields", "item", "got"),
    [
        ("AngledAreaSearchTask", {"SearchAreaID": 9}, "SearchAreaID", "9"),
        ("ImpactLineSearchTask", {"LineID": 9}, "LineID", "9"),
        ("PatternSearchTask", {"SearchLocationID": 9, "Extent": 5.0}, "SearchLocationID", "9"),
        ("PatternSearchTask", {"SearchLocationID": 5, "Extent": -5.0}, "Extent", "-5 m"),
        (
            "AreaSearchTask",
            {"SearchArea": lmcp.new("Circle", CenterPoint=place(), Radius=0.0)},
            "SearchArea",
            "0 m",
        ),
        ("LoiterTask", {"DesiredAction": hover(LoiterType="Hover")}, "LoiterType", "Hover"),
        ("LoiterTask", {"DesiredAction": hover(Duration=-1)}, "Duration", "-1"),
        ("LoiterTask", {"DesiredAction": hover(Radius=-5.0)}, "Radius", "-5"),
        ("WatchTask", {"WatchedEntityID": 4}, "WatchedEntityID", "4"),
        ("EscortTask", {"SupportedEntityID": 4}, "task 1", "EscortTask"),
    ],
)
def test_what_a_message_lacks_is_named(
    kind: str, fields: dict[str, Any], item: str, got: str
) -> None:
    with pytest.raises(BadInput) as caught:
        read(kind, **fields)
    assert item in caught.value.item
    assert got in caught.value.got
    assert caught.value.where == "task.xml"
    assert caught.value.expected
