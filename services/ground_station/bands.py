"""Heading bands of vehicles, as the WellClearViolationIntervals in a log tell them; none is computed here."""

from __future__ import annotations

import math
from typing import Any

from cratous.services.logs.entry import Entry, any_data

BANDS = "larcfm.DAIDALUS.WellClearViolationIntervals"
REGIONS = ("NEAR", "MID", "FAR")
RECOVERY = "RECOVERY"
PERIOD_MS = 1000


class Bands:
    """Reads them in the order of the log. unread: how many messages do not fit."""

    def __init__(self) -> None:
        self._rows: dict[str, dict[int, dict[str, Any]]] = {}
        self.unread = 0

    def add(self, entry: Entry, time_ms: int) -> None:
        """Take a message of a time of the page; those of other types change nothing."""
        if entry.topic != BANDS:
            return
        body, error = any_data(entry)
        row = None if error is not None else _row(body, time_ms)
        if row is None:
            self.unread += 1
            return
        # the first of each second stays
        self._rows.setdefault(str(row.pop("vehicle")), {}).setdefault(time_ms // PERIOD_MS, row)

    @property
    def found(self) -> dict[str, list[dict[str, Any]]]:
        """By the number of a vehicle, the first message of each second, in the order of time.

        Time [ms], own heading [degrees], bands (from and to, clockwise [degrees], and region) and
        intruders (number, time to the violation [s], alert level); what is not finite is None.
        """
        return {vehicle: [rows[k] for k in sorted(rows)] for vehicle, rows in self._rows.items()}


def _row(body: Any, time_ms: int) -> dict[str, Any] | None:
    """What is shown of a message; None where it lacks something, or its lists do not fit together."""
    try:
        bands = [
            (*_ends(interval["GroundHeadings"]), _region(region))
            for interval, region in zip(
                body["WCVGroundHeadingIntervals"], body["WCVGroundHeadingRegions"], strict=True
            )
        ]
        bands += [
            (*_ends(interval["RecoveryGroundHeadings"]), RECOVERY)
            for interval in body["RecoveryGroundHeadingIntervals"]
        ]
        told = (body[f"{name}List"] for name in ("Entity", "TimeToViolation", "AlertLevel"))
        intruders = [
            (int(number), _finite(time_s), _finite(level))
            for number, time_s, level in zip(*told, strict=True)
        ]
        return {
            "vehicle": int(body["EntityId"]),
            "time_ms": time_ms,
            "heading_deg": _finite(body["CurrentHeading"]),
            "bands": bands,
            "intruders": intruders,
        }
    except (LookupError, OverflowError, TypeError, ValueError):
        return None


def _ends(ends: Any) -> tuple[float, float]:
    low, high = (float(end) for end in ends)
    if not (math.isfinite(low) and math.isfinite(high)):
        raise ValueError
    return round(low, 1), round(high, 1)


def _region(region: Any) -> str:
    if region not in REGIONS:
        raise ValueError
    return str(region)


def _finite(value: Any) -> float | None:
    number = float(value)
    return round(number, 1) if math.isfinite(number) else None
