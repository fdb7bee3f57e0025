"""The mission items that an ICAROUS parameter file sets, with values in the mission file's units."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan, degrees
from typing import Any, NamedTuple

from cratous.services.flight.dynamics import GRAVITY_M_S2
from cratous.services.parameters.parameter_file import Given


class Setting(NamedTuple):
    """An item of a mission file, its value there, and the parameter name and place that it comes from."""

    item: str
    value: Any
    name: str
    where: str


def settings_of(given: Mapping[str, Given], speed_m_s: float) -> dict[str, Setting]:
    """The items that a file sets, by item. speed_m_s: cruise speed for converting a turn rate to a bank
    angle.
    """
    found = dict[str, Setting]()
    for one in given.values():
        item, value = one.name.item, one.value
        if not item:
            continue
        if one.name.name == "turn_rate":
            value = degrees(atan(float(value) * speed_m_s / GRAVITY_M_S2))
        if one.name.unit == "deg" and item.endswith("_deg"):
            value = degrees(float(value))
        if one.name.name in ("alerting_m", "alerting_n") and float(value).is_integer():
            value = int(float(value))
        if one.name.name in ("min_vs", "max_vs"):
            value = abs(float(value))
            before = found.get(item)
            if before is not None and before.value <= value:
                continue
        if one.name.name == "passive_mode":
            if not value:
                continue
            value = 0
        found[item] = Setting(item, value, one.name.name, one.where)
    return found
