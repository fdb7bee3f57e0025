"""How an instance flies over a merge fix: to its slot, granted by a majority of the members, or holding outside.

At each heartbeat the kernel `merge_step` decides the stage, and the kernel `pace` the speed at which the vehicle
arrives at its slot. The route announced by UxAS is flown at that speed, or a circle, if permitted from the present
position (`course_permits`); if not even a circle is permitted, the manoeuvre of least deviation is flown, as in any takeover.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.avoidance.manoeuvre import Pace
from cratous.core.avoidance.resolution import Choice
from cratous.core.avoidance.way_ahead import near_line
from cratous.core.kernel import Vec2
from cratous.core.merging.stages import HOLDING, IN_SLOT, merge_step
from cratous.core.routing.polylines import Track, circle_points
from cratous.core.tasks.rendezvous import Pace as Arrival
from cratous.core.tasks.rendezvous import pace
from cratous.services.icarous import course as courses
from cratous.services.icarous import merger as talk
from cratous.services.icarous.course import Course
from cratous.services.icarous.course_permits import forbidden as forbidden_courses
from cratous.services.icarous.course_permits import refused_soon
from cratous.services.icarous.forbidden import FREE, Forbidden
from cratous.services.icarous.foresight import ON_PATH_M, scene_of
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.merge_state import Fix, Followed, Merging
from cratous.services.icarous.merger import Merger, Wish
from cratous.services.icarous.messages import Merges, Sensed, Talk, Tells
from cratous.services.icarous.return_to_path import flat, onto, rejoin
from cratous.services.icarous.state import IDLE, Config, State
from cratous.services.mission.merging import TOLERANCE_MS
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose
from cratous.spec.records import replace

WAITS_MS = 3_600_000
"""The window of a vehicle that can still wait ends this much later [ms]."""
STEADY_MS = 3000
"""The speed is kept for this time before the slot [ms]."""
ORIGIN = Vec2(0.0, 0.0)
PASSED_M = 1.0
"""The fix counts as passed from this distance before it, along the route [m]."""
BEATS = 4
"""The position on the route is searched as far ahead as the vehicle flies in this number of heartbeats."""
LEGS = 24
"""Number of legs in which a lap is announced."""
HEARD_MS = 2000
"""Time for which a member's announced route is used [ms]."""
BEFORE = "the slot at the fix is later: a circle is flown"
WITHOUT = "no slot at the fix: a circle is flown"


class Ahead(NamedTuple):
    """The fix as seen from the vehicle. left_m: distance to it along the route, None if it is not ahead on it; near,
    inside, entered: as in the kernel `merge_step`.
    """

    left_m: float | None
    near: bool
    inside: bool
    entered: bool


NOT_AHEAD = Ahead(None, False, False, False)


def heard(config: Config, state: State, message: Talk) -> State:
    """The state after another member's message. BadInput if the sender is not another member."""
    fix, before = config.merging, state.merging
    if fix is None:
        return state
    after = talk.hear(fix.talks, before.merger, message.said, message.now_ms)
    return replace(state, merging=before._replace(merger=after))


def heartbeat(
    config: Config, state: State, sensed: Sensed
) -> tuple[State, tuple[Merges | Tells, ...]]:
    """The state after a heartbeat, a notice for the record if it changed that, and the message to the others."""
    fix, before, now_ms = config.merging, state.merging, sensed.now_ms
    if fix is None:
        return state, ()
    beat_s = config.heartbeat_ms / 1000
    course = None if before.course is None else before.course.flown(sensed.motion, beat_s)
    way = _followed(before.way, state, sensed, beat_s)
    # after a declared failure it no longer flies the route over the fix, and keeps no slot
    failed = state.failing.declared
    ahead = NOT_AHEAD if failed else _ahead(fix, course, way, sensed)
    merger, slot, arrival = _agreed(fix, before, state, sensed, ahead)
    early = arrival is not None and arrival.act == 1
    stage = merge_step(
        before.stage, ahead.near, ahead.inside, slot is not None, early, ahead.entered
    )
    going = replace(state, merging=before._replace(way=way))
    tried = _candidates(config, going, sensed, stage, course, arrival)
    course = _permitted(config, state, sensed, tried)
    announced = state.no_link.course if failed else course
    flies = _flies(announced, sensed, config.daa.lookahead_s)
    merger, said = talk.beat(fix.talks, merger, flies, now_ms)
    told = _told(fix, stage, merger, slot)
    after = Merging(stage, merger, way, course, slot, told, () if course else tried)
    state = replace(state, merging=after)
    if stage not in (IN_SLOT, HOLDING) and before.stage in (IN_SLOT, HOLDING):
        state = replace(state, held=None, search=IDLE)
    tells = Tells(config.vehicle_id, said)
    # compared with what was recorded last: a message may have told of a leader since then
    if told == before.told:
        return state, (tells,)
    return state, (Merges(config.vehicle_id, now_ms, *told, reason(after)), tells)


