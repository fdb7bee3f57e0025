"""What an ICAROUS instance has been told over the bridge: zones, waypoints, and progress along them."""

from __future__ import annotations

from dataclasses import dataclass

from cratous.bridge.text_protocol import (
    FenceDone,
    FenceVertex,
    ForgetFences,
    ForgetWaypoints,
    HardReset,
    Message,
    SoftReset,
    StartMission,
    StopMission,
    VelocityOfAnother,
    WayOfAnother,
    Waypoint,
    WaypointReached,
)
from cratous.core.authority.timeliness import lasted
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Position, Velocity, Zone, ZoneKind
from cratous.spec.records import replace

MOST_OTHERS = 1000
"""Most other vehicles whose routes or velocities are kept; the oldest are dropped."""


@dataclass(frozen=True)
class Told:
    """The mission as received so far.

    waypoints: the plan in force; next_index: the waypoint to fly to; resume: where the path is to be resumed,
    while ICAROUS has control; gathering, vertices: incomplete plan and zone. heard_ms: when UxAS was last
    heard; others: routes of other vehicles under UxAS, of_others: incomplete lines of one; steered:
    velocities of other vehicles under ICAROUS.
    """

    zones: tuple[Zone, ...] = ()
    waypoints: tuple[Position, ...] = ()
    speed_m_s: float = 0.0
    next_index: int = 0
    resume: Position | None = None
    gathering: tuple[Waypoint, ...] = ()
    vertices: tuple[FenceVertex, ...] = ()
    heard_ms: int = 0
    started: bool = False
    others: tuple[tuple[int, tuple[Position, ...]], ...] = ()
    of_others: tuple[WayOfAnother, ...] = ()
    steered: tuple[tuple[int, Velocity], ...] = ()

    def alone(self) -> Told:
        """The inbox without messages about other vehicles."""
        return replace(self, others=(), of_others=(), steered=())

    @property
    def stopped(self) -> bool:
        """Whether UxAS has said that the mission of this plan is over."""
        return bool(self.waypoints) and not self.started

    def way_of(self, vehicle_id: int) -> tuple[Position, ...]:
        """Another vehicle's route under UxAS; () if unknown."""
        return dict(self.others).get(vehicle_id, ())


def hear(
    told: Told, message: Message, projection: Projection, now_ms: int, original: bool = False
) -> Told:
    """The inbox after one more line, received at now_ms [ms]. original: from a UxAS of the original's."""
    after = _hear(told, message, projection, original)
    if after is told and not lasted(told.heard_ms, now_ms, 1):
        return told  # the usual case: lines about other aircraft within one heartbeat
    return replace(after, heard_ms=now_ms)


def _hear(told: Told, message: Message, projection: Projection, original: bool) -> Told:
    if isinstance(message, WaypointReached):
        return replace(told, next_index=max(told.next_index, message.index + 1))
    if isinstance(message, Waypoint):
        gathering = () if message.index == 0 else told.gathering
        return replace(told, gathering=(*gathering, message))
    if isinstance(message, StartMission):
        return _start(told, projection, original)
    if isinstance(message, SoftReset):
        if message.lat_deg is None or message.long_deg is None or message.alt_m is None:
            return replace(told, resume=None)
        north, east = projection.to_local(message.lat_deg, message.long_deg)
        return replace(told, resume=Position(north, east, message.alt_m))
    if isinstance(message, HardReset):
        return Told()
    if isinstance(message, ForgetFences):
        return replace(told, zones=(), vertices=())
    if isinstance(message, ForgetWaypoints):
        return replace(told, waypoints=(), next_index=0, gathering=(), resume=None)
    if isinstance(message, StopMission):
        return replace(told, started=False)
    if isinstance(message, FenceVertex):
        kept = told.vertices if message.vertex > 1 else ()
        return replace(told, vertices=(*kept, message))
    if isinstance(message, FenceDone):
        return _close_fence(told, message, projection)
    if isinstance(message, WayOfAnother):
        steered = tuple(one for one in told.steered if one[0] != message.vehicle_id)
        if len(steered) != len(told.steered):
            told = replace(told, steered=steered)
        return _of_another(told, message, projection)
    if isinstance(message, VelocityOfAnother):
        vid = message.vehicle_id
        steered = tuple(one for one in told.steered if one[0] != vid)
        to = Velocity(message.north_mps, message.east_mps, message.down_mps)
        others = tuple(one for one in told.others if one[0] != vid)
        return replace(told, others=others, steered=(*steered, (vid, to))[-MOST_OTHERS:])
    return told


