"""The options of a task that follows an entity: one per vehicle and slot, and their combinations.

Each option flies to the circle around the point where its vehicle meets the entity. A task of several
vehicles is a choice among the combinations that assign a different vehicle to each slot.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import permutations
from typing import Any

from cratous.bridge import lmcp
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.core.kernel import Vec2
from cratous.core.routing.dubins import pose_after
from cratous.core.routing.loiter_discs import broken_by
from cratous.core.routing.visibility import name_of
from cratous.core.tasks.stations import in_ring, outruns
from cratous.services.following.chase import chase, slot_of
from cratous.services.following.motion import Motion
from cratous.services.following.stations import (
    Station,
    camera_of,
    reached_from,
    relays,
    station,
    towards,
)
from cratous.services.following.task_parameters import Asked
from cratous.services.loading.ground import drives
from cratous.services.pipeline.contexts import Context
from cratous.services.pipeline.implementation import offer
from cratous.services.planning.options import Dropped, Option, hold_rooms, unfit
from cratous.services.planning.performance_classes import MOMENT_MS, Flyer, Way, flyer_of, straight
from cratous.spec.mission import Position, Task, Vehicle, Zone
from cratous.spec.mission.plan import Pose

APPROACH = 3.0
"""Length of the approach to a circle in turn radii, where zones allow it: a waypoint counts as reached two
radii ahead, and a shorter approach might be passed between two states, unnoticed.
"""
FAR = 4.0
"""A vehicle farther from the rim than this many turn radii has its whole approach before the rim."""
CATCH_UP = 1.25
"""A vehicle that follows a faster entity flies at up to this many times the entity's speed."""
WAYS_MOST = 336
"""Most combinations of vehicles and slots offered (three of eight)."""


def options_of(
    context: Context, task: Task, asked: Asked, motion: Motion
) -> tuple[list[Option], list[Dropped]]:
    """The options of a task, in order of slots, and what is not offered, with the reason."""
    mission, made, dropped = context.inputs.mission, list[Option](), list[Dropped]()
    able = flying(mission.vehicles, task, dropped)
    if asked.entity in [v.id for v in able]:
        able = [v for v in able if v.id != asked.entity]
        dropped.append(Dropped(task.id, (asked.entity,), "", "the task keeps to this very one"))
    if math.perm(len(able), asked.needed) > WAYS_MOST:
        text = (
            f"{len(able)} vehicles may be {asked.needed} at a time in more than {WAYS_MOST} ways: "
            "name fewer as EligibleEntities"
        )
        return [], [Dropped(task.id, tuple(v.id for v in able), "", text)]
    for slot in range(asked.needed):
        for k, vehicle in enumerate(able):
            number = 2 * (slot * len(able) + k) + 1
            start = context.inputs.starts[vehicle.id]
            found = _option(context, task, asked, motion, slot, vehicle, start)
            if isinstance(found, Option):
                made.append(named(found, number, vehicle.id))
                hurried = chase(context, asked, motion, found, vehicle)
                if hurried is not None:
                    made.append(named(hurried, number + 1, vehicle.id))
            elif slot == 0 or "region" in found.label:
                dropped.append(found._replace(vehicles=(vehicle.id,)))
    return made, dropped


def flying(vehicles: Sequence[Vehicle], task: Task, dropped: list[Dropped]) -> list[Vehicle]:
    """The eligible vehicles that can fly a task; ground vehicles are dropped with the reason."""
    able = [v for v in vehicles if not task.eligible or v.id in task.eligible]
    driving = tuple(v.id for v in able if drives(v))
    if driving:
        dropped.append(Dropped(task.id, driving, "", "it drives, and the task is flown"))
    return [v for v in able if not drives(v)]


def named(option: Option, number: int, vehicle: int) -> Option:
    """The option with its number and its vehicle."""
    from dataclasses import replace

    return replace(option, option_id=number, vehicles=(vehicle,))


def _option(
    context: Context, task: Task, asked: Asked, motion: Motion, slot: int, vehicle: Vehicle,
    start: Pose,
) -> Option | Dropped:  # fmt: skip
    terrain_m, zones = context.inputs.mission.frame.terrain_m, context.inputs.zones
    flyer = _fast_enough(motion, flyer_of(vehicle), vehicle)
    reason = ""
    if asked.looks is not None:
        camera = camera_of(asked, flyer)
        reason = unfit(asked.looks, flyer, camera, terrain_m)
        if camera is None and asked.watches:
            reason = reason or "it has no camera, and what it watches is seen by one alone"
    if not reason and not outruns(motion.velocity, flyer.speed_m_s):
        speed = math.hypot(*motion.velocity)
        who = f"entity {asked.entity}"
        if asked.tower is not None:
            who = f"the middle between {who} and the tower"
        reason = f"{who} moves at {speed:.1f} m/s, and it flies {flyer.speed_m_s:g} m/s"
    if reason:
        return Dropped(task.id, (), "", reason)
    here = Vec2(start.north_m, start.east_m)
    # where its usual speed is too slow, it catches up from there
    found = reached_from(here, asked, slot, flyer, motion, terrain_m)
    if found is None:
        return Dropped(task.id, (), "", f"it would not come up with entity {asked.entity}")
    met, far_m = found
    goal = station(asked, slot, flyer, met, terrain_m)
    if asked.tower is not None and not relays(asked.tower, met, met.at, goal.radius_m):
        text = f"halfway it is not in reach of both, of {asked.tower.range_m:g} m, all around its circle"
        return Dropped(task.id, (), "", text)
    way, zone = _way_in(f"slot {slot + 1}", here, goal, far_m, flyer, zones)
    if zone is not None:
        text = f"its circle about entity {asked.entity} breaks {name_of(zone)}"
        return Dropped(task.id, (), f"region, {way.label}", text)
    rooms = hold_rooms(way.start, flyer.radius_m, zones)
    lasts = max(asked.least_ms, way.duration_ms)
    return Option(task.id, 0, (), flyer, way.start, way.end, way.points, lasts, rooms, way.label)


