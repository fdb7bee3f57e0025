"""Counting the entries into kernels: as often as the interpreter enters them, and nothing else changes."""

from __future__ import annotations

import inspect
import json
import subprocess
import sys
import threading
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import profiled_crossing
import pytest
from profiled_crossing import flown

from cratous.core.authority.gate import gate_accepts
from cratous.core.authority.timeliness import beats_in_time, in_time
from cratous.core.geofence.mission_leg_arrays import first_bad, table
from cratous.core.geofence.planar import locate, orient
from cratous.core.kernel import REGISTRY, Entry, Fold, Vec2, qualified
from cratous.core.kernel.sources import altered
from cratous.core.readings import tiered
from cratous.core.readings.enclosed import enclosed
from cratous.core.readings.exact import exact, exactly
from cratous.core.readings.machine.compiled import compiled, is_kept, machine
from cratous.core.tasks.footprints import points_in_quads
from cratous.core.well_clear.now import vertical_violation
from cratous.services.certify.evidence import LOOP, PYTHON, counted, is_data
from cratous.services.cli import main
from cratous.spec.errors import BadInput

CROSSING = Path(__file__).parents[2] / "examples" / "crossing" / "mission.yaml"
SQUARE = (
    (Vec2(0, 0), Vec2(2, 0)), (Vec2(2, 0), Vec2(2, 2)), (Vec2(2, 2), Vec2(0, 2)),
    (Vec2(0, 2), Vec2(0, 0)),
)  # fmt: skip


