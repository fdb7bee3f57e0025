"""What the editor shows of a text: its shapes, what is wrong with it, and its relations."""

from __future__ import annotations

from pathlib import Path

from cratous.services.mission_editor.relations import relations
from cratous.services.mission_editor.sketch import sketch

ROOT = Path(__file__).resolve().parents[2]
CROSSING = (ROOT / "examples/crossing/mission.yaml").read_text(encoding="utf-8")
RELATIONS = (ROOT / "examples/relations/mission.yaml").read_text(encoding="utf-8")


def test_a_mission_is_drawn_with_its_starts_and_places() -> None:
    found = sketch(CROSSING, "m.yaml")
    assert found["problems"] == []
    assert found["tasks"] == [1, 2]
    assert found["relations"] == "|(p1 p2)"
    assert found["drawn"]["starts"][1] == {
        "id": 2, "north_m": 0.0, "east_m": -2200.0, "heading_deg": 90.0,
    }  # fmt: skip
    keys = [place["key"] for place in found["places"]]
    # the point of `variation` is that of no thing
    assert ["tasks", 0, "points", 1] in keys
    assert all(key[0] in ("vehicles", "tasks") for key in keys)
    zones = [place["key"] for place in sketch(RELATIONS, "m.yaml")["places"]]
    assert ["zones", 1, "vertices", 3] in zones


def test_what_is_wrong_is_told_with_its_line_and_drawn_all_the_same() -> None:
    text = CROSSING.replace("eligible: [2]", "eligible: [5]")
    found = sketch(text, "m.yaml")
    (problem,) = found["problems"]
    assert problem["line"] == 1 + text[: text.index("eligible: [5]")].count("\n")
    assert "5" in problem["got"] + problem["error"]
    assert found["drawn"] is not None


def test_a_text_that_cannot_be_read_is_not_drawn() -> None:
    found = sketch(CROSSING.replace("vehicles:", "vehicles: ["), "m.yaml")
    assert found["drawn"] is None
    assert "not valid YAML" in found["problems"][0]["error"]
    found = sketch("name: x\n", "m.yaml")
    assert found["drawn"] is None
    assert {problem["item"] for problem in found["problems"]} >= {"frame", "vehicles", "tasks"}


def test_relations_are_a_tree_or_an_error_with_its_place() -> None:
    told = relations("|(p1 .(p2 p3)_[0-100])", [1, 2, 3])
    assert told["tree"]["parts"][1]["suffix"] == "_[0-100]"
    assert any("p3 starts no earlier than p2 ends" in row for row in told["rows"])
    error = relations("|(p1 .(p2 p4))", [1, 2, 3])["error"]
    assert error["offset"] == 10
    assert relations("|(p1 p2", [1, 2])["error"]["offset"] == 7
    assert relations("", [1, 2])["canonical"] == "|(p1 p2)"
