"""Bands and alerts of vehicles, from the WellClearViolationIntervals in a log; nothing is computed here."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.services.logs.entry import Entry, any_data

BANDS = "larcfm.DAIDALUS.WellClearViolationIntervals"
REGIONS = ("NEAR", "MID", "FAR")
RECOVERY = "RECOVERY"
PERIOD_MS = 1000
Band = tuple[float, float, str]


class Dimension(NamedTuple):
    """Message fields of one dimension: own value, intervals with regions, recovery, and the range of both."""

    own: str
    intervals: str
    regions: str
    ends: str
    recoveries: str
    recovery_ends: str
    digits: int


DIMENSIONS = {
    "heading": Dimension(
        "CurrentHeading", "WCVGroundHeadingIntervals", "WCVGroundHeadingRegions", "GroundHeadings",
        "RecoveryGroundHeadingIntervals", "RecoveryGroundHeadings", 1,
    ),
    "speed": Dimension(
        "CurrentGoundSpeed", "WCVGroundSpeedIntervals", "WCVGroundSpeedRegions", "GroundSpeeds",
        "RecoveryGroundSpeedIntervals", "RecoveryGroundSpeeds", 2,
    ),
    "climb": Dimension(
        "CurrentVerticalSpeed", "WCVVerticalSpeedIntervals", "WCVVerticalSpeedRegions",
        "VerticalSpeeds", "RecoveryVerticalSpeedIntervals", "RecoveryVerticalSpeed", 2,
    ),
    "altitude": Dimension(
        "CurrentAltitude", "WCVAlitudeIntervals", "WCVAltitudeRegions", "Altitude",
        "RecoveryAltitudeIntervals", "RecoveryAltitude", 1,
    ),
}  # fmt: skip


class Bands:
    """Reads the bands of each vehicle in log order. unread: number of messages that could not be read."""

    def __init__(self) -> None:
        self._rows: dict[str, dict[int, dict[str, Any]]] = {}
        self._new: dict[str, list[dict[str, Any]]] = {}
        self.unread = 0

    def add(self, entry: Entry, time_ms: int) -> None:
        """Process a message with its display time [ms]; other types are ignored."""
        if entry.topic != BANDS:
            return
        body, error = any_data(entry)
        row = None if error is not None else _row(body, time_ms)
        if row is None:
            self.unread += 1
            return
        vehicle = str(body["EntityId"])
        rows, second = self._rows.setdefault(vehicle, {}), time_ms // PERIOD_MS
        if second not in rows:  # the first of each second is kept
            rows[second] = row
            self._new.setdefault(vehicle, []).append(row)

    @property
    def found(self) -> dict[str, list[dict[str, Any]]]:
        """By vehicle number, the first message of each second, in time order.

        Time [ms]; own: a value for each of DIMENSIONS; bands: by dimension, if any, with start, end
        (for headings clockwise) and region; intruders: number, time to the violation [s], alert
        level. Units are degrees, m/s, m; non-finite values are None.
        """
        return {vehicle: [rows[k] for k in sorted(rows)] for vehicle, rows in self._rows.items()}

    def forget(self, before_ms: int) -> None:
        """Drop data older than before_ms."""
        first = before_ms // PERIOD_MS
        for vehicle, rows in list(self._rows.items()):
            self._rows[vehicle] = {k: row for k, row in rows.items() if k >= first}
            if not self._rows[vehicle]:
                del self._rows[vehicle]

    @property
    def size(self) -> int:
        """Number of stored rows, bands and intruders."""
        return sum(
            1 + sum(map(len, row["bands"].values())) + len(row["intruders"])
            for rows in self._rows.values()
            for row in rows.values()
        )

    def take_new(self) -> dict[str, list[dict[str, Any]]]:
        """The data that arrived since the last call."""
        taken, self._new = self._new, {}
        return taken


def _row(body: Any, time_ms: int) -> dict[str, Any] | None:
    """The displayed data of a message; None if it lacks something, or its lists are inconsistent."""
    try:
        int(body["EntityId"])
        bands = {name: _bands(body, one) for name, one in DIMENSIONS.items()}
        told = (body[f"{name}List"] for name in ("Entity", "TimeToViolation", "AlertLevel"))
        return {
            "time_ms": time_ms,
            "own": [_finite(body[one.own], one.digits) for one in DIMENSIONS.values()],
            "bands": {name: rows for name, rows in bands.items() if rows},
            "intruders": [
                (int(number), _finite(time_s), _finite(level))
                for number, time_s, level in zip(*told, strict=True)
            ],
        }
    except (LookupError, OverflowError, TypeError, ValueError):
        return None


def _bands(body: Any, one: Dimension) -> list[Band]:
    told = zip(body[one.intervals], body[one.regions], strict=True)
    found = [(*_ends(said[one.ends], one.digits), _region(region)) for said, region in told]
    recoveries = (_ends(said[one.recovery_ends], one.digits) for said in body[one.recoveries])
    return found + [(*ends, RECOVERY) for ends in recoveries]


def _ends(ends: Any, digits: int) -> tuple[float, float]:
    low, high = (float(end) for end in ends)
    if not (math.isfinite(low) and math.isfinite(high)):
        raise ValueError
    return round(low, digits), round(high, digits)


def _region(region: Any) -> str:
    if region not in REGIONS:
        raise ValueError
    return str(region)


def _finite(value: Any, digits: int = 1) -> float | None:
    number = float(value)
    return round(number, digits) if math.isfinite(number) else None
