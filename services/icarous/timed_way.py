"""A way in time that an instance flies where no manoeuvre leads back: past zones and moving traffic to the waypoint.

`services.ways_in_time` proposes it, for the vehicle's speeds and layers of altitude. It is flown instant by instant, and
at each heartbeat the kernels check what is left of it, for the vehicle where it is, against zones and traffic as they
are now; it is given up where they refuse it. Control goes back on it only as on any other flight: where the way back is
free.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.prediction import Piece, after, rest_of
from cratous.core.avoidance.resolution import Choice
from cratous.core.avoidance.resolution import Scene as Manoeuvres
from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.core.ways_in_time.scene import Checks, Scene
from cratous.services.icarous.deviation import keeps_to
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.route_end import TURN_MARGIN
from cratous.services.ways_in_time.asking import Asked, Outcome, way_in_time
from cratous.spec.mission import Daa, Position

SHARE_S = 0.25
"""Budget of the search for a way to the last place [s]; a nearer one is tried first, for half of it."""
LEADS_S = 2.0
"""The vehicle steers for where the way is this much later [s]."""
OFF_S = 1.0
"""It follows the way within the distance flown in this time [s], and within half of the buffer's margin; farther off
the way is given up.
"""
KIND = "way"
"""Kind of its choices."""


class Timed(NamedTuple):
    """pieces: the way, timed from begun_ms [ms]; rho_m: bound on the deviation of its arcs [m]; route: the waypoints that
    were known as it was found, to one of which it leads.
    """

    pieces: tuple[Piece, ...]
    begun_ms: int
    rho_m: float
    route: tuple[Position, ...] = ()

    def left(self, now_ms: int) -> tuple[Piece, ...]:
        """The rest of it, timed from now; () at its end."""
        last = self.pieces[-1]
        whole_ms = math.floor(1000 * (last.start_s + last.duration_s))
        if lasted(self.begun_ms, now_ms, whole_ms):
            return ()
        return rest_of(self.pieces, (now_ms - self.begun_ms) / 1000)


def room_m(daa: Daa, sensed: Sensed) -> float:
    """How far the vehicle may be off a way that it follows [m]."""
    return min((daa.buffer - 1) / 2 * daa.well_clear.dthr_m, OFF_S * sensed.motion.speed_m_s)


def scene_in_time(scene: Manoeuvres, daa: Daa, sensed: Sensed) -> Scene:
    """What a way is checked against: zones, with the own uncertainty and the deviation sideways as the margin; the buffered
    cylinder and the mission's own volume of each intruder.
    """
    here = scene.here
    wide_m, volumes = room_m(daa, sensed) + here.wide_m, (daa.well_clear,)
    return Scene(scene.zones, wide_m, scene.intruders, scene.volume, volumes, here.high_m)


def proposed(
    scene: Manoeuvres, daa: Daa, sensed: Sensed, points: tuple[Position, ...]
) -> Timed | None:
    """A permitted way to the first of the points, or else to the last; None if none is found."""
    motion, ability = sensed.motion, sensed.ability
    ability = ability._replace(turn_rate_rad_s=ability.turn_rate_rad_s / TURN_MARGIN)
    seen = scene_in_time(scene, daa, sensed)
    past_m = 2 * scene.volume.zthr_m
    layers = (motion.position.alt_m + past_m, motion.position.alt_m - past_m)
    for goal in dict.fromkeys((points[0], points[-1])):
        share_s = SHARE_S if goal == points[-1] else SHARE_S / 2
        found = way_in_time(Asked(motion, goal, ability, layers_m=layers), seen, share_s)
        if found.outcome is Outcome.PATH:
            return Timed(found.pieces, sensed.now_ms, found.rho_m)
    return None


def followed(timed: Timed, scene: Manoeuvres, daa: Daa, sensed: Sensed) -> Choice | None:
    """The velocity by which the vehicle follows a way now; None where it is over, the vehicle is too far off it, or
    what is left of it is not permitted against what is known now.
    """
    left = timed.left(sensed.now_ms)
    motion, ability = sensed.motion, sensed.ability
    here = motion.position
    if not left or not _follows(left[0].position, daa, sensed):
        return None
    checks = Checks(scene_in_time(scene, daa, sensed))
    keeps = all(checks.keeps_zones(p.position, after(p, p.duration_s)) for p in left)
    if not keeps or checks.first_met(left, timed.rho_m) is not None:
        return None
    ahead = rest_of(left, LEADS_S)[0].position
    north, east = ahead.north_m - here.north_m, ahead.east_m - here.east_m
    heading = math.atan2(east, north)
    least, most = ability.min_speed_m_s, ability.max_speed_m_s
    speed = min(max(math.hypot(north, east) / LEADS_S, least), most)
    steepest = ability.max_climb_m_s
    climb = min(max((ahead.alt_m - here.alt_m) / LEADS_S, -steepest), steepest)
    return Choice(KIND, heading, speed, climb, LEADS_S, True, None)


def _follows(there: Position, daa: Daa, sensed: Sensed) -> bool:
    """Whether the vehicle is as near to a place as a follower must be."""
    here = sensed.motion.position
    beside = Vec2(here.north_m - there.north_m, here.east_m - there.east_m)
    near = disc_within(beside, 0.0, room_m(daa, sensed))
    return bool(near and keeps_to(there, here, daa))
