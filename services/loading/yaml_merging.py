"""Reads the section `merging` of a mission file as `Merging`; the schema has its bounds."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from cratous.core.avoidance.way_ahead import near_line
from cratous.core.kernel import Vec2
from cratous.core.routing.dubins import turn_radius_m
from cratous.core.routing.polylines import Track
from cratous.core.tasks.rendezvous import spares_a_lap
from cratous.services.loading.checks import Finding, as_errors
from cratous.services.loading.coordinates import Places
from cratous.services.loading.document import Document
from cratous.services.loading.problems import refuse
from cratous.services.mission.merging import merging_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import GroundedVehicle, Mission, Position, Vehicle
from cratous.spec.mission.merging import DirectFaults, Merging, Silence

SEPARATION_S = 20.0
"""Default time between two vehicles at the fix, as in ICAROUS [s]."""
BESIDE = {
    "sensing": "members that may be anywhere within their sensed bounds turn the others aside, which miss their slots",
    "link_loss": "a vehicle that acts by itself without the link keeps no slot",
}
ORIGIN = Vec2(0.0, 0.0)
FOR_GOOD_MS = 86_400_000
PASSED_M = 1.0
"""The way to a task passes the fix if it is nearest to it at least this far before its end [m]."""
CIRCLES = 3.0
"""Least distance between the rims of the schedule and entry zones, in turn radii: a hold begun at the one stays out of
the other.
"""


def yaml_merging(document: Document, places: Places) -> Merging | None:
    """The fix at which vehicles merge; None for none. BadInput if a section that excludes it is there."""
    data = document.data.get("merging")
    if data is None:
        return None
    refuse([_beside(document, other) for other in BESIDE if other in document.data])
    place = places.position(data["fix"]["position"])
    return Merging(
        name=data["fix"]["name"],
        north_m=place.north_m,
        east_m=place.east_m,
        vehicles=tuple(int(one) for one in data["vehicles"]),
        separation_ms=round(1000 * float(data.get("separation_s", SEPARATION_S))),
        coordination_m=float(data["coordination_m"]),
        schedule_m=float(data["schedule_m"]),
        entry_m=float(data["entry_m"]),
        faults=_faults(data.get("faults", {})),
    )


def _beside(document: Document, other: str) -> BadInput:
    return BadInput(
        BESIDE[other],
        where=document.where(("merging",)),
        item="merging",
        expected=f"no section {other} beside it",
        got="both",
    )


def _faults(data: dict[str, Any]) -> DirectFaults:
    silences = tuple(
        Silence(
            int(one["vehicle"]),
            round(1000 * float(one["from_s"])),
            round(1000 * float(one["until_s"])) if "until_s" in one else FOR_GOOD_MS,
        )
        for one in data.get("silent", [])
    )
    return DirectFaults(int(data.get("seed", 0)), float(data.get("loss", 0.0)), silences)


@as_errors
def merging_problems(mission: Mission) -> Iterator[Finding]:
    """Problems of a merge fix: vehicles that cannot merge, zones without room, slots too near for well clear."""
    merging = merging_of(mission)
    if merging is None:
        return
    ours = {vehicle.id: vehicle for vehicle in mission.vehicles}
    for k, number in enumerate(merging.vehicles):
        item = f"merging.vehicles[{k}]"
        if number not in ours:
            yield Finding(item, "no such vehicle", "the id of a vehicle", str(number))
        elif number not in mission.instances:
            yield Finding(
                item, "nobody merges it", "a vehicle with an ICAROUS instance", str(number)
            )
        elif isinstance(ours[number], GroundedVehicle):
            yield Finding(
                item, "it starts on the ground", "a vehicle that starts in the air", str(number)
            )
        else:
            yield from _no_room(merging, ours[number], mission, item)
    for k, one in enumerate(merging.faults.silences):
        if one.vehicle not in merging.vehicles:
            item = f"merging.faults.silent[{k}].vehicle"
            yield Finding(item, "it does not merge", "one of merging.vehicles", str(one.vehicle))
    yield from _before_the_fix(merging, mission)
    radii = merging.coordination_m, merging.schedule_m, merging.entry_m
    if not radii[0] > radii[1] > radii[2]:
        got = ", ".join(f"{one:g}" for one in radii)
        expected = "coordination_m > schedule_m > entry_m"
        yield Finding("merging", "zones that do not lie in each other", expected, got)


def _before_the_fix(merging: Merging, mission: Mission) -> Iterator[Finding]:
    """Tasks that begin at the fix, or so near before it, as seen from the start of each vehicle that may fly them, that
    no circle there stays out of the entry zone: the way to them passes no fix, and after them no slot is waited for.
    """
    fix = Vec2(merging.north_m, merging.east_m)
    for k, task in enumerate(mission.tasks):
        able = [v for v in mission.vehicles if not task.eligible or v.id in task.eligible]
        if not able or any(v.id not in merging.vehicles for v in able):
            continue
        begins = task.start_point or task.points[0]
        place = Vec2(begins.north_m, begins.east_m)
        least_m = max(merging.entry_m + CIRCLES * _circle_m(vehicle) for vehicle in able)
        if not near_line(place, fix, fix, least_m):
            continue
        if not any(_passed(merging, vehicle.position, begins) for vehicle in able):
            yield Finding(
                f"tasks[{k}].points",
                f"it begins at the fix {merging.name}, or too near before it to wait for a slot after it",
                f"at least {least_m:.0f} m before {merging.name}, or beyond it",
                f"{math.dist(place, fix):.0f} m before it",
            )


def _circle_m(vehicle: Vehicle) -> float:
    """Radius of a circle that it holds in [m]."""
    # loaded only if vehicles merge
    from cratous.services.icarous.route_end import TURN_MARGIN

    return TURN_MARGIN * turn_radius_m(vehicle.speed_m_s, vehicle.max_bank_rad)


def _passed(merging: Merging, start: Position, place: Position) -> bool:
    """Whether the straight way to a place has passed the fix: within entry_m of it, nearest before its end."""
    way, fix = Track((start, place), 0.0), Vec2(merging.north_m, merging.east_m)
    near_m = way.nearest(Position(*fix, 0.0), 0.0, way.length_m).s_m
    there, left_m = way.at(near_m), way.length_m - near_m
    if not near_line(Vec2(there.north_m, there.east_m), fix, fix, merging.entry_m):
        return False
    return not near_line(Vec2(left_m, 0.0), ORIGIN, ORIGIN, PASSED_M)


def _no_room(merging: Merging, vehicle: Vehicle, mission: Mission, item: str) -> Iterator[Finding]:
    slow, fast = vehicle.min_speed_m_s, vehicle.max_speed_m_s
    radius_m = _circle_m(vehicle)
    least_m = merging.entry_m + CIRCLES * radius_m
    if not _within(least_m, merging.schedule_m):
        expected = (
            f"at least {least_m:.0f} m: entry_m and {CIRCLES:g} radii of vehicle {vehicle.id}"
        )
        got = f"{merging.schedule_m:g} m"
        yield Finding("merging.schedule_m", "nobody can hold before the entry zone", expected, got)
    lap_s = 2 * math.pi * radius_m / vehicle.speed_m_s
    if not spares_a_lap(merging.schedule_m - radius_m, lap_s, slow, fast):
        expected = f"speeds between which schedule_m takes {lap_s:.0f} s, a lap, longer or shorter"
        yield Finding(item, "it cannot be there at any time", expected, f"{slow:g} to {fast:g} m/s")
    apart_m = merging.separation_ms / 1000 * slow
    kept_m = mission.daa.well_clear.dthr_m * mission.daa.buffer
    if not _within(kept_m, apart_m):
        expected = f"at least {kept_m / slow:.1f} s: dthr_m with its buffer at {slow:g} m/s"
        got = f"{merging.separation_ms / 1000:g} s"
        yield Finding("merging.separation_s", "slots are nearer than well clear", expected, got)


def _within(one_m: float, other_m: float) -> bool:
    """Whether one distance is at most another [m]."""
    return near_line(Vec2(one_m, 0.0), ORIGIN, ORIGIN, other_m)
