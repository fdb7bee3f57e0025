"""The lint of the kernel subset: what a kernel may contain, with messages that teach.

Allowed: typed arguments and result; `if`, `return`, assignment to local names; arithmetic + - *,
division of reals, comparisons, `and or not`, & and | on masks; calls to other kernels, records
(NamedTuples) and `abs min max sqrt`; field access; integer, boolean literals. A float literal
would break the exact reading; // % ** differ between Python, numba and the prover; loops over
data are `fold`s; globals other than kernels and records would escape the ledger's key.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from dataclasses import dataclass
from typing import Any

from cratous.core.kernel import REGISTRY, Fold, entry_of, qualified

CALLS = {"abs", "min", "max", "sqrt"}
FORBIDDEN: dict[type[ast.AST], str] = {
    ast.While: "loops over data are `fold`s over a kernel step",
    ast.For: "loops over data are `fold`s over a kernel step",
    ast.Try: "kernels are total: decide with `if` instead of catching",
    ast.Raise: "kernels are total: return a value for every input",
    ast.Global: "kernels see nothing but their arguments",
    ast.Nonlocal: "kernels see nothing but their arguments",
    ast.Lambda: "name a kernel instead of a lambda",
    ast.ListComp: "no collections in kernels; use a `fold`",
    ast.GeneratorExp: "no collections in kernels; use a `fold`",
    ast.DictComp: "no collections in kernels; use a `fold`",
    ast.SetComp: "no collections in kernels; use a `fold`",
    ast.Subscript: "no indexing in kernels; pass the item (see `fold`)",
    ast.JoinedStr: "no text in kernels",
    ast.Import: "no imports in kernels",
    ast.ImportFrom: "no imports in kernels",
    ast.AugAssign: "write `x = x + y`: one assignment, one meaning",
    ast.FloorDiv: "// differs between the readings; multiply out instead",
    ast.Mod: "% differs between the readings; multiply out instead",
    ast.Pow: "** differs between the readings; write the product",
    ast.LShift: "no shifts in kernels: pass the mask",
    ast.RShift: "no shifts in kernels: pass the mask",
    ast.IfExp: "write `if` as a statement: the lifter forks there",
    ast.NamedExpr: "assign first, then use",
    ast.Delete: "nothing to delete in a kernel",
    ast.With: "no contexts in kernels",
    ast.Starred: "write the arguments out",
    ast.Assert: "kernels are total: put the premise into the theorem",
}


@dataclass(frozen=True)
class Finding:
    """A place in a kernel that is outside of the subset."""

    kernel: str
    line: int
    message: str

    def __str__(self) -> str:
        return f"{self.kernel}, line {self.line} of it: {self.message}"


def _function(function: Any) -> ast.FunctionDef:
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    node = tree.body[0]
    if not isinstance(node, ast.FunctionDef):
        raise TypeError(f"{function!r} is no function definition")
    return node


def lint(function: Any) -> list[Finding]:
    """Everything in one kernel that is outside of the subset."""
    node = _function(function)
    name = qualified(function)
    found = []

    def report(at: ast.AST, message: str) -> None:
        found.append(Finding(name, getattr(at, "lineno", 1), message))

    for argument in node.args.args:
        if argument.annotation is None:
            report(argument, f"argument {argument.arg!r} has no type")
    if node.returns is None:
        report(node, "the result has no type")
    if node.args.vararg or node.args.kwarg or node.args.defaults:
        report(node, "arguments are written out, without defaults")
    local = {argument.arg for argument in node.args.args}
    local |= {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and _stored(n)}
    body = node.body[1:] if ast.get_docstring(node) else node.body
    if not ast.get_docstring(node):
        report(node, "it has no docstring: meaning and units of every argument")
    for statement in body:
        for part in ast.walk(statement):
            _check(part, function, local, report)
    return found


def _stored(name: ast.Name) -> bool:
    return isinstance(name.ctx, ast.Store)


def _check(part: ast.AST, function: Any, local: set[str], report: Any) -> None:
    message = FORBIDDEN.get(type(part))
    if message:
        report(part, message)
    if isinstance(part, ast.Constant) and not isinstance(part.value, bool | int):
        report(part, f"the literal {part.value!r}: only integers and booleans are exact")
    if isinstance(part, ast.Attribute) and isinstance(part.ctx, ast.Store):
        report(part, "records are not changed: make a new one")
    if isinstance(part, ast.Tuple) and isinstance(part.ctx, ast.Load):
        report(part, "no bare tuples: make a record, or assign one name at a time")
    if isinstance(part, ast.Call) and not isinstance(part.func, ast.Name):
        report(part, "call kernels by their name")
    if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Load) and part.id not in local:
        value = function.__globals__.get(part.id)
        record = inspect.isclass(value) and issubclass(value, tuple)
        entry = entry_of(value)
        kernel = entry is not None and entry.kind == "kernel"
        if not (part.id in CALLS or record or kernel):
            report(part, f"{part.id!r} is neither a kernel nor a record")


def lint_all() -> list[Finding]:
    """Lint every registered kernel, and every step and finish of a fold."""
    found = []
    for entry in REGISTRY.values():
        if entry.kind == "kernel":
            found += lint(entry.function)
        if isinstance(entry.function, Fold):
            for part in (entry.function.step, entry.function.finish):
                if entry_of(part) is None:
                    found.append(Finding(entry.name, 1, f"{part.__name__} is no kernel"))
    return found