def beaten(told: Told) -> Told:
    """The inbox at a heartbeat. UxAS sends each route completely between two heartbeats, so an incomplete one
    is dropped.
    """
    return replace(told, of_others=()) if told.of_others else told


def _of_another(told: Told, line: WayOfAnother, projection: Projection) -> Told:
    """Another vehicle's route is known once all of its lines have arrived in order; until then it is unknown."""
    before = () if line.index == 0 else told.of_others
    lines = (*before, line)
    others = tuple(one for one in told.others if one[0] != line.vehicle_id)
    first = lines[0]
    alike = (first.vehicle_id, first.total) == (line.vehicle_id, line.total)
    if not alike or line.index != len(before):
        return replace(told, others=others, of_others=())
    if len(lines) != line.total:
        return replace(told, others=others, of_others=lines if line.total else ())
    norths, easts = projection.to_local_many(
        [one.lat_deg for one in lines], [one.long_deg for one in lines]
    )
    points = tuple(
        Position(float(n), float(e), one.alt_m)
        for n, e, one in zip(norths, easts, lines, strict=True)
    )
    others = (*others, (line.vehicle_id, points))[-MOST_OTHERS:]
    return replace(told, others=others, of_others=())


def _start(told: Told, projection: Projection, original: bool) -> Told:
    """Put the received plan into force; a plan with missing waypoints is dropped.

    The original's `total` is a running count: only its last line carries the final number.
    """
    if not told.gathering:
        return replace(told, started=True)
    count = len(told.gathering)
    numbers = [waypoint.index for waypoint in told.gathering]
    totals = {waypoint.total for waypoint in told.gathering[-1 if original else 0 :]}
    if numbers != list(range(count)) or totals != {count}:
        return replace(told, gathering=())
    norths, easts = projection.to_local_many(
        [w.lat_deg for w in told.gathering], [w.long_deg for w in told.gathering]
    )
    points = tuple(
        Position(float(n), float(e), w.alt_m)
        for n, e, w in zip(norths, easts, told.gathering, strict=True)
    )
    return replace(
        told,
        waypoints=points,
        speed_m_s=told.gathering[0].speed_mps,
        next_index=0,
        gathering=(),
        resume=None,
        started=True,
    )


def _close_fence(told: Told, done: FenceDone, projection: Projection) -> Told:
    """Put a zone into force if all of its lines have arrived; otherwise drop them.

    Complete means: vertices 1 to `total` in order, with the same zone, kind, total, floor and ceiling, and
    the zone that GEOFN_SEND names; a GEOFN_SEND without a zone closes the one received.
    """
    vertices = told.vertices
    if not vertices:
        return told
    first = vertices[0]
    alike = {(v.zone, v.fence, v.total, v.floor_m, v.ceiling_m) for v in vertices}
    counted = [v.vertex for v in vertices] == list(range(1, len(vertices) + 1))
    named = done.zone in (None, first.zone)
    if len(alike) != 1 or len(vertices) != first.total or not counted or not named:
        return replace(told, vertices=())
    zone = Zone(
        first.zone,
        ZoneKind.KEEP_IN if first.fence == "KEEPIN" else ZoneKind.KEEP_OUT,
        tuple(projection.to_local(v.lat_deg, v.long_deg) for v in vertices),
        first.floor_m,
        first.ceiling_m,
    )
    others = tuple(z for z in told.zones if z.id != zone.id)
    return replace(told, zones=(*others, zone), vertices=())
