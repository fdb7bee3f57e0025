"""Reading and writing detect-and-avoid configurations (`.conf`).

Text; each line is `key = value [unit]`, and `#` begins a comment. A missing key keeps its value; a value without a
unit is in SI. Alerters are named by `alerters = A, B` and described by keys that begin with their names. Every error
names file, line and key, and what was expected and found.
"""

from __future__ import annotations

import dataclasses
import math
import re
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from cratous.spec.daa.consistency import check
from cratous.spec.daa.parameters import (
    CYLINDER,
    DETECTORS,
    KEYS,
    OLD_NAMES,
    REGIONS,
    TCAS,
    TCAS_LEVELS,
    UNITS,
    URGENCIES,
    Alerter,
    Key,
    Level,
    Parameters,
    Spread,
    Volume,
)
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CONFIG_BYTES
from cratous.spec.files.text_file import text_of

SPREADS = {"hdir": ("rad", "deg"), "hs": ("m_s", "knot"), "vs": ("m_s", "fpm"), "alt": ("m", "ft")}
THRESHOLDS = {
    "WCV_DTHR": ("dthr_m", "m", "nmi"), "WCV_ZTHR": ("zthr_m", "m", "ft"),
    "WCV_TTHR": ("tthr_s", "s", "s"), "WCV_TCOA": ("tcoa_s", "s", "s"),
    "D": ("dthr_m", "m", "nmi"), "H": ("zthr_m", "m", "ft"), "VMOD_T": ("vmod_s", "s", "s"),
}  # fmt: skip


AMOUNT_MAX = 1e9
"""The largest threshold, time or spread in SI."""
TCAS_COLUMNS = {
    "TAU": ("tau_s", "s"), "TCOA": ("tau_s", "s"), "DMOD": ("dmod_m", "m"), "ZTHR": ("zthr_m", "m"),
    "HMD": ("hmd_m", "m"),
}  # fmt: skip
"""Columns of a TCAS table in files: the field of `spec.daa.parameters.TCAS_LEVELS`, and the dimension."""


@dataclass
class Entry:
    """One line of a file: its location, the value as written, and its unit ("" if none)."""

    where: str
    key: str
    value: str
    unit: str


@dataclass(frozen=True)
class Configuration:
    """Parameters, and the units in which the file gave them, kept for saving."""

    parameters: Parameters
    units: dict[str, str] = field(default_factory=dict)


_LINE = re.compile(r"^(?P<key>[A-Za-z][\w.]*)\s*=\s*(?P<value>.*)$")
_NUMBER = re.compile(r"^(?P<number>\S+?)\s*(?:\[(?P<boxed>[^\]]*)\]|(?P<unit>[A-Za-z][\w/^]*))?$")


def entries(text: str, file: str) -> dict[str, Entry]:
    """The lines of a configuration by key; raises BadInput for a malformed or repeated line."""
    found: dict[str, Entry] = {}
    for number, line in enumerate(text.splitlines(), 1):
        line = line.split("#", 1)[0].strip()
        if not line:
            continue
        where = f"{file}:{number}"
        match = _LINE.match(line)
        if not match:
            raise BadInput("not a line of a configuration", where=where,
                           expected="key = value [unit]", got=line[:60])  # fmt: skip
        key = match["key"]
        key = OLD_NAMES.get(key, key)
        if key in found:
            raise BadInput("a key is given twice", where=where, item=key,
                           expected="one line", got=f"another in {found[key].where}")  # fmt: skip
        found[key] = Entry(where, key, match["value"].strip(), "")
    return found


