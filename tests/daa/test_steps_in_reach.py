"""Intruders out of reach, and what is settled, are not asked about at a step: the safe steps are those of all."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from cratous.core.daa import steps
from cratous.core.daa.bands import manoeuvres
from cratous.core.daa.grid import grid
from cratous.core.daa.records import Intruders, Looking, Regaining
from cratous.core.daa.state import HDIR, HS, VS, Aircraft
from cratous.core.daa.steps import safe_steps
from cratous.core.kernel import Vec2
from cratous.spec.daa.presets import preset

VOLUME = (300.0, 60.0, 20.0, 0.0, 0.0)
P = preset("do_365b").parameters
REGAINING = (
    Regaining(0.0, 0.0, 0.0, False),
    Regaining(15.0, 200.0, 30.0, True),
    Regaining(45.0, 200.0, 30.0, True),
)


def _drawn(draw: random.Random, count: int) -> Intruders:
    states = np.array(
        [
            [
                draw.uniform(-6000, 6000), draw.uniform(-6000, 6000), draw.uniform(400, 600),
                draw.uniform(-40, 40), draw.uniform(-40, 40), draw.uniform(-2, 2),
            ]
            for _ in range(count)
        ]
    )  # fmt: skip
    volumes = np.zeros((count, 11))
    volumes[:, :5] = VOLUME
    kinds = np.array([draw.choice((0, 1, 2, 3, 4)) for _ in range(count)])
    sides = np.array([[draw.choice((0, 0, 0, 1)), 0] for _ in range(count)])
    return Intruders(
        states, kinds, volumes, np.array([draw.choice((25.0, 60.0)) for _ in kinds]), sides
    )


@pytest.mark.parametrize("dimension", [HDIR, HS, VS])
@pytest.mark.parametrize("regaining", REGAINING)
@pytest.mark.parametrize("counted", [False, True])
def test_the_safe_steps_are_those_of_all_intruders(
    monkeypatch: pytest.MonkeyPatch, dimension: int, regaining: Regaining, counted: bool
) -> None:
    draw, differ, spared = random.Random(11), 0, 0
    looking = Looking(90.0, counted, 0.0, False, False)
    for _ in range(12):
        own = Aircraft("own", 0.0, 0.0, 500.0, 20.0, draw.uniform(10, 30), draw.uniform(-1, 1))
        g = grid(P, own, dimension)
        intruders, chosen = _drawn(draw, 5), np.arange(5)
        ways = manoeuvres(g, g.step_s)
        for side in (g.right, g.left):
            found, whole = np.ones(len(side), dtype=np.bool_), np.ones(len(side), dtype=np.bool_)
            told = safe_steps(side, ways, intruders, chosen, regaining, looking, found)
            fastest = math.sqrt(np.max(side[:, 3] ** 2 + side[:, 4] ** 2))
            bounds = [
                steps.out_of_reach(intruders, i, regaining, ways.piece_s, fastest) for i in chosen
            ]
            away = np.sum(intruders.states[:, :2] ** 2, axis=1)
            spared += sum(a > far for a, (far, _) in zip(away, bounds, strict=True))
            with monkeypatch.context() as patched:
                patched.setattr(steps, "out_of_reach", lambda *_: (math.inf, math.inf))
                assert safe_steps(side, ways, intruders, chosen, regaining, looking, whole) == told
            assert found.tolist() == whole.tolist()
            differ += not found.all()
    assert differ > 3
    assert spared > 3


def test_who_is_out_of_reach_is_in_no_conflict() -> None:
    draw, out = random.Random(5), 0
    for _ in range(3000):
        intruders = _drawn(draw, 1)
        intruders.sides[:] = 0
        v = Vec2(draw.uniform(-30, 30), draw.uniform(-30, 30))
        far, _ = steps.out_of_reach(intruders, 0, REGAINING[0], 1.0, math.hypot(v.x, v.y))
        x, y, z, u, w, climb = intruders.states[0]
        if x * x + y * y <= far:
            continue
        out += 1
        seen = Vec2(v.x - u, v.y - w)
        for kind in (0, 1, 2, 3):
            assert not steps.in_conflict(
                kind, Vec2(-x, -y), seen, 500.0 - z, -climb, steps.Thresholds(*VOLUME), 0.0,
                float(intruders.horizons[0]),
            )  # fmt: skip
    assert out > 100
