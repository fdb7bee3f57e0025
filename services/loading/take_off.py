"""Vehicles that start on the ground: ground height below each, and checks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from cratous.core.authority.timeliness import in_time
from cratous.core.avoidance.landing import on_ground
from cratous.core.geofence.planar import keep_in_leg_ok
from cratous.services.loading.checks import Finding, as_errors
from cratous.services.mission.landing import (
    BRAKING_M_S2,
    MAX_ACCELERATION_M_S2,
    ground_m,
    sites_of,
)
from cratous.services.mission.take_off import LONGEST_MS, grounded, roll_m, take_off_ms
from cratous.spec.mission import GroundedVehicle, Mission
from cratous.spec.mission.link_loss import LandingSite


def on_their_ground(mission: Mission) -> Mission:
    """The mission with the ground height below each vehicle that starts on the ground: of the site
    or the terrain.
    """
    sites, terrain_m = sites_of(mission), mission.frame.terrain_m
    if not grounded(mission):
        return mission
    vehicles = (
        replace(one, ground_m=ground_m(one.position, sites, terrain_m))
        if isinstance(one, GroundedVehicle)
        else one
        for one in mission.vehicles
    )
    return replace(mission, vehicles=tuple(vehicles))


@as_errors
def take_off_problems(mission: Mission) -> Iterator[Finding]:
    """Vehicles on the ground without an ICAROUS instance, with a position not above the ground, a
    roll beyond level ground or too long a climb; and those in missions with sensors.
    """
    for vehicle in grounded(mission):
        item = f"vehicles[{mission.vehicles.index(vehicle)}].start"
        speed, alt_m = vehicle.min_speed_m_s, vehicle.position.alt_m
        found = list[tuple[str, str, str]]()
        if vehicle.id not in mission.instances:
            found.append(("nobody takes it off", "a vehicle with an ICAROUS instance", "none"))
        if mission.sensing is not None:
            what = "a way up is not permitted against sensed tracks"
            found.append((what, "no section sensing beside it", "both"))
        if not keep_in_leg_ok(1, False, alt_m, alt_m, vehicle.ground_m, math.inf):
            expected = f"a position above the ground of {vehicle.ground_m:g} m MSL"
            found.append(("it would not leave the ground", expected, f"{alt_m:g} m MSL"))
        took_ms = take_off_ms(vehicle, MAX_ACCELERATION_M_S2, mission.simulation.heartbeat_ms)
        if not in_time(0, took_ms, LONGEST_MS):
            expected = f"a take-off of at most {LONGEST_MS / 1000:g} s"
            found.append(("it climbs for too long", expected, f"{took_ms / 1000:g} s"))
        roll = roll_m(0.0, speed, MAX_ACCELERATION_M_S2) + speed * speed / (2 * BRAKING_M_S2)
        for site in sites_of(mission):
            if not _is_level(vehicle, site, roll, mission.frame.terrain_m):
                what = f"its roll may cross the rim of {site.name}, which is not as high"
                expected = f"level ground for {roll:.4g} m around its start"
                got = f"{site.ground_m:g} and {mission.frame.terrain_m:g} m MSL"
                found.append((what, expected, got))
        for what, expected, got in found:
            name = f"vehicle {vehicle.id} starts on the ground: {what}"
            yield Finding(item, name, expected, got)


def _is_level(vehicle: GroundedVehicle, site: LandingSite, roll: float, terrain_m: float) -> bool:
    """Whether a site is as high as the terrain, or a roll from the vehicle's position does not cross its rim."""
    place, high_m = vehicle.position, site.ground_m - terrain_m
    north, east = place.north_m - site.north_m, place.east_m - site.east_m
    inside = on_ground(north, east, max(site.radius_m - roll, 0.0), 0.0, 0.0)
    beside = not on_ground(north, east, site.radius_m + roll, 0.0, 0.0)
    level = on_ground(0.0, 0.0, 0.0, abs(high_m), 0.0)
    return level or inside or beside


def words(mission: Mission) -> str:
    """Which vehicles start on the ground, as text for reports."""
    names = ", ".join(str(one.id) for one in grounded(mission))
    return f"on the ground at the start, and taken off by ICAROUS: {names}"
