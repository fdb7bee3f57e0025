"""ICAROUS behind the bridge: `handle(state, line) -> (state, answers)`, on lines of the text protocol only.

The instance is that of `cratous run`, but all input comes over the wire: own state from POSTN, traffic from OBJCT,
the mission from WAYPT, GEOFN, WPRCH and COMND. Each POSTN at least a heartbeat later than the last is one heartbeat
of the instance. The vehicle's gate stands here: an offer is taken when UxAS sends the way on (START_MISSION after a
complete plan, or a RESET_SFT with a position). A WPREQ is answered at once (`routes`). For a peer of another dialect
than ours an offer counts as taken at once."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from cratous.bridge.text_protocol import (
    Attitude,
    Dialect,
    EpochTold,
    FenceDone,
    FenceVertex,
    Message,
    OwnPosition,
    RouteRequest,
    SetMode,
    SoftReset,
    StartMission,
    Traffic,
)
from cratous.core.authority import gate as gates
from cratous.core.authority.cycle import gate_wished
from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.manoeuvre import PIECE_S
from cratous.services.flight.dynamics import Limits
from cratous.services.flight.link_lines import MOST_TOLD
from cratous.services.icarous import state as icarous
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Foresees, Line, Sensed, Up, Wish
from cratous.services.icarous.route_requests import Asking
from cratous.services.icarous_program.goal_reports import onward, steering
from cratous.services.icarous_program.recovery import (
    ASK_AGAIN_MS,
    Part,
    Parts,
    asked,
    of_plan,
    of_zone,
    take,
)
from cratous.services.icarous_program.routes import Planner
from cratous.services.icarous_program.traffic import (
    MOST_TRAFFIC,
    SeenBy,
    another_time,
    by_themselves,
    changes,
    flying,
    intruders,
    kept,
    seen_at,
    told_by_itself,
)
from cratous.spec.authority.cycle import OFFER, TAKE_OVER, WITHDRAW

SPEEDS = (0.5, 2.0)
"""A POSTN with a speed below this factor of the airframe's lowest, or above this factor of its highest, is rejected."""
UNTOUCHED = gates.Gate(gates.UXAS, 0, False)
"""UxAS commands, and always has."""
OWNERS = {"UXAS": gates.UXAS, "ICAROUS": gates.ICAROUS}
ACTS = {OFFER: "offers control back", WITHDRAW: "withdraws its offer", TAKE_OVER: "takes over"}


class Tell(NamedTuple):
    """To UxAS: send a line."""

    line: Message


class Note(NamedTuple):
    """To the log. severity: logging level."""

    severity: str
    text: str


class Refuse(NamedTuple):
    """To the log: a line was ignored. why: reason, by which they are counted; detail: of this line."""

    why: str
    detail: str


Answer = Tell | Note | Refuse


@dataclass(frozen=True)
class Craft:
    """Fixed configuration. limits: of the airframe; floor_m: lowest altitude of a manoeuvre [m MSL]; cooperating:
    other vehicles with such an instance; dialect: of the UxAS end; step_s: longest time for which the autopilot
    holds one heading in a turn [s]."""

    config: icarous.Config
    limits: Limits
    floor_m: float
    cooperating: frozenset[int] = frozenset()
    dialect: Dialect = Dialect.CRATOUS
    step_s: float = PIECE_S


@dataclass(frozen=True)
class State:
    """instance: its state; gate: of its vehicle; seen: traffic by id; now_ms: time of the last POSTN, None before the
    first on this connection; beat_ms: time of the last heartbeat; lost: incomplete plan and zones; direct: other
    vehicles' own reports, selves: those for which these are used; sensed: at the last heartbeat."""

    instance: icarous.State = field(default_factory=icarous.State)
    gate: gates.Gate = UNTOUCHED
    seen: SeenBy = field(default_factory=dict)
    now_ms: int | None = None
    beat_ms: int = 0
    lost: Parts = field(default_factory=dict)
    direct: SeenBy = field(default_factory=dict)
    selves: frozenset[int] = frozenset()
    sensed: Sensed | None = None


Step = tuple[State, tuple[Answer, ...]]


def resumed(gate: gates.Gate) -> gates.Gate:
    """The gate of a restarted instance after the stored one: ICAROUS no longer steers, so its authority is offered
    back in a new epoch."""
    return gates.gate_offer(gate)


