"""Routes, zones and tasks from messages, in the frame of the page."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, Protocol

from cratous.services.ground_station.positions import Local, local_place
from cratous.services.logs.entry import Entry, any_data
from cratous.services.logs.selection import names_of
from cratous.services.logs.views import (
    COMMAND,
    GEO_JSON,
    KEEP_OUT,
    RESPONSE,
    ZONE,
    Views,
    corners_of,
    place_of,
)

GATED = "cratous.GatedCommand"
POINT, LINE, AREA = (f"afrl.cmasi.{kind}SearchTask" for kind in ("Point", "Line", "Area"))
REMOVED = {"afrl.cmasi.RemoveZones": "ZoneList", "afrl.cmasi.RemoveTasks": "TaskList"}
"""Messages that remove shapes, with the field of their ids."""
SHAPED = frozenset((COMMAND, RESPONSE, ZONE, GATED, POINT, LINE, AREA, *REMOVED))


class Kept(Protocol):
    """Storage of rows: a list, or a bounded one."""

    def append(self, row: dict[str, Any], /) -> None:
        """Add a row."""

    def __iter__(self) -> Iterator[dict[str, Any]]: ...


class Shapes:
    """Collects shapes in log order.

    unread: number of messages that could not be decoded; changes: number of changes of zones and
    tasks.
    """

    def __init__(
        self,
        to_local: Local,
        routes: Kept | None = None,
        zones: Kept | None = None,
        tasks: Kept | None = None,
    ) -> None:
        """to_local: latitude, longitude [deg] to north, east [m]; the others: their storage, lists by default."""
        self._to_local, self._views = to_local, Views()
        self._routes: Kept = [] if routes is None else routes
        self._zones: Kept = [] if zones is None else zones
        self._tasks: Kept = [] if tasks is None else tasks
        self.unread = self.changes = 0
        self._names: dict[str, tuple[str, ...]] = {}

    @property
    def routes(self) -> list[dict[str, Any]]:
        """In log order: time, vehicle, sender and waypoints."""
        return list(self._routes)

    @property
    def zones(self) -> list[dict[str, Any]]:
        """Number, kind, label, corners, start time, and end time if removed."""
        return list(self._zones)

    @property
    def tasks(self) -> list[dict[str, Any]]:
        """Number, label, kind and points; end time if removed."""
        return list(self._tasks)

    def add(self, entry: Entry, time_ms: int) -> None:
        """Process a message with its display time [ms]; messages without shapes change nothing."""
        names = self._names.get(entry.topic)
        if names is None:
            names = names_of(entry.topic) or (entry.topic,)
            names = self._names[entry.topic] = () if SHAPED.isdisjoint(names) else names
        if not names:
            return
        body, error = any_data(entry)
        if error is not None or not isinstance(body, dict):
            self.unread += 1
            return
        sender = ""
        if GATED in names:  # a command accepted by the gate, from any sender
            sender, body, names = str(body.get("Sender", "")), body.get("Command"), (COMMAND,)
            if not isinstance(body, dict) or body.get("$type") != "CMASI/MissionCommand":
                return
        taken = next((name for name in REMOVED if name in names), None)
        if taken is not None:
            self._remove(taken, body, time_ms)
        elif ZONE in names:
            self._zone(body, names, time_ms)
        elif COMMAND in names:
            self._route(body, sender, time_ms)
        elif RESPONSE in names:
            for command in body.get("MissionCommandList", ()):
                self._route(command, sender, time_ms)
        else:
            self._task(body, names)

    def _remove(self, name: str, body: Any, time_ms: int) -> None:
        kept, numbers = (
            self._zones if name.endswith("Zones") else self._tasks,
            body.get(REMOVED[name]),
        )
        for one in kept:
            if isinstance(numbers, list) and one["id"] in numbers and one.get("to_ms") is None:
                one["to_ms"] = time_ms
                self.changes += 1

    def _drawn(self, body: Any, names: tuple[str, ...]) -> Iterator[dict[str, Any]]:
        for view in self._views.of(body, names, 0):
            if view.schema == GEO_JSON:
                yield json.loads(view.data["geojson"])["geometry"]

    def _places(self, corners: Any) -> list[tuple[float, float]]:
        """Points from latitudes and longitudes in the frame of the page, or empty if invalid."""
        found = (local_place(self._to_local, *c[:2]) for c in corners if c is not None)
        return [place for place in found if place is not None]

    def _zone(self, body: Any, names: tuple[str, ...], time_ms: int) -> None:
        for shape in self._drawn(body, names):
            self.changes += 1
            self._zones.append(
                {
                    "id": body.get("ZoneID", 0),
                    "kind": "keep_out" if KEEP_OUT in names else "keep_in",
                    "label": str(body.get("Label", "")),
                    "vertices": self._places((c[1], c[0]) for c in shape["coordinates"][0][:-1]),
                    "from_ms": time_ms,
                }
            )

    def _route(self, command: Any, sender: str, time_ms: int) -> None:
        # an empty route replaces the previous one too
        self._routes.append(
            {
                "time_ms": time_ms,
                "vehicle": command.get("VehicleID", 0),
                "sender": sender,
                "points": self._places(place_of(w) for w in command.get("WaypointList", ())),
            }
        )

    def _task(self, body: Any, names: tuple[str, ...]) -> None:
        if POINT in names:
            found = [place_of(body.get("SearchLocation"))]
        elif LINE in names:
            found = [place_of(point) for point in body.get("PointList", ())]
        elif AREA in names:
            found = [(*corner, 0.0) for corner in corners_of(body.get("SearchArea"))]
        else:
            return
        places = self._places(found)
        if places:
            self.changes += 1
            self._tasks.append(
                {
                    "id": body.get("TaskID", 0),
                    "label": str(body.get("Label", "")),
                    "kind": names[0].rpartition(".")[2],
                    "points": places,
                    "radius_m": 0.0,
                    "closed": AREA in names,
                }
            )
