"""Spread alerts: a level is raised too if a small manoeuvre, to a value within its spread, conflicts within the
alerting time.
"""

from __future__ import annotations

import numpy as np

from cratous.core.daa.bands import manoeuvres
from cratous.core.daa.grid import Grid, grid, sides_in
from cratous.core.daa.guidance import evaluate
from cratous.core.daa.records import Intruders, Looking, Regaining
from cratous.core.daa.state import ALT, Aircraft
from cratous.core.kernel import driver
from cratous.core.readings.tiered import swift
from cratous.spec.daa.parameters import Level, Parameters


def _near(g: Grid, spread: float) -> Grid:
    """The grid values at most `spread` from the own one; a negative spread means all of them."""
    if spread < 0:
        return g
    if len(g.targets):
        return g._replace(targets=g.targets[np.abs(g.targets - g.own) <= spread])
    count = int(spread / g.step + 1e-9) + 1
    return g._replace(right=g.right[:count], left=g.left[:count])


@driver(checked_by=("in_conflict", "piece_counts", "straight_from"))
def spread_conflict(
    p: Parameters,
    own: Aircraft,
    other: np.ndarray,
    kind: int,
    volume: np.ndarray,
    level: Level,
    sides: np.ndarray,
) -> bool:
    """Whether some value within the level's spreads conflicts with the intruder `other` (6,), or violates one of the
    coordination sides (2,).
    """
    for dimension, spread in enumerate(level.spread):
        if spread == 0:
            continue
        g = _near(grid(p, own, dimension), spread)
        if dimension == ALT and not len(g.targets):
            continue
        safe_r = np.ones(len(g.targets) or len(g.right), dtype=np.bool_)
        safe_l = np.ones(len(g.left), dtype=np.bool_)
        intruder = Intruders(
            other.reshape(1, 6), np.array([kind], dtype=np.int64), volume.reshape(1, 11),
            np.array([min(p.lookahead_time_s, level.alerting_time_s)]),
            sides_in(dimension, sides.reshape(1, 2)),
        )  # fmt: skip
        looking = Looking(p.lookahead_time_s, p.bands_add_time_to_maneuver, 0.0, False, False)
        swift(evaluate, g.values // 3)(
            manoeuvres(g, g.step_s), intruder, np.zeros(1, dtype=np.int64),
            Regaining(0.0, 0.0, 0.0, False), looking, safe_r, safe_l,
        )  # fmt: skip
        if not safe_r.all() or not safe_l.all():
            return True
    return False
