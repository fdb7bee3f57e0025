"""Flight plans in the text format of ground stations: `QGC WPL 110`.

A line has index, current, frame, command, four parameters, latitude, longitude, altitude,
autocontinue, separated by blanks or tabs. They are read as ICAROUS reads them: the first waypoint
is home, where the vehicle starts. Items other than waypoints and speeds are not flown, and are
noted.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.services.importing.imported_content import (
    Parts,
    Place,
    Way,
    altitude,
    latitude,
    longitude,
    number,
    whole,
)
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import at_most

HEAD = "QGC WPL"
VERSION = "110"
FIELDS = 12
MOST = 2000
"""Maximum number of waypoints of a plan."""
MSL, RELATIVE, TERRAIN = 0, 3, 10
FRAMES = {MSL: False, 5: False, RELATIVE: True, 6: True, TERRAIN: True, 11: True}
"""MAV_FRAME: whether an altitude is above ground; 5, 6 and 11 are the same with integers on the wire."""
WAYPOINT, RETURN, LAND, TAKEOFF, SPEED = 16, 20, 21, 22, 178
COMMANDS = {
    WAYPOINT: "waypoint", RETURN: "return to launch", LAND: "land", TAKEOFF: "take-off", SPEED: "speed",
}  # fmt: skip
SPEED_MOST = 350.0


class _Line(NamedTuple):
    where: str
    frame: int
    command: int
    parameters: tuple[float, ...]
    texts: list[str]


def read_qgc(text: str, file: str, label: str) -> Parts:
    """The route of a plan. Raises BadInput with line and item."""
    lines = text.splitlines()
    head = lines[0].split() if lines else []
    if head[:2] != HEAD.split() or head[2:] != [VERSION]:
        raise BadInput(
            "not a flight plan that is read", where=f"{file}:1", expected=f"{HEAD} {VERSION}",
            got=lines[0][:60] if lines else "nothing",
        )  # fmt: skip
    places, speeds, notes = list[Place](), list[float](), dict[str, None]()
    at_most(len(lines), 2 * MOST, "too many lines", file, "of them")
    for count, raw in enumerate(lines[1:], 2):
        if not raw.strip():
            continue
        line = _line(raw, f"{file}:{count}")
        if line.command == SPEED:
            speeds.append(number(line.parameters[1], line.where, "speed", 0.01, SPEED_MOST))
            continue
        if line.command == TAKEOFF:
            notes["take-off is not flown: the vehicle starts in the air, at its first waypoint"] = (
                None
            )
            continue
        if line.command == RETURN:
            if not places:
                raise BadInput("a return before any waypoint", where=line.where, item="command")
            notes["return to launch is flown as a waypoint at home"] = None
            places.append(places[0])
            continue
        if line.command == LAND:
            notes["landing is not flown: its place is a waypoint"] = None
        if line.command == WAYPOINT and line.parameters[0]:
            notes["hold times at waypoints are not flown"] = None
        places.append(_place(line, places))
    if len(places) < 2:
        raise BadInput(
            "a plan that leads nowhere", where=file, expected="two waypoints or more",
            got=str(len(places)),
        )  # fmt: skip
    if len(set(speeds)) > 1:
        notes[f"all legs are flown at the first speed, {speeds[0]:g} m/s"] = None
    way = Way(label, tuple(places), speeds[0] if speeds else None, file)
    return Parts(ways=(way,), notes=tuple(f"{file}: {note}" for note in notes))


def _line(raw: str, where: str) -> _Line:
    texts = raw.split()
    if len(texts) != FIELDS:
        raise BadInput(
            "not a line of a flight plan",
            where=where,
            expected=f"{FIELDS} fields",
            got=str(len(texts)),
        )
    whole(texts[0], where, "index", 2 * MOST)
    frame = whole(texts[2], where, "frame", 255)
    command = whole(texts[3], where, "command", 65535)
    if command not in COMMANDS:
        known = ", ".join(f"{k} ({name})" for k, name in COMMANDS.items())
        raise BadInput(
            "a command that is not read", where=where, item="command", expected=known, got=texts[3]
        )
    names = [f"parameter {k}" for k in range(1, 5)]
    parameters = [number(t, where, n, -1e9, 1e9) for t, n in zip(texts[4:8], names, strict=True)]
    return _Line(where, frame, command, tuple(parameters), texts)


def _place(line: _Line, before: list[Place]) -> Place:
    if line.frame not in FRAMES:
        raise BadInput(
            "a frame that is not read", where=line.where, item="frame",
            expected=f"{MSL} (above sea level), {RELATIVE} (above home) or {TERRAIN} (above terrain)",
            got=str(line.frame),
        )  # fmt: skip
    lat, lon, alt = line.texts[8:11]
    place = Place(
        latitude(lat, line.where), longitude(lon, line.where), altitude(alt, line.where),
        FRAMES[line.frame],
    )  # fmt: skip
    if (place.latitude_deg, place.longitude_deg) == (0.0, 0.0) and before:
        raise BadInput(
            "a waypoint without a place", where=line.where, item="latitude",
            expected="its latitude and longitude", got="0, 0",
        )  # fmt: skip
    return place
