"""Requirements of one's own over the flight of the crossing, and edits of a report that has them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

TEXT = """# over the crossing
trace every 500 ms gap 600 ms
signal z_1: m from AirVehicleState[ID=1].Location.Altitude hold 1 s
signal roll_1: deg from AirVehicleState[ID=1].Roll hold 1 s
signal nowhere: m from AirVehicleState[ID=77].Location.Altitude
requirement FLOOR "never below 90 m" severity hazardous source "manual 2.1": z_1 >= 90 m and z_1 < 1 km
requirement BANK severity minor: roll_1 <= 20 deg
requirement IDLE: z_1 < 10 m implies eventually within 1 s z_1 > 100 m
requirement GONE: nowhere >= 10 m
fret "export.json" only RISE with alt is z_1
"""
EXPORT = [{"reqid": "RISE", "fulltext": "the plane shall always satisfy alt >= 1.0"}]
Edit = Callable[[dict[str, Any]], None]


def rows(report: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {row["requirement"]: row for row in report["own"]["requirements"]}


def changed(part: str, value: Any) -> Edit:
    return lambda report: report["own"]["requirements"][1].__setitem__(part, value)
