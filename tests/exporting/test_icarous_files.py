"""A mission as files of ICAROUS, and read again: the same way, the same zones."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.services.exporting.exported import exported
from cratous.services.importing.composing import Asked, composed
from cratous.services.importing.fences import read_fence_xml
from cratous.services.importing.gathering import gathered
from cratous.services.importing.geojson import read_geojson
from cratous.services.importing.imported_content import Reading
from cratous.services.importing.kml import read_kml
from cratous.services.importing.mission_text import mission_text
from cratous.services.importing.qgc import read_qgc
from cratous.services.loading.document import parse_document
from cratous.services.loading.yaml_mission import loaded
from cratous.services.mission.frames import Projection
from cratous.spec import mission as spec
from cratous.spec.errors import BadInput
from cratous.spec.mission.plan import Plan, PlanItem

Run = Callable[..., tuple[int, str, str]]
METRES = st.floats(-5000, 5000, width=32)
HEIGHTS = st.floats(0, 3000, width=32)
VEHICLE = spec.Vehicle(1, "one", spec.Position(0, 0, 50), 0, 9, 5, 12, 0.5, 3, True)


def mission(**values: object) -> spec.Mission:
    volume = spec.Daa(spec.WellClear(30, 10, 5, 5))
    base = spec.Mission("made", "", spec.Frame(52, 8.5, 100), (VEHICLE,), (), volume)
    return replace(base, **values)  # type: ignore[arg-type]


def points_task(number: int, place: tuple[float, float, float]) -> spec.Task:
    return spec.Task(number, spec.TaskKind.MUST_FLY, "", (spec.Position(*place),), (1,))


@given(st.lists(st.tuples(METRES, METRES, HEIGHTS), min_size=1, max_size=6), st.floats(0.5, 100))
@settings(max_examples=25, deadline=None)
def test_a_flight_plan_comes_back(places: list[tuple[float, float, float]], speed: float) -> None:
    tasks = tuple(points_task(k, place) for k, place in enumerate(places, 1))
    row = " ".join(f"p{task.id}" for task in tasks)
    flier = replace(VEHICLE, speed_m_s=speed)
    made = mission(vehicles=(flier,), tasks=tasks, relations=f".({row})" if tasks[1:] else row)
    (text,) = exported(made, "qgc").files.values()
    (way,) = read_qgc(text, "made", "made").ways
    plane = Projection(made.frame)
    assert way.speed_m_s == pytest.approx(speed, rel=1e-8)
    assert len(way.places) == len(places) + 1
    for place, wanted in zip(way.places[1:], places, strict=True):
        found = plane.to_local(place.latitude_deg, place.longitude_deg)
        assert math.dist(found, wanted[:2]) < 1e-3
        assert place.alt_m == pytest.approx(wanted[2], abs=1e-3)
        assert not place.above_ground


@given(
    st.lists(st.tuples(METRES, METRES), min_size=3, max_size=8),
    st.sampled_from(list(spec.ZoneKind)),
    st.floats(-1000, 100_000),
    st.floats(-1000, 100_000),
)
@settings(max_examples=25, deadline=None)
def test_zones_come_back(
    corners: list[tuple[float, float]], kind: spec.ZoneKind, floor_m: float, ceiling_m: float
) -> None:
    made = mission(zones=(spec.Zone(4, kind, tuple(corners), floor_m, ceiling_m),))
    (text,) = exported(made, "geofence").files.values()
    (fence,) = read_fence_xml(text.encode(), "made").fences
    plane = Projection(made.frame)
    assert fence.keep_out == (kind is spec.ZoneKind.KEEP_OUT)
    assert fence.floor_m is not None
    assert fence.ceiling_m is not None
    assert fence.floor_m + 100 == pytest.approx(floor_m, abs=1e-6)
    assert fence.ceiling_m + 100 == pytest.approx(ceiling_m, abs=1e-6)
    # a ring that ends where it begins is closed once
    assert len(corners) - len(fence.corners) in (0, 1)
    for corner, place in zip(fence.corners, corners, strict=False):
        assert math.dist(plane.to_local(*corner), place) < 1e-3


def test_the_example_comes_back_whole(root: Path, tmp_path: Path) -> None:
    """Imported, exported, and imported again with its traffic and parameters: the same mission."""
    folder = root / "examples" / "icarous-files"

    def taken(*files: Path) -> spec.Mission:
        made = composed(gathered(files, Reading()), Asked("again"))
        return loaded(parse_document(mission_text(made, []), "again"))

    first = taken(folder)
    for form, name in (("qgc", "a.waypoints"), ("geofence", "b.xml")):
        # the padding of keep-outs has been applied: it is taken off again for a second time
        zones = taken(folder / "patrol.waypoints", folder / "fences.xml").zones
        (text,) = exported(replace(first, zones=zones), form).files.values()
        (tmp_path / name).write_text(text, encoding="utf-8")
    rest = [folder / "traffic.yaml", folder / "parameters.txt"]
    again = taken(tmp_path / "a.waypoints", tmp_path / "b.xml", *rest)
    assert again.relations == first.relations
    assert [one.id for one in again.traffic] == [one.id for one in first.traffic] == [7, 8]
    for one_flies, other_flies in zip(again.traffic, first.traffic, strict=True):
        assert math.dist(one_flies.position, other_flies.position) < 1e-3
    assert again.daa == first.daa
    for one, other in zip(again.tasks, first.tasks, strict=True):
        assert math.dist(one.points[0], other.points[0]) < 1e-3
    for one_zone, other_zone in zip(again.zones, first.zones, strict=True):
        assert (one_zone.kind, one_zone.floor_m) == (other_zone.kind, other_zone.floor_m)
        for p, q in zip(one_zone.vertices, other_zone.vertices, strict=True):
            assert math.dist(p, q) < 1e-3


def test_a_planned_route_is_written_without_what_lies_on_its_legs() -> None:
    there = [spec.Position(north, 0, 50) for north in (0, 100, 200)]
    aside = [spec.Position(200, east, 50) for east in (10, 20)]
    item = PlanItem(1, 1, 1, tuple(there), tuple(aside), None, 11, 0, 9, 0, 9, 20, 1.57)
    plan = Plan("made", (item,), (), (1,), 20, "MINMAX", 1, True)
    made = mission(tasks=(points_task(1, (200, 20, 50)),))
    (text,) = exported(made, "qgc", plan).files.values()
    (way,) = read_qgc(text, "made", "made").ways
    plane = Projection(made.frame)
    found = [plane.to_local(p.latitude_deg, p.longitude_deg) for p in way.places]
    assert np.array(found) == pytest.approx(np.array([(0, 0), (200, 0), (200, 20)]), abs=1e-3)
    assert way.speed_m_s == 11
    for form, read in (("geojson", read_geojson), ("kml", read_kml)):
        (text,) = exported(made, form, plan).files.values()
        told = text if form == "geojson" else text.encode()
        (mapped,) = read(told, form, Reading()).ways  # type: ignore[operator]
        assert [place.alt_m for place in mapped.places] == [50.0] * len(mapped.places)
        assert mapped.speed_m_s == 11


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["--format", "qgc"], "one of 1, 2"),
        (["--format", "qgc", "--vehicle", "9"], "one of 1, 2"),
        (["--format", "qgc", "--vehicle", "1"], "a plan (--plan), or points to fly through"),
        (["--format", "geofence"], "one or more"),
        (["--format", "geofence", "--plan"], "--plan goes with"),
        (["--format", "kml", "--vehicle", "1"], "--vehicle goes with --format qgc"),
    ],
)
def test_what_cannot_be_written_is_refused(
    run: Run, root: Path, words: list[str], expected: str
) -> None:
    code, out, err = run("export", root / "examples/crossing/mission.yaml", *words)
    assert (code, out, expected in err) == (2, "", True), err


def test_a_way_in_no_one_order_is_for_the_plan() -> None:
    tasks = tuple(points_task(k, (100.0 * k, 0, 50)) for k in (1, 2))
    for relations in ("", "|(p1 p2)", "+(p1 p2)", "~(p1 p2)"):
        with pytest.raises(BadInput, match="in no one order"):
            exported(mission(tasks=tasks, relations=relations), "qgc")
    with pytest.raises(BadInput, match="flies nowhere"):
        exported(mission(), "qgc")
