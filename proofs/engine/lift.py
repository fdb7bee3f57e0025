"""The lifter: runs a kernel on symbolic values and gives the z3 term that it computes.

The function is run repeatedly, each time with another sequence of decisions, until every path through it has been
explored; a path whose conditions contradict each other is pruned, one that the solver cannot decide is kept (which is
sound). The results are joined into one term by if-then-else over the path conditions, and every side condition (no
division by zero, no root of a negative number, integers and shifts in range) becomes an obligation. A square root is
a fresh value with its defining fact. A call of another function is lifted separately and enters as one joined term,
so paths do not multiply across calls; recursion is refused.
"""

from __future__ import annotations

import builtins
import inspect
import math
import types
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import z3

from cratous.core.kernel.sources import is_root
from cratous.proofs.engine.cpu_limit import ends_within
from cratous.proofs.engine.models import Models
from cratous.proofs.engine.symbolic import (
    PATHS,
    LiftError,
    Path,
    Sym,
    SymBool,
    _raw,
    as_real,
    root,
    wrap,
)

__all__ = ["LiftError", "Lifted", "Visit", "join", "lift"]

PRUNE_RLIMIT = 200_000
PRUNE_CPU_S = 30
"""CPU seconds after which a feasibility question is ended: far above what any needs."""
MAX_PATHS = 4096
OPAQUE: dict[Callable[..., Any], Callable[..., Any]] = {}
"""Functions that are opaque at present, each with the stub in its place (see Claim.opaque)."""
CLOSED: list[Callable[[Callable[..., Any], tuple[Any, ...]], None]] = []
"""Callbacks for calls of opaque functions, innermost last (see `closed`)."""
REPLACED: dict[Any, Any] = {}
"""Functions and folds for which another one is lifted at present (see `proofs.mutation.mutate`)."""


@dataclass(frozen=True)
class Lifted:
    """What a function computes: the joined value, its side conditions, its paths.

    roots: defining facts of the square roots in the value; branches, values: each path's condition and value; pruned:
    the number of decisions with one feasible outcome only.
    """

    value: Any
    obligations: tuple[tuple[str, z3.BoolRef], ...]
    paths: int
    roots: tuple[z3.BoolRef, ...] = ()
    branches: tuple[z3.BoolRef, ...] = ()
    pruned: int = 0
    values: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Visit:
    """One lifted call: its function, arguments, path conditions and result.

    granted: hypotheses of an induction that hold there, beside the theorem's premises.
    """

    function: Callable[..., Any]
    args: tuple[Any, ...]
    context: tuple[z3.BoolRef, ...]
    lifted: Lifted
    granted: tuple[z3.BoolRef, ...] = ()


VISITS: list[list[Visit]] = []
"""Lists to which every lifted call is appended, innermost last (see `Claim.visits`)."""

_LIFTING: list[Callable[..., Any]] = []


_ASKED: dict[tuple[int, ...], tuple[list[z3.BoolRef], bool]] = {}
_MODELS = Models()


_NAMES: dict[int, tuple[z3.ExprRef, frozenset[str]]] = {}


def _names(term: z3.ExprRef) -> frozenset[str]:
    """The names of the values in a term, computed once for each subterm."""
    known = _NAMES.get(term.get_id())
    if known is None:
        if z3.is_const(term) and term.decl().kind() == z3.Z3_OP_UNINTERPRETED:
            found = frozenset([term.decl().name()])
        else:
            found = frozenset().union(*[_names(part) for part in term.children()])
        # the term is kept alive so that its id stays unique
        known = _NAMES[term.get_id()] = (term, found)
    return known[1]


def _relevant(conditions: list[z3.BoolRef]) -> list[z3.BoolRef]:
    """The conditions that share values with the last one, directly or through others.

    The rest is about other values: it was satisfiable before and does not affect the last condition.
    """
    left = conditions[:-1]
    found, names = [conditions[-1]], set(_names(conditions[-1]))
    while True:
        more = [c for c in left if _names(c) & names]
        if not more:
            return found
        left = [c for c in left if not _names(c) & names]
        found += more
        names.update(*[_names(c) for c in more])


def _feasible(conditions: list[z3.BoolRef]) -> bool:
    """False only if the last condition is known to contradict the others; each question is asked once."""
    conditions = _relevant(conditions)
    key = tuple(sorted({condition.get_id() for condition in conditions}))
    if key not in _ASKED and _MODELS.satisfy(conditions):
        _ASKED[key] = (conditions, True)
    if key not in _ASKED:
        solver = z3.Solver()
        solver.set("rlimit", PRUNE_RLIMIT)
        solver.add(*conditions)
        with ends_within(PRUNE_CPU_S):
            answer = solver.check()
        if answer == z3.sat:
            _MODELS.keep(solver.model())
        # the terms are kept alive so that their ids stay unique
        _ASKED[key] = (conditions, bool(answer != z3.unsat))
    return _ASKED[key][1]


def _decider(
    context: list[z3.BoolRef], queue: list[list[bool]], pruned: list[z3.BoolRef]
) -> Callable[..., bool]:
    """Returns decisions from the script; after its end takes the first feasible way and queues the other."""

    def decide(path: Path, condition: z3.BoolRef) -> bool:
        # a condition met before on this path is no decision, nor is it one in a replay
        known = {c.get_id() for c in (*context, *path.conditions)}
        if condition.get_id() in known:
            return True
        if z3.Not(condition).get_id() in known:
            return False
        index = len(path.taken)
        if index < len(path.script):
            choice = path.script[index]
        else:
            sofar = [*context, *path.conditions, *path.roots]
            yes = _feasible([*sofar, condition])
            no = _feasible([*sofar, z3.Not(condition)])
            choice = yes or not no
            if yes and no:
                queue.append([*path.taken, False])
            else:
                pruned.append(condition)
        path.taken.append(choice)
        path.conditions.append(condition if choice else z3.Not(condition))
        return choice

    return decide


