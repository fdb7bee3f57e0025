"""A route that an instance flies autonomously, ending in a circle or on the ground, and its steering."""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.avoidance.drift import NONE
from cratous.core.avoidance.manoeuvre import Motion, Pace
from cratous.core.avoidance.resolution import Choice
from cratous.core.routing.polylines import Track
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.route_end import TURN_MARGIN
from cratous.spec.mission import Position
from cratous.spec.mission.link_loss import LandingSite
from cratous.spec.mission.plan import Hold, Pose


class Course(NamedTuple):
    """hold: the circle at the end; speed_m_s: flown speed; track: the route to it, None for a circle alone;
    s_m: arc length flown; offset_m: distance from the track [m]; site: the landing site on which the route
    ends instead of in the circle, None for none: its last leg is the final descent; pace: the speed to
    accelerate to, if it differs.
    """

    hold: Hold
    speed_m_s: float
    track: Track | None = None
    s_m: float = 0.0
    offset_m: float = 0.0
    site: LandingSite | None = None
    pace: Pace | None = None

    @property
    def middle(self) -> Position:
        """The centre of the holding circle."""
        return Position(self.hold.north_m, self.hold.east_m, self.hold.alt_m)

    @property
    def left(self) -> tuple[Position, ...]:
        """The points of the route still to be flown; () at its end."""
        return () if self.track is None else self.track.rest(self.s_m)[1:]

    @property
    def flown_to_its_end(self) -> bool:
        """Whether its route has been flown; for a landing, all but the final descent."""
        return not self.left[0 if self.site is None else 1 :]

    def flown(self, motion: Motion, beat_s: float) -> Course:
        """The course with its progress updated after a heartbeat of beat_s [s]."""
        if self.track is None:
            return self
        window_m = 2 * motion.speed_m_s * beat_s + abs(self.offset_m)
        near = self.track.nearest(motion.position, self.s_m, window_m)
        return self._replace(s_m=near.s_m, offset_m=near.offset_m)


def courses(
    end: Pose, motion: Motion, radius_m: float, track: Track | None
) -> tuple[Course, Course]:
    """The route with the circle tangent to its end on the right, and with that on the left."""
    right, left = (
        Hold(
            end.north_m - side * radius_m * math.sin(end.heading_rad),
            end.east_m + side * radius_m * math.cos(end.heading_rad),
            end.alt_m,
            radius_m,
            side > 0,
        )
        for side in (1, -1)
    )
    return Course(right, motion.speed_m_s, track), Course(left, motion.speed_m_s, track)


def radius_m(sensed: Sensed) -> float:
    """Radius of turns and circles at the present speed [m]."""
    return TURN_MARGIN * sensed.motion.speed_m_s / sensed.ability.turn_rate_rad_s


def steered(course: Course, sensed: Sensed, beat_s: float) -> Choice:
    """The velocity until the next heartbeat: towards an aim point ahead on the route, as the autopilot
    steers.
    """
    motion, ability = sensed.motion, sensed.ability
    p, step_m = motion.position, motion.speed_m_s * beat_s
    track, exact = course.track, sensed.here == NONE.here
    if not exact and course.site is not None and course.flown_to_its_end and track is not None:
        return _sinking(track, course.speed_m_s, sensed, beat_s)
    wide_m = 1.5 * motion.speed_m_s / ability.turn_rate_rad_s
    lands = course.site is not None
    if course.track is not None and (course.left or lands):
        ahead_m = max(step_m, math.sqrt(abs(course.offset_m) * wide_m))
        aim = course.track.at(course.s_m + ahead_m)
        height_m = course.track.at(course.s_m + step_m).alt_m
    else:
        aim = _on_circle(course.hold, p, step_m, wide_m)
        height_m = course.hold.alt_m
    most = ability.max_climb_m_s
    climb = min(max((height_m - p.alt_m) / beat_s, -most), most)
    heading = math.atan2(aim.east_m - p.east_m, aim.north_m - p.north_m)
    return Choice("heading", heading, course.speed_m_s, climb, beat_s, True, None)


def _sinking(track: Track, speed: float, sensed: Sensed, beat_s: float) -> Choice:
    """The final descent by a state that is not exact: at its rate along its line, and on past its end, until the ground.

    The ground is where it is felt, not where the sensed altitude says that it is.
    """
    (gate, touch), p = track.points[-2:], sensed.motion.position
    north, east = touch.north_m - gate.north_m, touch.east_m - gate.east_m
    length_m = math.hypot(north, east)
    north, east = north / length_m, east / length_m
    along_m = (p.north_m - touch.north_m) * north + (p.east_m - touch.east_m) * east
    aside_m = (p.east_m - touch.east_m) * north - (p.north_m - touch.north_m) * east
    wide_m = 1.5 * sensed.motion.speed_m_s / sensed.ability.turn_rate_rad_s
    # as far ahead as its noise, so that it does not turn after that
    ahead_m = max(speed * beat_s, math.sqrt(abs(aside_m) * wide_m), sensed.here.wide_m)
    heading = math.atan2(east, north) - math.atan2(aside_m, ahead_m)
    rate = (gate.alt_m - touch.alt_m) * speed / length_m
    wanted_m = touch.alt_m - along_m * rate / speed - rate * beat_s
    climb = min(max((wanted_m - p.alt_m) / beat_s, -1.5 * rate), -0.5 * rate)
    return Choice("heading", heading, speed, climb, beat_s, True, None)


def _on_circle(hold: Hold, p: Position, step_m: float, wide_m: float) -> Position:
    north, east = p.north_m - hold.north_m, p.east_m - hold.east_m
    off_m = abs(math.hypot(north, east) - hold.radius_m)
    ahead_m = max(step_m, min(math.sqrt(off_m * wide_m), hold.radius_m))
    side = 1 if hold.clockwise else -1
    angle = math.atan2(east, north) + side * ahead_m / hold.radius_m
    return Position(
        hold.north_m + hold.radius_m * math.cos(angle),
        hold.east_m + hold.radius_m * math.sin(angle),
        hold.alt_m,
    )
