"""Marking and registering kernels, folds and drivers.

A *kernel* is a plain typed function in the subset of `core.subset`. A *fold* runs a kernel step
over data of run-time length. A *driver* is a map, a fold or a search whose output a proved kernel
re-checks. All three are registered here by name, so that the ledger can be held against them.
The decorators return the function itself: CPython runs exactly what is written.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

F = TypeVar("F", bound=Callable[..., Any])
Acc = TypeVar("Acc")


class Vec2(NamedTuple):
    """A vector in the horizontal plane: north and east (or x and y), one unit for both."""

    x: float
    y: float


@dataclass(frozen=True)
class Entry:
    """One registered function: what it is, what it implements, and the function.

    uses: kernels that a fold is made of or that re-check a driver; nonnegative: arguments for which
    a number below 0 means nothing; supports: the kernel or fold of which it is a part, which has the
    definition; restates: what a formula is for that its definition only repeats.
    """

    name: str
    kind: str
    implements: str
    function: Callable[..., Any]
    uses: tuple[str, ...] = ()
    nonnegative: tuple[str, ...] = ()
    supports: str = ""
    restates: str = ""


REGISTRY: dict[str, Entry] = {}


def _home(function: Callable[..., Any]) -> str:
    return function.step.__module__ if isinstance(function, Fold) else function.__module__


def _register(entry: Entry) -> None:
    old = REGISTRY.get(entry.name)
    if old is not None and _home(old.function) != _home(entry.function):
        raise ValueError(
            f"two kernels are called {entry.name!r}: in {_home(old.function)} "
            f"and in {_home(entry.function)}"
        )
    REGISTRY[entry.name] = entry


def kernel(
    *,
    implements: str = "",
    supports: str = "",
    restates: str = "",
    nonnegative: tuple[str, ...] = (),
) -> Callable[[F], F]:
    """Register a kernel under its function name.

    implements: its definition in `spec`, as `module.function`; or supports: the kernel or fold that
    it is a step of, which calls it and has a definition. restates: what the formula is for, where
    the definition can only repeat it. nonnegative: arguments that the theorems take to be at least
    0 and that come from outside, as thresholds do; the exact and the enclosed reading refuse a
    number below 0 there. Raises ValueError for a name that is no argument, and unless exactly one
    of implements and supports is given.
    """

    def mark(function: F) -> F:
        name = function.__name__
        strangers = set(nonnegative) - set(inspect.signature(function).parameters)
        if strangers:
            raise ValueError(f"{name} has no argument {', '.join(sorted(strangers))}")
        if bool(implements) == bool(supports):
            raise ValueError(
                f"{name}: give its definition (implements) or what it is a step of "
                "(supports), one of the two"
            )
        if restates and not implements:
            raise ValueError(f"{name}: what restates no definition (implements) has nothing to say")
        _register(Entry(name, "kernel", implements, function, (), nonnegative, supports, restates))
        return function

    return mark


def driver(*, checked_by: tuple[str, ...]) -> Callable[[F], F]:
    """Register a search or map; `checked_by` names the kernels that re-check its output."""

    def mark(function: F) -> F:
        _register(Entry(function.__name__, "driver", "", function, checked_by))
        return function

    return mark


@dataclass(frozen=True)
class Fold(Generic[Acc]):
    """`finish(step(... step(step(start, item0, *context), item1, *context) ..., *context))`.

    step and finish are kernels; start is a tuple of integers or booleans. The prover turns each
    fold into three obligations (base, step, use), so its theorem holds for every number of items.
    """

    name: str
    implements: str
    step: Callable[..., Acc]
    start: Acc
    finish: Callable[..., Any]

    @property
    def __name__(self) -> str:
        return self.name

    def __call__(self, items: Iterable[tuple[Any, ...]], *context: Any) -> Any:
        acc = self.start
        for item in items:
            acc = self.step(acc, *item, *context)
        return self.finish(acc)


def fold(
    *, name: str, implements: str, step: Callable[..., Acc], start: Acc, finish: Callable[..., Any]
) -> Fold[Acc]:
    """Make and register a fold over a proved step."""
    made = Fold(name, implements, step, start, finish)
    _register(Entry(name, "fold", implements, made, (step.__name__, finish.__name__)))
    return made
