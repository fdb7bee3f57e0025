"""Moving zones of a mission file: what is refused, and the standing regions that planning and flight keep out of.

A moving zone is followed by regions. Each holds all places at which the zone is from when the region comes into force
until a lead after the next one does, so a vehicle in whose way a new region lies has the lead to leave it. That a region
holds the zone at every instant is proved of it (kernel `stays_left`); its corners come from shapely.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

from cratous.core.geofence.motion import stays_left
from cratous.core.geofence.planar import edges_of, orient
from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.core.schedule.rows import runs_forward
from cratous.services.loading.checks import MAX_REACH_M, Where
from cratous.services.loading.polygons import Corner, polygon_problem
from cratous.spec.errors import BadInput
from cratous.spec.mission import (
    Change,
    FaultySimulation,
    Mission,
    MovingZone,
    SweptZone,
    Vehicle,
    Zone,
    ZoneKind,
)
from cratous.spec.mission.changes import ZONE, ZONE_ENDS, ZoneEnd

GRAVITY_M_S2 = 9.80665
ROOM_M = 6.0
"""By how much a region is wider than what the zone sweeps in it and in one step, for the deviation of a vehicle from its
path (`services.assumptions.path_deviation`) and for rounding [m]."""
MOST_REGIONS = 200
"""Regions by which a moving zone is followed, at most."""


def movement_of(data: dict[str, Any]) -> tuple[Corner, int, int | None] | None:
    """Velocity (north, east) [m/s], from and until when [ms] of a zone in a mission file; None if it stands."""
    if not data.keys() & {"velocity_m_s", "from_s", "until_s"}:
        return None
    north_m_s, east_m_s = data.get("velocity_m_s", (0.0, 0.0))
    until_ms = round(1000 * float(data["until_s"])) if "until_s" in data else None
    velocity = float(north_m_s), float(east_m_s)
    return velocity, round(1000 * float(data.get("from_s", 0))), until_ms


def as_given(zone: Zone, movement: tuple[Corner, int, int | None]) -> SweptZone:
    """The zone as the file has it; `with_regions` replaces it by its regions."""
    moving = MovingZone(zone.id, zone.vertices, zone.floor_m, zone.ceiling_m, *movement)
    fields = zone.id, zone.kind, zone.vertices, zone.floor_m, zone.ceiling_m, zone.padding_m
    return SweptZone(*fields, zone.label, moving)


def moving_problems(mission: Mission, where: Where) -> Iterator[BadInput]:
    """Faults of moving zones, and sections of the mission beside which they are not flown."""

    def fault(item: str, what: str, expected: str, got: str) -> BadInput:
        return BadInput(what, where=where(item), item=item, expected=expected, got=got)

    for k, change in enumerate(mission.changes):
        if isinstance(change.zone, SweptZone):
            yield fault(
                f"changes[{k}].zone.velocity_m_s",
                f"zone {change.zone.id} moves, and becomes known in flight",
                "a moving zone among `zones`, with its from_s",
                "a change",
            )
    known = [(k, zone) for k, zone in enumerate(mission.zones) if isinstance(zone, SweptZone)]
    for k, zone in known:
        yield from _of_zone(mission, k, zone, fault)
    ids = {zone.id for _, zone in known}
    for k, change in enumerate(mission.changes):
        if isinstance(change, ZoneEnd) and change.zone_id in ids:
            what = f"zone {change.zone_id} moves, and its end is told"
            expected = "until_s of the zone"
            yield fault(f"changes[{k}].zone_ends", what, expected, str(change.zone_id))
    if not known:
        return
    for item, there in (
        ("link_loss", mission.link_loss is not None),
        ("simulation.bridge_faults", isinstance(mission.simulation, FaultySimulation)),
    ):
        if there:
            what = "a zone moves, and a vehicle without the link is not told where it is"
            yield fault(item, what, f"no {item} beside moving zones", "both")


def _of_zone(mission: Mission, k: int, zone: SweptZone, fault: Any) -> Iterator[BadInput]:
    moving, item = zone.moving, f"zones[{k}]"
    speed_m_s = math.hypot(*moving.velocity_m_s)
    if zone.kind is not ZoneKind.KEEP_OUT:
        what = f"keep-in zone {zone.id} moves"
        yield fault(f"{item}.velocity_m_s", what, "a keep_out", "a keep_in")
    if not speed_m_s:
        yield fault(
            f"{item}.velocity_m_s",
            f"zone {zone.id} has times and does not move",
            "a velocity; a standing zone appears and ends by `changes`",
            "0 m/s",
        )
    slowest = min(mission.vehicles, key=lambda one: one.speed_m_s, default=None)
    velocity = Vec2(*moving.velocity_m_s)
    if slowest is not None and not disc_within(velocity, 0, slowest.speed_m_s):
        yield fault(
            f"{item}.velocity_m_s",
            f"zone {zone.id} moves too fast to be kept clear of",
            f"at most {slowest.speed_m_s:g} m/s, the speed of vehicle {slowest.id}",
            f"{speed_m_s:g} m/s",
        )
    end_ms = mission.simulation.limit_ms
    until_ms = end_ms if moving.until_ms is None else min(moving.until_ms, end_ms)
    if not runs_forward(moving.from_ms + 1, until_ms):
        ends = moving.until_ms is not None and not runs_forward(moving.from_ms + 1, moving.until_ms)
        name, got = ("until_s", until_ms) if ends else ("from_s", moving.from_ms)
        yield fault(
            f"{item}.{name}",
            f"zone {zone.id} is never in force",
            "from_s before until_s and before the end of the simulation",
            f"{got / 1000:g} s",
        )
    last = _moved(moving, until_ms)
    if all(map(math.isfinite, (x for c in last for x in c))):
        far_m = max(math.hypot(*corner) for corner in last)
        if not all(disc_within(Vec2(*corner), 0, MAX_REACH_M) for corner in last):
            yield fault(
                f"{item}.velocity_m_s",
                f"zone {zone.id} leaves the area of the mission",
                f"an until_s until which it is at most {MAX_REACH_M / 1000:g} km from the origin",
                f"{far_m / 1000:.1f} km",
            )


def with_regions(mission: Mission) -> tuple[Mission, list[str]]:
    """The mission with its moving zones, padded already, as the regions that follow them, and what is to be noted."""
    zones, later, notes = list[Zone](), list[Change](), list[str]()
    for zone in mission.zones:
        if not isinstance(zone, SweptZone):
            zones.append(zone)
            continue
        moving = replace(zone.moving, vertices=zone.vertices)
        zone = replace(zone, moving=moving)
        until_ms, lead_ms, times = _times(mission, moving)
        for begin_ms, end_ms in times:
            span_ms = max(begin_ms, moving.from_ms), min(end_ms + lead_ms, until_ms)
            region = _region(zone, span_ms, mission.simulation.step_ms)
            if begin_ms == 0:
                zones.append(region)
            else:
                later.append(Change(begin_ms, ZONE, zone=region))
        later.append(ZoneEnd(until_ms, ZONE_ENDS, zone_id=zone.id))
        north, east = moving.velocity_m_s
        notes.append(
            f"zone {zone.id} moves at {north:g} m/s north, {east:g} m/s east, from {moving.from_ms / 1000:g} s"
            f" to {until_ms / 1000:g} s; plans keep out of all places at which it is within "
            f"{lead_ms / 1000:g} s to {(lead_ms + times[0][1] - times[0][0]) / 1000:g} s from when they are made, and "
            "assume nothing of where it is later; they are checked again as it moves on"
        )
    later.sort(key=lambda change: change.at_ms)
    return replace(mission, zones=tuple(zones), changes=(*mission.changes, *later)), notes


def _times(mission: Mission, zone: MovingZone) -> tuple[int, int, list[tuple[int, int]]]:
    """Until when the zone is in force [ms], the lead [ms], and from and until when each region is [ms]."""
    step_ms, limit_ms = mission.simulation.step_ms, mission.simulation.limit_ms
    until_ms = min(limit_ms, limit_ms if zone.until_ms is None else zone.until_ms)
    lead_s = max(_lead_s(vehicle, zone) for vehicle in mission.vehicles)
    lead_ms = math.ceil(1000 * lead_s / step_ms) * step_ms
    first_ms = max(0, zone.from_ms - lead_ms) // step_ms * step_ms
    least_ms = max(lead_ms / 2, (until_ms - first_ms) / MOST_REGIONS)
    span_ms = math.ceil(least_ms / step_ms) * step_ms
    starts = range(first_ms, until_ms, span_ms)
    return until_ms, lead_ms, [(begin, min(begin + span_ms, until_ms)) for begin in starts]


def _lead_s(vehicle: Vehicle, zone: MovingZone) -> float:
    """How long a vehicle needs for a full turn and to cross the zone, with a heartbeat to hear of it [s]."""
    radius_m = vehicle.max_speed_m_s**2 / (GRAVITY_M_S2 * math.tan(vehicle.max_bank_rad))
    norths, easts = zip(*zone.vertices, strict=True)
    across_m = math.hypot(max(norths) - min(norths), max(easts) - min(easts))
    return 2 + (2 * math.pi * radius_m + across_m) / vehicle.speed_m_s


def _moved(zone: MovingZone, at_ms: int) -> list[Corner]:
    gone_s = (at_ms - zone.from_ms) / 1000
    return [
        (n + gone_s * zone.velocity_m_s[0], e + gone_s * zone.velocity_m_s[1])
        for n, e in zone.vertices
    ]


def _region(zone: SweptZone, times_ms: tuple[int, int], step_ms: int) -> SweptZone:
    """A convex polygon that holds the zone at every instant of a span [ms], proved; with the padding applied."""
    from shapely import MultiPoint

    points = [corner for at_ms in times_ms for corner in _moved(zone.moving, at_ms)]
    room_m = ROOM_M + step_ms / 1000 * sum(map(abs, zone.moving.velocity_m_s))
    outline = MultiPoint(points).convex_hull.buffer(room_m, join_style="mitre")
    corners = tuple((float(x), float(y)) for x, y in outline.exterior.coords[:-1])
    if not outline.exterior.is_ccw:
        corners = corners[::-1]
    if polygon_problem(corners) or not _holds(corners, zone.moving, times_ms):
        raise BadInput(
            f"no region was found that holds zone {zone.id} while it moves",
            item=f"zone {zone.id}",
            expected="a zone of ordinary size",
            got=f"{times_ms[0] / 1000:g} to {times_ms[1] / 1000:g} s",
        )
    return replace(zone, vertices=corners, padding_m=0.0)


def _holds(corners: tuple[Corner, ...], zone: MovingZone, times_ms: tuple[int, int]) -> bool:
    """Whether the corners turn one way, and each vertex of the zone stays left of each edge; on rationals."""
    velocity = _rational(zone.velocity_m_s)
    begin, end = (Fraction(at_ms - zone.from_ms, 1000) for at_ms in times_ms)
    vertices, ring = [_rational(v) for v in zone.vertices], [_rational(c) for c in corners]
    return all(
        all(orient(a, b, c) >= 0 for c in ring)
        and all(stays_left(a, b, m, velocity, begin, end) for m in vertices)  # type: ignore[arg-type]
        for a, b in edges_of(ring)
    )


def _rational(pair: Corner) -> Vec2:
    return Vec2(Fraction(pair[0]), Fraction(pair[1]))  # type: ignore[arg-type]
