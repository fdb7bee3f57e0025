"""Per-instance state of the UxAS end of the bridge, and the messages that follow from its changes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cratous.bridge.text_protocol import Message
from cratous.core.authority.gate import ICAROUS, UXAS, Gate, gate_accepts
from cratous.core.authority.link_end import LinkEnd
from cratous.services.flight import link_lines
from cratous.services.flight.messages import Down, HeardAgain, NotHeard
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Position, Velocity, Zone
from cratous.spec.records import replace

START = LinkEnd(False, 0, True)
"""Initial link state: UxAS commands and the instance counts as alive."""
UNTOUCHED = Gate(UXAS, 0, False)
"""Assumed gate of a vehicle that has not reported any yet."""


@dataclass(frozen=True)
class Peer:
    """What this end knows of one instance.

    end: who commands and whether it is heard, as the kernels have it; open: the connection is up; marks_m:
    arc length of each waypoint told, measured from from_m of the vehicle's track; reached: number of
    waypoints reported as reached; down: heartbeats sent; heard_ms: when it was last heard; gate: as last
    reported by the vehicle; way: lines of the last route; again: how often lines of the plan or of a zone
    were sent again, as ((tag, zone), times); flies: its route under UxAS, steered: its velocity under
    ICAROUS, as told to the other instances; outdated: a zone was removed since it last connected.
    """

    vehicle_id: int
    heard_ms: int
    end: LinkEnd = START
    open: bool = True
    marks_m: tuple[float, ...] = ()
    from_m: float = 0.0
    reached: int = 0
    down: int = 0
    gate: Gate = UNTOUCHED
    way: tuple[Message, ...] = ()
    again: tuple[tuple[tuple[str, int], int], ...] = ()
    flies: tuple[Position, ...] = ()
    steered: Velocity | None = None
    outdated: bool = False


@dataclass(frozen=True)
class State:
    """State of the UxAS end: the zones in force, and its peers."""

    zones: tuple[Zone, ...] = ()
    peers: tuple[Peer, ...] = ()

    def peer(self, vehicle_id: int) -> Peer | None:
        """The state of a vehicle's instance; None if it has none."""
        return next((p for p in self.peers if p.vehicle_id == vehicle_id), None)

    def with_peer(self, peer: Peer) -> State:
        """The state with this peer in place of the previous one of its vehicle."""
        peers = (peer if p.vehicle_id == peer.vehicle_id else p for p in self.peers)
        return replace(self, peers=tuple(peers))


def links(before: State, after: State, now_ms: int) -> Iterator[NotHeard | HeardAgain]:
    """The vehicles whose instance was lost, and those whose instance is heard again, at now_ms [ms]."""
    for peer in after.peers:
        old = before.peer(peer.vehicle_id)
        was, alive = old is None or old.end.alive, peer.end.alive
        if was and not alive:
            yield NotHeard(peer.vehicle_id, now_ms)
        elif alive and not was:
            theirs = gate_accepts(peer.gate, ICAROUS, peer.gate.epoch)
            yield HeardAgain(peer.vehicle_id, now_ms, not theirs)


def to_others(state: State, peer: Peer, projection: Projection) -> tuple[Down, ...]:
    """How a vehicle flies, as messages to the instances of the others."""
    told = link_lines.way_of_another(peer.vehicle_id, peer.steered or peer.flies, projection)
    others = (p for p in state.peers if p.vehicle_id != peer.vehicle_id)
    return tuple(down for p in others for down in down_to(p, told))


def of_others(state: State, vehicle_id: int, projection: Projection) -> list[Message]:
    """How the other vehicles fly, as lines for the instance of one vehicle."""
    known = {p.vehicle_id: p.steered or p.flies for p in state.peers if p.vehicle_id != vehicle_id}
    told = (link_lines.way_of_another(vid, how, projection) for vid, how in known.items() if how)
    return [line for lines in told for line in lines]


def down_to(peer: Peer, told: Sequence[Message]) -> tuple[Down, ...]:
    """Lines for an instance; none if there are none or its connection is closed."""
    return (Down(peer.vehicle_id, tuple(told)),) if told and peer.open else ()
