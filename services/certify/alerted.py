"""Alerts of a flight, read from WellClearViolationIntervals: who was told of whom, from when to when, how severe.

An alert lasts from the first message of a vehicle that has the intruder at a level to the last such message without
one in between that has not.
"""

from __future__ import annotations

from typing import Any

TOPIC = "larcfm.DAIDALUS.WellClearViolationIntervals"
LEVELS = {1: "corrective", 2: "warning"}
"""The levels of flights of `cratous run`, by number."""


class AlertReader:
    """Follows the messages of a log; `found` is what has been alerted so far, in the order of beginning."""

    def __init__(self) -> None:
        self.found: list[dict[str, Any]] = []
        self._open: dict[tuple[int, int], dict[str, Any]] = {}

    def add(self, body: dict[str, Any], time_ms: int) -> None:
        """Take the next message. Raises KeyError or ValueError for one that lacks something."""
        vehicle = int(body["EntityId"])
        told = zip(
            body["EntityList"], body["AlertLevelList"], body["TimeToViolationList"], strict=True
        )
        now = {int(other): (int(level), float(first)) for other, level, first in told if level}
        for key in [key for key in self._open if key[0] == vehicle and key[1] not in now]:
            del self._open[key]
        for other, (level, first_s) in sorted(now.items()):
            row = self._open.get((vehicle, other))
            if row is None:
                row = {"vehicle": vehicle, "intruder": other, "from_ms": time_ms, "to_ms": time_ms,
                       "level": level, "least_s": first_s}  # fmt: skip
                self._open[vehicle, other] = row
                self.found.append(row)
            row["to_ms"] = time_ms
            row["level"] = max(row["level"], level)
            row["least_s"] = min(row["least_s"], first_s)
