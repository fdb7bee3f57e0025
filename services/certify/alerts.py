"""Alerts of a flight, read from WellClearViolationIntervals: ownship, intruder, time span,
severity.

An alert lasts from the first message of a vehicle that lists the intruder at an alert level to the
last such message before one that does not.
"""

from __future__ import annotations

from math import isfinite
from typing import Any

from cratous.spec.errors import BadInput

TOPIC = "larcfm.DAIDALUS.WellClearViolationIntervals"
LEVELS = {1: "corrective", 2: "warning"}
"""Names of the alert levels of `cratous run`, by number."""


def level_name(level: int) -> str:
    """Name of an alert level, or its number if it has none."""
    return LEVELS.get(level, str(level))


def none_said(report: dict[str, Any]) -> str:
    """Why a report lists no alert, in words."""
    looks = report["log"]["by_topic"].get(TOPIC, 0)
    if looks:
        return f"None: {looks} looks of detect and avoid are in the log."
    return (
        "The log has no look of detect and avoid. In a flight of cratous run there is none where no loss of well clear "
        "is foreseen and ICAROUS does not fly, without avoidance, and with --processes, whose logs do not have them."
    )


class AlertReader:
    """Reads alerts from the messages of a log; `found` lists the alerts so far, by start time."""

    def __init__(self) -> None:
        self.found: list[dict[str, Any]] = []
        self._open: dict[tuple[int, int], dict[str, Any]] = {}

    def add(self, body: dict[str, Any], time_ms: int) -> None:
        """Process the next message. Raises BadInput if its lists do not match its intruders."""
        vehicle = int(body["EntityId"])
        now = _levels(body, time_ms)
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


def _levels(body: dict[str, Any], time_ms: int) -> dict[int, tuple[int, float]]:
    """By intruder with an alert: the level, and the time to violation [s]."""
    lists = ("EntityList", "AlertLevelList", "TimeToViolationList")
    told = [body[name] for name in lists]
    try:
        found = {
            int(other): (int(level), float(first))
            for other, level, first in zip(*told, strict=True)
            if level
        }
        if all(isfinite(first) for _, first in found.values()):
            return found
    except ValueError:  # lists of different lengths, or a level that is not a number
        pass
    raise BadInput(
        "the alerts of a message cannot be told",
        where="log",
        item=f"{TOPIC} at {time_ms} ms",
        expected="of each intruder one level and one time [s]",
        got=str(told)[:200],
    )
