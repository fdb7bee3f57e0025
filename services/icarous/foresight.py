"""The predictions that an instance submits to the avoidance kernels: its route ahead and its way back."""

from __future__ import annotations

import math

from cratous.core.avoidance.manoeuvre import velocity_of, way_along
from cratous.core.avoidance.prediction import Piece, buffered
from cratous.core.avoidance.resolution import Scene, first_zone_s
from cratous.core.avoidance.way_ahead import near_line, there_within
from cratous.services.icarous.forbidden import BY_ZONE, FREE, Forbidden, by_traffic
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.pace import at_pace, pace_of
from cratous.services.icarous.permits import keeps_volume, way_is_clear
from cratous.services.icarous.return_to_path import (
    flat,
    way_on,
    ways_back,
)
from cratous.services.icarous.route_end import TURN_MARGIN, Ahead, horizon_s, with_hold
from cratous.services.icarous.state import Config, State
from cratous.spec.mission import Daa, Position

ON_PATH_M = 30.0
"""Within this distance of its path a vehicle is predicted to fly along it, otherwise straight on [m]."""
REACHED_S = 0.5
"""A waypoint closer than this [s of flight] counts as reached."""
PASSED_S = 2.0
"""The last waypoint counts as just passed within this distance [s of flight]."""


def scene_of(config: Config, state: State, sensed: Sensed) -> Scene:
    """The scene against which manoeuvres are checked now."""
    daa = config.daa
    volume = buffered(daa.well_clear, daa.buffer)
    zones = state.told.zones
    return Scene(sensed.intruders, zones, volume, daa.lookahead_s, sensed.here, daa.looks_first)


def looked_s(daa: Daa) -> float:
    """How far ahead any result of `predicted` is checked against others [s]."""
    return daa.lookahead_s + buffered(daa.well_clear, daa.buffer).tthr_s


def predicted(config: Config, state: State, sensed: Sensed, scene: Scene) -> Ahead:
    """The predicted flight: along the waypoints and into the hold at their end while on the path (within
    ON_PATH_M), in the hold for PASSED_S past the last one; otherwise straight on.
    """
    told, motion, lookahead_s = state.told, sensed.motion, scene.lookahead_s
    pace = pace_of(told, sensed) if state.paces(sensed.now_ms) else None
    paced, own = at_pace(sensed, pace), config.daa.well_clear
    here, index = flat(motion.position), told.next_index
    if 0 < index < len(told.waypoints):
        ahead = told.waypoints[index:]
        goal = flat(ahead[0])
        if near_line(here, flat(told.waypoints[index - 1]), goal, ON_PATH_M):
            # a waypoint that counts as reached does not give the direction of flight
            if len(ahead) > 1 and there_within(here, goal, motion.speed_m_s, REACHED_S):
                ahead = ahead[1:]
            way = way_along(motion, ahead, horizon_s(scene), pace=pace)
            return with_hold(way, paced, scene, own, TURN_MARGIN, state.beside)
    passed = bool(told.waypoints) and index >= len(told.waypoints)
    if passed and there_within(here, flat(told.waypoints[-1]), motion.speed_m_s, PASSED_S):
        # until another route is sent the vehicle circles here
        way = way_along(motion, (), horizon_s(scene), pace=pace)
        return with_hold(way, paced, scene, own, TURN_MARGIN, state.beside)
    v = velocity_of(motion.heading_rad, motion.speed_m_s, motion.climb_m_s)
    straight = Piece(0.0, lookahead_s, motion.position, v)
    return Ahead((straight,), (scene.volume,), off_plan=bool(told.waypoints) and index > 0)


def way_back_is_free(
    config: Config, state: State, sensed: Sensed, in_turn: frozenset[int], lasting: bool = False
) -> bool:
    """Whether the way onto the path and along it, up to the hold at its end, is free of predicted conflict
    over the look-ahead. Against avoided intruders it must be permitted to the end of the announced route,
    so that one that flies straight on is not met again.

    in_turn: intruders in a turn, whose straight-line prediction beyond the look-ahead is meaningless.
    lasting: the way must be permitted to its end against every intruder seen, and meet no zone.
    """
    return way_back_forbidden(config, state, sensed, in_turn, lasting).free


def way_back_forbidden(
    config: Config, state: State, sensed: Sensed, in_turn: frozenset[int], lasting: bool = False
) -> Forbidden:
    """What forbids the way back, if it is not free (`way_back_is_free`)."""
    if not state.told.waypoints:
        scene = scene_of(config, state, sensed)
        ahead = predicted(config, state, sensed, scene)
        met = next((other.id for other in scene.intruders if ahead.meets(other)), None)
        return FREE if met is None else by_traffic(met)
    return way_forbidden(config, state, sensed, in_turn, points_back(state, sensed), lasting)


def points_back(state: State, sensed: Sensed) -> tuple[Position, ...]:
    """The points along which UxAS flies if it takes the vehicle back now; requires waypoints."""
    tightest_m = sensed.motion.speed_m_s / sensed.ability.turn_rate_rad_s
    return way_on(state.told, sensed.motion, tightest_m)


def way_is_free(
    config: Config,
    state: State,
    sensed: Sensed,
    in_turn: frozenset[int],
    points: tuple[Position, ...],
    lasting: bool = False,
) -> bool:
    """`way_back_is_free` for the way from here by flyable turns onto points[0], and along the rest of points."""
    return way_forbidden(config, state, sensed, in_turn, points, lasting).free


def way_forbidden(
    config: Config,
    state: State,
    sensed: Sensed,
    in_turn: frozenset[int],
    points: tuple[Position, ...],
    lasting: bool = False,
) -> Forbidden:
    """What forbids that way, if it is not free (`way_is_free`): what is found first."""
    scene = scene_of(config, state, sensed)
    pace = pace_of(state.told, sensed)
    flown = at_pace(sensed, pace)
    radius_m = TURN_MARGIN * flown.motion.speed_m_s / flown.ability.turn_rate_rad_s
    now, horizon = sensed.motion, horizon_s(scene)
    avoided = state.avoided - in_turn
    asked = [o for o in scene.intruders if o.id in avoided or (lasting and o.id not in in_turn)]
    for way in ways_back(now, radius_m, points, horizon, pace):
        ahead = with_hold(way, flown, scene, config.daa.well_clear, TURN_MARGIN)
        met = next((other.id for other in scene.intruders if ahead.meets(other)), None)
        if met is not None:
            return by_traffic(met)
        if first_zone_s(ahead.pieces, scene.zones, 5.0) is not None:
            return BY_ZONE
    whole = [one.pieces for one in ways_back(now, radius_m, points, math.inf, pace)]
    if lasting:
        # if a zone lies across it UxAS flies another way than this one
        if any(first_zone_s(pieces, scene.zones, 5.0) is not None for pieces in whole):
            return BY_ZONE
        if not all(keeps_volume(pieces, o, config.daa) for pieces in whole for o in asked):
            return by_traffic()
    if all(way_is_clear(pieces, o, config.daa) for pieces in whole for o in asked):
        return FREE
    return by_traffic()
