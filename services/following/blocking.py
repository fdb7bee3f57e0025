"""The options of a cordon: one per ground vehicle and place, and the combinations that assign a vehicle to
each place.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.routing.visibility import name_of
from cratous.services.loading.ground import drives
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.ground import ROADS
from cratous.services.planning.options import Dropped, Option
from cratous.services.planning.performance_classes import flyer_of
from cratous.spec.mission import Position, Task, Vehicle
from cratous.spec.mission.plan import Pose

BLOCKED_MOST = 8
"""Most roads to block at one time, which is also the limit of vehicles for any task."""
WAYS_MOST = 720
"""Most combinations offered: all of six vehicles at six places."""
LOOKED_MOST = 30_000
"""Most partial combinations examined."""


class Told(NamedTuple):
    """Road crossings of the circle, for one request: places with outward headings [deg]; why: reason if they
    are unknown.
    """

    context: Context
    crossings: tuple[tuple[Any, float], ...]
    why: str = ""


def options_of(
    context: Context, task: Task, told: Told, radius_m: float, least_ms: int
) -> tuple[list[Option], list[list[int]], list[Dropped]]:
    """The options, the combinations that assign a vehicle to each place (as option numbers), and what is not
    offered.
    """
    vehicles, count = context.inputs.mission.vehicles, len(told.crossings)
    may = [v for v in vehicles if not task.eligible or v.id in task.eligible]
    able = [v for v in may if drives(v)]
    flying = tuple(v.id for v in may if not drives(v))
    reason = "it does not drive, and blocks no road"
    dropped = [Dropped(task.id, flying, "", reason)] if flying else []
    why = told.why or _why_none(count, len(able), radius_m)
    where = f"task {task.id}"
    alt_m = context.inputs.mission.frame.terrain_m
    places = [] if why else [
        context.places.pose(*one, where, f"NodeLocations[{k}]")._replace(alt_m=alt_m)
        for k, one in enumerate(told.crossings)
    ]  # fmt: skip
    why = why or _zone(context, places)
    if why:
        who = tuple(v.id for v in able or may)
        return [], [], [*dropped, Dropped(task.id, who, "a cordon", why)]
    made = [
        _option(task, vehicle, k, places, least_ms, v * count + k + 1)
        for v, vehicle in enumerate(able)
        for k in range(count)
    ]
    times = [[_soon_s(context, v, place) for v in able] for place in places]
    found = soonest(times, WAYS_MOST)
    chosen = found or [in_turn(times)]
    ways, all_ways = (
        [[v * count + k + 1 for k, v in enumerate(way)] for way in chosen],
        math.perm(len(able), count),
    )
    if len(ways) != all_ways:
        how = (
            "of which the last is there"
            if found
            else "by which each road in turn gets who is there"
        )
        label = f"any way but {len(ways)} of {all_ways}, {how} soonest as the crow flies,"
        dropped.append(Dropped(task.id, (), label, "there are too many"))
    return made, ways, dropped


def _option(
    task: Task, vehicle: Vehicle, k: int, places: Sequence[Pose], least_ms: int, number: int
) -> Option:
    flyer, pose = flyer_of(vehicle), places[k]
    ids, path = (task.id, number, (vehicle.id,)), (Position(*pose[:3]),)
    return Option(*ids, flyer, pose, pose, path, least_ms, (), f"road {k + 1} of {len(places)}")


def _soon_s(context: Context, vehicle: Vehicle, place: Pose) -> float:
    """Straight-line travel time of a vehicle to a place [s]."""
    return math.dist(context.inputs.starts[vehicle.id][:2], place[:2]) / vehicle.speed_m_s


def soonest(times: Sequence[Sequence[float]], most: int) -> list[tuple[int, ...]]:
    """Combinations that assign a different vehicle to each place, in order of the time at which the last one
    arrives.

    times: for each place, travel time by vehicle. Returns at most `most`; fewer, or none, where LOOKED_MOST
    partial combinations do not suffice.
    """
    found: list[tuple[int, ...]] = []
    least = [min(row) for row in times]
    # lower bounds on the last arrival and on the sum, both so far, and the vehicles at the first places
    todo: list[tuple[float, float, float, float, tuple[int, ...]]] = [(0.0, 0.0, 0.0, 0.0, ())]
    looked = 0
    while todo and len(found) != most and looked != LOOKED_MOST:
        *_, last, total, way = heapq.heappop(todo)
        if len(way) == len(times):
            found.append(way)
            continue
        looked += 1
        left = least[len(way) + 1 :]
        last_left, sum_left = max(left, default=0.0), sum(left)
        for v, time in enumerate(times[len(way)]):
            if v not in way:
                far, long = max(last, time), total + time
                bounds = max(far, last_left), long + sum_left
                heapq.heappush(todo, (*bounds, far, long, (*way, v)))
    return found


def in_turn(times: Sequence[Sequence[float]]) -> tuple[int, ...]:
    """Greedy combination: each place in turn gets the unassigned vehicle that arrives first."""
    way: list[int] = []
    for row in times:
        way.append(min((v for v in range(len(row)) if v not in way), key=row.__getitem__))
    return tuple(way)


def _why_none(count: int, able: int, radius_m: float) -> str:
    """Why the roads cannot be blocked with this number of vehicles; empty if they can."""
    if not count:
        return f"{ROADS} has told of no road that crosses the circle of {radius_m:g} m"
    crossed = f"{count} roads cross the circle of {radius_m:g} m"
    if count > BLOCKED_MOST:
        return f"{crossed}, and at most {BLOCKED_MOST} are blocked at one time"
    return f"{crossed}, and {able} vehicles may block one" if able < count else ""


def _zone(context: Context, places: Sequence[Pose]) -> str:
    """The zone that contains a blocking position, in words; "" if there is none."""
    for k, pose in enumerate(places):
        bad = first_bad_leg((Position(*pose[:3]),), context.inputs.zones)
        if bad is not None:
            return f"road {k + 1} of {len(places)} would be blocked in breach of {name_of(bad[1])}"
    return ""
