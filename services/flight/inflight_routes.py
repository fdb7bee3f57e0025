"""Tracks made in flight: to the next task, back onto the path, around the final circle.

Planned tracks are flown as planned; these are made where a vehicle is not where the plan assumes. The router
respects zones and turn radius; where it finds no way that keeps the zones there is none, except for a vehicle
without tasks inside enclosing zones. The monitor judges what is flown.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.dubins import STRAIGHT, cut, dubins, pose_after
from cratous.core.routing.polylines import Track
from cratous.services.flight import chain as chains
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState, turn_radius_m
from cratous.services.flight.rejoining import Router
from cratous.services.flight.remaining_path import join_in_transit, last_lap, leaving_m
from cratous.services.mission.escapes import escapes
from cratous.services.mission.zones import distance_m
from cratous.services.planning.zone_exits import WayOut, entered, way_out
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import PlanItem, Pose
from cratous.spec.records import replace


class Back(NamedTuple):
    """A way back onto a track. join_m: arc length at which it joins; flown_m: arc length of the task's path
    there.
    """

    track: Track
    join_m: float
    flown_m: float


class Last(NamedTuple):
    """Where a vehicle circles at the end of its chain; whether the circle and the way there keep the zones.
    speed_m_s: speed to fly it at, None for the present one.
    """

    track: Track
    kept: bool
    way_kept: bool = True
    speed_m_s: float | None = None


AWAY = (3.0, 6.0, 12.0, 24.0)
"""Distances at which a place to circle is searched for [turn radii]."""
BEARINGS = 12
"""Number of directions in which it is searched for."""
ROOM_M = 10.0
"""Sufficient distance from zones for a path of tightest turns [m]."""


class Ways:
    """Tracks around the zones in force. dt_s: duration of a step of the flight [s]."""

    def __init__(self, zones: tuple[Zone, ...], dt_s: float) -> None:
        self.zones, self.dt_s = zones, dt_s
        self._router = Router(zones)

    def out_of(self, chain: Chain, state: AirState) -> tuple[tuple[Zone, ...], WayOut | None]:
        """The zones that a vehicle violates at its position, and the shortest level way found out of them, if
        any.
        """
        inside = entered(state.position, self.zones)
        return inside, way_out(state.pose, round(_radius_m(chain), 3), self.zones)

    def transit(self, chain: Chain, state: AirState) -> Track | None:
        """The planned transit to the item, or a new one if the vehicle is not at its start; None if none
        exists.
        """
        item = chain.item
        assert item is not None
        track = chains.transit_track(item, state.position)
        if self._there(state, track.points[0]):
            return track
        return self.new_transit(chain, state)

    def new_transit(self, chain: Chain, state: AirState) -> Track | None:
        """A new transit to the item from the vehicle's present position; None if none exists."""
        item = chain.item
        assert item is not None
        way = self.way_to(chain, state, chains.start_pose(item))
        return Track(way) if way else None

    def _there(self, state: AirState, place: Position) -> bool:
        """Whether a vehicle is at a place within tracking accuracy, with no further zone on the way there."""
        p = state.position
        off = math.hypot(place.north_m - p.north_m, place.east_m - p.east_m)
        if off > 3 * state.speed_m_s * self.dt_s + 1:
            return False
        inside = entered(p, self.zones)
        kept = tuple(zone for zone in self.zones if zone not in inside)
        return first_bad_leg((p, place), kept) is None

    def lap(self, chain: Chain, item: PlanItem) -> Track | None:
        """One lap of the hold at the start pose of an item; None if no circle there keeps the zones."""
        pose = chains.start_pose(item)
        hold = item.hold or chains.tangent_hold(pose, _radius_m(chain), self.zones)
        return None if hold is None else Track(chains.lap_points(hold, Position(*pose[:3])))

    def back(self, chain: Chain, state: AirState) -> Back | None:
        """A way back to where the path was left (in transit: to a waypoint ahead, else to the end), and the
        rest of the track; None if there is none.
        """
        if chain.phase is Phase.TASK:
            join = leaving_m(chain)
            return self._onto(chain, state, join, chain.base_m + join - chain.join_m)
        ahead = self._onto(chain, state, join_in_transit(chain, state), 0.0)
        return ahead or self._onto(chain, state, chain.track.length_m, 0.0)

    def _onto(self, chain: Chain, state: AirState, join: float, flown_m: float) -> Back | None:
        rest = Track(chain.track.rest(join), chain.track.heading_rad(join))
        target = Pose(*rest.points[0], rest.heading_rad(0.0))
        way = self.way_to(chain, state, target)
        if not way:
            return None
        points = (*way, *rest.points[1:])
        join_m = max(0.0, Track(points, target.heading_rad).length_m - rest.length_m)
        if chain.item is None:  # the last laps are of a whole final lap
            points += last_lap(chain)[1:]
        return Back(Track(points, target.heading_rad), join_m, flown_m)

    def last(self, chain: Chain, state: AirState, layer_m: float) -> Last:
        """The circle at the end of the chain if the vehicle is there, else at its position, raised by layer_m
        [m] where zones and climb allow it; where no circle there keeps the zones, one nearby.
        """
        end, heading = chain.track.at(chain.track.length_m), state.heading_rad
        if chain.k > 0 and self._there(state, end):
            heading = chain.track.heading_rad(chain.track.length_m)
        else:
            end = state.position
        slope = 0.9 * chain.vehicle.max_climb_m_s / chain.vehicle.max_speed_m_s
        radius_m, pose = _radius_m(chain), Pose(*end, heading)
        if chains.tangent_hold(pose, radius_m, self.zones) is None:
            return self._near(chain, state, pose)
        return Last(chains.final_loiter(pose, radius_m, layer_m, slope, self.zones), True)

    def _near(self, chain: Chain, state: AirState, pose: Pose) -> Last:
        """A way to the nearest place found where a circle keeps the zones, and a lap there.

        If no way keeps the zones, the tightest turns are compared with the direct ways, by the total length
        of the legs that violate a zone; a tight turn wins a tie. Without such a place: a circle at the pose,
        which violates a zone.
        """
        across: list[tuple[float, float, Track]] = []
        for place, lap in self._places(chain, pose):
            way = self.way_to(chain, state, place)
            if way:
                return Last(Track((*way, *lap)), True)
            direct = cut(dubins(state.pose, place, _radius_m(chain)), place)
            bad = [leg for leg in pairwise(direct) if first_bad_leg(leg, self.zones) is not None]
            broken_m, way_m = (sum(math.dist(*leg) for leg in g) for g in (bad, pairwise(direct)))
            # rounded to ten metres: a distant place is not preferred for a smaller difference
            across.append((round(broken_m, -1), way_m, Track((*direct, *lap))))
        least = min(across, key=lambda one: one[:2], default=None)
        tight = None if entered(state.position, self.zones) else self._tight(chain, state)
        if tight is not None and (least is None or tight[0] <= least[0]):
            return tight[1]
        if least is not None:
            return Last(least[2], True, way_kept=False)
        return Last(chains.final_loiter(pose, _radius_m(chain), 0.0, 0.0, ()), False)

    def _tight(self, chain: Chain, state: AirState) -> tuple[float, Last] | None:
        """A path of tightest turns and straights into a circle that keeps the zones, with the length that
        violates zones [m].

        Of paths that violate none, the first with ROOM_M of clearance, else the one with the most; if all
        violate some, the one that does so least. None where no such circle was found.
        """
        tried = escapes(state.pose, state.speed_m_s, chain.vehicle, self.zones, self.dt_s)
        best, best_m = None, -1.0
        for way in sorted(tried, key=lambda one: (round(one.broken_m, 3), one.length_m)):
            if best is not None and way.broken_m > 0:
                break
            radius_m = _radius_m(replace(chain, speed_m_s=way.speed_m_s))
            hold = chains.tangent_hold(way.end, radius_m, self.zones)
            if hold is None:
                continue
            track = Track((*way.points, *chains.lap_points(hold, way.points[-1])[1:]))
            found = way.broken_m, Last(track, True, way.broken_m == 0, way.speed_m_s)
            room_m = min(distance_m(track.points, zone) for zone in self.zones)
            if way.broken_m > 0 or room_m >= ROOM_M:
                return found
            if room_m > best_m:
                best, best_m = found, room_m
        return best

    def _places(self, chain: Chain, pose: Pose) -> Iterator[tuple[Pose, tuple[Position, ...]]]:
        """Places around a pose where a circle keeps the zones, nearest first, with the rest of the lap."""
        radius_m = _radius_m(chain)
        for away in AWAY:
            for k in range(BEARINGS):
                at = pose_after(
                    pose._replace(heading_rad=pose.heading_rad + 2 * math.pi * k / BEARINGS),
                    STRAIGHT, away * radius_m, radius_m,
                )  # fmt: skip
                hold = chains.tangent_hold(at, radius_m, self.zones)
                if hold is not None:
                    yield at, tuple(chains.lap_points(hold, Position(*at[:3]))[1:])

    def way_to(self, chain: Chain, state: AirState, target: Pose) -> tuple[Position, ...]:
        """A way from a state to a pose that keeps the zones; empty if none is found."""
        slope = chain.vehicle.max_climb_m_s / chain.speed_m_s
        return self._router.way_to(state, _radius_m(chain), target, slope)


def _radius_m(chain: Chain) -> float:
    return chains.ROUTE_MARGIN * turn_radius_m(
        max(chain.speed_m_s, chain.vehicle.min_speed_m_s), chain.vehicle.max_bank_rad
    )
