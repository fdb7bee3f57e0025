"""What a function holds by itself (closure, defaults, what it wraps) is part of what its key is made of."""

from __future__ import annotations

import builtins
import cmath
import dataclasses
import functools
import importlib
import inspect
import math
from types import FunctionType
from typing import Any

import pytest

from cratous.core import ledger as gate
from cratous.core.assignment.instance import Instance
from cratous.core.avoidance import manoeuvre, prediction
from cratous.core.avoidance.drift import Drift
from cratous.core.avoidance.manoeuvre import Ability
from cratous.core.geofence import planar
from cratous.core.geofence.shapes import Polygon
from cratous.core.kernel import Fold
from cratous.core.kernel.sources import constants, names_of, reached, stands_for_itself
from cratous.core.ledger.meant_names import replaced
from cratous.core.readings import exact
from cratous.core.readings.exact import integers

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


def _other(function) -> list[str]:
    """Names that are not what their files say, of one function, without what was kept before."""
    return replaced(reached(function).values(), {})


def _no_longer(value: float) -> float:
    return value


@pytest.mark.parametrize(
    ("module", "name", "other"),
    [
        # a module by one that has the same names, and by what is no module
        (manoeuvre, "math", cmath),
        (manoeuvre, "math", Ability),
        # builtins that a module's own name hides: by a function, by another builtin
        (manoeuvre, "abs", _no_longer),
        (manoeuvre, "max", min),
    ],
)
def test_modules_and_builtins_are_what_a_file_says(monkeypatch, module, name, other):
    assert _other(manoeuvre.fly_to) == []
    monkeypatch.setattr(module, name, other, raising=False)
    assert _other(manoeuvre.fly_to) == [f"{module.__name__}.{name}"]


def test_the_gate_refuses_a_builtin_that_was_hidden(monkeypatch):
    monkeypatch.setattr(prediction, "max", min, raising=False)
    told = [problem.what for problem in gate.check().problems]
    assert f"names mean something else than their files say: {prediction.__name__}.max" in told


def test_builtins_of_a_function_alone_are_named():
    own = {**vars(manoeuvre), "__builtins__": {**vars(builtins), "abs": _no_longer}}
    real = manoeuvre.fly_to
    other = FunctionType(real.__code__, own, real.__name__, real.__defaults__, real.__closure__)
    other.__qualname__, other.__module__ = real.__qualname__, real.__module__
    assert f"{manoeuvre.__name__}.__builtins__" in replaced([other], {})


def test_what_is_imported_is_followed_to_its_own_module(monkeypatch):
    """Both modules were given the other one: what they say of each other agrees."""
    source = importlib.import_module(prediction.violation_within.__module__)
    assert vars(source)["violation_within"] is prediction.violation_within
    user = next(
        function
        for function in vars(prediction).values()
        if inspect.isfunction(function)
        and function.__module__ == prediction.__name__
        and "violation_within" in function.__code__.co_names
    )
    assert replaced([user], {}) == []
    monkeypatch.setattr(source, "violation_within", prediction.violation)
    monkeypatch.setattr(prediction, "violation_within", prediction.violation)
    assert replaced([user], {}) == [f"{prediction.__name__}.violation_within"]


def test_what_is_asked_of_a_module_of_ours_is_what_its_file_says(monkeypatch):
    """`integers.decider`, by a function of another module."""
    user = next(
        function
        for function in vars(exact).values()
        if inspect.isfunction(function)
        and function.__module__ == exact.__name__
        and {"integers", "decider"} <= set(names_of(function.__code__))
    )
    assert replaced([user], {}) == []
    monkeypatch.setattr(integers, "decider", integers.__loader__.get_data)
    assert replaced([user], {}) == [f"{integers.__name__}.decider"]


FROM_TEXT: dict[str, Any] = {}
exec(
    "def aside_m(self, t_s): return 0.0\n"
    "def __init__(self, *values): pass\n"
    "def __new__(cls, *values): return tuple.__new__(cls, values[::-1])\n",
    FROM_TEXT,
)


@pytest.mark.parametrize(
    ("owner", "name", "other"),
    [
        # made from a text, as the library makes methods, or by the library for something else
        (Drift, "aside_m", FROM_TEXT["aside_m"]),
        (Polygon, "aside_m", FROM_TEXT["aside_m"]),
        (Polygon, "__init__", FROM_TEXT["__init__"]),
        (Polygon, "__eq__", dataclasses.make_dataclass("Other", ["value"]).__eq__),
        (Ability, "__new__", staticmethod(FROM_TEXT["__new__"])),
        (Drift, "aside_m", dataclasses.fields),
        (Polygon, "__hash__", dataclasses.fields),
        # by a function of elsewhere, by a method of another name, by what is no method
        (Drift, "aside_m", lambda self, t_s: 0.0),
        (Drift, "aside_m", manoeuvre.velocity_of),
        (Drift, "aside_m", math.hypot),
        (Drift, "aside_m", Ability),
        (Fold, "__call__", Fold.kernels.fget),
        (Fold, "__call__", print),
        # properties: by another, by a value, by one of elsewhere
        (Instance, "tasks", Instance.vehicles),
        (Instance, "tasks", 3),
        (Polygon, "edges", property(lambda self: ())),
        # a field of a record, by another field, by a property
        (Ability, Ability._fields[0], vars(Ability)[Ability._fields[1]]),
        (Ability, Ability._fields[0], property(lambda self: 0.0)),
        # what no file writes of the class
        (Polygon, "__getattribute__", lambda self, name: 0.0),
        (Ability, "__eq__", staticmethod(lambda self, other: True)),
    ],
)
def test_methods_and_fields_are_those_of_the_file(monkeypatch, owner, name, other):
    assert replaced([owner], {}) == []
    monkeypatch.setattr(owner, name, other, raising=False)
    assert replaced([owner], {}) == [f"{owner.__module__}.{owner.__qualname__}.{name}"]


def test_a_method_that_is_gone_is_named(monkeypatch):
    """Its base may have another under the same name."""
    monkeypatch.delattr(Drift, "aside_m")
    assert replaced([Drift], {}) == [f"{Drift.__module__}.Drift.aside_m"]


def test_the_gate_refuses_kernels_on_a_method_that_was_replaced(monkeypatch):
    monkeypatch.setattr(Instance, "tasks", Instance.vehicles)
    told = [problem.what for problem in gate.check().problems]
    assert any(f"{Instance.__module__}.Instance.tasks" in what for what in told)
