"""Tasks of kinds that we do not do: named at once, or done by a service of another's that speaks for them."""

from __future__ import annotations

import random
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest
from pipeline_messages import cost, implementation, matrix, option, options, unique
from pipeline_tools import Rig, must_fly, place, request, vehicle

from cratous.bridge import lmcp
from cratous.services.bus import Envelope
from cratous.services.pipeline import implementation as implementation_module
from cratous.services.pipeline import planner
from cratous.services.pipeline.external_tasks import OTHERS_MS
from cratous.spec import algebra
from cratous.spec.algebra import meaning as algebra_meaning

KIND = "afrl.impact.PayloadDropTask"
INFO = "AutomationResponse"


def relay(number: int, **more: Any) -> Any:
    return lmcp.new("PayloadDropTask", TaskID=number, DropLocation=place(0.03), **more)


class OtherTask:
    """A task's service as another's program would be, by messages alone."""

    subscribes: tuple[str, ...] = (
        "uxas.messages.task.UniqueAutomationRequest",
        "uxas.messages.task.TaskImplementationRequest",
    )

    def __init__(self, task: int, composition: str = "", count: int = 2) -> None:
        self.name, self.task, self.composition = f"OtherTask[{task}]", task, composition
        self.count = count

    def start(self) -> None:
        return None

    def begin(self, state: None) -> tuple[None, Iterable[Any]]:
        return None, [lmcp.new("TaskInitialized", TaskID=self.task)]

    def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, Iterable[Any]]:
        body = envelope.body
        if hasattr(body, "OriginalRequest"):
            if self.task not in body.OriginalRequest.TaskList:
                return None, ()
            made = [
                option(self.task, n, latitude=0.02 + 0.01 * n, cost=10_000)
                for n in range(1, self.count + 1)
            ]
            return None, [options(body.RequestID, self.task, *made, composition=self.composition)]
        if body.TaskID != self.task:
            return None, ()
        latitude = 0.02 + 0.01 * body.OptionID
        points = [
            lmcp.new(
                "Waypoint",
                Number=body.StartingWaypointID + k,
                NextWaypoint=body.StartingWaypointID + k + 1,
                Latitude=at,
                Altitude=300.0,
                Speed=20.0,
                AssociatedTasks=[self.task] if k else [],
            )
            for k, at in enumerate((latitude, latitude + 0.002))
        ]
        end_ms = max(body.StartTime, body.TimeThreshold) + 10_000
        end = place(latitude + 0.002)
        return None, [implementation(body, points, FinalLocation=end, FinalTime=end_ms)]


@pytest.fixture
def rig(tmp_path: Path) -> Rig:
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), must_fly(5))
    return rig


def told(rig: Rig, k: int) -> str:
    return " ".join(pair.Value for pair in rig.got(INFO)[k].Info)


def test_a_kind_that_nobody_does_is_named_when_others_had_their_time_to_speak(rig: Rig) -> None:
    rig.tell(relay(9), request(5, 9))
    rig.wait(OTHERS_MS - 1)
    assert not rig.got(INFO), "another's service may still be starting"
    rig.wait(1)
    assert f"task 9 is a {KIND}: no service here does this kind" in told(rig, 0)
    rig.tell(request(9), request(5))
    assert KIND in told(rig, 1), "at once: nobody has spoken since"
    assert rig.got(INFO)[2].MissionCommandList, "the others go on"
    rig.tell(relay(9), request(9))
    assert len(rig.got(INFO)) == 3, "another task of this id has its own time"
    rig.wait(OTHERS_MS)
    assert KIND in told(rig, 3)


def test_a_validator_that_is_started_anew_still_names_a_kind_that_nobody_does(rig: Rig) -> None:
    name = "AutomationRequestValidatorService"
    rig.tell(relay(9), request(5, 9))
    number = next(n for n, one in rig.one.manager.services.items() if one == name)
    rig.tell(lmcp.new("KillService", ServiceID=number))
    text = f'<Service Type="{name}" MaxResponseTime_ms="60000"/>'
    rig.tell(lmcp.new("CreateNewService", XmlConfiguration=text))
    rig.wait(OTHERS_MS)
    assert f"task 9 is a {KIND}: no service here does this kind" in told(rig, 0)


