"""One that is too far away is not followed along its way: what is said is the same as if it was."""

from __future__ import annotations

import math
import random

import pytest

from cratous.core.avoidance import prediction
from cratous.core.avoidance.prediction import Intruder, Piece, Spread, after, first_violation_s
from cratous.spec.mission import Position, Velocity, WellClear

VOLUME = WellClear(150.0, 30.0, 15.0, 0.0)


def _way(draw: random.Random, legs: int) -> tuple[Piece, ...]:
    within_m = draw.choice((1500.0, 8000.0))
    north, east = (draw.uniform(-within_m, within_m) for _ in range(2))
    place = Position(north, east, draw.uniform(290, 310))
    pieces, t_s = list[Piece](), 0.0
    for _ in range(legs):
        course, speed = draw.uniform(0, 2 * math.pi), draw.uniform(10, 40)
        velocity = Velocity(speed * math.cos(course), speed * math.sin(course), 0.0)
        pieces.append(Piece(t_s, draw.uniform(5, 60), place, velocity))
        place, t_s = after(pieces[-1], pieces[-1].duration_s), t_s + pieces[-1].duration_s
    return tuple(pieces)


def test_a_far_one_is_not_followed_and_nobody_near_is_missed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    draw, met, spared = random.Random(5), 0, 0
    for _ in range(900):
        own, way = _way(draw, draw.randint(1, 4)), _way(draw, draw.randint(1, 4))
        spread = draw.choice((Spread(), Spread(30.0, 1.0, 5.0, 0.5, 20.0)))
        other = Intruder(
            2, way[0].position, way[0].velocity, way=way, hold_m=draw.choice((0.0, 200.0)),
            spread=spread,
        )  # fmt: skip
        told = first_violation_s(own, other, VOLUME)
        spared += prediction.out_of_reach(own, other, VOLUME)
        with monkeypatch.context() as patched:
            patched.setattr(prediction, "out_of_reach", lambda *_: False)
            assert first_violation_s(own, other, VOLUME) == told
        met += told is not None
    assert met > 10
    assert spared > 30
