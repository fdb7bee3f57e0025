"""Parameters of a rendezvous, and its options: for each vehicle and state a route to it.

The route begins at a gate, with room beside it for waiting laps, and is long enough for slow flight to take a
lap longer than fast flight, so that a waiting vehicle can arrive at any later time. It ends beyond the state,
so that the vehicle passes the state in straight flight. There are two kinds: a direct one from just ahead of
the vehicle, and a straight run-in, for a vehicle that comes from elsewhere or is too near.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations, islice
from typing import Any, NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.core.routing.dubins import cut, dubins, polyline_length_m, pose_after
from cratous.core.routing.visibility import name_of
from cratous.core.tasks.rendezvous import pace, spares_a_lap
from cratous.services.following.speeds import (
    Limits,
    lap_s,
    limits_of,
    over_ground,
    waiting_of,
    wind_of,
)
from cratous.services.following.stations import Station
from cratous.services.following.task_options import WAYS_MOST, choice, flying, named
from cratous.services.following.task_parameters import milliseconds, within
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.services.pipeline.source import Known
from cratous.services.planning.options import Dropped, HoldRoom, Option, flight_ms, hold_rooms
from cratous.services.planning.performance_classes import Flyer, flyer_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, Task, Vehicle
from cratous.spec.mission.plan import Pose

PARTICIPANTS_MOST = 8
STATES_MOST = 64
TOLERANCE = "Tolerance_ms"
"""Task parameter with the tolerance of each arrival around the common time [ms]."""
TOLERANCE_MS, TOLERANCE_MOST_MS = 2_000, 600_000
WAIT = "Wait_ms"
"""Task parameter with the longest time that a vehicle waits for the others [ms]."""
WAIT_MS, WAIT_MOST_MS = 3_600_000, 86_400_000
RUN_IN_RADII = 6.0
"""Shortest length of a run-in in turn radii, so that it is flown straight."""
RUN_IN_RESERVE = 1.25
RUN_IN_MOST_M = 20_000.0
RUN_IN = "run-in, waiting at [m/s] "
"""The label of a run-in, before the speed at which its vehicle waits."""
DIRECT_RADII = 1.2
"""The straight end of a direct route, in turn radii at the fastest speed."""
LEAD_S = 10.0
"""A direct route begins this far ahead of its vehicle [s]: a state of each vehicle arrives before it is
there.
"""
BEYOND_RADII = 2.1
"""A route ends this many turn radii at the fastest speed beyond its state: the next waypoint is taken up to
two ahead.
"""


class Met(NamedTuple):
    """needed: number of vehicles; tolerance_ms: of their arrival times; wait_ms: longest wait for the others;
    states: (vehicle, pose), vehicle 0 for any.
    """

    needed: int
    tolerance_ms: int
    wait_ms: int
    states: tuple[tuple[int, Pose], ...]


def meeting_of(body: Any, places: RequestPlaces) -> Met:
    """The parameters in the message of a rendezvous; BadInput for values out of range."""
    where = f"task {body.TaskID}"
    needed, states = body.NumberOfParticipants, body.RendezvousStates
    within(needed, 1, PARTICIPANTS_MOST, where, "NumberOfParticipants")
    within(len(states), 1, STATES_MOST, where, "number of RendezvousStates")
    tolerance = milliseconds(body, TOLERANCE, TOLERANCE_MOST_MS, TOLERANCE_MS)
    wait = milliseconds(body, WAIT, WAIT_MOST_MS, WAIT_MS)
    found = []
    for k, state in enumerate(states):
        item = f"RendezvousStates[{k}]"
        pose = places.pose(state.PlanningPosition, state.PlanningHeading, where, item)
        found.append((state.EntityID, pose))
    return Met(needed, tolerance, wait, tuple(found))


def waits_as(option: Option) -> Flyer:
    """Speed and turn radius of an option's vehicle while it waits."""
    speed = float(option.label.removeprefix(RUN_IN))
    share = speed / option.flyer.speed_m_s
    return option.flyer._replace(speed_m_s=speed, radius_m=share**2 * option.flyer.radius_m)


