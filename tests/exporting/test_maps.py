"""Missions as GeoJSON and KML, held against the rules of the formats and against the mission."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from shapely import LineString, Point

from cratous.core import ledger
from cratous.services.cli import main
from cratous.services.exporting.exported import GEOJSON, KML, exported
from cratous.services.loading import load
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput
from cratous.spec.mission import Daa, Frame, Mission, WellClear, Zone, ZoneKind

NAMESPACE = "{http://www.opengis.net/kml/2.2}"
EXAMPLES = ("crossing", "popup", "relations", "search", "partial")
DEPTH = {"Point": 0, "LineString": 1, "Polygon": 2}
# the order in which the schema of KML 2.2 has these
ORDER = {
    "Document": ["name", "Style", "Folder"],
    "Folder": ["name", "Placemark"],
    "Placemark": ["name", "styleUrl", "ExtendedData", "Point", "LineString", "Polygon"],
    "Point": ["altitudeMode", "coordinates"],
    "LineString": ["altitudeMode", "coordinates"],
    "Style": ["LineStyle", "PolyStyle"],
    "LineStyle": ["color", "width"],
}


def example(root: Path, name: str) -> Mission:
    return load(root / f"examples/{name}/mission.yaml")


def geojson(mission: Mission) -> Any:
    (text,) = exported(mission, GEOJSON).files.values()
    return json.loads(text)


def kml(mission: Mission) -> ElementTree.Element:
    (text,) = exported(mission, KML).files.values()
    return ElementTree.fromstring(text)


def twice_area(ring: list[list[float]]) -> float:
    """Above 0 if the corners go counter-clockwise."""
    pairs = pairwise(ring)
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs)


def expected(mission: Mission) -> dict[tuple[str, int], list[tuple[float, float]]]:
    """Kind and id, and the places: latitude and longitude."""
    geodetic = Projection(mission.frame).to_geodetic
    found = {("vehicle", v.id): [geodetic(*v.position[:2])] for v in mission.vehicles}
    found |= {("traffic", t.id): [geodetic(*t.position[:2])] for t in mission.traffic}
    found |= {(t.kind.value, t.id): [geodetic(*p[:2]) for p in t.points] for t in mission.tasks}
    found |= {(z.kind.value, z.id): [geodetic(*p) for p in z.vertices] for z in mission.zones}
    return found


def same_places(got: list[list[float]], wanted: list[tuple[float, float]]) -> bool:
    """Whatever their order is, to 1e-8 degrees."""
    places = [(lat, lon) for lat, lon in wanted]
    for lon, lat, *_ in got:
        near = [p for p in places if abs(p[0] - lat) < 1e-8 and abs(p[1] - lon) < 1e-8]
        if not near:
            return False
        places.remove(near[0])
    return places == []


@pytest.mark.parametrize("name", EXAMPLES)
def test_geojson_has_every_thing_where_it_is(root: Path, name: str) -> None:
    mission = example(root, name)
    data, wanted = geojson(mission), expected(mission)
    assert (data["type"], data["name"]) == ("FeatureCollection", mission.name)
    assert len({feature["id"] for feature in data["features"]}) == len(data["features"])
    for feature in data["features"]:
        assert set(feature) == {"type", "id", "geometry", "properties"}
        assert feature["type"] == "Feature"
        said, shape = feature["properties"], feature["geometry"]
        places = shape["coordinates"]
        for _ in range(DEPTH[shape["type"]] - 1):
            (places,) = places
        places = places if DEPTH[shape["type"]] else [places]
        for lon, lat in places:
            assert abs(lon) <= 180
            assert abs(lat) <= 90
        if shape["type"] == "Polygon":
            assert len(places) >= 4
            assert places[0] == places[-1]
            assert twice_area(places) > 0, "the right-hand rule"
            places = places[1:]
        assert same_places(places, wanted.pop((said["kind"], said["id"])))
        assert said["label"]
        assert any(key.endswith("_msl_m") or key == "altitudes_msl_m" for key in said)
    assert wanted == {}


def test_areas_go_counter_clockwise_however_they_were_written(root: Path) -> None:
    corners = ((0.0, 0.0), (0.0, 90.0), (90.0, 90.0), (90.0, 0.0))
    for vertices in (corners, corners[::-1]):
        zone = Zone(7, ZoneKind.KEEP_OUT, vertices, 10.0, 900.0)
        (found,) = [
            f for f in geojson(replace(example(root, "crossing"), zones=(zone,)))["features"]
            if f["id"] == "keep_out-7"
        ]  # fmt: skip
        assert twice_area(found["geometry"]["coordinates"][0]) > 0
        assert (found["properties"]["floor_msl_m"], found["properties"]["ceiling_msl_m"]) == (
            10,
            900,
        )


def elements(element: ElementTree.Element) -> Iterator[ElementTree.Element]:
    yield element
    for part in element:
        yield from elements(part)


@pytest.mark.parametrize("name", EXAMPLES)
def test_kml_keeps_its_rules_and_has_every_thing_where_it_is(root: Path, name: str) -> None:
    mission = example(root, name)
    document, wanted = kml(mission), expected(mission)
    assert document.tag == f"{NAMESPACE}kml"
    assert [part.tag for part in document] == [f"{NAMESPACE}Document"]
    names = [e.get("id") for e in elements(document) if e.get("id")]
    assert len(set(names)) == len(names)
    for element in elements(document):
        assert element.tag.startswith(NAMESPACE)
        order = ORDER.get(element.tag.removeprefix(NAMESPACE))
        if order:
            parts = [order.index(part.tag.removeprefix(NAMESPACE)) for part in element]
            assert parts == sorted(parts)
        if element.tag == f"{NAMESPACE}styleUrl":
            assert str(element.text).removeprefix("#") in names
    for mark in document.iter(f"{NAMESPACE}Placemark"):
        said = {
            data.get("name"): data.findtext(f"{NAMESPACE}value")
            for data in mark.iter(f"{NAMESPACE}Data")
        }
        text = next(mark.iter(f"{NAMESPACE}coordinates")).text
        places = [[float(number) for number in place.split(",")] for place in str(text).split()]
        if mark.find(f"{NAMESPACE}Polygon") is not None:
            assert places[0] == places[-1]
            assert twice_area(places) > 0
            places = places[1:]
        assert same_places(places, wanted.pop((str(said["kind"]), int(str(said["id"])))))
    assert wanted == {}


def test_altitudes_of_kml_are_above_sea_level(root: Path) -> None:
    mission = example(root, "crossing")
    first = next(iter(kml(mission).iter(f"{NAMESPACE}Point")))
    assert first.findtext(f"{NAMESPACE}altitudeMode") == "absolute"
    altitude = float(str(first.findtext(f"{NAMESPACE}coordinates")).split(",")[2])
    assert altitude == mission.vehicles[0].position.alt_m


def test_labels_with_markup_are_text(root: Path) -> None:
    mission = example(root, "crossing")
    label = """</name><script>&amp;"'"""
    mission = replace(mission, vehicles=(replace(mission.vehicles[0], label=label),))
    assert f"{NAMESPACE}script" not in {e.tag for e in elements(kml(mission))}
    assert label in {e.text for e in kml(mission).iter(f"{NAMESPACE}name")}
    assert label in {f["properties"]["label"] for f in geojson(mission)["features"]}


