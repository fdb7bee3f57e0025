"""Reports of ICAROUS's goal to UxAS, as the original's ICAROUS sends them: SETPOS while it flies straight to
a waypoint, and at a handback GOTOWP, the waypoint at which the plan continues, before SETMOD PASSIVE.
"""

from __future__ import annotations

import math

from cratous.bridge.text_protocol import Dialect, GoToWaypoint, Message, SetPosition, SetVelocity
from cratous.core.avoidance.manoeuvre import smallest_turn
from cratous.core.avoidance.way_ahead import near_line
from cratous.services.icarous.foresight import points_back
from cratous.services.icarous.messages import FromInstance, Sensed, Wish
from cratous.services.icarous.return_to_path import bearing_rad, flat
from cratous.services.icarous.state import State
from cratous.services.icarous_communication.steering import circle_m
from cratous.services.mission.frames import Projection
from cratous.spec.authority.cycle import OFFER

STRAIGHT_RAD = math.radians(0.5)
LEVEL_M = 1.0
SPEED_M_S = 0.5
"""A manoeuvre counts as straight flight to a place within these deviations of heading [rad], altitude [m] and
speed [m/s].
"""
CIRCLES = 4.0
"""SETPOS is used until the place is within this many radii of the autopilot's circle; within two, it would
circle.
"""


def onward(
    said: tuple[FromInstance, ...], state: State, sensed: Sensed, dialect: Dialect
) -> tuple[GoToWaypoint, ...]:
    """GOTOWP of the waypoint at which the free way back begins, if control is offered now and that is one of
    the plan's.

    None if UxAS has set a resume point between two waypoints, nor to the original's UxAS, which misreads the
    number.
    """
    offers = any(isinstance(one, Wish) and one.act == OFFER for one in said)
    told = state.told
    if not offers or not told.waypoints or dialect is Dialect.ORIGINAL:
        return ()
    begins = points_back(state, sensed)[0]
    ahead = range(min(told.next_index, len(told.waypoints) - 1), len(told.waypoints))
    return tuple(GoToWaypoint(k) for k in ahead if told.waypoints[k] == begins)[:1]


def steering(line: Message, state: State, sensed: Sensed, projection: Projection) -> Message:
    """The line to send to UxAS: SETPOS of the waypoint instead of SETVEL, where straight, level flight to it
    is free of conflict over the look-ahead and the vehicle would not circle there yet; otherwise the line
    itself.
    """
    choice, told, motion = state.held, state.told, sensed.motion
    if (
        not isinstance(line, SetVelocity)
        or choice is None
        or not choice.clear
        or not told.waypoints
    ):
        return line
    goal = told.waypoints[min(state.goal, len(told.waypoints) - 1)]
    here, there = flat(motion.position), flat(goal)
    off_rad = smallest_turn(choice.heading_rad, bearing_rad(motion.position, goal))
    if (
        abs(off_rad) > STRAIGHT_RAD
        or choice.climb_m_s
        or abs(goal.alt_m - motion.position.alt_m) > LEVEL_M
        or abs(choice.speed_m_s - motion.speed_m_s) > SPEED_M_S
        or near_line(here, there, there, CIRCLES * circle_m(motion.speed_m_s))
    ):
        return line
    lat, long = projection.to_geodetic(goal.north_m, goal.east_m)
    return SetPosition(lat, long, goal.alt_m)
