"""Mission files: what they mean, and one clear message for each that means nothing."""

from __future__ import annotations

from math import cos, hypot, isclose, pi, radians
from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from loading_tools import small

from cratous.core.geofence.planar import INSIDE, OUTSIDE, edges_of, locate
from cratous.services.loading import load
from cratous.services.loading.document import item_key, item_name, parse_document
from cratous.services.loading.polygons import circle, padded, polygon_problem, rectangle
from cratous.services.loading.problems import BadMission
from cratous.services.loading.schema import mission_schema
from cratous.services.loading.yaml_mission import expectations
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, WellClear, Zone, ZoneKind

ROOT = Path(__file__).resolve().parents[2]
CROSSING = ROOT / "examples" / "crossing" / "mission.yaml"
SQUARE = [[-500, -500], [-500, 500], [500, 500], [500, -500]]


def write(folder: Path, data: object) -> Path:
    path = folder / "mission.yaml"
    text = data if isinstance(data, str) else yaml.safe_dump(data, sort_keys=False)
    path.write_text(text, encoding="utf-8")
    return path


def refusal(folder: Path, data: object) -> BadInput:
    with pytest.raises(BadInput) as caught:
        load(write(folder, data))
    error = caught.value
    assert str(folder) in error.where, "the message names the file"
    return error


def test_a_small_mission(tmp_path: Path) -> None:
    mission = load(write(tmp_path, small()))
    one, two = mission.vehicles
    assert one.position == (0.0, 0.0, 300.0)
    assert isclose(one.heading_rad, pi / 2)
    assert isclose(two.position.north_m, 1111.4, abs_tol=1.0), "0.01 degrees of latitude"
    assert abs(two.position.east_m) < 1e-6
    assert mission.instances == (1, 2)
    assert mission.tasks[1].eligible == (2,)
    assert mission.daa.well_clear == WellClear(150.0, 30.0, 15.0, 0.0)


def test_the_schema_is_one() -> None:
    from jsonschema import Draft202012Validator

    Draft202012Validator.check_schema(mission_schema())


def test_every_object_of_the_schema_is_closed_and_described() -> None:
    def walk(node: object, path: str) -> None:
        if isinstance(node, dict):
            if node.get("type") == "object":
                assert node["additionalProperties"] is False, path
            for name, part in node.get("properties", {}).items():
                if isinstance(part, dict) and "$ref" not in part:
                    assert part.get("description"), f"{path}.{name} has no description"
            for name, part in node.items():
                walk(part, f"{path}.{name}")

    walk(mission_schema(), "mission")


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*/mission.yaml")), ids=str)
def test_examples_load(path: Path) -> None:
    mission = load(path)
    assert mission.vehicles
    assert expectations(path)["exit_code"] in (0, 1, 2, 3)


def change(path: str, value: object) -> dict:
    """The small mission with one value replaced (or added, or taken away by None)."""
    data: dict = small()
    node: object = data
    *way, last = item_key(path)
    for part in way:
        node = node[part]  # type: ignore[index]
    if value is None:
        del node[last]  # type: ignore[attr-defined]
    else:
        node[last] = value  # type: ignore[index]
    return data


@pytest.mark.parametrize(
    ("item", "value", "words"),
    [
        ("vehicles[0].id", 2, "used twice"),
        ("vehicles[0].speed_m_s", "fast", "wrong type"),
        ("vehicles[0].speed_m_s", -3, "out of range"),
        ("vehicles[0].heading_deg", 900, "out of range"),
        ("vehicles[0].speed_m_s", 40, "cannot fly at its cruise speed"),
        ("vehicles[0].heading_deg", None, "missing"),
        ("vehicles[0].wings", 2, "unknown entry"),
        ("vehicles[0].position", {"north_m": 1, "alt_m": 2}, "does not fit"),
        ("vehicles[0].position", {"north_m": 45, "east_m": -120, "alt_m": 2}, "degrees where metr"),
        ("vehicles[0].position", {"north_m": 1e6, "east_m": 0, "alt_m": 2}, "too far"),
        ("tasks[1].eligible", [3], "eligible vehicle that does not exist"),
        ("tasks[1].id", 1, "used twice"),
        ("tasks[0].kind", "orbit_search", "unknown value"),
        ("tasks[0].kind", "area_search", "1 vertices, and a polygon has at least 3"),
        ("tasks[1].points", [{"north_m": 0, "east_m": 0}], "needs a line"),
        ("tasks[0].points", [{"north_m": k, "east_m": 0} for k in (0, 1)], "has one point"),
        ("tasks[0].kind", "loiter", "needs a duration"),
        ("relations", "|(p1 p9)", "unknown task p9"),
        ("relations", "|(p1", "never closed"),
        ("relations", "p1", "not in its relations"),
        ("bridge", {"instances": 3}, "more ICAROUS instances than vehicles"),
        ("daa", {"well_clear": {"dthr_m": -1}}, "out of range"),
        ("daa", {"well_clear": {"dthr_m": float("nan")}}, "finite"),
        ("name", "../up", "not a valid name"),
        ("vehicles", [], "too few"),
    ],
)
def test_one_wrong_value(tmp_path: Path, item: str, value: object, words: str) -> None:
    error = refusal(tmp_path, change(item, value))
    assert words in str(error)
    assert error.item, "the message names the item"
    assert error.expected or "never closed" in words