def _number(entry: Entry, dimension: str, low: float, high: float) -> tuple[float, str]:
    """Value in SI and unit as written."""
    match = _NUMBER.match(entry.value)
    text = match["number"] if match else ""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not match or not math.isfinite(value):
        raise BadInput("not a number", where=entry.where, item=entry.key,
                       expected="a finite number, then its unit", got=entry.value)  # fmt: skip
    unit = (match["boxed"] or match["unit"] or "").strip()
    if unit:
        known = [name for name, (what, _) in UNITS.items() if what == dimension]
        if unit not in known:
            raise BadInput("a unit that does not fit", where=entry.where, item=entry.key,
                           expected=" or ".join(known) or "no unit", got=unit)  # fmt: skip
        value *= UNITS[unit][1]
    if not low <= value <= high:
        size = UNITS[unit][1] if unit else 1.0
        shown = f" {unit}" if unit else " in SI" if dimension else ""
        text = (
            f"{low / size:g} to {high / size:g}"
            if math.isfinite(high)
            else f"at least {low / size:g}"
        )
        text += shown
        raise BadInput("a value out of range", where=entry.where, item=entry.key,
                       expected=text, got=entry.value)  # fmt: skip
    return value, unit


def _word(entry: Entry, words: dict[str, Any]) -> Any:
    got = words.get(entry.value.lower())
    if got is None:
        raise BadInput("a word that is not known here", where=entry.where, item=entry.key,
                       expected=" or ".join(words), got=entry.value)  # fmt: skip
    return got


def value_of(key: Key, entry: Entry) -> tuple[Any, str]:
    """The value of a key in SI, and its unit as written."""
    if key.kind == "bool":
        return _word(entry, {"true": True, "false": False}), ""
    if key.kind == "region":
        return _word(entry, {r.lower(): REGIONS.index(r) for r in REGIONS[1:4]}), ""
    if key.kind == "urgency":
        return _word(entry, {word: k for k, word in enumerate(URGENCIES)}), ""
    if key.kind == "id":
        return entry.value, ""
    dimension = UNITS[key.unit][0] if key.unit else ""
    value, unit = _number(entry, dimension, key.low, key.high)
    if key.kind == "int":
        if value != int(value):
            raise BadInput("not a whole number", where=entry.where, item=entry.key, got=entry.value)
        return int(value), unit
    return value, unit