def is_direct(option: Option) -> bool:
    """Whether an option is a direct route from the vehicle's position with a turn in it, and not a straight
    run-in.
    """
    return len(option.path) > 3


def usual_m_s(option: Option, limits: Limits) -> float:
    """Planned approach speed of an option's vehicle [m/s]."""
    return limits.brisk_m_s if is_direct(option) else limits.nominal_m_s


def planned_m_s(option: Option) -> float:
    """Speed of an option's waypoints from its gate to its place [m/s]."""
    if not is_direct(option):
        return option.flyer.speed_m_s
    length, beyond_ms = polyline_length_m(option.path[:-1]), _beyond_ms(option)
    return 1000 * length / (option.duration_ms - beyond_ms)


def _beyond_ms(option: Option) -> int:
    beyond_m = math.dist(option.path[-2][:2], option.path[-1][:2])
    return flight_ms(beyond_m, option.flyer.speed_m_s)


def _together(
    needed: int, able: Sequence[Vehicle], made: Sequence[tuple[Option, int]]
) -> list[tuple[Option, int]]:
    """The options, with direct routes adjusted to end at the same time, if it is certain that all of them are
    flown.
    """
    direct = {option.vehicles[0]: option for option, _ in made if is_direct(option)}
    limits = {vehicle.id: limits_of(vehicle) for vehicle in able}
    if not len(direct) == sum(is_direct(option) for option, _ in made) == needed:
        return list(made)
    lengths = {v: polyline_length_m(option.path[:-1]) for v, option in direct.items()}
    last_s = max(length / limits[v].brisk_m_s for v, length in lengths.items())
    found = []
    for option, k in made:
        if is_direct(option):
            length, own = lengths[option.vehicles[0]], limits[option.vehicles[0]]
            speed = pace(length, last_s, own.slowest_m_s, own.brisk_m_s, 0.0).speed_m_s
            lasts = flight_ms(length, speed) + _beyond_ms(option)
            option = replace(option, duration_ms=lasts)
        found.append((option, k))
    return found


def at_speed(made: Any, speed_m_s: float) -> Any:
    """A TaskImplementationResponse with a speed [m/s] for the leg from the gate to the place."""
    own = [w for w in made.TaskWaypoints if w.AssociatedTasks]
    there = [w.copy(Speed=speed_m_s) for w in own[1:-1]]
    return made.copy(TaskWaypoints=[*made.TaskWaypoints[: -len(own)], own[0], *there, own[-1]])


def options_of(
    context: Context, task: Task, met: Met, world: Known
) -> tuple[list[tuple[Option, int]], list[Dropped], list[str]]:
    """The options with the indices of their states; what is not offered, with the reason; and notes on
    deviations.

    A direct route follows the run-in of its vehicle and state.
    """
    made, dropped, notes = list[tuple[Option, int]](), list[Dropped](), list[str]()
    able = flying(context.inputs.mission.vehicles, task, dropped)
    known = [v.id for v in able]
    for k, (entity, _) in enumerate(met.states):
        if entity and entity not in known:
            text = f"RendezvousStates[{k}] is of entity {entity}, which is none of its vehicles"
            dropped.append(Dropped(task.id, (entity,), "", text))
    for vehicle in able:
        for k, (entity, pose) in enumerate(met.states):
            if entity not in (0, vehicle.id):
                continue
            found = _option(context, task, vehicle, pose, world)
            if isinstance(found, str):
                dropped.append(
                    Dropped(task.id, (vehicle.id,), "", f"RendezvousStates[{k}]: {found}")
                )
            else:
                state = world.get("state", vehicle.id)
                direct = _direct(context, vehicle, found, state)
                for one in (found, direct):
                    if one is not None:
                        made.append((named(one, len(made) + 1, vehicle.id), k))
                own = pose._replace(alt_m=found.flyer.alt_m)
                if own != pose:
                    notes.append(
                        f"vehicle {vehicle.id} passes RendezvousStates[{k}] of task {task.id} at its own "
                        f"altitude, {own.alt_m:g} m MSL, not at {pose.alt_m:g} m"
                    )
    return _together(met.needed, able, made), dropped, notes