@pytest.mark.parametrize(
    ("zone", "words"),
    [
        ([[-5, -5], [5, 5], [5, -5], [-5, 5]], "edge 1 (vertex 1 to 2) meets edge 3"),
        ([[0, 0], [9, 0], [9, 9], [0, 0.0]], "vertex 4 repeats vertex 1"),
        ([[0, 0], [9, 0], [4, 0], [4, 5]], "spike at vertex 2"),
        ([[0, 0], [4, 0], [9, 0]], "spike"),
        ([[0, 0], [9, 0], [9, 9], [4.5, 0], [0, 9]], "meets"),
    ],
)
def test_a_zone_that_is_no_polygon(tmp_path: Path, zone: list, words: str) -> None:
    data = small()
    data["zones"] = [{"id": 4, "kind": "keep_out", "vertices": zone}]
    error = refusal(tmp_path, data)
    assert words in str(error)
    assert "zone 4" in str(error)
    assert error.item == "zones[0].vertices"


def test_a_start_inside_a_keep_out(tmp_path: Path) -> None:
    data = small()
    data["zones"] = [{"id": 4, "kind": "keep_out", "vertices": SQUARE}]
    error = refusal(tmp_path, data)
    assert "vehicle 1 starts inside keep-out zone 4" in str(error)
    data["zones"][0]["ceiling_m"] = 200
    assert load(write(tmp_path, data)), "above the zone is outside"


def test_a_start_on_the_boundary_counts_as_inside_a_keep_out(tmp_path: Path) -> None:
    data = small()
    data["zones"] = [{"id": 4, "kind": "keep_out", "vertices": [[0, -9], [0, 9], [-9, 0]]}]
    assert "inside keep-out" in str(refusal(tmp_path, data))


def test_a_start_outside_a_keep_in(tmp_path: Path) -> None:
    data = small()
    data["zones"] = [{"id": 5, "kind": "keep_in", "vertices": SQUARE}]
    assert "vehicle 2 starts outside keep-in zone 5" in str(refusal(tmp_path, data))


def test_padding_binds_the_start(tmp_path: Path) -> None:
    data = small()
    near = [[10, -9], [10, 9], [30, 0]]
    data["zones"] = [{"id": 4, "kind": "keep_out", "vertices": near}]
    assert load(write(tmp_path, data))
    data["zones"][0]["padding_m"] = 20
    assert "inside keep-out" in str(refusal(tmp_path, data))


def test_padding_that_leaves_nothing(tmp_path: Path) -> None:
    data = small()
    data["zones"] = [{"id": 5, "kind": "keep_in", "vertices": SQUARE, "padding_m": 600}]
    assert "leaves nothing of zone 5" in str(refusal(tmp_path, data))


def test_all_problems_are_told_up_to_ten(tmp_path: Path) -> None:
    data = small()
    data["vehicles"][0] |= {"heading_deg": 900, "speed_m_s": 0, "wings": 2}
    with pytest.raises(BadMission) as caught:
        load(write(tmp_path, data))
    assert len(caught.value.problems) == 3
    assert len(caught.value.data()["more"]) == 2
    data["vehicles"][0] |= {f"entry{k}": k for k in range(20)}
    with pytest.raises(BadMission) as caught:
        load(write(tmp_path, data))
    assert len(caught.value.problems) == 10


def test_the_line_is_the_right_one(tmp_path: Path) -> None:
    text = CROSSING.read_text(encoding="utf-8").replace("speed_m_s: 22", "speed_m_s: -1", 1)
    error = refusal(tmp_path, text)
    line = int(error.where.rpartition(":")[2])
    assert "speed_m_s: -1" in text.splitlines()[line - 1]
    assert error.item == "vehicles[0].speed_m_s"
    assert error.got == "-1"


def test_a_misspelt_entry_is_guessed(tmp_path: Path) -> None:
    data = small()
    data["vehicles"][0]["heding_deg"] = data["vehicles"][0].pop("heading_deg")
    with pytest.raises(BadMission) as caught:
        load(write(tmp_path, data))
    assert any("heading_deg?" in problem.expected for problem in caught.value.problems)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "empty"),
        ("a: [1, 2", "not valid YAML"),
        ("a: 1\na: 2", "given twice"),
        ("a: 010", "two ways"),
        ("a: 1:30", "two ways"),
        ("a: &x [1]\nb: *x", "aliases"),
        ("a: .nan", "finite"),
        ("a: .inf", "finite"),
        ("a: 1e999", "finite"),
        ("[1]: 2", "plain word"),
        ("a: !!python/object:os.system x", "tags"),
        ("{" * 5000, ""),
    ],
)
def test_text_that_means_nothing_or_two_things(tmp_path: Path, text: str, words: str) -> None:
    assert words in str(refusal(tmp_path, text))


