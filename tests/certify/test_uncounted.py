"""The copy of a loop that runs while calls are counted: the same code, and none of its calls is counted."""

from __future__ import annotations

import inspect
import threading

import pytest

from cratous.core.geofence.planar import orient
from cratous.core.kernel import REGISTRY, Entry, Vec2, qualified
from cratous.core.readings import tiered
from cratous.services.certify.evidence import PYTHON, counted
from cratous.services.certify.uncounted import uncounted

LIMIT = 2
CORNERS = Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)
BEGUN, OTHER_DONE = threading.Event(), threading.Event()


def rising(n: int, *, by: int = 1) -> int:
    return (
        n if n >= LIMIT else rising(n + by, by=by) + orient(Vec2(0, 0), Vec2(1, 0), Vec2(0, n)) * 0
    )


def changing(n: int) -> int:
    global LIMIT
    LIMIT = n
    return n


def test_a_copy_calls_copies_and_reads_the_same_names(monkeypatch: pytest.MonkeyPatch) -> None:
    name = qualified(rising)
    monkeypatch.setitem(REGISTRY, name, Entry(name, "driver", "", rising))
    with counted() as calls:
        assert uncounted(rising)(0) == 2
        assert uncounted(rising)(0, by=3) == 3
        assert rising(1) == 2
        assert inspect.unwrap(rising).__code__ is uncounted(rising).__code__
    assert calls.data()["called"] == {name: {PYTHON: 2}, qualified(orient): {PYTHON: 1}}


def test_what_assigns_to_its_module_is_not_copied() -> None:
    assert uncounted(changing) is changing


def waiting() -> bool:
    orient(*CORNERS)
    BEGUN.set()
    return OTHER_DONE.wait(120)


def test_calls_of_other_threads_are_counted_while_a_loop_runs() -> None:
    def work() -> None:
        BEGUN.wait(120)
        for _ in range(100):
            orient(*CORNERS)
        OTHER_DONE.set()

    with counted() as calls:
        thread = threading.Thread(target=work)
        thread.start()
        assert tiered.swift(waiting)()
        thread.join()
    assert calls.data()["called"] == {qualified(orient): {PYTHON: 100}}
