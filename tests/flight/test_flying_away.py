"""Control goes back as soon as an aircraft that flies away has left the buffered cylinder, for the persistence time."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from flight_tools import flown, of_type

from cratous.services.icarous.return_to_path import PERSIST_MS
from cratous.services.loading import load
from cratous.spec.mission import Position, Velocity

MISSION = Path(__file__).resolve().parents[1] / "missions" / "hovering_behind.yaml"


@pytest.mark.parametrize(
    ("place", "velocity"),
    [
        ((660.0, 150.0), (0.0, 30.0)),
        ((700.0, 0.0), (40.0, 0.0)),
        ((560.0, 0.0), (-30.0, 0.0)),
    ],
)
def test_an_aircraft_that_flies_away_does_not_delay_the_handback(
    place: tuple[float, float], velocity: tuple[float, float]
) -> None:
    """It appears beside the vehicle, within the volume, which surprises it; the mission goes on far ahead."""
    mission = load(MISSION)
    (drone,), (task,) = mission.traffic, mission.tasks
    leaves = replace(
        drone,
        position=Position(*place, 300.0),
        velocity=Velocity(*velocity, 0.0),
        appears_ms=30_000,
    )
    goal = replace(task, points=(Position(3000.0, 0.0, 300.0),))
    result, log = flown(replace(mission, traffic=(leaves,), tasks=(goal,)))
    assert (result.outcome, result.takeovers) == ("complete", 1)
    states = of_type(log, "TruthState")
    own = {one.Time: (one.North, one.East) for one in states if one.VehicleID == 1}
    other = {one.Time: (one.North, one.East) for one in states if one.VehicleID == drone.id}
    radius_m = mission.daa.well_clear.dthr_m * mission.daa.buffer
    inside = [t for t, at in other.items() if math.dist(own[t], at) <= radius_m]
    (back,) = [one.Time for one in of_type(log, "AuthorityChange") if one.Owner.name == "UxAS"]
    beats_ms = 2 * mission.simulation.heartbeat_ms
    assert max(inside) < back <= max(inside) + PERSIST_MS + beats_ms
