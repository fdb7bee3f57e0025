"""Requests that the original misreads, crashes at or never answers, through the whole pipeline.

The rows are those that were measured on OpenUxAS (tie-breaks, lost tasks, vehicles that may not, texts
that mean nothing, files that are no XML); here each is answered once, by a plan that means what the
request says, or with the reason.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, must_fly, request, vehicle
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.spec.errors import BadInput


def told(folder: Path, asked: Any, **more: Any) -> Rig:
    """Two vehicles, task 5 for any, task 6 for vehicle 2 alone, and one request."""
    rig = Rig(folder)
    rig.tell(*vehicle(1), *vehicle(2, 0.01))
    rig.tell(must_fly(5, **more), must_fly(6, 0.03, EligibleEntities=[2]))
    rig.tell(asked)
    rig.wait(10_000)
    assert len(rig.got("AutomationResponse")) == 1
    assert not rig.said.has("fails at")
    return rig


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (request(), "the request names no task"),
        (request(5, 6, vehicles=(1,)), "task 6"),
        (request(7), "task 7 does not exist"),
        (request(5, vehicles=(9,)), "vehicle 9 does not exist"),
        (request(5, 6, vehicles=(1, 2), TaskRelationships="|(p5 p9)"), "unknown task p9"),
        (request(5, 6, vehicles=(1, 2), TaskRelationships="|(p5 p6"), "expected"),
        (request(5, 6, vehicles=(1, 2), TaskRelationships="|"), "expected"),
        (request(5, 6, vehicles=(1, 2), TaskRelationships="|(p5,p6)"), "expected"),
        (request(5, 6, vehicles=(1, 2), TaskRelationships="|(p p5)"), "expected"),
        (request(5, 6, vehicles=(1, 2), TaskRelationships="p" + "9" * 20), "p"),
        (request(5, 6, vehicles=(1, 2), TaskRelationships="*(p5 p6)"), "expected"),
        (request(5, OperatingRegion=3), "operating region 3 does not exist"),
    ],
)
def test_what_cannot_be_done_is_answered_once_with_the_reason(
    tmp_path: Path, asked: Any, words: str
) -> None:
    rig = told(tmp_path, asked)
    (answer,) = rig.got("AutomationResponse")
    assert not answer.MissionCommandList
    assert words in " ".join(pair.Value for pair in answer.Info)
    assert words in " ".join(rig.reasons())


@pytest.mark.parametrize(
    ("asked", "flown"),
    [
        # bare, with blanks, without relations: the obvious meaning
        (request(5, 6, vehicles=(1, 2), TaskRelationships="p5"), {5}),
        (request(5, 6, vehicles=(1, 2), TaskRelationships=" |( p5 p6 ) "), {5, 6}),
        (request(5, 6, vehicles=(1, 2)), {5, 6}),
        (request(5, 6, vehicles=(1, 2), TaskRelationships="+(p5 p6)"), {5}),
        # no list of vehicles means all; a vehicle that is not listed flies nothing
        (request(5, 6, vehicles=()), {5, 6}),
        (request(5, 6, vehicles=(2,)), {5, 6}),
    ],
)
def test_what_can_be_done_is_planned_for_who_may(
    tmp_path: Path, asked: Any, flown: set[int]
) -> None:
    rig = told(tmp_path, asked)
    (answer,) = rig.got("AutomationResponse")
    by = {
        task: command.VehicleID
        for command in answer.MissionCommandList
        for waypoint in command.WaypointList
        for task in waypoint.AssociatedTasks
    }
    assert set(by) == flown or (set(by) == {6} and asked.TaskRelationships == "+(p5 p6)")
    assert by.get(6, 2) == 2
    assert set(by.values()) <= set(asked.EntityList or (1, 2))


def test_the_ids_of_vehicles_and_options_are_apart(tmp_path: Path) -> None:
    """The original's vehicle 500001 and option 1 of its task 5 are one node."""
    rig = Rig(tmp_path)
    rig.tell(*vehicle(500_001), *vehicle(600_001, 0.01), must_fly(5), must_fly(6, 0.03))
    rig.tell(request(5, 6, vehicles=(500_001, 600_001), TaskRelationships=".(p5 p6)"))
    (answer,) = rig.got("AutomationResponse")
    flown = [
        t for c in answer.MissionCommandList for w in c.WaypointList for t in w.AssociatedTasks
    ]
    assert set(flown) == {5, 6}
    assert {c.VehicleID for c in answer.MissionCommandList} <= {500_001, 600_001}


BROKEN = (
    '<LineSearchTask Series="CMASI"><TaskID>5</TaskID><EligibleEntities>{}</EligibleEntities>'
    "</LineSearchTask>"
)


@pytest.mark.parametrize("inside", ["<int64>1<int64>", "<int64>1000/<int64>", "<int64>1</int32>"])
def test_a_message_file_that_is_no_xml_is_refused_with_its_place(
    tmp_path: Path, inside: str
) -> None:
    """The original takes it without a word, and everybody is eligible."""
    (tmp_path / "task.xml").write_text(BROKEN.format(inside))
    path = write_cfg(
        tmp_path,
        f'<Service Type="SendMessagesService" PathToMessageFiles="{tmp_path}">'
        '<Message MessageFileName="task.xml" SendTime_ms="10"/></Service>',
    )
    with pytest.raises(BadInput, match=r"task\.xml"):
        process(path)


def test_a_new_service_whose_task_is_no_xml_is_refused_and_the_process_goes_on(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path)
    text = (
        f'<Service Type="afrl.cmasi.LineSearchTask"><TaskRequest>{BROKEN}</TaskRequest></Service>'
    )
    before = rig.bus.names()
    rig.tell(
        lmcp.new("CreateNewService", ServiceID=99, XmlConfiguration=text.format("<int64>1<int64>"))
    )
    assert rig.bus.names() == before
    assert "XML" in rig.reasons()[0]
    rig.tell(*vehicle(1), must_fly(5), request(5))
    assert rig.got("AutomationResponse")[0].MissionCommandList
