"""The lifter: runs a kernel on symbolic values and gives the z3 term that it computes.

The function is run again and again, each time with another script of decisions, until every way
through it has been seen; a way whose conditions contradict each other is pruned, one that the
solver cannot judge is kept (which is sound). The results are joined into one term by
if-then-else over the path conditions, and every side condition (no division by zero, integers in
range) comes out as an obligation. A call to another kernel is lifted on its own and enters as one
joined term, so paths do not multiply across calls.
"""

from __future__ import annotations

import builtins
import inspect
import types
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import z3

from cratous.proofs.symbolic import PATHS, Path, Sym, SymBool, _raw, wrap

PRUNE_RLIMIT = 200_000
MAX_PATHS = 4096
OPAQUE: dict[Callable[..., Any], Callable[..., Any]] = {}
"""Functions that are not looked into at present, with what stands for them (see Claim.opaque)."""


class LiftError(Exception):
    """A function that cannot be lifted; says which and why."""


@dataclass(frozen=True)
class Lifted:
    """What a function computes: the joined value, its side conditions, how many paths it has."""

    value: Any
    obligations: tuple[tuple[str, z3.BoolRef], ...]
    paths: int


def _feasible(conditions: list[z3.BoolRef]) -> bool:
    solver = z3.Solver()
    solver.set("rlimit", PRUNE_RLIMIT)
    solver.add(*conditions)
    return bool(solver.check() != z3.unsat)


def _decider(context: list[z3.BoolRef], queue: list[list[bool]]) -> Callable[..., bool]:
    """Follow the script; at its end take the first feasible way and queue the other."""

    def decide(path: Path, condition: z3.BoolRef) -> bool:
        index = len(path.taken)
        if index < len(path.script):
            choice = path.script[index]
        else:
            # a condition that was met before on this path needs no new decision
            known = {c.get_id() for c in path.conditions}
            if condition.get_id() in known:
                return True
            yes = _feasible([*context, *path.conditions, condition])
            no = _feasible([*context, *path.conditions, z3.Not(condition)])
            choice = yes or not no
            if yes and no:
                queue.append([*path.taken, False])
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
        columns = [join([(c, v[i]) for c, v in branches]) for i in range(len(first))]
        return type(first)(*columns) if hasattr(first, "_fields") else tuple(columns)
    terms = [(c, _raw(v)) for c, v in branches]
    if any(t is None for _, t in terms):
        raise LiftError(f"branches return values that cannot be joined: {branches!r}")
    real = any(z3.is_real(t) for _, t in terms)
    bits = any(z3.is_bv(t) for _, t in terms)
    joined: Any = None
    for condition, term in reversed(terms):
        if real and z3.is_int(term):
            term = z3.ToReal(term)
        if bits and z3.is_int_value(term):
            term = z3.BitVecVal(term.as_long(), 64)
        joined = term if joined is None else z3.If(condition, term, joined)
    return wrap(joined)


def lift(function: Callable[..., Any], *args: Any) -> Lifted:
    """Run `function` on symbolic arguments through every path, and join the results."""
    if function in OPAQUE:
        return Lifted(OPAQUE[function](*args), (), 1)
    target = _with_lifted_callees(function)
    context = [c for path in PATHS for c in path.conditions]
    queue: list[list[bool]] = [[]]
    decide = _decider(context, queue)
    branches: list[tuple[z3.BoolRef, Any]] = []
    obligations: list[tuple[str, z3.BoolRef]] = []
    while queue:
        if len(branches) >= MAX_PATHS:
            raise LiftError(f"{function.__name__} has more than {MAX_PATHS} paths")
        path = Path(decide, script=queue.pop(0))
        PATHS.append(path)
        try:
            value = target(*args)
        finally:
            PATHS.pop()
        condition = z3.And(*path.conditions) if path.conditions else z3.BoolVal(True)
        branches.append((condition, value))
        obligations += path.obligations
    return Lifted(join(branches), tuple(obligations), len(branches))


def _with_lifted_callees(function: Callable[..., Any]) -> Callable[..., Any]:
    """A copy of the function in whose globals calls to functions of ours are lifted calls."""
    if not isinstance(function, types.FunctionType):
        return function
    scope = dict(function.__globals__)
    for name in function.__code__.co_names:
        value = scope.get(name, getattr(builtins, name, None))
        if value is min or value is max:
            scope[name] = _extreme(value)
        elif inspect.isfunction(value) and value.__module__.startswith("cratous."):
            scope[name] = _calling(value)
    return types.FunctionType(
        function.__code__, scope, function.__name__, function.__defaults__, function.__closure__
    )


def _calling(callee: Callable[..., Any]) -> Callable[..., Any]:
    def call(*args: Any) -> Any:
        lifted = lift(callee, *args)
        for text, condition in lifted.obligations:
            PATHS[-1].require(f"{callee.__name__}: {text}", condition)
        return lifted.value

    return call


def _extreme(which: Callable[..., Any]) -> Callable[..., Any]:
    """min and max of two values as one if-then-else, without forking the path."""

    def choose(a: Any, b: Any) -> Any:
        if not isinstance(a, Sym) and not isinstance(b, Sym):
            return which(a, b)
        first = (a <= b) if which is min else (a >= b)
        if not isinstance(first, SymBool):
            return which(a, b)
        return join([(first.term, a), (z3.Not(first.term), b)])

    return choose