def with_members(config: Config, state: State, now_ms: int) -> Told:
    """What was told of the others, with the routes of members as announced by the ICAROUS that flies them."""
    told = state.told
    if config.merging is None:
        return told
    said = {
        one.member: one.flies
        for one in state.merging.merger.heard
        if one.flies and in_time(one.at_ms, now_ms, HEARD_MS)
    }
    if not said:
        return told
    others = tuple(one for one in told.others if one[0] not in said)
    steered = tuple(one for one in told.steered if one[0] not in said)
    return replace(told, others=(*others, *said.items()), steered=steered)


def _flies(course: Course | None, sensed: Sensed, for_s: float) -> tuple[Position, ...]:
    """The points of a course; of a circle, those of the laps within this time [s]."""
    here = sensed.motion.position
    if course is None:
        return ()
    if course.track is not None:
        return (here, *course.left)
    hold = course.hold
    lap = circle_points((hold.north_m, hold.east_m), hold.radius_m, hold.clockwise, here, LEGS)
    lap_s = 2 * math.pi * hold.radius_m / sensed.motion.speed_m_s
    return lap[:-1] * (1 + math.ceil(for_s / lap_s))


def reason(merging: Merging) -> str:
    """The reason for which ICAROUS has authority over a vehicle that merges; "" for none."""
    if merging.stage == IN_SLOT:
        return f"merging: it is flown to be at the fix at {(merging.slot or 0) / 1000:g} s"
    if merging.stage == HOLDING:
        return f"merging: {WITHOUT if merging.slot is None else BEFORE}"
    return ""


def flown(config: Config, state: State, sensed: Sensed) -> tuple[State, Choice]:
    """The manoeuvre to fly now, along the permitted course."""
    course = state.merging.course
    assert course is not None, "it merges on a permitted course"
    choice = courses.steered(course, sensed, config.heartbeat_ms / 1000)
    return replace(state, held=None, search=IDLE), choice


def forbidden(config: Config, state: State, sensed: Sensed) -> Forbidden:
    """What forbids every course of the present stage, if none is permitted."""
    if state.merging.course is not None:
        return FREE
    scene, beat_s = scene_of(config, state, sensed), config.heartbeat_ms / 1000
    return forbidden_courses(state.merging.tried, sensed, scene, config.daa, beat_s)


def _told(fix: Fix, stage: int, merger: Merger, slot: int | None) -> tuple[int, int, int, int, int]:
    """Stage, term, leader, request and slot (-1: none), for the record."""
    leader = talk.leader_of(merger, fix.talks.me)
    return stage, merger.seat.latest, leader, merger.wish.request, -1 if slot is None else slot


def _followed(
    before: Followed | None, state: State, sensed: Sensed, beat_s: float
) -> Followed | None:
    points, motion = state.told.waypoints, sensed.motion
    if not points:
        return None
    window_m = BEATS * beat_s * motion.speed_m_s
    if before is None or before.points is not points:
        # a newly announced route begins near the present position
        before, window_m = Followed(points, Track(points, motion.heading_rad), 0.0), ON_PATH_M
        window_m += 2 * BEATS * beat_s * motion.speed_m_s
    near = before.track.nearest(motion.position, before.at_m, window_m)
    return before._replace(at_m=near.s_m)


def _ahead(fix: Fix, course: Course | None, way: Followed | None, sensed: Sensed) -> Ahead:
    track, at_m = (None, 0.0) if way is None else (way.track, way.at_m)
    if course is not None and course.track is not None:
        track, at_m = course.track, course.s_m
    if track is None or sensed.on_ground or sensed.landed:
        return NOT_AHEAD
    there = Position(*fix.place, 0.0)
    rest_m = max(track.length_m - at_m, 0.0)
    s_m = track.nearest(there, at_m, rest_m).s_m
    to_fix_m = s_m - at_m
    passes = near_line(flat(track.at(s_m)), fix.place, fix.place, fix.entry_m)
    passed = near_line(Vec2(to_fix_m, 0.0), ORIGIN, ORIGIN, PASSED_M)
    left_m = to_fix_m if passes and not passed else None
    here = flat(sensed.motion.position)
    near, inside, entered = (
        left_m is not None and near_line(here, fix.place, fix.place, radius_m)
        for radius_m in (fix.coordination_m, fix.schedule_m, fix.entry_m)
    )
    return Ahead(left_m, near, inside, entered)


