"""Plans in tables: `.eutl` (points in time, as in NASA's plan files) and `.daa` (encounters).

An `.eutl` has named columns (id, lat lon alt or sx sy sz, time), a line of units, and a row per
point; rows with the same id form one plan. In a `.daa` the ownship flies from its first position to
its last, as in ICAROUS; the other aircraft are traffic.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from cratous.services.importing import imported_content
from cratous.services.mission.frames import Projection
from cratous.spec.daa.encounter_files import Row, parse
from cratous.spec.daa.parameters import UNITS
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import at_most
from cratous.spec.mission import Frame

COLUMNS = {
    "id": ("id", "aircraft"), "lat": ("lat", "latitude"), "lon": ("lon", "long", "longitude"),
    "x": ("sx",), "y": ("sy",), "alt": ("alt", "altitude", "sz"), "time": ("time", "tm", "st"),
}  # fmt: skip
USUAL = {"lat": "deg", "lon": "deg", "x": "nmi", "y": "nmi", "alt": "ft", "time": "s"}
TURNS = ("tcp_trk", "tcp_gs", "tcp_vs")
"""Columns that tell how a plan turns, and changes speed and climb rate, at its points."""
NONE = {"", "-", "none", "unitless"}
MOST = 2000
"""Maximum number of points in a file."""


class _Point(NamedTuple):
    where: str
    id: str
    time_s: float
    place: imported_content.Place


def read_eutl(text: str, file: str, how: imported_content.Reading) -> imported_content.Parts:
    """The routes of all plans in a file, in order of first occurrence. Raises BadInput with line and column."""
    points, curved = list[_Point](), False
    for point, turns in _points(text, file, how):
        points.append(point)
        curved = curved or turns
    ways = []
    for name in dict.fromkeys(point.id for point in points):
        mine = [point for point in points if point.id == name]
        _in_order(mine)
        if len(mine) < 2:
            raise BadInput(
                "a plan that leads nowhere", where=mine[0].where, item=name, expected="two points"
            )
        places = tuple(point.place for point in mine)
        spent_s = mine[-1].time_s - mine[0].time_s
        ways.append(imported_content.Way(name, places, _length_m(places) / spent_s, mine[0].where))
    if not ways:
        raise BadInput("the file has no points", where=file, expected="a header, units and rows")
    notes = [f"{file}: all legs are flown at the mean speed of the plan, its times are not kept"]
    if curved:
        notes.append(
            f"{file}: turns are the vehicle's own, those of the plan's points are not flown"
        )
    return imported_content.Parts(ways=tuple(ways), notes=tuple(notes))


def _in_order(points: Sequence[_Point]) -> None:
    for before, after in pairwise(points):
        earlier, later = before.time_s, after.time_s
        if not earlier < later:
            raise BadInput(
                "points are out of order", where=after.where, item="time",
                expected=f"later than {earlier:g} s", got=f"{later:g} s",
            )  # fmt: skip


def _points(text: str, file: str, how: imported_content.Reading) -> Iterator[tuple[_Point, bool]]:
    names: list[str] | None = None
    units, first = dict[str, str](USUAL), True
    for count, raw in enumerate(io.StringIO(text, newline=None), 1):
        line = raw.split("#", 1)[0].strip()
        where = f"{file}:{count}"
        at_most(count, 2 * MOST, "too many lines", where, "of them")
        if not line or (names is None and "=" in line):
            continue
        cells = [p.strip() for p in line.split(",")] if "," in line else line.split()
        if names is None:
            names = _header(cells, where)
            continue
        if len(cells) != len(names):
            raise BadInput(
                "a row of another length", where=where, expected=f"{len(names)} values",
                got=str(len(cells)),
            )  # fmt: skip
        row = dict(zip(names, cells, strict=True))
        if first and _is_units(row):
            units.update(_units(row, where))
            first = False
            continue
        first = False
        turns = any(row.get(name, "").lower() not in NONE for name in TURNS)
        yield _point(row, units, where, how), turns


def _header(cells: Sequence[str], where: str) -> list[str]:
    by_name = {other: name for name, others in COLUMNS.items() for other in others}
    names = [by_name.get(part.lower(), part.lower()) for part in cells]
    for ways in (({"id"},), ({"lat", "lon"}, {"x", "y"}), ({"alt"},), ({"time"},)):
        if not any(way <= set(names) for way in ways):
            raise BadInput(
                "a column is missing", where=where,
                expected=" or ".join(" and ".join(sorted(way)) for way in ways), got=", ".join(cells)[:80],
            )  # fmt: skip
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise BadInput("a column is given twice", where=where, item=twice[0])
    return names


def _is_units(row: dict[str, str]) -> bool:
    return all(
        row[name].strip("[]").lower() in {u.lower() for u in UNITS} for name in ("alt", "time")
    )


def _units(row: dict[str, str], where: str) -> dict[str, str]:
    by_lower = {name.lower(): name for name in UNITS} | {"nm": "nmi"}
    found = {}
    for name, usual in USUAL.items():
        if name not in row:
            continue
        unit = by_lower.get(row[name].strip("[]").lower(), "")
        if unit not in UNITS or UNITS[unit][0] != UNITS[usual][0]:
            raise BadInput(
                "a unit that does not fit", where=where, item=name, expected=usual, got=row[name]
            )
        found[name] = unit
    return found


def _point(
    row: dict[str, str], units: dict[str, str], where: str, how: imported_content.Reading
) -> _Point:
    def amount(name: str) -> float:
        return imported_content.number(row[name], where, name, -1e10, 1e10) * UNITS[units[name]][1]

    alt_m = imported_content.altitude(amount("alt"), where)
    if "lat" in row:
        lat, lon = math.degrees(amount("lat")), math.degrees(amount("lon"))
        place = imported_content.Place(
            imported_content.latitude(lat, where),
            imported_content.longitude(lon, where),
            alt_m,
            False,
        )
    else:
        place = _from_metres(amount("y"), amount("x"), alt_m, where, how)
    return _Point(where, row["id"], amount("time"), place)


def _from_metres(
    north_m: float, east_m: float, alt_m: float, where: str, how: imported_content.Reading
) -> imported_content.Place:
    if how.origin is None:
        raise BadInput(
            "places in metres from nowhere", where=where, expected="--origin LATITUDE,LONGITUDE",
            got="sx and sy",
        )  # fmt: skip
    plane = Projection(Frame(*how.origin))
    imported_content.number(
        math.hypot(north_m, east_m), where, "distance from the origin", 0, 100_000
    )
    return imported_content.Place(*plane.to_geodetic(north_m, east_m), alt_m, False)


def _length_m(places: Sequence[imported_content.Place]) -> float:
    plane = Projection(Frame(places[0].latitude_deg, places[0].longitude_deg))
    flat = [plane.to_local(place.latitude_deg, place.longitude_deg) for place in places]
    return sum(math.dist(a, b) for a, b in pairwise(flat))


def read_daa(text: str, file: str, how: imported_content.Reading) -> imported_content.Parts:
    """The ownship's route from its first position to its last, and all other aircraft from their
    first positions.
    """
    found = parse(text, file)
    first, last = dict[str, Row](), dict[str, Row]()
    for _, rows in found.steps:
        for row in rows:
            first.setdefault(row.id, row)
            last[row.id] = row
    own, end = first[found.ownship], last[found.ownship]
    places = tuple(_of_row(row, file, how) for row in (own, end))
    if own.line == end.line:
        raise BadInput(
            "a plan that leads nowhere", where=file, expected="two states of the ownship"
        )
    speed = _length_m(places) / (end.time_s - own.time_s)
    way = imported_content.Way(found.ownship, places, speed, f"{file}:{own.line}")
    others = tuple(
        _intruder(k, row, file, how, row.time_s - own.time_s)
        for k, row in enumerate((row for name, row in first.items() if name != found.ownship), 1)
    )
    notes = [
        f"{file}: the ownship flies straight from its first place to its last, the others straight on"
    ]
    notes += [f"{file}: left out: {what}" for what in found.left_out]
    return imported_content.Parts(ways=(way,), intruders=others, notes=tuple(notes))


def _of_row(row: Row, file: str, how: imported_content.Reading) -> imported_content.Place:
    where, v = f"{file}:{row.line}", row.values
    alt_m = imported_content.altitude(v["alt"], where)
    if row.geodetic:
        lat, lon = math.degrees(v["lat"]), math.degrees(v["lon"])
        return imported_content.Place(
            imported_content.latitude(lat, where),
            imported_content.longitude(lon, where),
            alt_m,
            False,
        )
    return _from_metres(v["y"], v["x"], alt_m, where, how)


def _intruder(
    k: int, row: Row, file: str, how: imported_content.Reading, appears_s: float
) -> imported_content.Intruder:
    place, v = _of_row(row, file, how), row.values
    moves = (v["vy"], v["vx"], -v["vs"])
    return imported_content.Intruder(
        k, place, 0.0, 0.0, place.alt_m, moves, max(0.0, appears_s), f"{file}:{row.line}"
    )
