"""Tracks made in flight: to the next task, back onto the path that was left, around at the end.

What is planned is flown as it is planned; these are made where a vehicle does not come from where
the plan has it. Zones and turns are the router's; what is flown is judged by the monitor.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.routing.polylines import Track
from cratous.services.flight import chain as chains
from cratous.services.flight.ahead import join_in_transit, leaving_m
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState, turn_radius_m
from cratous.services.flight.rejoining import Router
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import PlanItem, Pose


class Back(NamedTuple):
    """A way back onto a track. join_m: arc length at which it joins; flown_m: of the task's path."""

    track: Track
    join_m: float
    flown_m: float


class Ways:
    """Tracks around the zones that bind now. dt_s: a step of the flight [s]."""

    def __init__(self, zones: tuple[Zone, ...], dt_s: float) -> None:
        self.zones, self.dt_s = zones, dt_s
        self._router = Router(zones)

    def transit(self, chain: Chain, state: AirState) -> Track:
        """The planned way to the item, or a new one if we do not come from where it begins."""
        item = chain.item
        assert item is not None
        track = chains.transit_track(item, state.position)
        first = track.points[0]
        off = math.hypot(
            first.north_m - state.position.north_m, first.east_m - state.position.east_m
        )
        if off <= 3 * state.speed_m_s * self.dt_s + 1:
            return track
        return Track(self._to(chain, state, chains.start_pose(item)))

    def lap(self, chain: Chain, item: PlanItem) -> Track:
        """One lap of the hold at the start pose of an item."""
        pose = chains.start_pose(item)
        hold = item.hold or chains.tangent_hold(pose, _radius_m(chain), ())
        assert hold is not None
        return Track(chains.lap_points(hold, Position(*pose[:3])))

    def back(self, chain: Chain, state: AirState) -> Back:
        """To where the path was left, or to a waypoint ahead in transit, and on along the rest."""
        flown = 0.0
        if chain.phase is Phase.TASK:
            join = leaving_m(chain)
            flown = chain.base_m + join - chain.join_m
        else:
            join = join_in_transit(chain, state)
        rest = Track(chain.track.rest(join), chain.track.heading_rad(join))
        target = Pose(*rest.points[0], rest.heading_rad(0.0))
        way = self._to(chain, state, target)
        track = Track((*way, *rest.points[1:]), target.heading_rad)
        return Back(track, max(0.0, track.length_m - rest.length_m), flown)

    def last(self, chain: Chain, state: AirState, layer_m: float) -> Track:
        """Circle at the end of the chain, raised by layer_m where zones and climb allow it."""
        end = chain.track.at(chain.track.length_m) if chain.k > 0 else state.position
        heading = (
            chain.track.heading_rad(chain.track.length_m) if chain.k > 0 else state.heading_rad
        )
        slope = 0.9 * chain.vehicle.max_climb_m_s / chain.vehicle.max_speed_m_s
        return chains.final_loiter(
            Pose(*end, heading), _radius_m(chain), layer_m, slope, self.zones
        )

    def _to(self, chain: Chain, state: AirState, target: Pose) -> tuple[Position, ...]:
        slope = chain.vehicle.max_climb_m_s / chain.speed_m_s
        return self._router.way_to(state, _radius_m(chain), target, slope)


def _radius_m(chain: Chain) -> float:
    return chains.ROUTE_MARGIN * turn_radius_m(
        max(chain.speed_m_s, chain.vehicle.min_speed_m_s), chain.vehicle.max_bank_rad
    )
