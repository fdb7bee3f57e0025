"""Side conditions of opaque functions, which a theorem uses without looking into them.

Nothing is known of the result of such a function but what lemmas say. It is still called, so its side conditions are
owed: no division by 0, no square root of a negative number, integers within 64 bits. A function whose side conditions
hold for all arguments is proved so once. Those of any other are owed at every call, with all that it calls looked
into, unless a lemma about it is used for the same arguments: the lemma's own proof covers them under its premises,
which are owed there.
"""

from __future__ import annotations

import functools
import inspect
import types
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, get_type_hints

import z3

from cratous.core.kernel.sources import ours
from cratous.proofs.engine.lift import CLOSED, OPAQUE, REPLACED, VISITS, LiftError, join, lift
from cratous.proofs.engine.solver_order import check
from cratous.proofs.engine.symbolic import PATHS, RANGE, SymReal, as_real
from cratous.proofs.engine.terms import Stub, fresh, known

EVERYWHERE_RLIMIT = 1_000_000
TRUE = z3.BoolVal(True)
Function = Callable[..., Any]
Owed = tuple[str, z3.BoolRef]


@dataclass(frozen=True)
class Call:
    """A call of an opaque function: its arguments, the condition of its path, and what is known there.

    key: a text that equal arguments share; machine: its integers are 64-bit, as in compiled code.
    """

    function: Function
    args: tuple[Any, ...]
    key: str
    path: z3.BoolRef
    machine: bool
    given: tuple[z3.BoolRef, ...]

    @property
    def name(self) -> str:
        """The function's name, for messages."""
        return self.function.__name__


@dataclass(frozen=True)
class Requirements:
    """A function's side conditions at some arguments; roots: defining facts of its square roots."""

    owed: tuple[Owed, ...]
    roots: tuple[z3.BoolRef, ...]


def path_to(where: z3.BoolRef) -> z3.BoolRef:
    """The condition of the path being explored, together with `where`."""
    return z3.simplify(z3.And(where, *[c for path in PATHS for c in path.conditions]))


def only_where(where: z3.BoolRef, value: Any, function: Function, name: str) -> Any:
    """A function's value where a condition holds, and any value of its type elsewhere, where it may not be defined.

    name: of the other value; empty for none.
    """
    if where is TRUE or not name:
        return value
    other = fresh(name, get_type_hints(function)["return"])
    return join([(where, value), (z3.Not(where), other)])


@contextmanager
def _looked_into(closed: dict[Function, Stub]) -> Iterator[None]:
    """Within this, every function but those in `closed` is looked into, and no call is reported."""
    before = dict(OPAQUE), list(PATHS), list(VISITS), list(CLOSED)
    OPAQUE.clear()
    OPAQUE.update(closed)
    for some in (PATHS, VISITS, CLOSED):
        some.clear()
    try:
        yield
    finally:
        OPAQUE.clear()
        OPAQUE.update(before[0])
        PATHS[:], VISITS[:], CLOSED[:] = before[1:]


def requirements(
    function: Function,
    args: Iterable[Any],
    *,
    machine: bool,
    closed: dict[Function, Stub] | None = None,
) -> Requirements:
    """The side conditions of a function at these arguments; all that it calls is looked into, except `closed`."""
    kinds = get_type_hints(function)
    names = list(inspect.signature(function).parameters)
    given = [_symbolic(value, kinds[n]) for n, value in zip(names, args, strict=True)]
    with _looked_into(closed or {}):
        lifted = lift(function, *given)
    owed = [o for o in lifted.obligations if machine or not o[0].endswith(RANGE)]
    return Requirements(tuple(owed), lifted.roots if owed else ())


def _symbolic(value: Any, kind: Any) -> Any:
    """A symbolic value for a function to run on; with plain numbers Python itself would compute."""
    if isinstance(value, tuple):
        kinds = get_type_hints(kind)
        parts = [_symbolic(v, kinds[f]) for f, v in zip(kind._fields, value, strict=True)]
        return kind(*parts)
    return SymReal(as_real(known(value))) if kind is float else value


def everywhere(function: Function, *, machine: bool) -> Requirements | None:
    """The side conditions of a function at arbitrary arguments, if the solver finds that they hold there; else None.

    This does not replace their proof: the prover decides them like every other obligation.
    """
    return _everywhere(function, machine, tuple(REPLACED.items()))


