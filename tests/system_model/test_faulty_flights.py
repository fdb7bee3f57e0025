"""Flights over a broken bridge fit the model: what a link does to messages is in it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from faulty_bridge import FAULTS, faulty
from flight_tools import meeting, vehicle
from mission_tools import must_fly

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.flight.loop import fly
from cratous.services.pipeline.plan import make_plan
from cratous.services.system_model.replay import Replayed, replay
from cratous.spec.mission import Mission, Simulation


def judged(mission: Mission, kind: str, seed: int) -> Replayed:
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(log.append)
    with faulty(kind, seed):
        fly(mission, make_plan(mission), bus)
    return replay(mission, True, log)


def changed(seed: int) -> Mission:
    """The meeting sooner, each time at another place, and a second vehicle beside."""
    (other,) = meeting().traffic
    moved = other.position._replace(north_m=1760.0, east_m=-1760.0 + 22.0 * 5 * seed)
    first, second = must_fly(1, (3800.0, 0.0, 300.0)), must_fly(2, (2000.0, 9000.0, 300.0))
    return replace(
        meeting(),
        vehicles=(vehicle(1, 0.0, 0.0), vehicle(2, 0.0, 9000.0)),
        tasks=(first, second),
        traffic=(replace(other, position=moved),),
        instances=(1, 2),
        simulation=Simulation(limit_ms=200_000),
    )


@pytest.mark.parametrize("kind", FAULTS)
@pytest.mark.parametrize("seed", range(3))
def test_it_fits_whatever_the_link_does(kind: str, seed: int) -> None:
    found = judged(changed(seed), kind, seed)
    assert found.finding is None, found.finding.text
    assert found.events["MissionEnd"] == 1
    assert found.events["AuthorityChange"] > 0, "nothing was taken over: nothing was shown"
