"""What a definition may contain, as a list of what is permitted: the kernel subset and some more.

A definition of `spec` is read by people and by the prover, never compiled. Beside what a kernel has, it may choose
with `a if c else b`, take remainders by positive numbers and shift masks, name constants, and call plain functions of
`spec` and `core`, also by their module's name.
"""

from __future__ import annotations

import ast
import functools
import inspect
import sys
import types
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from cratous.core.kernel import entry_of, qualified
from cratous.core.kernel.sources import ours
from cratous.proofs.engine.expressions import Kinds, Refused
from cratous.proofs.engine.lift import Visit
from cratous.proofs.engine.module_source import NOTHING, constant
from cratous.proofs.engine.subset import PLAIN, Body, Finding, hints, identity, lint, syntax
from cratous.proofs.engine.terms import leaves
from cratous.proofs.engine.value_kinds import Kind, Literal, is_kind, merged, shown
from cratous.proofs.engine.written_types import differing

MORE = (ast.Mod, ast.LShift, ast.RShift)


class DefinitionKinds(Kinds):
    """Kinds of expressions in definitions; callees: the functions that are called."""

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
        if isinstance(node, ast.BinOp) and isinstance(node.op, (*MORE, ast.BitXor)):
            both = merged(self.of(node.left, names), self.of(node.right, names))
            if both is not int and not isinstance(both, Literal):
                raise Refused(node, "remainders and shifts are of integers")
            return int
        if isinstance(node, ast.Attribute | ast.Name) and (found := self._constant(node)):
            return found
        return super().of(node, names)

    def comparable(self, one: Kind, other: Kind, order: bool) -> bool:
        """Whether two kinds may be compared: as in kernels, and records of one kind for equality."""
        same = one is other and is_kind(one)
        return super().comparable(one, other, order) or (same and not order)

    def _constant(self, node: ast.expr) -> Kind | None:
        """The kind of a constant of this or another module; None for anything else."""
        value = self.named(node)
        if isinstance(value, bool | int | Fraction):
            self._as_written(node, value)
        if isinstance(value, bool):
            return bool
        if isinstance(value, int):
            return Literal(abs(value))
        return float if isinstance(value, Fraction) else None

    def _as_written(self, node: ast.expr, value: Any) -> None:
        """Refuse a constant whose value at run time differs from the one in the hashed file."""
        if isinstance(node, ast.Attribute):
            home, name = self.named(node.value), node.attr
        else:
            home, name = sys.modules.get(str(self.scope["__name__"])), ast.unparse(node)
        said = constant(home, name) if isinstance(home, types.ModuleType) else NOTHING
        if said is NOTHING or said != value or type(said) is not type(value):
            raise Refused(
                node,
                f"{name!r} is {value} as it runs, and not by its module's file: a constant is written once",
            )

    def named(self, node: ast.expr) -> Any:
        """The object that a name or a module's attribute refers to; None for a local or unknown name."""
        if isinstance(node, ast.Name):
            return None if node.id in self.local else self.scope.get(node.id)
        if isinstance(node, ast.Attribute):
            owner = self.named(node.value)
            if isinstance(owner, types.ModuleType):
                return vars(owner).get(node.attr)
        return None

    def _call(self, node: ast.Call, names: dict[str, Kind]) -> Kind:
        value = self.named(node.func)
        if value is Fraction:
            for part in node.args:
                if not isinstance(self.of(part, names), Literal) or node.keywords:
                    raise Refused(node, "a Fraction of two written integers")
            return float
        if (
            isinstance(node.func, ast.Name)
            and node.func.id in OVER
            and node.func.id not in self.local
        ):
            return self._over(node, names)
        entry = entry_of(value)
        if not isinstance(value, types.FunctionType) or (entry and entry.kind == "kernel"):
            return super()._call(node, names)
        if not ours(value):
            raise Refused(node, f"{value.__name__!r} is no function of spec or core")
        kinds = hints(value)
        result = kinds.pop("return", None)
        order = list(inspect.signature(value).parameters)
        if result is None or set(kinds) != set(order):
            raise Refused(node, f"{value.__name__!r} has no types")
        self._arguments(node, order, kinds, names)
        self.callees.append(value)
        return result

    def _over(self, node: ast.Call, names: dict[str, Kind]) -> Kind:
        """The kind of any, all or sum of an expression over a written list of values."""
        name = ast.unparse(node.func)
        if self.scope.get(name, OVER[name]) is not OVER[name]:
            raise Refused(node, f"{name!r} is not Python's own here: give yours another name")
        over = node.args[0] if len(node.args) == 1 and not node.keywords else None
        if isinstance(over, ast.Tuple | ast.List):
            return self._of_all(node, name, self._common(over, names))
        if not isinstance(over, ast.GeneratorExp) or len(over.generators) != 1:
            raise Refused(node, f"{name} of (... for ... in ...), over a few written values")
        loop = over.generators[0]
        if loop.ifs:
            raise Refused(node, "a loop over all of a few written values")
        kind = self.of(over.elt, {**names, **self.items(loop, names)})
        return self._of_all(node, name, kind)

    def _of_all(self, node: ast.Call, name: str, kind: Kind) -> Kind:
        """The kind of any, all or sum of values of this kind."""
        if kind is not bool if name != "sum" else kind not in (float, int):
            raise Refused(node, f"{name} is not of {shown(kind)}")
        return kind

    def _common(self, node: ast.Tuple | ast.List, names: dict[str, Kind]) -> Kind:
        """The common kind of all values written here."""
        kinds = [self.of(part, names) for part in node.elts]
        both = functools.reduce(lambda a, b: None if a is None else merged(a, b), kinds)
        if both is None:
            raise Refused(node, "the values that are gone through are of one kind")
        return both

    def items(self, loop: ast.comprehension | ast.For, names: dict[str, Kind]) -> dict[str, Kind]:
        """The names that a loop over written values binds, with the kinds of their values."""
        ways = [loop.iter]
        targets = [loop.target]
        called = ast.unparse(loop.iter.func) if isinstance(loop.iter, ast.Call) else ""
        if called in self.scope or called in self.local:
            raise Refused(
                loop.iter, f"{called!r} is not Python's own here: give yours another name"
            )
        if isinstance(loop.iter, ast.Call) and called == "zip":
            ways = list(loop.iter.args)
            targets = list(loop.target.elts) if isinstance(loop.target, ast.Tuple) else []
        if not ways or len(ways) != len(targets):
            raise Refused(loop.iter, "a loop over a few written values, or a zip of such")
        found: dict[str, Kind] = {}
        for way, target in zip(ways, targets, strict=True):
            constants = self.named(way)
            if isinstance(way, ast.Tuple | ast.List) and way.elts:
                both = self._common(way, names)
            elif isinstance(way, ast.Call) and called == "range" and len(way.args) == 1:
                both = self.of(way.args[0], names)
                if not isinstance(both, Literal) or not 0 < both.bound <= LOOPS:
                    raise Refused(way, f"so many times as is written, at most {LOOPS}")
            elif isinstance(constants, tuple) and isinstance(way, ast.Name):
                self._as_written(way, constants)
                if not constants or not all(type(v) is int for v in constants):
                    raise Refused(way, "a tuple of integers that its module writes once")
                both = Literal(max(abs(v) for v in constants))
            else:
                raise Refused(way, "a loop over a few written values, or a zip of such")
            if not isinstance(target, ast.Name):
                raise Refused(way, "each value of a loop has a name")
            found[target.id] = both
        return found


