"""The manoeuvres of the bands, one by one, against other aircraft as they fly: whether there is a way out.

Definitions: `spec.excuse`. The manoeuvres are those of `core.daa.bands.grid`: turns, changes of speed and of vertical
speed in steps, each flown straight for a step time, and from any step straight; changes of altitude in the phases of
`core.daa.climb`, divided into segments of SAMPLE_S. Other aircraft need not fly straight. Every segment is judged by
the kernels of `core.excuse.way_out`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np

from cratous.core.daa.bands import SAMPLE_S, out_of_range
from cratous.core.daa.climb import climb, height
from cratous.core.daa.grid import SLACK, Grid, grid
from cratous.core.daa.state import ALT, DIMENSIONS, HDIR, Aircraft
from cratous.core.daa.volume import conflict_span
from cratous.core.excuse.state import OPEN, REFUSED, SURELY, Other, Tried
from cratous.core.excuse.way_out import after_piece, manoeuvre_judged, piece_lost, way_out
from cratous.core.kernel import Vec2, driver
from cratous.core.readings.tiered import swift
from cratous.core.well_clear.thresholds import Thresholds
from cratous.spec.daa.parameters import Parameters


class Pieces(NamedTuple):
    """Straight segments in order of time, (P, 8): begin, end [s], position [m] and velocity [m/s] at the beginning;
    those of manoeuvre or aircraft n from first[n] to first[n + 1].
    """

    rows: np.ndarray
    first: np.ndarray


@driver(checked_by=("piece_lost", "after_piece", "conflict_span"))
def judge_pieces(
    own: Pieces, traffic: Pieces, kinds: np.ndarray, volumes: np.ndarray, less: float,
    answers: np.ndarray, by: np.ndarray, facts: np.ndarray,
):  # fmt: skip
    """Judge manoeuvres; answers: of each 1 free, 0 open, -1 refused.

    own: of the manoeuvres; traffic: of the other aircraft; kinds: (n), volumes: (n, 5); less: the factor of
    thresholds for a certain loss. by: the aircraft that causes the refusal; facts: (m, 3) when, and the distances
    then.
    """
    pieces, first, others, begins = own.rows, own.first, traffic.rows, traffic.first
    for m in range(first.size - 1):
        so_far = answers[m]
        for p in range(first[m], first[m + 1]):
            for n in range(kinds.size):
                known_s = pieces[p, 0]
                w = volumes[n]
                full = Thresholds(w[0], w[1], w[2], w[3], w[4])
                smaller = Thresholds(
                    w[0] * less, w[1] * less, w[2] * less, w[3] * less, w[4] * less
                )
                for q in range(begins[n], begins[n + 1]):
                    a_s = max(pieces[p, 0], others[q, 0])
                    b_s = min(pieces[p, 1], others[q, 1])
                    if a_s > b_s:
                        continue
                    u_s, w_s = a_s - pieces[p, 0], a_s - others[q, 0]
                    v = Vec2(pieces[p, 5] - others[q, 5], pieces[p, 6] - others[q, 6])
                    vz = pieces[p, 7] - others[q, 7]
                    s = Vec2(
                        pieces[p, 2] + u_s * pieces[p, 5] - others[q, 2] - w_s * others[q, 5],
                        pieces[p, 3] + u_s * pieces[p, 6] - others[q, 3] - w_s * others[q, 6],
                    )
                    sz = pieces[p, 4] + u_s * pieces[p, 7] - others[q, 4] - w_s * others[q, 7]
                    lost = piece_lost(kinds[n], s, v, sz, vz, full, b_s - a_s)
                    surely = lost and piece_lost(kinds[n], s, v, sz, vz, smaller, b_s - a_s)
                    so_far = after_piece(so_far, known_s >= a_s, lost, surely)
                    known_s = max(known_s, b_s)
                    if so_far < 0:
                        when, _ = conflict_span(kinds[n], s, v, sz, vz, full, 0.0, b_s - a_s)
                        by[m] = n
                        facts[m, 0] = a_s + when
                        x, y = s.x + when * v.x, s.y + when * v.y
                        facts[m, 1] = sqrt(x * x + y * y)
                        facts[m, 2] = abs(sz + when * vz)
                        break
                # the other's known states end before the segment does
                so_far = after_piece(so_far, known_s >= pieces[p, 1], False, False)
                if so_far < 0:
                    break
            if so_far < 0:
                break
        answers[m] = so_far


def _steps(g: Grid, dimension: int, side: int, horizon_s: float) -> list[tuple[float, np.ndarray]]:
    """Value and segments of every step to one side, the present value only to the right."""
    path = g.right if side > 0 else g.left
    width = g.high - g.own if side > 0 else g.own - g.low
    found = []
    for k in range(0 if side > 0 else 1, len(path)):
        if k * g.step > width + SLACK * g.step:
            break
        ends_s = np.minimum(np.append(g.step_s * np.arange(1, k + 1), horizon_s), horizon_s)
        begins_s = np.minimum(g.step_s * np.arange(k + 1), horizon_s)
        keep = np.append(ends_s[:-1] > begins_s[:-1], True)
        rows = np.column_stack([begins_s, ends_s, path[: k + 1, :6]])[keep]
        value = g.own + side * k * g.step
        found.append((value % (2 * math.pi) if dimension == HDIR else value, rows))
    return found


def _climb_pieces(g: Grid, target_m: float, horizon_s: float) -> np.ndarray:
    """The segments of a change of altitude; instantaneous without a rate or an acceleration."""
    x, y, z, vx, vy, vz = g.right[0, :6].tolist()
    if not g.rate_m_s or not g.accel_m_s2:
        return np.array([[0.0, horizon_s, x, y, target_m, vx, vy, 0.0]])
    phases = climb(z, vz, target_m, g.rate_m_s, g.accel_m_s2)
    cuts = {0.0, phases.t1_s, phases.t2_s, phases.t3_s}
    for begin_s, end_s in ((0.0, phases.t1_s), (phases.t2_s, phases.t3_s)):
        cuts |= {begin_s + k * SAMPLE_S for k in range(int((end_s - begin_s) / SAMPLE_S) + 1)}
    times_s = np.array([*sorted(t for t in cuts if 0 <= t < horizon_s), horizon_s])
    heights = [height(z, vz, target_m, g.accel_m_s2, phases, t).z_m for t in times_s.tolist()]
    begins_s = times_s[:-1]
    up = np.diff(heights) / np.diff(times_s)
    same = np.ones(len(begins_s))
    return np.column_stack(
        [begins_s, times_s[1:], x + begins_s * vx, y + begins_s * vy, heights[:-1], vx * same, vy * same, up]
    )  # fmt: skip


def _climbs(g: Grid, horizon_s: float) -> list[tuple[float, np.ndarray]]:
    """Target and segments of every change of altitude."""
    targets = [t for t in g.targets.tolist() if t <= g.high + SLACK * g.step]
    return [(t, _climb_pieces(g, t, horizon_s)) for t in targets]


def manoeuvres(
    p: Parameters, own: Aircraft, horizon_s: float
) -> tuple[list[tuple[str, float, np.ndarray]], str]:
    """All manoeuvres of the bands as (dimension, value, pieces), and what cannot be flown from here."""
    found: list[tuple[str, float, np.ndarray]] = []
    why = []
    for dimension, name in enumerate(DIMENSIONS):
        outside = out_of_range(p, own, dimension)
        if outside:
            why.append(outside)
            continue
        g = grid(p, own, dimension)
        if dimension == ALT:
            ways = _climbs(g, horizon_s)
        else:
            ways = _steps(g, dimension, 1, horizon_s) + _steps(g, dimension, -1, horizon_s)
        found += [(name, value, rows) for value, rows in ways]
    return found, "; ".join(why)


def judge(
    p: Parameters, own: Aircraft, others: Sequence[Other], horizon_s: float
) -> tuple[int, tuple[Tried, ...], str]:
    """The answer of the bands' manoeuvres within the horizon, each of them, and what remains open."""
    ways, why = manoeuvres(p, own, horizon_s)
    count = len(ways)
    first = np.cumsum([0, *(len(rows) for _, _, rows in ways)]).astype(np.int64)
    pieces = np.concatenate([rows for _, _, rows in ways]) if ways else np.zeros((0, 8))
    begins = np.cumsum([0, *(len(o.pieces) for o in others)]).astype(np.int64)
    flown = np.concatenate([o.pieces for o in others]) if others else np.zeros((0, 8))
    answers = np.full(count, manoeuvre_judged.start, dtype=np.int64)
    by, facts = np.full(count, -1, dtype=np.int64), np.zeros((count, 3))
    swift(judge_pieces, len(pieces) * len(flown) // 15)(
        Pieces(np.ascontiguousarray(pieces), first), Pieces(np.ascontiguousarray(flown), begins),
        np.array([o.kind for o in others], dtype=np.int64),
        np.array([o.thresholds for o in others], dtype=np.float64).reshape(-1, 5),
        1 - SURELY, answers, by, facts,
    )  # fmt: skip
    tried = tuple(
        Tried(name, value, int(answers[m]))
        if answers[m] != REFUSED
        else Tried(name, value, REFUSED, others[by[m]].id, *facts[m].tolist())
        for m, (name, value, _) in enumerate(ways)
    )
    items = [(t.answer,) for t in tried]
    if why:
        items.append((OPEN,))
    return int(way_out(items)), tried, why