def _option(
    context: Context, task: Task, vehicle: Vehicle, pose: Pose, world: Known
) -> Option | str:
    """A vehicle's run-in to a state, or why none exists."""
    flyer, limits, zones = flyer_of(vehicle), limits_of(vehicle), context.inputs.zones
    wind = wind_of(world.get("state", vehicle.id), pose.heading_rad)
    waiting = waiting_of(flyer, limits, wind)
    ground, lap = over_ground(limits, wind), lap_s(waiting, wind)
    spread = ground.fastest_m_s - ground.slowest_m_s
    lap_m2_s = lap * ground.slowest_m_s * ground.fastest_m_s
    length = min(RUN_IN_RESERVE * lap_m2_s / spread, RUN_IN_MOST_M) if spread else RUN_IN_MOST_M
    length = max(length, RUN_IN_RADII * flyer.radius_m)
    if not spares_a_lap(length, lap, ground.slowest_m_s, ground.fastest_m_s):
        return (
            f"at {ground.slowest_m_s:.4g} to {ground.fastest_m_s:.4g} m/s over ground it cannot make up for a "
            f"lap of {lap:.1f} s on {length / 1000:g} km, so no common time can be kept"
        )
    at = pose._replace(alt_m=flyer.alt_m)
    gate = pose_after(at, 0, -length, 1.0)
    beyond = BEYOND_RADII * _widest(flyer, limits)
    end = pose_after(at, 0, beyond, 1.0)
    path = tuple(Position(*p[:3]) for p in (gate, at, end))
    leg = first_bad_leg(path, zones)
    if leg is not None:
        return f"its straight way there breaks {name_of(leg[1])}"
    rooms = _rooms(gate, flyer, waiting, end, context)
    if not rooms:
        return "its circle to wait on, before its straight way there, breaks a zone"
    lasts = flight_ms(length + beyond, flyer.speed_m_s)
    label = f"{RUN_IN}{waiting.speed_m_s!r}"
    return Option(task.id, 0, (), flyer, gate, end, path, lasts, rooms, label)


def _widest(flyer: Flyer, limits: Limits) -> float:
    """Turn radius at the fastest speed [m]: it grows with the square of the speed."""
    return flyer.radius_m * (limits.fastest_m_s / limits.nominal_m_s) ** 2


def _rooms(
    gate: Pose, flyer: Flyer, waiting: Flyer, on: Position | Pose, context: Context
) -> tuple[HoldRoom, ...]:
    """The sides of a gate on which a vehicle may wait and from which it may continue to a place."""
    zones, goal = context.inputs.zones, Position(*on[:3])
    return tuple(
        room
        for room in hold_rooms(gate, flyer.radius_m, zones)
        if first_bad_leg((_middle(gate, waiting, room.clockwise), goal), zones) is None
    )


def _direct(context: Context, vehicle: Vehicle, straight: Option, state: Any) -> Option | None:
    """The route to a state from just ahead of a vehicle, if it can absorb a lap and breaks no zone; else
    None.

    Its turns are wide enough for every speed of the vehicle.
    """
    flyer, limits, begin = straight.flyer, limits_of(vehicle), context.inputs.starts[vehicle.id]
    gate = pose_after(begin._replace(alt_m=flyer.alt_m), 0, LEAD_S * flyer.speed_m_s, 1.0)
    at = straight.end._replace(north_m=straight.path[1][0], east_m=straight.path[1][1])
    wide_m, waiting = _widest(flyer, limits), waits_as(straight)
    last = pose_after(at, 0, -DIRECT_RADII * wide_m, 1.0)
    path = (*cut(dubins(gate, last, wide_m), last), *straight.path[1:])
    length = polyline_length_m(path[:-1])
    chord = math.atan2(at.east_m - gate.east_m, at.north_m - gate.north_m)
    for heading in (chord, at.heading_rad):
        wind = wind_of(state, heading)
        ground = over_ground(limits, wind)
        if not spares_a_lap(length, lap_s(waiting, wind), ground.slowest_m_s, ground.fastest_m_s):
            return None
    if first_bad_leg(path, context.inputs.zones) is not None:
        return None
    rooms = _rooms(gate, flyer, waiting, path[1], context)
    lasts = flight_ms(length, limits.brisk_m_s) + _beyond_ms(straight)
    made = replace(straight, start=gate, path=path, duration_ms=lasts, holds=rooms)
    return made if rooms else None


