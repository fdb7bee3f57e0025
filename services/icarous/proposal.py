"""The manoeuvre that an instance flies: preferably the turn after which the way back is free soonest.

Candidates are turns that keep clear over the whole look-ahead, up to 60 degrees off the course, or up to 90
where that is over much sooner. Such a turn is flown until the way back is free at one of the instants
checked: permanently (permitted to its end against everybody, no zone across it) if possible, else for the
look-ahead. If there is none, a way in time to the waypoint is searched (`timed_way`), flown while there is a
certificate for it; without one the manoeuvre of least deviation is flown (`core.avoidance.resolution`). Where
the mission prefers changes of altitude or speed, these are tried before turns, starting with the bands'
resolutions. Where nothing keeps well clear, the recovery bands are tried first. This module only proposes:
control goes back only on a way that is free when it is flown.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from cratous.core.authority.cycle import patience
from cratous.core.authority.timeliness import lasted
from cratous.core.avoidance.manoeuvre import Motion, fly_to
from cratous.core.avoidance.prediction import after, later
from cratous.core.avoidance.resolution import (
    Choice,
    Scene,
    first_conflict_s,
    keeps_clear,
    of_kind,
    resolve,
    turn_back_s,
)
from cratous.services.icarous.foresight import points_back, scene_of, way_back_is_free
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.offers import Refused, certified
from cratous.services.icarous.return_to_path import PERSIST_MS, bearing_rad, goal_index
from cratous.services.icarous.route_end import cylinder
from cratous.services.icarous.state import Config, Search, State
from cratous.services.icarous.timed_way import KIND, Timed, followed, proposed
from cratous.spec.daa.parameters import NMAC_HALF_HEIGHT_M, NMAC_RADIUS_M
from cratous.spec.mission import Position, WellClear
from cratous.spec.records import replace

STEPS = 15
"""Number of instants per look-ahead at which the way back is checked; the last third is left out."""
TURNS_DEG = (10, 20, 30, 40, 50, 60)
"""Turns off the course that are tried, right and left [deg]."""
WIDE_DEG = (75, 90)
"""Wider turns [deg]. They lead farther away, so they are used only for a permanently free way back,"""
SOONER = 4
"""and only if it is free this many instants sooner than after a smaller turn that also leads to one."""
AGAIN_MS = 5000
"""After an unsuccessful search, the next one follows this much later [ms]."""


class Found(NamedTuple):
    """A manoeuvre, the number of the instant at which the way back is free after it, and whether it is then
    permitted to its end against everybody.
    """

    choice: Choice
    step: int
    lasting: bool


def manoeuvre(
    config: Config, state: State, sensed: Sensed, in_turn: frozenset[int], free: bool
) -> tuple[State, Choice]:
    """The manoeuvre to fly now, and the state that records it with its goal waypoint. free: the way back is
    free now.
    """
    state, goal = _with_goal(state, sensed)
    motion, now_ms, search = sensed.motion, sensed.now_ms, state.search
    course = bearing_rad(motion.position, goal) if goal is not None else motion.heading_rad
    speed = state.told.speed_m_s or motion.speed_m_s
    scene = scene_of(config, state, sensed)
    held, timed = state.held, state.timed
    if held is not None and timed is not None:
        # on another route, or with none as without the link, it leads to a place of the past
        same = timed.route == state.told.waypoints
        follows = _permitted(timed, scene, config, sensed) if same else None
        if follows is not None:
            return replace(state, held=follows), follows
        held = None
    state = replace(state, held=held, timed=None)
    lasts = held is not None and not lasted(search.until_ms, now_ms, 0)
    if held is not None and lasts and keeps_clear(motion, sensed.ability, scene, held):
        return state, held
    if not free and (held is None or search.until_ms or lasted(search.at_ms, now_ms, AGAIN_MS)):
        found = _soonest(config, state, sensed, in_turn, (course, speed))
        state = replace(state, search=Search(now_ms, 0))
        if found is not None:
            at_s = found.step * scene.lookahead_s / STEPS
            waits_ms = patience(state.cycle.relapses, PERSIST_MS) + 2 * config.heartbeat_ms
            search = Search(now_ms, now_ms + math.ceil(1000 * at_s) + waits_ms, found.lasting)
            return replace(state, held=found.choice, search=search), found.choice
        timed = _in_time(config, state, sensed, scene)
        follows = None if timed is None else _permitted(timed, scene, config, sensed)
        if follows is not None:
            return replace(state, held=follows, timed=timed), follows
    choice = resolve(motion, sensed.ability, scene, course, speed, held)
    if not choice.clear:
        choice = _recovery(config, state, sensed, choice) or choice
    return replace(
        state, held=choice, search=state.search._replace(until_ms=0, lasting=False)
    ), choice


def _soonest(
    config: Config,
    state: State,
    sensed: Sensed,
    in_turn: frozenset[int],
    flying: tuple[float, float],
) -> Found | None:
    """The manoeuvre after which the way back is free soonest; among equals the course itself, then the bands'
    resolutions, then the smallest turn. None if there is none.

    A permanently free way back is preferred to one that is free for the look-ahead. flying: course [rad],
    speed [m/s].
    """
    course, speed = flying
    scene = scene_of(config, state, sensed)
    level = Choice("heading", course, speed, 0.0, 0.0, True, None)

    def after_turns(turns: Sequence[float], until: int) -> Found | None:
        return first([level._replace(heading_rad=course + turn) for turn in turns], until)

    def first(choices: Sequence[Choice], until: int) -> Found | None:
        clear = [
            one._replace(clear=True)
            for one in choices
            if keeps_clear(sensed.motion, sensed.ability, scene, one)
        ]
        found = None
        for k in range(1, until + 1):
            for choice in clear:
                then = _later(sensed, choice, k * scene.lookahead_s / STEPS)
                if way_back_is_free(config, state, then, in_turn, True):
                    return Found(choice, k, True)
                if found is None and way_back_is_free(config, state, then, in_turn):
                    found = Found(choice, k, False)
        return found

    last = 2 * STEPS // 3
    asked = (
        *_by_bands(config, state, sensed, level),
        *of_kind(scene.first, sensed.motion, sensed.ability, scene, level),
    )
    found = first(asked, last) if asked else None
    if found is not None:
        return found
    told = _told(state, course)
    right_first = not told or told[0] >= 0
    found = after_turns((0.0, *told, *_either_side(TURNS_DEG, right_first)), last)
    until = found.step - SOONER if found is not None and found.lasting else last
    wide = after_turns(_either_side(WIDE_DEG, right_first), until)
    return wide if wide is not None and wide.lasting else found


def _in_time(config: Config, state: State, sensed: Sensed, scene: Scene) -> Timed | None:
    """A way in time onto the path of UxAS; None without a path, or if none is found."""
    if not state.told.waypoints:
        return None
    points = points_back(state, sensed)
    found = proposed(scene, config.daa, sensed, points)
    return None if found is None else found._replace(route=state.told.waypoints)


def _permitted(timed: Timed, scene: Scene, config: Config, sensed: Sensed) -> Choice | None:
    """The velocity by which a way in time is followed now; None where it is not followed, or there is no certificate for
    that velocity.
    """
    follows = followed(timed, scene, config.daa, sensed)
    if follows is None or isinstance(certified(sensed, scene, follows, config.daa), Refused):
        return None
    return follows


def _by_bands(config: Config, state: State, sensed: Sensed, level: Choice) -> tuple[Choice, ...]:
    """The bands' resolutions of the kind that the mission prefers."""
    if state.bands is None:
        return ()
    from cratous.services.icarous.band_choices import of_bands

    return of_bands(state.bands, config.daa, sensed, level)


