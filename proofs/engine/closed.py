"""What is owed where a theorem uses a function that it does not look into.

Such a function gives what lemmas say and no more, but it is still called: what it divides by is not
0, what it takes roots of is not negative, its integers stay in 64 bits. A function that owes nothing
for any arguments is shown to do so once. Of another one it is owed at every use, with all that it
calls looked into, unless a lemma about it is used for the same arguments: what the lemma's own
proof has shown under its premises, which are owed there.
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
from cratous.proofs.engine.lift import CLOSED, OPAQUE, REPLACED, VISITS, LiftError, lift
from cratous.proofs.engine.solver_order import check
from cratous.proofs.engine.symbolic import PATHS, RANGE, SymReal, as_real
from cratous.proofs.engine.terms import Stub, fresh, known

EVERYWHERE_RLIMIT = 1_000_000
TRUE = z3.BoolVal(True)
Function = Callable[..., Any]
Owed = tuple[str, z3.BoolRef]


@dataclass(frozen=True)
class Call:
    """A use of a closed function: its arguments, on which path, and what is known there.

    key: a text that equal arguments share; machine: its integers are those of compiled code.
    """

    function: Function
    args: tuple[Any, ...]
    key: str
    path: z3.BoolRef
    machine: bool
    given: tuple[z3.BoolRef, ...]

    @property
    def name(self) -> str:
        """The function for people."""
        return self.function.__name__


@dataclass(frozen=True)
class Requirements:
    """What a function owes at some arguments; roots: what is true of the square roots in it."""

    owed: tuple[Owed, ...]
    roots: tuple[z3.BoolRef, ...]


def path_to(where: z3.BoolRef) -> z3.BoolRef:
    """The condition of the path that is being explored, where it counts."""
    return z3.simplify(z3.And(where, *[c for path in PATHS for c in path.conditions]))


@contextmanager
def _looked_into(closed: dict[Function, Stub]) -> Iterator[None]:
    """In here every function but these is looked into, and nobody is told of it."""
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
    """What a function owes at these arguments, with all that it calls, but for these, looked into."""
    kinds = get_type_hints(function)
    names = list(inspect.signature(function).parameters)
    given = [_symbolic(value, kinds[n]) for n, value in zip(names, args, strict=True)]
    with _looked_into(closed or {}):
        lifted = lift(function, *given)
    owed = [o for o in lifted.obligations if machine or not o[0].endswith(RANGE)]
    return Requirements(tuple(owed), lifted.roots if owed else ())


def _symbolic(value: Any, kind: Any) -> Any:
    """A value for a function to run on: Python would compute with plain numbers by itself."""
    if isinstance(value, tuple):
        kinds = get_type_hints(kind)
        parts = [_symbolic(v, kinds[f]) for f, v in zip(kind._fields, value, strict=True)]
        return kind(*parts)
    return SymReal(as_real(known(value))) if kind is float else value


def everywhere(function: Function, *, machine: bool) -> Requirements | None:
    """What a function owes at any arguments, if it seems that this always holds; else None.

    Whether it does is for the prover to say, as of every obligation.
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
    # what it calls gives any value then, if that will do
    for closed in (stubs, {}) if stubs else ({},):
        try:
            own = requirements(function, args, machine=machine, closed=closed)
        except (LiftError, TypeError):
            continue  # a mask, say: it is looked at where it is used
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
    """The functions that it calls by their names, itself apart."""
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
    """What lemmas have shown of functions that they look into: by function and key, where it holds.

    found: (condition, what was given where the lemma was used) of each.
    """

    found: dict[tuple[Function, str], list[tuple[z3.BoolRef, tuple[z3.BoolRef, ...]]]] = field(
        default_factory=dict
    )

    def add(
        self, function: Function, key: str, when: z3.BoolRef, given: tuple[z3.BoolRef, ...]
    ) -> None:
        """A lemma looks into the function at these arguments, and holds where this is so."""
        self.found.setdefault((function, key), []).append((when, given))

    def through(self, other: Told, given: z3.BoolRef, under: tuple[z3.BoolRef, ...]) -> None:
        """What a lemma was told by its own lemmas and shows itself; its premises are owed here."""
        for (function, key), conditions in other.found.items():
            for condition, _ in conditions:
                self.add(function, key, z3.And(given, condition), under)

    def where(self, call: Call) -> list[z3.BoolRef]:
        """The conditions under which lemmas have shown what this call owes."""
        have = {term.get_id() for term in call.given}
        return [
            z3.simplify(z3.And(when, *[term for term in given if term.get_id() not in have]))
            for when, given in self.found.get((call.function, call.key), [])
        ]


def owed(
    calls: Iterable[Call], told: Told
) -> Iterator[tuple[str, tuple[z3.BoolRef, ...], z3.BoolRef]]:
    """(text, given, goal) of everything that these calls owe and no lemma has shown."""
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