class _Reader:
    """Consumes entries as they are recognised; those left at the end are unknown."""

    def __init__(self, found: dict[str, Entry], units: dict[str, str]) -> None:
        self.left, self.units = dict(found), units
        self.tables: set[str] = set()

    def take(self, key: str) -> Entry | None:
        return self.left.pop(key, None)

    def amount(self, key: str, dimension: str, default: float, low: float = 0.0) -> float:
        entry = self.take(key)
        if entry is None:
            return default
        value, unit = _number(entry, dimension, low, AMOUNT_MAX)
        self.units[key] = unit
        return value

    def alerter(self, name: str, where: str) -> Alerter:
        levels = []
        number = 1
        while f"{name}_alert_{number}_detector" in self.left:
            levels.append(self.level(name, number))
            number += 1
        if not levels:
            raise BadInput("an alerter has no levels", where=where, item=name,
                           expected=f"{name}_alert_1_detector = ...")  # fmt: skip
        return Alerter(name, tuple(levels))

    def level(self, name: str, number: int) -> Level:
        head = f"{name}_alert_{number}"
        detector = self.take(f"{head}_detector")
        assert detector is not None
        region_entry = self.take(f"{head}_region")
        words = {r.lower(): REGIONS.index(r) for r in REGIONS[:4]}
        region = 0 if region_entry is None else _word(region_entry, words)
        alerting = self.amount(f"{head}_alerting_time", "s", 0.0)
        early = self.amount(f"{head}_early_alerting_time", "s", alerting)
        if early < alerting:
            raise BadInput("the early alerting time is below the alerting time",
                           where=detector.where, item=f"{head}_early_alerting_time",
                           expected=f"at least {alerting:g} s", got=f"{early:g} s")  # fmt: skip
        spreads = [
            self.amount(f"{head}_spread_{d}", dim, 0.0, -math.inf)
            for d, (dim, _) in SPREADS.items()
        ]
        volume = self.volume(name, detector)
        return Level(detector.value, volume, alerting, early, region, Spread(*spreads))

    def volume(self, name: str, detector: Entry) -> Volume:
        load = f"{name}_load_core_detection_{detector.value}"
        entry = self.left.get(load)
        if entry is None:
            raise BadInput("a level's detector is not described", where=detector.where,
                           item=detector.key, expected=f"a line {load} = ...",
                           got=detector.value)  # fmt: skip
        kind_name = entry.value.rsplit(".", 1)[-1]
        if kind_name not in DETECTORS:
            raise BadInput("a detector of an unknown kind", where=entry.where, item=entry.key,
                           expected=" or ".join(DETECTORS), got=entry.value)  # fmt: skip
        kind = DETECTORS.index(kind_name)
        values = {"dthr_m": 0.0, "zthr_m": 0.0}
        if kind == CYLINDER:
            values = {"dthr_m": 5 * UNITS["nmi"][1], "zthr_m": 1000 * UNITS["ft"][1]}
        for key, (into, dimension, _) in THRESHOLDS.items():
            full = f"{name}_{detector.value}_{key}"
            if full in self.left:
                value, unit = _number(self.left[full], dimension, 0.0, math.inf)
                values[into], self.units[full] = value, unit
        if kind == TCAS:
            self.resolution_table(f"{name}_{detector.value}_TCAS_")
        return Volume(kind, **values)

    def resolution_table(self, head: str) -> None:
        """Refuse a TCAS table other than that of resolution advisories, the only one modelled; a file may omit it or
        write it out.
        """
        known: dict[str, tuple[float, str]] = {
            f"{head}level_{k}": (TCAS_LEVELS[k - 2].below_m if k > 1 else 0.0, "m")
            for k in range(1, 8)
        }
        for column, (into, dimension) in TCAS_COLUMNS.items():
            for k in range(1, 9):
                wanted = getattr(TCAS_LEVELS[k - 2], into) if k > 1 else 0.0
                known[f"{head}{column}_{k}"] = (wanted, dimension)
        self.tables |= {*known, f"{head}HMDFilter"}
        for full, (wanted, dimension) in known.items():
            if full in self.left:
                value, _ = _number(self.left[full], dimension, 0.0, math.inf)
                if not math.isclose(value, wanted, rel_tol=1e-9):
                    self._other_table(full, f"{wanted:g} {dimension.replace('_', '/')}")
        full = f"{head}HMDFilter"
        if full in self.left and not _word(self.left[full], {"true": True, "false": False}):
            self._other_table(full, "true")

    def _other_table(self, full: str, expected: str) -> None:
        entry = self.left[full]
        raise BadInput("another TCAS table than that of resolution advisories, which is not modelled",
                       where=entry.where, item=full, expected=expected, got=entry.value)  # fmt: skip

    def finish(self, names: list[str]) -> None:
        """Drop the detector lines that levels share; refuse unknown keys."""
        for key in list(self.left):
            name = next((n for n in names if key.startswith(f"{n}_")), None)
            if name is None:
                continue
            rest = key.removeprefix(f"{name}_")
            if (
                rest.startswith("load_core_detection_")
                or any(rest.endswith(f"_{t}") for t in THRESHOLDS)
                or key in self.tables
            ):
                del self.left[key]
        for entry in self.left.values():
            close = get_close_matches(entry.key, [*KEYS, *OLD_NAMES, "alerters"], 3)
            raise BadInput("an unknown key", where=entry.where, item=entry.key,
                           expected="a key of the configuration" + (f", such as {', '.join(close)}" if close else ""),
                           got=entry.key)  # fmt: skip