@functools.cache
def outside(function: Callable[..., Any]) -> tuple[Finding, ...]:
    """Everything outside of the subset in a function that a theorem uses.

    Functions of a theorem's own file are in the language of theorems (`theorem_subset`).
    """
    return () if of_theorems(function) else tuple(check(function))


def refusals(function: Callable[..., Any]) -> list[str]:
    """What a definition contains outside of the subset; or that its file has no such definition."""
    try:
        return list(map(str, outside(function)))
    except TypeError:
        return [f"the code that runs is not its file's: {qualified(function)}"]


def of_theorems(function: Callable[..., Any]) -> bool:
    """Whether it is a function of a theorem's file, or one of the product's methods of proof."""
    package, _, home = str(function.__module__).partition(".")
    if package == "cratous":
        return home.startswith(("proofs.methods.", "proofs.theorems."))
    return home.startswith("theorems.")


LOOPS = 1000
OVER = {"any": any, "all": all, "sum": sum}


def on_numbers(visit: Visit) -> bool:
    """Whether arguments and result are plain numbers, and Python computes the same result: a table, for example."""
    values = [leaf for value in (visit.args, visit.lifted.value) for leaf in leaves(value)]
    if not all(isinstance(value, bool | int | Fraction) for value in values):
        return False
    return bool(visit.function(*visit.args) == visit.lifted.value)


def check(function: Callable[..., Any]) -> list[Finding]:
    """Everything outside of the definition subset, in a definition and in what it calls."""
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
    types_ = hints(function)
    if set(types_) != {a.arg for a in given.args} | {"return"}:
        report(node, "each argument and the result has a type")
    for part, kind in types_.items():
        if not is_kind(kind):
            report(node, f"the type of {part!r}: float, int, bool or a record without behaviour")
    for what in differing(node, types_, function.__globals__):
        report(node, f"{what} is not the one that is written: {PLAIN}")
    if found:
        return found, []
    local = {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and not _loaded(n)}
    kinds = DefinitionKinds(function.__globals__, local | {a.arg for a in given.args})
    Body(function, kinds, report).check(node)
    return found, kinds.callees


def _loaded(name: ast.Name) -> bool:
    return isinstance(name.ctx, ast.Load)
