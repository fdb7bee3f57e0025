"""Autonomous behaviour without the link, or after a declared failure: what the mission chooses if permitted, else a circle.

The kernel `loss_step` decides at each heartbeat which mode is flown, since when, and until when. The chosen
behaviour and the circle are courses (`services.icarous.course`), permitted from the present position. If no
circle here is permitted, one farther from the nearest aircraft is flown to; if none is, the manoeuvre of least
deviation is flown, as in any takeover. A route that was
not permitted is searched for again after AGAIN_MS. A landing is flown to the gate of its final descent like
any route, and from there to the ground. A procedure that is flown only in hand counts UxAS as heard whenever
UxAS has the vehicle. After a declared failure (`services.icarous.failing`) UxAS counts as never heard again.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from cratous.core.authority.failure import heard_by, loss_declared
from cratous.core.authority.link_loss import (
    FINAL,
    FINISH,
    LAND,
    LANDED,
    LINKED,
    LOITER,
    OVER,
    RETURN,
    loss_step,
)
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.avoidance.resolution import Choice
from cratous.core.avoidance.way_ahead import near_line
from cratous.core.routing.polylines import Track
from cratous.services.icarous import course as courses
from cratous.services.icarous import failing
from cratous.services.icarous.course import Course
from cratous.services.icarous.course_permits import TAKEN, refused, refused_soon
from cratous.services.icarous.course_permits import forbidden as forbidden_courses
from cratous.services.icarous.forbidden import FREE, Forbidden
from cratous.services.icarous.foresight import ON_PATH_M, scene_of
from cratous.services.icarous.landing import approaches, in_order
from cratous.services.icarous.lost_link import LostLink, NoLink
from cratous.services.icarous.messages import Checks, Fails, Sensed, WithoutLink
from cratous.services.icarous.proposal import AGAIN_MS, manoeuvre
from cratous.services.icarous.return_to_path import bearing_rad, flat, onto, rejoin
from cratous.services.icarous.state import IDLE, Config, State
from cratous.spec.authority.cycle import MONITOR
from cratous.spec.authority.link_loss import BEGIN, COMMIT, END, FALL_BACK, NOTHING, REJOIN, TOUCH
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose
from cratous.spec.records import replace

WAITS = "; a circle is flown until it is, where one is permitted"
NO_WAY = "no way there was found"
STAYS = "it does not leave the ground"
ASIDE_PARTS = (1.0, 0.5, 0.25)
"""Distances of a circle elsewhere, in parts of what both aircraft fly in the look-ahead."""
ASIDE_TURNS_RAD = tuple(math.radians(deg) for deg in (0, 45, -45, 90, -90))
"""Its directions, from straight away from the nearest aircraft."""
ENDED = (OVER, FINAL, LANDED)
"""Modes in which no other course is searched for."""


class Tried(NamedTuple):
    """A permitted course for the chosen behaviour, or None and the reason."""

    course: Course | None
    why: str = ""


def heartbeat(
    config: Config, state: State, sensed: Sensed
) -> tuple[State, tuple[WithoutLink, ...]]:
    """The state with the mode and course for this heartbeat, and what to report. `declared` comes before it."""
    plan, now_ms = config.alone(state.failing.failure), sensed.now_ms
    if plan is None:
        return state, ()
    before, tried = state.no_link, Tried(None)
    linked_ms = heard_by(state.failing.failure, state.told.heard_ms)
    if plan.in_hand:
        linked_ms = max(linked_ms, now_ms if _out_of_hand(state) else before.linked_ms)
    linked = in_time(linked_ms, now_ms, plan.after_ms)
    course = before.course
    if course is not None:
        course = course.flown(sensed.motion, _beat_s(config))
    chosen, mode, due, aside_ms = plan.choice, before.loss.mode, False, before.aside_ms
    if not linked and mode not in ENDED and chosen != LOITER and not sensed.on_ground:
        due = mode in (LINKED, chosen) or lasted(before.tried_ms, now_ms, AGAIN_MS)
        going = course if mode == chosen else None
        tried = _tried(config, state, sensed, plan, going) if due else tried
    ended = mode == chosen and course is not None and course.flown_to_its_end
    ended = sensed.landed if mode == FINAL else ended
    stepped = loss_step(
        before.loss, chosen, linked_ms, now_ms, plan.after_ms, tried.course is not None, ended
    )
    mode = stepped.loss.mode
    if stepped.act == REJOIN or sensed.on_ground:
        course = None
    elif stepped.act == COMMIT:
        course = tried.course
    elif mode in (FINAL, LANDED):
        pass  # the final descent is flown as it was permitted
    elif mode == chosen and chosen != LOITER:
        course = tried.course
    elif mode != LINKED:
        course = _circle(config, state, sensed, None if stepped.act == FALL_BACK else course)
        if course is None and lasted(aside_ms, now_ms, AGAIN_MS):
            course, aside_ms = _circle_aside(config, state, sensed, plan), now_ms
    tried_ms = now_ms if due else before.tried_ms
    after = replace(state, no_link=NoLink(stepped.loss, course, tried_ms, linked_ms, aside_ms))
    if stepped.act == NOTHING:
        return after, ()
    if stepped.act == REJOIN:
        after = replace(after, held=None, search=IDLE)
    heard_ms = state.told.heard_ms
    silent = f"nothing was heard of UxAS for {(now_ms - heard_ms) / 1000:g} s"
    if state.failing.declared:
        silent = "after a declared failure"
    vid, why = config.vehicle_id, _words(stepped.act, plan, tried, course, silent)
    if sensed.on_ground and stepped.act != REJOIN:
        why = f"{silent}: {STAYS}"
    return after, (WithoutLink(vid, now_ms, mode, chosen, heard_ms, why),)


def declared(
    config: Config, state: State, sensed: Sensed
) -> tuple[State, tuple[Checks | Fails, ...]]:
    """The state with a failure that is declared now, what was flown by itself until then left, and what is recorded."""
    if config.on_failure is None:
        return state, ()
    before, loss = state.failing, state.no_link.loss
    flies = state.cycle.mode != MONITOR
    asked, beat_ms = config.on_failure.asked, config.heartbeat_ms
    seen = failing.Beat(loss.mode, flies, state.told.stopped, beat_ms)
    now, said = failing.watched(before, asked, seen, sensed, config.vehicle_id)
    loss = loss_declared(before.failure, now.failure, loss)
    state = replace(state, failing=now, no_link=state.no_link._replace(loss=loss))
    if now.declared != before.declared:
        # what follows is no continuation of what was flown without the link
        state = replace(state, no_link=state.no_link._replace(course=None))
    return state, said


def _out_of_hand(state: State) -> bool:
    """Whether UxAS has the vehicle."""
    return state.cycle.mode == MONITOR


def _words(act: int, plan: LostLink, tried: Tried, course: Course | None, silent: str) -> str:
    site = course.site.name if course is not None and course.site is not None else ""
    if act == TOUCH:
        return f"landed at {site}"
    if act == COMMIT:
        return f"the last descent to {site}"
    if act == BEGIN:
        other = "" if site in ("", plan.site) else f", here at {site}"
        return f"{silent}: {plan.words}{other}{tried.why and f' ({tried.why})'}"
    if act == FALL_BACK:
        return f"{silent}: {plan.words}: {tried.why}{WAITS}"
    if act == END:
        return f"{plan.words}: done, a circle is flown there"
    return "UxAS is heard again"


def flown(config: Config, state: State, sensed: Sensed) -> tuple[State, Choice]:
    """The manoeuvre to fly without the link, along the permitted course; on the ground none."""
    course = state.no_link.course
    if state.no_link.loss.mode == LANDED:
        stands = Choice("heading", sensed.motion.heading_rad, 0.0, 0.0, 0.0, True, None)
        return replace(state, held=None, search=IDLE), stands
    assert course is not None, "it flies by itself on a permitted course"
    choice = courses.steered(course, sensed, _beat_s(config))
    return replace(state, held=None, search=IDLE), choice


def forbidden(config: Config, state: State, sensed: Sensed) -> Forbidden:
    """What forbids every course, the circles here being the last ones tried, if none is permitted."""
    if state.no_link.course is not None:
        return FREE
    motion, scene = sensed.motion, scene_of(config, state, sensed)
    here = Pose(*motion.position, motion.heading_rad)
    circles = courses.courses(here, motion, courses.radius_m(sensed), None)
    return forbidden_courses(circles, sensed, scene, config.daa, _beat_s(config))


def avoiding(
    config: Config, state: State, sensed: Sensed, in_turn: frozenset[int]
) -> tuple[State, Choice]:
    """The manoeuvre to fly without the link where no course is permitted."""
    plan = config.alone(state.failing.failure)
    told, goal = state.told, plan.goal if plan else None
    # with RETURN it makes for that place, otherwise it has no goal
    points = () if goal is None else (goal,)
    alone = replace(told, waypoints=points, next_index=0, resume=None)
    after, choice = manoeuvre(config, replace(state, told=alone, goal=0), sensed, in_turn, False)
    return replace(after, told=told, goal=state.goal), choice


def _beat_s(config: Config) -> float:
    return config.heartbeat_ms / 1000


def _tried(
    config: Config, state: State, sensed: Sensed, plan: LostLink, going: Course | None
) -> Tried:
    """The present course if it is still permitted, else another one from here."""
    scene, told = scene_of(config, state, sensed), dict[str, str]()
    for course in _candidates(state, sensed, plan, going):
        why = refused(course, sensed, scene, config.daa, _beat_s(config))
        site = course.site.name if course.site is not None else ""
        if not why:
            # report why a preferred site was not used
            found = course is not going and site not in ("", plan.site)
            return Tried(course, _why_not(plan, sensed, told, site) if found else "")
        if not site or site not in told:
            told[site] = why
    return Tried(None, told.get("") or _why_not(plan, sensed, told, "") or NO_WAY)


def _why_not(plan: LostLink, sensed: Sensed, told: dict[str, str], site: str) -> str:
    """Why the sites before this one in order are not used. told: reason by site why no route there is
    permitted.
    """
    names = [one.name for one in in_order(plan, sensed.motion.position)] if plan.sites else []
    before = names[: names.index(site)] if site in names else names
    told = {**dict.fromkeys(sensed.taken, TAKEN), **told}
    return "; ".join(f"{name}: {told.get(name, NO_WAY)}" for name in before)


def _candidates(
    state: State, sensed: Sensed, plan: LostLink, going: Course | None
) -> Iterator[Course]:
    if going is not None:
        yield going
    if plan.choice == LAND:
        for site in in_order(plan, sensed.motion.position):
            if site.name not in sensed.taken:
                yield from approaches(plan, site, sensed, state.told.zones)
        return
    motion, wide_m = sensed.motion, courses.radius_m(sensed)
    points = _known_way(state, sensed, wide_m) if plan.choice == FINISH else ()
    if plan.choice == RETURN and plan.goal is not None:
        start = Pose(*motion.position, motion.heading_rad)
        end = Pose(*plan.goal, bearing_rad(motion.position, plan.goal))
        slope = sensed.ability.max_climb_m_s / motion.speed_m_s
        points = plan.find(start, end, wide_m, slope, state.told.zones)
    if not points:
        return
    track = Track(points, motion.heading_rad)
    end = Pose(*track.points[-1], track.heading_rad(track.length_m))
    yield from courses.courses(end, motion, wide_m, track)


def _known_way(state: State, sensed: Sensed, wide_m: float) -> tuple[Position, ...]:
    """The rest of the announced route from here; progress is estimated for the time of the silence."""
    told, motion = state.told, sensed.motion
    known = told.waypoints[max(told.next_index - 1, 0) :]
    if not known:
        return ()
    track = Track(known, motion.heading_rad)
    silent_s = (sensed.now_ms - told.heard_ms) / 1000
    near = track.nearest(motion.position, 0.0, 2 * motion.speed_m_s * silent_s + ON_PATH_M)
    rest = track.rest(near.s_m)
    here, place = flat(motion.position), flat(track.at(near.s_m))
    if near_line(here, place, place, ON_PATH_M):
        return (motion.position, *rest[1:])
    ahead = onto(rest, motion, wide_m)
    back = rejoin(motion, wide_m, ahead[0], ahead[1] if ahead[1:] else None)
    return (*back, *ahead[1:])


def _circle(config: Config, state: State, sensed: Sensed, going: Course | None) -> Course | None:
    """The present circle if it is still permitted, else a new one from here; None where none is."""
    motion, scene = sensed.motion, scene_of(config, state, sensed)
    here, wide_m = Pose(*motion.position, motion.heading_rad), courses.radius_m(sensed)
    found = [going] if going is not None else []
    for course in (*found, *courses.courses(here, motion, wide_m, None)):
        if not refused_soon(course, sensed, scene, config.daa, _beat_s(config)):
            return course
    return None


def _circle_aside(config: Config, state: State, sensed: Sensed, plan: LostLink) -> Course | None:
    """A circle as far from the nearest aircraft as both fly in the look-ahead, or in a part of it, with a way there
    that is permitted within the look-ahead; None if there is none.
    """
    motion, scene = sensed.motion, scene_of(config, state, sensed)
    here, wide_m = motion.position, courses.radius_m(sensed)
    near = min(sensed.intruders, key=lambda o: math.dist(o.position, here), default=None)
    away_rad, speed_m_s = motion.heading_rad, motion.speed_m_s
    if near is not None:
        away_rad = bearing_rad(near.position, here)
        speed_m_s += math.hypot(near.velocity.north_m_s, near.velocity.east_m_s)
    start = Pose(*here, motion.heading_rad)
    slope = sensed.ability.max_climb_m_s / motion.speed_m_s
    for part in ASIDE_PARTS:
        far_m = part * speed_m_s * scene.lookahead_s
        for turn_rad in ASIDE_TURNS_RAD:
            heading = away_rad + turn_rad
            north_m, east_m = far_m * math.cos(heading), far_m * math.sin(heading)
            end = Pose(here.north_m + north_m, here.east_m + east_m, here.alt_m, heading)
            points = plan.find(start, end, wide_m, slope, state.told.zones)
            if not points:
                continue
            track = Track(points, motion.heading_rad)
            for course in courses.courses(end, motion, wide_m, track):
                if not refused_soon(course, sensed, scene, config.daa, _beat_s(config)):
                    return course
    return None
