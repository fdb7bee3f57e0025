"""Two aircraft that meet, and parameters with implicit coordination, for the tests of it."""

from __future__ import annotations

import dataclasses
import math
import random

from hypothesis import strategies as st

from cratous.core.daa.state import Aircraft
from cratous.core.kernel import Vec2
from cratous.spec.daa.parameters import FIXED, Parameters

# small whole numbers meet ties, equal altitudes and standing still; the others do not
NUMBERS = st.one_of(st.integers(-3, 3).map(float), st.floats(-9000, 9000, allow_subnormal=False))
VECTORS = st.builds(Vec2, NUMBERS, NUMBERS)


def coordinating(p: Parameters, with_id: str, conflict: bool = True, recovery: bool = True):
    return dataclasses.replace(
        p, conflict_crit=conflict, recovery_crit=recovery, urgency_strategy=FIXED,
        most_urgent_aircraft=with_id,
    )  # fmt: skip


def meeting(rng: random.Random) -> tuple[Aircraft, Aircraft]:
    """Two aircraft that come within some hundred metres of each other in half a minute or more."""
    turn, other_turn = rng.uniform(0, 2 * math.pi), rng.uniform(0, 2 * math.pi)
    speed, other_speed = rng.uniform(60, 200), rng.uniform(60, 200)
    u, v = speed * math.sin(turn), speed * math.cos(turn)
    x, y = other_speed * math.sin(other_turn), other_speed * math.cos(other_turn)
    climb, other_climb = (rng.choice((0.0, rng.uniform(-8, 8))) for _ in range(2))
    t, miss, angle = rng.uniform(30, 70), rng.uniform(0, 900), rng.uniform(0, 2 * math.pi)
    own = Aircraft("own", 0.0, 0.0, 3000.0, u, v, climb)
    return own, Aircraft(
        "intruder", t * (u - x) + miss * math.sin(angle), t * (v - y) + miss * math.cos(angle),
        3000 + t * (climb - other_climb) + rng.uniform(-90, 90), x, y, other_climb,
    )  # fmt: skip
