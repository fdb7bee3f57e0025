"""Changes of altitude: accelerate to a climb rate, hold it, level off; and their conflicts.

Definitions: `spec.daa.meaning`. Vertical speed changes at a constant rate accel; in between it is the climb rate, or
the present one if that is faster in the same direction. If there is no room to reach the rate, the level-off begins
at the fastest rate that can be reached.
"""

import math
from math import sqrt
from typing import NamedTuple

import numpy as np

from cratous.core.daa.records import Intruders, Looked, Looking, Manoeuvres, Regaining, Relative
from cratous.core.daa.steps import until
from cratous.core.daa.uncertainty import SUM_KIND, lost
from cratous.core.daa.volume import in_conflict
from cratous.core.kernel import Vec2, driver, kernel
from cratous.core.well_clear.thresholds import Thresholds


class Climb(NamedTuple):
    """The phases of a change of altitude: the rate is reached at t1_s, held to t2_s, level from t3_s on; rate_m_s is
    the rate that is held, up.
    """

    t1_s: float
    t2_s: float
    t3_s: float
    rate_m_s: float


@kernel(implements="daa.meaning.climb_is_flown")
def climb(z_m: float, vz_m_s: float, target_m: float, rate_m_s: float, accel_m_s2: float) -> Climb:
    """The phases from altitude z_m and vertical speed vz_m_s to target_m; rate, accel > 0.

    A target too near to level off at is overshot and then returned to.
    """
    way = target_m - z_m
    up = vz_m_s
    down = target_m < z_m
    if down:
        way = 0 - way
        up = 0 - up
    if up > 0 and up * up > 2 * accel_m_s2 * way:
        way = 0 - way
        up = 0 - up
        down = not down
    most = max(rate_m_s, up)
    # twice accel times the distance flown while reaching the rate and while levelling off
    if 2 * most * most - up * up <= 2 * accel_m_s2 * way:
        t1 = (most - up) / accel_m_s2
        t2 = t1 + (way - (2 * most * most - up * up) / (2 * accel_m_s2)) / most
        peak = most
    else:
        peak = sqrt(accel_m_s2 * way + up * up / 2)
        t1 = (peak - up) / accel_m_s2
        t2 = t1
    t3 = t2 + peak / accel_m_s2
    if down:
        return Climb(t1, t2, t3, 0 - peak)
    return Climb(t1, t2, t3, peak)


class Height(NamedTuple):
    """Altitude [m] and vertical speed [m/s, up]."""

    z_m: float
    vz_m_s: float


@kernel(implements="daa.meaning.accelerated")
def height(
    z_m: float, vz_m_s: float, target_m: float, accel_m_s2: float, phases: Climb, t_s: float
) -> Height:
    """Altitude and vertical speed t_s after the beginning of a `climb` with these phases."""
    t1_s, t2_s, t3_s, rate_m_s = phases
    if t_s > t3_s:
        return Height(target_m, 0)
    if t_s <= t1_s:
        change = accel_m_s2
        if rate_m_s < vz_m_s:
            change = 0 - accel_m_s2
        return Height(z_m + t_s * vz_m_s + t_s * t_s * change / 2, vz_m_s + t_s * change)
    reached = z_m + (vz_m_s + rate_m_s) * t1_s / 2
    if t_s <= t2_s:
        return Height(reached + (t_s - t1_s) * rate_m_s, rate_m_s)
    change = accel_m_s2
    if rate_m_s > 0:
        change = 0 - accel_m_s2
    since = t_s - t2_s
    begun = reached + (t2_s - t1_s) * rate_m_s
    return Height(begun + since * rate_m_s + since * since * change / 2, rate_m_s + since * change)


