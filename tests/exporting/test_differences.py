"""What two missions have not in common: every field that is changed is found, and nothing else."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cratous.services.exporting.differences import differences
from cratous.services.loading import load
from cratous.spec import mission as spec

ZONE = spec.Zone(
    7, spec.ZoneKind.KEEP_OUT, ((5000.0, 0.0), (5000.0, 9.0), (5009.0, 0.0)), 0.0, 900.0
)
AIRCRAFT = spec.Traffic(90, spec.Position(500.0, 3000.0, 300.0), spec.Velocity(0.0, 20.0, 0.0))


def first(name: str, **more: Any) -> Callable[[spec.Mission], spec.Mission]:
    """The first of a list with something else."""

    def change(mission: spec.Mission) -> spec.Mission:
        one, *rest = getattr(mission, name)
        return replace(mission, **{name: (replace(one, **more), *rest)})

    return change


CHANGED: list[tuple[str, Callable[[spec.Mission], spec.Mission]]] = [
    ("relations", lambda m: replace(m, relations="")),
    ("cost", lambda m: replace(m, cost="ENERGY")),
    ("gap", lambda m: replace(m, gap=0.1)),
    ("node_limit", lambda m: replace(m, node_limit=5)),
    ("instances", lambda m: replace(m, instances=m.instances[1:])),
    ("daa.lookahead_s", lambda m: replace(m, daa=replace(m.daa, lookahead_s=61.0))),
    ("simulation.bridge_faults", lambda m: replace(m, simulation=spec.FaultySimulation())),
    ("frame.terrain_m", lambda m: replace(m, frame=replace(m.frame, terrain_m=20.0))),
    ("zones", lambda m: replace(m, zones=(ZONE,))),
    ("traffic", lambda m: replace(m, traffic=(AIRCRAFT,))),
    ("tasks", lambda m: replace(m, tasks=m.tasks[1:])),
    ("tasks[0].priority", first("tasks", priority=3)),
    ("tasks[0].eligible", first("tasks", eligible=(1, 2))),
    ("vehicles[0].power_w", first("vehicles", power_w=90.0)),
    ("vehicles[0].protected", first("vehicles", protected=False)),
    ("vehicles[0].cruise_m", first("vehicles", cruise_m=310.0)),
    ("vehicles[0].position.north_m", first("vehicles", position=spec.Position(3.0, 0.0, 300.0))),
]


@pytest.mark.parametrize(("item", "change"), CHANGED)
def test_each_change_is_found(
    root: Path, item: str, change: Callable[[spec.Mission], spec.Mission]
) -> None:
    mission = load(root / "examples/crossing/mission.yaml")
    changed = change(mission)
    for a, b in ((mission, changed), (changed, mission)):
        found = differences(a, b)
        assert item in {one.item for one in found}
        assert {one.item.partition(".")[0] for one in found} == {item.partition(".")[0]}
        assert found[0].text.startswith(found[0].item)


def test_another_frame_is_no_difference_where_the_places_are_the_same(root: Path) -> None:
    mission = load(root / "examples/popup/mission.yaml")
    assert differences(mission, mission) == []
    frame = spec.Frame(mission.frame.latitude_deg + 0.001, mission.frame.longitude_deg)
    shifted = differences(mission, replace(mission, frame=frame))
    assert {one.item for one in shifted} >= {f"vehicles[{k}].position.north_m" for k in range(2)}
