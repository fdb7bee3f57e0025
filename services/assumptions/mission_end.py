"""Assumptions on the executive: it checks for the end at each step, and settled tasks stay settled."""

from __future__ import annotations

from cratous.core.authority.timeliness import in_time
from cratous.services.assumptions.authority import icarous_has
from cratous.services.assumptions.observations import ANY_LATER, EVERY, Message, Record, gone_ms
from cratous.spec.mission import Mission

SETTLED = ("Complete", "Failed")
COUNTED = ("complete", "failed")
"""Outcomes with which a flight ends only when no vehicle is awaited; a limit or operator ends it regardless."""
AT_WORK = ("Transit", "Waiting", "Active", "Suspended")


class EndWatch:
    """Checks that no message comes later than the time limit plus one step."""

    kinds = EVERY

    def __init__(self, mission: Mission) -> None:
        simulation = mission.simulation
        self._most_ms = simulation.limit_ms + simulation.step_ms
        self._record = Record("s", self._most_ms / 1000, (in_time,), waits="no message was seen")

    def message(self, message: Message) -> None:
        """Process any message; position messages are counted, since one comes at each step."""
        now_ms = max(0, message.time_ms)
        ok = in_time(0, now_ms, self._most_ms)
        if message.kind == "TruthState" or not ok:
            self._record.see(now_ms / 1000)
        if not ok:
            text = f"a {message.kind} at {now_ms / 1000:.2f} s"
            self._record.check(ok, self._most_ms, 0, text)

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: no check is pending."""

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"end of the flight": self._record}


class AwayWatch:
    """Checks that a flight that ends before its limit ends with no vehicle in the air under ICAROUS."""

    kinds = ("AuthorityChange", "TruthState", "MissionEnd")

    def __init__(self, mission: Mission) -> None:
        self._away = {v.id: False for v in mission.vehicles}
        self._lost_ms = gone_ms(mission)
        self._moves: dict[int, bool] = {}
        unseen = "" if mission.instances else "no vehicle has an ICAROUS instance"
        waits = "the flight ended neither complete nor failed, so nobody had to be counted"
        self._record = Record("vehicles", 0, unseen=unseen, waits=waits)

    def message(self, message: Message) -> None:
        """Process one message: commander of a vehicle, its motion, or the outcome of the flight."""
        body = message.body
        if message.kind == "TruthState" and body.VehicleID in self._away:
            self._moves[body.VehicleID] = any(
                (body.VelocityNorth, body.VelocityEast, body.VelocityDown)
            )
        elif message.kind == "AuthorityChange":
            self._away[body.VehicleID] = icarous_has(body)
        elif message.kind == "MissionEnd" and body.Outcome in COUNTED:
            self._ends(message)

    def _ends(self, message: Message) -> None:
        """Check the end of the flight: a vehicle at rest before take-off or after landing is not awaited."""
        at_ms = message.time_ms
        there = [
            vid for vid in self._away if in_time(at_ms, self._lost_ms.get(vid, at_ms), ANY_LATER)
        ]
        away = [vid for vid in there if self._away[vid] and self._moves.get(vid, True)]
        unseen = [vid for vid in there if vid not in self._moves]
        self._record.gaps.extend(f"vehicle {vid} was not seen" for vid in unseen)
        self._record.see(len(away))
        vid = away[0] if away else 0
        text = f"the flight ended as {message.body.Outcome} while vehicle {vid} was under ICAROUS"
        self._record.check(not away, at_ms, vid, text)

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: no check is pending."""

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"vehicles away counted": self._record}


class SettledWatch:
    """Checks that a completed or failed task is not flown again."""

    kinds = ("TaskProgress",)

    def __init__(self) -> None:
        self._settled: dict[int, str] = {}
        self._again = 0
        self._record = Record("tasks", 0, waits="no task was seen")

    def message(self, message: Message) -> None:
        """Process a change of a task's phase."""
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
        """End of the messages at at_ms [ms]: no check is pending."""

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"settled tasks": self._record}
