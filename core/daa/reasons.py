"""Why a grid value is not safe: which intruder, which volume, during the manoeuvre or after it, and when.

The same kernels as for the bands are called, for one value, intruder by intruder.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from cratous.core.daa.bands import Raw, Traffic, manoeuvres
from cratous.core.daa.climb import altitude_conflict
from cratous.core.daa.coordination import step_is_repulsive
from cratous.core.daa.engine import Seen
from cratous.core.daa.grid import sides_in
from cratous.core.daa.records import Looked, Looking, Relative
from cratous.core.daa.steps import piece_counts, straight_from, until
from cratous.core.daa.uncertainty import lost, lost_span
from cratous.core.kernel import Vec2, driver
from cratous.core.readings.tiered import swift
from cratous.spec.daa.parameters import NEAR, Parameters


class Reason(NamedTuple):
    """An obstacle to a value.

    intruder: its id; region: whose volume; on_way: while manoeuvring, not after it; first_s, last_s: when the volume
    is violated [s from now]; miss_m, above_m: least horizontal distance in that time and vertical distance at it [m];
    limit_m, limit_z_m: the volume's thresholds; side: 0, or the obstacle is coordination, not the volume: from
    first_s on the manoeuvre does not repel to that side.
    """

    intruder: str
    region: int
    on_way: bool
    first_s: float | None
    last_s: float | None
    miss_m: float | None
    above_m: float | None
    limit_m: float
    limit_z_m: float
    side: int = 0


def _least(state: np.ndarray, first_s: float, last_s: float) -> tuple[float, float]:
    """Least horizontal distance in a time span, and vertical distance then."""
    x, y, z, u, v, w = (float(q) for q in state)
    vv = u * u + v * v
    t = min(max(-(x * u + y * v) / vv, first_s), last_s) if vv > 0 else first_s
    return math.hypot(x + t * u, y + t * v), abs(z + t * w)


@driver(checked_by=("repels", "repels_vertically"))
def coordination_reasons(
    p: Parameters, seen: Seen, raw: Raw, dimension: int, side: int, k: int
) -> list[Reason]:
    """Whether step k to one side violates the coordination side with the most urgent intruder; reported for each
    region in whose bands it counts.
    """
    found: list[Reason] = []
    g, traffic = raw.grid, seen.traffic
    path = g.right if side > 0 else g.left
    keep = sides_in(dimension, traffic.sides)
    for i, name in enumerate(traffic.ids):
        across, up = int(keep[i, 0]), int(keep[i, 1])
        if not across and not up:
            continue
        steps = range(k, k + 1) if g.step_s == 0 else range(k + 1)
        asked: Any = swift(step_is_repulsive)
        at = next(
            (j for j in steps if not asked(path, j, g.step_s, traffic.states[i], across, up)), -1
        )
        if at < 0:
            continue
        for region in range(NEAR, 0, -1):
            recovering = p.recovery_crit and raw.recovery.computed and region == p.corrective_region
            counts = (p.conflict_crit and raw.state[region]) or recovering
            if counts and traffic.mapped[region, i]:
                volume = traffic.volumes[region, i]
                found.append(
                    Reason(
                        name, region, bool(g.step_s), at * g.step_s, None, None, None,
                        float(volume[0]), float(volume[1]), across or up,
                    )
                )  # fmt: skip
    return found


def _looked_at(p: Parameters, traffic: Traffic, raw: Raw) -> Iterator[tuple[int, int, str, float]]:
    """Each region of the bands, most severe first, with each intruder that counts there: (region, index, its id,
    look-ahead [s]).
    """
    for region in range(NEAR, 0, -1):
        if not raw.state[region]:
            continue
        for i, name in enumerate(traffic.ids):
            if traffic.mapped[region, i]:
                horizon_s = p.lookahead_time_s
                if not traffic.conflict[region, i]:
                    horizon_s = min(horizon_s, float(traffic.alerting_s[region, i]))
                yield region, i, name, horizon_s


@driver(checked_by=("in_conflict", "piece_counts", "straight_from"))
def step_reasons(p: Parameters, seen: Seen, raw: Raw, side: int, k: int) -> list[Reason]:
    """The obstacles to step k to the right (side 1) or left (side -1), most severe first."""
    g, traffic = raw.grid, seen.traffic
    path = g.right if side > 0 else g.left
    found: list[Reason] = []
    for region, i, name, horizon_s in _looked_at(p, traffic, raw):
        kind = int(traffic.kinds[region, i])
        volume = traffic.volumes[region, i]
        for j in range(k + 1):
            at_s = j * g.step_s
            relative = path[j, :6] - traffic.states[i]
            relative[:3] -= at_s * traffic.states[i, 3:]
            state: Any = (
                kind,
                Relative(
                    Vec2(relative[0], relative[1]), Vec2(relative[3], relative[4]),
                    relative[2], relative[5],
                ),
                volume, at_s,
            )  # fmt: skip
            violated: Any = lost
            times_of: Any = lost_span
            counted = p.bands_add_time_to_maneuver
            last_s = horizon_s if counted else p.lookahead_time_s
            way = g.step_s > 0 and piece_counts(at_s, 0, last_s) and violated(*state, 0, g.step_s)
            end_s = until(p.lookahead_time_s, horizon_s, at_s, counted)
            after = j == k and violated(*state, straight_from(at_s, 0), end_s - at_s)
            if not way and not after:
                continue
            first_s, final_s = times_of(*state, 0, g.step_s if way else end_s - at_s)
            miss, above = _least(relative, first_s, final_s)
            times = (at_s + first_s, at_s + final_s)
            found.append(
                Reason(
                    name,
                    region,
                    bool(way),
                    *times,
                    miss,
                    above,
                    float(volume[0]),
                    float(volume[1]),
                )
            )
            break
    return found


@driver(checked_by=("in_conflict", "climb", "height"))
def altitude_reasons(p: Parameters, seen: Seen, raw: Raw, k: int) -> list[Reason]:
    """The obstacles to target altitude k, most severe first; the times are not computed."""
    g, traffic = raw.grid, seen.traffic
    looking = Looking(p.lookahead_time_s, p.bands_add_time_to_maneuver, 0.0, False, False)
    found: list[Reason] = []
    for region, i, name, horizon_s in _looked_at(p, traffic, raw):
        volume = traffic.volumes[region, i]
        if swift(altitude_conflict)(
            manoeuvres(g, g.step_s), g.targets[k], traffic.states[i], traffic.kinds[region, i],
            volume, Looked(0.0, horizon_s, False), looking,
        ):  # fmt: skip
            found.append(
                Reason(
                    name,
                    region,
                    False,
                    None,
                    None,
                    None,
                    None,
                    float(volume[0]),
                    float(volume[1]),
                )
            )
    return found


def reasons_at(
    p: Parameters, seen: Seen, raw: Raw, value: float, dimension: int = -1
) -> list[Reason]:
    """The obstacles to the grid value nearest to `value` (not wrapped around the circle); with a dimension,
    coordination too.
    """
    g = raw.grid
    if len(g.targets):
        k = int(np.argmin(np.abs(g.targets - value)))
        return altitude_reasons(p, seen, raw, k)
    side = 1 if value >= g.own else -1
    path = g.right if side > 0 else g.left
    k = min(round(abs(value - g.own) / g.step), len(path) - 1)
    found = step_reasons(p, seen, raw, side, k)
    if dimension >= 0:
        found += coordination_reasons(p, seen, raw, dimension, side, k)
    return found
