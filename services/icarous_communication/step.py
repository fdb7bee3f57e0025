"""The UxAS end of the bridge in `cratous uxas`: `handle(state, message) -> (state, messages)`.

It wraps the end that `cratous run` flies (`flight.link_end`). UxAS's messages are translated for that end:
MissionCommands into routes, states into own positions and traffic, zones into fences. The gate of each vehicle stands
here, since ICAROUS steers through UxAS: a SETMOD moves it, ICAROUS's steering is passed on while it owns the vehicle,
and its offer is taken at once."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from cratous.bridge.text_protocol import GoToWaypoint, Heartbeat, Hello, Message, SetMode
from cratous.core.authority.gate import ICAROUS, UXAS, gate_accepts, gate_after
from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.manoeuvre import Motion
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.link_end import UxasEnd
from cratous.services.flight.messages import (
    Connected,
    Down,
    Flown,
    GateIs,
    Heard,
    Left,
    Lost,
    Route,
    Say,
    Seen,
    Suspend,
    TakeBack,
    ToLinkEnd,
    Watch,
    ZonesKnown,
)
from cratous.services.icarous_communication import modes, returning, unheard
from cratous.services.icarous_communication.holding import (
    Sender,
    about_tasks,
    by_uxas,
    commanded,
    held,
    hold,
    icarous_has,
    missions_at_gate,
    taken_over,
)
from cratous.services.icarous_communication.listeners import Dialects
from cratous.services.icarous_communication.plans import (
    Away,
    Plan,
    begins_as,
    begun_with,
    being_done,
    deviates,
    going_on,
    leading_back,
    next_part,
    part,
    plan_of,
    resume_point,
    resumed,
    shown,
)
from cratous.services.icarous_communication.state import (
    COMMANDS_FROM,
    SETTLES_MS,
    SPARE_WAYPOINTS,
    Craft,
    Note,
    Out,
    Refuse,
    State,
    air_state,
    at_the_time_of,
    ended,
    free,
    goes_on,
    known_zones,
    left_out,
    over_meanwhile,
    placed,
    plane,
    turn_radius_of,
)
from cratous.services.icarous_communication.steering import (
    action_of,
    at_gate,
    flies,
    in_flight,
    taken_back,
    told,
)
from cratous.services.icarous_communication.unheard import IN_HAND, LostLink
from cratous.services.uxas.daidalus.zones import frame_at
from cratous.spec.authority.link_loss import REJOIN
from cratous.spec.errors import BadInput

Step = tuple[State, list[Out]]


@dataclass(frozen=True)
class Communication:
    """The step and its fixed configuration. allowed_m: deviation from its leg at which a vehicle's tasks pause [m];
    dialects: of the peers; other dialects than ours have no heartbeat; procedure: what is flown without ICAROUS."""

    name: str
    allowed_m: float
    dialects: Dialects
    procedure: LostLink = IN_HAND

    @property
    def sender(self) -> Sender:
        """Sender of commands."""
        return Sender(self.name, self.dialects)

    # what comes over the wire ---------------------------------------------------------------------

    def connected(self, state: State, vehicle_id: int, now_ms: int) -> Step:
        """An instance is assigned to a vehicle: it is sent everything; its next SETMOD states who commands, in which
        epoch."""
        known = state.link.peer(vehicle_id) is not None
        state, out = self._end(state, Connected(now_ms, (vehicle_id,)))
        peer = state.link.peer(vehicle_id)
        assert peer is not None
        link = state.link.with_peer(modes.anew(peer))
        state = replace(state, link=link, fresh=state.fresh | {vehicle_id})
        if not known:
            state, more = self._route(state, vehicle_id)
            out += more
            if not self.dialects.ours(vehicle_id):  # which states no epoch
                out += in_flight(self.name, vehicle_id, peer.gate, state.craft(vehicle_id).plan)
        else:
            out += over_meanwhile(state, vehicle_id, self.dialects.of(vehicle_id))
        if (body := state.craft(vehicle_id).body) is None:
            return state, out
        state, more = self._seen(state, vehicle_id, body, now_ms)
        return state, [*out, *more]

    def lost(self, state: State, message: Lost) -> Step:
        """An instance's connection has closed."""
        state, out = self._end(state, message)
        return held(self.sender, state, message.vehicle_id, out)

    def heard(self, state: State, vehicle_id: int, line: Message, now_ms: int) -> Step:
        """Process a line from an instance; what was flown without it ends."""
        state, out = self._line(state, vehicle_id, line, now_ms)
        return self._alone(state, vehicle_id, now_ms, out)

    def _line(self, state: State, vehicle_id: int, line: Message, now_ms: int) -> Step:
        if isinstance(line, SetMode):
            return self._mode(state, vehicle_id, line, now_ms)
        flown = flies(line, state.craft(vehicle_id).air, state.plane)
        state, out = self._end(state, Heard(vehicle_id, now_ms, flown))
        state = free(state, vehicle_id)
        if isinstance(line, Heartbeat):
            state = state.put(vehicle_id, replace(state.craft(vehicle_id), handed=False))
        if self.dialects.original(vehicle_id) and isinstance(line, GoToWaypoint):
            return state, [*out, Refuse("GOTOWP of the original: its number is noise", str(line))]
        craft, peer = state.craft(vehicle_id), state.link.peer(vehicle_id)
        if craft.air is None or peer is None or state.frame is None:
            return state, out
        try:
            action = action_of(line, craft.air, craft.plan, plane(state.frame))
        except BadInput as error:
            return state, [*out, Refuse(error.what, f"vehicle {vehicle_id}: {error}")]
        if action is None:
            return state, out
        if craft.away is None or not gate_accepts(peer.gate, ICAROUS, peer.gate.epoch):
            if craft.handed:
                return state, out
            detail = f"vehicle {vehicle_id}: {type(line).__name__} in epoch {peer.gate.epoch}"
            return state, [*out, Refuse("steering by one without authority", detail)]
        state, command = commanded(
            self.sender, goes_on(state, vehicle_id, line), vehicle_id, action
        )
        come = at_gate(self.name, vehicle_id, peer.gate, ICAROUS, command.body)
        return state, [*out, come, command]

    def watch(self, state: State, now_ms: int) -> Step:
        """Detect the instances that have become silent at now_ms [ms]."""
        peers = [one.vehicle_id for one in state.link.peers]
        state, out = self._end(state, Watch(now_ms, frozenset(filter(self.dialects.ours, peers))))
        for vid in peers:
            state, out = held(self.sender, state, vid, out)
            state, out = self._alone(state, vid, now_ms, out)
        return state, out

    def _mode(self, state: State, vehicle_id: int, line: SetMode, now_ms: int) -> Step:
        """Process a SETMOD: it moves the gate if it is the gate's next transition; the kernels of the link end decide
        whether it is accepted, and what follows."""
        if (peer := state.link.peer(vehicle_id)) is None:
            return state, []
        fresh = vehicle_id in state.fresh
        over = modes.forgotten(peer, line, fresh)
        if over is not None:
            state, out = self._end(state, Heard(vehicle_id, now_ms, Hello(vehicle_id)))
            return state, [*out, *modes.told(vehicle_id, line, over)]
        said = modes.read(peer, line, fresh)
        state = replace(state, fresh=state.fresh - {vehicle_id} if said.believed else state.fresh)
        state, out = self._end(state, GateIs(vehicle_id, said.gate))
        if modes.begins(peer, said, fresh and self.dialects.ours(vehicle_id)):
            out += in_flight(self.name, vehicle_id, said.gate, state.craft(vehicle_id).plan)
        state, more = self._end(state, Heard(vehicle_id, now_ms, said.line))
        return free(state, vehicle_id), [*out, *more]

    # what comes over the bus ----------------------------------------------------------------------

    def configured(self, state: State, body: Any) -> Step:
        """Process an AirVehicleConfiguration."""
        return state.put(body.ID, replace(state.craft(body.ID), configuration=body)), []

    def mission(self, state: State, command: Any, now_ms: int) -> Step:
        """Process another sender's MissionCommand; one for a vehicle that is off its plan waits until it is back on it."""
        vid, craft = int(command.VehicleID), state.craft(command.VehicleID)
        if not command.WaypointList:
            return ended(state, vid, self.dialects.of(vid))
        if returning.is_part(command, craft):
            return state, by_uxas(self.sender, state, vid, command)
        if craft.away is not None:
            why = returning.WAITS[icarous_has(state, vid)]
            come = by_uxas(self.sender, state, vid, command)
            note = Note("WARN", f"vehicle {vid}: a mission has come {why}")
            return state.put(vid, replace(craft, waiting=command)), [note, *come]
        state, out = self._in_force(state, vid, command, now_ms)
        return state, [*by_uxas(self.sender, state, vid, command), *out]

    def _in_force(self, state: State, vid: int, command: Any, now_ms: int) -> Step:
        """Put a MissionCommand into force."""
        state, out = self._framed(state, command.WaypointList[0])
        assert state.frame is not None
        craft = state.craft(vid)
        here = craft.air.position if craft.air else None
        begun = being_done(craft.plan, craft.listed)
        plan = begun_with(plan_of(command, plane(state.frame), now_ms, here), begun)
        if begins_as(plan, craft.plan):  # a waypoint manager repeats what was sent already
            return state, out
        state, more = self._route(state.put(vid, replace(craft, plan=plan)), vid)
        return state, [*out, *more]

    def zone(self, state: State, body: Any) -> Step:
        """Process a KeepInZone or KeepOutZone."""
        return self._fenced(replace(state, zones={**state.zones, body.ZoneID: body}))

    def zones_removed(self, state: State, ids: list[int]) -> Step:
        """Process RemoveZones."""
        left = {number: zone for number, zone in state.zones.items() if number not in ids}
        return self._fenced(replace(state, zones=left))

    def flown(self, state: State, body: Any, now_ms: int) -> Step:
        """Process an AirVehicleState."""
        vid = int(body.ID)
        state, out = self._framed(state, body.Location)
        assert state.frame is not None
        air = air_state(body, plane(state.frame))
        craft = state.craft(vid)
        craft = replace(craft, body=body, air=air, handed=False, first=craft.first or air.position)
        if craft.plan is not None and craft.away is None:
            settled = lasted(craft.plan.since_ms, now_ms, SETTLES_MS)
            craft = replace(craft, plan=shown(craft.plan, body.CurrentWaypoint, settled))
        state = state.put(vid, craft)
        if state.link.peer(vid) is None:
            return state, out
        if craft.away is not None:
            state, more = self._deviation(state, vid, craft.away, craft, air)
            out += more
        elif craft.plan is not None:
            state, more = self._reached(state, vid, craft.plan)
            out += more
        state, more = self._seen(state, vid, body, now_ms)
        return state, [*out, *more]

    def _reached(self, state: State, vid: int, plan: Plan) -> Step:
        """Report the waypoints passed, and send the next part to a peer that holds only a part."""
        out: list[Out] = []
        if (most := self.dialects.of(vid).part_waypoints) is not None:
            onward = next_part(plan, most, SPARE_WAYPOINTS)
            if onward is not plan:
                state = state.put(vid, replace(state.craft(vid), plan=onward))
                state, out = self._route(state, vid)
        reached = plan.marks[plan.goal]
        if not reached:
            return state, out
        state, more = self._end(state, Flown(vid, plan.track.s_m[reached - 1]))
        return state, [*out, *more]

    def _seen(self, state: State, vid: int, body: Any, now_ms: int) -> Step:
        """Send an instance all aircraft at its vehicle's time; those that are too old are reported once."""
        aircraft, stale = at_the_time_of(body, state.crafts)
        angles = math.radians(body.Roll), math.radians(body.Pitch)
        seen = Seen(vid, now_ms, int(body.Time), aircraft, *angles)
        notes = left_out(stale - state.stale)
        state, out = self._end(replace(state, stale=stale), seen)
        return state, [*notes, *out]

    def _deviation(self, state: State, vid: int, away: Away, craft: Craft, air: AirState) -> Step:
        """Pause a vehicle's tasks when it is farther from its leg than allowed, once per takeover. The original's
        client is not sent the resume point: a RESET_SFT makes its ICAROUS forget what it avoids."""
        plan = craft.plan
        if away.paused or not away.tasks or plan is None:
            return state, []
        if not deviates(plan, air.position, self.allowed_m):
            return state, []
        state = state.put(vid, replace(craft, away=away._replace(paused=True)))
        point = None if self.dialects.original(vid) else resume_point(plan, away.left)
        state, out = self._end(state, Left(vid, point)) if point else (state, [])
        paused = about_tasks(self.sender, "TaskPause", away.tasks)
        text = f"vehicle {vid} is more than {self.allowed_m:g} m from its leg; tasks pause"
        return state, [*out, *paused, Note("INFO", f"{text}: {list(away.tasks)}")]

    # what the end answers ------------------------------------------------------------------------

    def _end(self, state: State, message: ToLinkEnd) -> Step:
        """Pass a message to the end, and carry out its answers."""
        link, answers = UxasEnd(state.plane).handle(state.link, message)
        state, out = replace(state, link=link), list[Out]()
        for answer in answers:
            match answer:
                case Suspend(vid, now_ms, _):
                    state, more = taken_over(self.sender, state, vid, now_ms)
                    out += more
                case TakeBack(vid, now_ms, _, epoch):
                    state, more = self._take_back(state, vid, epoch, now_ms)
                    out += more
                case Down(vid, lines):
                    out.append(Down(vid, placed(state, vid, lines, self.dialects.of(vid))))
                case Say():
                    out.append(answer)
        return state, out

    def _take_back(self, state: State, vid: int, epoch: int, now_ms: int) -> Step:
        """UxAS takes back: tasks and mission resume, ICAROUS is sent the route; without a mission it holds."""
        away, peer = state.craft(vid).away, state.link.peer(vid)
        assert peer is not None
        gate = gate_after(peer.gate, UXAS, epoch)
        state, out = self._end(state, GateIs(vid, gate))
        state, onward = self._onward(state, vid, now_ms)
        out.append(Note("WARN", f"vehicle {vid}: ICAROUS hands back, in epoch {epoch}"))
        out += taken_back(self.name, vid, now_ms, peer.gate, onward)
        out += told(self.name, vid, now_ms, gate)
        if away is not None and away.paused:
            out += about_tasks(self.sender, "TaskResume", away.tasks)
        return state, [*out, *onward]

    def _onward(self, state: State, vid: int, now_ms: int) -> Step:
        """What a vehicle is sent after a handback."""
        craft = state.craft(vid)
        away, plan, air = craft.away, craft.plan, craft.air
        state = state.put(
            vid, replace(craft, away=None, holds=False, handed=True, waiting=None, returns=None)
        )
        if craft.waiting is not None:
            state = state.put(vid, replace(state.craft(vid), plan=None))
            state, out = self._in_force(state, vid, craft.waiting, now_ms)
            return state, [Say(craft.waiting, self.name), *out]
        if plan is None or away is None or air is None or state.frame is None:
            return hold(self.sender, state, vid, [], "handed back without a mission")
        now = Motion(air.position, air.heading_rad, air.speed_m_s, air.climb_m_s)
        plan, radius_m = going_on(plan, away), turn_radius_of(craft, air)
        sent = resumed(plan, away, now, radius_m, state.plane, COMMANDS_FROM + state.commands + 1)
        flown = plan_of(sent.command, state.plane, now_ms, air.position)
        way = leading_back(plan, away, sent, flown)
        after = replace(craft, away=None, holds=False, handed=True, plan=way, returns=None)
        state = replace(state.put(vid, after), commands=state.commands + 1)
        state, out = self._route(state, vid)
        return state, [Say(sent.command, self.name), *out]

    def _route(self, state: State, vid: int) -> Step:
        plan = state.craft(vid).plan
        if plan is None or state.link.peer(vid) is None:
            return state, []
        points = part(plan, self.dialects.of(vid).part_waypoints)
        return self._end(state, Route(vid, points, plan.speed_m_s, plan.track.s_m[plan.told]))

    def _alone(self, state: State, vid: int, now_ms: int, out: list[Out]) -> Step:
        """Carry out what a vehicle flies while its ICAROUS is not heard."""
        who = self.name, self.procedure
        state, beat = unheard.heartbeat(*who, state, vid, now_ms, self.dialects.ours(vid))
        craft, out = state.craft(vid), [*out, *beat.said]
        if beat.step.act != REJOIN or craft.away is None or icarous_has(state, vid):
            state, more = unheard.flown(self.sender, state, vid, beat)
            return state, [*out, *more]
        state, onward = self._onward(state, vid, now_ms)
        out += missions_at_gate(self.sender, state, vid, onward)
        return state, [*out, *about_tasks(self.sender, "TaskResume", craft.away.tasks), *onward]

    def _framed(self, state: State, place: Any) -> Step:
        """The first position received defines the plane; zones received before are then converted."""
        if state.frame is not None:
            return state, []
        return self._fenced(replace(state, frame=frame_at(place)))

    def _fenced(self, state: State) -> Step:
        """Send all zones to all instances."""
        if state.frame is None:
            return state, []
        state, zones, notes = known_zones(state, state.frame, self.dialects)
        state, out = self._end(state, ZonesKnown(zones))
        return state, [*out, *notes]
