"""A flight whose direct way back is barred by a zone: with UxAS's planner asked it is handed back sooner."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from cratous.bridge import lmcp
from cratous.core.geofence.mission_legs import first_bad_leg
from cratous.services.bus import Bus
from cratous.services.flight import interruption
from cratous.services.flight.loop import fly
from cratous.services.icarous import proposal
from cratous.services.icarous.route_requests import OVERDUE
from cratous.services.loading import load
from cratous.services.pipeline.plan import make_plan
from cratous.services.processes.files import Ports, write_configuration
from cratous.spec.errors import BadInput
from cratous.spec.mission import (
    LivePlanningMission,
    Mission,
    Position,
    Simulation,
    Traffic,
    Velocity,
    Zone,
    ZoneKind,
)

BARS = Zone(
    1, ZoneKind.KEEP_OUT, ((-600.0, 600.0), (-60.0, 600.0), (-60.0, 1500.0), (-600.0, 1500.0)), 0.0, 1000.0
)  # fmt: skip
MEETS = Traffic(9, Position(0.0, 2400.0, 300.0), Velocity(0.0, -30.0, 0.0))


class Flown(NamedTuple):
    back_ms: int
    end_ms: int
    texts: list[str]
    path: list[Position]


def flown(root: Path, kind: type[Mission]) -> Flown:
    """Eastward along the edge of a zone, and head-on with somebody who does not give way."""
    whole = load(root / "examples/crossing/mission.yaml", 0)
    mission = kind(
        name="barred", source="", frame=whole.frame, vehicles=(whole.vehicle(2),),
        tasks=(whole.task(2),), daa=whole.daa, zones=(BARS,), traffic=(MEETS,), instances=(2,),
        simulation=Simulation(limit_ms=400_000),
    )  # fmt: skip
    bus, heard = Bus(lmcp.full_names), list[tuple[int, Any]]()
    bus.tap(lambda envelope: heard.append((envelope.time_ms, envelope.body)))
    with pytest.MonkeyPatch.context() as patched:
        # what a search finds here is free without asking: this is of flights in which it finds nothing
        patched.setattr(proposal, "_soonest", lambda *_: None)
        # nor is a way in time, by which it is handed back as soon without asking
        patched.setattr(proposal, "proposed", lambda *_: None)
        result = fly(mission, make_plan(mission), bus)
    assert (result.outcome, result.takeovers) == ("complete", 1)

    def of(name: str) -> list[tuple[int, Any]]:
        return [(at_ms, body) for at_ms, body in heard if type(body).__name__ == name]

    (back_ms,) = (at for at, body in of("AuthorityChange") if body.Owner.name != "ICAROUS")
    texts = [body.Resolution for _, body in of("Conflict")]
    path = [Position(b.North, b.East, b.Altitude) for _, b in of("TruthState") if b.VehicleID == 2]
    return Flown(back_ms, result.end_ms, texts, path)


@pytest.fixture(scope="module")
def own(root: Path) -> Flown:
    return flown(root, Mission)


def test_it_is_handed_back_sooner_and_keeps_the_zone(root: Path, own: Flown) -> None:
    asked = flown(root, LivePlanningMission)
    assert asked.back_ms < own.back_ms - 20_000
    assert asked.end_ms < own.end_ms - 10_000
    assert all(first_bad_leg(leg, (BARS,)) is None for leg in pairwise(asked.path))


def test_without_an_answer_icarous_finds_its_way_back_as_ever_and_says_so(
    root: Path, own: Flown, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(interruption, "propose", lambda *_: None)
    asked = flown(root, LivePlanningMission)
    assert (asked.back_ms, asked.path) == (own.back_ms, own.path)
    assert OVERDUE in asked.texts
    assert OVERDUE not in own.texts


def test_a_mission_file_asks_for_it_in_processes_too(root: Path, tmp_path: Path) -> None:
    text = (root / "examples/crossing/mission.yaml").read_text()
    path = tmp_path / "m.yaml"
    path.write_text(f"{text}\nbridge: {{uxas_route_planner: true}}\n")
    mission, ports = load(path, 0), Ports(1, 2, 3)
    assert isinstance(mission, LivePlanningMission)
    cfg = write_configuration(mission, [1, 2], ports, tmp_path)
    assert 'UseUxasRoutePlanner="true"' in cfg.read_text()
    with pytest.raises(BadInput, match="cannot ask UxAS"):
        write_configuration(mission, [1, 2], ports, tmp_path, original=True)
    without = load(root / "examples/crossing/mission.yaml", 0)
    assert not isinstance(without, LivePlanningMission)
    assert "UseUxas" not in write_configuration(without, [1, 2], ports, tmp_path).read_text()