def _recovery(config: Config, state: State, sensed: Sensed, least: Choice) -> Choice | None:
    """The recovery manoeuvre of the bands where no manoeuvre keeps well clear: the first that avoids a near
    mid-air collision over the look-ahead, and zones for the turn-back time. None if there is none, or the
    bands have no recovery.

    least: the manoeuvre that keeps well clear longest.
    """
    if state.bands is None or not state.bands.recovers:
        return None
    from cratous.services.icarous.band_choices import recovering

    motion, ability, scene = sensed.motion, sensed.ability, scene_of(config, state, sensed)
    speed = state.told.speed_m_s or motion.speed_m_s
    level = Choice("heading", motion.heading_rad, speed, 0.0, 0.0, False, least.first_violation_s)
    near = scene._replace(intruders=(), lookahead_s=turn_back_s(motion, ability))
    hit = scene._replace(volume=nmac_of(config.daa.well_clear))
    for one in recovering(state.bands, config.daa, sensed, level):
        pieces = fly_to(motion, ability, *one[1:5], scene.lookahead_s)
        if keeps_clear(motion, ability, near, one) and first_conflict_s(pieces, hit) is None:
            first_s = first_conflict_s(pieces, scene)
            return one._replace(first_violation_s=first_s, clear=first_s is None)
    return None


