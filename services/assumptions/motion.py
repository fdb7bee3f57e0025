"""Assumptions on motion during a takeover: an intruder in its tube, a vehicle on its path. Decided
by `disc_within`.

ICAROUS keeps a volume that is `buffer` times the mission's. The excess over DTHR and ZTHR is
divided: half for the intruder, half for the vehicle. While both deviate by no more than that, a
prediction that keeps the buffered cylinder clear implies that the mission's own is clear.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from cratous.core.authority.gate import ICAROUS, UXAS, Gate, gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.core.avoidance.manoeuvre import Ability, Motion, fly_to
from cratous.core.avoidance.prediction import Piece, after
from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.services.assumptions.authority import (
    UNTOUCHED,
    icarous_has,
    reported,
    sender_of,
)
from cratous.services.assumptions.link import NO_INSTANCE
from cratous.services.assumptions.observations import ANY_LATER, Message, Record
from cratous.spec.mission import Daa, Mission, Position, Velocity

GRAVITY_M_S2 = 9.80665
ACCELERATION_M_S2 = 1.0
"""Maximum acceleration of an airframe [m/s2], the same as in the simulator."""
SHARE = 0.5
"""Each aircraft's share of the buffer's excess: half for the intruder, half for the vehicle."""
ROUNDED_M = 1e-3
"""Minimum tolerance [m]: positions are sums of rounded steps, so this much is no deviation."""


class Room(NamedTuple):
    """Permitted deviation from a prediction: horizontally and in altitude [m]."""

    wide_m: float
    high_m: float


def room_of(daa: Daa) -> Room:
    """The permitted deviation of one aircraft."""
    left, volume = SHARE * (daa.buffer - 1), daa.well_clear
    return Room(max(ROUNDED_M, left * volume.dthr_m), max(ROUNDED_M, left * volume.zthr_m))


def is_within(off: Position, room: Room) -> bool:
    """Whether a deviation from a prediction is within its limits; exact on the given numbers."""
    numbers = (*off, *room)
    if not all(map(math.isfinite, numbers)):
        return False
    ratios = [x.as_integer_ratio() for x in numbers]
    unit = max(below for _, below in ratios)  # powers of two
    # integers in one unit: exact, and fastest in CPython
    whole: list[Any] = [above * (unit // below) for above, below in ratios]
    north, east, up, wide, high = whole
    nothing: Any = 0
    beside = disc_within(Vec2(north, east), nothing, wide)
    return bool(beside) and bool(disc_within(Vec2(up, nothing), nothing, high))


def look(record: Record, off: Position, room: Room, seen: tuple[int, int], what: str) -> None:
    """Record a deviation from a prediction and check it. seen: time [ms], and the vehicle taken
    over; what: break text with "{off}" in place of the deviation.
    """
    at_ms, number = seen
    beside_m = math.hypot(off.north_m, off.east_m)
    record.see(beside_m)
    apart = f"{beside_m:.4g} m beside and {abs(off.alt_m):.4g} m above or below"
    record.check(is_within(off, room), at_ms, number, what.format(off=apart))


class Seen(NamedTuple):
    """Position of an aircraft, and the velocity with which it arrived there: what observers know."""

    time_ms: int
    position: Position
    velocity: Velocity


def off_by(here: Position, predicted: Position) -> Position:
    """Difference between actual and predicted position [m]."""
    return Position(
        here.north_m - predicted.north_m,
        here.east_m - predicted.east_m,
        here.alt_m - predicted.alt_m,
    )


class Positions:
    """Combines successive samples of an aircraft: the velocity in a sample is that of the next step."""

    def __init__(self) -> None:
        self._coming: dict[int, Velocity] = {}
        self._newest: tuple[Message, Seen] | None = None

    def seen(self, message: Message) -> Seen:
        """The sample with the velocity that led to it; repeated calls with the newest message give the same."""
        if self._newest is not None and self._newest[0] is message:
            return self._newest[1]
        body = message.body
        coming = Velocity(body.VelocityNorth, body.VelocityEast, body.VelocityDown)
        came = self._coming.get(body.VehicleID, coming)
        self._coming[body.VehicleID] = coming
        place = Position(body.North, body.East, body.Altitude)
        seen = Seen(message.time_ms, place, came)
        self._newest = message, seen
        return seen


class IntruderWatch:
    """Observes the intruder of each takeover, until the vehicle is handed back."""

    kinds = ("AuthorityChange", "SensedState", "TruthState")

    def __init__(self, mission: Mission, positions: Positions | None = None) -> None:
        """positions: shared with other watches of the same samples."""
        self._room = room_of(mission.daa)
        self._ahead_ms = round(1000 * mission.daa.lookahead_s)
        self._instances = frozenset(mission.instances)
        self._positions = positions or Positions()
        self._avoided: dict[int, set[int]] = {}
        self._sources: dict[tuple[int, int], int] = {}
        self._base: dict[tuple[int, int], Seen] = {}
        self._last: dict[tuple[int, int], int] = {}
        self._step_ms = mission.simulation.step_ms
        none = "" if mission.instances else NO_INSTANCE
        waits = "no takeover because of an intruder"
        kernels = (disc_within, in_time)
        self._record = Record("m", self._room.wide_m, kernels, none, waits=waits)

    def message(self, message: Message) -> None:
        """Process one message: a change of command, or the true state of an aircraft."""
        kind, now_ms, _, body = message
        if kind == "AuthorityChange" and body.VehicleID in self._instances:
            own = body.VehicleID
            if not icarous_has(body):
                self._forget(own, now_ms)
            elif body.IntruderID:
                # a radar track has its own number
                other = self._sources.get((own, body.IntruderID), body.IntruderID)
                self._record.waits = "the intruder was not seen during the takeover"
                self._avoided.setdefault(own, set()).add(other)
                self._last[own, other] = now_ms
        elif kind == "SensedState":
            self._sources[body.ObserverID, body.TrackID] = body.VehicleID
        elif kind == "TruthState":
            self._sample(message)

    def _forget(self, own: int, now_ms: int) -> None:
        for other in self._avoided.pop(own, ()):
            self._was_seen(own, other, now_ms)
            self._base.pop((own, other), None)

    def _was_seen(self, own: int, other: int, now_ms: int) -> None:
        """Note a gap between the last sample and now."""
        last_ms = self._last[own, other]
        who = f"aircraft {other}, which {own} avoids,"
        self._record.unseen_between(who, last_ms, now_ms, self._step_ms)

    def _sample(self, message: Message) -> None:
        here, other = self._positions.seen(message), message.body.VehicleID
        for own, avoided in self._avoided.items():
            if other not in avoided:
                continue
            base = self._base.get((own, other))
            self._was_seen(own, other, here.time_ms)
            self._last[own, other] = here.time_ms
            if base is not None:
                self._hold(own, other, base, here)
            if base is None or not in_time(base.time_ms, here.time_ms, self._ahead_ms - 1):
                self._base[own, other] = here

    def _hold(self, own: int, other: int, base: Seen, here: Seen) -> None:
        v, p, t_s = base.velocity, base.position, (here.time_ms - base.time_ms) / 1000
        off = off_by(here.position, after(Piece(0.0, t_s, p, v), t_s))
        who = f"aircraft {other}, which {own} avoids"
        since = f"where it was predicted at {base.time_ms / 1000:.2f} s"
        look(self._record, off, self._room, (here.time_ms, own), f"{who}, is {{off}} {since}")

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: open takeovers end here."""
        for own in list(self._avoided):
            self._forget(own, at_ms)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"intruder in its tube": self._record}


