"""The actors of a flight, with the delivery of messages controlled by a trace.

They are those of `cratous run`, and lines go over its sockets. These messages are held back:
commands to the gate, the vehicle's gate reports, and SETMOD lines (of which a trace may send any,
including forged ones). Everything else is delivered immediately. A heartbeat of the trace is one of
the flight; one that finds the path clear corresponds to as many as the instance's patience
requires, since a trace has no times.
"""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.bridge.loopback import Bridge
from cratous.bridge.text_protocol import Message, SetMode
from cratous.core.authority.gate import ICAROUS, UXAS, Gate
from cratous.services.bus import Bus
from cratous.services.flight.commands import SENDERS
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.executive import Executive
from cratous.services.flight.link_end import ToLinkEnd
from cratous.services.flight.loop import Flight
from cratous.services.flight.messages import (
    Begin,
    Commanded,
    Connected,
    GateIs,
    Move,
    SetOut,
    Tick,
)
from cratous.services.flight.vehicle import UNTOUCHED
from cratous.services.icarous_program.epochs import EpochFile
from cratous.services.pipeline.plan import make_plan
from cratous.services.trace_replay import replay_flight
from cratous.services.trace_replay.impossible_delivery import NeverSent
from cratous.services.trace_replay.replay_flight import INTRUDER, VEHICLE
from cratous.spec.authority.cycle import AVOID
from cratous.spec.system.trace import (
    COMMAND,
    HEARTBEAT,
    MODE,
    NOTHING,
    REPORT,
    RESTART,
    TRACK,
    Event,
    Standing,
)

MOST_BEATS = 60
"""Upper bound of the instance's patience, in heartbeats."""


class Held(NamedTuple):
    """A command held back: sender, epoch, and number of gate epochs before it."""

    sender: int
    epoch: int
    changes: int
    body: Any


class _HoldingBridge(Bridge):
    """A flight's bridge that delivers no SETMOD of the instance by itself."""

    def to_uxas(self, vehicle_id: int, message: Message) -> bool:
        return isinstance(message, SetMode) or super().to_uxas(vehicle_id, message)

    def forge(self, line: SetMode) -> None:
        """Send a SETMOD to UxAS's end."""
        super().to_uxas(VEHICLE, line)