def _middle(gate: Pose, flyer: Flyer, clockwise: bool) -> Position:
    """Centre of the waiting circle beside a gate."""
    side = gate.heading_rad + (math.pi / 2 if clockwise else -math.pi / 2)
    return Position(
        gate.north_m + flyer.radius_m * math.cos(side),
        gate.east_m + flyer.radius_m * math.sin(side),
        flyer.alt_m,
    )


def waiting_circle(option: Option) -> tuple[Station, bool]:
    """The waiting circle of an option's vehicle, and whether it is flown clockwise."""
    clockwise = option.holds[0].clockwise
    waiting = waits_as(option)
    middle = _middle(option.start, waiting, clockwise)
    return Station(Vec2(middle.north_m, middle.east_m), waiting.radius_m), clockwise


def ways_of(met: Met, options: Sequence[tuple[Option, int]]) -> list[tuple[int, ...]]:
    """All combinations that assign different vehicles to states, as option numbers; BadInput if there are too
    many.

    A single state for any vehicle is shared by all. Direct routes are used for all vehicles of a combination
    or for none.
    """
    found = _all_ways(met, [one for one in options if not is_direct(one[0])])
    direct = _all_ways(met, options)  # of one vehicle and state the later option counts
    return [*direct, *found] if found != direct and 2 * len(found) <= WAYS_MOST else found


def _all_ways(met: Met, options: Sequence[tuple[Option, int]]) -> list[tuple[int, ...]]:
    by_vehicle: dict[int, dict[int, int]] = {}
    for option, k in options:
        by_vehicle.setdefault(option.vehicles[0], {})[k] = option.option_id
    groups = math.comb(len(by_vehicle), met.needed)
    found = list(islice(_ways(met, by_vehicle), WAYS_MOST + 1)) if groups <= WAYS_MOST else []
    if max(groups, len(found)) > WAYS_MOST:
        raise BadInput(
            "vehicles may meet in too many ways", item="RendezvousStates, EligibleEntities",
            expected=f"at most {WAYS_MOST} ways to give {met.needed} vehicles a state each",
            got=f"{len(by_vehicle)} vehicles, {len(met.states)} states",
        )  # fmt: skip
    return found


def _ways(met: Met, by_vehicle: Mapping[int, Mapping[int, int]]) -> Iterator[tuple[int, ...]]:
    for chosen in combinations(sorted(by_vehicle), met.needed):
        if len(met.states) == 1:
            yield tuple(by_vehicle[v][0] for v in chosen)
            continue
        # the vehicle with the fewest choices first, to fail early
        rare = tuple(sorted(chosen, key=lambda v: len(by_vehicle[v])))
        yield from _given(rare, by_vehicle, frozenset(range(len(met.states))))


def _given(
    chosen: tuple[int, ...], by_vehicle: Mapping[int, Mapping[int, int]], free: frozenset[int]
) -> Iterator[tuple[int, ...]]:
    """Assignments of a different state to each vehicle."""
    if not chosen:
        yield ()
        return
    for k, number in by_vehicle[chosen[0]].items():
        if k in free:
            for rest in _given(chosen[1:], by_vehicle, free - {k}):
                yield (number, *rest)


def offered(context: Context, task_id: int, options: Sequence[Option], ways: Sequence[Any]) -> Any:
    """TaskPlanOptions: a choice of combinations, each flown by all of its vehicles; without options if there
    is none.
    """
    left = {option.option_id for option in options}
    ways = [way for way in ways if left.issuperset(way)]
    return choice(context, task_id, options, ways)
