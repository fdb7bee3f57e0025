"""Content of a mission text for the page: what is drawn, what can be moved, and what is wrong."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any

from cratous.services.ground_station.flight_display import FlownRecording
from cratous.services.loading.coordinates import Places
from cratous.services.loading.document import Document, Key, parse_document
from cratous.services.loading.problems import BadMission
from cratous.services.loading.yaml_mission import drawn, loaded
from cratous.services.mission_editor.text_edits import DEGREES, HEADING, PLACE, RADIUS
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission

_LINE = re.compile(r":(\d+)(?::\d+)?$")
NO_PLACES = ("frame", "variation", "expect")
"""Sections whose positions do not belong to map objects."""

LISTED = ("places", "numbers", "problems", "notes", "tasks")


def sketch(text: str, where: str) -> dict[str, Any]:
    """drawn: for the map, None if the text cannot be read; places: movable positions with their
    keys; numbers: headings [deg] and radii [m] shown on the map, each with its key and that of its
    position (of); problems: faults with their lines; notes: the mission's notes; tasks: their ids;
    relations: the process-algebra text.
    """
    found: dict[str, Any] = {"drawn": None, **{name: [] for name in LISTED}}
    try:
        document = parse_document(text, where)
        mission = drawn(document)
        # invalid objects are drawn too, so that they can be corrected on the map
        found |= _shown(document, mission)
        found["notes"] = list(loaded(document).notes)
    except BadInput as error:
        problems = error.problems if isinstance(error, BadMission) else (error,)
        found["problems"] = [_problem(one) for one in problems]
    return found


def _problem(error: BadInput) -> dict[str, Any]:
    line = _LINE.search(error.where)
    return {**error.data(), "line": int(line.group(1)) if line else None}


def _shown(document: Document, mission: Mission) -> dict[str, Any]:
    first = FlownRecording(mission).first()
    starts = [
        {
            "id": vehicle.id,
            "north_m": vehicle.position.north_m,
            "east_m": vehicle.position.east_m,
            "heading_deg": math.degrees(vehicle.heading_rad),
        }
        for vehicle in mission.vehicles
    ]
    places = Places(mission.frame)
    return {
        "drawn": {**first, "starts": starts},
        "places": [
            {"key": list(key), "north_m": north_m, "east_m": east_m}
            for key, (north_m, east_m) in _places(document.data, (), places)
        ],
        "numbers": [
            {"key": list(key), "of": list(of), "value": value}
            for key, of, value in _numbers(document.data)
        ],
        "tasks": [task.id for task in mission.tasks],
        "relations": document.data.get("relations") or "",
    }


def _places(data: Any, key: Key, places: Places) -> Iterator[tuple[Key, tuple[float, float]]]:
    """Every position in a mission, with its key."""
    if isinstance(data, dict):
        if set(PLACE) <= set(data) or set(DEGREES) <= set(data):
            yield key, places.horizontal(data)
            return
        for name, value in data.items():
            if key or name not in NO_PLACES:
                yield from _places(value, (*key, name), places)
    elif isinstance(data, list):
        corners = bool(key) and key[-1] == "vertices"
        for number, value in enumerate(data):
            if corners and isinstance(value, list):
                yield (*key, number), places.vertex(value)
            else:
                yield from _places(value, (*key, number), places)


def _numbers(data: Any) -> Iterator[tuple[Key, Key, float]]:
    """Each heading and radius that belongs to a position: its key, that of the position, and the number."""
    for k, vehicle in enumerate(data.get("vehicles", ())):
        key: Key = ("vehicles", k)
        yield (*key, HEADING), (*key, "position"), float(vehicle[HEADING]) % 360
    for k, task in enumerate(data.get("tasks", ())):
        key, loiter = ("tasks", k), task.get("loiter", {})
        first: Key = (*key, "points", 0)
        if "circle" in task:
            within: Key = (*key, "circle")
            yield (*within, RADIUS), (*within, "centre"), float(task["circle"][RADIUS])
        if RADIUS in loiter:
            within = (*key, "loiter")
            centre = (*within, "centre") if "centre" in loiter else first
            yield (*within, RADIUS), centre, float(loiter[RADIUS])
        elif RADIUS in task:
            yield (*key, RADIUS), first, float(task[RADIUS])
    for k, site in enumerate(data.get("landing_sites", ())):
        key = ("landing_sites", k)
        yield (*key, RADIUS), (*key, "position"), float(site[RADIUS])