def test_where_tasks_are_made_elsewhere_a_request_waits_for_them(tmp_path: Path) -> None:
    rig = Rig(tmp_path, "AutomationRequestValidatorService")
    rig.tell(*vehicle(1), relay(9), request(9))
    rig.wait(OTHERS_MS)
    assert not rig.got(INFO)
    rig.tell(lmcp.new("TaskInitialized", TaskID=9))
    (asked,) = rig.got("UniqueAutomationRequest")
    assert asked.OriginalRequest.TaskList == [9]


@pytest.mark.parametrize("late", [False, True])
def test_a_kind_for_which_another_speaks_takes_part(rig: Rig, late: bool) -> None:
    rig.tell(relay(9))
    if late:
        rig.wait(2 * OTHERS_MS)
    rig.bus.add(OtherTask(9))
    rig.tell(request(5, 9, TaskRelationships=".(p5 p9)"))
    (response,) = rig.got(INFO)
    (command,) = response.MissionCommandList
    flown = [t for w in command.WaypointList for t in w.AssociatedTasks]
    assert list(dict.fromkeys(flown)) == [5, 9]
    (summary,) = rig.got("TaskAssignmentSummary")
    assert [(t.TaskID, t.OptionID) for t in summary.TaskList][1] == (9, 1), "the nearer option"
    rig.tell(lmcp.new("RemoveTasks", TaskList=[9]), request(9))
    assert "task 9 does not exist" in told(rig, 1)


def test_eligibility_and_relations_hold_for_another_s_task_too(rig: Rig) -> None:
    rig.tell(*vehicle(2, 0.5), relay(9, EligibleEntities=[2]))
    rig.bus.add(OtherTask(9))
    rig.tell(request(5, 9, vehicles=(1, 2), TaskRelationships="|(p5 p9)"))
    (summary,) = rig.got("TaskAssignmentSummary")
    assert {t.TaskID: t.AssignedVehicle for t in summary.TaskList} == {5: 1, 9: 2}


def test_a_planner_s_process_without_a_validator_refuses_what_nobody_speaks_for(
    tmp_path: Path,
) -> None:
    rig = Rig(tmp_path, "RouteAggregatorService")
    rig.tell(*vehicle(1), relay(9), unique(3, 9))
    assert "tasks of type PayloadDropTask are not covered" in rig.reasons()[0]
    rig.tell(lmcp.new("TaskInitialized", TaskID=9), unique(4, 9))
    assert len(rig.reasons()) == 1, "it waits for the options of the one who spoke"
    rig.tell(relay(9), unique(5, 9))
    assert len(rig.reasons()) == 2, "another task of this id has not been spoken for"


@pytest.mark.parametrize(
    ("composition", "flown"),
    [
        (".(p1 p2)", [1, 2]),
        (".(p2 p1)", [2, 1]),
        ("|(p1 p2)", [1, 2]),
        ("+(.(p2 p1) p3)", [3]),
        (".(+(p1 p3) p2)", [1, 2]),
        ("+(.(p1 p2 p3))_[0-9000000]", [1, 2, 3]),
    ],
)
def test_the_options_of_a_task_are_flown_as_its_composition_says(
    rig: Rig, composition: str, flown: list[int]
) -> None:
    count = max(int(c) for c in composition.split("_")[0] if c.isdigit())
    rig.tell(relay(9))
    rig.bus.add(OtherTask(9, composition, count))
    rig.tell(request(5, 9, TaskRelationships=".(p5 p9)"))
    assert not rig.reasons(), rig.reasons()
    (summary,) = rig.got("TaskAssignmentSummary")
    pairs = [(t.TaskID, t.OptionID) for t in summary.TaskList]
    assert pairs == [(5, pairs[0][1]), *((9, n) for n in flown)]
    starts = [t.TimeThreshold for t in summary.TaskList]
    assert all(b >= a.TimeTaskCompleted for a, b in zip(summary.TaskList, starts[1:], strict=False))
    (command,) = rig.got(INFO)[0].MissionCommandList
    passed = [round(w.Latitude, 6) for w in command.WaypointList if 9 in w.AssociatedTasks]
    assert passed == [round(0.022 + 0.01 * n, 6) for n in flown]


