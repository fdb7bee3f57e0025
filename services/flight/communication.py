"""IcarousCommunicationService: the UxAS end of the bridge, for all vehicles.

Down: zones, waypoints and START_MISSION at the start and whenever the way changes; at each
heartbeat WPRCH, POSTN, ATTUD and one OBJCT per other aircraft. Up: SETMOD (with the epoch that
ICAROUS's gate is in), SETVEL, HBEAT. On a takeover the task is suspended and ICAROUS is told the
resume point by RESET_SFT; on an offer the way back is computed, told (RESET_SFT, the remaining
WAYPTs, START_MISSION), and commanded in the new epoch.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass, field
from typing import Any

from cratous.bridge import lmcp
from cratous.bridge.link import LinkEvent
from cratous.bridge.loopback import Bridge
from cratous.bridge.text_protocol import (
    Attitude,
    FenceDone,
    FenceVertex,
    Heartbeat,
    Message,
    OwnPosition,
    SetMode,
    SoftReset,
    StartMission,
    Traffic,
    Waypoint,
    WaypointReached,
)
from cratous.core.following import Track
from cratous.core.timeliness import in_time
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.executive import Executive
from cratous.services.frames import Projection
from cratous.spec.mission import Mission, Position, Zone, ZoneKind

LINK_LOST_MS = 2000
"""A vehicle's ICAROUS counts as silent when nothing came up for this long [ms]."""
FAR_M = 1e6
"""Altitudes beyond this are sent as this [m]: no aircraft is there."""
AHEAD_S = 30
"""Waypoints are told at least this much farther than the look-ahead [s]."""


@dataclass
class Peer:
    """What this end knows of one instance."""

    told_version: int = -1
    track: Track | None = None
    told_index: int = 0
    track_from_m: float = 0.0
    down: int = 0
    heard_ms: int = 0
    alive: bool = True
    epoch: int = 0
    active: bool = False


