"""Where a vehicle holds for an operator: the way there and the lap, if both keep the zones."""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import polyline_length_m
from cratous.core.routing.polylines import Track
from cratous.services.flight import chain as chains
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState, turn_radius_m
from cratous.services.flight.executive_state import Config, Out, State
from cratous.services.flight.inflight_routes import Ways
from cratous.services.flight.task_transitions import circling
from cratous.spec.mission import Position
from cratous.spec.mission.changes import HoldCommand
from cratous.spec.mission.plan import Pose

TURNS_RAD = (0.0, math.pi / 2, -math.pi / 2, math.pi)
"""Headings at which a place is approached: straight on, else turned by these angles [rad]."""
HERE_M = 1.0
"""A place within this distance counts as the vehicle's present position [m]."""


class Into(NamedTuple):
    """A path into a hold, or why none exists. pose: where it joins the circle; way_m: length of the way there
    [m].
    """

    track: Track | None
    pose: Pose
    why: str = ""
    way_m: float = 0.0


def pose_of(asked: HoldCommand, air: AirState) -> Pose:
    """The pose in which a hold is entered: at its place and altitude, in the direction of straight flight
    there.
    """
    here = air.position
    alt_m = here.alt_m if asked.alt_m is None else asked.alt_m
    if asked.place is None:
        return Pose(here.north_m, here.east_m, alt_m, air.heading_rad)
    north_m, east_m = asked.place
    north, east = north_m - here.north_m, east_m - here.east_m
    near = math.hypot(north, east) < HERE_M
    return Pose(north_m, east_m, alt_m, air.heading_rad if near else math.atan2(east, north))


def into(ways: Ways, chain: Chain, air: AirState, asked: Pose) -> Into:
    """A way to a circle through a pose, and one lap of it.

    No track, with the reason, where no way or no circle keeps the zones, or the altitude cannot be reached on
    the way.
    """
    why = f"no circle there keeps the zones that bind at {asked.alt_m:.0f} m"
    for turn in TURNS_RAD:
        pose = asked._replace(heading_rad=asked.heading_rad + turn)
        hold = chains.tangent_hold(pose, _radius_m(chain), ways.zones)
        if hold is None:
            continue
        lap = chains.lap_points(hold, Position(*pose[:3]))
        if math.dist(air.position, pose[:3]) < HERE_M and turn == 0.0:
            return Into(Track(lap), pose)
        way = ways.way_to(chain, air, pose)
        if not way:
            why = "no way there keeps the zones"
            continue
        if first_bad_leg((*way, *lap[1:]), ways.zones) is not None:
            why = "the way there found breaks a zone that it is in now"
            continue
        way_m = polyline_length_m(way)
        if abs(pose.alt_m - air.position.alt_m) > way_m * _slope(chain) + HERE_M:
            why = f"it cannot come to {pose.alt_m:.0f} m on a way of {way_m:.0f} m"
            continue
        return Into(Track((*way, *lap[1:])), pose, way_m=way_m)
    return Into(None, asked, why)


def held_again(config: Config, state: State, chain: Chain, now_ms: int, out: Out) -> Chain:
    """The chain of a holding vehicle that is on its way back to its hold after another had flown it; where no
    way leads there, it circles where it is.
    """
    assert chain.holds is not None
    ways, air = config.ways(state.zones), state.air(chain.vehicle.id)
    found = into(ways, chain, air, chain.holds)
    track = found.track
    if track is None:
        chain, track = circling(config, state, chain, 0.0, out)
    return chain.enter(Phase.DONE, track, now_ms)


def _radius_m(chain: Chain) -> float:
    speed = max(chain.speed_m_s, chain.vehicle.min_speed_m_s)
    return chains.ROUTE_MARGIN * turn_radius_m(speed, chain.vehicle.max_bank_rad)


def _slope(chain: Chain) -> float:
    return chain.vehicle.max_climb_m_s / chain.speed_m_s
