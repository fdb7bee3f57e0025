"""What a function holds by itself (closure, defaults, what it wraps) is part of what its key is made of."""

from __future__ import annotations

import functools

import pytest

from cratous.core import ledger as gate
from cratous.core.avoidance import prediction
from cratous.core.geofence import planar
from cratous.core.kernel.sources import constants, reached, stands_for_itself

gate.load_all()


def _shifted(by: int):
    def shifted(value: int) -> int:
        return value + by

    return shifted


def _scaled(value: int, factor: int = 2, *, shift: int = 3) -> int:
    return factor * value + shift


def _logged(function):
    @functools.wraps(function)
    def wrapper(*args):
        return function(*args)

    wrapper.__module__ = __name__
    return wrapper


def test_a_closure_counts():
    assert constants(_shifted(1)) != constants(_shifted(2))
    assert constants(_shifted(1)) == constants(_shifted(1))


def test_defaults_count(monkeypatch):
    before = constants(_scaled)
    assert any("factor by default=int 2" in text for text in before)
    monkeypatch.setattr(_scaled, "__kwdefaults__", {"shift": 4})
    assert constants(_scaled) != before
    monkeypatch.undo()
    monkeypatch.setattr(_scaled, "__defaults__", (5,))
    assert constants(_scaled) != before


def test_what_is_wrapped_is_reached():
    assert planar.orient in reached(_logged(planar.orient)).values()


def test_a_kernel_behind_a_wrapper_does_not_fly(monkeypatch):
    assert stands_for_itself(planar.orient)
    monkeypatch.setattr(planar, "orient", _logged(planar.orient))
    problems = {problem.name: problem.what for problem in gate.check().problems}
    assert "would run in its place" in problems["cratous.core.geofence.planar.orient"]
    assert sum("would run in its place" in what for what in problems.values()) == 1


def _as_it_says(function, name: str, module: str):
    function.__name__ = function.__qualname__ = name
    function.__module__ = module
    return function


@pytest.mark.parametrize(
    ("module", "name", "other"),
    [
        # a helper that is no kernel, by a function of this file, and by one that bears its name
        (prediction, "_thresholds", lambda volume: prediction.StandardThresholds(1.0, 1.0, 1.0, 1.0)),
        (prediction, "_thresholds", _as_it_says(lambda volume: None, "_thresholds", prediction.__name__)),
        # what is imported, by another kernel, and a record by another
        (prediction, "violation_within", prediction.violation),
        (prediction, "StandardThresholds", tuple),
    ],
)  # fmt: skip
def test_a_helper_that_its_module_was_given_does_not_fly(monkeypatch, module, name, other):
    assert gate.check().problems == ()
    monkeypatch.setattr(module, name, other)
    told = [problem.what for problem in gate.check().problems]
    assert any(
        f"names mean something else than their files say: {module.__name__}.{name}" in what
        or "the code that runs is not its file's" in what
        for what in told
    )
