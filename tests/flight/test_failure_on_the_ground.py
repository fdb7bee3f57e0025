"""After a declared failure a vehicle that started on the ground returns to where that was, or does not leave it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
import yaml
from ground_tools import Flown, flown_of

from cratous.services.flight.landing_reach import require_reachable
from cratous.services.flight.lost_link import after_failure
from cratous.services.loading import load
from cratous.spec.mission.guarantees import Outcome

ROWS = (
    "what vehicle 1 does after a failure",
    "authority over vehicle 1",
    "take-off of vehicle 1",
    "failures of vehicle 1 are declared when due",
)
OVER_IT = [{"at_s": 72, "zone": {"id": 9, "kind": "keep_out", "vertices": [[2400, -100], [2600, -100], [2600, 100], [2400, 100]]}}]  # fmt: skip
SITES = [{"name": "base", "position": {"north_m": 60, "east_m": 0}, "radius_m": 220}, {"name": "field", "position": {"north_m": 900, "east_m": 0}, "radius_m": 60}]  # fmt: skip
HOVERS = {"id": 90, "position": {"north_m": 600, "east_m": 20, "alt_m": 120}, "velocity": {"north_m_s": 0, "east_m_s": 0}}  # fmt: skip
BESIDE = {"id": 90, "position": {"north_m": 350, "east_m": -30, "alt_m": 100}, "velocity": {"north_m_s": 14, "east_m_s": 1}, "appears_s": 31, "vanishes_s": 140}  # fmt: skip


def mission_file(root: Path, folder: Path, **sections: Any) -> Path:
    data = yaml.safe_load((root / "tests/missions/on_failure.yaml").read_text())
    (vehicle,) = data["vehicles"]
    place = {"north_m": 0, "east_m": 0, "alt_m": 200}
    data["vehicles"] = [{**vehicle, "start": "ground", "position": place}]
    data["tasks"] = [{"id": 1, "kind": "must_fly", "points": [{**place, "north_m": 2500}]}]
    found = {k: v for k, v in {**data, "landing_sites": None, **sections}.items() if v is not None}
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(found))
    return path


def failures(flight: Flown) -> list[str]:
    return [body.Failure.name for body in flight.told("FailureState")]


def modes(flight: Flown) -> list[str]:
    return [body.Mode.name for body in flight.told("LinkLossState")]


def assert_known(flight: Flown, folder: Path) -> None:
    verdicts, judged = flight.verdicts(), flight.judged(folder)
    for item in ROWS:
        assert verdicts[item].outcome is Outcome.HOLDS, verdicts[item]
        assert judged[item] == "holds"


def test_it_lands_where_it_started(root: Path, tmp_path: Path) -> None:
    """Another site is nearer then; the one that it started from is taken if none is named."""
    sections = {"on_failure": {"choice": "land"}, "landing_sites": SITES, "changes": OVER_IT}
    mission = load(mission_file(root, tmp_path, **sections))
    require_reachable(mission)
    flies = after_failure(mission, 1)
    assert flies is not None
    assert flies.flies.site == "base"
    flight = flown_of(mission)
    assert failures(flight) == ["Ended"]
    assert modes(flight) == ["Land", "Final", "Landed"]
    last = flight.told("TruthState")[-1]
    assert math.hypot(last.North - 60, last.East) < 220
    assert (last.Altitude, last.VelocityNorth, last.VelocityEast) == (0, 0, 0)
    assert_known(flight, tmp_path)


def test_it_returns_to_above_where_it_started(root: Path, tmp_path: Path) -> None:
    after = {"choice": "return"}
    flight = flown_of(load(mission_file(root, tmp_path, on_failure=after, changes=OVER_IT)))
    assert failures(flight) == ["Ended"]
    assert modes(flight) == ["Return", "Over"]
    last = flight.told("TruthState")[-1]
    assert math.hypot(last.North, last.East) < 400
    assert last.Altitude == pytest.approx(200, abs=2)
    assert_known(flight, tmp_path)


@pytest.mark.parametrize("choice", ["hold", "return", "land"])
def test_one_that_is_kept_on_the_ground_stays_there(
    root: Path, tmp_path: Path, choice: str
) -> None:
    """That it has no certificate on the ground is no failure; that it is kept from its task is one."""
    sites = SITES if choice == "land" else None
    sections = {"on_failure": {"choice": choice}, "landing_sites": sites, "changes": None}
    daa = {"lookahead_s": 20}
    path = mission_file(root, tmp_path, traffic=[HOVERS], daa=daa, **sections)
    flight = flown_of(load(path))
    assert failures(flight) == ["Blocked"]
    assert modes(flight) == ["Loiter"]
    (said,) = flight.told("LinkLossState")
    assert said.Reason == "after a declared failure: it does not leave the ground"
    assert flight.told("TakeOffState")[-1].Reason == "it stands: a failure is declared"
    assert flight.result.end_ms == flight.told("FailureState")[0].Time
    own = [one for one in flight.told("TruthState") if one.VehicleID == 1]
    assert {(one.North, one.East, one.Altitude) for one in own} == {(0, 0, 0)}
    assert_known(flight, tmp_path)


def test_one_that_is_surprised_in_its_climb_leaves_it(root: Path, tmp_path: Path) -> None:
    after = {"choice": "return"}
    path = mission_file(root, tmp_path, on_failure=after, traffic=[BESIDE], changes=None)
    flight = flown_of(load(path))
    assert failures(flight) == ["Surprised"]
    assert modes(flight)[-2:] == ["Return", "Over"]
    assert [body.Mode.name for body in flight.told("TakeOffState")] == ["Rolling", "Climbing", "Up"]
    assert_known(flight, tmp_path)
