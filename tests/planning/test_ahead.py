"""A first plan of many tasks has its machine code made by other processes; who needs it waits for them."""

from __future__ import annotations

import dataclasses
import functools
import os
import subprocess
import sys
import threading
from collections import Counter
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from cratous.bridge.text_protocol.keys import KEY_VARIABLE
from cratous.core.assignment.annealing import anneal
from cratous.core.assignment.anytime import greedy, improve
from cratous.core.assignment.compiled import MODERATE_TASKS
from cratous.core.assignment.layers import look_ahead, tables
from cratous.core.assignment.problem import START
from cratous.core.assignment.tables import latest_tables
from cratous.core.ledger import PRODUCT, Keys
from cratous.core.readings import tiered
from cratous.core.readings.machine.compiled import machine
from cratous.core.readings.tiered import at_once
from cratous.core.routing.bulk import direct_many, route_many
from cratous.core.routing.visibility import Roadmap, lengths_around, routes
from cratous.core.tasks.coverage_arrays import mark_seen
from cratous.services.planning import pending_compilation, stages
from cratous.services.planning import routes as planned
from cratous.services.planning.assign import solve
from cratous.services.planning.assign_warm import simple_instance
from cratous.services.planning.detours import many_detours
from cratous.services.planning.inputs import Inputs
from cratous.services.planning.pending_compilation import AROUND, ASSIGNMENT, ROUTES
from cratous.services.planning.zones import roadmaps
from cratous.services.startup import ahead, sample_missions, warm
from cratous.spec.assignment.search import ORDER, AssignmentProblem, Choice
from cratous.spec.errors import Refused
from cratous.spec.mission import Mission, Zone, ZoneKind


class Started:
    """Stands for processes that compile: what was started, and how often it was waited for."""

    pid = -1
    """No process."""

    def __init__(self, arguments: list[str], env: dict[str, str], **_: Any) -> None:
        self.name, self.waits, self.ended, self.env = arguments[-1], 0, False, env
        ALL.append(self)

    def wait(self, _limit_s: float | None = 0.0) -> int:
        self.waits += 1
        return 1

    def poll(self) -> int | None:
        return 1 if self.waits else None

    def terminate(self) -> None:
        self.ended = True


ALL: list[Started] = []


def mission(tasks: int, zone: Zone | None = None) -> Mission:
    """A vehicle south of so many points, which a zone may part from it."""
    points = [f"[{{north_m: 5000, east_m: {100 * k}, alt_m: 300}}]" for k in range(1, tasks + 1)]
    made = sample_missions.mission([f"kind: must_fly, points: {one}" for one in points], zone="")
    return dataclasses.replace(made, zones=() if zone is None else (zone,))


def in_any_order(count: int) -> AssignmentProblem:
    """So many tasks for one vehicle."""
    tasks = range(1, count + 1)
    choices = tuple(Choice(t, 1, 1, (1,)) for t in tasks)
    rows = tuple(tuple(None if a == b else 1 for b in range(count)) for a in range(count + 1))
    text = f"|({' '.join(f'p{t}' for t in tasks)})"
    return AssignmentProblem("", (1,), (0,), choices, (rows,), text)


def wall(east_m: float) -> Zone:
    """A zone across the way north, or beside it."""
    corners = ((2000.0, east_m), (2000.0, east_m + 9000), (2200.0, east_m + 9000), (2200.0, east_m))
    return Zone(1, ZoneKind.KEEP_OUT, corners, 0.0, 500.0)


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[Started]:
    ALL.clear()
    monkeypatch.setattr(subprocess, "Popen", Started)
    monkeypatch.setattr(ahead.atexit, "register", lambda *_: None)
    monkeypatch.setattr(ahead, "_cores", lambda: 2)
    monkeypatch.setattr(ahead, "is_kept", functools.cache(lambda _: False))
    monkeypatch.setattr(ahead, "private_cache", lambda: tmp_path)
    (tmp_path / "tables").mkdir()
    monkeypatch.setattr(pending_compilation, "_coming", {})
    monkeypatch.setattr(tiered, "_coming", {})
    return ALL


def test_little_work_and_what_is_kept_start_nothing(
    begun: list[Started], monkeypatch: pytest.MonkeyPatch
) -> None:
    ahead.begin([mission(ahead.MANY_TASKS - 1)])
    monkeypatch.setattr(ahead, "is_kept", lambda _: True)
    ahead.begin([mission(50)])
    ahead.begin_all()
    assert begun == []


