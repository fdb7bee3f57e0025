"""Reading parameter files of ICAROUS: `key = value [unit]`, `#` begins a comment.

Every name is known: it sets an item of the mission, or is listed as not used here, with the reason. Values
are checked against the type and the unit of the name. A value without unit is in SI, as in detect-and-avoid
configurations.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from cratous.services.loading.uxas_settings import nearest
from cratous.services.parameters.icarous_names import NAMES, Name
from cratous.spec.daa.conf_files import Entry, entries, value_of
from cratous.spec.daa.parameters import KEYS, UNITS, Key
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CONFIG_BYTES
from cratous.spec.files.text_file import text_of

VOLUME, ONLY = "default_load_core_detection_det_1", "WCV_TAUMOD"
WORDS = {
    "corrective_region",
    "alerters",
    "default_alert_1_region",
    "default_alert_1_detector",
    VOLUME,
}
MISSPELT = ("undertainty", "uncertainty")
"""Misspelling in twelve names of a file that ships with ICAROUS, and its correction."""
SQUARES = {"m^2", "m2", "m^2/s^2"}


class Given(NamedTuple):
    """One line of a file: the name with its meaning here, the value in SI (degrees as radians), its text and
    its place.
    """

    name: Name
    value: float | bool | str
    text: str
    where: str


def read(file: Path) -> dict[str, Given]:
    """The lines of a parameter file by name. Raises BadInput with file, line, name, expected and got."""
    return parse(text_of(file, CONFIG_BYTES, "a parameter file of ICAROUS"), str(file))


def parse(text: str, file: str) -> dict[str, Given]:
    """The lines of a parameter text by name; errors as in `read`."""
    found = dict[str, Given]()
    for entry in entries(text, file).values():
        key = entry.key if entry.key in NAMES else entry.key.replace(*MISSPELT)
        if key not in NAMES:
            raise BadInput(
                "an unknown parameter", where=entry.where, item=entry.key,
                expected=nearest_name(entry.key), got=entry.key,
            )  # fmt: skip
        if key in found:
            raise BadInput("a key is given twice", where=entry.where, item=key, got=entry.key)
        found[key] = Given(NAMES[key], _value(NAMES[key], entry), entry.value, entry.where)
    _consistent(found)
    return found


def default_of(name: Name) -> float | bool | str:
    """The default of ICAROUS for a parameter, in SI."""
    text = f"{name.default} [{name.unit}]" if name.unit else name.default
    return _value(name, Entry("", name.name, text, ""))


def nearest_name(name: str) -> str:
    """The most similar known names; a hint if there is none."""
    text = nearest(name, NAMES)
    return "one of the names of `cratous params --names`" if text.count(",") > 5 else text


def _value(name: Name, entry: Entry) -> float | bool | str:
    if name.name in WORDS:
        return _word(name, entry)
    if name.default.lower() in ("true", "false"):
        lowered = Entry(entry.where, entry.key, entry.value.lower(), "")
        value: float | bool = value_of(Key(name.name, "", "bool", "", 0, 1), lowered)[0]
        return value
    text = entry.value
    if name.unit in SQUARES:
        number, _, unit = text.partition("[")
        if unit.rstrip("] ").strip() in SQUARES:
            text = number.strip()
    unit = name.unit if name.unit in UNITS else ""
    low, high = _bounds(name)
    plain = Entry(entry.where, entry.key, text, "")
    found: float = value_of(Key(name.name, "", "float", unit, low, high), plain)[0]
    return found


def _bounds(name: Name) -> tuple[float, float]:
    """Bounds in SI: those of detect and avoid for its keys; otherwise negative values are excluded where
    meaningless.
    """
    key = KEYS.get(name.name)
    if key is not None:
        return key.low, key.high
    free = name.name.startswith("Priority") or "_uncertainty_" in name.name
    return (-math.inf if free or name.name == "rtl_altitude" else 0.0), math.inf


def _word(name: Name, entry: Entry) -> str:
    if not entry.value:
        raise BadInput(
            "no value", where=entry.where, item=entry.key, expected=f"a word such as {name.default}"
        )
    if name.name == VOLUME and entry.value.rpartition(".")[2] != ONLY:
        raise BadInput(
            "a volume that is not kept here", where=entry.where, item=entry.key,
            expected=f"{ONLY} (modified tau)", got=entry.value,
        )  # fmt: skip
    return entry.value


def _consistent(found: Mapping[str, Given]) -> None:
    """Check that lower limits are not above upper ones, and the signs of the climb rates; BadInput otherwise."""
    for name, sign in (("min_vs", -1), ("max_vs", 1)):
        one = found.get(name)
        if one is not None and sign * float(one.value) <= 0:
            raise BadInput(
                f"{name} leaves no {'climb' if sign > 0 else 'descent'}", where=one.where, item=name,
                expected=f"{'more' if sign > 0 else 'less'} than 0", got=one.text,
            )  # fmt: skip
    for low, high in (("min_hs", "max_hs"), ("min_vs", "max_vs"), ("min_alt", "max_alt")):
        a, b = found.get(low), found.get(high)
        if a is not None and b is not None and not a.value <= b.value:  # type: ignore[operator]
            raise BadInput(
                f"{low} is above {high}", where=a.where, item=low,
                expected=f"at most {b.text}", got=a.text,
            )  # fmt: skip