class Actors(Flight):
    """The flight of the scene; its bridge is closed at the end (`with Actors() as actors`)."""

    bridge: _HoldingBridge

    def __init__(self) -> None:
        mission = replay_flight.mission()
        bus = Bus(lmcp.full_names)
        self.sent: list[Held] = []
        self.reports = {UNTOUCHED}
        self.begun: set[int] = set()  # epochs after the first
        self.last_of_uxas, self.dropped, self.is_met = NOTHING, False, False
        plan, bridge = make_plan(mission), _HoldingBridge((VEHICLE,))
        super().__init__(mission, plan, bus, bridge, (VEHICLE,))
        bus.now_ms = 0
        self._executive(Begin(0, self._own()))
        self._link(Connected(0, self.instances))
        self._executive(SetOut())
        for one in self.sent:  # nothing has happened yet: the vehicle flies its path
            self._vehicle(VEHICLE, Commanded(0, one.body))

    def __enter__(self) -> Actors:
        return self

    def __exit__(self, *_: object) -> None:
        self.bridge.close()

    # what is held back -------------------------------------------------------------------------

    def _publish(self, body: Any, source: str) -> None:
        self.bus.publish(body, source)
        if isinstance(body, self.gated):
            sender = ICAROUS if body.Sender.name == SENDERS[ICAROUS] else UXAS
            self.sent.append(Held(sender, body.Epoch, len(self.begun), body))
            if sender == UXAS:
                self.last_of_uxas = body.Epoch
        elif type(body).__name__ == "CommandDropped":
            self.dropped = True

    def _link(self, message: ToLinkEnd) -> None:
        if isinstance(message, GateIs):
            self.reports.add(message.gate)
            self.begun.add(message.gate.epoch)
        else:
            super()._link(message)

    def _everyone(self) -> tuple[tuple[int, AirState], ...]:
        own = super()._everyone()
        return (*own, (INTRUDER, replay_flight.met(dict(own)[VEHICLE]))) if self.is_met else own

    # what a trace lets happen ------------------------------------------------------------------

    def heartbeat(self, event: Event) -> None:
        """A heartbeat of ICAROUS; event.flag: no intruder is in conflict."""
        self.is_met = not event.flag
        before = self.icarous_states[VEHICLE].cycle.mode, self.gate
        for _ in range(MOST_BEATS if event.flag and before[0] == AVOID else 1):
            self._beat()
            if (self.icarous_states[VEHICLE].cycle.mode, self.gate) != before:
                return

    def _beat(self) -> None:
        """Fly until the next heartbeat, before anything else of that instant."""
        while True:
            self.bus.now_ms = self.now_ms
            self._step()
            self.bus.run()
            self._to_all(Move())
            self.now_ms += self.mission.simulation.step_ms
            if self.now_ms % self.mission.simulation.heartbeat_ms == 0:
                return

    def report(self, event: Event) -> None:
        """A report of the gate reaches UxAS."""
        gate = Gate(event.who, event.epoch, event.flag)
        if gate not in self.reports:
            raise NeverSent("such a report of the gate was never made")
        super()._link(GateIs(VEHICLE, gate))

    def mode(self, event: Event) -> None:
        """A SETMOD line reaches UxAS over the socket."""
        self.bridge.forge(SetMode("ACTIVE" if event.flag else "PASSIVE", event.epoch))
        self._exchange()

    def track(self, _event: Event) -> None:
        """A wind change becomes known: UxAS replans and has new tracks to fly."""
        executive = self.executive.config
        known, change = replay_flight.with_breeze(executive.mission, self.now_ms)
        self.executive = Executive(replace(executive, mission=known))
        self.executive_state = replace(self.executive_state, to_come=(change,))
        self._executive(Tick(self.now_ms, self._own()))

    def command(self, event: Event) -> None:
        """A command that was sent reaches the gate."""
        wanted = event.who, event.epoch, event.changes
        body = next((one.body for one in self.sent if one[:3] == wanted), None)
        if body is None:
            raise NeverSent("such a command was never sent")
        self._vehicle(VEHICLE, Commanded(self.now_ms, body))

    def restart(self, _event: Event) -> None:
        """Restart the gate's process, with what `cratous icarous --epochs` has stored."""
        with tempfile.TemporaryDirectory() as folder:
            file = EpochFile(Path(folder) / "epoch", VEHICLE)
            file.keep(self.gate)
            gate = file.resumed()
        state = self.vehicle_states[VEHICLE]
        self.vehicle_states[VEHICLE] = replace(state, gate=gate)
        if gate != state.gate:
            self._link(GateIs(VEHICLE, gate))

    # resulting state --------------------------------------------------------------------------

    @property
    def gate(self) -> Gate:
        """The vehicle's gate."""
        return self.vehicle_states[VEHICLE].gate

    def happen(self, event: Event) -> Standing:
        """Execute an event; returns the resulting state. NeverSent if it is impossible."""
        self.last_of_uxas, self.dropped = NOTHING, False
        {
            HEARTBEAT: self.heartbeat,
            REPORT: self.report,
            MODE: self.mode,
            TRACK: self.track,
            COMMAND: self.command,
            RESTART: self.restart,
        }[event.kind](event)
        self.bus.run()
        peer = self.link_state.peer(VEHICLE)
        assert peer is not None
        return Standing(
            *self.gate,
            self.icarous_states[VEHICLE].cycle.mode,
            peer.end.active,
            peer.end.epoch,
            self.executive_state.chain(VEHICLE).suspended,
            event.kind == COMMAND and not self.dropped,
            self.last_of_uxas if event.kind in (MODE, TRACK) else NOTHING,
        )
