"""The way back is judged at the speed at which UxAS flies it, and so is what follows until the vehicle has it."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import pytest
import yaml
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.core.authority.gate import Gate
from cratous.core.avoidance.manoeuvre import Pace, way_along
from cratous.core.avoidance.prediction import Intruder, after
from cratous.services.flight.encounter import fly_encounter
from cratous.services.icarous.foresight import predicted, scene_of, way_back_is_free
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.state import Config, State
from cratous.services.loading import load
from cratous.spec.mission import Daa, Position, Velocity

CONFIG = Config(1, Daa(VOLUME), PROJECTION, 500)
WAY = (Position(-1000.0, 0.0, 300.0), Position(9000.0, 0.0, 300.0))
SLOW = NORTH._replace(speed_m_s=15.0)


@pytest.mark.parametrize("to_m_s", [30.0, 15.5, 8.0])
def test_a_way_is_flown_with_the_change_of_speed(to_m_s: float) -> None:
    """Without gaps, through its points, and nowhere farther along than half a metre off the true change."""
    points = (Position(130.0, 0.0, 310.0), Position(130.0, 400.0, 300.0))
    way = way_along(SLOW, points, math.inf, pace=Pace(to_m_s, 1.0))
    assert way.beyond is not None
    pieces, flown_m = (*way.pieces, way.beyond), 0.0
    assert math.hypot(*way.beyond.velocity[:2]) == pytest.approx(to_m_s)
    for a, b in itertools.pairwise(pieces):
        assert a.start_s + a.duration_s == pytest.approx(b.start_s)
        assert after(a, a.duration_s) == pytest.approx(b.position, abs=1e-6)
        change_s = min(b.start_s, abs(to_m_s - 15.0))
        true_m = 15.0 * change_s + math.copysign(change_s**2 / 2, to_m_s - 15.0)
        true_m += to_m_s * (b.start_s - change_s)
        flown_m += math.hypot(*a.velocity[:2]) * a.duration_s
        assert flown_m == pytest.approx(true_m, abs=0.5)
    assert any(p.position == pytest.approx(points[0], abs=1e-6) for p in pieces)
    for horizon_s in (0.7, 20.0, 60.0):
        ends = way_along(SLOW, points, horizon_s, pace=Pace(to_m_s, 1.0))
        last = ends.beyond or ends.pieces[-1]
        assert last.start_s + last.duration_s == pytest.approx(horizon_s)


def test_a_slow_vehicle_is_not_handed_back_into_a_conflict_that_it_has_at_speed() -> None:
    """One crosses in front where it would be in 40 s at 15 m/s, and meets one that flies at 22 m/s."""
    meets_s = 40.0
    crosses = Intruder(9, Position(860.0, -20.0 * meets_s, 300.0), Velocity(0.0, 20.0, 0.0))
    sensed = Sensed(5000, SLOW, ABILITY, (crosses,), Gate(0, 0, False))
    for speed_m_s, free in ((0.0, True), (15.0, True), (22.0, False)):
        told = Told(waypoints=WAY, next_index=1, speed_m_s=speed_m_s)
        state = State(told=told, goal=1)
        assert way_back_is_free(CONFIG, state, sensed, frozenset()) is free
        # and so it is watched while UxAS, which has just taken it back, speeds it up
        for until_ms, seen in ((5001, not free), (5000, False)):
            watched = State(told=told, goal=1, pace_ms=until_ms)
            ahead = predicted(CONFIG, watched, sensed, scene_of(CONFIG, watched, sensed))
            assert (ahead.first_s(crosses) is not None) is seen


MISSION: dict[str, Any] = {
    "name": "slower",
    "frame": {"latitude_deg": 45, "longitude_deg": -120},
    "vehicles": [
        {
            "id": 1,
            "position": {"north_m": -1639, "east_m": 0, "alt_m": 300},
            "heading_deg": 0,
            "speed_m_s": 18.6,
            "min_speed_m_s": 13,
            "max_speed_m_s": 26,
            "max_bank_deg": 30,
        }
    ],
    "tasks": [{"id": 1, "kind": "must_fly", "eligible": [1], "points": [{"north_m": 1639, "east_m": 0, "alt_m": 300}]}],
    "traffic": [
        {
            "id": 101,
            "position": {"north_m": -2005.3, "east_m": -1371.8, "alt_m": 300},
            "velocity": {"north_m_s": 22.79, "east_m_s": 15.59},
        }
    ],
    "daa": {"resolution": "speed", "well_clear": {"dthr_m": 60, "zthr_m": 30, "tthr_s": 0, "tcoa_s": 0}},
    "simulation": {"limit_s": 120},
}  # fmt: skip


def test_a_change_of_speed_is_one_takeover(tmp_path: Path) -> None:
    """Judged at the speed to which it had slowed down, its way back was free, and then not: three takeovers."""
    file = tmp_path / "mission.yaml"
    file.write_text(yaml.safe_dump(MISSION))
    assert fly_encounter(load(file)).takeovers == 1
