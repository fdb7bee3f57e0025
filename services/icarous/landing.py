"""Routes to landing sites: to the gate of the final descent at ICAROUS's lowest altitude, then straight down.

The vehicle touches down half of its roll before the centre of the site. Where the route is too short for the
descent, laps of a circle are flown before the gate. The final descent uses half of the greatest descent rate,
to keep a margin for delay; it and the route to it are flown at the lowest speed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from cratous.core.authority.timeliness import in_time
from cratous.core.avoidance.manoeuvre import Ability
from cratous.core.routing.dubins import polyline_length_m
from cratous.core.routing.polylines import Track, circle_points
from cratous.services.icarous.course import Course, courses, radius_m
from cratous.services.icarous.lost_link import LostLink
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.return_to_path import bearing_rad
from cratous.services.mission.landing import BRAKING_M_S2, STEEP
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.link_loss import LandingSite
from cratous.spec.mission.plan import Pose

DIRECTIONS = 8
"""A site is approached straight on, or from this many directions, those closest to straight on first."""
EVEN = 0.8
"""Largest share of the climb rate used on the route down to the gate."""
LEGS = 24
"""Number of legs per lap."""
MOST_LAPS = 50
"""A landing that would need more laps is rejected."""
LONGEST_MS = 1_800_000
"""So is one whose final descent would take longer [ms]."""


def in_order(plan: LostLink, place: Position) -> list[LandingSite]:
    """The sites in the order in which they are tried: the named one (without a name, all that are not for
    ditching), then those for ditching, each group by distance.
    """

    def rank(site: LandingSite) -> tuple[bool, float]:
        first = site.name == plan.site or not (plan.site or site.ditch)
        return not first, math.hypot(site.north_m - place.north_m, site.east_m - place.east_m)

    there = (one for one in plan.sites if one.ditch or plan.site in ("", one.name))
    return sorted(there, key=rank)


def approaches(
    plan: LostLink, site: LandingSite, sensed: Sensed, zones: tuple[Zone, ...]
) -> Iterator[Course]:
    """Routes from the vehicle to the ground of a site; none where the final descent would take too long."""
    motion, ability = sensed.motion, sensed.ability
    if sinks_too_slowly(site, ability):
        return
    middle = Position(site.north_m, site.east_m, site.ground_m)
    straight = bearing_rad(motion.position, middle)
    turns = sorted(range(DIRECTIONS), key=lambda k: min(k, DIRECTIONS - k))
    for turn in turns:
        heading = straight + 2 * math.pi * turn / DIRECTIONS
        touch, gate = _last_descent(site, heading, ability)
        # by then the vehicle has slowed down
        lead_m = max(motion.speed_m_s**2 - ability.min_speed_m_s**2, 0.0)
        lead_m /= 2 * ability.acceleration_m_s2
        before = along(gate, heading, -lead_m)
        wide_m, start = radius_m(sensed), Pose(*motion.position, motion.heading_rad)
        slope = EVEN * ability.max_climb_m_s / ability.min_speed_m_s
        end = Pose(*before, heading)
        way = plan.find(start, end, wide_m, slope, zones)
        if not way:
            continue
        for side in (1, -1):
            whole = (*with_laps(way, end, wide_m, slope, side), gate)
            if len(whole) == 1:
                continue
            track = Track((*whole, touch), motion.heading_rad)
            flown = courses(Pose(*gate, heading), motion, wide_m, track)[0]
            yield flown._replace(speed_m_s=ability.min_speed_m_s, site=site)


def sinks_too_slowly(site: LandingSite, ability: Ability) -> bool:
    """Whether the final descent to a site would take longer than LONGEST_MS."""
    down_m = max(ability.floor_m - site.ground_m, 0.0)
    return not in_time(0, math.ceil(1000 * down_m / (STEEP * ability.max_climb_m_s)), LONGEST_MS)


def _last_descent(site: LandingSite, heading: float, ability: Ability) -> tuple[Position, Position]:
    """The touchdown point, and the gate where the final descent begins."""
    speed = ability.min_speed_m_s
    middle = Position(site.north_m, site.east_m, site.ground_m)
    touch = along(middle, heading, -speed * speed / (4 * BRAKING_M_S2))
    down_m = max(ability.floor_m - site.ground_m, 0.0)
    far_m = down_m * speed / (STEEP * ability.max_climb_m_s)
    return touch, along(touch, heading, -far_m)._replace(alt_m=site.ground_m + down_m)


def along(place: Position, heading: float, by_m: float) -> Position:
    """The place by_m [m] farther in a direction, at the same altitude."""
    north_m, east_m = (
        place.north_m + by_m * math.cos(heading),
        place.east_m + by_m * math.sin(heading),
    )
    return Position(north_m, east_m, place.alt_m)


def with_laps(
    way: tuple[Position, ...], end: Pose, wide_m: float, slope: float, side: int
) -> tuple[Position, ...]:
    """The route with an even descent and the laps at its end that it requires, right (1) or left (-1); () for
    too many.
    """
    middle = (
        end.north_m - side * wide_m * math.sin(end.heading_rad),
        end.east_m + side * wide_m * math.cos(end.heading_rad),
    )
    lap = circle_points(middle, wide_m, side > 0, way[-1], LEGS)
    down_m = abs(way[0].alt_m - end.alt_m)
    missing_m = max(down_m / slope - polyline_length_m(way), 0.0)
    times = math.ceil(missing_m / polyline_length_m((way[-1], *lap)))
    if times > MOST_LAPS:
        return ()
    points = (*way, *(lap * times))
    return _evenly(points, way[0].alt_m, end.alt_m)


def _evenly(points: tuple[Position, ...], begin_m: float, end_m: float) -> tuple[Position, ...]:
    """The points with altitudes interpolated over the flown length."""
    total_m, flown_m, found = polyline_length_m(points), 0.0, [points[0]._replace(alt_m=begin_m)]
    for before, after in pairwise(points):
        flown_m += math.dist(before[:2], after[:2])
        found.append(after._replace(alt_m=begin_m + (end_m - begin_m) * flown_m / total_m))
    return tuple(found)
