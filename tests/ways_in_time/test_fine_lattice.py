"""The search against a fine lattice of places and instants, in plain Python that shares no code with it.

The lattice's vehicle turns on the spot and has every speed between the least and the greatest. With less to keep clear
of than the search it reaches more, with more it reaches less, by as much as its cells are coarse.
"""

from __future__ import annotations

import math
import random

import pytest

from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Intruder
from cratous.core.ways_in_time.scene import Scene
from cratous.services.ways_in_time.asking import Asked, Outcome, way_in_time
from cratous.spec.mission import Position, Velocity, WellClear, Zone, ZoneKind

CELL_M, STEP_S, HORIZON_S = 25.0, 2.5, 120.0
RADIUS_M = 80.0
LEAST, MOST = 10.0, 20.0
GOAL_M, WIDE_M = 900.0, 200.0
MOVES = [
    (i, j)
    for i in range(-2, 3)
    for j in range(-2, 3)
    if LEAST * STEP_S <= CELL_M * math.hypot(i, j) <= MOST * STEP_S
]
Walls = list[tuple[float, float, float, float]]
Others = list[tuple[float, float, float, float]]


def drawn(seed: int) -> tuple[Walls, Others]:
    """Walls (south, west, north, east), most of them across the way, and others (north, east, their speeds)."""
    draw = random.Random(seed)
    walls = []
    for k in range(draw.randint(1, 2)):
        south = 200 + 350 * k + draw.uniform(0, 80)
        left, gap = draw.uniform(-150, 80), draw.uniform(40, 140)
        walls += [(south, -WIDE_M, south + 60, left), (south, left + gap, south + 60, WIDE_M)]
    others = []
    for _ in range(draw.randint(1, 4)):
        meets_s, north = draw.uniform(15, 60), draw.uniform(200, 800)
        course, speed = draw.uniform(0, 2 * math.pi), draw.uniform(3, 15)
        vn, ve = speed * math.cos(course), speed * math.sin(course)
        others.append((north - vn * meets_s, draw.uniform(-80, 80) - ve * meets_s, vn, ve))
    return walls, others


def free(n: float, e: float, t: float, walls: Walls, others: Others, more_m: float) -> bool:
    """Whether a place is clear of walls, the sides and others, by more_m more than asked for."""
    if abs(e) > WIDE_M - max(more_m, 0.0):
        return False
    for south, west, north, east in walls:
        if south - more_m <= n <= north + more_m and west - more_m <= e <= east + more_m:
            return False
    return all(
        math.hypot(n - a - va * t, e - b - vb * t) > RADIUS_M + more_m for a, b, va, vb in others
    )


def reaches(walls: Walls, others: Others, more_m: float) -> bool:
    """Whether the lattice has a way to within a cell of the goal by the horizon."""
    now = {(0, 0)}
    for layer in range(int(HORIZON_S / STEP_S)):
        after: set[tuple[int, int]] = set()
        for i, j in now:
            for di, dj in MOVES:
                to = i + di, j + dj
                if to in after or not -4 <= to[0] <= GOAL_M / CELL_M + 4:
                    continue
                clear = all(
                    free(
                        CELL_M * (i + di * k / 4), CELL_M * (j + dj * k / 4),
                        (layer + k / 4) * STEP_S, walls, others, more_m,
                    )
                    for k in (4, 2, 1, 3)
                )  # fmt: skip
                if clear:
                    after.add(to)
        if any(math.hypot(CELL_M * i - GOAL_M, CELL_M * j) <= CELL_M for i, j in after):
            return True
        now = after
    return False


def answer(walls: Walls, others: Others) -> tuple[Outcome, list[tuple[float, float, float]]]:
    """What the search answers, and samples (s, north, east) of its way."""
    zones = [
        Zone(k, ZoneKind.KEEP_OUT, ((s, w), (s, e), (n, e), (n, w)), 0.0, 1000.0)
        for k, (s, w, n, e) in enumerate(walls, 1)
    ]
    side = ((-500.0, -WIDE_M), (-500.0, WIDE_M), (2000.0, WIDE_M), (2000.0, -WIDE_M))
    zones.append(Zone(99, ZoneKind.KEEP_IN, side, 0.0, 1000.0))
    seen = tuple(
        Intruder(k, Position(n, e, 300.0), Velocity(vn, ve, 0.0))
        for k, (n, e, vn, ve) in enumerate(others, 1)
    )
    scene = Scene(tuple(zones), 1.0, seen, WellClear(RADIUS_M, 50.0, 0.0, 0.0))
    now = Motion(Position(0.0, 0.0, 300.0), 0.0, 15.0, 0.0)
    ability = Ability(0.7, LEAST, MOST, 0.0, 2.0, 50.0)
    found = way_in_time(Asked(now, Position(GOAL_M, 0.0, 300.0), ability, HORIZON_S), scene, 2.0)
    samples = []
    for piece in found.pieces:
        for k in range(11):
            t = k / 10 * piece.duration_s
            samples.append((
                piece.start_s + t,
                piece.position.north_m + piece.velocity.north_m_s * t,
                piece.position.east_m + piece.velocity.east_m_s * t,
            ))  # fmt: skip
    return found.outcome, samples


def compared(seed: int) -> tuple[Outcome, bool]:
    """The search's answer, held against the lattice; and whether the lattice finds a way with room to spare."""
    walls, others = drawn(seed)
    outcome, samples = answer(walls, others)
    assert all(free(n, e, t, walls, others, 0.0) for t, n, e in samples)
    if samples:
        assert samples[-1][0] <= HORIZON_S
        assert math.hypot(samples[-1][1] - GOAL_M, samples[-1][2]) < 1.0
    if outcome is Outcome.PATH:
        assert reaches(walls, others, -CELL_M)
    return outcome, reaches(walls, others, CELL_M / 2)


@pytest.mark.parametrize("seed", range(6))
def test_a_way_is_clear_and_found_by_the_lattice_too(seed: int) -> None:
    compared(seed)


@pytest.mark.long
def test_it_finds_a_way_nearly_wherever_the_lattice_does_with_room_to_spare() -> None:
    both = [compared(seed) for seed in range(60)]
    easy = [outcome for outcome, reached in both if reached]
    assert len(easy) >= 20
    assert sum(outcome is Outcome.PATH for outcome in easy) >= 0.85 * len(easy)
    assert any(outcome is not Outcome.PATH for outcome, _ in both)
