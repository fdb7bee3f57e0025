"""Guidance of ground and surface vehicles: along waypoints, to a stop, or on a given course.

`steer` follows the motion in each step; `mission` and `command` process what is received. All are pure:
Course in, Course out.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import radians
from typing import Any, NamedTuple

from cratous.services.simulator.driving import (
    Chassis,
    Leg,
    Point,
    bends,
    corner,
    leg_at,
)
from cratous.services.simulator.earth import bearing_rad, distance_m
from cratous.services.simulator.guidance import (
    DIRECTED,
    LOITER,
    NOTHING,
    WAYPOINT,
    Waypoint,
    waypoint_of,
)
from cratous.services.simulator.motion import Motion

NEAR_M = 0.2
"""Within this distance a place counts as reached [m]."""
LOOKED_MOST = 500
"""Most waypoints examined ahead for braking."""


class Stand(NamedTuple):
    """A stop: its place [rad], how long it lasts [s], 0: forever; how long it has lasted [s], -1: not there
    yet.
    """

    place: Point
    duration_s: float
    for_s: float = -1.0


class Course(NamedTuple):
    """mode; route: its waypoints by number; route_id, stand_id, directed_id: ids of the commands for them;
    start, to: of the present leg; limits: distances beyond `to` with the speed limits there [m, m/s];
    turn_m: distance before `to` at which the turn begins; stands: pending stops, the present or next one
    first; of_waypoint: whether they belong to `to`; held_m_s: speed that overrides the waypoints';
    heading_rad: of a given course; fired: payload actions to execute; done: those of `to` have been
    executed.
    """

    mode: str = WAYPOINT
    route: dict[int, Waypoint] = {}  # noqa: RUF012 - a value, never written to
    route_id: int = 0
    stand_id: int = 0
    directed_id: int | None = None
    start: Point = (0.0, 0.0)
    to: Waypoint | None = None
    limits: tuple[Point, ...] = ()
    turn_m: float = 0.0
    stands: tuple[Stand, ...] = ()
    of_waypoint: bool = False
    held_m_s: float | None = None
    heading_rad: float = 0.0
    fired: tuple[Any, ...] = ()
    done: bool = False


def place(w: Waypoint) -> Point:
    """Position of a waypoint."""
    return w.lat_rad, w.lon_rad


def mission(
    c: Course, body: Any, m: Motion, chassis: Chassis, told: Mapping[int, int] = NOTHING
) -> Course:
    """Execute a MissionCommand unchanged from its first waypoint on; without such a waypoint continue as
    before; without any, the mission is over.

    told: reported numbers of waypoints.
    """
    if not body.WaypointList:
        return c._replace(route={}, route_id=body.CommandID, directed_id=None)
    route: dict[int, Waypoint] = {}
    for w in body.WaypointList:
        route.setdefault(w.Number, waypoint_of(w, told))
    to = route.get(body.FirstWaypoint)
    if to is None:
        return c
    fresh = Course(route=route, route_id=body.CommandID, stand_id=body.CommandID, fired=c.fired)
    return _towards(fresh, (m.lat_rad, m.lon_rad), to, chassis)


def command(c: Course, body: Any, m: Motion, chassis: Chassis) -> Course:
    """Execute a VehicleActionCommand; payload actions are collected in `fired`."""
    c, here = c._replace(directed_id=None), (m.lat_rad, m.lon_rad)
    stood = c.stands
    c = c._replace(stands=())
    for one in body.VehicleActionList:
        kind = type(one).__name__
        if kind == "GoToWaypointAction":
            to = c.route.get(one.WaypointNumber)
            if to is not None:
                c = _towards(c._replace(mode=WAYPOINT, stands=()), here, to, chassis)
                stood = ()
        elif kind == "FlightDirectorAction":
            held = one.Speed or chassis.usual_m_s
            c = c._replace(mode=DIRECTED, heading_rad=radians(one.Heading), held_m_s=held,
                           directed_id=body.CommandID, stands=())  # fmt: skip
            stood = ()
        else:
            c = _action(c, one)
            if kind == "LoiterAction":
                c = c._replace(mode=LOITER, of_waypoint=False, start=here, stand_id=body.CommandID)
    if not c.stands:  # it is commanded nothing about its stop
        c = c._replace(stands=stood)
    return c


def _action(c: Course, body: Any) -> Course:
    kind = type(body).__name__
    if kind == "LoiterAction":
        at = radians(body.Location.Latitude), radians(body.Location.Longitude)
        return c._replace(stands=(*c.stands, Stand(at, body.Duration / 1000)))
    if kind == "SpeedOverrideAction":
        return c._replace(held_m_s=body.Speed)
    return c._replace(fired=(*c.fired, body))


def following(c: Course, w: Waypoint) -> Waypoint | None:
    """The waypoint after one; None if it is the last."""
    number = next(
        (a.WaypointNumber for a in w.actions if type(a).__name__ == "GoToWaypointAction"
         and a.WaypointNumber in c.route),
        w.next_number,
    )  # fmt: skip
    then = c.route.get(number)
    return None if then is None or then.number == w.number else then


def _towards(c: Course, start: Point, to: Waypoint, chassis: Chassis) -> Course:
    """Continue towards a waypoint from a place."""
    limits, turn_m = list[Point](), 0.0
    far = chassis.max_speed_m_s**2 / (2 * chassis.along_m_s2)
    before, at, along = start, to, 0.0
    for _ in range(LOOKED_MOST):
        then = following(c, at)
        stands = any(type(one).__name__ == "LoiterAction" for one in at.actions)
        speed = begins = 0.0
        if then is not None and not stands:
            turn = bearing_rad(*place(at), *place(then)) - bearing_rad(*before, *place(at))
            lengths = distance_m(*before, *place(at)), distance_m(*place(at), *place(then))
            speed, begins = corner(chassis, turn, *lengths) if lengths[0] else (0.0, 0.0)
        if at is to:
            turn_m = begins
        limits.append((along - begins, speed))
        if then is None or stands or along > far:
            break
        along += distance_m(*place(at), *place(then))
        before, at = place(at), then
    else:
        limits.append((along, 0.0))
    return c._replace(start=start, to=to, limits=tuple(limits), turn_m=turn_m, held_m_s=None,
                      done=False)  # fmt: skip


def steer(c: Course, m: Motion, chassis: Chassis, dt_s: float) -> tuple[Course, float, float]:
    """Guidance after a step of motion; commanded course [rad] and speed [m/s]."""
    if c.mode == DIRECTED:
        speed = chassis.within(c.held_m_s or 0.0)
        return c, c.heading_rad, min(speed, bends(chassis, m, c.heading_rad))
    if c.mode == LOITER:
        return _stand(c, m, chassis, dt_s)
    if c.to is None:
        return c, m.heading_rad, 0.0
    was = c.to
    leg = leg_at(c.start, place(was), m)
    if leg.left_m <= max(NEAR_M, c.turn_m):
        then = following(c, was)
        c = _reached(c, was, m)
        if c.mode == LOITER:
            return c, m.heading_rad, 0.0
        if then is None:  # it stops at its last waypoint
            return c, m.heading_rad, 0.0
        c = _towards(c, place(was), then, chassis)
        leg = leg_at(c.start, place(then), m)
    return c, leg.course_rad, _speed(c, leg, m, chassis)


def _reached(c: Course, to: Waypoint, m: Motion) -> Course:
    """Execute the actions of the reached waypoint, once."""
    if c.done:
        return c
    c = c._replace(done=True, stands=())
    for one in to.actions:
        c = c if type(one).__name__ == "GoToWaypointAction" else _action(c, one)
    if not c.stands:
        return c
    return c._replace(mode=LOITER, of_waypoint=True, start=(m.lat_rad, m.lon_rad))


def _speed(c: Course, leg: Leg, m: Motion, chassis: Chassis) -> float:
    """Speed along the leg [m/s]: as commanded, as far as it can still brake for what is ahead."""
    asked = c.held_m_s
    if asked is None:
        asked = c.to.speed_m_s if c.to is not None else 0.0
    speed = chassis.within(asked if asked > 0 else chassis.usual_m_s)
    for beyond_m, most in c.limits:
        speed = min(speed, chassis.still_from(most, leg.left_m + beyond_m))
    return min(speed, bends(chassis, m, leg.course_rad))


def _stand(c: Course, m: Motion, chassis: Chassis, dt_s: float) -> tuple[Course, float, float]:
    """Drive to the place of the stop and stay there for its duration; then continue, if it belongs to a
    waypoint.
    """
    stand, *rest = c.stands
    if stand.for_s < 0:
        leg = leg_at(c.start, stand.place, m)
        if leg.left_m > NEAR_M:
            speed = min(chassis.within(chassis.usual_m_s), chassis.still_from(0.0, leg.left_m))
            return c, leg.course_rad, min(speed, bends(chassis, m, leg.course_rad))
        stand = stand._replace(for_s=0.0)
    elif m.airspeed_m_s == 0:
        stand = stand._replace(for_s=stand.for_s + dt_s)
    c = c._replace(stands=(stand, *rest))
    over = 0 < stand.duration_s < stand.for_s
    if over and rest:
        c = c._replace(stands=tuple(rest), start=(m.lat_rad, m.lon_rad))
    elif over and c.of_waypoint and c.to is not None:
        then = following(c, c.to)
        c = c._replace(mode=WAYPOINT, stands=())
        if then is not None:
            c = _towards(c, (m.lat_rad, m.lon_rad), then, chassis)
    return c, m.heading_rad, 0.0
