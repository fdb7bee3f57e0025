"""GeoJSON beneath the map: what is shown of it, where, and what of a bad file is told."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from chromium_tools import READY, browsing
from ground_station_tools import ask, serving

from cratous.services.cli import main
from cratous.services.ground_station import overlays
from cratous.services.ground_station.overlays import Shape, in_frame, overlays_of
from cratous.services.loading import load
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

COAST = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature", "properties": {"name": "coast"},
            "geometry": {"type": "LineString", "coordinates": [[-76.4, 37.1], [-76.39, 37.12, 3]]},
        },
        {
            "type": "Feature", "properties": {"label": "lake"},
            "geometry": {"type": "MultiPolygon", "coordinates": [
                [[[-76.4, 37.1], [-76.39, 37.1], [-76.39, 37.11], [-76.4, 37.1]]],
                [[[-76.2, 37.1], [-76.19, 37.1], [-76.19, 37.11], [-76.2, 37.1]]],
            ]},
        },
        {"type": "Feature", "properties": None, "geometry": None},
        {"type": "GeometryCollection", "geometries": [{"type": "Point", "coordinates": [-76.4, 37.2]}]},
    ],
}  # fmt: skip


def _file(folder: Path, data: Any) -> Path:
    file = folder / "coast.geojson"
    file.write_text(data if isinstance(data, str) else json.dumps(data), encoding="utf-8")
    return file


def test_all_kinds_of_geometry_are_shapes_in_the_frame(tmp_path: Path) -> None:
    found = overlays_of((_file(tmp_path, COAST),))
    assert [(len(one.places), one.area, one.name) for one in found] == [
        (2, False, "coast"), (4, True, "lake"), (4, True, "lake"), (1, False, ""),
    ]  # fmt: skip
    frame = Frame(37.1, -76.4)
    coast, *_, point = in_frame(found, frame)
    assert coast["places"][0] == [0.0, 0.0]
    assert coast["places"][1] == pytest.approx(Projection(frame).to_local(37.12, -76.39), abs=0.06)
    assert point["places"][0] == pytest.approx([11_100, 0], abs=10)


def test_what_is_too_far_for_a_plane_is_left_out() -> None:
    far = Shape(((37.1, -76.4), (-37.1, 103.6)), False, "to the other side")
    near = Shape(((37.1, -76.4), (38.0, -76.4)), False, "near")
    assert [one["name"] for one in in_frame((far, near), Frame(37.1, -76.4))] == ["near"]


@pytest.mark.parametrize(
    ("data", "item", "what"),
    [
        ([1], "$", "no object of GeoJSON"),
        ({"type": "Topology"}, "$", "no object of GeoJSON"),
        ({"type": ["Point"], "coordinates": [1, 2]}, "$", "no object of GeoJSON"),
        ({"type": "FeatureCollection"}, "$", "a FeatureCollection without features"),
        ({"type": "Point", "coordinates": [1]}, "$.coordinates", "not a position"),
        ({"type": "Point", "coordinates": [1, 91]}, "$.coordinates", "not a position"),
        ({"type": "Point", "coordinates": [True, 9]}, "$.coordinates", "not a position"),
        ({"type": "LineString", "coordinates": [[1, 2], "x"]}, "$.coordinates[1]", "not a position"),
        ({"type": "Polygon", "coordinates": [7]}, "$.coordinates[0]", "no list"),
        (
            {"type": "FeatureCollection", "features": [{"type": "Feature", "geometry": 3}]},
            "$.features[0].geometry", "no object of GeoJSON",
        ),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_file_and_place(
    tmp_path: Path, data: Any, item: str, what: str
) -> None:
    file = _file(tmp_path, data)
    with pytest.raises(BadInput, match=what) as told:
        overlays_of((file,))
    assert (told.value.where, told.value.item) == (str(file), item)


def test_more_places_than_the_map_can_draw_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(overlays, "MOST_PLACES", 11)
    file = _file(tmp_path, COAST)
    assert len(overlays_of((file,))) == 4
    with pytest.raises(BadInput, match="too many places") as told:  # of all files together
        overlays_of((file, file))
    assert told.value.where == str(file)


def test_a_bad_overlay_is_bad_input_before_anything_listens(
    crossing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = _file(tmp_path, '{"type": "Point", "coordinates": [')
    assert main(["serve", str(crossing), "--overlay", str(file), "--port", "0"]) == 2
    assert str(file) in capsys.readouterr().err
    assert main(["serve", str(crossing), "--overlay", str(tmp_path / "none"), "--port", "0"]) == 2


@pytest.mark.slow
def test_the_page_draws_it_beneath_the_aircraft(crossing: Path, tmp_path: Path) -> None:
    frame = load(Path(__file__).resolve().parents[2] / "examples/crossing/mission.yaml", 0).frame
    square = [
        [frame.longitude_deg + east, frame.latitude_deg + north]
        for north, east in ((0, 0), (0, 0.01), (0.01, 0.01), (0.01, 0))
    ]
    file = _file(tmp_path, {"type": "Polygon", "coordinates": [[*square, square[0]]]})
    with (
        serving(crossing, Path("--overlay"), file) as (_, port),
        browsing(tmp_path / "profile") as page,
    ):
        for query in (
            "",
            "?latitude=91&longitude=0",
            "?latitude=0&longitude=181",
            "?latitude=nan&longitude=0",
        ):
            assert ask(port, f"/overlays.json{query}").status == 400
        (shape,) = ask(
            port, f"/overlays.json?latitude={frame.latitude_deg}&longitude={frame.longitude_deg}"
        ).data()["shapes"]
        assert math.hypot(*shape["places"][0]) == 0
        page.go(f"http://127.0.0.1:{port}/#t=30&theme=light")
        page.until(READY)
        # in the middle of the square the paper is darker than outside of it
        shade = """(() => { const map = document.querySelector('#map .leaflet-beneath-pane canvas');
            if (!map) return 0;
            const pen = map.getContext('2d'), [w, h] = [map.width, map.height];
            let grey = 0;
            const pixels = pen.getImageData(0, 0, w, h).data;
            for (let k = 3; k < pixels.length; k += 4) grey += pixels[k] > 10 && pixels[k] < 40;
            return grey; })()"""
        page.until(f"{shade} > 2000")
        assert page.logged == []
