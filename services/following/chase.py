"""A chase: the way of a vehicle from its present position to its circle about a moving entity, at its greatest speed.

Offered beside the way at the usual speed, which may be flown from anywhere. It is predicted as that one is.
"""

from __future__ import annotations

import math
from dataclasses import replace

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.core.requirements.verdict import reaches
from cratous.core.routing.dubins import cut, cut_length_m, dubins, pose_after
from cratous.core.routing.loiter_discs import broken_by
from cratous.core.tasks.stations import in_ring, outruns
from cratous.services.following.meeting import Look, first_met
from cratous.services.following.motion import Motion
from cratous.services.following.stations import Station, station
from cratous.services.following.task_parameters import Asked
from cratous.services.mission.landing import MAX_ACCELERATION_M_S2
from cratous.services.pipeline.contexts import Context
from cratous.services.planning.options import Option, hold_rooms
from cratous.services.planning.performance_classes import flight_ms
from cratous.spec.mission import Position, Vehicle
from cratous.spec.mission.plan import Pose

CHASE = ", chased"
"""The end of the label of a chase."""
CHASED = ("WatchTask", "MultiVehicleWatchTask", "BlockadeTask")
"""The kinds of tasks for which a chase is offered."""
FASTER = 1.05
"""Least ratio of a vehicle's greatest speed to its usual one for which a chase is offered."""
LEAD_S = 3.0
"""A chase begins this far ahead of its vehicle [s]: a state of the vehicle arrives before it is there."""
SETTLED_S = 0.5
"""A chase takes as long as until its circle is where it ends, to within this [s]; a way that jumps may not."""


def is_chase(option: Option) -> bool:
    """Whether an option is a chase."""
    return option.label.endswith(CHASE)


def slot_of(option: Option) -> int:
    """The slot of an option, from 0."""
    return int(option.label.removeprefix("slot ").removesuffix(CHASE)) - 1


def speed_of(option: Option, vehicle: Vehicle) -> float:
    """The speed at which a vehicle flies an option to its circle [m/s]."""
    return vehicle.max_speed_m_s if is_chase(option) else option.flyer.speed_m_s


def slows_down_m(option: Option, vehicle: Vehicle) -> float:
    """Distance from the rim of its circle within which a vehicle that chases is told its usual speed [m]: enough to
    slow down to it, so that it does not swing out of its circle, which is as wide as a turn at the usual speed.
    """
    fast, usual = vehicle.max_speed_m_s, option.flyer.speed_m_s
    return max(option.flyer.radius_m, (fast**2 - usual**2) / (2 * MAX_ACCELERATION_M_S2))


def chase(
    context: Context, asked: Asked, motion: Motion, usual: Option, vehicle: Vehicle
) -> Option | None:
    """A vehicle's chase to the circle of its option at the usual speed; None where none is of use or possible: no
    higher speed, an entity that stands or is no slower, a circle too near, zones in the way, or another kind of task.

    Its turns are wide enough for its speed.
    """
    flyer, fast = usual.flyer, vehicle.max_speed_m_s
    moves = motion.velocity != (0.0, 0.0) and outruns(motion.velocity, fast)
    faster = outruns(Vec2(FASTER * flyer.speed_m_s, 0.0), fast)
    if asked.kind not in CHASED or not moves or not faster:
        return None
    begin = context.inputs.starts[vehicle.id]._replace(alt_m=flyer.alt_m)
    gate = pose_after(begin, 0, LEAD_S * flyer.speed_m_s, 1.0)
    wide_m, slow_m = flyer.radius_m * (fast / flyer.speed_m_s) ** 2, slows_down_m(usual, vehicle)
    zones, terrain_m = context.inputs.zones, context.inputs.mission.frame.terrain_m
    here = Vec2(*gate[:2])

    def circle(seconds: float) -> tuple[Station, Pose]:
        """The circle so long after the chase begins [s], and where its rim is reached, heading for the centre."""
        there = motion._replace(at=motion.after(LEAD_S + seconds))
        goal = station(asked, slot_of(usual), flyer, there, terrain_m)
        heading = math.atan2(goal.at.y - here.y, goal.at.x - here.x)
        middle = Pose(*goal.at, flyer.alt_m, heading)
        return goal, pose_after(middle, 0, -goal.radius_m, 1.0)

    def look(seconds: float) -> Look:
        way_m = cut_length_m(dubins(gate, circle(seconds)[1], wide_m))
        last_m = min(way_m, slow_m)
        left_s = (way_m - last_m) / fast + last_m / flyer.speed_m_s - seconds
        return Look(not reaches(0.0, left_s), left_s)

    if _near(here, circle(0.0)[0], wide_m):
        return None
    seconds = first_met(look, look(0.0).by)
    if seconds is None or abs(look(seconds).by) > SETTLED_S:
        return None
    goal, rim = circle(seconds)
    path = tuple(cut(dubins(gate, rim, wide_m), rim))
    if _near(here, goal, wide_m):
        return None
    if broken_by(Position(*goal.at, flyer.alt_m), goal.radius_m, zones) is not None:
        return None
    if first_bad_leg(path, zones) is not None:
        return None
    lasts = max(asked.least_ms, flight_ms(seconds, 1.0))
    return replace(
        usual, start=gate, end=rim, path=path, duration_ms=lasts, label=usual.label + CHASE,
        holds=hold_rooms(gate, flyer.radius_m, zones),
    )  # fmt: skip


def _near(here: Vec2, goal: Station, wide_m: float) -> bool:
    """Whether a circle is so near that there is no room to turn to it, and to chase."""
    return in_ring(goal.at, here, 0, goal.radius_m + 2 * wide_m)