def test_two_vehicles_fly_the_parts_of_one_task(rig: Rig) -> None:
    """As a blockade has it: both options at once, each by whom it suits."""
    rig.tell(*vehicle(2, 0.06), relay(9))
    rig.bus.add(OtherTask(9, "|(p1 p2 p3)", 3))
    rig.tell(request(9, vehicles=(1, 2)))
    (summary,) = rig.got("TaskAssignmentSummary")
    assert {t.AssignedVehicle for t in summary.TaskList} == {1, 2}
    assert sorted(t.OptionID for t in summary.TaskList) == [1, 2, 3]
    assert len(rig.got(INFO)[0].MissionCommandList) == 2


@pytest.mark.parametrize("seed", range(12))
def test_a_composition_costs_what_the_same_relations_of_tasks_cost(
    tmp_path: Path, seed: int
) -> None:
    """Options 1 to 4 of task 9, and tasks 1 to 4 with the composition as relations: one problem, two ways."""
    rng = random.Random(seed)
    rig = Rig(tmp_path, "AssignmentTreeBranchBoundService")
    rig.tell(*vehicle(1), *vehicle(2, 0.01), relay(9), *(must_fly(n) for n in (1, 2, 3, 4)))
    rig.tell(lmcp.new("TaskInitialized", TaskID=9))
    text = _random_term(rng, [1, 2, 3, 4])
    times = {n: rng.randrange(1000, 9000) for n in (1, 2, 3, 4)}
    ways = {
        (v, a, b): rng.randrange(100, 5000)
        for v in (1, 2)
        for a in range(5)
        for b in (1, 2, 3, 4)
        if a != b
    }
    one = [option(9, n, cost=times[n]) for n in times]
    rows = [cost(v, 9, b, ms, (9, a) if a else (0, 0)) for (v, a, b), ms in ways.items()]
    rig.tell(unique(2, 9, vehicles=(1, 2)), options(2, 9, *one, composition=text), matrix(2, *rows))
    rows = [cost(v, b, 1, ms, (a, 1) if a else (0, 0)) for (v, a, b), ms in ways.items()]
    asked = unique(3, 1, 2, 3, 4, vehicles=(1, 2), TaskRelationships=text)
    rig.tell(asked, *(options(3, n, option(n, 1, cost=times[n])) for n in times), matrix(3, *rows))
    assert not rig.reasons(), rig.reasons()
    composed, related = rig.got("TaskAssignmentSummary")
    ends = [max(t.TimeTaskCompleted for t in s.TaskList) for s in (composed, related)]
    assert ends[0] == ends[1]
    done = {t.OptionID for t in composed.TaskList}
    whole = [set(algebra_meaning.tasks(b)) for b in algebra_meaning.branches(algebra.parse(text))]
    assert done in whole


def _random_term(rng: random.Random, left: list[int]) -> str:
    if len(left) == 1:
        return f"p{left[0]}"
    cut = rng.randrange(1, len(left))
    parts = " ".join(_random_term(rng, part) for part in (left[:cut], left[cut:]))
    return f"{rng.choice('.|+')}({parts})"


@pytest.mark.parametrize(("shorter_ms", "planned"), [(1, True), (49, True), (50, False)])
def test_a_way_of_another_planner_that_is_shorter_by_its_rounding_needs_no_hold(
    rig: Rig, monkeypatch: pytest.MonkeyPatch, shorter_ms: int, planned: bool
) -> None:
    """Where no circle fits, a wait of a millisecond ended the whole mission."""
    own = planner.plans_of

    def other(contexts: Any, asked: Any, constraints: Any) -> list[Any]:
        plans = own(contexts, asked, constraints)
        less = 0 if asked.IsCostOnlyRequest else shorter_ms
        return [plan.copy(RouteCost=plan.RouteCost - less) for plan in plans]

    monkeypatch.setattr(planner, "plans_of", other)
    monkeypatch.setattr(implementation_module, "hold_of", lambda *_: None)
    rig.tell(request(5))
    assert bool(rig.got(INFO)[0].MissionCommandList) is planned
    assert ("no hold circle there" in " ".join(rig.reasons())) is not planned
    early = f"begins task 5 {shorter_ms / 1000:.3f} s earlier than planned"
    assert (early in " ".join(rig.reasons("Warning"))) is planned