@functools.cache
def _everywhere(
    function: Function, machine: bool, replaced: tuple[tuple[Any, Any], ...]
) -> Requirements | None:
    total = {g: found for g in _called(function) if (found := _everywhere(g, machine, replaced))}
    stubs = {g: Stub(f"any!{g.__name__}", g) for g in total}
    kinds = get_type_hints(function)
    args = [fresh(f"any!{name}", kinds[name]) for name in inspect.signature(function).parameters]
    # first with arbitrary results of the functions that it calls, if that is enough
    for closed in (stubs, {}) if stubs else ({},):
        try:
            own = requirements(function, args, machine=machine, closed=closed)
        except (LiftError, TypeError):
            continue  # a mask, for example: checked at each use instead
        goal = z3.And(*[condition for _, condition in own.owed])
        for roots in ((), own.roots):
            if not own.owed or _holds(roots, goal):
                parts = [own] if not closed else [own, *total.values()]
                owed = tuple(o for part in parts for o in part.owed)
                return Requirements(owed, (*roots, *_roots(parts[1:])))
    return None


def _roots(parts: Iterable[Requirements]) -> Iterator[z3.BoolRef]:
    for part in parts:
        yield from part.roots


def _called(function: Function) -> list[Function]:
    """The functions of the product that it calls by name, except itself."""
    if not isinstance(function, types.FunctionType):
        return []
    names = function.__code__.co_names
    found = [function.__globals__.get(name) for name in names]
    return [f for f in found if isinstance(f, types.FunctionType) and f is not function and ours(f)]


def _holds(given: Iterable[z3.BoolRef], goal: z3.BoolRef) -> bool:
    context = z3.Context()
    solver = z3.Solver(ctx=context)
    solver.add(*[term.translate(context) for term in (*given, z3.Not(goal))])
    return check(solver, context, EVERYWHERE_RLIMIT).result == "unsat"


@dataclass
class Told:
    """What lemmas have shown of functions that they look into, by function and key.

    found: for each, (condition under which it holds, facts known where the lemma was used).
    """

    found: dict[tuple[Function, str], list[tuple[z3.BoolRef, tuple[z3.BoolRef, ...]]]] = field(
        default_factory=dict
    )

    def add(
        self, function: Function, key: str, when: z3.BoolRef, given: tuple[z3.BoolRef, ...]
    ) -> None:
        """Record that a lemma looks into the function at these arguments and holds under `when`."""
        self.found.setdefault((function, key), []).append((when, given))

    def through(self, other: Told, given: z3.BoolRef, under: tuple[z3.BoolRef, ...]) -> None:
        """Record what a lemma took over from its own lemmas; its premises are owed here."""
        for (function, key), conditions in other.found.items():
            for condition, _ in conditions:
                self.add(function, key, z3.And(given, condition), under)

    def where(self, call: Call) -> list[z3.BoolRef]:
        """The conditions under which lemmas have shown the side conditions of this call."""
        have = {term.get_id() for term in call.given}
        return [
            z3.simplify(z3.And(when, *[term for term in given if term.get_id() not in have]))
            for when, given in self.found.get((call.function, call.key), [])
        ]


def owed(
    calls: Iterable[Call], told: Told
) -> Iterator[tuple[str, tuple[z3.BoolRef, ...], z3.BoolRef]]:
    """(text, given, goal) of every side condition of these calls that no lemma has shown."""
    done: set[Any] = set()
    for call in calls:
        once = (call.function, call.machine)
        total = everywhere(call.function, machine=call.machine)
        if total is not None:
            if total.owed and once not in done:
                goal = z3.And(*[condition for _, condition in total.owed])
                yield f"{call.name}, which is closed: it is defined everywhere", total.roots, goal
            done.add(once)
            continue
        shown = told.where(call)
        if any(z3.is_true(when) for when in shown):
            continue
        there = requirements(call.function, call.args, machine=call.machine)
        for text, condition in there.owed:
            goal = z3.Or(z3.Not(call.path), *shown, condition)
            if (key := (goal.get_id(), *(g.get_id() for g in call.given))) not in done:
                done.add(key)
                yield f"{call.name}, which is closed: {text}", (*call.given, *there.roots), goal
