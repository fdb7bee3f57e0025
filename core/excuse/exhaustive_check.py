"""An independent, exhaustive check of every manoeuvre, implemented separately from the bands.

It shares only the parameters with `core.daa.bands`, `core.daa.steps` and `core.daa.climb`: each manoeuvre is
integrated in ticks of TICK_S from the own state under its rates, and the path between two ticks is a straight segment
from the one position to the other. Each segment is checked by the times kernel `conflict_span` (the bands use
`in_conflict`), and the answers go to the folds of `core.excuse.way_out`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from cratous.core.daa.state import DIMENSIONS, Aircraft
from cratous.core.daa.volume import conflict_span
from cratous.core.excuse.state import OPEN, REFUSED, SURELY, Other, Tried
from cratous.core.excuse.way_out import after_piece, manoeuvre_judged, way_out
from cratous.core.readings.machine.compiled import compiled
from cratous.spec.daa.parameters import G_M_S2, Parameters

TICK_S = 0.25
"""Length of the ticks in which manoeuvres are integrated [s]."""
NEAR_ENOUGH = 1e-9


class Targets(NamedTuple):
    """The target of each manoeuvre: the quantity `which` (0 hdir, 1 hs, 2 vs, 3 alt) reaches `value`."""

    which: np.ndarray
    value: np.ndarray


def _multiples(low: float, high: float, own: float, step: float) -> np.ndarray:
    """own and own +- multiples of step within [low, high]."""
    down = math.floor((own - low) / step + NEAR_ENOUGH)
    up = math.floor((high - own) / step + NEAR_ENOUGH)
    return own + step * np.arange(-down, up + 1)


def _limits(low: float, high: float, below: float, above: float, own: float) -> tuple[float, float]:
    """The range of a dimension: absolute, or relative to the own value where distances are given."""
    if below == 0 and above == 0:
        return low, high
    return (low if below < 0 else max(low, own - below)), (
        high if above < 0 else min(high, own + above)
    )


def targets(p: Parameters, own: Aircraft) -> tuple[Targets, str]:
    """All targets on the grid, and which own values lie outside their range."""
    heading = math.atan2(own.ve_m_s, own.vn_m_s)
    speed = math.hypot(own.ve_m_s, own.vn_m_s)
    hdir = _multiples(
        heading - p.left_hdir_rad, heading + p.right_hdir_rad, heading, p.step_hdir_rad
    )
    parts, why = [(0, hdir)], []
    ranges = (
        (1, speed, p.step_hs_m_s, p.min_hs_m_s, p.max_hs_m_s, p.below_relative_hs_m_s, p.above_relative_hs_m_s),
        (2, own.vu_m_s, p.step_vs_m_s, p.min_vs_m_s, p.max_vs_m_s, p.below_relative_vs_m_s, p.above_relative_vs_m_s),
        (3, own.alt_m, p.step_alt_m, p.min_alt_m, p.max_alt_m, p.below_relative_alt_m, p.above_relative_alt_m),
    )  # fmt: skip
    for which, now, step, least, most, below, above in ranges:
        low, high = _limits(least, most, below, above, now)
        if not low <= now <= high:
            why.append(f"own {DIMENSIONS[which]} {now:g} is outside of [{low:g}, {high:g}]")
            continue
        # altitudes are counted from the lowest one, all other values from the own one
        parts.append((which, _multiples(low, high, low if which == 3 else now, step)))
    return Targets(
        np.concatenate([np.full(len(v), which, dtype=np.int64) for which, v in parts]),
        np.concatenate([v for _, v in parts]),
    ), "; ".join(why)


def _turn_rate(p: Parameters, speed: float, flown: float) -> float:
    """Turn rate [rad/s]; 0 for turns at once."""
    if p.hdir_bands_below_min_as == 1 and flown < p.min_airspeed_m_s:
        return 0.0
    if p.bank_angle_rad > 0:
        return G_M_S2 * math.tan(p.bank_angle_rad) / speed
    return p.turn_rate_rad_s


def _towards(now: np.ndarray, wanted: np.ndarray, most: float) -> np.ndarray:
    """`now` changed towards `wanted` by at most `most`; 0: immediately."""
    if most == 0:
        return wanted.copy()
    return now + np.clip(wanted - now, -most, most)


def integrate(p: Parameters, own: Aircraft, goal: Targets, ticks_s: np.ndarray) -> np.ndarray:
    """The position in every manoeuvre at every tick, (M, T + 1, 3) [m]."""
    count = len(goal.value)
    flown = math.hypot(own.ve_m_s, own.vn_m_s)
    slowest = max(flown, p.step_hs_m_s, p.min_airspeed_m_s)
    rate = _turn_rate(p, slowest, flown)
    turning, pacing, climbing, levelling = (goal.which == k for k in range(4))
    heading = np.full(count, math.atan2(own.ve_m_s, own.vn_m_s))
    to_heading = np.where(turning, goal.value, heading)
    # the minimum speed in a turn, as in the bands
    speed = np.where(turning, slowest, flown)
    to_speed = np.where(pacing, goal.value, speed)
    up = np.full(count, own.vu_m_s)
    accel, reach = p.vertical_accel_m_s2, p.vertical_rate_m_s
    place = np.zeros((count, len(ticks_s), 3))
    place[:, 0] = [own.east_m, own.north_m, own.alt_m]
    at_once = accel == 0 or reach == 0
    if at_once:
        place[levelling, 0, 2] = goal.value[levelling]
        up[levelling] = 0.0
    for k, h in enumerate(np.diff(ticks_s)):
        turned, paced = (
            _towards(heading, to_heading, rate * h),
            _towards(speed, to_speed, p.horizontal_accel_m_s2 * h),
        )
        half = (turned - heading) / 2 if rate else np.zeros(count)
        fresh = turned if not rate else heading + half
        # the time within the tick during which the rate applies; after it the course is straight
        used = np.abs(turned - heading) / rate if rate else np.zeros(count)
        chord = np.sinc(half / math.pi)
        east = np.sin(fresh) * chord * used + np.sin(turned) * (h - used)
        north = np.cos(fresh) * chord * used + np.cos(turned) * (h - used)
        gain = (
            np.abs(paced - speed) / p.horizontal_accel_m_s2 if p.horizontal_accel_m_s2 else 0 * used
        )
        way = (speed + paced) / 2 * gain + paced * (h - gain)
        wanted = np.where(climbing, goal.value, up)
        if not at_once:
            wanted = np.where(
                levelling, _to_level(place[:, k, 2], goal.value, up, accel, reach, h), wanted
            )
        after = _towards(up, wanted, accel * h)
        spent = np.abs(after - up) / accel if accel else 0 * used
        rise = (up + after) / 2 * spent + after * (h - spent)
        place[:, k + 1, 0] = place[:, k, 0] + east * way / h
        place[:, k + 1, 1] = place[:, k, 1] + north * way / h
        place[:, k + 1, 2] = place[:, k, 2] + rise
        heading, speed, up = turned, paced, after
    return place


def _to_level(
    z: np.ndarray, target: np.ndarray, up: np.ndarray, accel: float, reach: float, h: float
) -> np.ndarray:
    """The climb rate at the end of a tick on the way to an altitude: the fastest from which it can still be levelled
    off there.
    """
    rest = target - z
    side = np.where(rest >= 0, 1.0, -1.0)
    # after a tick at the mean of the rates, braking must bring it to the target: v^2 / 2a = the remaining distance
    room = np.maximum(np.abs(rest) - side * up * h / 2, 0.0)
    most = -accel * h / 2 + np.sqrt((accel * h / 2) ** 2 + 2 * accel * room)
    fastest = np.maximum(reach, side * up)
    return side * np.minimum(fastest, np.maximum(most, 0.0))


def _flown(other: Other, t_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The segment that another aircraft flies at each of these times, (T, 8), and whether there is one."""
    if not len(other.pieces):
        return np.zeros((len(t_s), 8)), np.zeros(len(t_s), dtype=np.bool_)
    k = np.searchsorted(other.pieces[:, 0], t_s, side="right") - 1
    rows = other.pieces[np.maximum(k, 0)]
    return rows, (k >= 0) & (t_s <= rows[:, 1])


