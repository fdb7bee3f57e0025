"""Which of the two runs a loop, CPython or machine code, and that nothing else shows it."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
import pytest

from cratous.core.geofence.mission_leg_arrays import first_bad
from cratous.core.kernel import qualified
from cratous.core.readings import tiered
from cratous.core.readings.machine.compiled import machine
from cratous.core.routing import visibility
from cratous.core.routing.bulk import direct_many, route_many
from cratous.core.routing.visibility import Roadmap, routes
from cratous.services.certify.evidence import counted
from cratous.services.planning.zones import roadmaps
from cratous.spec.mission import Zone, ZoneKind


def test_what_is_made_meanwhile_is_used_from_then_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Nobody waits for it, and nothing is compiled twice."""
    kept: list[bool] = [False]
    monkeypatch.setattr(tiered, "_done", Counter())
    monkeypatch.setattr(tiered, "_compiled", {})
    monkeypatch.setattr(tiered, "_is_kept", lambda _: kept[0])
    assert tiered.swift(direct_many, tiered.WORTH - 10_000) is direct_many
    kept[0] = True
    assert tiered.swift(direct_many, 1) is direct_many  # it is not looked for each time
    monkeypatch.setattr(tiered, "_done", Counter())
    assert tiered.swift(direct_many, 2 * tiered.SOON) is direct_many  # nor loaded for little
    assert tiered.swift(direct_many, tiered.LOADED) is machine(direct_many)
    assert tiered.swift(direct_many, 1) is machine(direct_many)
    # the compiler is loaded now: another loop is used sooner
    assert tiered.swift(route_many, tiered.SOON + 1) is machine(route_many)


def test_what_many_loops_have_done_together_is_worth_loading_the_compiler(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(tiered, "_done", Counter())
    monkeypatch.setattr(tiered, "_compiled", {})
    monkeypatch.setattr(tiered, "_is_kept", lambda _: True)
    for k in range(tiered.LOADED // tiered.SOON):
        tiered._done[f"loop {k}"] = tiered.SOON
    assert tiered.swift(direct_many, tiered.SOON) is direct_many  # its own share is small
    assert tiered.swift(direct_many, 1) is machine(direct_many)


def test_legs_within_routes_run_as_machine_code_with_the_same_routes_and_the_same_counts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A part of a loop is no entry of its own, whatever runs it."""
    square = ((400.0, -300.0), (400.0, 300.0), (700.0, 300.0), (700.0, -300.0))
    (roadmap, *_) = roadmaps((Zone(1, ZoneKind.KEEP_OUT, square, 0.0, 500.0),), 60.0)
    starts = np.array([[0.0, e, 100.0, 0.0] for e in (-900.0, -100.0, 0.0, 250.0, 900.0)])
    ends = np.array([[1200.0, e, 120.0, 0.5] for e in (-900.0, 0.0, 80.0, 900.0, 550.0)])
    found, counts, runs = [], [], Counter[str]()
    # also where other tests have done so much that it would be time
    monkeypatch.setattr(tiered, "_is_time", lambda *_: False)
    for known in ({}, {qualified(first_bad): machine(first_bad)}):
        monkeypatch.setattr(tiered, "_compiled", dict(known))
        monkeypatch.setattr(tiered, "_inner", {})
        roadmap._seen.clear()
        with counted() as calls:
            found.append(routes(starts, ends, 60.0, roadmap, 0.2))
        counts.append(calls.data())
        runs.update(tiered._inner.keys())
    assert runs == {qualified(first_bad): 1}
    assert counts[0] == counts[1]
    for one, other in zip(*(each[:3] for each in found), strict=True):
        assert one.tobytes() == other.tobytes()


def test_routes_are_searched_in_blocks_and_each_asks_what_there_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[int] = []

    def swift(loop: Any, work: int) -> Any:
        asked.append(work)
        return loop

    monkeypatch.setattr(visibility, "swift", swift)
    n = 2 * visibility.BLOCK + 1
    starts = np.zeros((n, 4))
    ends = np.array([[4000.0 + k, 100.0 * (k % 7), 0.0, 0.0] for k in range(n)])
    whole = routes(starts, ends, 50.0, Roadmap(()), 0.1, ways=True)
    assert asked == [n, tiered.SOON, tiered.SOON]
    each = [
        routes(starts[k:][:1], ends[k:][:1], 50.0, Roadmap(()), 0.1, ways=True) for k in range(n)
    ]
    for part, parts in zip(whole, zip(*each, strict=True), strict=True):
        assert (
            part[:, :2].tobytes() == np.concatenate(parts)[:, :2].tobytes()
            if part.ndim > 1
            else (part.tobytes() == np.concatenate(parts).tobytes())
        )
