"""OverridePlanningConditions: requests that are planned at speeds and altitudes of their own."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import unique
from pipeline_tools import PIPELINE, Rig, must_fly, request, vehicle

from cratous.bridge import lmcp

NAME = "AutomationRequestValidatorService"


def trial_of(pairs: list[Any], *tasks: int, number: int = 70) -> Any:
    return lmcp.new(
        "ImpactAutomationRequest",
        RequestID=number,
        TrialRequest=request(*tasks),
        OverridePlanningConditions=pairs,
    )


def pair(speed: float, altitude: float = 0.0, task: int = 0, vehicle_id: int = 1) -> Any:
    fields = {"Speed": speed, "Altitude": altitude, "AltitudeType": "MSL" if altitude else "AGL"}
    return lmcp.new("SpeedAltPair", VehicleID=vehicle_id, TaskID=task, **fields)


def test_a_trial_is_planned_at_its_own_speed_and_altitude(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    anywhere = [lmcp.new("Location3D", Latitude=north) for north in (0.02, 0.03)]
    flown = [lmcp.new("MustFlyTask", TaskID=5 + k, Position=at) for k, at in enumerate(anywhere)]
    rig.tell(*vehicle(1), *flown)
    rig.tell(request(5), trial_of([pair(25.0, 400.0)], 5), request(5), trial_of([pair(25.0)], 5))
    rig.tell(trial_of([pair(25.0, 400.0, 5), pair(25.0, 400.0, 6)], 5, 6))
    plain, again = (r.MissionCommandList for r in rig.got("AutomationResponse"))
    high, fast, both = (
        r.TrialResponse.MissionCommandList for r in rig.got("ImpactAutomationResponse")
    )
    ends = {(w[0].WaypointList[-1].Speed, w[0].WaypointList[-1].Altitude) for w in (plain, again)}
    assert ends == {(20.0, 300.0)}
    assert {w.Speed for w in high[0].WaypointList} == {25.0}
    assert high[0].WaypointList[-1].Altitude == 400.0
    assert {(w.Speed, w.Altitude) for w in fast[0].WaypointList} == {(25.0, 300.0)}
    assert (both[0].WaypointList[-1].Speed, both[0].WaypointList[-1].Altitude) == (25.0, 400.0)


@pytest.mark.parametrize(
    ("pairs", "words"),
    [
        ([pair(10.0)], "vehicle 1 does not fly at this speed; expected 15 to 30 m/s"),
        ([pair(40.0)], "vehicle 1 does not fly at this speed"),
        ([pair(float("nan"))], "vehicle 1 does not fly at this speed"),
        (
            [pair(20.0, float("nan"))],
            "vehicle 1 does not fly at this altitude; expected a number of metres",
        ),
        ([pair(20.0, float("inf"))], "vehicle 1 does not fly at this altitude"),
        ([pair(20.0, vehicle_id=9)], "vehicle 9 has no AirVehicleConfiguration"),
        ([pair(25.0, task=5)], "some tasks at another speed"),
        ([pair(25.0), pair(20.0, task=6)], "some tasks at another speed"),
    ],
)
def test_conditions_that_cannot_be_kept_are_refused(
    tmp_path: Path, pairs: list[Any], words: str
) -> None:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), must_fly(5), must_fly(6), trial_of(pairs, 5, 6), request(5, 6))
    (refused,) = rig.got("ImpactAutomationResponse")
    assert re.search(words, refused.TrialResponse.Info[0].Value)
    assert not refused.TrialResponse.MissionCommandList
    assert rig.got("AutomationResponse")[0].MissionCommandList, "the same without them"


def test_where_the_validator_is_elsewhere_conditions_are_not_taken_for_another_request(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path, *(name for name in PIPELINE if name != NAME))
    rig.tell(*vehicle(1), must_fly(5), trial_of([pair(25.0)], 5), unique(7, 5))
    assert "validator is in another process" in rig.reasons()[0]