def test_what_may_not_be_needed_stands_back(
    begun: list[Started], monkeypatch: pytest.MonkeyPatch
) -> None:
    back: list[tuple[str, int]] = []
    monkeypatch.setattr(ahead, "_stand_back", lambda process, by: back.append((process.name, by)))
    ahead.begin([mission(ahead.MANY_ROUTES)])
    assert back == [(ROUTES, ahead.BEHIND)]
    ahead.begin([mission(MODERATE_TASKS + 1)])
    assert len(back) == 1
    ahead.begin([mission(MODERATE_TASKS)])
    assert back[1:] == [(ASSIGNMENT, ahead.BEHIND)]


def test_on_one_core_who_answers_waits_before_and_who_plans_compiles(
    begun: list[Started], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    beside: list[list[str]] = []
    monkeypatch.setattr(ahead, "_cores", lambda: 1)
    monkeypatch.setattr(ahead, "beside", lambda module, _: beside.append(module))
    monkeypatch.setattr(warm, "_mark", lambda: tmp_path / "none")
    ahead.begin([mission(50)])
    assert begun == []
    warm.ensure_planning(lambda _: None)
    assert [process.waits for process in begun] == [1, 1]
    assert [module[1] for module in beside] == ["warm"]


def test_who_needs_machine_code_waits_for_it_once(begun: list[Started]) -> None:
    ahead.begin([mission(ahead.MANY_ROUTES)])
    assert [process.name for process in begun] == [ASSIGNMENT, ROUTES]
    assert solve(in_any_order(MODERATE_TASKS)).cost is not None
    assert [process.waits for process in begun] == [0, 0]
    for _ in range(2):
        assert solve(in_any_order(MODERATE_TASKS + 1)).cost is not None
    # that a process failed is no reason to wait again, nor not to plan
    assert [process.waits for process in begun] == [1, 0]


def test_what_is_compiled_for_routes_goes_by_whether_many_lead_around_zones(
    begun: list[Started], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ahead, "MANY_ROUTES", ahead.MANY_TASKS)
    few = ahead.MANY_ROUTES - 1
    ahead.begin([mission(few, wall(-2000.0)), mission(ahead.MANY_ROUTES, wall(3000.0))])
    assert [process.name for process in begun] == [ahead.LEGS, ASSIGNMENT, ROUTES]
    begun.clear()
    ahead.begin([mission(few), mission(ahead.MANY_ROUTES, wall(-2000.0))])
    assert [process.name for process in begun] == [ahead.LEGS, ASSIGNMENT, AROUND]


def test_legs_have_machine_code_of_their_own_where_there_are_zones_and_some_tasks(
    begun: list[Started],
) -> None:
    ahead.begin([mission(ahead.SOME_TASKS), mission(ahead.SOME_TASKS - 1, wall(3000.0))])
    assert begun == []
    ahead.begin([mission(ahead.SOME_TASKS, wall(3000.0))])
    assert [process.name for process in begun] == [ahead.LEGS]


def test_in_an_empty_cache_another_process_reads_files_for_the_gate(
    begun: list[Started], tmp_path: Path
) -> None:
    (tmp_path / "tables").rmdir()
    ahead.begin([mission(1)])
    assert [process.name for process in begun] == [ahead.TABLES]


def test_what_is_read_for_the_gate_is_what_the_gate_reads(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """All of it, the last first: each file is read by one of the two."""
    tree, read = Keys(PRODUCT).tree, list[str]()
    monkeypatch.setattr(tree, "table", read.append)
    monkeypatch.setattr(ahead, "Keys", lambda _: SimpleNamespace(tree=tree))
    ahead.make_tables()
    assert read == [*reversed(tree.every_module)]
    assert {"cratous.core.ledger.tables", "cratous.spec.mission"} <= {*read}


def test_ways_across_a_zones_box_are_many_or_not() -> None:
    starts, ends = np.zeros((20, 2)), np.full((20, 2), (4000.0, 0.0))
    assert not many_detours(starts, ends, ())
    assert not many_detours(starts[:0], ends[:0], (wall(-2000.0),))
    assert not many_detours(starts, ends, (wall(1.0),))
    assert many_detours(starts, ends, (wall(1.0), wall(-2000.0)))
    assert many_detours(starts, starts + 0.0, (wall(-2000.0),)) is False  # none goes anywhere
    ends[1:] = (1000.0, 0.0)  # one of twenty gets there
    assert not many_detours(starts, ends, (wall(-2000.0),))
    inside = dataclasses.replace(wall(-2000.0), kind=ZoneKind.KEEP_IN)
    assert not many_detours(starts, np.full((20, 2), (4000.0, 0.0)), (inside,))


def test_many_that_lead_around_get_the_ways_that_direct_ones_and_the_rest_get() -> None:
    square = ((400.0, -300.0), (400.0, 300.0), (700.0, 300.0), (700.0, -300.0))
    zone = Zone(1, ZoneKind.KEEP_OUT, square, 0.0, 500.0)
    starts = np.array(
        [[0.0, e, 100.0 + 50 * (e > 0), 0.0] for e in (-900.0, -100.0, 0.0, 250.0, 900.0)]
    )
    ends = np.array([[1200.0, e, 120.0, 0.5] for e in (-900.0, 0.0, 80.0, 900.0, 550.0)])
    (roadmap, *_) = roadmaps((zone,), 60.0)
    apart = routes(starts, ends, 60.0, roadmap, 0.2)
    whole = lengths_around(starts, ends, 60.0, roadmap, 0.2)
    assert set(apart.links.tolist()) > {1}  # direct ones are among them, and others
    for one, other in zip(apart[:3], whole[:3], strict=True):
        assert one.tobytes() == other.tobytes()


@pytest.mark.parametrize(("east_m", "name"), [(320.0, AROUND), (3000.0, ROUTES)])
def test_who_searches_many_ways_waits_for_the_search_that_they_need(
    monkeypatch: pytest.MonkeyPatch, east_m: float, name: str
) -> None:
    """Many that lead around zones are all searched by what finds those; else direct ways are found first."""
    waited: list[str] = []
    searched: list[str] = []
    for search in (routes, lengths_around):

        def looked(*given: Any, _search: Any = search) -> Any:
            searched.append(_search.__name__)
            return _search(*given)

        monkeypatch.setattr(planned, search.__name__, looked)
    monkeypatch.setattr(pending_compilation, "ready", waited.append)
    corners = ((4900.0, east_m), (4900.0, east_m + 60), (5100.0, east_m + 60), (5100.0, east_m))
    made = mission(6, Zone(1, ZoneKind.KEEP_OUT, corners, 0.0, 500.0))
    ours = Inputs(made, stages.start_poses(made))
    count = len(ours.options)
    pairs = [(before, to) for before in (START, *range(count)) for to in range(count)]
    monkeypatch.setitem(pending_compilation.WORTH_WAITING, name, len(pairs))
    Inputs(made, stages.start_poses(made)).routes.prepare(0, pairs)
    assert waited == []  # CPython has them sooner
    monkeypatch.setitem(pending_compilation.WORTH_WAITING, name, pending_compilation.MANY_WAYS)
    searched.clear()
    ours.routes.prepare(0, pairs)
    assert waited == [name]
    assert set(searched) == {{AROUND: "lengths_around", ROUTES: "routes"}[name]}


def test_a_process_that_nobody_waited_for_is_ended(begun: list[Started]) -> None:
    ahead.begin([mission(ahead.MANY_TASKS)])
    for process in begun:
        ahead._end(process)  # type: ignore[arg-type]
    assert all(process.ended for process in begun)


def test_a_process_that_is_late_is_waited_for_no_longer_and_ended(
    begun: list[Started], monkeypatch: pytest.MonkeyPatch
) -> None:
    def late(_: Started, limit_s: float | None = None) -> int:
        assert limit_s == ahead.WAIT_S
        raise subprocess.TimeoutExpired("ahead", limit_s)

    monkeypatch.setattr(Started, "wait", late)
    ahead.begin_all()
    for name in ahead.MAKERS:
        pending_compilation.ready(name)  # says nothing: who needs it compiles it
    for process in begun:
        ahead._end(process)  # type: ignore[arg-type]
    assert [process.ended for process in begun] == [True, True]


def test_what_has_ended_already_is_not_set_back_and_not_ended(
    begun: list[Started], monkeypatch: pytest.MonkeyPatch
) -> None:
    def gone(*_: int) -> None:
        raise ProcessLookupError

    monkeypatch.setattr(ahead.os, "setpriority", gone)
    ahead.beside(["module"], 5)
    (process,) = begun
    process.wait()
    ahead._end(process)  # type: ignore[arg-type]
    assert not process.ended


def test_who_has_begun_plans_nothing_that_the_gate_refuses(
    begun: list[Started], root: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any
) -> None:
    """Compiling begins before the gate has spoken; what is compiled is not used before."""
    from cratous.core import ledger
    from cratous.services.cli import main

    def refused(**_: Any) -> None:
        names = [process.name for process in begun]
        assert names == [ahead.LEGS, ahead.SQUARES, ASSIGNMENT]
        raise Refused("the code is not what was proved")

    monkeypatch.setattr(ahead, "MANY_TASKS", 1)
    monkeypatch.setattr(ledger, "require", refused)
    code = main(["plan", str(root / "examples" / "search" / "mission.yaml"), "--json"])
    said = capsys.readouterr()
    assert code == Refused("").exit_code
    assert "the code is not what was proved" in said.out + said.err
    assert all(process.waits == 0 for process in begun)


@pytest.mark.slow
def test_such_a_process_leaves_machine_code_and_says_nothing(tmp_path: Path) -> None:
    """As `begin` starts it, but waited for: the cache has then what `is_kept` looks for."""
    ask = (
        "from cratous.core.readings.machine.compiled import is_kept; "
        "from cratous.core.routing.bulk import direct_many; print(is_kept(direct_many))"
    )
    own = {**os.environ, "CRATOUS_CACHE": str(tmp_path / "cache")}
    lines = [["-c", ask], ["-P", "-m", ahead.__name__, ROUTES], ["-c", ask]]
    runs = [
        subprocess.run([sys.executable, *line], env=own, capture_output=True, check=True)
        for line in lines
    ]
    assert [run.stdout.strip() for run in runs] == [b"False", b"", b"True"]
    assert runs[1].stderr == b""


def test_what_compiles_beside_has_no_key_of_the_bridge(
    begun: list[Started], monkeypatch: pytest.MonkeyPatch
) -> None:
    """UxAS has those of all vehicles."""
    monkeypatch.setenv(KEY_VARIABLE.format(1), "5b" * 32)
    ahead.begin([mission(ahead.MANY_TASKS)])
    assert begun
    for process in begun:
        assert process.env["PATH"] == os.environ["PATH"]
        assert "5b" * 32 not in process.env.values()


def test_what_is_compiled_beside_needs_no_other_program_and_no_file_of_the_present_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "calendar.py").write_text("open('ran', 'w')")
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "waits.py").write_text(
        "import calendar, os, time\n"
        "until = time.monotonic() + 300\n"
        "while os.nice(0) < 19 and time.monotonic() < until:\n    time.sleep(0.01)\n"
        "open('nice', 'w').write(str(os.nice(0)))\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "own"))
    before = set(threading.enumerate())
    ahead.beside(["waits"], 600)  # one set back so far gets hardly any of a loaded machine
    for one in set(threading.enumerate()) - before:
        one.join(600)  # it is waited for, and leaves nothing behind
    assert not Path("ran").exists()
    assert Path("nice").read_text() == "19"


def test_what_is_made_ahead_is_what_a_plan_calls() -> None:
    """Machine code is made by types: a plan that came with others would compile again."""
    ahead.make_routes()
    ahead.make_around()
    ahead.make_assignment()
    loops = (direct_many, route_many, anneal, latest_tables)
    kinds = [list(machine(loop).run.signatures) for loop in loops]  # type: ignore[attr-defined]
    square = ((900.0, 900.0), (900.0, 990.0), (990.0, 990.0), (990.0, 900.0))
    zone = Zone(1, ZoneKind.KEEP_OUT, square, 0.0, 500.0)
    poses = np.array([[0.0, 0.0, 100.0, 0.0], [0.0, 500.0, 100.0, 1.0]])
    with at_once():
        for search in (routes, lengths_around):
            search(poses, poses[::-1], 50.0, Roadmap((zone,)), 0.1)
        instance = simple_instance(ORDER)
        improve(instance, greedy(instance)[1] or [], 1, 1)
        tables(instance, look_ahead(instance), 20)
    assert [list(machine(loop).run.signatures) for loop in loops] == kinds  # type: ignore[attr-defined]
    assert all(len(kind) == 1 for kind in kinds)


def test_an_area_has_its_squares_compiled_ahead_and_who_needs_them_waits_once(
    begun: list[Started], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tiered, "_coming", {})
    monkeypatch.setattr(tiered, "_done", Counter())
    monkeypatch.setattr(tiered, "_compiled", {})
    area = sample_missions.mission(
        [task for task in sample_missions.TASKS if "area_search" in task], zone=""
    )
    ahead.begin([area])
    assert [process.name for process in begun] == [ahead.SQUARES]
    (process,) = begun
    monkeypatch.setattr(tiered, "_is_kept", lambda _: False)
    assert tiered.swift(mark_seen, tiered.WORTH) is mark_seen
    assert process.waits == 0
    assert tiered.swift(mark_seen, 1) is machine(mark_seen)
    assert tiered.swift(mark_seen, 1) is machine(mark_seen)
    assert process.waits == 1
