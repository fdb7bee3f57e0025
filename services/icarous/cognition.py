"""Decision logic: what an instance has seen at a heartbeat, the mode that the kernel `decide` makes of it, and what is
flown in that mode.

In each mode something is checked that would be flown if nothing were avoided: under UxAS its plan, or straight flight off
the plan; under ICAROUS the way back; without the link, after a declared failure and at a merge fix the course found. Where
traffic or a zone forbids it, the conflict is avoided. Where UxAS has given up a leg or planned anew meanwhile, the way back
leads to another waypoint than the next one of the route that was left.
"""

from __future__ import annotations

import math

from cratous.core.authority.cognition import (
    DITCH,
    FAILED,
    LAND,
    LANDED,
    LOST_LINK,
    MERGING,
    TAKE_OFF,
    Conditions,
    decide,
    mode_avoids,
    mode_lets_go,
    resolution,
    turns_by,
)
from cratous.core.authority.link_loss import FINAL, LINKED
from cratous.core.authority.link_loss import LAND as TO_LAND
from cratous.core.authority.link_loss import LANDED as AT_REST
from cratous.core.authority.take_off import departure_takes
from cratous.core.avoidance.resolution import Choice
from cratous.core.kernel import Vec2
from cratous.core.merging.stages import merging_takes
from cratous.core.permit.tubes import disc_within
from cratous.services.icarous import link_loss, merging, take_off
from cratous.services.icarous.forbidden import FREE, Forbidden
from cratous.services.icarous.messages import Decides, Sensed
from cratous.services.icarous.proposal import manoeuvre
from cratous.services.icarous.state import Config, State
from cratous.services.icarous.timed_way import KIND as WAY
from cratous.spec.authority.cycle import MONITOR
from cratous.spec.records import replace

BY_ITSELF = (LOST_LINK, FAILED, DITCH, LAND, LANDED)
"""Modes in which a course without the link, or after a declared failure, is flown."""
STRAIGHT_RAD = math.radians(1.0)
"""A manoeuvre within this angle of the present heading is no turn."""
SAME_SHARE = 0.1
"""On a way in time a climb within this share of the greatest, and a speed within it of the announced one, is none."""


def decided(
    config: Config, state: State, sensed: Sensed, forbidden: Forbidden, off_plan: bool = False
) -> State:
    """The state with the mode of this heartbeat. forbidden: what forbids that which is flown if nothing is avoided;
    off_plan: UxAS has the vehicle, off its plan.
    """
    before, told, has = state.decided, state.told, state.cycle.mode != MONITOR
    left, first = before.left, before.next_index
    if not has:
        left, first = told.waypoints, told.next_index
    skipped = 0
    if has and left is not told.waypoints:
        still = frozenset(told.waypoints)
        skipped = sum(place not in still for place in left[first:])
    loss, departure = state.no_link.loss.mode, take_off.rising(config, state).departure
    seen = Conditions(
        landed=loss == AT_REST,
        descends=loss == FINAL,
        departs=departure_takes(departure, False),
        traffic=forbidden.traffic,
        fence=forbidden.zone,
        lands=loss == TO_LAND,
        failed=state.failing.declared,
        alone=loss != LINKED,
        merges=merging_takes(state.merging.stage, False),
        has=has,
        skips=skipped > 0,
        deviates=off_plan,
    )
    mode, by = decide(before.mode, seen), forbidden.intruder_id
    after = before._replace(
        mode=mode, seen=seen, intruder_id=by, left=left, next_index=first, skipped=skipped
    )
    return replace(state, decided=after)


def by_itself(config: Config, state: State) -> bool:
    """Whether ICAROUS flies a course of its own: to take off, to merge, without the link, or after a failure."""
    departs = take_off.departs(config, state)
    alone = state.no_link.loss.mode != LINKED
    return departs or merging_takes(state.merging.stage, alone)


def course_forbidden(config: Config, state: State, sensed: Sensed) -> Forbidden:
    """What forbids every course that could be flown by itself now; `FREE` where one is permitted."""
    lost = state.no_link.loss.mode
    if take_off.departs(config, state) or lost in (FINAL, AT_REST):
        return FREE
    if lost != LINKED:
        return link_loss.forbidden(config, state, sensed)
    return merging.forbidden(config, state, sensed)


def flown(
    config: Config, state: State, sensed: Sensed, in_turn: frozenset[int]
) -> tuple[State, Choice]:
    """What is flown in the mode of this heartbeat, if ICAROUS flies."""
    mode = state.decided.mode
    if mode == TAKE_OFF:
        return take_off.flown(config, state, sensed)
    if mode in BY_ITSELF:
        return link_loss.flown(config, state, sensed)
    if mode == MERGING:
        return merging.flown(config, state, sensed)
    if mode_avoids(mode) and state.decided.seen.alone:
        return link_loss.avoiding(config, state, sensed, in_turn)
    return manoeuvre(config, state, sensed, in_turn, mode_lets_go(mode))


def _on_a_way(state: State, sensed: Sensed, held: Choice) -> tuple[bool, bool]:
    """Whether a way in time climbs or descends now, and whether it is flown at another speed than the announced one."""
    speed, climbs_m_s = state.told.speed_m_s or sensed.motion.speed_m_s, Vec2(held.climb_m_s, 0.0)
    faster_m_s = Vec2(held.speed_m_s - speed, 0.0)
    level = disc_within(climbs_m_s, 0.0, SAME_SHARE * sensed.ability.max_climb_m_s)
    return not level, not disc_within(faster_m_s, 0.0, SAME_SHARE * speed)


def told(
    config: Config, state: State, before: State, sensed: Sensed
) -> tuple[State, tuple[Decides, ...]]:
    """The state with how a conflict is avoided, and the record of mode and conditions if something has changed since
    `before`.
    """
    now, held = state.decided, state.held
    turns = climbs = paces = False
    if held is not None:
        off_rad = math.remainder(held.heading_rad - sensed.motion.heading_rad, math.tau)
        climbs, paces = held.kind == "altitude", held.kind == "speed"
        turns = held.kind == "heading" or turns_by(off_rad, STRAIGHT_RAD)
        if held.kind == WAY:
            climbs, paces = _on_a_way(state, sensed, held)
    clear = held is not None and held.clear
    now = now._replace(resolution=resolution(now.mode, turns, climbs, paces, clear))
    state, was = replace(state, decided=now), before.decided
    same = (now.mode, now.seen, now.resolution, now.skipped) == (
        was.mode, was.seen, was.resolution, was.skipped,
    )  # fmt: skip
    if same or not config.records:
        return state, ()
    return state, (
        Decides(
            config.vehicle_id, sensed.now_ms, now.mode, now.resolution, now.intruder_id, now.skipped, now.seen,
        ),
    )  # fmt: skip
