"""Changes of a mission's text say what was asked, and leave every other character as it was."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.services.loading.document import parse_document
from cratous.services.mission_editor.sketch import sketch
from cratous.services.mission_editor.text_edits import MissionText
from cratous.spec.errors import BadInput

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "examples").glob("*/mission.yaml"))
TEXTS = {path.parent.name: path.read_text(encoding="utf-8") for path in EXAMPLES}
ZONE = {"id": 70, "kind": "keep_out", "vertices": [[1, 2], [3.5, 4], [5, -6]]}


def data(text: str) -> Any:
    return parse_document(text, "m.yaml").data


def taken_out(old: str, new: str) -> list[str]:
    """The lines that only the old text has."""
    left = new.split("\n")
    found = []
    for line in old.split("\n"):
        if line in left:
            left.remove(line)
        else:
            found.append(line)
    return found


@pytest.mark.parametrize("name", TEXTS)
def test_every_place_of_the_examples_moves_and_one_line_changes(name: str) -> None:
    text = TEXTS[name]
    for place in sketch(text, "m.yaml")["places"]:
        key = tuple(place["key"])
        new = MissionText(text, "m.yaml").moved(key, 12.34, -77.0)
        (moved,) = (p for p in sketch(new, "m.yaml")["places"] if p["key"] == place["key"])
        assert (moved["north_m"], moved["east_m"]) == (12.3, -77.0)
        assert len(taken_out(text, new)) <= 2
        wanted = copy.deepcopy(data(text))
        holder = wanted
        for part in key[:-1]:
            holder = holder[part]
        if isinstance(holder[key[-1]], list):
            holder[key[-1]] = [12.3, -77.0]
        else:
            holder[key[-1]] |= {"north_m": 12.3, "east_m": -77.0}
        assert data(new) == wanted


@pytest.mark.parametrize("name", TEXTS)
def test_every_heading_and_radius_of_the_examples_changes_and_nothing_else(name: str) -> None:
    text = TEXTS[name]
    found = sketch(text, "m.yaml")
    places = [place["key"] for place in found["places"]]
    assert len(found["numbers"]) >= len(data(text).get("vehicles", ()))
    for number in found["numbers"]:
        key = tuple(number["key"])
        assert number["of"] in places
        new = MissionText(text, "m.yaml").with_number(key, 123.44)
        (changed,) = (n for n in sketch(new, "m.yaml")["numbers"] if n["key"] == number["key"])
        assert changed["value"] == 123.4
        assert len(taken_out(text, new)) <= 1
        wanted = copy.deepcopy(data(text))
        holder = wanted
        for part in key[:-1]:
            holder = holder[part]
        holder[key[-1]] = 123.4
        assert data(new) == wanted


@pytest.mark.parametrize(
    "key", [(), ("name",), ("vehicles", 0, "speed_m_s"), ("vehicles", 9, "heading_deg"), ("seed",)]
)
def test_what_is_no_heading_or_radius_is_not_changed_as_one(key: tuple[str | int, ...]) -> None:
    with pytest.raises(BadInput, match="this is no heading or radius"):
        MissionText(TEXTS["crossing"], "m.yaml").with_number(key, 1.0)
    with pytest.raises(BadInput, match="this is no heading or radius"):
        MissionText("a: {radius_m: {b: 1}}", "m.yaml").with_number(("a", "radius_m"), 1.0)


@pytest.mark.parametrize("name", TEXTS)
def test_an_item_is_added_and_removed_again(name: str) -> None:
    text = TEXTS[name]
    new = MissionText(text, "m.yaml").added("zones", ZONE)
    before = data(text).get("zones", [])
    assert data(new)["zones"] == [*before, ZONE]
    assert taken_out(text, new) == []  # no line of the old text is gone
    again = MissionText(new, "m.yaml").removed(("zones", len(before)))
    assert data(again) == data(text)
    assert again.rstrip() == text.rstrip()


WAYS = {
    "block": "zones:\n  - id: 1  # one\n    a: [1, 2]\n  # between\n  - id: 2\nlast: 3\n",
    "flow": "zones: [{id: 1, a: [1, 2]}, {id: 2}]  # told\nlast: 3\n",
    "empty": "zones: []\nlast: 3\n",
    "at the end": "last: 3\nzones:\n- {id: 1}\n- id: 2",
    "windows": "zones:\r\n  - id: 1\r\n  - id: 2\r\nlast: 3\r\n",
}


@pytest.mark.parametrize("way", WAYS)
def test_each_way_to_write_a_list(way: str) -> None:
    text = WAYS[way]
    new = MissionText(text, "m.yaml").added("zones", {"id": 3, "kind": "keep_out"})
    assert data(new)["zones"] == [*data(text)["zones"], {"id": 3, "kind": "keep_out"}]
    assert data(new)["last"] == 3
    for number in range(len(data(text)["zones"])):
        less = MissionText(text, "m.yaml").removed(("zones", number))
        wanted = [one for k, one in enumerate(data(text)["zones"]) if k != number]
        assert data(less) == {"zones": wanted, "last": 3}
    if "#" in text:
        assert "#" in new


def test_a_list_whose_only_item_goes_goes_too() -> None:
    text = "a: 1\n# about zones\nzones:\n  - id: 1\nb: 2\n"
    assert MissionText(text, "m.yaml").removed(("zones", 0)) == "a: 1\n# about zones\nb: 2\n"


def test_a_place_in_degrees_stays_in_degrees() -> None:
    text = (
        "frame: {latitude_deg: 37.1, longitude_deg: -76.4}\n"
        "p: {latitude_deg: 37.2, longitude_deg: -76.3} # here\n"
    )
    new = MissionText(text, "m.yaml").moved(("p",), 1000.0, -500.0)
    place = data(new)["p"]
    assert place["latitude_deg"] == pytest.approx(37.109, abs=1e-3)
    assert place["longitude_deg"] == pytest.approx(-76.4056, abs=1e-3)
    assert new.endswith("# here\n")


@pytest.mark.parametrize(
    ("text", "relations"),
    [
        ('relations: "|(p1 p2)"  # both\n', "~(p1 p2)"),
        ("relations: |\n  |(p1\n   p2)\nlast: 3\n", "p1"),
        ("relations: >-\n  |(p1\n   p2)\nlast: 3\n", 'a "quoted" \\ text: # no comment'),
        ("a: 1\n", "+(p1 p2)"),
    ],
)
def test_a_text_is_put_in_place_of_another(text: str, relations: str) -> None:
    new = MissionText(text, "m.yaml").put(("relations",), relations)
    assert data(new) == {**data(text), "relations": relations}
    assert ("# both" in new) == ("# both" in text)


@pytest.mark.parametrize(
    ("change", "item"),
    [
        (lambda m: m.moved(("a",), 1.0, 2.0), "a"),
        (lambda m: m.moved(("none", 3), 1.0, 2.0), "none[3]"),
        (lambda m: m.put(("b", "c"), "x"), "b.c"),
        (lambda m: m.removed(("a",)), "a"),
        (lambda m: m.removed(("list", 9)), "list[9]"),
        (lambda m: m.removed(()), ""),
        (lambda m: m.added("a", {"id": 1}), "a"),
        (lambda m: m.removed(("deep", 0, "list", 0)), "deep[0].list[0]"),
    ],
)
def test_what_cannot_be_changed_is_refused_by_name(change: Any, item: str) -> None:
    text = "a: 1\nb: {d: 2}\nlist:\n  - 1\ndeep:\n  - list:\n    - 1\n"
    with pytest.raises(BadInput) as told:
        change(MissionText(text, "m.yaml"))
    assert told.value.item == item


def test_a_change_that_would_mean_something_else_is_refused() -> None:
    flow = "{a: 1, b: 2}\n"
    with pytest.raises(BadInput, match="without changing more"):
        MissionText(flow, "m.yaml").added("zones", {"id": 1})


WORDS = st.text(st.characters(codec="utf-8", exclude_categories=["C"]), max_size=12)


@given(WORDS, st.floats(-1e5, 1e5), st.floats(-1e5, 1e5), st.sampled_from(["\n", "\r\n"]))
def test_whatever_a_comment_or_label_says(label: str, north: float, east: float, end: str) -> None:
    lines = ["# " + label.replace("\x85", "").replace("\u2028", "").replace("\u2029", "")]
    lines += ["p: {north_m: 1, east_m: 2}", "zones:", "  - {id: 1}", "# end"]
    text = end.join(lines) + end
    new = MissionText(text, "m.yaml").moved(("p",), north, east)
    assert data(new)["p"]["north_m"] == pytest.approx(north, abs=0.051)
    put = MissionText(new, "m.yaml").put(("relations",), label)
    assert data(put)["relations"] == label
    assert data(MissionText(put, "m.yaml").added("zones", {"id": 2, "label": label}))["zones"] == [
        {"id": 1},
        {"id": 2, "label": label},
    ]


def test_a_word_stands_as_it_is_and_one_that_yaml_reads_otherwise_in_quotes() -> None:
    text = MissionText("tasks:\n  - id: 1\n    kind: must_fly\n", "m.yaml").added(
        "tasks", {"id": 3, "kind": "loiter", "label": "on", "wavelength": "no"}
    )
    assert '    kind: loiter\n    label: "on"\n    wavelength: "no"\n' in text
