"""The rest of a vehicle's chain: where its path was left, where it is rejoined, the points that follow."""

from __future__ import annotations

import math

from cratous.core.avoidance.manoeuvre import Motion
from cratous.core.routing.dubins import polyline_length_m
from cratous.services.flight import chain as chains
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState, turn_radius_m
from cratous.services.icarous.return_to_path import goal_index
from cratous.spec.mission import Position

OVERLAP_S = 1.0
"""An interrupted task resumes this much before the point where it was left [s of flight]."""


def leaving_m(chain: Chain) -> float:
    """Arc length at which the path is resumed: slightly before where it was left, so that coverage overlaps
    [m].
    """
    return max(chain.s_m - OVERLAP_S * chain.speed_m_s, chain.join_m)


def join_in_transit(chain: Chain, state: AirState) -> float:
    """Arc length of the waypoint ahead at which the route is rejoined, as ICAROUS chooses it [m]."""
    track, p = chain.track, state.position
    near = track.nearest(p, chain.s_m, track.length_m)
    index = 0
    while index < len(track.s_m) - 1 and track.s_m[index] <= near.s_m:
        index += 1
    motion = Motion(p, state.heading_rad, state.speed_m_s, state.climb_m_s)
    radius = turn_radius_m(state.speed_m_s, chain.vehicle.max_bank_rad)
    return track.s_m[goal_index(motion, radius, track.points, index)]


def points_left(chain: Chain) -> tuple[Position, ...]:
    """The points of the present track from its flown arc length on; at least two."""
    points = chain.track.rest(chain.s_m)
    if len(points) > 1:
        return points
    (p,), h = points, chain.track.heading_rad(chain.s_m)
    # a single point has no direction: a second one, one metre on, gives it the track's
    return (p, Position(p.north_m + math.cos(h), p.east_m + math.sin(h), p.alt_m))


def last_lap(chain: Chain) -> tuple[Position, ...]:
    """One more lap of the final loiter, level at its final altitude."""
    points = chain.track.points
    lap = points[-chains.LAP_LEGS - 1 :]
    return tuple(p._replace(alt_m=points[-1].alt_m) for p in lap)


def points_ahead(chain: Chain, opens_ms: int, ahead_m: float) -> tuple[Position, ...]:
    """The rest of the present track and at least ahead_m [m] of what is expected to follow, or all of it.

    opens_ms: when the next task is expected to begin [ms].
    """
    points = list(chain.track.rest(chain.s_m))
    item = chain.item
    more: list[Position] = []
    after = () if chain.holds else chain.items[chain.k + 1 :]
    if item is None or chain.holds:
        more = list(last_lap(chain)) * 4
    elif chain.phase is not Phase.TASK:
        more = list(laps_expected(chain, opens_ms, ahead_m)) + list(item.path)
    # a route that ends earlier has no continuation: ICAROUS treats its end as final
    for following in after:
        if polyline_length_m((points[-1], *more)) >= ahead_m:
            break
        more += [*following.transit, *following.path]
    return tuple(points + more)


def laps_expected(chain: Chain, opens_ms: int, ahead_m: float) -> tuple[Position, ...]:
    """The laps of the hold expected until the task may begin, limited to about ahead_m [m]."""
    item = chain.item
    if item is None or item.hold is None:
        return ()
    wait_m = (opens_ms - chain.since_ms) / 1000 * chain.speed_m_s - chain.left_m()
    lap = 2 * math.pi * item.hold.radius_m
    laps = max(0, min(round(wait_m / lap), math.ceil(ahead_m / lap)))
    return chains.lap_points(item.hold, item.path[0]) * laps
