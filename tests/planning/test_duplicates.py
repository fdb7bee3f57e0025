"""Requests that list a vehicle or a task several times: it counts once, and that is said."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, must_fly, request

from cratous.bridge import lmcp
from cratous.services.loading import load
from cratous.spec.mission import Mission

SAID = {
    "vehicle 1": "vehicle 1 is listed 2 times in EntityList, and counts once",
    "task 5": "task 5 is listed 3 times in TaskList, and counts once",
}


def answered(folder: Path, tasks: tuple[int, ...], vehicles: tuple[int, ...]) -> tuple[Rig, Any]:
    folder.mkdir()
    rig = Rig(folder).with_two()
    rig.tell(request(*tasks, vehicles=vehicles, TaskRelationships=".(p5 p6)"))
    (response,) = rig.got("AutomationResponse")
    assert response.MissionCommandList, rig.reasons()
    return rig, response


def test_the_answer_is_that_to_the_request_without_them_and_says_so(tmp_path: Path) -> None:
    _, plain = answered(tmp_path / "plain", (5, 6), (1, 2))
    rig, twice = answered(tmp_path / "twice", (5, 6, 5, 5), (1, 2, 1))
    assert twice.MissionCommandList == plain.MissionCommandList
    assert not plain.Info
    assert [pair.Value for pair in twice.Info] == list(SAID.values())
    assert rig.reasons("Warning") == list(SAID.values())
    (unique,) = rig.got("UniqueAutomationRequest")
    asked = unique.OriginalRequest
    assert (list(asked.EntityList), list(asked.TaskList)) == ([1, 2], [5, 6])


@pytest.mark.parametrize("kind", ["ImpactAutomationRequest", "TaskAutomationRequest"])
def test_wrapped_requests_are_answered_so_too(tmp_path: Path, kind: str) -> None:
    rig = Rig(tmp_path).with_two()
    inner = request(5, 5, 5, vehicles=(1, 1))
    field = "TrialRequest" if kind.startswith("Impact") else "OriginalRequest"
    rig.tell(lmcp.new(kind, RequestID=3, **{field: inner}))
    (response,) = rig.got(kind.replace("Request", "Response"))
    made = response.TrialResponse if kind.startswith("Impact") else response.OriginalResponse
    assert [c.VehicleID for c in made.MissionCommandList] == [1]
    assert [pair.Value for pair in made.Info] == list(SAID.values())


def test_one_that_another_validator_passes_on_as_it_is_is_planned(tmp_path: Path) -> None:
    rig = Rig(tmp_path).with_two()
    rig.tell(
        lmcp.new(
            "UniqueAutomationRequest", RequestID=7, OriginalRequest=request(5, 6, 5, vehicles=(1, 2, 1))
        )
    )  # fmt: skip
    (response,) = rig.got("UniqueAutomationResponse")
    done = [
        {t for w in c.WaypointList for t in w.AssociatedTasks}
        for c in response.OriginalResponse.MissionCommandList
    ]
    assert set().union(*done) == {5, 6}
    assert not rig.reasons()


def test_an_eligible_vehicle_that_is_listed_twice_is_one(tmp_path: Path) -> None:
    rig = Rig(tmp_path).with_two()
    rig.tell(must_fly(8, EligibleEntities=[2, 2]), request(8, vehicles=(1, 2)))
    (response,) = rig.got("AutomationResponse")
    assert [c.VehicleID for c in response.MissionCommandList] == [2]
    (offer,) = rig.got("TaskPlanOptions")
    assert {tuple(option.EligibleEntities) for option in offer.Options} == {(2,)}


def test_a_folder_whose_request_does_so_is_read_with_a_note(shared: Path, tmp_path: Path) -> None:
    given = shared / "examples" / "openuxas" / "waterway"
    for file in given.rglob("*.xml"):
        text = file.read_text()
        if "<AutomationRequest" in text:
            text = text.replace("<TaskList>", "<TaskList><int64>1000</int64>", 1)
        copy = tmp_path / "waterway" / file.relative_to(given)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text)
    plain, twice = load(given), load(tmp_path / "waterway")
    assert isinstance(plain, Mission)
    assert isinstance(twice, Mission)
    assert twice.tasks == plain.tasks
    note = "task 1000 is listed 2 times in TaskList, and counts once"
    assert note in twice.notes
    assert note not in plain.notes
