"""Tracks from the states in a log without a mission: one position per second of each aircraft."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from cratous.services.logs.entry import Entry, any_data, to_object
from cratous.services.logs.selection import names_of
from cratous.services.logs.views import STATE, place_of
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput
from cratous.spec.mission import Frame

PERIOD_MS = 1000
CONFIGURATION = "afrl.cmasi.EntityConfiguration"
NOBODY = -1
"""Placeholder for the commander: the log does not contain it."""


Local = Callable[[float, float], tuple[float, float]]


def local_place(
    to_local: Local, latitude_deg: float, longitude_deg: float
) -> tuple[float, float] | None:
    """North and east [m] to a decimetre; None for invalid coordinates."""
    from pyproj.exceptions import ProjError

    try:
        north_m, east_m = to_local(latitude_deg, longitude_deg)
    except ProjError:  # no frame can contain such a place
        return None
    if not math.isfinite(north_m) or not math.isfinite(east_m):
        return None
    return round(north_m, 1), round(east_m, 1)


def state_of(entry: Entry) -> tuple[Any, tuple[float, float, float] | None, bool]:
    """For a state: its vehicle, position (latitude, longitude [deg], altitude [m]; None if not
    numeric), and whether it could be decoded.
    """
    if not isinstance(entry.body, bytes):
        body, error = any_data(entry)
        told = isinstance(body, dict)
        return (
            (body.get("ID"), place_of(body.get("Location")), error is None)
            if told
            else (None, None, error is None)
        )
    try:
        state = to_object(entry)
    except BadInput:
        return None, None, False
    # avoid the JSON form: it takes as long as all other work on the log
    at = getattr(state, "Location", None)
    place = None if at is None else (at.Latitude, at.Longitude, at.Altitude)
    finite = place is not None and all(map(math.isfinite, place))
    return getattr(state, "ID", None), place if finite else None, True


class Positions:
    """Reads states and configurations, in log order.

    frame: about the first position, None before there is one; unread: number of states that could
    not be decoded; left_out: number of states of aircraft beyond the maximum.
    """

    def __init__(self, most: int | None = None) -> None:
        """most: the largest number of aircraft to keep, by default all."""
        self._most, self.left_out = most, 0
        self._new: dict[str, list[list[float]]] = {}
        self._tracks: dict[str, dict[int, list[float]]] = {}
        self.frame: Frame | None = None
        self.unread = 0
        self._projection: Projection | None = None
        self._labels: dict[str, str] = {}

    def add(self, entry: Entry, time_ms: int) -> None:
        """Process one message, with its time since the first of the log; only vehicle states and
        configurations matter.
        """
        names = names_of(entry.topic)
        if CONFIGURATION in names:
            body, _ = any_data(entry)
            if isinstance(body, dict) and self._has_place(self._labels, str(body.get("ID", 0))):
                self._labels[str(body.get("ID", 0))] = str(body.get("Label", ""))
        if STATE not in names:
            return
        vehicle, place, read = state_of(entry)
        self.unread += not read
        if place is None or not isinstance(vehicle, int):
            return
        number = str(vehicle)
        if not self._has_place(self._tracks, number):
            self.left_out += 1
            return
        # the first of each second is kept
        rows, second = self._tracks.get(number, {}), time_ms // PERIOD_MS
        if second in rows:
            return
        frame = Frame(place[0], place[1])
        projection = self._projection or Projection(frame)
        local = local_place(projection.to_local, place[0], place[1])
        if local is None:
            return
        if self._projection is None:
            self.frame, self._projection = frame, projection
        rows[second] = [time_ms, *local, round(place[2], 1), NOBODY]
        self._tracks[number] = rows
        self._new.setdefault(number, []).append(rows[second])

    def _has_place(self, kept: dict[str, Any], number: str) -> bool:
        return number in kept or self._most is None or len(kept) < self._most

    def take_new(self) -> dict[str, list[list[float]]]:
        """The data that arrived since the last call."""
        taken, self._new = self._new, {}
        return taken

    def forget(self, before_ms: int) -> None:
        """Drop older data; an aircraft without remaining data is removed."""
        first = before_ms // PERIOD_MS
        for number, rows in list(self._tracks.items()):
            self._tracks[number] = {k: row for k, row in rows.items() if k >= first}
            if not self._tracks[number]:
                del self._tracks[number]

    @property
    def size(self) -> int:
        """Number of stored rows."""
        return sum(map(len, self._tracks.values()))

    def tracks(self) -> dict[str, list[list[float]]]:
        """By number, rows of time [ms], north, east, altitude [m] and `NOBODY`, in time order."""
        return {number: sorted(rows.values()) for number, rows in self._tracks.items()}

    def vehicles(self) -> list[dict[str, Any]]:
        """Number and name of every aircraft that has a track."""
        return [
            {"id": int(number), "label": self._labels.get(number, ""), "protected": None}
            for number in self._tracks
        ]
