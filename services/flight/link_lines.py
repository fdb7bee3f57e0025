"""Messages from UxAS to an ICAROUS instance, as lines of the text protocol: zones, routes, states."""

from __future__ import annotations

import math
from collections.abc import Sequence

from cratous.bridge.text_protocol import (
    Attitude,
    FenceDone,
    FenceVertex,
    LinesMissing,
    Message,
    OwnPosition,
    RouteEnd,
    RoutePoint,
    RouteRequest,
    RouteStart,
    SoftReset,
    StartMission,
    Traffic,
    VelocityOfAnother,
    WayOfAnother,
    Waypoint,
    WaypointReached,
)
from cratous.core.authority.gate import UXAS, Gate
from cratous.services.flight.dynamics import AirState
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Position, Velocity, Zone, ZoneKind

FAR_M = 1e6
"""Altitudes are limited to this magnitude on the wire [m]: no aircraft is beyond it."""

MOST_AGAIN = 5
"""How often the missing lines of one plan or zone are sent again."""

MOST_SAID = Gate(UXAS, 10**12, False)
"""Largest plausible epoch of an instance at the beginning of a connection."""
MOST_TOLD = Gate(UXAS, 10**14, False)
"""Largest epoch from which an instance goes on, so that later ones fit the 15 digits of a line."""

Aircraft = tuple[tuple[int, AirState], ...]
Places = dict[int, tuple[float, float]]
"""Latitude and longitude by aircraft [deg]."""


def fence(zone: Zone, number: int, projection: Projection) -> list[Message]:
    """A zone as GEOFN lines and GEOFN_SEND. number: its number on the wire, from 1.

    Raises ValueError for a zone with padding, which must be turned into vertices first.
    """
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
    """An altitude limited to FAR_M for the text protocol [m]."""
    return max(-FAR_M, min(FAR_M, alt_m))


def way(points: tuple[Position, ...], speed_m_s: float, projection: Projection) -> list[Message]:
    """A route as RESET_SFT, its WAYPTs, each with the total count, and START_MISSION."""
    lats, lons = projection.to_geodetic_many(
        [p.north_m for p in points], [p.east_m for p in points]
    )
    waypoints = [
        Waypoint(
            total=len(points),
            speed_mps=speed_m_s,
            lat_deg=float(lat),
            long_deg=float(lon),
            alt_m=p.alt_m,
            index=k,
        )
        for k, (p, lat, lon) in enumerate(zip(points, lats, lons, strict=True))
    ]
    return [SoftReset(), *waypoints, StartMission()]


Flies = tuple[Position, ...] | Velocity
"""How a vehicle flies: its route under UxAS, or its velocity under ICAROUS."""


def way_of_another(vehicle_id: int, points: Flies, projection: Projection) -> list[Message]:
    """Another vehicle's route as OTHER lines, or its velocity as OVELO; without points, one line for an
    unknown route.
    """
    if isinstance(points, Velocity):
        return [VelocityOfAnother(vehicle_id, *points)]
    if not points:
        return [WayOfAnother(vehicle_id, 0, 0.0, 0.0, 0.0, 0)]
    lats, lons = projection.to_geodetic_many(
        [p.north_m for p in points], [p.east_m for p in points]
    )
    return [
        WayOfAnother(vehicle_id, len(points), float(lat), float(lon), p.alt_m, k)
        for k, (p, lat, lon) in enumerate(zip(points, lats, lons, strict=True))
    ]


def asked_way(asked: RouteRequest, projection: Projection) -> tuple[AirState, Position]:
    """Start state and end position of the route that a WPREQ requests."""
    start = projection.to_local(asked.start_lat_deg, asked.start_long_deg)
    end = projection.to_local(asked.end_lat_deg, asked.end_long_deg)
    begins = Position(*start, asked.start_alt_m)
    track = math.radians(asked.track_deg)
    return AirState(begins, track, asked.horizontal_mps, 0.0), Position(*end, asked.end_alt_m)


def proposal(
    way: tuple[Position, ...], speed_m_s: float, number: int, projection: Projection
) -> list[Message]:
    """The RPRSP lines of a route; one without places means that no route exists."""
    norths, easts = [p.north_m for p in way], [p.east_m for p in way]
    places = zip(*projection.to_geodetic_many(norths, easts), way, strict=True)
    points = (
        RoutePoint(float(lat), float(long), p.alt_m, speed_m_s, number) for lat, long, p in places
    )
    return [RouteStart(number), *points, RouteEnd(number)]


def reset_to(p: Position, projection: Projection) -> SoftReset:
    """The resume point as RESET_SFT."""
    lat, lon = projection.to_geodetic(p.north_m, p.east_m)
    return SoftReset(lat_deg=lat, long_deg=lon, alt_m=p.alt_m)


def places_of(aircraft: Aircraft, projection: Projection) -> Places:
    """Latitude and longitude of each aircraft [deg]."""
    return {
        vid: projection.to_geodetic(s.position.north_m, s.position.east_m) for vid, s in aircraft
    }


def climbing(s: AirState) -> Attitude:
    """The attitude derived from the flight path alone: wings level, nose along it."""
    pitch = math.degrees(math.atan2(s.climb_m_s, s.speed_m_s))
    return Attitude(roll_deg=0.0, pitch_deg=pitch, yaw_deg=0.0)


def states(
    vehicle_id: int,
    aircraft: Aircraft,
    places: Places,
    now_ms: int,
    attitude: Attitude | None = None,
    lines: dict[int, Traffic] | None = None,
) -> list[Message]:
    """POSTN and ATTUD of a vehicle, and an OBJCT for each other aircraft. attitude: None for `climbing`;
    lines: result of `traffic`, computed once for many recipients.
    """
    others = traffic(aircraft, places) if lines is None else lines
    out: list[Message] = []
    for vid, s in aircraft:
        v, (lat, lon) = s.velocity, places[vid]
        if vid == vehicle_id:
            own = OwnPosition(
                time_s=now_ms / 1000,
                lat_deg=lat,
                long_deg=lon,
                alt_abs_m=s.position.alt_m,
                alt_rel_m=s.position.alt_m,
                north_mps=v.north_m_s,
                east_mps=v.east_m_s,
                down_mps=v.down_m_s,
                vehicle_id=vid,
            )
            out[:0] = [own, attitude or climbing(s)]
        else:
            out.append(others[vid])
    return out


def traffic(aircraft: Aircraft, places: Places) -> dict[int, Traffic]:
    """One OBJCT message per aircraft, shared by all recipients."""
    lines = {}
    for vid, s in aircraft:
        v, (lat, lon) = s.velocity, places[vid]
        lines[vid] = Traffic(
            what="TRAFFIC",
            lat_deg=lat,
            long_deg=lon,
            alt_m=s.position.alt_m,
            north_mps=v.north_m_s,
            east_mps=v.east_m_s,
            down_mps=v.down_m_s,
            index=vid,
        )
    return lines


def between(lines: Sequence[Message], asked: LinesMissing, number: str) -> list[Message]:
    """The requested range of lines; all of them if the total differs from the request's."""
    if len(lines) != asked.total:
        return list(lines)
    return [m for m in lines if getattr(m, number) in range(asked.first, asked.last + 1)]


def onward(way: Sequence[Message], reached: int) -> list[Message]:
    """The route sent last, and a WPRCH for each waypoint reached."""
    return [*way, *(WaypointReached(k) for k in range(reached))]
