"""What messages have reported so far: the newest state of each entity, task, zone and region.

A request's mission is built from this, by the same loader that reads UxAS folders.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from cratous.services.bus import Envelope
from cratous.services.loading.uxas_cfg import Configuration, Sent

MOST = 100_000  # most objects kept of one sort


class World:
    """A service that records objects; it publishes nothing."""

    subscribes: tuple[str, ...] = (
        "afrl.cmasi.EntityConfiguration",
        "afrl.cmasi.EntityState",
        "afrl.cmasi.Task",
        "afrl.cmasi.AbstractZone",
        "afrl.cmasi.OperatingRegion",
        "afrl.impact.PointOfInterest",
        "afrl.impact.LineOfInterest",
        "afrl.impact.AreaOfInterest",
        "afrl.cmasi.RemoveTasks",
        "afrl.cmasi.RemoveZones",
        "afrl.cmasi.RemoveEntities",
        "afrl.cmasi.AutomationResponse",
    )

    def __init__(self, name: str = "WorldState") -> None:
        self.name = name
        self._kept: dict[str, dict[int, Sent]] = {}

    def start(self) -> dict[str, dict[int, Sent]]:
        return self._kept

    def handle(
        self, state: dict[str, dict[int, Sent]], envelope: Envelope, now_ms: int
    ) -> tuple[Any, Iterable[Any]]:
        self.add(envelope.body, f"message {envelope.seq} from {envelope.source}", now_ms)
        return state, ()

    def add(self, body: Any, where: str, time_ms: int = 0) -> None:
        """Store an object in place of the previous one with its id."""
        kind = type(body).__name__
        if kind.startswith("Remove"):
            self._remove(kind, body)
            return
        if kind == "AutomationResponse":
            for command in body.MissionCommandList:
                self._keep("mission", command.VehicleID, Sent(command, where, time_ms))
            return
        self._keep(*_key(body), Sent(body, where, time_ms))

    def _keep(self, sort: str, number: int, sent: Sent) -> None:
        kept = self._kept.setdefault(sort, {})
        if number not in kept and len(kept) >= MOST:
            kept.pop(next(iter(kept)))
        kept[number] = sent

    def task(self, number: int) -> Sent | None:
        """The newest task with an id."""
        return self._kept.get("task", {}).get(number)

    def has(self, sort: str, number: int) -> bool:
        """Whether an object of a sort has this id."""
        return number in self._kept.get(sort, {})

    def get(self, sort: str, number: int) -> Any:
        """The newest object of a sort with an id, or None."""
        found = self._kept.get(sort, {}).get(number)
        return None if found is None else found.body

    def forget(self, sort: str, number: int) -> None:
        """Remove an object."""
        self._kept.get(sort, {}).pop(number, None)

    def knows(self, body: Any) -> bool:
        """Whether an object with this one's id is known already."""
        sort, number = _key(body)
        return number in self._kept.get(sort, {})

    def ids(self, sort: str) -> list[int]:
        """The ids of all objects of a sort."""
        return list(self._kept.get(sort, {}))

    def of(self, sort: str) -> list[Any]:
        """All objects of a sort: configuration, state, task, zone, region, point, line, area; mission: the
        newest command of a vehicle's plan.
        """
        return [sent.body for sent in self._kept.get(sort, {}).values()]

    def configuration(
        self, path: Path, root: dict[str, str], services: Any, request: Sent
    ) -> Configuration:
        """All objects known and a request, in the loader's form."""
        sorts = sorted(sort for sort in self._kept if sort != "mission")
        kept = [sent for sort in sorts for sent in self._kept[sort].values()]
        return Configuration(path, root, services, (*kept, request), ())

    def _remove(self, kind: str, body: Any) -> None:
        sorts, numbers = {
            "RemoveTasks": (("task",), "TaskList"),
            "RemoveZones": (("zone",), "ZoneList"),
            "RemoveEntities": (("configuration", "state", "mission"), "EntityList"),
        }[kind]
        for sort in sorts:
            for number in getattr(body, numbers):
                self.forget(sort, number)


def _key(body: Any) -> tuple[str, int]:
    if hasattr(body, "TaskID"):
        return "task", body.TaskID
    if hasattr(body, "ZoneID"):
        return "zone", body.ZoneID
    for sort in ("Point", "Line", "Area"):
        if hasattr(body, f"{sort}ID"):
            return sort.lower(), getattr(body, f"{sort}ID")
    names = body.all_names
    if "afrl.cmasi.EntityState" in names:
        return "state", body.ID
    if "afrl.cmasi.EntityConfiguration" in names:
        return "configuration", body.ID
    return "region", body.ID
