"""Of the bands of altitude only intruders that the flight over ground meets are looked at; the bands are those of all."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from cratous.core.daa import climb
from cratous.core.daa.climb import safe_altitudes
from cratous.core.daa.records import Intruders, Looking, Manoeuvres, Regaining
from cratous.core.daa.volume import in_conflict
from cratous.core.kernel import Vec2
from cratous.core.well_clear.thresholds import Thresholds

VOLUME = (300.0, 60.0, 20.0, 0.0, 0.0)


def _drawn(draw: random.Random, count: int) -> tuple[Manoeuvres, Intruders]:
    """An ownship that climbs through 0 to 1000 m, and intruders near and far of it."""
    own = np.zeros((1, 11))
    own[0, :6] = 0.0, 0.0, 500.0, 0.0, draw.uniform(15, 40), draw.uniform(-2, 2)
    states = np.array(
        [
            [
                draw.uniform(-3000, 3000), draw.uniform(-3000, 3000), draw.uniform(0, 1000),
                draw.uniform(-60, 60), draw.uniform(-60, 60), draw.uniform(-5, 5),
            ]
            for _ in range(count)
        ]
    )  # fmt: skip
    volumes = np.zeros((count, 11))
    volumes[:, :5] = VOLUME
    ways = Manoeuvres(own, own, 0.0, 0.0, np.arange(0.0, 1001.0, 25.0), 5.0, 2.0, 1.0)
    kinds = np.array([draw.choice((0, 1, 2, 3, 4)) for _ in range(count)])
    horizons = np.full(count, 60.0)
    return ways, Intruders(states, kinds, volumes, horizons, np.zeros((count, 2), dtype=np.int64))


@pytest.mark.parametrize("regaining", [Regaining(0.0, 0.0, 0.0, False), Regaining(20.0, 200.0, 30.0, True)])  # fmt: skip
def test_the_bands_are_those_of_all_intruders(
    monkeypatch: pytest.MonkeyPatch, regaining: Regaining
) -> None:
    draw, differ, spared = random.Random(7), 0, 0
    looking = Looking(90.0, False, 0.0, False, False)
    for _ in range(30):
        ways, intruders = _drawn(draw, 6)
        chosen = np.arange(6)
        found = np.ones(len(ways.targets), dtype=np.bool_)
        told = safe_altitudes(ways, intruders, chosen, regaining, looking, found)
        asked = [climb.in_reach(ways.right[0], intruders, i, regaining, looking) for i in chosen]
        spared += asked.count((False, False))
        with monkeypatch.context() as patched:
            patched.setattr(climb, "in_reach", lambda *_: (True, True))
            whole = np.ones(len(ways.targets), dtype=np.bool_)
            assert safe_altitudes(ways, intruders, chosen, regaining, looking, whole) == told
        assert found.tolist() == whole.tolist()
        differ += not found.all()
    assert differ > 3
    assert spared > 10


def test_beside_at_the_same_height_is_the_worst() -> None:
    draw = random.Random(3)
    limits, met = Thresholds(*VOLUME), 0
    for _ in range(2000):
        kind, t = draw.choice((0, 1, 2, 3)), draw.uniform(0, 40)
        s = Vec2(draw.uniform(-2000, 2000), draw.uniform(-2000, 2000))
        v = Vec2(draw.uniform(-60, 60), draw.uniform(-60, 60))
        z, climbs = draw.uniform(-200, 200), draw.uniform(-5, 5)
        there = Vec2(s.x + t * v.x, s.y + t * v.y)
        if in_conflict(kind, there, v, z, climbs, limits, 0.0, draw.uniform(0, 20)):
            met += 1
            assert in_conflict(kind, s, v, 0.0, 0.0, limits, 0.0, t + 20.0)
    assert met > 20
    far = Vec2(3000.0, 0.0)
    assert not in_conflict(0, far, Vec2(0.0, 0.0), 0.0, 0.0, limits, 0.0, math.inf)
