"""What is drawn in the editor, with what it gets of the mission's first vehicle."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from cratous.services.loading.document import parse_document
from cratous.services.loading.yaml_mission import loaded
from cratous.services.mission_editor.completed import completed
from cratous.services.mission_editor.sketch import sketch
from cratous.services.mission_editor.text_edits import MissionText
from cratous.spec.mission import Mission

ROOT = Path(__file__).resolve().parents[2]
SEARCH = (ROOT / "examples/search/mission.yaml").read_text(encoding="utf-8")
POPUP = (ROOT / "examples/popup/mission.yaml").read_text(encoding="utf-8")
PLACE = {"north_m": -700.5, "east_m": 300.0}


def text_with(text: str, name: str, item: dict[str, Any]) -> str:
    mission = MissionText(text, "m.yaml")
    return mission.added(name, completed(mission, name, item))


def mission_of(text: str) -> Mission:
    return loaded(parse_document(text, "m.yaml"))


def test_a_vehicle_is_as_the_first_one_at_another_place_with_an_id_of_its_own() -> None:
    text = text_with(SEARCH, "vehicles", {"position": PLACE})
    mission = mission_of(text)
    first, new = mission.vehicles[0], mission.vehicles[-1]
    assert (new.id, new.label) == (4, "vehicle 4")
    assert new.position == (-700.5, 300.0, first.position.alt_m)
    for name in ("speed_m_s", "min_speed_m_s", "max_speed_m_s", "max_bank_rad", "max_climb_m_s",
                 "heading_rad", "cameras", "cruise_m", "protected"):  # fmt: skip
        assert getattr(new, name) == getattr(first, name), name
    assert text.startswith(SEARCH[: SEARCH.index("tasks:")].rstrip())  # nothing else is touched
    keys = [place["key"] for place in sketch(text, "m.yaml")["places"]]
    assert ["vehicles", 3, "position"] in keys


def test_other_traffic_and_zones_to_come_keep_their_ids() -> None:
    data = MissionText(POPUP, "m.yaml").data
    taken = {one["id"] for one in (*data["vehicles"], *data.get("traffic", ()))}
    text = text_with(POPUP, "vehicles", {"position": PLACE})
    assert MissionText(text, "m.yaml").data["vehicles"][-1]["id"] not in taken
    corners = [[9000, 9000], [9000, 9100], [9100, 9100]]
    text = text_with(POPUP, "zones", {"kind": "keep_out", "vertices": corners})
    after = MissionText(text, "m.yaml").data
    later = {change["zone"]["id"] for change in data["changes"] if "zone" in change}
    assert later
    assert after["zones"][-1]["id"] not in later | {z["id"] for z in data.get("zones", ())}


def test_a_vehicle_that_starts_in_degrees_is_followed_by_one_in_metres() -> None:
    degrees = "position: {latitude_deg: 45.3, longitude_deg: -121.0, alt_m: 500}"
    text = SEARCH.replace("position: {north_m: 0, east_m: 0, alt_m: 500}", degrees)
    assert text != SEARCH
    new = mission_of(text_with(text, "vehicles", {"position": PLACE})).vehicles[-1]
    assert new.position == (-700.5, 300.0, 500.0)


@pytest.mark.parametrize("rest", ["", "vehicles: []\n"])
def test_the_first_vehicle_of_a_mission_has_the_stated_values(rest: str) -> None:
    text = f"name: new\nframe: {{latitude_deg: 45, longitude_deg: 9, terrain_m: 120}}\n{rest}"
    text = text_with(text, "vehicles", {"position": PLACE})
    text = text_with(text, "tasks", {"kind": "loiter", "points": [PLACE], "duration_s": 60})
    mission = mission_of(text)
    (vehicle,), (task,) = mission.vehicles, mission.tasks
    assert vehicle.position == (-700.5, 300.0, 420.0)
    assert (vehicle.id, vehicle.speed_m_s, vehicle.heading_rad) == (1, 20.0, 0.0)
    assert task.points[0].alt_m == 420.0


def test_a_loiter_is_at_the_altitude_of_the_first_vehicle_s_tasks_and_an_area_on_the_ground() -> (
    None
):
    loiter = {"kind": "loiter", "points": [PLACE], "radius_m": 260.5, "duration_s": 45}
    new = mission_of(text_with(SEARCH, "tasks", loiter)).tasks[-1]
    assert (new.kind, new.points[0].alt_m) == ("loiter", 500.0)
    assert (new.radius_m, new.duration_ms) == (260.5, 45_000)
    high = SEARCH.replace("    speed_m_s: 25", "    cruise_m: 650\n    speed_m_s: 25", 1)
    assert mission_of(text_with(high, "tasks", loiter)).tasks[-1].points[0].alt_m == 650.0
    said = {**loiter, "points": [{**PLACE, "alt_m": 300}]}
    assert mission_of(text_with(high, "tasks", said)).tasks[-1].points[0].alt_m == 300.0
    corners = [{"north_m": n, "east_m": e} for n, e in ((0, 300), (900, 300), (900, 900))]
    area = mission_of(text_with(SEARCH, "tasks", {"kind": "area_search", "points": corners}))
    assert [point.alt_m for point in area.tasks[-1].points] == [0.0, 0.0, 0.0]


def test_what_is_drawn_wrong_is_among_the_problems() -> None:
    crossed = [{"north_m": n, "east_m": e} for n, e in ((0, 0), (900, 900), (900, 0), (0, 900))]
    (problem,) = sketch(
        text_with(SEARCH, "tasks", {"kind": "area_search", "points": crossed}), "m.yaml"
    )["problems"]
    assert "not a valid polygon" in problem["error"]
    first = {"north_m": 0, "east_m": 0}
    found = sketch(text_with(SEARCH, "vehicles", {"position": first}), "m.yaml")["problems"]
    assert any("vehicle 4" in str(one) or "4" in one["error"] for one in found), found
