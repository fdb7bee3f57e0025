"""Guidance of one aircraft: along waypoints, around loiters, or on a given course.

`guide` follows the motion in each step; `mission`, `action` and `command` process what is received. All are
pure: Guidance in, Guidance out. In compatibility mode AMASE's defects are reproduced, each commented where it
occurs.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot, inf, pi, radians, tan
from types import MappingProxyType
from typing import Any, NamedTuple

from cratous.services.simulator.earth import bearing_rad, bound_pi, distance_m, to_leg
from cratous.services.simulator.loiter import (
    HOVER,
    HOVER_GAIN_S,
    Loiter,
    course,
    first_corner,
    loiter_of,
)
from cratous.services.simulator.motion import GRAVITY_M_S2, Command, Motion

NOTHING: Mapping[int, int] = MappingProxyType({})
DIRECTED, WAYPOINT, LOITER = "FlightDirector", "Waypoint", "Loiter"


class Waypoint(NamedTuple):
    """number, number of the next; position [rad, m MSL], airspeed [m/s], whether it is flown over; actions
    and task ids as in the message.
    """

    number: int
    next_number: int
    lat_rad: float
    lon_rad: float
    alt_m: float
    speed_m_s: float
    fly_over: bool
    actions: tuple[Any, ...]
    tasks: tuple[int, ...]


class Leg(NamedTuple):
    """The waypoint flown to, those before and after it, and their geometry: bearing [rad] and length [m] of
    the leg to it, bearing from the next one to it, and that distance.
    """

    to: Waypoint | None = None
    past: Waypoint | None = None
    then: Waypoint | None = None
    bearing_rad: float = 0.0
    length_m: float = 0.0
    back_rad: float = 0.0
    then_m: float = 0.0


class Guidance(NamedTuple):
    """mode; command; route: its waypoints by number, None without one; route_id, loiter_id, directed_id: ids
    of the commands for them; leg; loiters: pending ones; loiter: the present one, loiter_s: its duration
    so far [s], corner: its present corner (-1 before the first); at_waypoint: whether it belongs to a
    waypoint; fired: payload actions of reached waypoints; compatible: AMASE's defects are reproduced.
    """

    command: Command
    compatible: bool
    min_speed_m_s: float
    mode: str = DIRECTED
    route: dict[int, Waypoint] | None = None
    route_id: int = 0
    loiter_id: int = 0
    directed_id: int | None = None
    leg: Leg = Leg()
    loiters: tuple[Loiter, ...] = ()
    loiter: Loiter | None = None
    loiter_s: float = 0.0
    corner: int = -1
    at_waypoint: bool = False
    fired: tuple[Any, ...] = ()


def mission(g: Guidance, body: Any, told: Mapping[int, int] = NOTHING) -> Guidance:
    """Fly a MissionCommand from its first waypoint on. told: reported numbers of waypoints.

    Without waypoints the mission is over: who circles goes on circling, without end; all others keep their course.
    """
    if not body.WaypointList:
        return g if g.compatible else _over(g, body.CommandID)
    route: dict[int, Waypoint] = {}
    for w in body.WaypointList:
        # of waypoints with the same number the first one counts
        route.setdefault(w.Number, waypoint_of(w, told))
    g = g._replace(
        mode=WAYPOINT,
        route=route,
        route_id=body.CommandID,
        loiter_id=body.CommandID,
        directed_id=None,
        leg=Leg(),
        loiters=(),
        loiter=None,
    )
    g = advance(g, body.FirstWaypoint)
    return g if g.leg.to is not None else g._replace(mode=DIRECTED)


def _over(g: Guidance, number: int) -> Guidance:
    """Guidance without a route, by a command of this number."""
    g = g._replace(
        route=None, route_id=number, directed_id=None, leg=Leg(), loiters=(), at_waypoint=False
    )
    if g.mode == LOITER and g.loiter is not None:
        return g._replace(loiter=g.loiter._replace(duration_s=0.0), loiter_id=number)
    return g._replace(mode=DIRECTED, loiter=None)


def waypoint_of(w: Any, told: Mapping[int, int] = NOTHING) -> Waypoint:
    """A Waypoint of a message."""
    return Waypoint(
        told.get(w.Number, w.Number),
        w.NextWaypoint,
        radians(w.Latitude),
        radians(w.Longitude),
        w.Altitude,
        w.Speed,
        w.TurnType.name == "FlyOver",
        tuple(w.VehicleActionList),
        tuple(w.AssociatedTasks),
    )


def advance(g: Guidance, number: int) -> Guidance:
    """Continue to the waypoint of a number: the actions of the reached one are executed.

    Without such a waypoint the aircraft keeps its present one.
    """
    old = g.leg
    again = old.to is not None and old.to.number == number
    if old.to is not None and not (again and not g.compatible and old.past is old.to):
        for one in old.to.actions:
            g = action(g, one)
    to = (g.route or {}).get(number)
    past = old.past if to is old.to else old.to
    then = None if to is None else (g.route or {}).get(to.next_number)
    if to is None:
        to = past
    if to is None:
        return g._replace(leg=Leg())
    leg = Leg(to, past, then, old.bearing_rad, old.length_m, old.back_rad, old.then_m)
    if past is not None:
        ends = past.lat_rad, past.lon_rad, to.lat_rad, to.lon_rad
        leg = leg._replace(bearing_rad=bearing_rad(*ends), length_m=distance_m(*ends))
    if then is not None:
        ends = then.lat_rad, then.lon_rad, to.lat_rad, to.lon_rad
        leg = leg._replace(back_rad=bearing_rad(*ends), then_m=distance_m(*ends))
    g = g._replace(leg=leg)
    return _of_waypoint(g) if g.compatible or g.mode == WAYPOINT else g


def _of_waypoint(g: Guidance) -> Guidance:
    """Apply altitude and speed of the waypoint flown to."""
    to = g.leg.to
    if to is None:
        return g
    return g._replace(command=g.command._replace(alt_m=to.alt_m, speed_m_s=to.speed_m_s))


def command(g: Guidance, body: Any) -> Guidance:
    """Execute a VehicleActionCommand; payload actions are collected in `fired`."""
    g = g._replace(directed_id=None)
    kinds = [type(one).__name__ for one in body.VehicleActionList]
    if "LoiterAction" in kinds:
        g = g._replace(loiters=(), loiter=None, loiter_id=body.CommandID)
    for one, kind in zip(body.VehicleActionList, kinds, strict=True):
        if kind == "GoToWaypointAction":
            g = _go_to(g, one.WaypointNumber)
            if g.compatible and "LoiterAction" not in kinds:
                # AMASE switches to a loiter that does not exist, and flies straight on
                g = g._replace(mode=LOITER, loiters=(), loiter=None)
            continue
        g = action(g, one)
        if kind == "LoiterAction":
            g = g._replace(at_waypoint=False)
        elif kind == "FlightDirectorAction":
            g = g._replace(directed_id=body.CommandID, loiters=(), loiter=None)
    return g


def _go_to(g: Guidance, number: int) -> Guidance:
    """Fly straight to a waypoint of the route; without such a waypoint continue as before."""
    if g.route is None or (number not in g.route and not g.compatible):
        return g
    g = g._replace(mode=WAYPOINT, leg=Leg())
    if not g.compatible:
        g = g._replace(loiters=(), loiter=None)
    return advance(g, number)


def action(g: Guidance, body: Any) -> Guidance:
    """Execute one action, of a command or of a reached waypoint."""
    kind = type(body).__name__
    if kind == "LoiterAction":
        loiter = loiter_of(body, g.min_speed_m_s, g.compatible)
        g = g._replace(loiters=(*g.loiters, loiter), at_waypoint=True)
        if g.mode != LOITER:
            g = _leave_waypoints(g, LOITER)
        elif not g.at_waypoint:
            g = g._replace(loiter=None)
        return g
    if kind == "FlightDirectorAction":
        c = g.command
        c = Command(
            radians(body.Heading),
            body.Altitude or c.alt_m,
            body.Speed or c.speed_m_s,
            body.ClimbRate,
        )
        return g._replace(mode=DIRECTED, command=c)
    if kind == "SpeedOverrideAction":
        return g._replace(command=g.command._replace(speed_m_s=body.Speed))
    if kind == "GoToWaypointAction":
        return g
    return g._replace(fired=(*g.fired, body))


def _leave_waypoints(g: Guidance, mode: str) -> Guidance:
    """AMASE keeps the vertical speed of the waypoint flown to, and climbs or descends without end."""
    if not g.compatible:
        g = g._replace(command=g.command._replace(climb_m_s=0.0))
    return g._replace(mode=mode)


def guide(g: Guidance, m: Motion, max_bank_rad: float, dt_s: float) -> Guidance:
    """Guidance after a step of motion."""
    if g.mode == WAYPOINT:
        g = _follow(g, m, max_bank_rad)
    if g.mode == LOITER:
        g = _loiter(g, m, dt_s)
    return g


def _follow(g: Guidance, m: Motion, max_bank_rad: float) -> Guidance:
    to = g.leg.to
    if to is None:
        return g
    lat, lon = m.lat_rad, m.lon_rad
    away = distance_m(lat, lon, to.lat_rad, to.lon_rad)
    away = hypot(away, to.alt_m - m.alt_m)
    azimuth = bearing_rad(lat, lon, to.lat_rad, to.lon_rad)
    radius = m.airspeed_m_s**2 / (GRAVITY_M_S2 * tan(max_bank_rad))
    if reached(g.leg, away, azimuth, m.heading_rad, radius):
        g = _next(g, to)
        if not g.compatible and g.mode != WAYPOINT:
            return g
        wanted = g.command.course_rad
    else:
        wanted = azimuth
    leg = g.leg
    if leg.past is not None and leg.to is not None and leg.length_m >= radius:
        wanted = _onto_leg(leg.past, leg.to, leg.bearing_rad, lat, lon, 2 * radius)
    _, alt_m, speed_m_s, climb = g.command
    if away != 0:
        climb = (alt_m - m.alt_m) / away * m.airspeed_m_s
    return Guidance(Command(wanted, alt_m, speed_m_s, climb), *g[1:])


def _next(g: Guidance, to: Waypoint) -> Guidance:
    """Continue after a reached waypoint: its actions, then the next one."""
    if not g.compatible:
        if to.next_number == to.number and g.leg.past is to:
            return g  # the last one: its actions have been executed
        for one in to.actions:
            if type(one).__name__ == "GoToWaypointAction" and one.WaypointNumber in (g.route or {}):
                return advance(g, one.WaypointNumber)
    return advance(g, to.next_number)


def reached(
    leg: Leg, away_m: float, azimuth_rad: float, heading_rad: float, radius_m: float
) -> bool:
    """Whether the waypoint of a leg counts as reached, so that the next one is flown to.

    away_m, azimuth_rad: of the waypoint from the aircraft; radius_m: of its tightest turn. Fly-over: when it
    is closer than the radius and lies behind. Otherwise: when the turn onto the next leg has to begin, at
    most two radii before it.
    """
    if leg.to is None:
        return False
    if leg.to.fly_over or leg.then is None:
        behind = abs(bound_pi(heading_rad - azimuth_rad)) > pi / 2
        return away_m < radius_m and behind
    turn = 0.0 if leg.then_m < radius_m else leg.back_rad - azimuth_rad
    half = tan(turn / 2)
    begins_m = abs(radius_m / half) if half else inf
    return away_m < min(begins_m, 2 * radius_m)


def _onto_leg(
    past: Waypoint, to: Waypoint, bearing: float, lat: float, lon: float, limit_m: float
) -> float:
    """Course onto a leg: straight at it from afar, increasingly along it nearby."""
    start, end = (past.lat_rad, past.lon_rad), (to.lat_rad, to.lon_rad)
    off_m, side = to_leg(start, end, lat, lon)
    if off_m > limit_m:
        return side
    return bound_pi(side + bound_pi(bearing - side) * (1 - (off_m / limit_m if limit_m else 0)))


def _loiter(g: Guidance, m: Motion, dt_s: float) -> Guidance:
    loiter = g.loiter
    if loiter is None:
        if not g.loiters:
            return g
        loiter = g.loiters[0]
        c = g.command._replace(alt_m=loiter.alt_m, speed_m_s=loiter.speed_m_s)
        g = g._replace(loiter=loiter, loiters=g.loiters[1:], loiter_s=0.0, corner=-1, command=c)
    if g.loiter_s > loiter.duration_s > 0:
        g = g._replace(loiter=None, loiter_s=0.0)
        if g.at_waypoint and not (g.loiters and not g.compatible):
            g = g._replace(mode=WAYPOINT)
            # AMASE continues at altitude and speed of the loiter
            return g if g.compatible else _of_waypoint(g)
        return g
    corner = g.corner
    if corner < 0:
        corner = first_corner(loiter, m.lat_rad, m.lon_rad, g.compatible)
    wanted, corner = course(loiter, corner, m.lat_rad, m.lon_rad)
    _, alt_m, speed_m_s, climb_m_s = g.command
    if loiter.kind == HOVER:
        away = distance_m(m.lat_rad, m.lon_rad, *loiter.points[0])
        speed_m_s = min(loiter.speed_m_s, HOVER_GAIN_S * away)
    # by place, since _replace takes as long as all the rest here
    c = Command(wanted, alt_m, speed_m_s, climb_m_s)
    return Guidance(c, *g[1:11], g.loiter_s + dt_s, corner, *g[13:])
