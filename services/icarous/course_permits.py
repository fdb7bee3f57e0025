"""Whether a course that an instance flies autonomously is permitted, with the circle that ends it.

The kernels check it at each heartbeat from the present position. Each leg keeps the zones, given the
deviation from it; the rest of the route and the laps within the look-ahead keep the buffered volume of every
known intruder clear, in straight flight or along its announced route, with the time thresholds; the disc of
the circle keeps the cylinder clear. A sensed intruder is anywhere within its bounds; the vehicle itself is anywhere
within its own, which widens the margin to zones. A route to a landing site ends on the ground, without a circle or
anything after it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from cratous.core.avoidance.drift import Off
from cratous.core.avoidance.manoeuvre import Motion, way_along
from cratous.core.avoidance.prediction import Piece, after, first_violation_s
from cratous.core.avoidance.resolution import Scene
from cratous.core.avoidance.way_ahead import near_line
from cratous.core.geofence.clearance import leg_keeps
from cratous.core.kernel import Vec2
from cratous.core.permit.remainder import hold_at, hold_permits, zones_permit
from cratous.core.routing.polylines import circle_points
from cratous.services.icarous.course import Course
from cratous.services.icarous.forbidden import Forbidden
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.permits import way_is_clear
from cratous.services.icarous.route_end import TRACKING_S
from cratous.spec.mission import Daa, Position, Zone

ORIGIN = Vec2(0.0, 0.0)
LEGS = 24
"""Number of legs per lap; the polyline deviates by 1 % of the radius."""
TAKEN = "somebody is on its ground"
"""Reason for not landing at a site, which has room for the roll of one vehicle."""


def refused(course: Course, sensed: Sensed, scene: Scene, daa: Daa, beat_s: float) -> str:
    """Why a course is not permitted from the present position; "" if it is."""
    return next(_refused(course, sensed, scene, daa, beat_s), "")


def refused_soon(course: Course, sensed: Sensed, scene: Scene, daa: Daa, beat_s: float) -> str:
    """As `refused`, but a course longer than the look-ahead is checked only within the look-ahead."""
    pieces = way_along(sensed.motion, course.left, scene.lookahead_s, pace=course.pace).pieces
    flown_m = sum(piece.duration_s * _speed_m_s(piece) for piece in pieces)
    left_m = 0.0 if course.track is None else course.track.length_m - course.s_m
    ends = near_line(Vec2(left_m, 0.0), ORIGIN, ORIGIN, flown_m)
    if not course.left or ends:
        return refused(course, sensed, scene, daa, beat_s)
    aside_m = sensed.motion.speed_m_s * beat_s / 2
    found = (*_against_zones(pieces, scene, aside_m), *_against_others(pieces, sensed, scene, daa))
    return next(iter(found), "")


def forbidden(
    found: Iterable[Course], sensed: Sensed, scene: Scene, daa: Daa, beat_s: float
) -> Forbidden:
    """Whether traffic alone, and zones alone, forbid each of these courses within the look-ahead; both if they do so
    only together.
    """
    found, unseen = tuple(found), sensed._replace(intruders=())
    open_air = scene._replace(zones=())
    traffic = all(refused_soon(one, sensed, open_air, daa, beat_s) for one in found)
    zone = all(refused_soon(one, unseen, scene, daa, beat_s) for one in found)
    together = not (traffic or zone)
    return Forbidden(traffic or together, zone or together)


def _speed_m_s(piece: Piece) -> float:
    return math.hypot(piece.velocity.north_m_s, piece.velocity.east_m_s)


def _against_zones(pieces: tuple[Piece, ...], scene: Scene, aside_m: float) -> Iterator[str]:
    off = Off(aside_m + scene.here.wide_m, scene.here.high_m)
    for zone in scene.zones:
        if not all(_keeps(piece, zone, off) for piece in pieces):
            yield f"zone {zone.id} is in the way"


def _against_others(
    pieces: tuple[Piece, ...], sensed: Sensed, scene: Scene, daa: Daa
) -> Iterator[str]:
    for other in sensed.intruders:
        meets = first_violation_s(pieces, other, scene.volume) is not None
        if meets or not way_is_clear(pieces, other, daa):
            yield f"it is not permitted against {other.id}"


def _refused(
    course: Course, sensed: Sensed, scene: Scene, daa: Daa, beat_s: float
) -> Iterator[str]:
    motion, ability = sensed.motion, sensed.ability
    pieces = way_along(motion, course.left, math.inf, pace=course.pace).pieces
    if course.pace is not None:
        motion = motion._replace(speed_m_s=course.pace.speed_m_s)
    # between two commands the vehicle flies straight on, where the route may turn
    aside_m = motion.speed_m_s * beat_s / 2
    yield from _against_zones(pieces, scene, aside_m)
    if course.site is not None:
        if course.site.name in sensed.taken:
            yield TAKEN
        yield from _against_others(pieces, sensed, scene, daa)
        return
    disc_m = course.hold.radius_m + TRACKING_S * motion.speed_m_s
    if not _disc_keeps(course.middle, disc_m, scene):
        yield "no circle there keeps the zones"
    begin_s = sum(piece.duration_s for piece in pieces)
    points, until_s = _points(course, motion, scene), begin_s + scene.lookahead_s
    laps = way_along(sensed.motion, points, until_s, pace=course.pace).pieces
    for other in sensed.intruders:
        meets = first_violation_s(laps, other, scene.volume) is not None
        if meets or not way_is_clear(pieces, other, daa):
            yield f"it is not permitted against {other.id}"
    hold = hold_at(course.middle, begin_s, begin_s + scene.lookahead_s)
    rise_m = TRACKING_S * ability.max_climb_m_s
    for other in sensed.intruders:
        if not hold_permits(hold, other, scene.volume, disc_m, rise_m):
            yield f"the circle is not permitted against {other.id}"


def _points(course: Course, motion: Motion, scene: Scene) -> list[Position]:
    """The rest of the route, and the laps flown within the look-ahead."""
    hold, left = course.hold, course.left
    here = left[-1] if left else motion.position
    north, east = here.north_m - hold.north_m, here.east_m - hold.east_m
    share = hold.radius_m / max(math.hypot(north, east), 1e-6)
    begin = Position(hold.north_m + share * north, hold.east_m + share * east, hold.alt_m)
    middle = (hold.north_m, hold.east_m)
    lap = circle_points(middle, hold.radius_m, hold.clockwise, begin, LEGS)
    lap_s = 2 * math.pi * hold.radius_m / motion.speed_m_s
    return [*left, *lap[:-1] * math.ceil(scene.lookahead_s / lap_s), begin]


def _keeps(piece: Piece, zone: Zone, off: Off) -> bool:
    end = after(piece, piece.duration_s)
    return leg_keeps(piece.position, end, zone, off.wide_m, off.high_m)


def _disc_keeps(middle: Position, disc_m: float, scene: Scene) -> bool:
    """Whether a disc keeps the zones, wherever its middle is within the own bounds."""
    wide_m, high_m = disc_m + scene.here.wide_m, scene.here.high_m
    if not zones_permit(middle, scene.zones, wide_m):
        return False
    return not high_m or all(leg_keeps(middle, middle, z, wide_m, high_m) for z in scene.zones)
