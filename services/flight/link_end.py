"""The UxAS end of the bridge, for all vehicles: `handle(state, message) -> (state, messages)`.

Down: zones, waypoints and START_MISSION at the start and whenever the route changes; at each heartbeat WPRCH,
POSTN, ATTUD and one OBJCT per other aircraft. Up: SETMOD (with the epoch of ICAROUS's gate, at each heartbeat
while ICAROUS flies), SETVEL, HBEAT. A SETMOD is accepted only if it agrees with the vehicle's own report of
its gate; one of an epoch that was never issued is refused and reported. On a takeover the executive suspends
the vehicle, and RESET_SFT tells ICAROUS the resume point; on an offer the executive takes the vehicle back in
the new epoch. The other instances are told how each vehicle flies: its route under UxAS (OTHER), its velocity
under ICAROUS (OVELO). The kernels of `core.authority.link_end` decide which mode is accepted and which
instance counts as alive.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

from cratous.bridge.text_protocol import (
    Attitude,
    ForgetFences,
    HardReset,
    Heartbeat,
    LinesMissing,
    Message,
    NotKnown,
    RouteRequest,
    SetMode,
    SetVelocity,
    StartMission,
    StopMission,
    UxasPlans,
    Waypoint,
    WaypointReached,
)
from cratous.core.authority.link_end import link_mode, link_sign
from cratous.core.routing.polylines import Track
from cratous.services.flight import link_lines
from cratous.services.flight.link_lines import MOST_AGAIN
from cratous.services.flight.link_peers import (
    Peer,
    State,
    down_to,
    links,
    of_others,
    to_others,
)
from cratous.services.flight.messages import (
    Beat,
    Connected,
    Flown,
    FromLinkEnd,
    GateIs,
    Heard,
    Left,
    Lost,
    Proposed,
    Route,
    RouteAsked,
    Say,
    Seen,
    Stop,
    Suspend,
    TakeBack,
    ToLinkEnd,
    Unreadable,
    Watch,
    ZonesKnown,
)
from cratous.services.flight.notices import bridge_status, heartbeat, mode_refused
from cratous.services.mission.frames import Projection
from cratous.services.pipeline.status import status
from cratous.spec.authority.link_end import (
    ENDED,
    HEARD,
    NOTHING,
    OVERTAKEN,
    PASSED,
    REFUSED,
    SAY_HEARD,
    SAY_LOST,
    SAY_SILENT,
    SUSPEND,
    TAKE_BACK,
)
from cratous.spec.mission import Velocity, Zone
from cratous.spec.mission.changes import is_next
from cratous.spec.records import replace

LINK_LOST_MS = 2000
"""An instance counts as silent when nothing has come up from it for this long [ms]."""
NAME = "uxas/ics"
"""Sender of what this end publishes."""


Step = tuple[State, tuple[FromLinkEnd, ...]]


@dataclass(frozen=True)
class UxasEnd:
    """The service and its fixed configuration. live: ICAROUS may request routes back; alone: a vehicle acts
    autonomously without the link, so its chain is suspended meanwhile.
    """

    projection: Projection
    live: bool = False
    alone: bool = False

    def handle(self, state: State, message: ToLinkEnd) -> Step:
        """One step: the state that results, and the messages to send, in order."""
        after, out = self._handled(state, message)
        if not self.alone:
            return after, out
        now_ms = getattr(message, "now_ms", 0)
        return after, (*out, *links(state, after, now_ms))

    def _handled(self, state: State, message: ToLinkEnd) -> Step:
        match message:
            case Heard(_, now_ms, LinesMissing() as line) if state.peer(message.vehicle_id):
                return self._again(state, message.vehicle_id, line, now_ms)
            case Heard(vid, now_ms, RouteRequest() as line) if self.live and state.peer(vid):
                return self._asked(state, vid, line, now_ms)
            case Connected(now_ms, vehicle_ids):
                return self._connected(state, vehicle_ids, now_ms)
            case ZonesKnown(zones):
                return self._zones(state, zones)
            case Beat():
                return self._beat(state, message)
            case Watch(now_ms, of):
                return self._watch(state, now_ms, of)
        peer = state.peer(message.vehicle_id)
        if peer is None:
            return state, ()
        return self._stepped(state, peer, self._of_one(peer, message))

    def _stepped(self, state: State, peer: Peer, step: OfOne) -> Step:
        """The state after a step of one peer. A change of how it flies is sent to the others first."""
        after, out = step
        state = state.with_peer(after)
        if (after.flies, after.steered) != (peer.flies, peer.steered):
            out = (*to_others(state, after, self.projection), *out)
        return state, out

    def _watch(self, state: State, now_ms: int, of: frozenset[int] | None) -> Step:
        """Report the instances that have become silent."""
        out: list[FromLinkEnd] = []
        for peer in (one for one in state.peers if of is None or one.vehicle_id in of):
            note = f"silent since {peer.heard_ms} ms"
            state, said = self._stepped(state, peer, _sign(peer, PASSED, now_ms, note))
            out += said
        return state, tuple(out)

    def _asked(self, state: State, vehicle_id: int, line: RouteRequest, now_ms: int) -> Step:
        """A WPREQ: passed to the executive, which routes the vehicle. Without a request number it cannot be
        answered.
        """
        known = state.peer(vehicle_id)
        assert known is not None
        peer, out = _sign(replace(known, heard_ms=now_ms), HEARD, now_ms, "heard again")
        if line.request is not None:
            start, end = link_lines.asked_way(line, self.projection)
            out = (*out, RouteAsked(vehicle_id, start, end, line.request))
        return state.with_peer(peer), out

    def _again(self, state: State, vehicle_id: int, line: LinesMissing, now_ms: int) -> Step:
        """Send again the lines that an instance reports missing, at most MOST_AGAIN times per plan or zone."""
        known = state.peer(vehicle_id)
        assert known is not None
        peer, out = _sign(replace(known, heard_ms=now_ms), HEARD, now_ms, "heard again")
        told = self._again_lines(state, peer, line)
        what = f"plan of {line.total}" if line.what == "WAYPT" else f"zone {line.number}"
        key = (line.what, line.number if line.what == "GEOFN" else 0)
        text = f"lines {line.first} to {line.last} of {what}"
        times = dict(peer.again).get(key, 0)
        if not told:
            note = f"{text} are asked for again, and there are none"
        elif times in range(MOST_AGAIN):
            out, note = (*out, *down_to(peer, told)), f"{text} are sent again"
            peer = replace(peer, again=tuple({**dict(peer.again), key: times + 1}.items()))
        else:
            note = f"{text} are missing after they were sent again {times} times: not in force"
            error = status(0, "Error", [("reason", f"vehicle {vehicle_id}: {note}")])
            out = (*out, Say(error, NAME))
        return state.with_peer(peer), (*out, _status(peer, peer.end.alive, now_ms, note))

    def _again_lines(self, state: State, peer: Peer, line: LinesMissing) -> list[Message]:
        """The missing lines, with those that close them; the whole plan where ICAROUS knows another number of
        lines.
        """
        if line.what == "GEOFN":
            if line.number not in range(1, len(state.zones) + 1):
                return []
            zone = state.zones[line.number - 1]
            *corners, done = link_lines.fence(zone, line.number, self.projection)
            return [*link_lines.between(corners, line, "vertex"), done]
        points: list[Message] = [m for m in peer.way if isinstance(m, Waypoint)]
        if len(points) != line.total:
            return link_lines.onward(peer.way, peer.reached)
        reached = [WaypointReached(k) for k in range(peer.reached)]
        return [*link_lines.between(points, line, "index"), StartMission(), *reached]

    def _of_one(self, peer: Peer, message: ToOne) -> tuple[Peer, tuple[FromLinkEnd, ...]]:
        """Handle a message about one vehicle, which affects that peer only."""
        match message:
            case Route():
                return self._route(peer, message)
            case Flown(_, s_m):
                return _flown(peer, s_m)
            case Seen():
                return self._seen(peer, message)
            case Left(_, position):
                return peer, down_to(peer, [link_lines.reset_to(position, self.projection)])
            case Stop():
                return peer, down_to(peer, [StopMission()])
            case Heard(_, now_ms, line):
                return _heard(peer, line, now_ms)
            case Proposed(_, number, way, speed):
                return peer, down_to(peer, link_lines.proposal(way, speed, number, self.projection))
            case GateIs(_, gate):
                return replace(peer, gate=gate), ()
            case Unreadable(_, now_ms, text):
                return peer, (_status(peer, peer.open, now_ms, text),)
            case Lost(_, now_ms, event):
                note = f"link lost: {event.kind} {event.detail}".strip()
                return _sign(replace(peer, open=False), ENDED, now_ms, note)

    def _connected(self, state: State, vehicle_ids: tuple[int, ...], now_ms: int) -> Step:
        """On a new connection, send everything: zones, route, progress along it, and how the others fly."""
        out: list[FromLinkEnd] = []
        for vid in vehicle_ids:
            old = state.peer(vid)
            peer = Peer(vid, now_ms)
            if old is not None:
                end = old.end._replace(alive=True)
                peer = replace(old, heard_ms=now_ms, end=end, open=True, again=(), outdated=False)
                state = state.with_peer(peer)
            else:
                state = replace(state, peers=(*state.peers, peer))
            told: list[Message] = [UxasPlans()] if self.live else []
            if old is not None and old.outdated:
                told.append(ForgetFences())
            told += [*self._fences(state.zones), *link_lines.onward(peer.way, peer.reached)]
            out += down_to(peer, told + of_others(state, vid, self.projection))
            out.append(_status(peer, True, now_ms, "connected again" if old else "connected"))
        return state, tuple(out)

    def _zones(self, state: State, zones: tuple[Zone, ...]) -> Step:
        known = len(state.zones)
        # a region of a moving zone replaces the one before it under its number
        same = (a == b or is_next(a, b) for a, b in zip(state.zones, zones, strict=False))
        more = known <= len(zones) and all(same)
        fences = self._fences(zones, state.zones if more else ())
        out: list[FromLinkEnd] = []
        for peer in state.peers:
            others = of_others(state, peer.vehicle_id, self.projection)
            anew = [HardReset(), *fences, *link_lines.onward(peer.way, peer.reached), *others]
            if not zones:  # the route is kept
                anew = [ForgetFences()]
            out += down_to(peer, fences if more else anew)
            # also with an open connection: a break may not have been noticed yet
            outdated = peer.outdated or not more
            state = state.with_peer(replace(peer, again=(), outdated=outdated))
        return replace(state, zones=zones), tuple(out)

    def _fences(self, zones: tuple[Zone, ...], known: tuple[Zone, ...] = ()) -> list[Message]:
        """The zones that differ from those known at their number, as lines."""
        return [
            line
            for number, zone in enumerate(zones, 1)
            if zone not in known[number - 1 : number]
            for line in link_lines.fence(zone, number, self.projection)
        ]

    def _route(self, peer: Peer, route: Route) -> tuple[Peer, tuple[FromLinkEnd, ...]]:
        track = Track(route.points)
        told = link_lines.way(track.points, route.speed_m_s, self.projection)
        after = replace(peer, marks_m=track.s_m, from_m=route.from_m, reached=0, again=())
        after = replace(after, way=tuple(told), flies=track.points, steered=None)
        return after, down_to(peer, told)

    def _seen(self, peer: Peer, seen: Seen) -> OfOne:
        """Send POSTN, ATTUD and OBJCT to one instance."""
        places = link_lines.places_of(seen.aircraft, self.projection)
        attitude = Attitude(math.degrees(seen.roll_rad), math.degrees(seen.pitch_rad), 0.0)
        told = link_lines.states(peer.vehicle_id, seen.aircraft, places, seen.time_ms, attitude)
        after = replace(peer, down=peer.down + peer.open)
        beat = (_heartbeat(after, seen.now_ms, "Down", after.down),) if peer.open else ()
        return after, (*down_to(peer, told), *beat)

    def _beat(self, state: State, beat: Beat) -> Step:
        """Send POSTN, ATTUD and OBJCT to every instance, and publish the heartbeats."""
        places, aircraft = link_lines.places_of(beat.aircraft, self.projection), beat.aircraft
        lines = link_lines.traffic(aircraft, places)
        peers, out = list[Peer](), list[FromLinkEnd]()
        for peer in state.peers:
            told = link_lines.states(peer.vehicle_id, aircraft, places, beat.now_ms, lines=lines)
            count = peer.down + peer.open
            peers.append(replace(peer, down=count))
            out += down_to(peer, told)
            if peer.open:
                out.append(_heartbeat(peer, beat.now_ms, "Down", count))
        return replace(state, peers=tuple(peers)), tuple(out)


ToOne = Route | Flown | Seen | Left | Stop | Heard | Unreadable | Lost | GateIs | Proposed
OfOne = tuple[Peer, tuple[FromLinkEnd, ...]]


def _flown(peer: Peer, s_m: float) -> OfOne:
    """Send WPRCH for every waypoint passed since the last report."""
    passed = bisect_right(peer.marks_m, s_m - peer.from_m + 1e-6)
    reached = [WaypointReached(k) for k in range(peer.reached, passed)]
    return replace(peer, reached=max(peer.reached, passed)), down_to(peer, reached)


def _heard(peer: Peer, line: Message, now_ms: int) -> OfOne:
    """Act on one line from an instance."""
    if isinstance(line, SetMode):
        return _mode(peer, line, now_ms)
    peer, out = _alive(peer, now_ms)
    if isinstance(line, Heartbeat):
        return peer, (*out, _heartbeat(peer, now_ms, "Up", line.sequence))
    if isinstance(line, SetVelocity) and peer.end.active:
        flies = Velocity(line.north_mps, line.east_mps, line.down_mps)
        return replace(peer, steered=flies), out
    if isinstance(line, NotKnown):
        note = f"ICAROUS does not know the command {line.kind}"
        return peer, (*out, _status(peer, peer.end.alive, now_ms, note))
    return peer, out


def _mode(peer: Peer, line: SetMode, now_ms: int) -> OfOne:
    """A SETMOD line; one without an epoch, as the original sends it, counts as of the present one.

    A contradictory line is no sign of life, nor is one that repeats that UxAS commands: any sender could have
    produced it.
    """
    epoch = line.epoch if line.epoch is not None else peer.gate.epoch
    linked = link_mode(peer.end, peer.gate, line.mode == "ACTIVE", epoch)
    vid = peer.vehicle_id
    if linked.act == REFUSED:
        return peer, (Say(mode_refused(vid, now_ms, line, epoch, peer.gate), NAME),)
    if (linked.act, linked.end) == (NOTHING, peer.end) and not peer.end.active:
        return peer, ()
    peer, out = _alive(peer, now_ms)
    after = replace(peer, end=linked.end._replace(alive=peer.end.alive))
    if linked.act == SUSPEND:
        after = replace(after, flies=())
        return after, (*out, Suspend(vid, now_ms, linked.act))
    if linked.act == TAKE_BACK:
        after = replace(after, steered=None)
        return after, (*out, TakeBack(vid, now_ms, linked.act, epoch))
    if linked.act == OVERTAKEN:
        note = f"a mode of epoch {epoch} is overtaken by one of epoch {peer.gate.epoch}"
        return after, (*out, _status(after, after.end.alive, now_ms, note))
    return after, out


def _alive(peer: Peer, now_ms: int) -> OfOne:
    """A line of the instance has arrived."""
    return _sign(replace(peer, heard_ms=now_ms), HEARD, now_ms, "heard again")


def _sign(peer: Peer, event: int, now_ms: int, note: str) -> OfOne:
    """Update the peer's link state after an event, and report a change of it with the note."""
    linked = link_sign(peer.end, event, peer.heard_ms, now_ms, LINK_LOST_MS)
    after = replace(peer, end=linked.end)
    if after.end.active and not after.end.alive:
        after = replace(after, steered=None)  # its SETVEL may be out of date
    if linked.act in (SAY_HEARD, SAY_LOST, SAY_SILENT):
        return after, (_status(after, after.end.alive, now_ms, note),)
    return after, ()


def _status(peer: Peer, alive: bool, now_ms: int, note: str) -> Say:
    return Say(bridge_status(peer.vehicle_id, alive, now_ms, note), NAME)


def _heartbeat(peer: Peer, now_ms: int, direction: str, sequence: int) -> Say:
    return Say(heartbeat(peer.vehicle_id, now_ms, direction, sequence), NAME)
