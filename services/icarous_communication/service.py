"""The service IcarousCommunicationService: connections, seats and clock around the step of `step`.

It listens for the ICAROUS instances, or connects to each of them, and assigns each to its vehicle. Its
process waits for them before it sends StartupComplete, and ends with an error when they do not come.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from typing import Any

from cratous.bridge.link import LinkEvent
from cratous.bridge.port import Report, Tally, is_due, often
from cratous.bridge.redial import Redial
from cratous.bridge.text_connection import PROGRAM_LIMITS, REFUSED, Bounds, Opened
from cratous.bridge.text_port import Came, TextPort
from cratous.bridge.text_ports import TextPorts
from cratous.bridge.text_protocol import (
    Heartbeat,
    Hello,
    Message,
    RouteRequest,
    SetMode,
    Skipped,
    WireError,
)
from cratous.bridge.text_protocol.authenticated_lines import FORGED
from cratous.services.bus import Bus, Envelope, Wake
from cratous.services.flight.messages import Down, Lost, Say
from cratous.services.icarous_communication import modes
from cratous.services.icarous_communication.connection_assignment import Refusal, Seats
from cratous.services.icarous_communication.proposals import Proposals
from cratous.services.icarous_communication.routes import GROUP, REQUEST, RouteLine, Routes
from cratous.services.icarous_communication.settings import Settings
from cratous.services.icarous_communication.state import led_back
from cratous.services.icarous_communication.step import (
    Communication,
    Note,
    Out,
    Refuse,
    State,
    Step,
)
from cratous.services.icarous_communication.unheard import WATCH_MS
from cratous.services.pipeline.planner import OWN_PLANNER
from cratous.services.pipeline.status import status
from cratous.spec.errors import CratousError

MISSION, STATE = "afrl.cmasi.MissionCommand", "afrl.cmasi.AirVehicleState"
CONFIGURED = "afrl.cmasi.AirVehicleConfiguration"
KEEP_IN, KEEP_OUT = "afrl.cmasi.KeepInZone", "afrl.cmasi.KeepOutZone"
REMOVE_ZONES = "afrl.cmasi.RemoveZones"
MOST_VEHICLES, MOST_ZONES = 1000, PROGRAM_LIMITS.zones
"""Limits of vehicles and zones; for further ones a refusal is logged: they are not avoided."""
MOST_EARLY = 1000
"""Lines kept of a connection until its vehicle is known."""
PROGRESS_S = 10.0
"""Interval of the report while waiting for instances [s]."""


class NobodyCame(CratousError):
    """ICAROUS instances required by the configuration have not connected in time."""

    exit_code = 3


class IcarousCommunicationService:
    """The UxAS end of the bridge."""

    subscribes: tuple[str, ...] = (
        MISSION,
        STATE,
        CONFIGURED,
        KEEP_IN,
        KEEP_OUT,
        REMOVE_ZONES,
        REQUEST,
        GROUP,
        OWN_PLANNER,
    )

    def __init__(
        self,
        name: str,
        bus: Bus,
        report: Report,
        settings: Settings,
        secret: str,
        routes: Routes | None = None,
        proposals: Proposals | None = None,
    ) -> None:
        """BadInput if it cannot listen. report(severity, sentence): to the log; routes: set if ICAROUS plans
        routes; proposals: set if ICAROUS may request routes from UxAS.
        """
        self.name, self._bus, self._report, self._settings = name, bus, report, settings
        bounds = Bounds(silence_s=None, connections=4 * settings.instances)
        self._doors = settings.doors
        self.port = TextPorts(
            [
                TextPort(
                    door.where,
                    server=True,
                    listens=not settings.to,
                    bounds=bounds,
                    dialect=door.dialect,
                    secret=door.keys or secret,
                    report=report,
                )
                for door in self._doors
            ]
        )
        self._step = Communication(name, settings.deviation_m, settings.dialects, settings.lost)
        self._seats = Seats(settings.instances, settings.ids)
        self._routes, self._proposals = routes, proposals
        self._early: dict[int, list[Message]] = {}
        self._known: set[int] = set()
        self._tally = Tally(name, report)
        self._forgeries: Counter[int] = Counter()
        self._refusals: Counter[str] = Counter()
        self._refused: set[int] = set()
        self._started = False
        self._until_s: float | None = None
        self._say_s, self._said = 0.0, ""
        self._redial = Redial(self.port.ports[0], settings.to)
        if settings.to:
            text = ", ".join(one.text for one in settings.to)
            report("INFO", f"{name}: connects to {text}")
            return
        for door, one in zip(self._doors, self.port.ports, strict=True):
            host, port = one.bound
            who = f", {door.dialect.value} for vehicles {door.ids}" if settings.others else ""
            report("INFO", f"{name}: listens at {host}:{port}{who}")
            if door.where.everywhere:
                report("WARN", f"{name}: listens on all interfaces; whoever is there may connect")

    # of the bus -----------------------------------------------------------------------------------

    def start(self) -> State:
        return State()

    def begin(self, state: State) -> tuple[State, Iterable[Any]]:
        """Start the periodic check for silent instances, and announce who plans routes."""
        said = [] if self._routes is None else [self._routes.begun()]
        return state, [*self._deliver(said), Wake(WATCH_MS)]

    def wake(self, state: State, key: Any, now_ms: int) -> tuple[State, Iterable[Any]]:
        state, out = self._step.watch(state, now_ms)
        return state, [*self._deliver(out), Wake(WATCH_MS)]

    def handle(self, state: State, envelope: Envelope, now_ms: int) -> tuple[State, Iterable[Any]]:
        body, topic = envelope.body, envelope.topic
        if topic == MISSION and envelope.source == self.name:
            return state, ()
        if topic == OWN_PLANNER:
            if self._proposals is None or envelope.source == self.name:
                return state, ()
            seated = self._seats.vehicles
            return state, self._deliver(self._proposals.planner_says(body.Plans, seated))
        if topic == REQUEST:
            asked = [] if self._routes is None else self._routes.asked(envelope)
            return state, [*self._deliver(asked), *self._deliver(self._planned())]
        state, out = self._heard(state, topic, body, now_ms)
        return state, self._deliver(out)

    def _heard(self, state: State, topic: str, body: Any, now_ms: int) -> Step:
        many = _too_many(state, topic, body)
        if many is not None:
            return state, [many]
        if topic == MISSION:
            return self._step.mission(state, body, now_ms)
        if topic == REMOVE_ZONES:
            return self._step.zones_removed(state, list(body.ZoneList))
        if topic == CONFIGURED:
            self._known.add(body.ID)
            return self._step.configured(state, body)
        if topic == STATE:
            self._known.add(body.ID)
            return self._step.flown(state, body, now_ms)
        return self._step.zone(state, body)

    def stop(self, state: State) -> None:
        """Close all connections and log their counts."""
        self.port.close()
        refused = sorted(self._tally.counts.refused.items())
        lines = ", ".join(f"{why}: {n}" for why, n in refused) or "none"
        self._report("INFO", f"{self.name}: closed; {self.port.counts.line()}; refused: {lines}")

    # of the loop ----------------------------------------------------------------------------------

    def pump(self, now_s: float) -> int:
        """Process received input. Returns the number of events."""
        self._redial.step(now_s)
        arrived = self.port.step(now_s)
        for came in arrived:
            self._came(came, now_s)
            self.port.ended(came)
        for key, vid in self._seats.settle(self._known, now_s):
            self._seated(key, vid)
        self._publish([] if self._routes is None else self._routes.look(now_s))
        self._publish(self._planned())
        return len(arrived)

    def _planned(self) -> list[Out]:
        """Send the route requests that ICAROUS can take now."""
        return [] if self._routes is None else self._routes.step(self._seats.vehicles)

    def _publish(self, answers: list[Out]) -> None:
        if answers:
            self._stepped(lambda state: (state, answers))

    def awaits(self, now_s: float) -> bool:
        """Whether instances are still missing before the start. NobodyCame when the wait is over."""
        if self._started or self._seats.come >= self._settings.instances:
            self._started = True
            return False
        if self._until_s is None:
            self._until_s = now_s + self._settings.wait_s
        text = self._seats.missing()
        if is_due(self._until_s, now_s):
            raise NobodyCame(f"{self.name}: {self._settings.wait_s:g} s are over: {text}")
        if text != self._said or is_due(self._say_s, now_s):
            self._report("WARN", f"{self.name}: waiting: {text}")
            self._said, self._say_s = text, now_s + PROGRESS_S
        return True

    def _came(self, came: Came, now_s: float) -> None:
        key = came.key
        if key in self._refused and not isinstance(came.what, LinkEvent):
            return  # sent together with what it was refused for
        match came.what:
            case Opened():
                self._redial.opened(key, now_s)
                only = self._doors[self.port.which(key)].ids if self._settings.others else ()
                self._refuse(key, self._seats.opened(key, now_s, only))
            case LinkEvent() as event:
                said = self._redial.ended(key, event.detail or event.kind, now_s)
                if said:
                    self._report("WARN", f"{self.name}: {said}")
                self._gone(key, event)
            case Hello(vid):
                had = self._seats.vehicle(key)
                refusal = self._seats.hello(key, vid)
                self._refuse(key, refusal)
                if refusal is None and had is None:
                    self._seated(key, vid)
            case Message() as line:
                self._line(key, line)
            case WireError(what=what, tag="SETMOD") if what == FORGED:
                self._forged(key, what)
            case Skipped() as skipped:
                self._tally.refuse("not known", f"{self.port.name(key)}: {skipped.text}")

    def _forged(self, key: int, what: str) -> None:
        """An unauthenticated mode was injected into a vehicle's connection."""
        vid, now_ms = self._seats.vehicle(key), self._bus.now_ms
        if vid is None:
            return
        self._forgeries[vid] += 1
        count = self._forgeries[vid]
        if not often(count):  # limits the growth of the log under attack
            return
        why = what if count == 1 else f"{what} ({count} so far)"

        def step(state: State) -> Step:
            peer = state.link.peer(vid)
            return state, [] if peer is None else [modes.forged(self.name, peer, now_ms, why)]

        self._stepped(step)

    def _line(self, key: int, line: Message) -> None:
        vid, now_ms = self._seats.vehicle(key), self._bus.now_ms
        if vid is not None:
            self._stepped(lambda state: self._heard_line(state, vid, line, now_ms))
            if self._routes is not None and isinstance(line, RouteLine):
                self._publish(self._routes.heard(vid, line))
            return
        self._seats.speaks(key)
        early = self._early.setdefault(key, [])
        if len(early) >= MOST_EARLY:
            self._tally.refuse("line before its vehicle is known", self.port.name(key))
        elif not isinstance(line, Heartbeat):
            early.append(line)

    def _heard_line(self, state: State, vid: int, line: Message, now_ms: int) -> Step:
        """Process a line of a vehicle's instance, including route requests and handbacks on a proposal."""
        if self._proposals is not None and isinstance(line, SetMode):
            places, away = self._proposals.chosen(vid, line), state.craft(vid).away is not None
            if away and line.request is not None and not places:
                why = f"request {line.request} has no answer: it is led back by the direct way"
                self._report("WARN", f"{self.name}: vehicle {vid}: {why}")
            state = led_back(state, vid, places)
        state, out = self._step.heard(state, vid, line, now_ms)
        if self._proposals is not None and isinstance(line, RouteRequest):
            out += self._proposals.asked(state, vid, line, now_ms)
        elif isinstance(line, RouteRequest):
            out.append(Refuse("WPREQ of an ICAROUS", f"vehicle {vid}: no UseUxasRoutePlanner"))
        return state, out

    def _gone(self, key: int, event: LinkEvent) -> None:
        self._early.pop(key, None)
        vid, now_ms = self._seats.gone(key), self._bus.now_ms
        if vid is not None:
            lost = Lost(vid, now_ms, event)
            self._report("WARN", f"{self.name}: vehicle {vid}: {event.kind} {event.detail}")
            self._stepped(lambda state: self._step.lost(state, lost))
            self._publish([] if self._routes is None else self._routes.gone(vid))
        elif event.kind in ("dropped", REFUSED):
            self._tally.refuse("peer that speaks for no vehicle", event.detail)
            if key not in self._refused:
                self._say_refused(event.kind, event.detail)
        self._refused.discard(key)

    def _seated(self, key: int, vid: int) -> None:
        """Assign a connection to a vehicle."""
        now_ms = self._bus.now_ms
        self._report("INFO", f"{self.name}: {self.port.name(key)} is the ICAROUS of vehicle {vid}")
        self._stepped(lambda state: self._step.connected(state, vid, now_ms))
        self._publish([] if self._proposals is None else self._proposals.connected(vid))
        for line in self._early.pop(key, ()):
            self._line(key, line)

    def _refuse(self, key: int, refusal: Refusal | None) -> None:
        if refusal is None:
            return
        name = self.port.name(key)
        self.port.refuse(key, refusal.why, refusal.detail)
        self._seats.gone(key)  # it occupies no seat while the refusal is sent
        self._early.pop(key, None)
        self._refused.add(key)
        self._say_refused(refusal.why, f"{name}: {refusal.detail}")

    def _say_refused(self, why: str, text: str) -> None:
        """Publish a refusal on the bus for the report, at decreasing frequency for repeated ones. why: key by
        which they are counted, never chosen by the peer.
        """
        self._refusals[why] += 1
        count = self._refusals[why]
        if often(count):
            said = f"refused {text} ({count} so far)"
            self._publish([Say(status(0, "Warning", [("reason", said)]), self.name)])

    def _stepped(self, step: Callable[[State], Step]) -> None:
        """Execute a step caused by a connection; the bus keeps the state."""

        def call(state: State) -> tuple[State, list[Any]]:
            after, answers = step(state)
            return after, self._deliver(answers)

        self._bus.call(self.name, call)

    def _deliver(self, answers: Iterable[Out]) -> list[Any]:
        """Send lines and log sentences; returns the bodies for the bus."""
        bodies = []
        for answer in answers:
            match answer:
                case Say(body):
                    bodies.append(body)
                case Down(vid, lines):
                    key = self._seats.key(vid)
                    for line in lines:
                        if key is None or not self.port.send(key, line):
                            self._tally.lose("line that cannot be sent", f"vehicle {vid}: {line}")
                case Refuse(why, detail):
                    self._tally.refuse(why, detail)
                case Note(severity, text):
                    self._report(severity, f"{self.name}: {text}")
        return bodies


def _too_many(state: State, topic: str, body: Any) -> Refuse | None:
    """Why there is no room for a vehicle or zone not known before; None if there is."""
    if topic in (KEEP_IN, KEEP_OUT):
        if len(state.zones) >= MOST_ZONES and body.ZoneID not in state.zones:
            return Refuse("more zones than are kept", f"zone {body.ZoneID} is not avoided")
    elif topic != REMOVE_ZONES and len(state.crafts) >= MOST_VEHICLES:
        number = body.VehicleID if topic == MISSION else body.ID
        if number not in state.crafts:
            return Refuse("more vehicles than are kept", f"vehicle {number} is not avoided")
    return None
