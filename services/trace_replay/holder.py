"""The vehicle that holds a certificate: its gate, surveillance and autopilot are those of `cratous
run`.

It flies straight, and so does each offered trajectory of a trace. A heartbeat of the trace is half
as long as the reserve required after an offer. A track is an aircraft far away, or one within the
volume. The vehicle detects by itself what the trace says of tracks, immediately and for the
certificate in hand.
"""

from __future__ import annotations

from typing import Any

from cratous.core.authority.gate import ICAROUS, UXAS, gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.core.avoidance.prediction import Intruder, Piece
from cratous.core.permit.hand import Offer
from cratous.services.assumptions.observations import ANY_LATER
from cratous.services.flight.commands import gated, velocity_command
from cratous.services.flight.holding import Ground
from cratous.services.flight.messages import (
    Choose,
    Commanded,
    Held,
    Move,
    Surveyed,
    ToVehicle,
    Wished,
)
from cratous.services.flight.vehicle import VehicleNode
from cratous.services.icarous.certificate import Certificate, Track
from cratous.services.icarous.messages import Offers, Wish
from cratous.services.mission.frames import Projection
from cratous.services.trace_replay import replay_flight
from cratous.services.trace_replay.impossible_delivery import NeverSent
from cratous.services.trace_replay.replay_flight import INTRUDER, VEHICLE
from cratous.spec.authority.cycle import OFFER as OFFERS_CONTROL
from cratous.spec.authority.cycle import TAKE_OVER
from cratous.spec.mission import Position
from cratous.spec.system.hand_trace import (
    ANSWER,
    ARRIVES,
    KNOWN,
    LEFT,
    OFFER,
    TIME,
    Event,
    InHand,
)

FAR_M, NEAR_M = 50_000.0, 50.0
"""Lateral distance of a track that is clear of the vehicle, and of one within the volume [m]."""
ROOM_M = 5.0
"""Lateral and vertical allowance of the scene's certificates [m]."""


