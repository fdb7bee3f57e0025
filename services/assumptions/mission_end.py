"""Assumptions on the executive: it asks for the end at each step, and settled tasks stay settled."""

from __future__ import annotations

from cratous.core.authority.timeliness import in_time
from cratous.services.assumptions.observed import EVERY, Message, Record
from cratous.spec.mission import Mission

SETTLED = ("Complete", "Failed")
AT_WORK = ("Transit", "Waiting", "Active", "Suspended")


class EndWatch:
    """No message comes later than the limit and one step."""

    kinds = EVERY

    def __init__(self, mission: Mission) -> None:
        simulation = mission.simulation
        self._most_ms = simulation.limit_ms + simulation.step_ms
        self._record = Record("s", self._most_ms / 1000, (in_time,), waits="no message was seen")

    def message(self, message: Message) -> None:
        """Any message; those that say where somebody is are counted, for they come at each step."""
        now_ms = max(0, message.time_ms)
        ok = in_time(0, now_ms, self._most_ms)
        if message.kind == "TruthState" or not ok:
            self._record.see(now_ms / 1000)
        if not ok:
            text = f"a {message.kind} at {now_ms / 1000:.2f} s"
            self._record.check(ok, self._most_ms, 0, text)

    def end(self, at_ms: int) -> None:
        """Nothing is open."""

    def records(self) -> dict[str, Record]:
        """See `Watch`."""
        return {"end of the flight": self._record}


class SettledWatch:
    """A task that is complete or has failed is not flown again."""

    kinds = ("TaskProgress",)

    def __init__(self) -> None:
        self._settled: dict[int, str] = {}
        self._again = 0
        self._record = Record("tasks", 0, waits="no task was seen")

    def message(self, message: Message) -> None:
        """The phase of a task."""
        if message.kind != "TaskProgress":
            return
        body, phase = message.body, message.body.Phase.name
        was = self._settled.get(body.TaskID)
        again = was is not None and phase in AT_WORK
        self._again += again
        self._record.see(self._again)
        text = f"task {body.TaskID} is {phase.lower()} after it was {str(was).lower()}"
        self._record.check(not again, message.time_ms, body.VehicleID, text)
        if phase in SETTLED:
            self._settled[body.TaskID] = phase

    def end(self, at_ms: int) -> None:
        """Nothing is open."""

    def records(self) -> dict[str, Record]:
        """See `Watch`."""
        return {"settled tasks": self._record}
