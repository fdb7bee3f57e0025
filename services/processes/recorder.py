"""The log of a flight in processes: the simulator provides the truth, UxAS's bus everything else.

Times are mission times: 0 is the simulator's first state, before which nothing flies. A state is logged when
the next one is known, so that `TruthState` has the velocity that leads there: between two states, half a
second apart, straight flight is assumed.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.exporting.messages import payloads_of
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.notices import mission_end, plan_accepted, truth
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Mission, Position
from cratous.spec.mission.plan import Plan

HELD = 10
"""Number of recent instants held back for late messages from UxAS."""
SIMULATION, UXAS, RECORDER = "simulation", "uxas", "recorder"
TIMES = ("Time", "Heard", "TimeTaskActivated", "TimeTaskCompleted")
"""Message fields with times of the simulator."""
OF_TIME = frozenset(
    {"TaskActive", "TaskComplete", "GateState", "AuthorityChange", "Heartbeat", "BridgeStatus",
     "ModeRefused", "CommandDropped", "LinkLossState"}
)  # fmt: skip
"""The messages with such fields."""
AT_CHANGE = {"ICAROUS": ("Suspended", "ICAROUS has the vehicle"), "UxAS": ("Active", "handed back")}
"""Task phase and note at a takeover and at a handback."""


@dataclass
class Instant:
    """One time of the simulator [ms of the mission], and the states of all aircraft by id."""

    time_ms: int
    states: dict[int, Any] = field(default_factory=dict)


class Recorder:
    """Publishes the messages of a flight on a bus in order, for the log and the monitor."""

    def __init__(self, mission: Mission, bus: Bus) -> None:
        self._plane, self._bus = Projection(mission.frame), bus
        self._ours = frozenset(mission.instances)
        self._zero_ms: int | None = None
        self._instants: deque[Instant] = deque()
        self._stream: deque[tuple[int, Any]] = deque()
        self._told_ms = 0
        self._cameras = {
            (v.id, seen.PayloadID): camera.payload_id
            for v in mission.vehicles
            for camera, (_, seen) in zip(v.cameras, payloads_of(v), strict=True)
        }
        self._doing: dict[int, int] = {}

    @property
    def now_ms(self) -> int:
        """Mission time of the newest state [ms]."""
        return self._instants[-1].time_ms if self._instants else 0

    # what comes -----------------------------------------------------------------------------------

    def state(self, body: Any) -> None:
        """Record an AirVehicleState; one of a new time completes the previous instant."""
        if self._zero_ms is None:
            self._zero_ms = int(body.Time)
        time_ms = int(body.Time) - self._zero_ms
        if time_ms not in (instant.time_ms for instant in self._instants):
            if len(self._instants) == HELD:
                self._log(self._instants.popleft(), self._instants[0])
            self._instants.append(Instant(time_ms))
        self._instants[-1].states[body.ID] = body.copy(
            Time=time_ms, PayloadStateList=[self._named(body.ID, p) for p in body.PayloadStateList]
        )

    def accepted(self, plan: Plan) -> None:
        """Record the plan in force."""
        self._say(plan_accepted(self.now_ms, plan, frozenset()))

    def heard(self, body: Any) -> Any:
        """Record a message of UxAS's bus; returns it with times of the mission."""
        kind = type(body).__name__
        if kind in OF_TIME and self._zero_ms is not None:
            zero_ms = self._zero_ms
            times = {n: max(0, getattr(body, n) - zero_ms) for n in TIMES if n in body.names}
            body = body.copy(**times)
            self._told_ms = max(self._told_ms, *times.values())
        self._say(body)
        if kind == "TaskActive":
            self._doing[body.EntityID] = body.TaskID
            self._progress(body.EntityID, body.TaskID, "Active", "")
        elif kind == "TaskComplete":
            for vehicle in body.EntitiesInvolved:
                self._ended(vehicle, body.TaskID, "Complete", "")
        elif kind == "AuthorityChange":
            self._authority(body)
        return body

    def failed(self, task: int, vehicle: int, why: str) -> None:
        """Record a task that ended undone or did not end."""
        self._ended(vehicle, task, "Failed", why)

    def end(self, outcome: str) -> None:
        """End the mission at the newest instant; without an outcome the log just stops."""
        self._told_ms = self.now_ms
        if outcome:
            self._say(mission_end(self.now_ms, outcome))
        while self._instants:
            now = self._instants.popleft()
            self._log(now, self._instants[0] if self._instants else None)

    # what is logged -------------------------------------------------------------------------------

    def _authority(self, body: Any) -> None:
        """A takeover suspends the vehicle's task, a handback resumes it."""
        if body.VehicleID in self._doing:
            vehicle = body.VehicleID
            self._progress(vehicle, self._doing[vehicle], *AT_CHANGE[body.Owner.name])

    def _ended(self, vehicle: int, task: int, phase: str, note: str) -> None:
        """A task has ended; the vehicle may already be flying the next one."""
        self._progress(vehicle, task, phase, note)
        if self._doing.get(vehicle) == task:
            del self._doing[vehicle]

    def _progress(self, vehicle: int, task: int, phase: str, note: str) -> None:
        self._say(
            lmcp.new(
                "TaskProgress",
                TaskID=task,
                VehicleID=vehicle,
                Time=self._told_ms,
                Phase=phase,
                Served=1.0 if phase == "Complete" else 0.0,
                Note=note,
            )
        )

    def _say(self, body: Any) -> None:
        """Queue a message of UxAS's bus, at the newest time received there."""
        self._stream.append((self._told_ms, body))

    def _named(self, vehicle: int, payload: Any) -> Any:
        """A camera's state with the mission's id for it, that of its gimbal."""
        number = self._cameras.get((vehicle, payload.PayloadID))
        if number is None or type(payload).__name__ != "CameraState":
            return payload
        return payload.copy(PayloadID=number)

    def _log(self, now: Instant, following: Instant | None) -> None:
        """Log an instant with the velocity to the following one, and the messages until then; None: all
        messages.
        """
        self._bus.now_ms = now_ms = now.time_ms
        for vehicle, body in sorted(now.states.items()):
            after, span_ms = None, 0
            if following is not None:
                after, span_ms = following.states.get(vehicle), following.time_ms - now_ms
            air = self._air(body, after, span_ms)
            self._bus.publish(body, SIMULATION)
            self._bus.publish(truth(vehicle, air, now_ms, vehicle in self._ours), SIMULATION)
        while self._stream and (
            following is None or self._stream[0][0] in range(following.time_ms)
        ):
            _, body = self._stream.popleft()
            self._bus.publish(body, RECORDER if type(body).__name__ in _OURS else UXAS)
        self._bus.run()

    def _air(self, body: Any, after: Any, span_ms: int) -> AirState:
        """Position, and the velocity that leads to the next state; for the last state, its own velocity."""
        here = self.place(body)
        if after is None or not span_ms:
            heading = math.radians(body.Course)
            return AirState(here, heading, body.Groundspeed, body.VerticalSpeed)
        there, span_s = self.place(after), span_ms / 1000
        north, east = there.north_m - here.north_m, there.east_m - here.east_m
        climb = (there.alt_m - here.alt_m) / span_s
        return AirState(here, math.atan2(east, north), math.hypot(north, east) / span_s, climb)

    def place(self, body: Any) -> Position:
        """The position in a state, in the mission's frame."""
        at = body.Location
        return Position(*self._plane.to_local(at.Latitude, at.Longitude), float(at.Altitude))


_OURS = ("TaskProgress", "PlanAccepted", "MissionEnd")
"""Messages derived from UxAS's bus, not published there."""