@pytest.fixture(scope="module")
def crossing(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], Counter[str], str]:
    """The counts of a flight, those that the interpreter's profiler gives, and its digest."""
    run = subprocess.run(
        [sys.executable, profiled_crossing.__file__, str(tmp_path_factory.mktemp("flown"))],
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    data, seen, digest = json.loads(run.stdout)
    return data, Counter(seen), digest


def test_every_entry_is_counted(crossing: tuple[dict[str, Any], Counter[str], str]) -> None:
    data, seen, _ = crossing
    found = {name: sum(ways.values()) for name, ways in data["called"].items()}
    assert found == seen
    assert sum(found.values()) > 10_000


def test_a_flight_is_the_same_with_and_without(
    crossing: tuple[dict[str, Any], Counter[str], str], tmp_path: Path
) -> None:
    assert flown(tmp_path) == crossing[2]


def test_a_second_flight_in_the_process_has_the_same_counts(
    crossing: tuple[dict[str, Any], Counter[str], str], tmp_path: Path
) -> None:
    with counted() as calls:
        flown(tmp_path)
    assert calls.data() == crossing[0]


def test_contracts_gates_and_the_monitor_are_called_and_what_is_not_is_not_listed(
    crossing: tuple[dict[str, Any], Counter[str], str],
) -> None:
    data = crossing[0]
    listed = {*data["called"], *data["within"]}
    packages = {name.split(".")[2] for name in listed}
    assert {"contracts", "schedule", "authority", "well_clear", "assignment"} <= packages
    assert qualified(gate_accepts) in data["called"]
    assert "terminal_area" not in " ".join(listed)
    assert any(name.startswith("cratous.core.daa.steps.") for name in listed)
    assert len(data["called"]) < len(REGISTRY) / 2
    loops = {
        name for name, ways in {**data["called"], **data["loops"]}.items() if set(ways) != {PYTHON}
    }
    assert {name for names in data["within"].values() for name in names} <= loops
    assert is_data(data)


def test_what_stands_in_machine_code_is_listed_with_it() -> None:
    line = np.array([[1.0, 1.0], [5.0, 5.0]])
    quads = np.array([[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]])
    seen = np.zeros(2, np.bool_)
    with counted() as calls:
        machine(points_in_quads)(line, quads, seen)
    assert seen.tolist() == [True, False]
    data, name = calls.data(), qualified(points_in_quads)
    assert data["called"] == {name: {"machine code": 1}}
    parts = {"crosses_ray", "location_result", "location_step", "on_segment", "orient"}
    assert data["within"] == {f"cratous.core.geofence.planar.{part}": [name] for part in parts}


def test_a_loop_counts_once_whatever_runs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else what is kept in the cache would stand in the report."""
    line = np.array([[1.0, 1.0], [5.0, 5.0]])
    quads = np.array([[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]])
    corners = [Vec2(*corner) for corner in quads[0].tolist()]
    found = []
    for run in (points_in_quads, machine(points_in_quads)):
        monkeypatch.setattr(tiered, "_compiled", {qualified(points_in_quads): run})
        seen = np.zeros(2, np.bool_)
        with counted() as calls:
            orient(*corners[:3])
            tiered.swift(points_in_quads)(line, quads, seen)
            orient(*corners[:3])
            tiered.swift(points_in_quads)(line, quads, seen)
        assert seen.tolist() == [True, False]
        found.append(calls.data())
    assert found[0] == found[1]
    assert found[0]["called"] == {
        qualified(orient): {PYTHON: 2},
        qualified(points_in_quads): {LOOP: 2},
    }
    assert qualified(locate) not in found[0]["within"]
    assert found[0]["within"][qualified(orient)] == [qualified(points_in_quads)]


def test_a_loop_that_is_no_kernel_is_listed_with_what_stands_in_it() -> None:
    from cratous.core.tasks.footprints import in_quad

    with counted() as calls:
        machine(in_quad)(1.0, 1.0, np.array([[0.0, 0.0], [0.0, 2.0], [2.0, 2.0], [2.0, 0.0]]))
    data = calls.data()
    assert data["called"] == {}
    assert data["loops"] == {qualified(in_quad): {"machine code": 1}}
    assert qualified(orient) in data["within"]


def test_every_reading_is_counted_by_its_way() -> None:
    columns = (1.0, 0.0, 2.0, 3.0)
    with counted() as calls:
        vertical_violation(*columns)
        compiled(vertical_violation)(*columns)
        exactly(vertical_violation)(*columns)
        exact(vertical_violation, *columns)
        enclosed(vertical_violation)(*columns)
        locate(SQUARE, Vec2(1, 1))
        exact(locate, SQUARE, Vec2(1, 1))
    called = calls.data()["called"]
    assert called[qualified(vertical_violation)] == {
        "CPython": 1, "machine code": 1, "exact": 2, "enclosed": 1,
    }  # fmt: skip
    assert called[qualified(locate)] == {"CPython": 1, "exact": 1}
    assert qualified(in_time) not in called


def test_afterwards_all_is_as_it_was_also_when_something_is_raised() -> None:
    before = {name: vars(e.function).copy() for name, e in REGISTRY.items()}
    codes = {
        name: e.function.__code__
        for name, e in REGISTRY.items()
        if not isinstance(e.function, Fold)
    }
    with pytest.raises(TypeError), counted() as calls:
        in_time("0", 1, 2)  # type: ignore[arg-type]
    assert {name: vars(e.function) for name, e in REGISTRY.items()} == before
    assert all(REGISTRY[name].function.__code__ is code for name, code in codes.items())
    with counted() as anew:
        pass
    assert anew.data()["called"] == {}
    assert calls.data()["called"] == {qualified(in_time): {"CPython": 1}}  # it was entered


def test_threads_lose_no_count() -> None:
    def work() -> None:
        for k in range(5_000):
            in_time(0, k, 10)
            beats_in_time([], 5)

    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with counted() as calls:
            threads = [threading.Thread(target=work) for _ in range(4)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
    finally:
        sys.setswitchinterval(before)
    called = calls.data()["called"]
    assert called[qualified(in_time)] == called[qualified(beats_in_time)] == {"CPython": 20_000}


def test_one_count_at_a_time() -> None:
    with counted():
        with pytest.raises(BadInput, match="already"), counted():
            pass
        in_time(0, 1, 2)
    with counted() as calls:
        in_time(0, 1, 2)
    assert calls.data()["called"] == {qualified(in_time): {"CPython": 1}}


def test_the_gate_vouches_for_nothing_that_is_counted() -> None:
    with counted():
        assert altered(in_time) == [qualified(in_time)]
    assert altered(in_time) == []


def test_signature_source_and_machine_code_are_those_of_the_function() -> None:
    signature, source = inspect.signature(orient), inspect.getsource(orient)
    with counted():
        assert inspect.signature(orient) == signature
        assert inspect.getsource(orient) == source
        made = machine.__wrapped__(orient)
    assert made.run.__module__ == machine.__wrapped__(orient).run.__module__


def plain(a: int, /, b: int = 2, *rest: int, c: int, d: int = 4, **more: int) -> tuple[Any, ...]:
    return a, b, rest, c, d, more


def only(a: int, b: int = 1, /) -> tuple[int, int]:
    return a, b


def named(*, count__: int = 1, original__: int) -> tuple[int, int]:
    return count__, original__


def falls(n: int) -> int:
    return n and 1 + falls(n - 1)


def registered(monkeypatch: pytest.MonkeyPatch, function: Any) -> str:
    name = qualified(function)
    monkeypatch.setitem(REGISTRY, name, Entry(name, "driver", "", function))
    return name


@pytest.mark.parametrize(
    ("function", "given", "names"),
    [
        (plain, (1,), {"c": 3}),
        (plain, (1, 5, 6, 7), {"c": 3, "d": 8, "e": 9, "a": 10}),
        (only, (1,), {}),
        (only, (1, 2), {}),
        (named, (), {"original__": 2}),
        (named, (), {"original__": 2, "count__": 3}),
    ],
)
def test_arguments_of_every_kind_arrive(
    monkeypatch: pytest.MonkeyPatch, function: Any, given: tuple[int, ...], names: dict[str, int]
) -> None:
    name, wanted = registered(monkeypatch, function), function(*given, **names)
    with counted() as calls:
        assert function(*given, **names) == wanted
    assert calls.data()["called"] == {name: {"CPython": 1}}


def test_what_calls_itself_is_counted_each_time(monkeypatch: pytest.MonkeyPatch) -> None:
    name = registered(monkeypatch, falls)
    with counted() as calls:
        assert falls(5) == 5
    assert calls.data()["called"] == {name: {"CPython": 6}}


def test_what_is_registered_too_late_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    with counted() as calls:
        name = registered(monkeypatch, falls)
        falls(2)
    assert calls.data()["uncounted"] == [name]
    assert calls.data()["called"] == {}


def test_what_cannot_be_counted_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    outer = 3

    def inner() -> int:
        return outer

    registered(monkeypatch, inner)
    with pytest.raises(BadInput, match="within another"), counted():
        pass
    assert altered(in_time) == []  # the others are as they were


@pytest.mark.parametrize(
    "value",
    [
        None, [], {}, {"called": []}, {"uncounted": {}},
        {"called": {"a": 1}}, {"called": {"a": {"CPython": 0}}}, {"loops": {"a": {"CPython": True}}},
        {"within": {"a": "b"}}, {"within": {"a": [1]}}, {"uncounted": [1]}, {"more": {}},
    ],
)  # fmt: skip
def test_what_is_no_count(value: Any) -> None:
    empty: dict[str, Any] = {"called": {}, "loops": {}, "within": {}, "uncounted": []}
    assert is_data(empty)
    assert not is_data({**empty, **value} if isinstance(value, dict) and value else value)


def evidence_of(capsys: pytest.CaptureFixture[str], *command: object) -> dict[str, Any]:
    capsys.readouterr()
    assert main([*map(str, command), "--json", "--allow-unproved"]) in (0, 3)
    data: dict[str, Any] = json.loads(capsys.readouterr().out)
    named = {name for row in data["constraints"] for name in row["kernels"]}
    kernels: dict[str, Any] = data["evidence"]["kernels"]
    assert named
    assert named <= {name for name, one in kernels.items() if one["count"]}
    return kernels


def test_plan_and_monitor_tell_what_they_called(
    capsys: pytest.CaptureFixture[str], fly_once: Callable[[Path], Path]
) -> None:
    zones = Path(__file__).parents[2] / "examples" / "relations" / "mission.yaml"
    planned = evidence_of(capsys, "plan", zones)
    assert "cratous.core.geofence.mission_legs.leg_ok" in planned
    watched = evidence_of(capsys, "monitor", fly_once(CROSSING))
    assert "cratous.core.well_clear.during.violation_within" in watched
    assert not any(".contracts." in name or ".assignment." in name for name in watched)


def test_a_plan_has_the_same_evidence_without_and_with_kept_machine_code(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also in the second run of a process, when its caches are full."""
    relations = Path(__file__).parents[2] / "examples" / "relations" / "mission.yaml"
    machine(first_bad)(np.zeros((1, 3)), table(()))
    found, made = [], []
    for kept in (False, True, True):
        monkeypatch.setattr(tiered, "_compiled", {})
        monkeypatch.setattr(tiered, "_inner", {})
        monkeypatch.setattr(tiered, "_is_time", lambda loop, *_, kept=kept: kept and is_kept(loop))
        found.append(evidence_of(capsys, "plan", relations))
        made.append({*tiered._compiled})
    assert found[0] == found[1] == found[2]
    assert not made[0]
    assert qualified(first_bad) in made[1]
