"""MissionCommands as routes for ICAROUS, deviations from them, and the way back after a handback.

A vehicle that has deviated by more than is allowed returns to where it left its route, so that no coverage is
lost; one that has stayed close continues to its next waypoint.
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
"""Number of the added waypoint where a vehicle was when it received a plan; no command uses it."""


class Plan(NamedTuple):
    """A MissionCommand in force.

    command: as received; waypoints: in flight order, preceded by the vehicle's place at that time (START), if
    known, and a way back; positions, marks: place of each, and its point of the track; goal: index of the
    next waypoint; since_ms: when it was received; settled: whether the vehicle flies it; back: index of the
    last waypoint that is not the mission's (-1: none); resume: where it rejoins its route, if that is where
    it was left; told: first point of the track in the part sent to its ICAROUS; begun: tasks in progress when
    the way back began.
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
        """Planned speed [m/s]."""
        return float(self.waypoints[0].Speed)


def part(plan: Plan, most: int | None) -> tuple[Position, ...]:
    """The part of a plan that is sent to a peer: all of it, or at most `most` points from `told` on."""
    points = plan.track.points[plan.told :]
    return points if most is None else points[:most]


def next_part(plan: Plan, most: int, spare: int) -> Plan:
    """The plan with the next part to send, from the point passed last, if the vehicle has at most `spare`
    points of the present part ahead; otherwise, or if that part contains the end, the plan itself.
    """
    at = plan.marks[plan.goal]
    if plan.told + most - at > spare or plan.told + most >= len(plan.track.points):
        return plan
    return plan._replace(told=max(at - 1, 0))


def being_done(plan: Plan | None, tasks: Iterable[int]) -> tuple[int, ...]:
    """The tasks in progress, of those that a state lists.

    A task begins at the first waypoint that names it in AssociatedTasks; states list it already on the way
    there. A task that no known waypoint names counts as in progress.
    """
    if plan is None:
        return tuple(tasks)
    own = range(plan.back + 1, len(plan.waypoints))

    def begun(task: int) -> bool:
        bears = next((k for k in own if task in plan.waypoints[k].AssociatedTasks), None)
        return bears is None or task in plan.begun or bears in range(plan.goal)

    return tuple(task for task in tasks if begun(task))


def begun_with(plan: Plan | None, tasks: tuple[int, ...]) -> Plan | None:
    """The plan with the tasks in progress at its beginning."""
    return None if plan is None else plan._replace(begun=tasks)


class Away(NamedTuple):
    """ICAROUS has a vehicle. left: where its route was left; tasks: in progress then; paused: it has deviated
    more than is allowed and these tasks were paused; proposed: route of UxAS's planner on which ICAROUS
    hands back, () for the direct one; waypoint: index of the waypoint with which ICAROUS continues.
    """

    left: Position
    tasks: tuple[int, ...]
    paused: bool = False
    proposed: tuple[Position, ...] = ()
    waypoint: int | None = None


def position_of(place: Any, projection: Projection) -> Position:
    """The position of a Location3D or Waypoint in the local plane."""
    north_m, east_m = projection.to_local(place.Latitude, place.Longitude)
    return Position(north_m, east_m, float(place.Altitude))


def plan_of(
    command: Any, projection: Projection, now_ms: int, here: Position | None
) -> Plan | None:
    """The route of a MissionCommand, following NextWaypoint from its first waypoint; a loop is flown once.
    None without waypoints. here: the vehicle's position.
    """
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
    """Whether a vehicle that has passed none of a plan's waypoints is given the same route again."""
    return (
        plan is not None
        and told is not None
        and (told.goal, told.told) == (plan.goal, plan.told)
        and _legs(plan) == _legs(told)
    )


def _legs(plan: Plan) -> list[tuple[float, ...]]:
    """What identifies the route of a plan from its next waypoint on."""
    found = plan.waypoints[plan.goal :]
    return [(w.Number, w.Latitude, w.Longitude, w.Altitude, w.Speed) for w in found]


