"""A way in time from a present motion to a place, past zones and traffic: the question and its three answers.

The search proposes; the kernels that permit routes and manoeuvres permit each stretch, and the whole way once more. The
budget is a number of checks, derived from a rate, so the answer depends on no clock.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple

from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Piece
from cratous.core.permit.remainder import hold_at, hold_permits
from cratous.core.requirements.verdict import reaches
from cratous.core.ways_in_time.grid import Craft, Grid
from cratous.core.ways_in_time.scene import Checks, Scene
from cratous.core.ways_in_time.search import (
    EXHAUSTED,
    FOUND,
    FULL,
    OVERDUE,
    REFUSED,
    SPENT,
    Budget,
    Found,
    Search,
)
from cratous.services.ways_in_time.excluded import excluded
from cratous.services.ways_in_time.places import places_of
from cratous.spec.mission import Position

BUDGET_S = 0.5
"""Time for one search [s]."""
CHECKS_PER_S = 50_000
"""Checks that a slow core makes in a second. A search ends at the first state after the budget's; laying out the grid and
the last check of the whole way are not cut short.
"""
STATES = 60_000
"""Greatest number of states in memory; each takes less than a kilobyte."""
BINS = 60
"""A horizon has so many instants that are told apart,"""
LEAST_BIN_S = 2.0
"""but they are no closer to each other than this [s]."""
LATER = 2.0
"""The default horizon is the time of a straight flight at the slowest speed, this many times,"""
MORE_S = 120.0
"""and this much more [s]."""


class Outcome(StrEnum):
    """The three answers."""

    PATH = "path"
    NO_PATH = "no path exists"
    NONE_IN_TIME = "none found in time"


class Asked(NamedTuple):
    """now: present motion; goal: where to; ability: of the airframe, with the
    turn rate that may be used at the present speed; horizon_s: by when the goal
    must be reached, None for `LATER` straight flights; layers_m: altitudes that may be used beside those of start and
    goal [m MSL]; speeds_m_s: to be flown, the preferred first; () for the present, least and greatest speed.
    """

    now: Motion
    goal: Position
    ability: Ability
    horizon_s: float | None = None
    layers_m: tuple[float, ...] = ()
    speeds_m_s: tuple[float, ...] = ()


class Answer(NamedTuple):
    """outcome; reason: of what there is none, or what was spent; pieces: the way, segments timed from now; rho_m: bound
    on the deviation of the flight from them [m]; checks, states: what the search took.
    """

    outcome: Outcome
    reason: str
    pieces: tuple[Piece, ...] = ()
    rho_m: float = 0.0
    checks: int = 0
    states: int = 0


def way_in_time(
    asked: Asked,
    scene: Scene,
    budget_s: float = BUDGET_S,
    overdue: Callable[[], bool] | None = None,
) -> Answer:
    """A way to the goal at the speeds asked for that keeps the zones and, at every instant until it ends, every
    intruder's volume clear. ValueError if a zone has padding, or a speed is not positive.

    `path`: the whole way was put to the kernels. `no path exists`: the reason says of what: no path at all, where zones
    or traffic already exclude it, else none on the grid of legs, which was searched whole. `none found in time`: the
    budget was spent. overdue: asked at each state; where it is true the search ends, and says so.
    """
    if why := _impossible(asked, scene):
        return Answer(Outcome.NO_PATH, why)
    grid = _grid(asked, scene)
    budget = _budget(asked, grid.craft, budget_s)
    found = Search(grid, budget, overdue).run()
    spent = grid.checks.calls, found.states
    if found.end == FOUND:
        last = found.pieces[-1]
        text = f"{last.start_s + last.duration_s:.1f} s, permitted against all that is known"
        return Answer(Outcome.PATH, text, found.pieces, found.rho_m, *spent)
    outcome = Outcome.NO_PATH if found.end == EXHAUSTED else Outcome.NONE_IN_TIME
    return Answer(outcome, _why(found, grid, budget), (), 0.0, *spent)


def _impossible(asked: Asked, scene: Scene) -> str:
    """Why no path exists at all; "" where that is not known."""
    start = asked.now.position
    if why := excluded(start, asked.goal, scene.zones, asked.layers_m):
        return why
    for other in scene.intruders:
        if not hold_permits(hold_at(start, 0.0, 0.0), other, scene.volume, 0.0, 0.0):
            return f"its start is within the volume of intruder {other.id}"
    return ""


def _grid(asked: Asked, scene: Scene) -> Grid:
    """The grid of a question."""
    now, ability = asked.now, asked.ability
    least, most = ability.min_speed_m_s, ability.max_speed_m_s
    present = min(max(now.speed_m_s, least), most)
    speeds = asked.speeds_m_s or tuple(dict.fromkeys((present, least, most)))
    slowest = min(*speeds, now.speed_m_s)
    if reaches(0.0, slowest):
        raise ValueError(f"a speed that is not positive: {slowest} m/s")
    lateral = now.speed_m_s * ability.turn_rate_rad_s
    craft = Craft(speeds, lateral, ability.acceleration_m_s2, ability.max_climb_m_s)
    start, speed = now.position, speeds[0]
    layers = [alt for alt in asked.layers_m if reaches(alt, ability.floor_m)]
    places = places_of(start, asked.goal, speed, craft.radius_m(speed), scene, layers)
    return Grid(now, places, craft, Checks(scene))


def _budget(asked: Asked, craft: Craft, budget_s: float) -> Budget:
    horizon_s = asked.horizon_s
    if horizon_s is None:
        p, q = asked.now.position, asked.goal
        straight_m = math.hypot(q.north_m - p.north_m, q.east_m - p.east_m)
        horizon_s = LATER * straight_m / min(craft.speeds_m_s) + MORE_S
    bin_s = max(LEAST_BIN_S, horizon_s / BINS)
    return Budget(math.floor(budget_s * CHECKS_PER_S), STATES, horizon_s, bin_s)


def _why(found: Found, grid: Grid, budget: Budget) -> str:
    """Why a search has no way."""
    if found.end == EXHAUSTED:
        speeds = ", ".join(f"{speed:g}" for speed in grid.craft.speeds_m_s)
        told = f"{len(grid.places)} places, {grid.legs()} legs, {speeds} m/s"
        if grid.checks.scene.intruders:
            told += f", instants told apart by {budget.bin_s:g} s, until {budget.horizon_s:.0f} s"
        return f"no path on this grid of legs ({told}); elsewhere was not searched"
    return {
        SPENT: f"{grid.checks.calls} checks made, the budget is {budget.calls}",
        FULL: f"{budget.states} states in memory, as many as may be",
        OVERDUE: f"ended by the clock after {grid.checks.calls} checks",
        REFUSED: "the way that was found is refused as a whole",
    }[found.end]
