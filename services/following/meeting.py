"""What a rendezvous asks for, and its options: for each vehicle and state a straight run-in to it.

The run-in begins at a gate, with room beside it to wait in laps, and is so long that flown slowly it takes a
lap longer than flown fast, so that who waits there can arrive at any time to come. It ends beyond the state, so
that the vehicle passes that straight on.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, islice
from typing import Any, NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.core.routing.dubins import pose_after
from cratous.core.routing.visibility import name_of
from cratous.core.tasks.rendezvous import spares_a_lap
from cratous.services.following.asked import milliseconds, within
from cratous.services.following.offering import WAYS_MOST, choice, flying, named
from cratous.services.following.stations import Station
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.places import RequestPlaces
from cratous.services.pipeline.source import Known
from cratous.services.planning.flyers import Flyer, flyer_of
from cratous.services.planning.options import Dropped, Option, flight_ms, hold_rooms
from cratous.spec.errors import BadInput
from cratous.spec.mission import Position, Task, Vehicle
from cratous.spec.mission.plan import Pose

PARTICIPANTS_MOST = 8
STATES_MOST = 64
TOLERANCE = "Tolerance_ms"
"""The task parameter that says how far from the common time each may arrive."""
TOLERANCE_MS, TOLERANCE_MOST_MS = 2_000, 600_000
WAIT = "Wait_ms"
"""The task parameter that says how long one waits in laps for the others at most."""
WAIT_MS, WAIT_MOST_MS = 3_600_000, 86_400_000
RUN_IN_RADII = 6.0
"""A run-in is so many turn radii long at least, so that it is flown straight."""
RUN_IN_RESERVE = 1.25
RUN_IN_MOST_M = 20_000.0
LEAST_M_S = 1.0
"""Who makes less way against the wind is taken to make this."""
SLOWER = 2.0
"""Who waits flies no slower than its nominal speed by this: a lap is so long that states show each quarter of it."""
RUN_IN = "run-in, waiting at [m/s] "
"""The label of an option, before the speed at which its vehicle waits."""
BEYOND_RADII = 2.5
"""A run-in ends so many radii of a turn at the fastest speed beyond its state: at most two ahead the next begins."""


class Met(NamedTuple):
    """needed: how many meet; tolerance_ms: of their time; wait_ms: no longer does one wait for the others;
    states: of whom (0: anybody) and where."""

    needed: int
    tolerance_ms: int
    wait_ms: int
    states: tuple[tuple[int, Pose], ...]


def meeting_of(body: Any, places: RequestPlaces) -> Met:
    """What the message of a rendezvous asks for; BadInput names what cannot be."""
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


class Limits(NamedTuple):
    """Speeds of a vehicle [m/s]."""

    slowest_m_s: float
    nominal_m_s: float
    fastest_m_s: float


def limits_of(vehicle: Vehicle) -> Limits:
    """The speeds of a vehicle; one that its configuration leaves out is the nominal one."""
    nominal = vehicle.speed_m_s
    slowest = min(vehicle.min_speed_m_s or nominal, nominal)
    return Limits(slowest, nominal, max(vehicle.max_speed_m_s, nominal))


def wind_of(state: Any, heading_rad: float) -> Vec2:
    """The wind that a vehicle's state tells, along a heading and across it [m/s]; BadInput for what is no wind."""
    speed, source = getattr(state, "WindSpeed", 0.0), getattr(state, "WindDirection", 0.0)
    if not (math.isfinite(speed) and math.isfinite(source)):
        raise BadInput(
            "a wind that is no number", where=f"state of vehicle {state.ID}",
            item="WindSpeed, WindDirection", expected="finite numbers", got=f"{speed:g}, {source:g}",
        )  # fmt: skip
    off = math.radians(source) - heading_rad
    return Vec2(-speed * math.cos(off), -speed * math.sin(off))


def over_ground(limits: Limits, wind: Vec2) -> Limits:
    """The speeds of a vehicle over ground, at least `LEAST_M_S`; wind: along its way and across it [m/s]."""
    found = []
    for speed in limits:
        along = math.sqrt(max(speed**2 - wind.y**2, 0.0))
        found.append(max(along + wind.x, LEAST_M_S))
    return Limits(*found)


def lap_s(flyer: Flyer, wind: Vec2 = Vec2(0.0, 0.0)) -> float:
    """How long a lap of waiting takes [s], in a wind at most ten times as long as without one."""
    calm_s = 2 * math.pi * flyer.radius_m / flyer.speed_m_s
    return calm_s / max(1 - (wind.x**2 + wind.y**2) / flyer.speed_m_s**2, 0.1)


