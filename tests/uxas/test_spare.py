"""What a process does before its first request comes: piece by piece, and only when nothing else is there to do."""

from __future__ import annotations

import ast
import contextlib
import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import must_fly, request, vehicle
from uxas_tools import process, write_cfg

from cratous.bridge import lmcp
from cratous.services.pipeline.contexts import Contexts
from cratous.services.planning import inputs
from cratous.services.planning import routes as planned
from cratous.services.startup import idle_work
from cratous.services.uxas import message_source
from cratous.services.uxas.message_source import MessageSource
from cratous.services.uxas.process import Process

ROOT = Path(__file__).parents[2]
LOOPS_IN = ("core/geofence", "core/routing", "core/tasks", "services/mission")


@pytest.mark.parametrize("fails", [False, True])
def test_spare_time_is_used_piece_by_piece(tmp_path: Path, fails: bool) -> None:
    ours, said = process(write_cfg(tmp_path, '<Service Type="HelloWorld"/>'))
    done: list[int] = []

    def pieces() -> Iterator[bool]:
        for number in range(3):
            done.append(number)
            yield True
        ours.stopping = True
        if fails:
            raise OSError("no cache")

    with ours:
        ours.run(10.0, pieces())
        assert ours.stopping
    assert done == [0, 1, 2]
    assert said.has("the first request will take longer: OSError: no cache") == fails


def test_what_is_due_comes_before_a_piece_and_virtual_time_has_none(tmp_path: Path) -> None:
    hello = '<Service Type="HelloWorld" SendPeriod_ms="5"/>'
    for virtual in (False, True):
        folder = tmp_path / str(virtual)
        folder.mkdir()
        ours, _ = process(write_cfg(folder, hello), virtual=virtual)
        done: list[int] = []
        with ours:
            ours.run(0.2, (done.append(k) is None for k in range(3)))
        assert not done


def test_where_nothing_is_to_do_for_now_it_is_not_asked_again_at_once(tmp_path: Path) -> None:
    """Else a process that waits would take a core."""
    ours, _ = process(write_cfg(tmp_path, '<Service Type="HelloWorld"/>'))
    done: list[int] = []
    with ours:
        ours.run(1.0, (bool(done.append(k)) for k in itertools.count()))
    assert 1 <= len(done) < 10


def test_nothing_is_done_ahead_once_something_is_asked_for(tmp_path: Path) -> None:
    ours, _ = process(write_cfg(tmp_path, '<Service Type="HelloWorld"/>'))
    done: list[int] = []

    def pieces() -> Iterator[bool]:
        for number in range(9):
            done.append(number)
            if number == 1:
                ours.bus.publish(lmcp.new("TaskAutomationRequest"), "test")
            yield True

    with ours:
        ours.run(0.3, pieces())
    assert done == [0, 1]


def test_every_loop_that_planning_may_have_compiled_is_read_ahead() -> None:
    files = [file for folder in LOOPS_IN for file in sorted((ROOT / folder).rglob("*.py"))]
    calls = [
        n for f in files for n in ast.walk(ast.parse(f.read_text())) if isinstance(n, ast.Call)
    ]
    # of routes, `_search` hands the loop that it is called with to `swift`
    by = ("swift", "_search")
    names = {ast.unparse(n.args[0]) for n in calls if ast.unparse(n.func) in by} - {"loop"}
    assert names == {loop.__name__ for loop in idle_work._LOOPS}


def test_the_pieces_plan_what_planning_is_asked_for() -> None:
    assert sum(1 for _ in idle_work.pieces()) == len(idle_work._LOOPS) + len(idle_work.TASKS) + 2


PLANS = "TaskManager AutomationRequestValidator RoutePlannerVisibility RouteAggregator PlanBuilder"
AT = {"Latitude": 0.02, "Longitude": 0.01}


