"""WaypointPlanManagerService and SimpleWaypointPlanManagerService: plans for one vehicle.

The manager sends a long path in segments; the proved kernels of `core.contracts.segments` decide
which positions of the path come next. A cyclic path never ends.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.contracts.segments import Span, first_span, span_after, waypoint_after
from cratous.services.bus import Envelope

RESPONSE, COMMAND = "afrl.cmasi.AutomationResponse", "afrl.cmasi.MissionCommand"
INCREMENT = "uxas.messages.uxnative.IncrementWaypoint"
STATES = (
    "afrl.cmasi.AirVehicleState",
    "afrl.vehicles.GroundVehicleState",
    "afrl.vehicles.SurfaceVehicleState",
)
AHEAD_DEG = -60.0
"""Gimbal elevation at the end of a mission, above the horizon [deg]."""
FAR = 2**60
"""Last position of a cyclic path."""


class Serving(NamedTuple):
    """How a path is served; to_serve, overlap: waypoints per segment, and shared with the next.

    radius_m: of loiters at the end of the mission, or of each segment; turn_type: of all waypoints;
    gimbal: payload pointed ahead and down at the end of the mission, below 1: none.
    """

    to_serve: int = 100_000
    overlap: int = 3
    radius_m: float = 200.0
    loiter_segments: bool = False
    loiter_mission: bool = False
    back_to_first_task: bool = False
    stop_at_end: bool = False
    turn_type: str = "TurnShort"
    gimbal: int = -1


class Path(NamedTuple):
    """Waypoints in flight order; back_to: index that follows the last one (its own: the path ends there)."""

    command: Any
    waypoints: tuple[Any, ...]
    back_to: int

    @property
    def end(self) -> int:
        """The last position."""
        return FAR if self.cyclic else len(self.waypoints) - 1

    @property
    def cyclic(self) -> bool:
        """True if the path is cyclic."""
        return self.back_to != len(self.waypoints) - 1

    def indices(self, span: Span) -> list[int]:
        """Indices of the waypoints at the positions of a span."""
        found, index = [], 0
        for _ in range(self._same(span.first)):
            index = waypoint_after(index, len(self.waypoints), self.back_to)
        for _ in range(span.first, span.last + 1):
            found.append(index)
            index = waypoint_after(index, len(self.waypoints), self.back_to)
        return found

    def _same(self, position: int) -> int:
        """The position in the first round with the same waypoint."""
        count = len(self.waypoints)
        if not self.cyclic or position < count:
            return position
        return self.back_to + (position - self.back_to) % (count - self.back_to)


def path_of(command: Any, serving: Serving) -> Path:
    """The path of a MissionCommand: from its first waypoint, following the NextWaypoint links."""
    known = {w.Number: w for w in command.WaypointList}
    order: dict[int, int] = {}
    number = command.FirstWaypoint if command.FirstWaypoint in known else next(iter(known))
    while number in known and number not in order:
        order[number] = len(order)
        number = known[number].NextWaypoint
    points = [known[n].copy(TurnType=serving.turn_type) for n in order]
    back_to = order.get(number, len(points) - 1)
    if serving.back_to_first_task and back_to == len(points) - 1:
        tasked = (k for k, w in enumerate(points) if w.AssociatedTasks)
        back_to = next(tasked, back_to)
        points[-1] = points[-1].copy(NextWaypoint=points[back_to].Number)
    if back_to == len(points) - 1:
        last = points[-1].copy(NextWaypoint=points[-1].Number)
        if serving.stop_at_end:
            last = last.copy(Speed=0.0)
        if serving.loiter_mission:
            last = _loitering(last, serving.radius_m)
        if serving.gimbal > 0:
            ahead = lmcp.new("GimbalAngleAction", PayloadID=serving.gimbal, Elevation=AHEAD_DEG)
            last = last.copy(VehicleActionList=[*last.VehicleActionList, ahead])
        points[-1] = last
    return Path(command, tuple(points), back_to)


def _loitering(waypoint: Any, radius_m: float) -> Any:
    place = {k: getattr(waypoint, k) for k in ("Latitude", "Longitude", "Altitude", "AltitudeType")}
    action = lmcp.new(
        "LoiterAction",
        LoiterType="Circular",
        Radius=radius_m,
        Duration=-1,
        Airspeed=waypoint.Speed,
        Location=lmcp.new("Location3D", **place),
    )
    return waypoint.copy(VehicleActionList=[*waypoint.VehicleActionList, action])


class Served(NamedTuple):
    """The path in progress, the segment sent to the vehicle, its current waypoint, the last command id, and the
    vehicle's newest state (None: not known).
    """

    path: Path | None = None
    span: Span = Span(0, 0)
    waypoint: int = 0
    commands: int = 0
    newest: Any = None


Step = tuple[Served, Iterable[Any]]


class WaypointPlanManagerService:
    """AutomationResponse or MissionCommand -> MissionCommands with a few waypoints each, in sequence; without
    waypoints, no more of them: the vehicle circles where it is, or stands there.
    """

    subscribes: tuple[str, ...] = (RESPONSE, COMMAND, INCREMENT, *STATES)

    def __init__(self, name: str, vehicle: int, serving: Serving) -> None:
        self.name, self._vehicle, self._serving = name, vehicle, serving

    def start(self) -> Served:
        return Served()

    def handle(self, state: Served, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        if topic == RESPONSE:
            for command in body.MissionCommandList:
                if command.VehicleID == self._vehicle:
                    return self._begin(state, command)
            return state, ()
        if topic in STATES:
            if self._vehicle != body.ID:
                return state, ()
            return self._flown(state._replace(newest=body), body)
        if body.VehicleID != self._vehicle:
            return state, ()
        if topic == COMMAND:
            return self._begin(state, body)
        return self._increment(state)

    def _begin(self, state: Served, command: Any) -> Step:
        if not command.WaypointList:
            return self._end(state, command)
        path = path_of(command, self._serving)
        end = len(path.waypoints) - 1 if self._all(path) else path.end
        span = first_span(end, self._length(path))
        begun = state._replace(path=path, span=span, waypoint=0)
        return self._serve(begun, path.waypoints[0].Number)

    def _end(self, state: Served, command: Any) -> Step:
        """The mission is over: nothing more is served, and the vehicle is told to stay where it is, if that is known."""
        here, over = state.newest, state._replace(path=None, span=Span(0, 0), waypoint=0)
        if here is None:
            return over, ()
        stay = lmcp.new(
            "LoiterAction",
            LoiterType="Circular",
            Radius=self._serving.radius_m,
            Duration=-1,
            Airspeed=getattr(here, "Airspeed", here.Groundspeed) or here.u,
            Location=here.Location,
        )
        told = lmcp.new(
            "VehicleActionCommand",
            CommandID=state.commands + 1,
            VehicleID=self._vehicle,
            VehicleActionList=[*command.VehicleActionList, stay],
        )
        return over._replace(commands=state.commands + 1), [told]

    def _length(self, path: Path) -> int:
        """Length of a segment; for a cyclic path at most the number of waypoints in the cycle."""
        if not path.cyclic or self._all(path):
            return self._serving.to_serve
        return min(self._serving.to_serve, len(path.waypoints) - path.back_to)

    def _next(self, state: Served, path: Path) -> Span:
        length = self._length(path)
        return span_after(state.span, path.end, length, min(self._serving.overlap, length - 1))

    def _serve(self, state: Served, first: int) -> Step:
        """The current segment as a command that begins with waypoint number `first`."""
        path = state.path
        assert path is not None
        points = [path.waypoints[k] for k in path.indices(state.span)]
        if state.span.last != path.end and not self._all(path):
            last = points[-1].copy(NextWaypoint=points[-1].Number)
            if self._serving.loiter_segments:
                last = _loitering(last, self._serving.radius_m)
            points[-1] = last
        command = path.command.copy(
            CommandID=state.commands + 1, WaypointList=points, FirstWaypoint=first
        )
        return state._replace(commands=state.commands + 1, waypoint=first), [command]

    def _all(self, path: Path) -> bool:
        """True if one segment contains a whole cycle, which then repeats by itself."""
        return path.cyclic and self._serving.to_serve >= len(path.waypoints)

    def _flown(self, state: Served, body: Any) -> Step:
        """Send the next segment when the vehicle has reached the waypoints that both share."""
        path, number = state.path, body.CurrentWaypoint
        if path is None or number == state.waypoint:
            return state, ()
        here = [path.waypoints[k].Number for k in path.indices(state.span)]
        if number not in here:
            return state, ()
        state = state._replace(waypoint=number)
        if self._all(path):
            return state, ()
        following = self._next(state, path)
        if following == state.span or state.span.first + here.index(number) < following.first:
            return state, ()
        return self._serve(state._replace(span=following), number)

    def _increment(self, state: Served) -> Step:
        """Send the vehicle to the waypoint after its current one."""
        path = state.path
        if path is None:
            return state, ()
        numbers = [w.Number for w in path.waypoints]
        index = waypoint_after(numbers.index(state.waypoint), len(numbers), path.back_to)
        here = [numbers[k] for k in path.indices(state.span)]
        if numbers[index] not in here:
            state = state._replace(span=self._next(state, path))
        return self._serve(state, numbers[index])


class SimpleWaypointPlanManagerService:
    """AutomationResponse -> the complete MissionCommand of one vehicle."""

    subscribes: tuple[str, ...] = (RESPONSE,)

    def __init__(self, name: str, vehicle: int) -> None:
        self.name, self._vehicle = name, vehicle

    def start(self) -> int:
        return 0

    def handle(self, state: int, envelope: Envelope, now_ms: int) -> tuple[int, Iterable[Any]]:
        """state: number of commands so far."""
        mine = [c for c in envelope.body.MissionCommandList if c.VehicleID == self._vehicle]
        out = [command.copy(CommandID=state + k + 1) for k, command in enumerate(mine)]
        return state + len(out), out
