"""TaskTrackerService: logs each change of a task's status.

A task is known, assigned (in a plan of a vehicle), active (as the vehicle reports), or done.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from cratous.services.bus import Envelope

KNOWN, ASSIGNED, ACTIVE, DONE = "known", "assigned", "active", "done"


class Tracked(NamedTuple):
    """Current status of a task, and its vehicle (0: none)."""

    status: str
    vehicle: int = 0


State = dict[int, Tracked]


class TaskTrackerService:
    """Tracks the state of every task; publishes nothing."""

    subscribes: tuple[str, ...] = (
        "afrl.cmasi.Task",
        "afrl.cmasi.AutomationResponse",
        "afrl.cmasi.MissionCommand",
        "afrl.cmasi.EntityState",
        "afrl.cmasi.RemoveTasks",
    )

    def __init__(self, name: str, log: Callable[[str, str], None]) -> None:
        self.name, self._log = name, log

    def start(self) -> State:
        return {}

    def handle(self, state: State, envelope: Envelope, now_ms: int) -> tuple[State, Iterable[Any]]:
        body, topic = envelope.body, envelope.topic
        if topic == "afrl.cmasi.AutomationResponse":
            for command in body.MissionCommandList:
                state = self._assigned(state, command)
            return state, ()
        if topic == "afrl.cmasi.MissionCommand":
            return self._assigned(state, body), ()
        if topic == "afrl.cmasi.RemoveTasks":
            return {n: t for n, t in state.items() if n not in body.TaskList}, ()
        if hasattr(body, "TaskID"):
            return self._told(state, {body.TaskID: Tracked(KNOWN)}), ()
        return self._flown(state, body), ()

    def _assigned(self, state: State, command: Any) -> State:
        tasks = {t for waypoint in command.WaypointList for t in waypoint.AssociatedTasks}
        news = {t: Tracked(ASSIGNED, command.VehicleID) for t in sorted(tasks)}
        return self._told(
            state, {t: new for t, new in news.items() if state.get(t) != Tracked(ACTIVE, new[1])}
        )

    def _flown(self, state: State, body: Any) -> State:
        news = {t: Tracked(ACTIVE, body.ID) for t in body.AssociatedTasks}
        news |= {
            t: Tracked(DONE, body.ID)
            for t, now in state.items()
            if now == Tracked(ACTIVE, body.ID) and t not in news
        }
        return self._told(state, news)

    def _told(self, state: State, news: State) -> State:
        for number, now in news.items():
            if state.get(number) != now:
                whom = f" (vehicle {now.vehicle})" if now.vehicle else ""
                self._log("INFO", f"{self.name}: task {number} is {now.status}{whom}")
        return {**state, **news}
