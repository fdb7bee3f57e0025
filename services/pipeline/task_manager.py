"""TaskManagerService: creates a task's service when the task arrives, and ends it when the task is removed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.pipeline.world import World


class TaskManagerService:
    """Task -> CreateNewService with its XML; a task with a known id, or RemoveTasks -> KillService."""

    subscribes: tuple[str, ...] = ("afrl.cmasi.Task", "afrl.cmasi.RemoveTasks")
    knows = ("EntityConfiguration", "EntityState")

    def __init__(self, name: str, world: World, new_id: Callable[[], int]) -> None:
        """new_id(): the next service id of this process."""
        self.name, self._world, self._new_id = name, world, new_id

    def start(self) -> dict[int, int]:
        return {}

    def handle(
        self, state: dict[int, int], envelope: Envelope, now_ms: int
    ) -> tuple[dict[int, int], Iterable[Any]]:
        body = envelope.body
        if envelope.topic == "afrl.cmasi.RemoveTasks":
            gone = [n for n in body.TaskList if n in state]
            left = {n: service for n, service in state.items() if n not in gone}
            return left, [lmcp.new("KillService", ServiceID=state[n]) for n in gone]
        out: list[Any] = []
        if body.TaskID in state:
            out.append(lmcp.new("KillService", ServiceID=state[body.TaskID]))
        number = self._new_id()
        out.append(self._create(body, envelope.topic, number))
        return {**state, body.TaskID: number}, out

    def _create(self, task: Any, full_name: str, number: int) -> Any:
        world = self._world
        # the receiver adds the closing tag, as in UxAS
        text = f'<Service Type="{full_name}"><TaskRequest>{lmcp.xml.dumps(task)}</TaskRequest>'
        return lmcp.new(
            "CreateNewService",
            ServiceID=number,
            XmlConfiguration=text,
            EntityConfigurations=[x.copy() for x in world.of("configuration")],
            EntityStates=[x.copy() for x in world.of("state")],
            KeepInZones=[x.copy() for x in world.of("zone") if type(x).__name__ == "KeepInZone"],
            KeepOutZones=[x.copy() for x in world.of("zone") if type(x).__name__ == "KeepOutZone"],
            OperatingRegions=[x.copy() for x in world.of("region")],
        )