def _fast_enough(motion: Motion, usual: Flyer, vehicle: Vehicle) -> Flyer:
    """The flyer at its usual speed, or as fast as needed and possible to follow the entity."""
    if outruns(motion.velocity, usual.speed_m_s):
        return usual
    speed = min(CATCH_UP * math.hypot(*motion.velocity), vehicle.max_speed_m_s)
    wider = (speed / usual.speed_m_s) ** 2  # the radius of a turn
    return usual._replace(speed_m_s=speed, radius_m=wider * usual.radius_m)


def _way_in(
    label: str, here: Vec2, goal: Station, far_m: float, flyer: Flyer, zones: Sequence[Zone]
) -> tuple[Way, Zone | None]:
    """The straight approach from here to a circle, and a zone that forbids it, None if none does.

    far_m: distance from here, towards the circle's centre, at which the vehicle's station begins.
    """
    heading = math.atan2(goal.at.y - here.y, goal.at.x - here.x)
    bad = broken_by(Position(*goal.at, flyer.alt_m), goal.radius_m, zones)
    # it comes to the rim of its circle, heading for the centre
    rim = Pose(
        goal.at.x - goal.radius_m * math.cos(heading),
        goal.at.y - goal.radius_m * math.sin(heading),
        flyer.alt_m,
        heading,
    )
    long_ms = max(round(1000 * APPROACH * flyer.radius_m / flyer.speed_m_s), MOMENT_MS)
    tries = [(rim, long_ms), (rim, MOMENT_MS)]
    begins = towards(here, goal.at, far_m)
    if not in_ring(
        here, begins, 0, FAR * flyer.radius_m
    ):  # there is room for all of it before that
        end = Pose(*begins, flyer.alt_m, heading)
        tries.insert(0, (pose_after(end, 0, -flyer.speed_m_s * long_ms / 2000, 1.0), long_ms))
    for middle, way_ms in tries:
        way = straight(label, middle, way_ms, flyer.speed_m_s)
        leg = first_bad_leg(way.points, zones)
        if leg is None:
            break
    return way, bad if bad is not None or leg is None else leg[1]


def offered(context: Context, task_id: int, options: Sequence[Option], needed: int) -> Any:
    """TaskPlanOptions; without options if too few vehicles are left for all slots."""
    if needed == 1:
        return offer(context, task_id, options)
    slow, soon = dict[tuple[int, int], int](), dict[tuple[int, int], int]()
    for option in options:  # a chase follows the other option of its vehicle and slot
        at = (slot_of(option), option.vehicles[0])
        soon[at] = option.option_id
        slow.setdefault(at, option.option_id)
    found, chases = _all_ways(slow, needed), _all_ways(soon, needed)
    more = chases if chases != found and 2 * len(found) <= WAYS_MOST else []
    return choice(context, task_id, options, [*more, *found])


def _all_ways(by_slot: Mapping[tuple[int, int], int], needed: int) -> list[list[int]]:
    """The combinations that assign different vehicles to all slots, as option numbers."""
    vehicles = sorted({vehicle for _, vehicle in by_slot})
    return [
        [by_slot[slot, vehicle] for slot, vehicle in enumerate(chosen)]
        for chosen in permutations(vehicles, needed)
        if all((slot, vehicle) in by_slot for slot, vehicle in enumerate(chosen))
    ]


def choice(
    context: Context, task_id: int, options: Sequence[Option], ways: Sequence[Sequence[int]]
) -> Any:
    """TaskPlanOptions: one of the combinations, each flown with all of its options; without options if there
    is none.
    """
    used = {number for way in ways for number in way}
    made = offer(context, task_id, [o for o in options if o.option_id in used])
    if not ways:
        return made
    terms = ["|(" + " ".join(f"p{number}" for number in way) + ")" for way in ways]
    return lmcp.new(
        "TaskPlanOptions",
        CorrespondingAutomationRequestID=made.CorrespondingAutomationRequestID,
        TaskID=made.TaskID,
        Composition=terms[0] if len(terms) == 1 else f"+({' '.join(terms)})",
        Options=made.Options,
    )