def waiting_of(flyer: Flyer, limits: Limits, wind: Vec2) -> Flyer:
    """How a vehicle flies while it waits: as slowly as it can, on the narrower circle of that, if a lap is shorter so."""
    share = max(limits.slowest_m_s / limits.nominal_m_s, 1 / SLOWER)
    slow = flyer._replace(
        speed_m_s=share * flyer.speed_m_s, radius_m=share * share * flyer.radius_m
    )
    return min(flyer, slow, key=lambda one: lap_s(one, wind))


def waits_as(option: Option) -> Flyer:
    """How the vehicle of an option flies while it waits."""
    speed = float(option.label.removeprefix(RUN_IN))
    share = speed / option.flyer.speed_m_s
    return option.flyer._replace(speed_m_s=speed, radius_m=share**2 * option.flyer.radius_m)


def options_of(
    context: Context, task: Task, met: Met, world: Known
) -> tuple[list[tuple[Option, int]], list[Dropped], list[str]]:
    """The options with the numbers of their states; what is not offered, with the reason; what is not done."""
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
                number = len(made) + 1
                made.append((named(found, number, vehicle.id), k))
                own = pose._replace(alt_m=found.flyer.alt_m)
                if own != pose:
                    notes.append(
                        f"vehicle {vehicle.id} passes RendezvousStates[{k}] of task {task.id} at its own "
                        f"altitude, {own.alt_m:g} m MSL, not at {pose.alt_m:g} m"
                    )
    return made, dropped, notes


def _option(
    context: Context, task: Task, vehicle: Vehicle, pose: Pose, world: Known
) -> Option | str:
    """The run-in of a vehicle to a state, or why there is none."""
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
    # the radius of a turn grows with the square of the speed
    beyond = BEYOND_RADII * flyer.radius_m * (limits.fastest_m_s / limits.nominal_m_s) ** 2
    end = pose_after(at, 0, beyond, 1.0)
    path = tuple(Position(*p[:3]) for p in (gate, at, end))
    leg = first_bad_leg(path, zones)
    if leg is not None:
        return f"its straight way there breaks {name_of(leg[1])}"
    rooms = hold_rooms(gate, flyer.radius_m, zones)
    rooms = tuple(
        room
        for room in rooms
        if first_bad_leg((_middle(gate, waiting, room.clockwise), path[2]), zones) is None
    )
    if not rooms:
        return "its circle to wait on, before its straight way there, breaks a zone"
    lasts = flight_ms(length + beyond, flyer.speed_m_s)
    label = f"{RUN_IN}{waiting.speed_m_s!r}"
    return Option(task.id, 0, (), flyer, gate, end, path, lasts, rooms, label)


def _middle(gate: Pose, flyer: Flyer, clockwise: bool) -> Position:
    """The middle of the circle to wait on beside a gate."""
    side = gate.heading_rad + (math.pi / 2 if clockwise else -math.pi / 2)
    return Position(
        gate.north_m + flyer.radius_m * math.cos(side),
        gate.east_m + flyer.radius_m * math.sin(side),
        flyer.alt_m,
    )


def waiting_circle(option: Option) -> tuple[Station, bool]:
    """The circle on which an option's vehicle waits, and whether clockwise."""
    clockwise = option.holds[0].clockwise
    waiting = waits_as(option)
    middle = _middle(option.start, waiting, clockwise)
    return Station(Vec2(middle.north_m, middle.east_m), waiting.radius_m), clockwise


def ways_of(met: Met, options: Sequence[tuple[Option, int]]) -> list[tuple[int, ...]]:
    """All ways to choose vehicles and to give each a state of its own, as the numbers of options; BadInput if they
    are too many. One state for anybody is everybody's."""
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
        # who has the least choice comes first, so that nothing is looked at in vain for long
        rare = tuple(sorted(chosen, key=lambda v: len(by_vehicle[v])))
        yield from _given(rare, by_vehicle, frozenset(range(len(met.states))))


def _given(
    chosen: tuple[int, ...], by_vehicle: Mapping[int, Mapping[int, int]], free: frozenset[int]
) -> Iterator[tuple[int, ...]]:
    """Each vehicle with a state of its own."""
    if not chosen:
        yield ()
        return
    for k, number in by_vehicle[chosen[0]].items():
        if k in free:
            for rest in _given(chosen[1:], by_vehicle, free - {k}):
                yield (number, *rest)


def offered(context: Context, task_id: int, options: Sequence[Option], ways: Sequence[Any]) -> Any:
    """TaskPlanOptions: a choice of ways, each flown by all its vehicles; without options where there is none."""
    left = {option.option_id for option in options}
    ways = [way for way in ways if left.issuperset(way)]
    return choice(context, task_id, options, ways)
