"""Reading encounter files (`.daa`, `.xyz`): states of aircraft over time.

`#` begins a comment; `key = value [unit]` lines may come first; then a header line of column names in any order, an
optional line of units (in brackets or not), and one row per state. Columns are separated by commas, blanks or tabs.
Rows of one time form a step; the first aircraft is the ownship unless another one is chosen. Every error names file,
line and column, and what was expected and found.
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from cratous.spec.daa.conf_files import Entry, value_of
from cratous.spec.daa.parameters import KEYS, OLD_NAMES, UNITS
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import ENCOUNTER_ROWS, at_most
from cratous.spec.files.text_file import text_of

COLUMNS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "id": (("name", "aircraft", "id"), "", ""),
    "time": (("time", "tm", "st", "clock"), "s", "s"),
    "lat": (("lat", "latitude"), "rad", "deg"),
    "lon": (("lon", "long", "longitude"), "rad", "deg"),
    "x": (("sx",), "m", "nmi"),
    "y": (("sy",), "m", "nmi"),
    "alt": (("alt", "altitude", "sz"), "m", "ft"),
    "vx": (("vx",), "m_s", "knot"),
    "vy": (("vy",), "m_s", "knot"),
    "vs": (("vs", "verticalspeed", "hdot", "vz"), "m_s", "fpm"),
    "trk": (("trk", "track"), "rad", "deg"),
    "gs": (("gs", "groundspeed", "groundspd"), "m_s", "knot"),
    "heading": (("heading",), "rad", "deg"),
    "airspeed": (("airspeed",), "m_s", "knot"),
    "alerter": (("alerter",), "", ""),
    "s_ew": (("s_ew_std", "s_ew"), "m", "nmi"),
    "s_ns": (("s_ns_std", "s_ns"), "m", "nmi"),
    "s_en": (("s_en_std", "s_en"), "m", "nmi"),
    "s_z": (("sz_std",), "m", "ft"),
    "v_ew": (("v_ew_std", "v_ew"), "m_s", "knot"),
    "v_ns": (("v_ns_std", "v_ns"), "m_s", "knot"),
    "v_en": (("v_en_std", "v_en"), "m_s", "knot"),
    "v_z": (("vz_std",), "m_s", "fpm"),
}
"""Columns: their names in files, their dimension, and the unit if the file gives none."""
MOST = {
    "time": 1e10, "lat": math.pi / 2, "lon": 2 * math.pi, "x": 1e8, "y": 1e8, "alt": 1e5,
    "vx": 1e4, "vy": 1e4, "vs": 1e4, "trk": 4 * math.pi, "gs": 1e4, "heading": 4 * math.pi,
    "airspeed": 1e4, "alerter": 1e3, "s_ew": 1e6, "s_ns": 1e6, "s_en": 1e6, "s_z": 1e6,
    "v_ew": 1e4, "v_ns": 1e4, "v_en": 1e4, "v_z": 1e4,
}  # fmt: skip
"""The largest magnitude of a value in SI: beyond any aircraft state, and far below overflow when squared."""
NAMES = {name: column for column, (names, _, _) in COLUMNS.items() for name in names}
_SPLIT = re.compile(r"\s*,\s*|\s+")
_SETTING = re.compile(r"^([A-Za-z]\w*)\s*=\s*(.+)$")


@dataclass(frozen=True)
class Row:
    """One state in SI, as given in the file; `settings`: parameters that its row sets."""

    line: int
    id: str
    time_s: float
    values: dict[str, float]
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def geodetic(self) -> bool:
        """Whether the position is a latitude and longitude."""
        return "lat" in self.values


@dataclass(frozen=True)
class Encounters:
    """The steps of a file, each (time, rows with the ownship first), and what was left out and why."""

    file: str
    ownship: str
    settings: dict[str, Any]
    steps: tuple[tuple[float, tuple[Row, ...]], ...]
    left_out: tuple[str, ...]


def _parts(line: str) -> list[str]:
    return [part for part in _SPLIT.split(line.strip()) if part]


class _Table:
    """Header and units of a file."""

    def __init__(self, file: str, line: int, names: list[str]) -> None:
        self.file = file
        self.columns: list[str] = []
        for name in names:
            low = name.lower()
            key = OLD_NAMES.get(low, low)
            column = NAMES.get(low, key if key in KEYS else "")
            if not column:
                close = get_close_matches(low, [*NAMES, *KEYS], 3)
                near = f", such as {', '.join(close)}" if close else ""
                raise BadInput("an unknown column", where=f"{file}:{line}", item=name,
                               expected=f"a column of encounter files or a key of the configuration{near}",
                               got=name)  # fmt: skip
            if column in self.columns:
                raise BadInput("a column is given twice", where=f"{file}:{line}", item=name)
            self.columns.append(column)
        have = set(self.columns)
        needed: list[tuple[set[str], ...]] = [
            ({"id"},), ({"time"},), ({"lat", "lon"}, {"x", "y"}), ({"alt"},),
            ({"vx", "vy"}, {"trk", "gs"}), ({"vs"},),
        ]  # fmt: skip
        for ways in needed:
            if not any(way <= have for way in ways):
                raise BadInput("a column is missing", where=f"{file}:{line}",
                               expected=" or ".join(" and ".join(sorted(w)) for w in ways),
                               got=", ".join(names))  # fmt: skip
        self.units = [self.default(column) for column in self.columns]

    def default(self, column: str) -> str:
        """The unit of a column without one."""
        return COLUMNS[column][2] if column in COLUMNS else ""

    def take_units(self, line: int, parts: list[str]) -> bool:
        """Store the units if the line is a line of units; return whether it is."""
        words = [part.strip("[]") for part in parts]
        known = set(UNITS) | {"unitless", "-", "", "none"}
        wrong = next((k for k, word in enumerate(words) if word not in known), None)
        if wrong is not None and any(
            p.startswith("[") and w in known for p, w in zip(parts, words, strict=True)
        ):
            raise BadInput("an unknown unit", where=f"{self.file}:{line}",
                           item=self.columns[wrong] if wrong < len(self.columns) else "",
                           expected=" or ".join(UNITS), got=words[wrong])  # fmt: skip
        if len(words) != len(self.columns) or not all(word in known for word in words):
            return False
        for k, (column, word) in enumerate(zip(self.columns, words, strict=True)):
            if word in ("unitless", "-", "", "none"):
                continue
            wanted = (
                COLUMNS[column][1]
                if column in COLUMNS
                else (UNITS[KEYS[column].unit][0] if KEYS[column].unit else "")
            )
            if UNITS[word][0] != wanted:
                raise BadInput("a unit that does not fit", where=f"{self.file}:{line}", item=column,
                               expected=self.default(column) or "none", got=word)  # fmt: skip
            self.units[k] = word
        return True

    def row(self, line: int, parts: list[str]) -> Row:
        """One state."""
        where = f"{self.file}:{line}"
        if len(parts) != len(self.columns):
            raise BadInput("a row of another length", where=where,
                           expected=f"{len(self.columns)} values", got=str(len(parts)))  # fmt: skip
        values: dict[str, float] = {}
        settings: dict[str, Any] = {}
        name = ""
        for column, unit, part in zip(self.columns, self.units, parts, strict=True):
            if column == "id":
                name = part
            elif column in KEYS:
                text = f"{part} [{unit}]" if unit else part
                key = KEYS[column]
                settings[key.field] = value_of(key, Entry(where, column, text, ""))[0]
            else:
                values[column] = self.number(where, column, unit, part)
        for column in ("gs", "airspeed", "s_ew", "s_ns", "s_z", "v_ew", "v_ns", "v_z"):
            if values.get(column, 0.0) < 0:
                raise BadInput("a value out of range", where=where, item=column,
                               expected="0 or more", got=str(values[column]))  # fmt: skip
        if "trk" in values and "vx" not in values:
            values["vx"] = values["gs"] * math.sin(values["trk"])
            values["vy"] = values["gs"] * math.cos(values["trk"])
        return Row(line, name, values["time"], values, settings)

    def number(self, where: str, column: str, unit: str, part: str) -> float:
        """A number in SI; a clock time may be h:m:s."""
        try:
            if column == "time" and ":" in part:
                hours, minutes, seconds = part.split(":")
                value = float(hours) * 3600 + float(minutes) * 60 + float(seconds)
            else:
                value = float(part)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise BadInput("not a number", where=where, item=column,
                           expected="a finite number", got=part)  # fmt: skip
        size = UNITS[unit][1] if unit else 1.0
        most = MOST[column]
        if abs(value * size) > most * (1 + 1e-12):
            raise BadInput("a value out of range", where=where, item=column,
                           expected=f"{-most / size:g} to {most / size:g} {unit}".strip(),
                           got=f"{part[:40]} {unit}".strip())  # fmt: skip
        return value * size


def parse(text: str, file: str = "encounters", ownship: str = "") -> Encounters:
    """The steps of a text. ownship: its name; if empty, the first aircraft. Raises BadInput."""
    table: _Table | None = None
    rows: list[Row] = []
    settings: dict[str, Any] = {}
    before: dict[str, Row] = {}
    units_open = False
    for number, raw in enumerate(io.StringIO(text, newline=None), 1):
        line = raw.split("#", 1)[0].strip()
        if not line:
            continue
        if table is None:
            setting = _SETTING.match(line)
            if setting:
                key = KEYS.get(OLD_NAMES.get(setting[1].lower(), setting[1].lower()))
                if key is not None:
                    settings[key.field] = value_of(
                        key, Entry(f"{file}:{number}", key.name, setting[2].strip(), "")
                    )[0]
                continue
            table, units_open = _Table(file, number, _parts(line)), True
            continue
        parts = _parts(line)
        if units_open and table.take_units(number, parts):
            units_open = False
            continue
        units_open = False
        row = table.row(number, parts)
        old = before.get(row.id)
        if old is not None and row.time_s <= old.time_s:
            raise BadInput("rows are out of order", where=f"{file}:{number}", item=f"time of {row.id}",
                           expected=f"later than {old.time_s:g} s (line {old.line})",
                           got=f"{row.time_s:g} s")  # fmt: skip
        before[row.id] = row
        rows.append(row)
        at_most(len(rows), ENCOUNTER_ROWS, "too many states", f"{file}:{number}", "rows")
    if not rows:
        raise BadInput("the file has no states", where=file, expected="a header, units and rows")
    own = ownship or rows[0].id
    if own not in before:
        raise BadInput("there is no such aircraft", where=file, item="ownship",
                       expected=" or ".join(sorted(before)), got=own)  # fmt: skip
    return _steps(file, own, settings, rows)


def _steps(file: str, own: str, settings: dict[str, Any], rows: Sequence[Row]) -> Encounters:
    by_time: dict[float, list[Row]] = {}
    for row in rows:
        by_time.setdefault(row.time_s, []).append(row)
    steps, left_out = [], []
    for time_s in sorted(by_time):
        here = by_time[time_s]
        first = [row for row in here if row.id == own]
        if not first:
            left_out.append(f"{file}: no state of {own} at {time_s:g} s; {len(here)} rows left out")
            continue
        steps.append((time_s, (*first, *(row for row in here if row.id != own))))
    return Encounters(file, own, settings, tuple(steps), tuple(left_out))


def read(file: Path, ownship: str = "") -> Encounters:
    """The steps of a file; raises BadInput."""
    return parse(text_of(file), str(file), ownship)
