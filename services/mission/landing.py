"""Landing site data shared by mission, loader, simulator and monitor."""

from __future__ import annotations

from collections.abc import Iterable

from cratous.core.avoidance.drift import NONE, Off
from cratous.core.avoidance.landing import on_ground
from cratous.spec.mission import (
    CombinedDaa,
    FailureDaa,
    LandingLoss,
    Mission,
    Position,
    Vehicle,
)
from cratous.spec.mission.link_loss import LandingSite
from cratous.spec.mission.on_failure import OnFailure

BRAKING_M_S2 = 2.0
"""Deceleration of a vehicle on the ground [m/s2]."""
MAX_ACCELERATION_M_S2 = 1.0
"""Greatest acceleration on the ground and in the air, and deceleration in the air [m/s2]."""
SLACK_M = 0.01
"""Within this height a vehicle is on the ground [m]."""
TOUCHES_OFF_BEATS = 1.0
"""Largest deviation of the touchdown point, in heartbeats of flight."""
STEEP = 0.5
"""Share of the climb rate used in the final descent."""


def own_bounds(mission: Mission) -> Off:
    """How far a vehicle may be from its sensed position after one fix [m]; 0 if its own state is exact."""
    sensing = mission.sensing
    gps = None if sensing is None else sensing.gps
    if sensing is None or gps is None:
        return NONE.here
    return Off(sensing.sigmas * gps.horizontal_m, sensing.sigmas * gps.vertical_m)


def touches_off_m(mission: Mission, vehicle: Vehicle) -> float:
    """How far from its touchdown point a vehicle may touch down [m], after a heartbeat of flight, and with the bounds of
    its own position: an altitude that is wrong moves the point along the slope of the final descent.
    """
    speed, off = vehicle.min_speed_m_s, own_bounds(mission)
    late_m = TOUCHES_OFF_BEATS * speed * mission.simulation.heartbeat_ms / 1000
    return late_m + off.wide_m + off.high_m * speed / (STEEP * vehicle.max_climb_m_s)


def on_failure_of(mission: Mission) -> OnFailure | None:
    """What a mission specifies to be flown after a declared failure; None if nothing."""
    return mission.daa.on_failure if isinstance(mission.daa, FailureDaa | CombinedDaa) else None


def sites_of(mission: Mission) -> tuple[LandingSite, ...]:
    """The landing sites of a mission."""
    if (after := on_failure_of(mission)) is not None:
        return after.sites
    loss = mission.link_loss
    return loss.sites if isinstance(loss, LandingLoss) else ()


def site_under(place: Position, sites: Iterable[LandingSite]) -> LandingSite | None:
    """The landing site on which a position lies; None in the air or outside all sites."""
    for site in sites:
        north, east = place.north_m - site.north_m, place.east_m - site.east_m
        if on_ground(north, east, site.radius_m, place.alt_m - site.ground_m, SLACK_M):
            return site
    return None


def is_down(height_m: float) -> bool:
    """Whether a vehicle at this height above the ground [m] is on it."""
    return on_ground(0.0, 0.0, 0.0, height_m, SLACK_M)


def ground_m(place: Position, sites: Iterable[LandingSite], terrain_m: float) -> float:
    """Altitude of the ground below a place [m MSL]: of a landing site there, else of the terrain."""
    for site in sites:
        north, east = place.north_m - site.north_m, place.east_m - site.east_m
        if on_ground(north, east, site.radius_m, 0.0, 0.0):
            return site.ground_m
    return terrain_m