def shown(plan: Plan, number: int, long_enough: bool) -> Plan:
    """The plan with the waypoint that the vehicle reports as its next.

    Until the vehicle reports this plan's first waypoint, the number may belong to an earlier plan, unless it
    has had long_enough to switch.
    """
    settled = plan.settled or long_enough or number == plan.waypoints[plan.goal].Number
    numbers = [w.Number for w in plan.waypoints]
    if not settled or number not in numbers[plan.goal :]:
        return plan._replace(settled=settled)
    return plan._replace(settled=True, goal=numbers.index(number, plan.goal))


def deviates(plan: Plan, here: Position, allowed_m: float) -> bool:
    """Whether the vehicle is farther from its present leg than allowed; before the first waypoint there is no
    leg.
    """
    if plan.goal == 0:
        return False
    a, b = plan.positions[plan.goal - 1], plan.positions[plan.goal]
    return not near_line(_flat(here), _flat(a), _flat(b), allowed_m)


def resume_point(plan: Plan, left: Position) -> Position | None:
    """Where a vehicle that deviated too far rejoins its route: the point of its leg nearest to where it left;
    on a way back, that way's resume point. None: at its next waypoint.
    """
    if plan.goal <= plan.back:
        return plan.resume
    if plan.goal == 0:
        return None
    leg = Track(plan.positions[plan.goal - 1 : plan.goal + 1])
    return leg.at(leg.nearest(left, 0.0, leg.length_m).s_m)


def going_on(plan: Plan, away: Away) -> Plan:
    """The plan with the waypoint at which ICAROUS continues as its next; unchanged if the route is resumed
    elsewhere, or if a waypoint with actions or tasks would be skipped.
    """
    goals = [k for k, mark in enumerate(plan.marks) if mark == away.waypoint]
    if not goals or away.paused or away.proposed or plan.goal <= plan.back:
        return plan
    left_out = plan.waypoints[plan.goal : goals[0]]
    if any(w.VehicleActionList or w.AssociatedTasks for w in left_out):
        return plan
    return plan._replace(goal=max(plan.goal, goals[0]))


class Resumed(NamedTuple):
    """command: for the autopilot; back: number of waypoints of the way back; resume: as in `Plan`."""

    command: Any
    back: int
    resume: Position | None


def resumed(
    plan: Plan, away: Away, now: Motion, radius_m: float, projection: Projection, command_id: int
) -> Resumed:
    """The command for a vehicle after a handback: the shortest flyable way, or UxAS's proposal accepted by
    ICAROUS, onto its route, and along it.

    radius_m: turn radius.
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
        way = way[:-1]  # the last point is the waypoint itself
    following, points = plan.waypoints[goal], list(plan.command.WaypointList)
    first = 1 + max(w.Number for w in points)
    numbers = [*range(first, first + len(way)), following.Number]
    for k, place in enumerate(way):
        points.append(_at(following, place, projection, numbers[k], numbers[k + 1]))
    command = plan.command.copy(CommandID=command_id, FirstWaypoint=numbers[0], WaypointList=points)
    return Resumed(command, len(way), resume)


def leading_back(plan: Plan, away: Away, sent: Resumed, way: Plan | None) -> Plan | None:
    """The plan of a way back flown after `plan`. It keeps the mission's own command, for a later way back."""
    if way is None:
        return None
    return way._replace(command=plan.command, back=sent.back, resume=sent.resume, begun=away.tasks)


def _at(waypoint: Any, place: Position, projection: Projection, number: int, following: int) -> Any:
    """A copy of a waypoint at another place, without its actions."""
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
    """Index of each position in their `Track`, in which coincident positions are one point."""
    marks = [0]
    for a, b in itertools.pairwise(positions):
        apart_m = math.hypot(b.north_m - a.north_m, b.east_m - a.east_m)
        marks.append(marks[-1] + (apart_m > 1e-6))
    return tuple(marks)


def _flat(p: Position) -> Vec2:
    return Vec2(p.north_m, p.east_m)
