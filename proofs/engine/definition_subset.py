"""What a definition may contain, by permission: the kernel subset and a little more.

A definition of `spec` is read by people and by the prover, never compiled. Beside what a kernel has,
it may choose with `a if c else b`, take remainders by positive numbers and shift masks, name
constants, and call plain functions of `spec` and `core`, also by their module's name.
"""

from __future__ import annotations

import ast
import functools
import inspect
import types
from collections.abc import Callable
from fractions import Fraction
from typing import Any, get_type_hints

from cratous.core.kernel import entry_of, qualified
from cratous.core.kernel.sources import ours
from cratous.proofs.engine.expressions import Kinds, Refused
from cratous.proofs.engine.kinds import Kind, Literal, is_kind, merged, shown
from cratous.proofs.engine.lift import Visit
from cratous.proofs.engine.subset import Body, Finding, identity, lint, syntax
from cratous.proofs.engine.terms import leaves

MORE = (ast.Mod, ast.LShift, ast.RShift)


class DefinitionKinds(Kinds):
    """As of kernels; callees: the functions that are called."""

    several = True

    def __init__(self, scope: dict[str, Any], local: set[str]) -> None:
        super().__init__(scope, local)
        self.callees: list[types.FunctionType] = []

    def of(self, node: ast.expr, names: dict[str, Kind]) -> Kind:
        if isinstance(node, ast.IfExp):
            self.truth(node.test, names)
            kinds = self.of(node.body, names), self.of(node.orelse, names)
            both = merged(*kinds)
            if both is None:
                raise Refused(node, f"it is {shown(kinds[0])} or {shown(kinds[1])}: one kind")
            return both
        if isinstance(node, ast.BinOp) and isinstance(node.op, MORE):
            both = merged(self.of(node.left, names), self.of(node.right, names))
            if both is not int and not isinstance(both, Literal):
                raise Refused(node, "remainders and shifts are of integers")
            return int
        if isinstance(node, ast.Attribute | ast.Name) and (found := self._constant(node)):
            return found
        return super().of(node, names)

    def comparable(self, one: Kind, other: Kind, order: bool) -> bool:
        """Records of one kind may be equal."""
        same = one is other and is_kind(one)
        return super().comparable(one, other, order) or (same and not order)

    def _constant(self, node: ast.expr) -> Kind | None:
        """The kind of a constant of this module or of another one; None for anything else."""
        value = self.named(node)
        if isinstance(value, bool):
            return bool
        if isinstance(value, int):
            return Literal(abs(value))
        return float if isinstance(value, Fraction) else None

    def named(self, node: ast.expr) -> Any:
        """What a name, or the attribute of a module, stands for; None if it is local or nothing."""
        if isinstance(node, ast.Name):
            return None if node.id in self.local else self.scope.get(node.id)
        if isinstance(node, ast.Attribute):
            owner = self.named(node.value)
            if isinstance(owner, types.ModuleType):
                return vars(owner).get(node.attr)
        return None

    def _call(self, node: ast.Call, names: dict[str, Kind]) -> Kind:
        value = self.named(node.func)
        entry = entry_of(value)
        if not isinstance(value, types.FunctionType) or (entry and entry.kind == "kernel"):
            return super()._call(node, names)
        if not ours(value):
            raise Refused(node, f"{value.__name__!r} is no function of spec or core")
        hints = get_type_hints(value)
        result = hints.pop("return", None)
        order = list(inspect.signature(value).parameters)
        if result is None or set(hints) != set(order):
            raise Refused(node, f"{value.__name__!r} has no types")
        self._arguments(node, order, hints, names)
        self.callees.append(value)
        return result


@functools.cache
def outside(function: Callable[..., Any]) -> tuple[Finding, ...]:
    """What is outside of the subset in a function that a theorem uses.

    Functions of a theorem's own file are in the language of theorems (`theorem_subset`).
    """
    parts = str(function.__module__).split(".")
    return () if "theorems" in parts[1:3] else tuple(check(function))


def on_numbers(visit: Visit) -> bool:
    """Plain numbers were given and came out, and do again: a table, say, that Python looks up."""
    values = [leaf for value in (visit.args, visit.lifted.value) for leaf in leaves(value)]
    if not all(isinstance(value, bool | int | Fraction) for value in values):
        return False
    return bool(visit.function(*visit.args) == visit.lifted.value)


def check(function: Callable[..., Any]) -> list[Finding]:
    """Everything in a definition, and in what it calls, that is outside of what definitions have."""
    found: list[Finding] = []
    seen: list[Any] = []
    todo: list[Any] = [function]
    while todo:
        one = todo.pop()
        if any(one is other for other in seen):
            continue
        seen.append(one)
        entry = entry_of(one)
        if entry is not None and entry.kind == "kernel":
            found += lint(one)
        else:
            findings, callees = _check(one)
            found += findings
            todo += callees
    return found


def _check(function: Any) -> tuple[list[Finding], list[types.FunctionType]]:
    name = qualified(function)
    if wrong := identity(function):
        return [Finding(name, 1, wrong)], []
    found: list[Finding] = []

    def report(at: ast.AST | None, message: str) -> None:
        found.append(Finding(name, getattr(at, "lineno", 1), message))

    node = syntax(function)
    given = node.args
    if node.decorator_list:
        report(node, "nothing stands over a definition")
    if given.vararg or given.kwarg or given.defaults or given.kwonlyargs or given.posonlyargs:
        report(node, "arguments are written out, without defaults")
    hints = get_type_hints(function)
    if set(hints) != {a.arg for a in given.args} | {"return"}:
        report(node, "each argument and the result has a type")
    for part, kind in hints.items():
        if not is_kind(kind):
            report(node, f"{part!r} is float, int, bool or a record of these without behaviour")
    if found:
        return found, []
    local = {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and not _loaded(n)}
    kinds = DefinitionKinds(function.__globals__, local | {a.arg for a in given.args})
    Body(function, kinds, report).check(node)
    return found, kinds.callees


def _loaded(name: ast.Name) -> bool:
    return isinstance(name.ctx, ast.Load)
