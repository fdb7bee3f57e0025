"""Tracks from the states in a log that has no mission: one position a second of each aircraft."""

from __future__ import annotations

from typing import Any

from cratous.services.logs.entry import Entry, any_data
from cratous.services.logs.selection import names_of
from cratous.services.logs.views import STATE, place_of
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Frame

PERIOD_MS = 1000
CONFIGURATION = "afrl.cmasi.EntityConfiguration"
NOBODY = -1
"""In the place of the owner: the log does not say who commands."""


class Positions:
    """Reads states and configurations, in the order of the log.

    frame: about the first position, None before there is one.
    """

    def __init__(self) -> None:
        self._tracks: dict[str, dict[int, list[float]]] = {}
        self.frame: Frame | None = None
        self._projection: Projection | None = None
        self._labels: dict[str, str] = {}

    def add(self, entry: Entry, begin_ms: int) -> None:
        """Take a message; what is no state and no configuration changes nothing."""
        names = names_of(entry.topic)
        if CONFIGURATION in names:
            body, _ = any_data(entry)
            if isinstance(body, dict):
                self._labels[str(body.get("ID", 0))] = str(body.get("Label", ""))
        if STATE not in names:
            return
        body, _ = any_data(entry)
        place = place_of(body.get("Location")) if isinstance(body, dict) else None
        if place is None or not isinstance(body.get("ID"), int):
            return
        if self._projection is None:
            self.frame = Frame(place[0], place[1])
            self._projection = Projection(self.frame)
        local = self._projection.to_local(place[0], place[1])
        time_ms = entry.time_ms - begin_ms
        row = [time_ms, *(round(x, 1) for x in (*local, place[2])), NOBODY]
        # the first of each second stays
        self._tracks.setdefault(str(body["ID"]), {}).setdefault(time_ms // PERIOD_MS, row)

    def tracks(self) -> dict[str, list[list[float]]]:
        """By number, rows of time [ms], north, east, altitude [m] and `NOBODY`, in the order of time."""
        return {number: sorted(rows.values()) for number, rows in self._tracks.items()}

    def vehicles(self) -> list[dict[str, Any]]:
        """Number and name of every aircraft that has a track."""
        return [
            {"id": int(number), "label": self._labels.get(number, ""), "protected": None}
            for number in self._tracks
        ]