@contextlib.contextmanager
def planner(folder: Path) -> Iterator[Process]:
    """A process that plans, with two aircraft."""
    services = "".join(f'<Service Type="{name}Service"/>' for name in PLANS.split())
    assignment = '<Service Type="AssignmentTreeBranchBoundService"/>'
    with process(write_cfg(folder, services + assignment), virtual=True)[0] as ours:
        for body in (*vehicle(1), *vehicle(2, 0.01)):
            ours.bus.publish(body, "test")
        ours.run(1.0)
        yield ours


@pytest.fixture
def planning(tmp_path: Path) -> Iterator[tuple[Process, Contexts]]:
    """Such a process, and who knows what has been told."""
    with planner(tmp_path) as ours:
        yield ours, ours.host.shared["contexts"]


def tell(ours: Process, *bodies: Any) -> None:
    for body in bodies:
        ours.bus.publish(body, "test")
    ours.bus.run()


def asked(ours: Process, body: Any) -> list[Any]:
    """What is said once a request was told."""
    said: list[Any] = []
    ours.bus.tap(lambda envelope: said.append(envelope.body))
    tell(ours, body)
    ours.run(10.0)
    return said


def line(number: int) -> Any:
    ends = [lmcp.new("Location3D", **AT), lmcp.new("Location3D", Latitude=0.03, Longitude=0.02)]
    return lmcp.new("LineSearchTask", TaskID=number, PointList=ends, DesiredWavelengthBands=["EO"])


