"""Traffic files of ICAROUS: a YAML list of `[id, range m, bearing deg, altitude m, speed m/s,
heading deg, climb m/s, delay s, transmitter, 6 + 6 covariances]`; everything after the climb rate
is optional. Bearings are from home.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, radians, sin
from typing import Any

from cratous.services.importing.imported_content import Intruder, Parts, altitude, number
from cratous.services.loading.document import Document
from cratous.spec.errors import BadInput

NAMES = ("id", "range", "bearing", "altitude", "speed", "heading", "climb", "delay")
LENGTHS = (7, 8, 9, 21)
RANGES = {
    "id": (1, 2**31 - 1), "range": (0, 100_000), "bearing": (-360, 360), "speed": (0, 350),
    "heading": (-360, 360), "climb": (-100, 100), "delay": (0, 86_400),
}  # fmt: skip
TRANSMITTERS = ("ADS-B", "FLARM", "GroundTruth")


def is_traffic(data: Any) -> bool:
    """Whether the data of a YAML file is a list of lists."""
    return isinstance(data, list) and bool(data) and all(isinstance(one, list) for one in data)


def read_traffic(document: Document) -> Parts:
    """The intruders of a file. Raises BadInput with line and item."""
    found = tuple(_intruders(document))
    notes = []
    if any(len(one) == max(LENGTHS) and any(one[9:]) for one in document.data):
        notes.append(
            f"{document.path}: covariances are not used: errors of sensors are for the section `sensing` to say"
        )
    return Parts(intruders=found, notes=tuple(notes))


def _intruders(document: Document) -> Iterator[Intruder]:
    seen = set[int]()
    for k, one in enumerate(document.data):
        where, item = document.where((k,)), f"[{k}]"
        if len(one) not in LENGTHS:
            raise BadInput(
                "not an aircraft", where=where, item=item,
                expected=", ".join(map(str, LENGTHS[:-1])) + f" or {LENGTHS[-1]} values",
                got=str(len(one)),
            )  # fmt: skip
        told = dict[str, float]()
        for j, (name, value) in enumerate(zip(NAMES, one, strict=False)):
            place = f"[{k}][{j}] ({name})"
            if name == "altitude":
                told[name] = altitude(value, where, place)
            else:
                told[name] = number(value, where, place, *RANGES[name])
        if told["id"] != int(told["id"]) or int(told["id"]) in seen:
            raise BadInput(
                "not an id of its own", where=where, item=f"{item}[0] (id)",
                expected="whole numbers that differ", got=str(one[0]),
            )  # fmt: skip
        seen.add(int(told["id"]))
        if len(one) > 8 and one[8] not in TRANSMITTERS:
            raise BadInput(
                "an unknown transmitter", where=where, item=f"{item}[8] (transmitter)",
                expected=" or ".join(TRANSMITTERS), got=str(one[8])[:40],
            )  # fmt: skip
        for j, value in enumerate(one[9:], 9):
            number(value, where, f"[{k}][{j}] (covariance)", -1e9, 1e9)
        bearing, heading = radians(told["bearing"]), radians(told["heading"])
        yield Intruder(
            id=int(told["id"]),
            place=None,
            north_m=told["range"] * cos(bearing),
            east_m=told["range"] * sin(bearing),
            alt_m=told["altitude"],
            velocity=(
                told["speed"] * cos(heading), told["speed"] * sin(heading), -told["climb"],
            ),
            appears_s=told.get("delay", 0.0),
            where=where,
        )  # fmt: skip
