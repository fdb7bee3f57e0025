"""Lost-link parameters for a vehicle's ICAROUS."""

from __future__ import annotations

from functools import lru_cache

from cratous.core.authority.link_loss import FINISH, LAND, LOITER, RETURN
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.rejoining import Router
from cratous.services.icarous.lost import LostLink
from cratous.services.mission.landing import sites_of
from cratous.services.mission.merging import merging_of
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.mission.link_loss import WithoutLink, words
from cratous.spec.mission.plan import Pose

IN_HAND_AFTER_MS = 30_000
"""Silence of UxAS after which a vehicle in ICAROUS's hand finishes its way and circles, if the mission sets nothing
[ms].
"""
CHOICES = {
    WithoutLink.FINISH: FINISH,
    WithoutLink.LOITER: LOITER,
    WithoutLink.RETURN: RETURN,
    WithoutLink.LAND: LAND,
}


def lost_link(mission: Mission, vehicle_id: int) -> LostLink | None:
    """The lost-link behaviour for one vehicle: that of the mission, else the one of a vehicle in ICAROUS's hand.

    None where the mission sets none and has sensors or a merge fix: courses are not permitted against sensed tracks,
    nor in the turns of a merge.
    """
    loss = mission.link_loss
    if loss is None:
        if mission.sensing is not None or merging_of(mission) is not None:
            return None
        said = words(WithoutLink.FINISH, "")
        return LostLink(FINISH, IN_HAND_AFTER_MS, said, _way, in_hand=True)
    goal = loss.to or mission.vehicle(vehicle_id).position
    returns = loss.choice is WithoutLink.RETURN
    choice = CHOICES[loss.choice]
    said, sites = words(loss.choice, loss.name), sites_of(mission)
    goal_of = goal if returns else None
    site = loss.name if sites else ""
    return LostLink(choice, loss.after_ms, said, _way, goal_of, site, sites)


def _way(
    start: Pose, end: Pose, radius_m: float, slope: float, zones: tuple[Zone, ...]
) -> tuple[Position, ...]:
    place = Position(start.north_m, start.east_m, start.alt_m)
    state = AirState(place, start.heading_rad, 0.0, 0.0)
    return _router(zones).way_to(state, radius_m, end, slope)


@lru_cache(maxsize=64)
def _router(zones: tuple[Zone, ...]) -> Router:
    return Router(zones)
