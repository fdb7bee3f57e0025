"""Vehicles that hardly climb are flown like any other."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from flight_tools import flown
from hypothesis import given
from hypothesis import strategies as st

from cratous.services.flight.chain import CLIMB_LAPS, LAP_LEGS, lap_points, raised
from cratous.services.loading import load
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Hold

CROSSING = Path(__file__).resolve().parents[2] / "examples" / "crossing" / "mission.yaml"
LAP = lap_points(Hold(0.0, 80.0, 300.0, 80.0, True), Position(0.0, 0.0, 300.0))


@given(st.floats(0.1, 500.0), st.floats(1e-9, 1.0))
def test_a_loiter_climbs_as_far_as_it_comes(layer_m: float, slope: float) -> None:
    points = raised(LAP, 300.0 + layer_m, slope)
    assert len(points) <= (CLIMB_LAPS + 1) * LAP_LEGS + 1
    around_m = sum(math.dist(a[:2], b[:2]) for a, b in pairwise(LAP))
    reached = min(300.0 + layer_m, 300.0 + CLIMB_LAPS * slope * around_m)
    assert points[-1].alt_m == pytest.approx(reached, abs=1e-5)
    for a, b in pairwise(points):
        assert b.alt_m - a.alt_m <= slope * math.dist(a[:2], b[:2]) + 1e-9


@pytest.mark.parametrize("climb_m_s", [0.001, 0.02])
def test_a_vehicle_that_hardly_climbs_finishes_before_others(climb_m_s: float) -> None:
    """Its last loiter would need hundreds of thousands of waypoints to come to a layer of its own."""
    mission = load(CROSSING)
    vehicles = tuple(replace(v, max_climb_m_s=climb_m_s) for v in mission.vehicles)
    result, _ = flown(replace(mission, vehicles=vehicles))
    assert result.outcome == "complete"
    assert result.end_ms < 250_000