@driver(checked_by=("in_conflict", "climb", "height", "until"))
def altitude_conflict(
    ways: Manoeuvres, target_m: float, other: np.ndarray, kind: int, w: np.ndarray, span: Looked,
    looking: Looking,
):  # fmt: skip
    """Whether the change to target_m conflicts with one intruder at span.from_s or later.

    Sampled every ways.sample_s while the vertical speed changes, exact while it is constant; rate
    or accel 0: at once. other: (6,) state of the intruder now; kind, w: its volume, as in `lost`.
    """
    own, rate_m_s, accel_m_s2, sample_s = (
        ways.right[0],
        ways.rate_m_s,
        ways.accel_m_s2,
        ways.sample_s,
    )
    from_s, horizon_s, whole = span.from_s, span.until_s, span.whole
    lookahead_s, counted, project_s = looking.lookahead_s, looking.counted, looking.project_s
    z0 = own[2] + own[5] * project_s
    x0 = own[0] - other[0] + (own[3] - other[3]) * project_s
    y0 = own[1] - other[1] + (own[4] - other[4]) * project_s
    h0 = other[2] + other[5] * project_s
    v = Vec2(own[3] - other[3], own[4] - other[4])
    if rate_m_s == 0 or accel_m_s2 == 0:
        level = Relative(Vec2(x0, y0), v, target_m - h0, 0.0 - other[5])
        return lost(kind, level, w, 0.0, from_s, min(lookahead_s, horizon_s))
    phases = climb(z0, own[5], target_m, rate_m_s, accel_m_s2)
    t1, t2, t3, rate = phases
    level_s = t3 + sample_s
    cruise_s = horizon_s
    final_s = horizon_s
    if not whole:
        cruise_s = until(lookahead_s, horizon_s, t1, counted)
        final_s = until(lookahead_s, horizon_s, level_s, counted)
    # straight flight at the new altitude
    level = Relative(
        Vec2(x0 + v.x * level_s, y0 + v.y * level_s), v,
        target_m - h0 - other[5] * level_s, 0.0 - other[5],
    )  # fmt: skip
    if max(from_s, level_s) <= final_s and lost(
        kind, level, w, level_s, max(from_s - level_s, 0.0), final_s - level_s
    ):
        return True
    if t2 > t1 and max(from_s, t1) <= min(cruise_s, t2):
        z1, _ = height(z0, own[5], target_m, accel_m_s2, phases, t1)
        cruise = Relative(
            Vec2(x0 + v.x * t1, y0 + v.y * t1), v, z1 - h0 - other[5] * t1, rate - other[5]
        )
        if lost(kind, cruise, w, t1, max(from_s - t1, 0.0), min(cruise_s, t2) - t1):
            return True
    for phase in range(2):
        begin, end = 0.0, t1
        if phase == 1:
            begin, end = math.ceil(t2 / sample_s) * sample_s, level_s
        t = max(begin, math.ceil(from_s / sample_s) * sample_s)
        while t <= end and t <= final_s:
            zt, vt = height(z0, own[5], target_m, accel_m_s2, phases, t)
            there = Relative(
                Vec2(x0 + v.x * t, y0 + v.y * t), v, zt - h0 - other[5] * t, vt - other[5]
            )
            if lost(kind, there, w, t, 0.0, 0.0):
                return True
            t += sample_s
    return False


@driver(checked_by=("in_conflict",))
def in_reach(
    own: np.ndarray, intruders: Intruders, i: int, regaining: Regaining, looking: Looking
) -> tuple[bool, bool]:
    """Whether intruder i's volume can matter at any altitude, and whether its recovery cylinder can: only altitudes
    change, the flight over ground does not.

    An intruder that is not in conflict at equal height is not in conflict at any height and climb rate
    (`daa_conflict_at_no_height_beside`).
    """
    other, w, kind = intruders.states[i], intruders.volumes[i], intruders.kinds[i]
    until_s = max(looking.lookahead_s, intruders.horizons[i])
    v = Vec2(own[3] - other[3], own[4] - other[4])
    s = Vec2(
        own[0] - other[0] + v.x * looking.project_s, own[1] - other[1] + v.y * looking.project_s
    )
    volume = Thresholds(w[0], w[1], w[2], w[3], w[4])
    near = regaining.begin_s <= intruders.horizons[i] and (
        kind == SUM_KIND or in_conflict(kind, s, v, 0.0, 0.0, volume, 0.0, until_s)
    )
    cylinder = Thresholds(regaining.radius_m, regaining.half_m, 0.0, 0.0, 0.0)
    held = regaining.recovering and in_conflict(3, s, v, 0.0, 0.0, cylinder, 0.0, until_s)
    return near, held


@driver(checked_by=("in_conflict", "climb", "height", "until"))
def safe_altitudes(
    ways: Manoeuvres, intruders: Intruders, chosen: np.ndarray, regaining: Regaining,
    looking: Looking, safe: np.ndarray,
):  # fmt: skip
    """Which target altitudes are free of conflict with all chosen intruders, into `safe`.

    Arguments as for `safe_steps`. Returns whether two neighbouring altitudes are safe, or any one if
    single.
    """
    targets, others, kinds, volumes = (
        ways.targets,
        intruders.states,
        intruders.kinds,
        intruders.volumes,
    )
    horizons, begin_s = intruders.horizons, regaining.begin_s
    found = False
    lead = 0
    cylinder = np.zeros(11)
    cylinder[0], cylinder[1] = regaining.radius_m, regaining.half_m
    near, held_clear = np.zeros(chosen.size, dtype=np.bool_), np.zeros(chosen.size, dtype=np.bool_)
    for c in range(chosen.size):
        near[c], held_clear[c] = in_reach(ways.right[0], intruders, chosen[c], regaining, looking)
    for k in range(targets.size):
        red = False
        for c in range(chosen.size):
            q = c
            if c == 0:
                q = lead
            elif c <= lead:
                q = c - 1
            i = chosen[q]
            if near[q] and begin_s <= horizons[i]:
                red = altitude_conflict(
                    ways, targets[k], others[i], kinds[i], volumes[i],
                    Looked(begin_s, horizons[i], False), looking,
                )  # fmt: skip
            if regaining.recovering and held_clear[q] and not red:
                held = Looked(0.0, min(begin_s, horizons[i]), begin_s <= horizons[i])
                red = altitude_conflict(ways, targets[k], others[i], 3, cylinder, held, looking)
            if red:
                lead = q
                break
        safe[k] = not red
        if safe[k] and (looking.single or (k > 0 and safe[k - 1])):
            found = True
            if looking.early:
                break
    return found
