"""What a vehicle's ICAROUS flies by itself: without the link, or after a declared failure."""

from __future__ import annotations

from functools import lru_cache

from cratous.core.authority.failure import Asked
from cratous.core.authority.link_loss import FINISH, LAND, LOITER, RETURN
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.rejoining import Router
from cratous.services.icarous.lost_link import LostLink, OnFailure
from cratous.services.mission.landing import on_failure_of, site_under, sites_of
from cratous.services.mission.merging import merging_of
from cratous.spec.mission import GroundedVehicle, Mission, Position, Vehicle, Zone
from cratous.spec.mission.link_loss import LandingSite, WithoutLink, words
from cratous.spec.mission.on_failure import AfterFailure, Failed
from cratous.spec.mission.plan import Pose

CHOICES = {
    WithoutLink.FINISH: FINISH,
    WithoutLink.LOITER: LOITER,
    WithoutLink.RETURN: RETURN,
    WithoutLink.LAND: LAND,
}


MODES = {
    AfterFailure.HOLD: LOITER,
    AfterFailure.RETURN: RETURN,
    AfterFailure.LAND: LAND,
    AfterFailure.DITCH: LAND,
}
ALWAYS_MS = 2**40
"""A silence that is never too long: only a declared failure ends the authority of UxAS [ms]."""


def lost_link(mission: Mission, vehicle_id: int) -> LostLink | None:
    """The lost-link behaviour for one vehicle: that of the mission, else the one of a vehicle in ICAROUS's hand.

    None where the mission sets none and has sensors or a merge fix: with these it is flown only if it is asked for.
    """
    loss = mission.link_loss
    if loss is None:
        if mission.sensing is not None or merging_of(mission) is not None:
            return None
        said = words(WithoutLink.FINISH, "")
        return LostLink(FINISH, mission.bridge_times.lost_link_after_ms, said, _way, in_hand=True)
    goal = loss.to or mission.vehicle(vehicle_id).position
    returns = loss.choice is WithoutLink.RETURN
    choice = CHOICES[loss.choice]
    said, sites = words(loss.choice, loss.name), sites_of(mission)
    goal_of = goal if returns else None
    site = loss.name if sites else ""
    return LostLink(choice, loss.after_ms, said, _way, goal_of, site, sites)


def after_failure(mission: Mission, vehicle_id: int) -> OnFailure | None:
    """What the mission sets for one vehicle after a declared failure, None if it sets nothing.

    One that starts on the ground of a site lands there if none is named.
    """
    after = on_failure_of(mission)
    if after is None:
        return None
    goal = mission.vehicle(vehicle_id).position if after.to is None else Position(*after.to)
    goal_of = goal if after.choice is AfterFailure.RETURN else None
    sites, site = after.sites, after.name if after.lands else ""
    if after.choice is AfterFailure.LAND and not site:
        site = _launch_site(mission.vehicle(vehicle_id), sites)
    if after.choice is AfterFailure.DITCH:
        sites = tuple(one for one in sites if one.ditch)
    flies = LostLink(MODES[after.choice], ALWAYS_MS, after.words, _way, goal_of, site, sites)
    return OnFailure(Asked(*(one in after.of for one in Failed)), flies)


def _launch_site(vehicle: Vehicle, sites: tuple[LandingSite, ...]) -> str:
    """The site on whose ground a vehicle starts, "" for none."""
    if not isinstance(vehicle, GroundedVehicle):
        return ""
    site = site_under(vehicle.stands_at, sites)
    return "" if site is None else site.name


def _way(
    start: Pose, end: Pose, radius_m: float, slope: float, zones: tuple[Zone, ...]
) -> tuple[Position, ...]:
    place = Position(start.north_m, start.east_m, start.alt_m)
    state = AirState(place, start.heading_rad, 0.0, 0.0)
    return _router(zones).way_to(state, radius_m, end, slope)


@lru_cache(maxsize=64)
def _router(zones: tuple[Zone, ...]) -> Router:
    return Router(zones)
