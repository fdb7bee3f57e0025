"""What of landing sites the mission, its loader, the simulator and the monitor share."""

from __future__ import annotations

from collections.abc import Iterable

from cratous.core.avoidance.landing import on_ground
from cratous.spec.mission import LandingLoss, Mission, Position
from cratous.spec.mission.link_loss import LandingSite

BRAKING_M_S2 = 2.0
"""On the ground a vehicle slows down so much."""
MAX_ACCELERATION_M_S2 = 1.0
"""On the ground and in the air it becomes faster, and in the air slower, by so much at most."""
SLACK_M = 0.01
"""So near to the ground a vehicle is on it [m]."""
TOUCHES_OFF_BEATS = 1.0
"""A vehicle touches down at most so many heartbeats of flight too early or too late."""


def sites_of(mission: Mission) -> tuple[LandingSite, ...]:
    """Where the vehicles of a mission may land."""
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
    """Whether a vehicle so high above the ground [m] is on it."""
    return on_ground(0.0, 0.0, 0.0, height_m, SLACK_M)


def ground_m(place: Position, sites: Iterable[LandingSite], terrain_m: float) -> float:
    """The height of the ground below a place [m MSL]: of the site there, else of the terrain."""
    for site in sites:
        north, east = place.north_m - site.north_m, place.east_m - site.east_m
        if on_ground(north, east, site.radius_m, 0.0, 0.0):
            return site.ground_m
    return terrain_m