@dataclass
class Communication:
    """The service; `executive` is the UxAS side that it speaks for."""

    mission: Mission
    zones: tuple[Zone, ...]
    projection: Projection
    bridge: Bridge
    executive: Executive
    peers: dict[int, Peer] = field(default_factory=dict)

    def begin(self, now_ms: int) -> list[Any]:
        """Zones, first waypoints and START_MISSION to every instance."""
        out = []
        for vid in self.bridge.vehicle_ids:
            self.peers[vid] = Peer(heard_ms=now_ms)
            for number, zone in enumerate(self.zones, 1):
                for message in fence(zone, number, self.projection):
                    self.bridge.to_icarous(vid, message)
            self.bridge.to_icarous(vid, SoftReset())
            self._tell_waypoints(vid)
            out.append(self._status(vid, now_ms, "connected"))
        return out

    def know(self, zones: tuple[Zone, ...]) -> None:
        """Zones that have become known since go down to every instance; ways are told anew."""
        fresh = list(enumerate(zones, 1))[len(self.zones) :]
        self.zones = zones
        for vid, peer in self.peers.items():
            for number, zone in fresh:
                for message in fence(zone, number, self.projection):
                    self.bridge.to_icarous(vid, message)
            peer.told_version = -1

    def heartbeat(self, states: dict[int, AirState], now_ms: int) -> list[Any]:
        """WPRCH, POSTN, ATTUD and OBJCT to every instance; what to publish of it."""
        out = []
        places = {vid: self._place(states[vid]) for vid in sorted(states)}
        for vid, peer in self.peers.items():
            chain = self.executive.chains[vid]
            if not chain.suspended:
                if chain.route_version != peer.told_version:
                    self.bridge.to_icarous(vid, SoftReset())
                    self._tell_waypoints(vid)
                self._tell_reached(vid, states[vid])
            if self._send_state(vid, states, places, now_ms):
                peer.down += 1
                out.append(_beat(vid, now_ms, "Down", peer.down))
        return out

    def _place(self, state: AirState) -> tuple[float, float]:
        return self.projection.to_geodetic(state.position.north_m, state.position.east_m)

    def _send_state(
        self,
        vid: int,
        states: dict[int, AirState],
        places: dict[int, tuple[float, float]],
        now_ms: int,
    ) -> bool:
        own, v = states[vid], states[vid].velocity
        lat, lon = places[vid]
        sent = self.bridge.to_icarous(
            vid,
            OwnPosition(
                time_s=now_ms / 1000,
                lat_deg=lat,
                long_deg=lon,
                alt_abs_m=own.position.alt_m,
                alt_rel_m=own.position.alt_m,
                north_mps=v.north_m_s,
                east_mps=v.east_m_s,
                down_mps=v.down_m_s,
                vehicle_id=vid,
            ),
        )
        pitch = math.degrees(math.atan2(own.climb_m_s, own.speed_m_s))
        self.bridge.to_icarous(vid, Attitude(roll_deg=0.0, pitch_deg=pitch, yaw_deg=0.0))
        for other, (olat, olon) in places.items():
            if other != vid:
                w = states[other].velocity
                self.bridge.to_icarous(
                    vid,
                    Traffic(
                        what="TRAFFIC",
                        lat_deg=olat,
                        long_deg=olon,
                        alt_m=states[other].position.alt_m,
                        north_mps=w.north_m_s,
                        east_mps=w.east_m_s,
                        down_mps=w.down_m_s,
                        index=other,
                    ),
                )
        return sent

    def hear(self, vid: int, message: Message, state: AirState, now_ms: int) -> list[Any]:
        """Act on one message from an instance; what to publish."""
        peer = self.peers[vid]
        peer.heard_ms = now_ms
        out: list[Any] = []
        if not peer.alive:
            peer.alive = True
            out.append(self._status(vid, now_ms, "heard again"))
        if isinstance(message, Heartbeat):
            out.append(_beat(vid, now_ms, "Up", message.sequence))
        elif isinstance(message, SetMode):
            peer.epoch = message.epoch if message.epoch is not None else peer.epoch + 1
            out += self._on_mode(vid, peer, message.mode == "ACTIVE", state, now_ms)
        return out

    def lost(self, vid: int, event: LinkEvent, now_ms: int) -> list[Any]:
        """The connection has ended."""
        self.peers[vid].alive = False
        return [self._status(vid, now_ms, f"link lost: {event.kind} {event.detail}".strip())]

    def watch(self, now_ms: int) -> list[Any]:
        """Say so when an instance has fallen silent."""
        out = []
        for vid, peer in self.peers.items():
            if peer.alive and not in_time(peer.heard_ms, now_ms, LINK_LOST_MS):
                peer.alive = False
                out.append(self._status(vid, now_ms, f"silent since {peer.heard_ms} ms"))
        return out

    def _on_mode(
        self, vid: int, peer: Peer, active: bool, state: AirState, now_ms: int
    ) -> list[Any]:
        if active:
            peer.active = True
            out, resume = self.executive.suspend(vid, now_ms)
            if resume is not None:
                self.bridge.to_icarous(vid, self._reset_to(resume))
            return out
        if not peer.active:
            return []
        peer.active = False
        self.executive.resume(vid, state, now_ms)
        self.bridge.to_icarous(vid, SoftReset())
        self._tell_waypoints(vid)
        return [self.executive.command(vid, peer.epoch)]

    def _reset_to(self, p: Position) -> SoftReset:
        lat, lon = self.projection.to_geodetic(p.north_m, p.east_m)
        return SoftReset(lat_deg=lat, long_deg=lon, alt_m=p.alt_m)

    def _tell_waypoints(self, vid: int) -> None:
        """The way ahead: the present track, and what follows for as far as ICAROUS looks."""
        peer, chain = self.peers[vid], self.executive.chains[vid]
        ahead_m = chain.vehicle.max_speed_m_s * (self.mission.daa.lookahead_s + AHEAD_S)
        track = Track(self.executive.waypoints(vid, ahead_m))
        lats, lons = self.projection.to_geodetic_many(
            [p.north_m for p in track.points], [p.east_m for p in track.points]
        )
        for k, (p, lat, lon) in enumerate(zip(track.points, lats, lons, strict=True)):
            self.bridge.to_icarous(
                vid,
                Waypoint(
                    total=k + 1,
                    speed_mps=chain.item.speed_m_s if chain.item else chain.speed_m_s,
                    lat_deg=float(lat),
                    long_deg=float(lon),
                    alt_m=p.alt_m,
                    index=k,
                ),
            )
        self.bridge.to_icarous(vid, StartMission())
        peer.track, peer.told_version, peer.told_index = track, chain.route_version, 0
        peer.track_from_m = chain.s_m

    def _tell_reached(self, vid: int, state: AirState) -> None:
        """WPRCH for every waypoint that has been passed since the last heartbeat."""
        peer, chain = self.peers[vid], self.executive.chains[vid]
        if peer.track is None:
            return
        flown = chain.s_m - peer.track_from_m
        passed = bisect_right(peer.track.s_m, flown + 1e-6)
        while peer.told_index < passed:
            self.bridge.to_icarous(vid, WaypointReached(peer.told_index))
            peer.told_index += 1

    def _status(self, vid: int, now_ms: int, note: str) -> Any:
        alive = self.peers[vid].alive
        return lmcp.new("BridgeStatus", VehicleID=vid, Time=now_ms, Alive=alive, Note=note)


def _beat(vid: int, now_ms: int, direction: str, sequence: int) -> Any:
    return lmcp.new("Heartbeat", VehicleID=vid, Time=now_ms, Direction=direction, Sequence=sequence)


def fence(zone: Zone, number: int, projection: Projection) -> list[Message]:
    """A zone as GEOFN lines and GEOFN_SEND; zones are numbered from 1 on the wire."""
    if zone.padding_m != 0:
        raise ValueError(f"zone {zone.id}: padding must be turned into vertices first")
    kind = "KEEPIN" if zone.kind is ZoneKind.KEEP_IN else "KEEPOUT"
    messages: list[Message] = []
    for k, (north, east) in enumerate(zone.vertices, 1):
        lat, lon = projection.to_geodetic(north, east)
        messages.append(
            FenceVertex(
                fence=kind,
                total=len(zone.vertices),
                vertex=k,
                lat_deg=lat,
                long_deg=lon,
                floor_m=_reachable_m(zone.floor_m),
                ceiling_m=_reachable_m(zone.ceiling_m),
                zone=number,
            )
        )
    messages.append(FenceDone(zone=number))
    return messages


def _reachable_m(alt_m: float) -> float:
    """An altitude as the text protocol can send it: beyond FAR_M nobody flies, so it says the same."""
    return max(-FAR_M, min(FAR_M, alt_m))