@pytest.mark.parametrize("form", [GEOJSON, KML])
def test_a_shape_across_the_180th_meridian_is_refused(root: Path, form: str) -> None:
    mission = replace(example(root, "crossing"), frame=Frame(0.0, 179.999))
    zone = Zone(7, ZoneKind.KEEP_OUT, ((0.0, 0.0), (0.0, 900.0), (90.0, 0.0)), 10.0, 900.0)
    assert exported(mission, form).files, "points on both sides are no shape across it"
    with pytest.raises(BadInput, match="180th meridian") as caught:
        exported(replace(mission, zones=(zone,)), form)
    assert caught.value.item == "zone 7"


@pytest.mark.parametrize("form", [GEOJSON, KML])
def test_what_maps_do_not_say_is_told(root: Path, form: str) -> None:
    mission = example(root, "crossing")
    assert exported(mission, form).unsaid == (
        "relations", "vehicles[0].cameras", "tasks[0].view",
    )  # fmt: skip
    more = replace(mission, gap=0.1, instances=(), daa=Daa(WellClear(1.0, 2.0, 3.0, 4.0)))
    assert {"gap", "instances", "daa"} <= set(exported(more, form).unsaid)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "code"), [("crossing", 3), ("partial", 1)])
def test_routes_of_kernels_without_proof_say_so(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch, name: str, code: int,
) -> None:  # fmt: skip
    standing = ledger.Standing(2, 1, 0, (ledger.Problem("kernel", "it has no proof"),))
    monkeypatch.setattr(ledger, "require", lambda **_: standing)
    source = str(root / f"examples/{name}/mission.yaml")
    words = ["export", source, "--plan", "--allow-unproved", "--format", "kml"]
    assert main([*words, "-o", str(tmp_path / "routes.kml")]) == code
    assert f"plan: {standing.line}" in capsys.readouterr().err
    assert standing.line.endswith("1 NOT VOUCHED FOR")


@pytest.mark.slow
def test_planned_routes_lead_from_the_start_over_the_tasks(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission = example(root, "crossing")
    out, source = tmp_path / "c.geojson", str(root / "examples/crossing/mission.yaml")
    words = ["export", source, "--plan", "--allow-unproved", "-o", str(out), "--format"]
    assert main([*words, "geojson"]) in (0, 3)
    routes = [
        feature for feature in json.loads(out.read_text(encoding="utf-8"))["features"]
        if feature["properties"]["kind"] == "route"
    ]  # fmt: skip
    local = Projection(mission.frame).to_local
    assert [route["properties"]["id"] for route in routes] == [1, 2]
    for route, vehicle in zip(routes, mission.vehicles, strict=True):
        said, places = route["properties"], route["geometry"]["coordinates"]
        start = local(places[0][1], places[0][0])
        assert start == pytest.approx(vehicle.position[:2], abs=1e-3)
        (task,) = said["tasks"]
        assert task["arrives_s"] <= task["starts_s"] <= task["ends_s"]
        flown = LineString([local(lat, lon) for lon, lat in places])
        for point in mission.task(task["id"]).points:
            # a line is searched from beside it; the delivery point is flown over
            assert flown.distance(Point(point[:2])) < (400.0 if task["id"] == 1 else 1.0)
    assert main([*words, "kml"]) in (0, 3)
    lines = ElementTree.parse(out).getroot().iter(f"{NAMESPACE}styleUrl")
    assert [line.text for line in lines].count("#route") == 2
    capsys.readouterr()
