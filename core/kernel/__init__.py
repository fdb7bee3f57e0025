"""Marking and registering kernels, folds and drivers.

A *kernel* is a plain typed function in the subset of `core.subset`. A *fold* runs a kernel step over data of run-time
length. A *driver* is a map, a fold or a search in which proved kernels decide; how far they check its output is
determined from its text (`proofs.statements`). All three are registered here under their qualified names,
`package.module.function`, so that the ledger can be compared with them and two of one bare name can coexist. The
decorators return the function itself: CPython runs exactly what is written.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

from cratous.core.kernel.names import candidates, near
from cratous.spec.errors import BadInput

F = TypeVar("F", bound=Callable[..., Any])
Acc = TypeVar("Acc")


class Vec2(NamedTuple):
    """A vector in the horizontal plane: north and east (or x and y), both in one unit."""

    x: float
    y: float


class Refusal:
    """Base of driver results where nothing was found: such a result claims nothing."""


@dataclass(frozen=True)
class Entry:
    """One registered function: its qualified name, its kind, what it implements, the function.

    uses: kernels that a fold consists of, or that decide in a driver, as named by its author (see `checkers`);
    nonnegative: arguments for which a number below 0 is meaningless, of a record all its numbers; supports: the
    kernel or fold of which it is a part, which has the definition (see `supported`); restates: the purpose of a
    formula that its definition only repeats.
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


def qualified(item: Callable[..., Any] | Fold[Any]) -> str:
    """The name under which a function or fold is registered: `package.module.function`."""
    if isinstance(item, Fold):
        return f"{item.module}.{item.name}"
    return f"{item.__module__}.{item.__qualname__}"


def entry_of(item: Any) -> Entry | None:
    """The entry of this very function or fold; None for anything else, even one of the same name."""
    if not (isinstance(item, Fold) or inspect.isfunction(item)):
        return None
    entry = REGISTRY.get(qualified(item))
    return entry if entry is not None and entry.function is item else None


def named(text: str) -> Entry:
    """The entry of this name, or of the only name with this ending. Raises BadInput."""
    found = [text] if text in REGISTRY else candidates(text, REGISTRY)
    if len(found) == 1:
        return REGISTRY[found[0]]
    raise BadInput(
        "there is no such kernel" if not found else "several kernels have this name",
        item=text,
        expected=" or ".join(found or near(text, REGISTRY)) or "the name of a registered kernel",
    )


def checkers(entry: Entry) -> tuple[str, ...]:
    """Qualified names of the kernels that re-check a driver.

    A bare name is resolved in the driver's module, else to the only kernel of that name in its package; otherwise it
    stays as it is. Raises BadInput for an ambiguous name.
    """
    return tuple(_resolved(name, entry) for name in entry.uses)


def supported(entry: Entry) -> str:
    """Qualified name of the kernel or fold that an entry is a step of; resolved as in `checkers`."""
    return _resolved(entry.supports, entry)


def _resolved(name: str, entry: Entry) -> str:
    if name in REGISTRY:
        return name
    module = entry.function.__module__
    here = entry_of(vars(sys.modules[module]).get(name))
    if here is not None:
        return here.name
    package = module.split(".")[0]
    found = [one for one in candidates(name, REGISTRY) if one.split(".")[0] == package]
    if len(found) > 1:
        raise BadInput(
            "several kernels have this name",
            where=entry.name,
            item=name,
            expected=" or ".join(found),
        )
    return found[0] if found else name


def _register(entry: Entry) -> None:
    old = REGISTRY.get(entry.name)
    if old is not None and not _alike(old, entry):
        raise BadInput(
            "two functions are registered under one name",
            item=entry.name,
            expected="one definition in a module, or another name",
        )
    REGISTRY[entry.name] = entry


def _alike(old: Entry, new: Entry) -> bool:
    """Whether two entries have the same text (the module was imported again)."""
    said = [(e.kind, e.implements, e.uses, e.supports, e.restates) for e in (old, new)]
    if said[0] != said[1]:
        return False
    one, other = old.function, new.function
    if isinstance(one, Fold) or isinstance(other, Fold):
        return isinstance(one, Fold) and isinstance(other, Fold) and one.start == other.start
    return bool(one.__code__ == other.__code__)


def kernel(
    *,
    implements: str = "",
    supports: str = "",
    restates: str = "",
    nonnegative: tuple[str, ...] = (),
) -> Callable[[F], F]:
    """Register a kernel under its qualified name.

    implements: its definition in `spec`, as `module.function`; or supports: the kernel or fold that it is a step of,
    which calls it and has a definition. restates: the purpose of the formula, if the definition can only repeat it.
    nonnegative: arguments (a record for all its numbers) that the theorems assume to be at least 0 and that come from
    outside, such as thresholds; the exact and the enclosed reading refuse a number below 0 there. Raises ValueError
    for a name that is not an argument, and unless exactly one of implements and supports is given.
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
        _register(
            Entry(
                qualified(function),
                "kernel",
                implements,
                function,
                (),
                nonnegative,
                supports,
                restates,
            )
        )
        return function

    return mark


def driver(*, checked_by: tuple[str, ...]) -> Callable[[F], F]:
    """Register a search or map; `checked_by` names the kernels that decide in it.

    This does not claim that its whole output goes through one of them: its text has to show that.
    """

    def mark(function: F) -> F:
        _register(Entry(qualified(function), "driver", "", function, checked_by))
        return function

    return mark


@dataclass(frozen=True)
class Fold(Generic[Acc]):
    """`finish(step(... step(step(start, item0, *context), item1, *context) ..., *context))`.

    step and finish are kernels; without a finish the result is that of the last step; start is a tuple of integers or
    booleans; module: where it is defined. The prover turns each fold into three obligations (base, step, use), so its
    theorem holds for every number of items.
    """

    name: str
    implements: str
    step: Callable[..., Acc]
    start: Acc
    finish: Callable[..., Any] | None = None
    module: str = ""

    @property
    def __name__(self) -> str:
        return self.name

    @property
    def kernels(self) -> tuple[Callable[..., Any], ...]:
        """The kernels that it consists of."""
        return (self.step,) if self.finish is None else (self.step, self.finish)

    def __call__(self, items: Iterable[tuple[Any, ...]], *context: Any) -> Any:
        acc = self.start
        for item in items:
            acc = self.step(acc, *item, *context)
        return acc if self.finish is None else self.finish(acc)


def fold(
    *,
    name: str,
    implements: str,
    step: Callable[..., Acc],
    start: Acc,
    finish: Callable[..., Any] | None = None,
) -> Fold[Acc]:
    """Make and register a fold over a proved step."""
    made = Fold(name, implements, step, start, finish, sys._getframe(1).f_globals["__name__"])
    parts = tuple(qualified(part) for part in made.kernels)
    _register(Entry(qualified(made), "fold", implements, made, parts))
    return made