def mode_of(gate: gates.Gate) -> SetMode:
    """The mode that UxAS is told about a gate on a new connection."""
    active = not gates.gate_accepts(gate, gates.UXAS, gate.epoch)
    return SetMode("ACTIVE" if active else "PASSIVE", gate.epoch)


class IcarousEnd:
    """The step of one vehicle."""

    def __init__(self, craft: Craft) -> None:
        self.craft, self._instance = craft, Instance(craft.config)
        self._planner = Planner(craft.config.projection, craft.limits, craft.config.daa)

    def connected(self, state: State) -> Step:
        """A connection has opened: traffic and pending requests are reset, and UxAS is told who commands.

        Waypoints and zones stay until UxAS sends them again, as it does on each connection; epochs continue. Routes
        of other vehicles are dropped: UxAS sends only those it knows."""
        former = state.instance
        asking = Asking(number=former.asking.number)  # UxAS announces again whether it plans live
        instance = replace(former, told=former.told.alone(), asking=asking)
        state = replace(state, seen={}, now_ms=None, lost={}, instance=instance, sensed=None)
        return state, (Tell(mode_of(state.gate)),)

    def handle(self, state: State, line: Message) -> Step:
        """Process one line from UxAS."""
        match line:
            case OwnPosition():
                return self._position(state, line)
            case Traffic():
                return self._traffic(state, line)
            case Attitude():
                return state, ()
            case RouteRequest():
                return state, self._route(state, line)
            case EpochTold():
                return self._synchronised(state, line)
        if not self.craft.dialect.ours:
            return self._told(state, line)
        taken = take(state.lost, line)
        state, answers = replace(state, lost=taken.lost), list[Answer]()
        for one in taken.told:
            state, more = self._told(state, one)
            answers += more
        if taken.ask is not None:
            state, more = self._ask(state, taken.lost[taken.ask])
            answers += more
        return state, tuple(answers)

    def _synchronised(self, state: State, line: EpochTold) -> Step:
        """UxAS knows a later epoch, since this instance was restarted: continue from there, and offer ICAROUS's
        authority back."""
        if gates.epoch_given(state.gate, line.epoch):
            return state, ()
        if not gates.epoch_given(MOST_TOLD, line.epoch):
            return state, (Refuse("epoch after which there is no room for others", str(line)),)
        state = replace(state, gate=resumed(gates.Gate(OWNERS[line.owner], line.epoch, False)))
        text = (
            f"epoch {line.epoch} was given before this start: going on in epoch {state.gate.epoch}"
        )
        return state, (Note("WARN", text), Tell(mode_of(state.gate)))

    def _route(self, state: State, line: RouteRequest) -> tuple[Answer, ...]:
        """The answer to a WPREQ: a route around the zones in force, or one without points."""
        lines, why = self._planner.answer(line, state.instance.told.zones, state.sensed)
        text = why or f"a way of {len(lines) - 2} points"
        note = Note("WARN" if why else "INFO", f"UxAS asks for a route ({line.planner}): {text}")
        return note, *map(Tell, lines)

    def _ask(self, state: State, part: Part) -> Step:
        """Ask for the missing lines of a plan or zone, or report that the limit is reached."""
        after = asked(part, state.now_ms or 0)
        if after is None:
            lost = {key: one for key, one in state.lost.items() if key != part.key}
            text = f"{part}; asked {part.asked} times: it is not in force"
            return replace(state, lost=lost), (Note("ERROR", text),)
        part, line = after
        state = replace(state, lost={**state.lost, part.key: part})
        return state, (Note("WARN", f"{part}; asked again, {part.asked}"), Tell(line))

    def _lacking(self, state: State, *parts: Part) -> Step:
        """A plan or zones are incomplete: ask for the rest, if the peer knows AGAIN."""
        answers: list[Answer] = []
        for part in parts if self.craft.dialect.ours else ():
            state, more = self._ask(state, part)
            answers += more
        return state, tuple(answers)

    def _told(self, state: State, line: Message) -> Step:
        """Process one line about mission or zones."""
        before = state.instance.told
        heard = Line(0 if state.now_ms is None else state.now_ms, line)
        instance, _ = self._instance.handle(state.instance, heard)
        state = replace(state, instance=instance)
        answers: list[Answer] = []
        takes = isinstance(line, SoftReset) and line.lat_deg is not None
        if isinstance(line, StartMission):
            if before.gathering and instance.told.waypoints is before.waypoints:
                told = f"{len(before.gathering)} of {before.gathering[-1].total} waypoints"
                answers.append(Refuse("plan with waypoints missing", told))
                state, more = self._lacking(state, of_plan(before.gathering))
                answers += more
            else:
                takes = True  # a rejected plan does not take control: there is no route to fly
                count = len(instance.told.waypoints)
                answers.append(Note("INFO", f"plan of {count} waypoints in force"))
        if isinstance(line, FenceDone):
            if instance.told.zones is before.zones:
                first = before.vertices[:1]
                total = first[0].total if first else 0
                zones = sorted({v.zone for v in before.vertices})
                told = f"{len(before.vertices)} of {total} vertices, of zones {zones}"
                told += f"; GEOFN_SEND of zone {line.zone}"
                answers.append(Refuse("zone that is not whole: it is not in force", told))
                ids = {v.zone for v in before.vertices} | ({line.zone} if line.zone else set())
                parts = [of_zone(number, before.vertices) for number in sorted(ids)]
                state, more = self._lacking(state, *parts)
                answers += more
            else:
                answers.append(Note("INFO", f"{len(instance.told.zones)} zones in force"))
        if isinstance(line, FenceVertex):
            others = {v.zone for v in before.vertices} - {line.zone}
            if others and not instance.told.vertices[1:]:  # a zone whose GEOFN_SEND was lost
                parts = [of_zone(number, before.vertices) for number in sorted(others)]
                state, more = self._lacking(state, *parts)
                answers += more
        if takes:
            state, more = self._taken(state)
            answers += more
        return state, tuple(answers)

    def _taken(self, state: State) -> Step:
        """UxAS takes command again, if the gate permits it."""
        after = gates.gate_after(state.gate, gates.UXAS, state.gate.epoch)
        if after == state.gate:
            return state, ()
        return replace(state, gate=after), (Note("INFO", f"epoch {after.epoch}: UxAS commands"),)

    def _traffic(self, state: State, line: Traffic) -> Step:
        own = line.index == self.craft.config.vehicle_id
        if own or (line.index not in state.seen and len(state.seen) >= MOST_TRAFFIC):
            why = "OBJCT of the vehicle itself" if own else "more traffic than is kept"
            return state, (Refuse(why, f"index {line.index}"),)
        if state.now_ms is None:
            return state, ()  # its time is unknown; the next one follows within a heartbeat
        one = seen_at(line, state.now_ms, self.craft.config.projection)
        seen = {**state.seen, line.index: one}
        return replace(state, seen=seen), ()

    def _position(self, state: State, line: OwnPosition) -> Step:
        """Process the own state, and run a heartbeat if one is due."""
        refused = self._wrong(state, line)
        if refused is not None:
            return state, (refused,)
        # time at which the instance receives what follows
        told = replace(state.instance.told, heard_ms=round(1000 * line.time_s))
        return self._due(replace(state, instance=replace(state.instance, told=told)), line)

    def alone(self, state: State, line: OwnPosition, reached: int) -> Step:
        """Process the own state from the autopilot while UxAS is not heard, and run a heartbeat if one is due.
        reached: number of further waypoints passed."""
        refused = self._wrong(state, line)
        if refused is not None:
            return state, (refused,)
        told = state.instance.told
        ahead = min(told.next_index + reached, len(told.waypoints))
        told = replace(told, next_index=max(ahead, told.next_index))
        return self._due(replace(state, instance=replace(state.instance, told=told)), line)

    def peer(self, state: State, vehicle_id: int, line: OwnPosition) -> Step:
        """Process another vehicle's own state, received over the direct link."""
        if line.vehicle_id != vehicle_id or vehicle_id == self.craft.config.vehicle_id:
            return state, (Refuse("direct state of another vehicle than the sender", str(line)),)
        if state.now_ms is None:
            return state, ()
        one, before = told_by_itself(line, self.craft.config.projection), state.direct
        if another_time(one, state.now_ms):
            detail = f"vehicle {vehicle_id}: {one.at_ms} ms at {state.now_ms} ms"
            return state, (Refuse("direct state of another time", detail),)
        if vehicle_id in before and not lasted(before[vehicle_id].at_ms, one.at_ms, 0):
            return state, ()  # overtaken by a newer one
        return replace(state, direct={**before, vehicle_id: one}), ()

    def _due(self, state: State, line: OwnPosition) -> Step:
        now_ms, first = round(1000 * line.time_s), state.now_ms is None
        state = replace(state, now_ms=now_ms)
        if not first and not lasted(state.beat_ms, now_ms, self.craft.config.heartbeat_ms):
            return state, ()
        return self._beat(replace(state, beat_ms=now_ms), line, now_ms)

    def _wrong(self, state: State, line: OwnPosition) -> Refuse | None:
        """Why a POSTN cannot be a state of this vehicle now; None if it can."""
        vid, limits = self.craft.config.vehicle_id, self.craft.limits
        if line.vehicle_id not in (0, vid):
            return Refuse("POSTN of another vehicle", f"expected {vid}, got {line.vehicle_id}")
        now_ms = round(1000 * line.time_s)
        if state.now_ms is not None and not lasted(state.now_ms, now_ms, 0):
            return Refuse("POSTN of an earlier time", f"{now_ms} ms after {state.now_ms} ms")
        speed = math.hypot(line.north_mps, line.east_mps)
        low_m_s, high_m_s = SPEEDS[0] * limits.min_speed_m_s, SPEEDS[1] * limits.max_speed_m_s
        if not low_m_s <= speed <= high_m_s:
            detail = f"expected {low_m_s:g} to {high_m_s:g} m/s, got {speed:.3g}"
            return Refuse("POSTN that this airframe cannot fly", detail)
        return None

    def _beat(self, state: State, line: OwnPosition, now_ms: int) -> Step:
        """Run one heartbeat of the instance, and apply its request to the gate."""
        seen, direct = kept(state.seen, now_ms), kept(state.direct, now_ms)
        selves = by_themselves(seen, direct, now_ms)
        gone = (state.seen.keys() | state.selves) - seen.keys() - direct.keys()
        answers: list[Answer] = [
            Note(*one) for one in changes(gone, state.selves, selves, seen.keys())
        ]
        state = replace(state, seen=seen, direct=direct, selves=selves)
        craft = self.craft
        motion, ability = flying(
            line, craft.config.projection, craft.limits, craft.floor_m, craft.step_s
        )
        others = intruders(seen, direct, now_ms, ability, craft.cooperating)
        sensed = Sensed(now_ms, motion, ability, others, state.gate)
        instance, said = self._instance.handle(state.instance, sensed)
        state = replace(state, instance=instance, sensed=sensed)
        for one in said:
            match one:
                case Wish():
                    state = replace(state, gate=gate_wished(state.gate, one.act))
                    epoch, does = state.gate.epoch, ACTS.get(one.act, f"act {one.act}")
                    because = f" (vehicle {one.intruder_id})" if one.intruder_id else ""
                    answers.append(
                        Note("WARN", f"epoch {epoch}: ICAROUS {does}: {one.reason}{because}")
                    )
                case Foresees():
                    answers.append(Note("INFO", f"{now_ms} ms: {one.resolution}"))
                case Up(_, told):
                    if isinstance(told, SetMode) and told.request is None:
                        answers += map(Tell, onward(said, instance, sensed, craft.dialect))
                    answers.append(Tell(steering(told, instance, sensed, craft.config.projection)))
        state, more = self._overdue(state, now_ms)
        answers += more
        if not self.craft.dialect.ours and state.gate.offered:
            state, more = self._taken(state)
            answers += more
        return state, tuple(answers)

    def _overdue(self, state: State, now_ms: int) -> Step:
        """At a heartbeat, ask for everything incomplete: UxAS finishes each plan and zone before it sends POSTN."""
        told, answers = state.instance.told, list[Answer]()
        late = [p for p in state.lost.values() if lasted(p.at_ms, now_ms, ASK_AGAIN_MS)]
        for part in late:
            state, more = self._ask(state, part)
            answers += more
        if not self.craft.dialect.ours:
            return state, tuple(answers)
        open_parts = [of_zone(n, told.vertices) for n in sorted({v.zone for v in told.vertices})]
        if told.gathering:
            open_parts.append(of_plan(told.gathering))
        told = replace(told, gathering=(), vertices=())
        state = replace(state, instance=replace(state.instance, told=told))
        state, more = self._lacking(state, *open_parts)
        return state, (*answers, *more)