def test_what_has_been_told_says_what_is_read(
    planning: tuple[Process, Contexts], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Machine code takes more memory than all the rest: a point alone is planned without it."""
    ours, contexts = planning
    did: list[str] = []
    monkeypatch.setattr(
        idle_work, "plan", lambda tasks, zone="z": did.append(f"{len(tasks)}{zone}")
    )
    monkeypatch.setattr(idle_work, "_read", lambda: iter([did.append("read") is None] * 2))
    pieces = idle_work.pieces(contexts)
    assert [next(pieces) for _ in range(3)] == [True, False, False]
    assert did == ["1"]
    tell(ours, must_fly(5))
    assert [next(pieces) for _ in range(3)] == [True, False, False]  # its options
    assert "read" not in did
    tell(ours, line(6))
    assert [*itertools.takewhile(bool, pieces)] == [
        True
    ] * 6  # two tasks, ways of two vehicles, two pieces
    assert did == ["1", "read"]


def test_where_nobody_tells_a_task_everything_is_read(
    planning: tuple[Process, Contexts], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(idle_work, "plan", lambda tasks, zone="z": None)
    monkeypatch.setattr(idle_work, "_read", lambda: iter([True]))
    monkeypatch.setattr(idle_work, "WITHOUT_TASKS_S", 0.0)
    pieces = idle_work.pieces(planning[1])
    assert [next(pieces) for _ in range(3)] == [True, True, False]


@pytest.mark.parametrize("vehicles", [(1, 2), (2,)])
def test_options_made_ahead_are_those_of_the_request_if_it_is_for_the_same(
    planning: tuple[Process, Contexts],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    vehicles: tuple[int, ...],
) -> None:
    """Else they are made anew; either way the plan is the one that is made without them."""
    ours, contexts = planning
    tell(ours, line(6), must_fly(5))
    monkeypatch.setattr(idle_work, "_read", lambda: iter(()))
    pieces = idle_work.pieces(contexts)
    assert [*itertools.takewhile(bool, pieces)] == [
        True
    ] * 5  # a point, two tasks, ways of two vehicles
    made: list[int] = []
    searched: list[int] = []
    expand, routes = inputs.expand, planned.routes

    def counted(mission: Any, tasks: Any, *more: Any) -> Any:
        made.extend(task.id for task in tasks)
        return expand(mission, tasks, *more)

    def looked(starts: Any, *more: Any) -> Any:
        searched.append(len(starts))
        return routes(starts, *more)

    monkeypatch.setattr(inputs, "expand", counted)
    monkeypatch.setattr(planned, "routes", looked)
    said = asked(ours, request(6, 5, vehicles=vehicles))
    assert sorted(made) == ([] if vehicles == (1, 2) else [5, 6])
    offers = [body for body in said if type(body).__name__ == "TaskPlanOptions"]
    options = sum(len(offer.Options) for offer in offers)
    # from each vehicle to each option, and along each: no way between two options
    assert (sum(searched) == (len(vehicles) + 1) * options) == (vehicles == (1, 2))
    (response,) = (body for body in said if type(body).__name__ == "AutomationResponse")
    assert response.MissionCommandList, response.Info
    (tmp_path / "other").mkdir()
    with planner(tmp_path / "other") as other:
        tell(other, line(6), must_fly(5))
        (plain,) = (
            body for body in asked(other, request(6, 5, vehicles=vehicles))
            if type(body).__name__ == "AutomationResponse"
        )  # fmt: skip
    assert response == plain


def test_what_was_made_stays_made_when_more_is_told_or_asked_for(
    planning: tuple[Process, Contexts], monkeypatch: pytest.MonkeyPatch
) -> None:
    """One task more is one task to make, and a request that comes before ways are found has not to make options."""
    ours, contexts = planning
    monkeypatch.setattr(idle_work, "_read", lambda: iter(()))
    made: list[int] = []
    expand = inputs.expand

    def counted(mission: Any, tasks: Any, *more: Any) -> Any:
        made.extend(task.id for task in tasks)
        return expand(mission, tasks, *more)

    tell(ours, line(6), must_fly(5))
    pieces = idle_work.pieces(contexts)
    assert next(pieces)  # a point
    monkeypatch.setattr(inputs, "expand", counted)
    assert [*itertools.takewhile(bool, pieces)]
    assert made == [6, 5]
    tell(ours, must_fly(8))
    assert [next(pieces) for _ in range(3)] == [True] * 3
    assert made == [6, 5, 8]
    said = asked(ours, request(6, 5, 8, vehicles=(1, 2)))
    assert made == [6, 5, 8]
    (response,) = (body for body in said if type(body).__name__ == "AutomationResponse")
    assert response.MissionCommandList, response.Info


def test_a_world_that_means_nothing_is_left_alone(planning: tuple[Process, Contexts]) -> None:
    ours, contexts = planning
    source = contexts.source
    assert isinstance(source, MessageSource)
    assert source.foreseen() is None  # no task
    tell(ours, lmcp.new("LineSearchTask", TaskID=6))
    assert source.foreseen() is None  # a line without points
    tell(ours, line(6))
    assert source.foreseen() is not None
    tell(ours, lmcp.new("RemoveEntities", EntityList=[1, 2]))
    assert source.foreseen() is None


def test_of_ways_only_those_of_tasks_that_are_asked_for_again_are_kept(
    planning: tuple[Process, Contexts],
) -> None:
    """Else a process that is asked for ever new tasks would remember the ways of all of them."""
    ours, contexts = planning
    tell(ours, line(6), must_fly(5), line(7))
    kept: list[int] = []
    for tasks in ((6, 5), (6, 5), (7,)):
        tell(ours, request(*tasks, vehicles=(1, 2)))
        ours.run(10.0 * (len(kept) + 1))
        (*_, newest) = contexts._found.values()
        kept.append(len(newest.inputs.finder._times))  # type: ignore[union-attr]
    assert kept[0] == kept[1] > kept[2]


def test_what_is_made_before_the_first_request_has_a_bound(
    planning: tuple[Process, Contexts], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ways grow with the square of the tasks: a process that was told 200 of them would take gigabytes."""
    ours, contexts = planning
    source = contexts.source
    assert isinstance(source, MessageSource)
    monkeypatch.setattr(message_source, "FORESEEN_MOST", 3)
    monkeypatch.setattr(inputs, "WAYS_AHEAD_MOST", 150)
    monkeypatch.setattr(inputs, "WAYS_AT_ONCE", 100)
    tell(ours, *(must_fly(number) for number in range(5, 10)))
    foreseen = source.foreseen()
    assert foreseen is not None
    assert [task.id for task in foreseen.mission.tasks] == [7, 8, 9]
    pairs = len(foreseen.options) ** 2
    assert pairs > 300
    assert sum(1 for _ in foreseen.find_ways()) == 2
    assert 0 < len(foreseen.finder._times) <= 150