def cut(others: Sequence[Other], horizon_s: float) -> np.ndarray:
    """Ticks, and every time at which another aircraft begins a new segment."""
    ticks = [np.arange(0.0, horizon_s, TICK_S), np.array([horizon_s])]
    for other in others:
        ticks += [other.pieces[:, 0], other.pieces[:, 1]]
    times = np.unique(np.concatenate(ticks))
    times = times[(times >= 0) & (times <= horizon_s)]
    # times that differ only by rounding are merged
    return times[np.append(np.diff(times) > NEAR_ENOUGH, True)] if len(times) > 1 else times


def judge(
    p: Parameters, own: Aircraft, others: Sequence[Other], horizon_s: float
) -> tuple[int, tuple[Tried, ...], str]:
    """The answer of this check within the horizon, each manoeuvre, and what remains open."""
    goal, why = targets(p, own)
    ticks_s = cut(others, horizon_s)
    if ticks_s[0] > 0:
        ticks_s = np.append(0.0, ticks_s[1:])
    place = integrate(p, own, goal, ticks_s)
    h = np.diff(ticks_s)
    velocity = np.diff(place, axis=1) / h[None, :, None]
    count, span = len(goal.value), compiled(conflict_span)
    answers = np.full(count, manoeuvre_judged.start, dtype=np.int64)
    by, when = np.full(count, -1), np.zeros(count)
    facts = np.zeros((count, 2))
    less = 1 - SURELY
    found = []
    for other in others:
        middle = (ticks_s[:-1] + ticks_s[1:]) / 2
        rows, known = _flown(other, middle)
        there = rows[:, 2:5] + (ticks_s[:-1] - rows[:, 0])[:, None] * rows[:, 5:8]
        s, v = place[:, :-1] - there[None], velocity - rows[None, :, 5:8]
        state = [s[..., 0], s[..., 1], v[..., 0], v[..., 1], s[..., 2], v[..., 2]]
        wide = span(other.kind, *state, *other.thresholds, 0.0, h[None])
        lost = wide.first_s <= wide.last_s
        where = np.nonzero(lost)
        smaller = [x * less for x in other.thresholds]
        tight = span(other.kind, *(x[where] for x in state), *smaller, 0.0, h[where[1]])
        surely = np.zeros_like(lost)
        surely[where] = tight.first_s <= tight.last_s
        found.append((s, v, known, wide.first_s, lost, surely))
    step = compiled(after_piece)
    for j in range(len(h)):
        for n, (s, v, known, first, lost, surely) in enumerate(found):
            after = step(answers, known[j], lost[:, j], surely[:, j])
            fresh = (after == REFUSED) & (answers != REFUSED)
            by[fresh], when[fresh] = n, ticks_s[j] + first[fresh, j]
            there = s[fresh, j] + first[fresh, j, None] * v[fresh, j]
            facts[fresh, 0] = np.hypot(there[:, 0], there[:, 1])
            facts[fresh, 1] = np.abs(there[:, 2])
            answers = after
    value = np.where(goal.which == 0, goal.value % (2 * math.pi), goal.value)
    tried = tuple(
        Tried(DIMENSIONS[goal.which[m]], float(value[m]), int(answers[m]))
        if answers[m] != REFUSED
        else Tried(
            DIMENSIONS[goal.which[m]], float(value[m]), REFUSED, others[by[m]].id, float(when[m]),
            *facts[m].tolist(),
        )
        for m in range(count)
    )  # fmt: skip
    items = [(t.answer,) for t in tried]
    if why:
        items.append((OPEN,))
    return int(way_out(items)), tried, why
