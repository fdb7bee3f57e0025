"""Completes an item drawn on the map: an id, and missing values taken from the first vehicle."""

from __future__ import annotations

import copy
from typing import Any

from cratous.services.mission_editor.text_edits import PLACE, MissionText
from cratous.spec.mission import TaskKind

VEHICLES, TASKS, ZONES = LISTS = ("vehicles", "tasks", "zones")
"""Lists to which items can be added on the map."""
ABOVE_TERRAIN_M, SPEED_M_S, HEADING_DEG = 300, 20, 0
"""Defaults for the first vehicle of a mission."""
AT_AN_ALTITUDE = (TaskKind.MUST_FLY, TaskKind.LOITER)
"""Task kinds whose point is at flight altitude."""


def completed(mission: MissionText, name: str, item: dict[str, Any]) -> dict[str, Any]:
    """The item as added to a list, with the next unused id.

    A vehicle given as `position` {north_m, east_m} gets all other values of the first vehicle,
    except its label. A point to fly through or to loiter at, without `alt_m`, gets the altitude at
    which the first vehicle performs its tasks.
    """
    number = _next_id(mission, name)
    if name == VEHICLES:
        like = _first(mission)
        like["position"] = {**item["position"], "alt_m": like["position"]["alt_m"]}
        like.pop("label", None)
        return {**like, "id": number}
    if item.get("kind") in AT_AN_ALTITUDE and isinstance(item.get("points"), list):
        first = _first(mission)
        alt_m = first.get("cruise_m", first["position"]["alt_m"])
        item = {**item, "points": [_at(point, alt_m) for point in item["points"]]}
    return {"id": number, **item}


def _at(point: Any, alt_m: Any) -> Any:
    return {**point, "alt_m": alt_m} if isinstance(point, dict) and "alt_m" not in point else point


def _first(mission: MissionText) -> dict[str, Any]:
    """The first vehicle with position and altitude, or a default."""
    for one in _items(mission, VEHICLES):
        place = one.get("position")
        if isinstance(place, dict) and type(place.get("alt_m")) in (int, float):
            return copy.deepcopy(one)
    frame = mission.data.get("frame")
    terrain_m: Any = frame.get("terrain_m", 0) if isinstance(frame, dict) else 0
    above_m = (terrain_m if type(terrain_m) in (int, float) else 0) + ABOVE_TERRAIN_M
    position = {**dict.fromkeys(PLACE, 0), "alt_m": above_m}
    return {"id": 0, "position": position, "heading_deg": HEADING_DEG, "speed_m_s": SPEED_M_S}


def _items(mission: MissionText, name: str) -> list[dict[str, Any]]:
    """The mappings in a list of the file."""
    found = mission.data.get(name)
    return [one for one in found if isinstance(one, dict)] if isinstance(found, list) else []


def _next_id(mission: MissionText, name: str) -> int:
    """An id not used by an item of the list, nor by a later zone, nor by other traffic."""
    items = _items(mission, name)
    if name == ZONES:
        later = [change.get("zone") for change in _items(mission, "changes")]
        items += [zone for zone in later if isinstance(zone, dict)]
    if name == VEHICLES:
        items += _items(mission, "traffic")
    return max([0, *(one["id"] for one in items if isinstance(one.get("id"), int))]) + 1