class Holder:
    """The vehicle, ICAROUS's offers in transit to it, and the traffic."""

    def __init__(self) -> None:
        mission = replay_flight.mission()
        simulation = mission.simulation
        self._ground = Ground(mission.daa, simulation.heartbeat_ms)
        self._unit_ms = self._ground.reserve_ms // 2
        self._step_ms = simulation.step_ms
        projection = Projection(mission.frame)
        (vehicle,) = mission.vehicles
        self._node = VehicleNode(vehicle, projection, self._step_ms / 1000, 0.0, self._ground)
        self._state = self._node.first()
        self._now_ms = 0
        self._offers: dict[int, Certificate] = {}
        self._others: tuple[Intruder, ...] = ()
        self._asked: list[int] = []
        self._flies = 0

    def happen(self, event: Event) -> InHand:
        """Execute an event; returns the resulting certificate in hand. NeverSent if it is impossible."""
        {
            OFFER: self._offer,
            ARRIVES: self._arrives,
            KNOWN: self._known,
            ANSWER: self._answer,
            LEFT: self._left,
            TIME: self._time,
        }[event.kind](event)
        now = self._now_ms // self._unit_ms
        return InHand(now, max(now, self._state.held.hand.expiry_ms // self._unit_ms))

    def _send(self, message: ToVehicle) -> None:
        self._state, _ = self._node.handle(self._state, message)

    @property
    def _by_icarous(self) -> bool:
        gate = self._state.gate
        return gate_accepts(gate, ICAROUS, gate.epoch)

    def _wish(self, act: int) -> None:
        self._send(Wished(self._now_ms, Wish(VEHICLE, act, "", 0)))

    def _command(self, sender: int) -> None:
        """The present commander commands the vehicle."""
        body = velocity_command(VEHICLE, 1, self._state.air.velocity)
        told: Any = gated(VEHICLE, self._state.gate.epoch, sender, body)
        self._send(Commanded(self._now_ms, told))

    def _offer(self, event: Event) -> None:
        """ICAROUS takes the vehicle, unless it has it, and makes an offer based on the certificate in hand."""
        begun = not in_time(self._now_ms // self._unit_ms, event.begins, ANY_LATER)
        if begun or in_time(event.until, event.begins, ANY_LATER):
            raise NeverSent("ICAROUS offers nothing that has begun, or is permitted for no time")
        if not self._by_icarous:
            self._wish(TAKE_OVER)
            self._command(ICAROUS)
        hand, air, unit_ms = self._state.held.hand, self._state.air, self._unit_ms
        begins_ms, until_ms = event.begins * unit_ms, event.until * unit_ms
        wait_s, lasts_s = (begins_ms - self._now_ms) / 1000, (until_ms - begins_ms) / 1000
        here, v = air.position, air.velocity
        begin = Position(here.north_m + wait_s * v.north_m_s, here.east_m + wait_s * v.east_m_s, here.alt_m)  # fmt: skip
        offer = Offer(hand.id + 1, hand.id, begins_ms, hand.knowledge, until_ms)
        tracks = tuple(Track(self._now_ms, one) for one in self._others)
        piece = Piece(0.0, lasts_s, begin, v)
        self._offers[event.trajectory] = Certificate(
            offer, (piece,), None, 0.0, ROOM_M, ROOM_M, 0.0, tracks
        )

    def _arrives(self, event: Event) -> None:
        """The offer reaches the vehicle, which looks around as it does at each heartbeat."""
        one = self._offers.get(event.trajectory)
        if one is None:
            raise NeverSent("such an offer was never made")
        before = self._state.held.certificate
        self._send(Held(self._now_ms, Offers(VEHICLE, one)))
        if self._state.held.certificate is not before:
            self._flies = event.trajectory
            self._command(ICAROUS)
        self._look()

    def _known(self, event: Event) -> None:
        """A track becomes known in the trace; the vehicle sees it at the answer (`_answer`)."""
        self._asked.append(event.trajectory)

    def _answer(self, event: Event) -> None:
        """The vehicle sees the track: far away if it permits the trajectory in hand, otherwise in the volume."""
        if event.trajectory not in self._asked:
            raise NeverSent("nobody has asked whether that trajectory is permitted")
        self._asked.remove(event.trajectory)
        in_hand = self._state.held.certificate is not None and event.trajectory == self._flies
        self._others = (*self._others, self._track(clear=event.permitted and in_hand))
        self._look()

    def _track(self, clear: bool) -> Intruder:
        number, own = INTRUDER + len(self._others), self._state.air
        off_m = FAR_M if clear else NEAR_M
        p = own.position
        return Intruder(number, p._replace(east_m=p.east_m + off_m), own.velocity, False)

    def _left(self, event: Event) -> None:
        """ICAROUS hands the vehicle back, and UxAS flies it on another trajectory."""
        if self._by_icarous:
            self._wish(OFFERS_CONTROL)
        self._command(UXAS)
        self._flies = event.trajectory

    def _time(self, _event: Event) -> None:
        """Fly until the trace's next heartbeat, at which the present commander commands."""
        for begins_ms in range(self._now_ms, self._now_ms + self._unit_ms, self._step_ms):
            self._send(Choose(begins_ms))
            self._send(Move())
            self._now_ms = begins_ms + self._step_ms
            if self._now_ms % self._ground.heartbeat_ms == 0:
                if self._by_icarous:
                    self._command(ICAROUS)
                self._others = tuple(self._flown(one) for one in self._others)
                self._look()

    def _flown(self, other: Intruder) -> Intruder:
        s, p, v = self._ground.heartbeat_ms / 1000, other.position, other.velocity
        north_m, east_m = p.north_m + s * v.north_m_s, p.east_m + s * v.east_m_s
        return other._replace(position=Position(north_m, east_m, p.alt_m))

    def _look(self) -> None:
        self._send(Surveyed(self._now_ms, self._others))
