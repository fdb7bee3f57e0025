"""Take-off by the instance: climb-outs, permitted from the vehicle's position on the ground, and the take-off
mode.

A climb-out runs straight along the ground to the take-off speed, then up: straight on, or straight on to
ICAROUS's lowest altitude and then in laps; it ends in a circle. The kernel `departure_step` decides the mode
at each heartbeat. Only one own vehicle rolls at a time: each may begin only at its own heartbeats.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from cratous.core.authority.failure import heard_by
from cratous.core.authority.take_off import (
    CLIMBING,
    ROLLING,
    STANDING,
    UP,
    Departure,
    departure_step,
)
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.avoidance.manoeuvre import Pace
from cratous.core.avoidance.resolution import Choice, Scene
from cratous.core.geofence.clearance import leg_keeps
from cratous.core.routing.polylines import Track
from cratous.services.icarous import course as courses
from cratous.services.icarous.course import Course
from cratous.services.icarous.course_permits import refused
from cratous.services.icarous.foresight import scene_of
from cratous.services.icarous.landing import along, with_laps
from cratous.services.icarous.messages import Sensed, TakesOff
from cratous.services.icarous.state import Config, Rising, State
from cratous.services.mission.landing import BRAKING_M_S2
from cratous.services.mission.take_off import USED, TakeOff, roll_m
from cratous.spec.authority.take_off import BEGIN, BREAK_OFF, END, LEAVE, LIFT_OFF, NOTHING
from cratous.spec.mission import Daa, Position, Zone
from cratous.spec.mission.plan import Pose
from cratous.spec.records import replace

AGAIN_MS = 2000
"""Where no climb-out is permitted, the next search follows this much later [ms]."""
NO_LINK = "UxAS is not heard"
FAILED = "a failure is declared"
NO_WAY = "there is no way up"
WORDS = {
    BEGIN: "the way up is permitted: it rolls",
    LIFT_OFF: "off the ground",
    END: "at the end of its way up",
}


def rising(config: Config, state: State) -> Rising:
    """Take-off state of an instance; UP for one that starts in the air."""
    return Rising(Departure(UP, 0)) if config.take_off is None else state.rising


def departs(config: Config, state: State) -> bool:
    """Whether the vehicle has not completed its take-off."""
    return rising(config, state).departure.mode != UP


def heartbeat(config: Config, state: State, sensed: Sensed) -> tuple[State, tuple[TakesOff, ...]]:
    """The state with the mode and climb-out for this heartbeat, and what to report."""
    plan, before = config.take_off, rising(config, state)
    mode = before.departure.mode
    if plan is None or mode == UP:
        return state, ()
    now_ms, course, why = sensed.now_ms, before.course, before.why
    # after a declared failure UxAS asks for no take-off any more
    heard_ms = heard_by(state.failing.failure, state.told.heard_ms)
    if course is not None:
        course = course.flown(sensed.motion, _beat_s(config))
    if mode == STANDING:
        course = None
        if not state.failing.declared and _is_due(config, plan, sensed, before):
            by = partial(_why_not, config, state, sensed)
            course, why = first_way_up(plan, sensed, by)
            state = replace(state, rising=before._replace(tried_ms=now_ms))
    elif course is not None:
        why = _why_not(config, state, sensed, course)
        course = None if why else course
    linked = in_time(heard_ms, now_ms, plan.silence_ms)
    why = why if linked else FAILED if state.failing.declared else NO_LINK
    ended = mode == CLIMBING and course is not None and course.flown_to_its_end
    stepped = departure_step(
        before.departure, heard_ms, now_ms, plan.silence_ms,
        course is not None, not sensed.on_ground, ended,
    )  # fmt: skip
    mode = stepped.departure.mode
    kept = course if mode in (ROLLING, CLIMBING) else None
    # the roll was permitted; the climb is checked at the next heartbeat
    kept = before.course if mode == CLIMBING and kept is None else kept
    tried_ms = state.rising.tried_ms
    after = replace(state, rising=Rising(stepped.departure, kept, why, tried_ms))
    text = WORDS.get(stepped.act, "")
    if stepped.act in (BREAK_OFF, LEAVE):
        text = f"{'the roll is broken off' if stepped.act == BREAK_OFF else 'the climb is left'}: {why}"
    if stepped.act == NOTHING:
        if mode != STANDING or why == before.why:
            return after, ()
        text = f"it stands: {why}"
    return after, (TakesOff(config.vehicle_id, now_ms, mode, state.told.heard_ms, text),)


def flown(config: Config, state: State, sensed: Sensed) -> tuple[State, Choice]:
    """The manoeuvre to fly now: standing, the take-off run, or the climb."""
    held, motion, beat_s = rising(config, state), sensed.motion, _beat_s(config)
    state, mode, course = replace(state, held=None), held.departure.mode, held.course
    choice = Choice("heading", motion.heading_rad, 0.0, 0.0, 0.0, True, None)
    if mode == STANDING or course is None or course.track is None:
        return state, choice
    if mode == CLIMBING:
        return state, courses.steered(course, sensed, beat_s)
    ahead_m = course.speed_m_s * beat_s
    rise_m = course.track.at(course.s_m + ahead_m).alt_m - motion.position.alt_m
    climb = min(max(rise_m / beat_s, 0.0), sensed.ability.max_climb_m_s)
    return state, choice._replace(speed_m_s=course.speed_m_s, climb_m_s=climb, climb_for_s=beat_s)


def _ways_up(plan: TakeOff, sensed: Sensed) -> Iterator[Course]:
    """Climb-outs from where the vehicle stands to the altitude of its plan, with the final circle on either
    side.
    """
    motion, ability = sensed.motion, sensed.ability
    speed, heading, here = ability.min_speed_m_s, motion.heading_rad, motion.position
    lift = along(here, heading, roll_m(motion.speed_m_s, speed, ability.acceleration_m_s2))
    slope = USED * ability.max_climb_m_s / speed
    ready = sensed._replace(motion=motion._replace(speed_m_s=speed))
    wide_m = courses.radius_m(ready)

    def up_to(alt_m: float) -> Position:
        return along(lift, heading, max(alt_m - here.alt_m, 0.0) / slope)._replace(alt_m=alt_m)

    def course(points: tuple[Position, ...], side: int) -> Course:
        track = Track((here, lift, *points), heading)
        end = Pose(*track.points[-1], heading)
        found = courses.courses(end, ready.motion, wide_m, track)[side]
        return found._replace(pace=Pace(speed, ability.acceleration_m_s2))

    top = up_to(plan.alt_m)
    yield from (course((top,), side) for side in (0, 1))
    gate = up_to(min(ability.floor_m, plan.alt_m))
    end = Pose(gate.north_m, gate.east_m, plan.alt_m, heading)
    for side, turn in ((0, 1), (1, -1)):
        points = with_laps((gate,), end, wide_m, slope, turn)
        if points[1:]:
            yield course(points, side)


def _why_not(config: Config, state: State, sensed: Sensed, course: Course) -> str:
    """Why a climb-out is not permitted from here on; "" if it is."""
    if sensed.on_ground and sensed.rolling:
        return f"vehicle {sensed.rolling[0]} rolls"
    if not _at_its_speed(course, sensed):
        return "in the wind of now it flies at another speed"
    return why_forbidden(
        course, sensed, scene_of(config, state, sensed), config.daa, _beat_s(config)
    )


def why_forbidden(course: Course, sensed: Sensed, scene: Scene, daa: Daa, beat_s: float) -> str:
    """Why zones or traffic forbid a climb-out from here on; "" if they do not."""
    if sensed.on_ground and not _may_stop(course, sensed, scene.zones):
        return "a zone is where the roll would end if it were broken off"
    return refused(course, sensed, scene, daa, beat_s)


def _at_its_speed(course: Course, sensed: Sensed) -> bool:
    """Whether a climb-out is flown at its planned speed: wind changes the lowest speed over ground."""
    lowest = sensed.ability.min_speed_m_s
    return lowest == course.speed_m_s or (not sensed.on_ground and lowest < course.speed_m_s)


def _may_stop(course: Course, sensed: Sensed, zones: tuple[Zone, ...]) -> bool:
    """Whether the ground ahead keeps the zones up to the stop of a take-off run aborted at its end."""
    here, heading, track = sensed.motion.position, sensed.motion.heading_rad, course.track
    left_m = 0.0 if track is None else max(track.s_m[1] - course.s_m, 0.0)
    stop = along(here, heading, left_m + course.speed_m_s**2 / (2 * BRAKING_M_S2))
    return all(leg_keeps(here, stop, zone, 0.0) for zone in zones)


def first_way_up(
    plan: TakeOff, sensed: Sensed, why_not_by: Callable[[Course], str]
) -> tuple[Course | None, str]:
    """A permitted climb-out, or None and why the first one is not. why_not_by: reason for one, "" if it is
    permitted.
    """
    first = ""
    for course in _ways_up(plan, sensed):
        why = why_not_by(course)
        if not why:
            return course, ""
        first = first or why
    return None, first or NO_WAY


def _is_due(config: Config, plan: TakeOff, sensed: Sensed, before: Rising) -> bool:
    """Whether this heartbeat is one of the vehicle's own for beginning to roll, and a search is due."""
    turn = sensed.now_ms // config.heartbeat_ms % plan.many == plan.turn
    return turn and (not before.why or lasted(before.tried_ms, sensed.now_ms, AGAIN_MS))


def _beat_s(config: Config) -> float:
    return config.heartbeat_ms / 1000
