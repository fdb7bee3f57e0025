"""Files of others: what each says, and what is refused with file, line and item."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from pathlib import Path

import pytest

from cratous.services.importing.imported_content import Parts, Place, Reading
from cratous.services.importing.kinds import read_part
from cratous.spec.errors import BadInput

NOTHING = Reading()
HOME = "0\t1\t0\t16\t0\t0\t0\t0\t52.0\t8.5\t40\t1\n"
NEXT = "1 0 3 16 0 0 0 0 52.001 8.5 50 1\n"
PLAN = f"QGC WPL 110\n{HOME}{NEXT}"
VERTICES = "".join(
    f'<vertex id="{k}"><lat>{lat}</lat><lon>{lon}</lon></vertex>'
    for k, (lat, lon) in enumerate([(52, 8), (52, 8.1), (52.1, 8.1)])
)
FENCE = (
    '<Geofence>\n<fence id="3">\n<type>KEEPOUT</type><num_vertices>3</num_vertices>'
    f"<floor>-5</floor><roof>60.5</roof>{VERTICES}</fence></Geofence>"
)
EUTL = """# a plan of two aircraft
ID lat lon alt time tcp_trk
unitless [deg] [deg] [ft] [s] unitless
A 52.0 8.5 1000 0 NONE
A 52.01 8.5 1000 100 BOT
B 52.0 8.6 2000 10 NONE
B 52.0 8.61 2000 70 NONE
"""
DAA = """NAME lat lon alt time trk gs vs
none [deg] [deg] [ft] [s] [deg] [knot] [fpm]
own 52.0 8.5 1000 10 0 40 0
two 52.1 8.5 1000 12 180 60 600
own 52.01 8.5 1000 60 0 40 0
two 52.09 8.5 1000 60 180 60 600
"""
AREA = {"type": "Polygon", "coordinates": [[[8, 52], [8.1, 52], [8.1, 52.1], [8, 52]]]}
SEVERAL = {"type": "MultiPolygon", "coordinates": [AREA["coordinates"]]}
ROUTE = {"type": "LineString", "coordinates": [[8, 52, 30], [8.1, 52, 40]]}
KML = (
    '<kml xmlns="http://www.opengis.net/kml/2.2">\n<Placemark><name>way</name>\n<LineString>'
    "<altitudeMode>{mode}</altitudeMode><coordinates>8,52,30 8.1,52,40</coordinates></LineString>"
    "</Placemark></kml>"
)
MANY = (
    "<kml><Placemark><name>wall</name><MultiGeometry><Polygon><LinearRing><coordinates>8,52 8.1,52 8.1,52.1 8,52"
    "</coordinates></LinearRing></Polygon></MultiGeometry></Placemark></kml>"
)


def features(*shapes: tuple[dict, dict]) -> str:
    made = [{"type": "Feature", "geometry": g, "properties": p} for g, p in shapes]
    return json.dumps({"type": "FeatureCollection", "features": made})


@pytest.fixture
def read(tmp_path: Path) -> Callable[..., Parts]:
    def made(name: str, text: str, how: Reading = NOTHING) -> Parts:
        (tmp_path / name).write_text(text, encoding="utf-8")
        return read_part(tmp_path / name, how)

    return made


def test_a_plan_of_a_ground_station(read: Callable[..., Parts]) -> None:
    speed = "2 0 0 178 1 12.5 0 0 0 0 0 1\n"
    more = "3 0 3 22 0 0 0 0 0 0 10 1\n4 0 0 16 5 0 0 0 52.002 8.5 50 1\n5 0 0 20 0 0 0 0 0 0 0 1\n"
    parts = read("my plan.txt", PLAN + speed + more)
    (way,) = parts.ways
    assert (way.label, way.speed_m_s) == ("my plan", 12.5)
    assert way.places[0] == way.places[-1] == Place(52.0, 8.5, 40.0, False)
    assert way.places[1] == Place(52.001, 8.5, 50.0, True)
    said = "\n".join(parts.notes)
    assert all(word in said for word in ("take-off", "return to launch", "hold times"))
    assert read("plain.waypoints", PLAN).notes == ()
    assert read("plain.waypoints", PLAN).ways[0].speed_m_s is None


@pytest.mark.parametrize("kind", ["KEEPOUT", "KEEP_OUT", "1", " keepout "])
def test_a_geofence_in_each_spelling(read: Callable[..., Parts], kind: str) -> None:
    (fence,) = read("f.xml", FENCE.replace("KEEPOUT", kind)).fences
    assert (fence.label, fence.keep_out, fence.above_ground) == ("fence 3", True, True)
    assert (fence.floor_m, fence.ceiling_m) == (-5.0, 60.5)
    assert fence.corners == ((52, 8), (52, 8.1), (52.1, 8.1))
    for word in ("KEEPIN", "0"):
        assert not read("f.xml", FENCE.replace("KEEPOUT", word)).fences[0].keep_out


def test_a_geofence_in_yaml(read: Callable[..., Parts]) -> None:
    text = (
        "- {id: 1, type: KEEPIN, numV: 3, floor: 0, roof: 9, vertices: [[1, 2], [1, 3], [2, 3]]}\n"
    )
    (fence,) = read("f.yaml", text).fences
    assert fence.corners == ((1, 2), (1, 3), (2, 3))


def test_traffic_is_told_from_home(read: Callable[..., Parts]) -> None:
    lines = "- [4, 100, 90, 5, 2, 270, 1]\n- [5, 10, 0, 5, 2, 0, 0, 30, FLARM]\n"
    sigma = "- [6, 10, 0, 5, 2, 0, 0, 0, ADS-B, 1, 1, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0]\n"
    parts = read("t.yaml", lines + sigma)
    one, two, _ = parts.intruders
    assert (one.id, one.alt_m, two.appears_s) == (4, 5.0, 30.0)
    assert (one.north_m, one.east_m) == (pytest.approx(0, abs=1e-9), 100.0)
    assert one.velocity == (pytest.approx(0, abs=1e-9), -2.0, -1.0)
    assert any("covariances" in note for note in parts.notes)


def test_plans_in_tables(read: Callable[..., Parts]) -> None:
    parts = read("p.eutl", EUTL)
    a, b = parts.ways
    assert (a.label, b.label, len(a.places)) == ("A", "B", 2)
    assert a.places[0].alt_m == pytest.approx(304.8)
    assert a.speed_m_s == pytest.approx(11.127, abs=1e-3)
    assert any("turns" in note for note in parts.notes)
    parts = read("p.daa", DAA)
    assert parts.ways[0].speed_m_s == pytest.approx(1112.7 / 50, abs=0.01)
    (other,) = parts.intruders
    assert other.appears_s == 50.0
    assert any("12" in note and "left out" in note for note in parts.notes)
    assert other.velocity == pytest.approx((-30.8667, 0.0, -3.048), abs=1e-3)


def test_a_table_in_metres_needs_an_origin(read: Callable[..., Parts]) -> None:
    text = "ID,sx,sy,sz,time\nNONE,m,m,m,s\nA,0,0,50,0\nA,0,1000,50,100\n"
    with pytest.raises(BadInput, match="--origin"):
        read("p.eutl", text)
    (way,) = read("p.eutl", text, Reading(origin=(52.0, 8.5))).ways
    assert way.places[1].latitude_deg == pytest.approx(52.00899, abs=1e-5)
    assert way.speed_m_s == pytest.approx(10.0)


def test_zones_and_ways_of_maps(read: Callable[..., Parts]) -> None:
    told = {"kind": "keep_in", "label": "yard", "floor_msl_m": 1, "ceiling_msl_m": 2}
    text = features((AREA, told), (ROUTE, {"speed_m_s": 7}), (AREA, {"kind": "area_search"}))
    parts = read("m.geojson", text)
    assert (parts.fences[0].label, parts.fences[0].keep_out) == ("yard", False)
    assert (parts.fences[0].floor_m, parts.fences[0].ceiling_m) == (1.0, 2.0)
    assert parts.ways[0].places[1] == Place(52, 8.1, 40.0, False)
    assert parts.notes[0].endswith("not taken over: 1 x area_search (Polygon)")
    assert read("m.geojson", features((AREA, {})), Reading(areas="keep_out")).fences[0].keep_out
    (way,) = read("m.kml", KML.format(mode="relativeToGround")).ways
    assert way.places[0] == Place(52, 8, 30.0, True)
    bare = KML.format(mode="relativeToGround").replace(",30", "")
    (way,) = read("m.kml", bare, Reading(alt_m=700.0)).ways
    assert way.places == (Place(52, 8, 700.0, False), Place(52, 8.1, 40.0, True)), (
        "--altitude is MSL"
    )


@pytest.mark.parametrize(
    ("name", "text", "line", "item", "expected"),
    [
        ("p.txt", "QGC WPL 120\n", 1, "", "QGC WPL 110"),
        ("p.txt", PLAN.replace("\t1\n", "\n"), 2, "", "12 fields"),
        ("p.txt", PLAN.replace(" 16 ", " 19 "), 3, "command", "16 (waypoint)"),
        ("p.txt", PLAN.replace(" 3 16", " 1 16"), 3, "frame", "above sea level"),
        ("p.txt", PLAN.replace("52.001", "95"), 3, "latitude", "-89 to 89"),
        ("p.txt", PLAN.replace(" 3 16", " 3.5 16"), 3, "frame", ""),
        ("p.txt", PLAN.replace("1 0 3", "one 0 3"), 3, "index", "0 to 4000"),
        ("p.txt", PLAN.replace("52.001", "5_2"), 3, "latitude", "-89 to 89"),
        ("p.txt", PLAN.replace("52.001", "٣"), 3, "latitude", "-89 to 89"),
        ("p.txt", PLAN.replace("52.001", "nan"), 3, "latitude", "-89 to 89"),
        ("p.txt", PLAN.replace("52.001 8.5", "0 0"), 3, "latitude", "its latitude"),
        ("p.txt", f"QGC WPL 110\n{HOME}", 0, "", "two waypoints or more"),
        ("p.txt", f"{PLAN}2 0 0 178 1 0 0 0 0 0 0 1\n", 4, "speed", "0.01 to 350"),
        ("f.xml", FENCE.replace("KEEPOUT", "WALL"), 2, "fence 3", "KEEPIN or KEEPOUT"),
        ("f.xml", FENCE.replace(">3<", ">4<"), 2, "fence 3", "4 vertices"),
        ("f.xml", FENCE.replace("<roof>60.5</roof>", ""), 2, "fence 3", "<roof>"),
        ("f.xml", FENCE.replace("52.1", "x"), 3, "fence 3: vertex 2", "-89 to 89"),
        ("f.xml", "<UxAS/>", 0, "", "a geofence (XML or YAML)"),
        ("f.xml", "<Geofence><fence>", 1, "", "XML"),
        ("f.yaml", "- {id: 1, floor: 0, roof: 9, vertices: [[1, 2]]}\n", 1, "fence 1: type", "type"),
        ("t.yaml", "- [1, 2, 3]\n", 1, "[0]", "7, 8, 9 or 21 values"),
        ("t.yaml", "- [1, 1, 1, 1, 1, 1, 1]\n- [1, 1, 1, 1, 1, 1, 1]\n", 2, "[1][0] (id)", "differ"),
        ("t.yaml", "- [1, -2, 1, 1, 1, 1, 1]\n", 1, "[0][1] (range)", "0 to 100000"),
        ("t.yaml", "- [1, 2, 1, 1, 1, 1, 1, 0, MODE]\n", 1, "[0][8] (transmitter)", "FLARM"),
        ("p.eutl", EUTL.replace(" alt ", " height "), 2, "", "alt"),
        ("p.eutl", EUTL.replace("[ft]", "[s]"), 3, "alt", "ft"),
        ("p.eutl", EUTL.replace(" 100 BOT", " 0 BOT"), 5, "time", "later than 0 s"),
        ("p.eutl", EUTL.replace(" BOT", ""), 5, "", "6 values"),
        ("m.json", features((AREA, {})), 0, "features[0]", "--areas keep_in or keep_out"),
        ("m.json", features((AREA, {"kind": "lawn"})), 0, "features[0]", "keep_in or keep_out"),
        ("m.json", features(({**ROUTE, "coordinates": [[1, 2], [2, 3]]}, {})), 0, "features[0]",
         "--altitude M"),
        ("m.json", features((SEVERAL, {"kind": "keep_out"})), 0, "features[0]", "a Polygon of its own"),
        ("m.json", features((SEVERAL, {})), 0, "features[0]", "a Polygon of its own"),
        ("m.json", features((ROUTE, {"kind": "keep_out"})), 0, "features[0]", "a Polygon of its own"),
        ("m.kml", MANY, 1, "wall", "a Polygon of its own"),
        ("m.json", "[]", 0, "", "a FeatureCollection or a Feature"),
        ("m.kml", KML.format(mode="clampToGround"), 2, "way", "relativeToGround"),
        ("x.txt", "hello\n", 0, "", "a parameter file of ICAROUS"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_refused(
    read: Callable[..., Parts], name: str, text: str, line: int, item: str, expected: str
) -> None:
    with pytest.raises(BadInput) as caught:
        read(name, text)
    error = caught.value
    assert (error.item, expected in error.expected) == (item, True), str(error)
    assert error.where.endswith(f"{name}:{line}" if line else name)


FORMS = {
    "p.txt": PLAN, "f.xml": FENCE, "p.eutl": EUTL, "p.daa": DAA, "m.kml": KML.format(mode="absolute"),
    "t.yaml": "- [4, 100, 90, 5, 2, 270, 1]\n- [5, 10, 0, 5, 2, 0, 0, 30, FLARM]\n",
    "m.json": features((AREA, {"kind": "keep_in"}), (ROUTE, {"speed_m_s": 7})),
}  # fmt: skip
RUBBISH = [
    "nan",
    "1e999",
    "9" * 400,
    "",
    "<",
    "]",
    "{",
    "null",
    "-",
    "\x00",
    ":",
    "#",
    "=",
    "\n",
    "0x1",
]


@pytest.mark.parametrize("name", FORMS)
def test_rubbish_is_read_or_refused(read: Callable[..., Parts], name: str) -> None:
    """Never an error of another kind: sixty changes of each form, the same in each run."""
    rng, refused = random.Random(25), list[str]()
    for _ in range(60):
        text = FORMS[name]
        for _ in range(rng.randint(1, 3)):
            at = rng.randrange(len(text))
            text = text[:at] + rng.choice(RUBBISH) + text[at + rng.choice((0, 1, 4)) :]
        try:
            read(name, text, Reading(origin=(52.0, 8.0)))
        except BadInput as error:
            refused.append(error.where)
    assert len(refused) > 20
    assert all(name in where for where in refused)
