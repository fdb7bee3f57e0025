"""MissionCommands as ICAROUS is told them, where a vehicle leaves its way, and how it is sent on.

A vehicle that has left its way by more than is allowed comes back to where it left it, so that the sensor
misses nothing; one that has stayed near makes for the waypoint that it was making for.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.core.avoidance.manoeuvre import Motion
from cratous.core.avoidance.way_ahead import near_line
from cratous.core.kernel import Vec2
from cratous.core.routing.polylines import Track
from cratous.services.icarous.return_to_path import onto, rejoin
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Position

START = -1
"""The number of the place where a vehicle was when it got a plan; no command bears it."""


class Plan(NamedTuple):
    """A MissionCommand in force.

    command: as it was given; waypoints: in the order of flight, before them the place where the vehicle was
    (START) if that is known, and a way back; where each is, and which point of the track it is; goal: index
    of the one that the vehicle makes for; since_ms: given at; settled: the vehicle flies it; back: index of
    the last that is none of the mission's (-1: they all are); resume: where it comes back to its way, if
    that is where it was left; told: point of the track with which what is told to its ICAROUS begins; begun: tasks
    that were being done when the way back began.
    """

    command: Any
    waypoints: tuple[Any, ...]
    positions: tuple[Position, ...]
    marks: tuple[int, ...]
    track: Track
    goal: int
    since_ms: int
    settled: bool = False
    back: int = -1
    resume: Position | None = None
    told: int = 0
    begun: tuple[int, ...] = ()

    @property
    def speed_m_s(self) -> float:
        """Planned on it [m/s]."""
        return float(self.waypoints[0].Speed)


def part(plan: Plan, most: int | None) -> tuple[Position, ...]:
    """The part of a plan that is sent to a peer: all of it, or from `told` on as much as the peer can hold."""
    points = plan.track.points[plan.told :]
    return points if most is None else points[:most]


def next_part(plan: Plan, most: int, spare: int) -> Plan:
    """The plan as it is to be told, when the vehicle has no more than `spare` points of its part ahead: from
    the point that it has passed last; the same plan otherwise, and where the part holds the end already."""
    at = plan.marks[plan.goal]
    if plan.told + most - at > spare or plan.told + most >= len(plan.track.points):
        return plan
    return plan._replace(told=max(at - 1, 0))


def being_done(plan: Plan | None, tasks: Iterable[int]) -> tuple[int, ...]:
    """Those of the tasks of a state that the vehicle does, and is not still on its way to.

    A task begins at the first waypoint of the way that bears its number in AssociatedTasks; states bear it already while
    that waypoint is made for. Of a task of no waypoint that is known nothing tells where it begins: it is being done.
    """
    if plan is None:
        return tuple(tasks)
    own = range(plan.back + 1, len(plan.waypoints))

    def begun(task: int) -> bool:
        bears = next((k for k in own if task in plan.waypoints[k].AssociatedTasks), None)
        return bears is None or task in plan.begun or bears in range(plan.goal)

    return tuple(task for task in tasks if begun(task))


def begun_with(plan: Plan | None, tasks: tuple[int, ...]) -> Plan | None:
    """A plan that may be a part of a way, as it begins within these tasks."""
    return None if plan is None else plan._replace(begun=tasks)


class Away(NamedTuple):
    """ICAROUS commands a vehicle. left: where its way was left; tasks: that it was doing then; paused:
    it is farther from its leg than is allowed, and these tasks are told to pause; proposed: the way of UxAS's
    planner onto which its ICAROUS hands back, none: the direct one; waypoint: of the way told, that ICAROUS goes on with."""

    left: Position
    tasks: tuple[int, ...]
    paused: bool = False
    proposed: tuple[Position, ...] = ()
    waypoint: int | None = None


def position_of(place: Any, projection: Projection) -> Position:
    """A place (a Location3D or a Waypoint) in the plane."""
    north_m, east_m = projection.to_local(place.Latitude, place.Longitude)
    return Position(north_m, east_m, float(place.Altitude))


def plan_of(
    command: Any, projection: Projection, now_ms: int, here: Position | None
) -> Plan | None:
    """The way of a MissionCommand, from its first waypoint each to the next that it names; a way that
    leads back into itself is told once around. None if it has no waypoints. here: where the vehicle is."""
    known = {w.Number: w for w in command.WaypointList}
    if not known:
        return None
    number, order = command.FirstWaypoint, list[Any]()
    if number not in known:
        number = next(iter(known))
    while number in known:
        order.append(known.pop(number))
        number = order[-1].NextWaypoint
    if here is not None:
        order.insert(0, _at(order[0], here, projection, START, order[0].Number))
    positions = tuple(position_of(w, projection) for w in order)
    track = Track(positions)
    start = 0 if here is None else 1
    back = start - 1
    return Plan(
        command, tuple(order), positions, _marks(positions), track, start, now_ms, back=back
    )


def begins_as(plan: Plan | None, told: Plan | None) -> bool:
    """True if a vehicle that flies a plan, and has passed nothing of it, is given the same way again."""
    return (
        plan is not None
        and told is not None
        and (told.goal, told.told) == (plan.goal, plan.told)
        and _legs(plan) == _legs(told)
    )


def _legs(plan: Plan) -> list[tuple[float, ...]]:
    """What makes the way of a plan, from its first waypoint on."""
    found = plan.waypoints[plan.goal :]
    return [(w.Number, w.Latitude, w.Longitude, w.Altitude, w.Speed) for w in found]


def shown(plan: Plan, number: int, long_enough: bool) -> Plan:
    """The plan with the waypoint that the vehicle says it makes for.

    As long as it does not show this plan's first waypoint, its number may be one of a former plan: that
    is over when it has had long_enough.
    """
    settled = plan.settled or long_enough or number == plan.waypoints[plan.goal].Number
    numbers = [w.Number for w in plan.waypoints]
    if not settled or number not in numbers[plan.goal :]:
        return plan._replace(settled=settled)
    return plan._replace(settled=True, goal=numbers.index(number, plan.goal))


def deviates(plan: Plan, here: Position, allowed_m: float) -> bool:
    """True iff the vehicle is farther than allowed from the leg that it is flying; before the first
    waypoint it has none."""
    if plan.goal == 0:
        return False
    a, b = plan.positions[plan.goal - 1], plan.positions[plan.goal]
    return not near_line(_flat(here), _flat(a), _flat(b), allowed_m)


def resume_point(plan: Plan, left: Position) -> Position | None:
    """Where a vehicle that was too far from its way comes back to it: the nearest place of its leg to where
    it left it; on a way back, where that leads. None: to the waypoint that it makes for."""
    if plan.goal <= plan.back:
        return plan.resume
    if plan.goal == 0:
        return None
    leg = Track(plan.positions[plan.goal - 1 : plan.goal + 1])
    return leg.at(leg.nearest(left, 0.0, leg.length_m).s_m)


def going_on(plan: Plan, away: Away) -> Plan:
    """The plan as it makes for the waypoint with which ICAROUS goes on; the same plan where the way is resumed at
    another place, or a waypoint with actions or tasks would be left out."""
    goals = [k for k, mark in enumerate(plan.marks) if mark == away.waypoint]
    if not goals or away.paused or away.proposed or plan.goal <= plan.back:
        return plan
    left_out = plan.waypoints[plan.goal : goals[0]]
    if any(w.VehicleActionList or w.AssociatedTasks for w in left_out):
        return plan
    return plan._replace(goal=max(plan.goal, goals[0]))


class Resumed(NamedTuple):
    """command: for the autopilot; back: how many waypoints its way back has; resume: as in `Plan`."""

    command: Any
    back: int
    resume: Position | None


def resumed(
    plan: Plan, away: Away, now: Motion, radius_m: float, projection: Projection, command_id: int
) -> Resumed:
    """What sends a vehicle on: the shortest flyable way, or that of UxAS's planner, which ICAROUS has found free, onto
    its own way.

    radius_m: of its turns.
    """
    again = away.paused or plan.goal <= plan.back
    resume = resume_point(plan, away.left) if again else None
    goal = max(plan.goal, plan.back + 1)
    onward = plan.positions[goal : goal + 2]
    if resume is not None:
        onward = (resume, *onward)
    if away.proposed:
        led = onto(away.proposed, now, radius_m)
        beyond = led[1] if len(led) > 1 else onward[1] if len(onward) > 1 else None
        way = (*rejoin(now, radius_m, led[0], beyond)[1:], *led[1:])
    else:
        way = rejoin(now, radius_m, onward[0], onward[1] if len(onward) > 1 else None)[1:]
    if resume is None:
        way = way[:-1]  # the last is the waypoint itself
    following, points = plan.waypoints[goal], list(plan.command.WaypointList)
    first = 1 + max(w.Number for w in points)
    numbers = [*range(first, first + len(way)), following.Number]
    for k, place in enumerate(way):
        points.append(_at(following, place, projection, numbers[k], numbers[k + 1]))
    command = plan.command.copy(CommandID=command_id, FirstWaypoint=numbers[0], WaypointList=points)
    return Resumed(command, len(way), resume)


def leading_back(plan: Plan, away: Away, sent: Resumed, way: Plan | None) -> Plan | None:
    """The plan of a way back, as it is flown after `plan`: the mission's own command is what the next way back leads to."""
    if way is None:
        return None
    return way._replace(command=plan.command, back=sent.back, resume=sent.resume, begun=away.tasks)


def _at(waypoint: Any, place: Position, projection: Projection, number: int, following: int) -> Any:
    """A waypoint like another one at another place."""
    latitude, longitude = projection.to_geodetic(place.north_m, place.east_m)
    return waypoint.copy(
        Number=number,
        NextWaypoint=following,
        Latitude=latitude,
        Longitude=longitude,
        Altitude=place.alt_m,
        VehicleActionList=[],
    )


def _marks(positions: tuple[Position, ...]) -> tuple[int, ...]:
    """Which point of their `Track` each place is; places that are one are one point of it."""
    marks = [0]
    for a, b in itertools.pairwise(positions):
        apart_m = math.hypot(b.north_m - a.north_m, b.east_m - a.east_m)
        marks.append(marks[-1] + (apart_m > 1e-6))
    return tuple(marks)


def _flat(p: Position) -> Vec2:
    return Vec2(p.north_m, p.east_m)
