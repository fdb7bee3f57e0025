"""Tasks as they are written, in a mission file or OpenUxAS messages: all is read, bad is refused."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
import yaml
from loading_tools import small
from task_tools import FIELD, vehicle

from cratous.bridge import lmcp
from cratous.core.tasks.coverage import area_m2, outline
from cratous.services.loading import load
from cratous.services.loading.coordinates import Places
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_tasks import Interests
from cratous.services.loading.uxas_tasks import task as read_task
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame, Pattern, Position, Task, TaskKind

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
    data = small()
    data["vehicles"] = [{**data["vehicles"][0], "cameras": [{"payload_id": 1}]}]
    data["tasks"] = [{k: v for k, v in task.items() if v is not None}]
    del data["relations"]
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
    ("GroundVehicleState", {"ID": 8, "Location": place(), "Groundspeed": 3.0}),
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
        ("WatchTask", {"WatchedEntityID": 8}, "WatchedEntityID", "3 m/s"),
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