def _agreed(
    fix: Fix, before: Merging, state: State, sensed: Sensed, ahead: Ahead
) -> tuple[Merger, int | None, Arrival | None]:
    """The state with the present request and its window, the slot, and the speed to arrive at it; None for none."""
    merger, now_ms = before.merger, sensed.now_ms
    slot = (
        talk.slot_of(fix.talks, merger, fix.talks.me, merger.wish.request) if ahead.near else None
    )
    arrival = _arrival(before, sensed, state, ahead, slot)
    late = arrival is not None and arrival.act == 2 and not ahead.entered
    again = late or (slot is None and talk.waited(merger, now_ms))
    merger, request = talk.asked(merger, ahead.near, again, now_ms)
    if request != before.merger.wish.request:
        slot, arrival = None, None
    if ahead.left_m is None or not request:
        return merger._replace(wish=Wish()), slot, arrival
    speed = state.told.speed_m_s or sensed.motion.speed_m_s
    soonest = now_ms + math.ceil(1000 * ahead.left_m / speed)
    latest = now_ms + WAITS_MS
    if ahead.entered:
        latest = now_ms + math.floor(1000 * ahead.left_m / sensed.ability.min_speed_m_s)
    return merger._replace(wish=Wish(request, soonest, max(soonest, latest))), slot, arrival


def _arrival(
    before: Merging, sensed: Sensed, state: State, ahead: Ahead, slot: int | None
) -> Arrival | None:
    """The speed at which the vehicle arrives at its slot. In a hold, the slowest one considered is midway
    between the slowest and the announced speed.
    """
    if slot is None or ahead.left_m is None:
        return None
    ability, left_s = sensed.ability, (slot - sensed.now_ms) / 1000
    slowest, fastest = ability.min_speed_m_s, ability.max_speed_m_s
    if before.stage == HOLDING:
        usual = state.told.speed_m_s or sensed.motion.speed_m_s
        slowest = (slowest + min(max(usual, slowest), fastest)) / 2
    return pace(ahead.left_m, left_s, slowest, fastest, TOLERANCE_MS / 1000)


def _candidates(
    config: Config,
    state: State,
    sensed: Sensed,
    stage: int,
    going: Course | None,
    arrival: Arrival | None,
) -> tuple[Course, ...]:
    """The courses of a stage, the preferred first: the present one continued, or new ones from here."""
    if stage == IN_SLOT:
        return _onward(config, state, sensed, going, arrival)
    if stage != HOLDING:
        return ()
    motion, wide_m = sensed.motion, courses.radius_m(sensed)
    here = Pose(*motion.position, motion.heading_rad)
    circles = courses.courses(here, motion, wide_m, None)
    return circles if going is None or going.track is not None else (going, *circles)


def _permitted(
    config: Config, state: State, sensed: Sensed, found: tuple[Course, ...]
) -> Course | None:
    """The first course that is permitted within the look-ahead; None if there is none."""
    if not found:
        return None
    scene, beat_s = scene_of(config, state, sensed), config.heartbeat_ms / 1000
    return next((c for c in found if not refused_soon(c, sensed, scene, config.daa, beat_s)), None)


def _onward(
    config: Config, state: State, sensed: Sensed, going: Course | None, arrival: Arrival | None
) -> tuple[Course, ...]:
    """Courses along the announced route from here, at the speed for the slot."""
    fix, way, motion, ability = config.merging, state.merging.way, sensed.motion, sensed.ability
    if fix is None or way is None or arrival is None:
        return ()
    speed, slot = arrival.speed_m_s, state.merging.slot
    flying = going if going is not None and going.track is not None else None
    if flying is not None and slot is not None and lasted(slot - STEADY_MS, sensed.now_ms, 0):
        speed = flying.speed_m_s
    own = Pace(speed, ability.acceleration_m_s2)
    if flying is not None:
        return (flying._replace(speed_m_s=speed, pace=own),)
    wide_m = courses.radius_m(sensed)
    rest = way.track.rest(way.at_m)
    here, place = flat(motion.position), flat(rest[0])
    points = (motion.position, *rest[1:])
    if not near_line(here, place, place, ON_PATH_M) or state.merging.stage == HOLDING:
        ahead = onto(rest, motion, wide_m)
        points = (*rejoin(motion, wide_m, ahead[0], ahead[1] if ahead[1:] else None), *ahead[1:])
    track = Track(points, motion.heading_rad)
    end = Pose(*track.points[-1], track.heading_rad(track.length_m))
    both = courses.courses(end, motion, wide_m, track)
    return tuple(one._replace(speed_m_s=speed, pace=own) for one in both)
