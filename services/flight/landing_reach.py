"""Whether a route that keeps the zones leads each vehicle from its start to a landing site."""

from __future__ import annotations

from cratous.core.authority.link_loss import LAND
from cratous.core.avoidance.manoeuvre import Motion
from cratous.core.avoidance.prediction import buffered
from cratous.core.avoidance.resolution import Scene
from cratous.services.flight.dynamics import (
    AirState,
    ability_at,
    limits_of,
    planned_state,
)
from cratous.services.flight.lost_link import after_failure, lost_link
from cratous.services.flight.vehicle import UNTOUCHED
from cratous.services.icarous.course_permits import refused
from cratous.services.icarous.landing import (
    LONGEST_MS,
    approaches,
    in_order,
    sinks_too_slowly,
)
from cratous.services.icarous.link_loss import NO_WAY
from cratous.services.icarous.lost_link import LostLink
from cratous.services.icarous.messages import Sensed
from cratous.services.loading.polygons import hard_zones
from cratous.services.mission.ground import floor_of
from cratous.services.mission.landing import own_bounds, sites_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Vehicle

SLOW = f"its last descent takes longer than {LONGEST_MS / 1000:g} s"


def require_reachable(mission: Mission) -> None:
    """BadInput where a vehicle that is to land without the link, or after a failure, could not reach a landing site from its
    start, given the zones known then and no other traffic.
    """
    if not sites_of(mission):
        return
    for number in mission.instances:
        after = after_failure(mission, number)
        plans = (lost_link(mission, number), None if after is None else after.flies)
        lands = [plan for plan in plans if plan is not None and plan.choice == LAND]
        found = (_why_not(mission, mission.vehicle(number), plan) for plan in lands)
        if why := next(filter(None, found), None):
            raise BadInput(
                f"vehicle {number} can land nowhere",
                where=mission.source,
                item="landing_sites",
                expected="a site that a way from its start leads to, clear of the zones",
                got="; ".join(why),
            )


def _why_not(mission: Mission, vehicle: Vehicle, plan: LostLink) -> list[str]:
    """Why no site can be reached, one reason per site; empty if one can."""
    sensed, daa = at_start(mission, vehicle, planned_state(vehicle)), mission.daa
    zones = hard_zones(mission.zones)
    volume = buffered(daa.well_clear, daa.buffer)
    scene = Scene((), zones, volume, daa.lookahead_s, own_bounds(mission), daa.looks_first)
    beat_s, said = mission.simulation.heartbeat_ms / 1000, list[str]()
    for site in in_order(plan, vehicle.position):
        why = SLOW if sinks_too_slowly(site, sensed.ability) else NO_WAY
        for course in approaches(plan, site, sensed, zones):
            why = refused(course, sensed, scene, daa, beat_s)
            if not why:
                return []
        said.append(f"{site.name}: {why}")
    return said


def at_start(mission: Mission, vehicle: Vehicle, air: AirState) -> Sensed:
    """What a vehicle in a state senses before any flight; on the ground, with its turn ability at take-off
    speed.
    """
    limits = limits_of(vehicle)
    speed, step_s = air.speed_m_s or limits.min_speed_m_s, mission.simulation.step_ms / 1000
    ability = ability_at(speed, limits, floor_of(mission), step_s)
    motion = Motion(air.position, air.heading_rad, air.speed_m_s, air.climb_m_s)
    return Sensed(0, motion, ability, (), UNTOUCHED)