class Order(NamedTuple):
    """A command of ICAROUS and its time: heading [rad], ground speed and climb rate [m/s]."""

    at_ms: int
    heading_rad: float
    speed_m_s: float
    climb_m_s: float


class Path(NamedTuple):
    """Predicted path of a vehicle between two instants [ms]."""

    since_ms: int
    until_ms: int
    pieces: tuple[Piece, ...]

    def at(self, t_s: float) -> Position:
        """The predicted position t_s seconds after the start of the path."""
        index = sum(
            in_time(round(1000 * p.start_s), round(1000 * t_s), ANY_LATER) for p in self.pieces
        )
        piece = self.pieces[max(0, index - 1)]
        return after(piece, t_s - piece.start_s)


class TrackingWatch:
    """Observes every vehicle under ICAROUS, from each of its commands to the next heartbeat."""

    kinds = ("GateState", "GatedCommand", "TruthState")

    def __init__(self, mission: Mission, positions: Positions | None = None) -> None:
        """positions: shared with other watches of the same samples."""
        self._room = room_of(mission.daa)
        self._period_ms = mission.simulation.heartbeat_ms
        self._bank = {v.id: v.max_bank_rad for v in mission.vehicles}
        self._gates = dict.fromkeys(mission.instances, UNTOUCHED)
        self._positions = positions or Positions()
        self._ordered: dict[int, Order] = {}
        self._paths: dict[int, Path] = {}
        none = "" if mission.instances else NO_INSTANCE
        kernels = (disc_within, gate_accepts, in_time)
        self._record = Record("m", self._room.wide_m, kernels, none, waits="no takeover")

    def message(self, message: Message) -> None:
        """Process a gate state, a command, or the true state of an aircraft."""
        kind, _, _, body = message
        if kind not in ("GateState", "GatedCommand", "TruthState"):
            return
        if body.VehicleID not in self._gates:
            return
        if kind == "GateState":
            self._gates[body.VehicleID] = reported(body)
        elif kind == "GatedCommand":
            self._command(message, self._gates[body.VehicleID])
        else:
            self._sample(message)

    def _command(self, message: Message, gate: Gate) -> None:
        body, number = message.body, message.body.VehicleID
        sender = sender_of(body)
        if not gate_accepts(gate, sender, body.Epoch):
            return
        unseen = self._ordered.pop(number, None)
        # the second of two commands at one instant is flown
        if unseen is not None and not in_time(message.time_ms, unseen.at_ms, 0):
            self._record.gaps = [f"vehicle {number} was not seen after each command of ICAROUS"]
        path = self._paths.get(number)
        if path is not None and sender == UXAS:
            self._paths[number] = path._replace(until_ms=min(path.until_ms, message.time_ms))
        action: Any = next(iter(getattr(body.Command, "VehicleActionList", None) or ()), None)
        if sender == ICAROUS and type(action).__name__ == "FlightDirectorAction":
            self._record.waits = "the vehicle was not seen after a command of ICAROUS"
            course = math.radians(action.Heading)
            order = Order(message.time_ms, course, action.Speed, action.ClimbRate)
            self._ordered[number] = order

    def _sample(self, message: Message) -> None:
        number, here = message.body.VehicleID, self._positions.seen(message)
        path = self._paths.get(number)
        if path is not None:
            self._hold(number, path, here)
        order = self._ordered.pop(number, None)
        if order is not None:
            self._paths[number] = self._predicted(number, here, order)

    def _hold(self, number: int, path: Path, here: Seen) -> None:
        if not in_time(here.time_ms, path.until_ms, self._period_ms):
            del self._paths[number]
            return
        off = off_by(here.position, path.at((here.time_ms - path.since_ms) / 1000))
        since = f"the path of its command of {path.since_ms / 1000:.2f} s"
        seen = here.time_ms, number
        look(self._record, off, self._room, seen, f"vehicle {number} is {{off}} {since}")

    def _predicted(self, number: int, here: Seen, order: Order) -> Path:
        v = here.velocity
        speed = math.hypot(v.north_m_s, v.east_m_s)
        now = Motion(here.position, math.atan2(v.east_m_s, v.north_m_s), speed, -v.down_m_s)
        rate = GRAVITY_M_S2 * math.tan(self._bank[number]) / speed if speed else 0.0
        ability = Ability(rate, 0.0, math.inf, math.inf, ACCELERATION_M_S2, -math.inf)
        period_s = self._period_ms / 1000
        pieces = fly_to(now, ability, *order[1:], period_s, period_s)
        return Path(here.time_ms, here.time_ms + self._period_ms, pieces)

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: no check is pending."""

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"tracking": self._record}