def nmac_of(own: WellClear) -> WellClear:
    """The near mid-air collision cylinder, no larger than the mission's own volume."""
    radius_m, half_m = min(NMAC_RADIUS_M, own.dthr_m), min(NMAC_HALF_HEIGHT_M, own.zthr_m)
    return cylinder(radius_m, half_m)


def _told(state: State, course_rad: float) -> tuple[float, ...]:
    """The turns off the course that the bands propose, the preferred one first, within the small turns [rad]."""
    if state.bands is None:
        return ()
    from cratous.services.icarous.bands import resolutions

    most = math.radians(TURNS_DEG[-1])
    return tuple(turn for turn in resolutions(state.bands, course_rad) if abs(turn) <= most)


def _either_side(turns_deg: Sequence[int], right_first: bool) -> list[float]:
    """Turns to either side, one side first for each angle [rad]."""
    sides = (1, -1) if right_first else (-1, 1)
    return [side * math.radians(k) for k in turns_deg for side in sides]


def _later(sensed: Sensed, choice: Choice, t_s: float) -> Sensed:
    """The predicted sensor input t_s [s] from now, if the manoeuvre is flown and all others fly as predicted."""
    last = fly_to(sensed.motion, sensed.ability, *choice[1:5], t_s)[-1]
    place, v = after(last, last.duration_s), last.velocity
    heading, speed = math.atan2(v.east_m_s, v.north_m_s), math.hypot(v.north_m_s, v.east_m_s)
    others = tuple(later(other, t_s) for other in sensed.intruders)
    return sensed._replace(motion=Motion(place, heading, speed, -v.down_m_s), intruders=others)


def _with_goal(state: State, sensed: Sensed) -> tuple[State, Position | None]:
    """The waypoint to make for, recorded in the state; None if no waypoints are known."""
    waypoints = state.told.waypoints
    if not waypoints:
        return state, None
    radius_m = sensed.motion.speed_m_s / sensed.ability.turn_rate_rad_s
    index = goal_index(sensed.motion, radius_m, waypoints, min(state.goal, len(waypoints) - 1))
    return replace(state, goal=index), waypoints[index]


def describe(choice: Choice) -> str:
    """A manoeuvre in words, for the record; it says when it is not free of conflict."""
    heading = round(math.degrees(choice.heading_rad)) % 360
    if choice.kind == KIND:
        return "a way in time, past all traffic"
    text = f"heading {heading:03d}"
    if choice.kind == "altitude":
        text += f", climb {choice.climb_m_s:+.1f} m/s"
    if choice.kind == "speed":
        text += f", speed {choice.speed_m_s:.1f} m/s"
    if not choice.clear:
        text += f"; no manoeuvre is free of conflict, this one is until {choice.first_violation_s:.1f} s"
    return text