def join(branches: list[tuple[z3.BoolRef, Any]]) -> Any:
    """One value out of (condition, value) branches that cover all cases."""
    first = branches[0][1]
    if len(branches) == 1:
        return first
    if isinstance(first, tuple):
        if any(not isinstance(v, tuple) or len(v) != len(first) for _, v in branches):
            raise LiftError(f"branches return values that cannot be joined: {_shown(branches)}")
        columns = [join([(c, v[i]) for c, v in branches]) for i in range(len(first))]
        return type(first)(*columns) if hasattr(first, "_fields") else tuple(columns)
    terms = [(c, _raw(v)) for c, v in branches]
    if any(t is None for _, t in terms):
        raise LiftError(f"branches return values that cannot be joined: {_shown(branches)}")
    if any(z3.is_real(t) for _, t in terms):
        terms = [(c, as_real(t)) for c, t in terms]
    bits = any(z3.is_bv(t) for _, t in terms)
    joined: Any = None
    for condition, term in reversed(terms):
        if bits and z3.is_int_value(term) and 0 <= term.as_long() < 2**64:
            term = z3.BitVecVal(term.as_long(), 64)
        if joined is not None and term.sort() != joined.sort():
            raise LiftError(f"branches return values that cannot be joined: {_shown(branches)}")
        joined = term if joined is None else z3.If(condition, term, joined)
    return wrap(joined)


def _shown(branches: list[tuple[z3.BoolRef, Any]]) -> str:
    values = [v.term if isinstance(v, Sym) else v for _, v in branches]
    return ", ".join(" ".join(str(v).split())[:60] for v in values)


def lift(function: Callable[..., Any], *args: Any) -> Lifted:
    """Run `function` on symbolic arguments through every path, and join the results."""
    if function in OPAQUE:
        for tell in CLOSED[-1:]:
            tell(function, args)
        return Lifted(OPAQUE[function](*args), (), 1)
    if function in _LIFTING:
        circle = " -> ".join(f.__name__ for f in [*_LIFTING[_LIFTING.index(function) :], function])
        raise LiftError(f"recursion: {circle}; write a fold, whose steps end")
    target = _with_lifted_callees(REPLACED.get(function, function))
    context = [c for path in PATHS for c in path.conditions]
    queue: list[list[bool]] = [[]]
    pruned: list[z3.BoolRef] = []
    decide = _decider(context, queue, pruned)
    branches: list[tuple[z3.BoolRef, Any]] = []
    obligations: list[tuple[str, z3.BoolRef]] = []
    seen: set[tuple[str, int]] = set()
    roots: list[z3.BoolRef] = []
    while queue:
        if len(branches) >= MAX_PATHS:
            raise LiftError(f"{function.__name__} has more than {MAX_PATHS} paths")
        path = Path(decide, script=queue.pop(0))
        PATHS.append(path)
        _LIFTING.append(function)
        try:
            value = target(*args)
        finally:
            PATHS.pop()
            _LIFTING.pop()
        condition = z3.And(*path.conditions) if path.conditions else z3.BoolVal(True)
        branches.append((condition, value))
        # paths with a common beginning have the same obligations there: stated once
        for text, owed in path.obligations:
            if (text, owed.get_id()) not in seen:
                seen.add((text, owed.get_id()))
                obligations.append((text, owed))
        roots += path.roots
    lifted = Lifted(
        join(branches),
        tuple(obligations),
        len(branches),
        tuple(roots),
        tuple(condition for condition, _ in branches),
        len(pruned),
        tuple(value for _, value in branches),
    )
    if VISITS:
        VISITS[-1].append(Visit(function, args, tuple(context), lifted))
    return lifted


def _with_lifted_callees(function: Callable[..., Any]) -> Callable[..., Any]:
    """A copy of the function whose globals hold lifted versions of the functions that it calls."""
    if not isinstance(function, types.FunctionType):
        return function
    scope = dict(function.__globals__)
    for name in function.__code__.co_names:
        value = scope.get(name, getattr(builtins, name, None))
        if value is min or value is max:
            scope[name] = _extreme(value)
        elif is_root(value):
            scope[name] = _root
        elif inspect.isfunction(value):
            scope[name] = _calling(value)
    return types.FunctionType(
        function.__code__, scope, function.__name__, function.__defaults__, function.__closure__
    )


def _calling(callee: Callable[..., Any]) -> Callable[..., Any]:
    def call(*args: Any) -> Any:
        lifted = lift(callee, *args)
        for text, condition in lifted.obligations:
            PATHS[-1].require(f"{callee.__name__}: {text}", condition)
        PATHS[-1].roots.extend(lifted.roots)
        return lifted.value

    return call


def _root(value: Any) -> Any:
    """sqrt: Python's for a plain number; for a symbolic value a fresh value with its defining fact."""
    return root(value) if isinstance(value, Sym) else math.sqrt(value)


def _extreme(which: Callable[..., Any]) -> Callable[..., Any]:
    """min or max of values as if-then-else, without splitting the path."""

    def choose(a: Any, b: Any, *more: Any) -> Any:
        if more:
            return choose(choose(a, b), *more)
        if not isinstance(a, Sym) and not isinstance(b, Sym):
            return which(a, b)
        first = (a <= b) if which is min else (a >= b)
        if not isinstance(first, SymBool):
            return which(a, b)
        return join([(first.term, a), (z3.Not(first.term), b)])

    return choose