def test_numbers_as_people_write_them() -> None:
    data = parse_document("a: 1e3\nb: 1.5\nc: -7\nd: yes\ne: '010'\nf: 1_000", "x").data
    assert data == {"a": 1000.0, "b": 1.5, "c": -7, "d": True, "e": "010", "f": 1000}


def test_bytes_that_are_no_text(tmp_path: Path) -> None:
    path = tmp_path / "mission.yaml"
    path.write_bytes(b"name: \xff\xfe")
    with pytest.raises(BadInput, match="not a text file"):
        load(path)


@pytest.mark.parametrize("name", ["absent.yaml", "notes.txt"])
def test_not_a_mission_file(tmp_path: Path, name: str) -> None:
    (tmp_path / "notes.txt").write_text("hello")
    with pytest.raises(BadInput) as caught:
        load(tmp_path / name)
    assert name in caught.value.where


@given(st.lists(st.from_regex(r"[a-z_]+", fullmatch=True) | st.integers(0, 99), min_size=1))
def test_item_names_come_back(parts: list) -> None:
    key = ("root", *parts)
    assert item_key(item_name(key)) == key


@given(st.integers(1, 10_000))
def test_variants_meet_at_the_point(seed: int) -> None:
    mission = load_crossing(seed)
    one, two = mission.vehicles
    times = []
    for vehicle in (one, two):
        distance = hypot(vehicle.position.north_m, vehicle.position.east_m)
        times.append(distance / vehicle.speed_m_s)
        along = -(
            vehicle.position.north_m * cos(vehicle.heading_rad)
            + vehicle.position.east_m * cos(vehicle.heading_rad - pi / 2)
        )
        assert isclose(along, distance, rel_tol=1e-9), "the point lies straight ahead"
        assert 18 <= vehicle.speed_m_s <= 28
    assert isclose(*times, rel_tol=1e-9)
    turn = abs(one.heading_rad - two.heading_rad) % (2 * pi)
    assert radians(39.999) <= min(turn, 2 * pi - turn) <= radians(140.001)
    assert one.position.alt_m == two.position.alt_m
    assert load_crossing(seed) == mission


def load_crossing(seed: int) -> Mission:
    return load(CROSSING, seed)


def test_a_mission_without_variants(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="no variants"):
        load(write(tmp_path, small()), seed=1)


CORNER = st.tuples(st.integers(-6, 6), st.integers(-6, 6))


@given(st.lists(CORNER, min_size=3, max_size=6))
def test_polygons_agree_with_shapely(corners: list) -> None:
    import shapely

    ours = polygon_problem([(float(a), float(b)) for a, b in corners]) == ""
    ring = shapely.LinearRing(corners)
    # shapely allows a vertex in the middle of an edge that goes on straight, and so do we
    theirs = len(set(corners)) == len(corners) and ring.is_simple and ring.is_valid
    assert ours == (theirs and shapely.Polygon(corners).area > 0)


def test_padding_moves_the_outline_the_safe_way() -> None:
    out = Zone(1, ZoneKind.KEEP_OUT, ((0.0, 0.0), (0.0, 9.0), (9.0, 9.0), (9.0, 0.0)), 0, 1, 2.0)
    wide = padded(out, "f", "i")
    assert wide.padding_m == 0
    assert sorted(wide.vertices) == [(-2.0, -2.0), (-2.0, 11.0), (11.0, -2.0), (11.0, 11.0)]
    narrow = padded(Zone(1, ZoneKind.KEEP_IN, out.vertices, 0, 1, 2.0), "f", "i")
    assert sorted(narrow.vertices) == [(2.0, 2.0), (2.0, 7.0), (7.0, 2.0), (7.0, 7.0)]


@given(st.floats(0, 2 * pi), st.floats(1, 5000))
def test_circles_forbid_no_less(angle: float, radius: float) -> None:
    from cratous.core.kernel import Vec2

    on = Vec2(0.9999 * radius * cos(angle), 0.9999 * radius * cos(angle - pi / 2))
    assert locate(edges_of(circle((0.0, 0.0), radius, outside=True)), on) == INSIDE
    beyond = Vec2(1.0001 * on.x / 0.9999, 1.0001 * on.y / 0.9999)
    assert locate(edges_of(circle((0.0, 0.0), radius, outside=False)), beyond) == OUTSIDE


def test_a_rectangle_turns_from_north_to_east() -> None:
    plain = rectangle((10.0, 20.0), 4.0, 2.0, 0.0)
    assert sorted(plain) == [(9.0, 18.0), (9.0, 22.0), (11.0, 18.0), (11.0, 22.0)]
    turned = rectangle((0.0, 0.0), 0.5, 100.0, radians(90))
    assert max(abs(east) for _, east in turned) == pytest.approx(50.0)