def parse(text: str, file: str = "configuration", base: Parameters | None = None) -> Configuration:
    """The configuration in a text, applied over `base` (default: the library's defaults). Raises BadInput."""
    found = entries(text, file)
    units: dict[str, str] = {}
    reader = _Reader(found, units)
    changes: dict[str, Any] = {}
    for name, key in KEYS.items():
        entry = reader.take(name)
        if entry is not None:
            changes[key.field], unit = value_of(key, entry)
            if key.unit:
                units[name] = unit
    listed = reader.take("alerters")
    names: list[str] = []
    if listed is not None:
        names = [n.strip() for n in listed.value.split(",") if n.strip()]
        if len(set(names)) < len(names):
            raise BadInput(
                "an alerter is listed twice", where=listed.where, item="alerters", got=listed.value
            )
        changes["alerters"] = tuple(reader.alerter(n, listed.where) for n in names)
    reader.finish(names)
    made = dataclasses.replace(base or Parameters(), **changes)
    lines = {key.field: found[name].where for name, key in KEYS.items() if name in found}
    check(made, file, lines)
    return Configuration(made, units)


def read(file: Path, base: Parameters | None = None) -> Configuration:
    """The configuration in a file; raises BadInput."""
    return parse(text_of(file, CONFIG_BYTES), str(file), base)


def _text(value: float, unit: str) -> str:
    """A number in a unit, written so that reading it gives the same double."""
    if not unit:
        return repr(value)
    size = UNITS[unit][1]
    for digits in range(1, 18):
        text = f"{value / size:.{digits}g}"
        if float(text) * size == value:
            return f"{float(text)!r} [{unit}]"
    si = next(n for n, (what, one) in UNITS.items() if what == UNITS[unit][0] and one == 1.0)
    return f"{value!r} [{si}]"


def write(made: Configuration) -> str:
    """The text of a configuration, in the units that its file used."""
    p, units = made.parameters, made.units
    lines = []
    for name, key in KEYS.items():
        value = getattr(p, key.field)
        if key.kind == "bool":
            lines.append(f"{name} = {str(value).lower()}")
        elif key.kind == "region":
            lines.append(f"{name} = {REGIONS[value]}")
        elif key.kind == "urgency":
            # keys of this project: written only if they differ from the default
            lines.append(f"{name} = {URGENCIES[value]}" if value else "")
        elif key.kind == "id":
            lines.append(f"{name} = {value}" if value else "")
        elif key.kind == "int":
            lines.append(f"{name} = {value}")
        else:
            lines.append(f"{name} = {_text(value, units.get(name, key.unit))}")
    lines.append(f"alerters = {', '.join(a.name for a in p.alerters)}" if p.alerters else "")
    for alerter in p.alerters:
        seen = set()
        for number, level in enumerate(alerter.levels, 1):
            head = f"{alerter.name}_alert_{number}"
            lines.append(f"{head}_region = {REGIONS[level.region]}")
            for name, time in (
                ("alerting_time", level.alerting_time_s),
                ("early_alerting_time", level.early_alerting_time_s),
            ):
                lines.append(f"{head}_{name} = {_text(time, units.get(f'{head}_{name}', 's'))}")
            for (d, (_, unit)), spread in zip(SPREADS.items(), level.spread, strict=True):
                lines.append(
                    f"{head}_spread_{d} = {_text(spread, units.get(f'{head}_spread_{d}', unit))}"
                )
            lines.append(f"{head}_detector = {level.detector}")
            if level.detector in seen:
                continue
            seen.add(level.detector)
            v = level.volume
            lines.append(
                f"{alerter.name}_load_core_detection_{level.detector} = {DETECTORS[v.kind]}"
            )
            if v.kind == TCAS:
                continue
            for key_name, (into, _, unit) in THRESHOLDS.items():
                if (key_name in ("D", "H")) != (v.kind == CYLINDER) or (
                    key_name == "VMOD_T" and not v.vmod_s
                ):
                    continue
                full = f"{alerter.name}_{level.detector}_{key_name}"
                lines.append(f"{full} = {_text(getattr(v, into), units.get(full, unit))}")
    return "\n".join(line for line in lines if line) + "\n"
