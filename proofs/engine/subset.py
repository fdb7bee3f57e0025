"""The kernel subset: what is not listed here is refused, with what to write instead.

A kernel is one typed function of a module, marked with `@kernel(...)` alone: arguments and result are `float`, `int`,
`bool` or records (`NamedTuple`s with such fields and no behaviour). Its body: a docstring, assignments to names (a
record may be taken apart), `if`, and `return` on every path. Its expressions: names of arguments and locals,
integers, `True` and `False`, `+ - *` of numbers of one kind, `/` of reals, `& |` of masks, comparisons of numbers of
one kind, `==` of truth values, `and or not` of truth values, fields, calls of kernels, of records and of Python's own
`abs min max sqrt`. A written integer may stand beside reals up to 2**53, where it is the same number in every
reading. Each expression has the same kind on every path (see `expressions`).
"""

from __future__ import annotations

import ast
import builtins
import sys
import types
from collections.abc import Callable, Container
from dataclasses import dataclass
from typing import Any, get_type_hints

from cratous.core.kernel import REGISTRY, Fold, entry_of, kernel, qualified
from cratous.core.kernel.sources import text_of
from cratous.proofs.engine.expressions import Kinds, Refused
from cratous.proofs.engine.module_source import is_top
from cratous.proofs.engine.value_kinds import Kind, Literal, fits, is_kind, merged, shown
from cratous.proofs.engine.written_types import differing

PLAIN = "write float, int, bool or a record by its own name"
STATEMENTS = "a kernel has assignments to names, `if` and `return`"
INSTEAD: dict[type[ast.AST], str] = {
    ast.While: "loops over data are `fold`s over a kernel step",
    ast.For: "loops over data are `fold`s over a kernel step",
    ast.Try: "kernels are total: decide with `if` instead of catching",
    ast.Raise: "kernels are total: return a value for every input",
    ast.Assert: "kernels are total: put the premise into the theorem",
    ast.Global: "kernels see nothing but their arguments",
    ast.Nonlocal: "kernels see nothing but their arguments",
    ast.AugAssign: "write `x = x + y`: one assignment, one meaning",
    ast.AnnAssign: "write `x = y`: the kind of a local follows from its value",
    ast.Match: "write `if`: its conditions are truth values",
    ast.FunctionDef: "write it as a kernel of the module",
    ast.Import: "no imports in kernels",
    ast.ImportFrom: "no imports in kernels",
    ast.Expr: "a value that nobody uses",
    ast.Pass: "write the branch that does something, turned round",
}


@dataclass(frozen=True)
class Finding:
    """A place in a kernel that is outside of the subset."""

    kernel: str
    line: int
    message: str

    def __str__(self) -> str:
        return f"{self.kernel}, line {self.line} of it: {self.message}"


def syntax(function: Any) -> ast.FunctionDef:
    """The definition of a function as its file has it; TypeError for anything else."""
    tree = ast.parse(text_of(function))
    node = tree.body[0]
    if not isinstance(node, ast.FunctionDef):
        raise TypeError(f"{function!r} is no function definition")
    return node


def identity(function: Any) -> str:
    """What is wrong with a function's name or origin; empty for a plain function of its module."""
    if not isinstance(function, types.FunctionType) or hasattr(function, "__wrapped__"):
        return "it is no plain function: nothing may stand around the `def`"
    module = sys.modules.get(function.__module__)
    plain: types.FunctionType = function
    if function.__closure__ or "." in function.__qualname__ or "<" in function.__qualname__:
        return "it is made inside of another function: write it at the top of a module"
    if function.__code__.co_qualname != function.__name__:
        return f"the code that runs is that of {function.__code__.co_qualname!r}, not its own"
    if module is None or function.__globals__ is not vars(module):
        return "it is not of the module that it names"
    if not _of_python(function.__builtins__) or not _of_python(vars(module).get("__builtins__")):
        return "its module brings other builtins than Python's own"
    if vars(module).get(function.__name__) is not function:
        return f"its module has another thing of the name {function.__name__!r}: give each its own"
    try:
        top = is_top(plain)
    except OSError:
        return "its source cannot be read: write it in a file"
    if not top:
        return "it is not the one definition of its name at the top of its module's file"
    return ""


def _of_python(scope: Any) -> bool:
    """Whether these are the names that Python has everywhere: a module may give its functions others."""
    return scope is builtins or scope is vars(builtins)


def hints(function: Any) -> dict[str, Any]:
    """The types of arguments and result, as `get_type_hints`; the annotation's text where its name is unknown."""
    try:
        return get_type_hints(function)
    except (NameError, TypeError, AttributeError, SyntaxError) as error:
        return {"return": f"a type that is not there ({error})"}


def lint(function: Any) -> list[Finding]:
    """Everything in one kernel that is outside of the subset."""
    name = qualified(function)
    found: list[Finding] = []

    def report(at: ast.AST | None, message: str) -> None:
        found.append(Finding(name, getattr(at, "lineno", 1), message))

    if wrong := identity(function):
        report(None, wrong)
        return found
    node = syntax(function)
    _head(node, function, report)
    if not ast.get_docstring(node):
        report(node, "it has no docstring: meaning and units of every argument")
    if not found:
        local = {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and _stored(n)}
        kinds = Kinds(function.__globals__, local | {a.arg for a in node.args.args})
        Body(function, kinds, report).check(node)
    return found


Report = Callable[[ast.AST | None, str], None]


def _head(node: ast.FunctionDef, function: types.FunctionType, report: Report) -> None:
    """Check decorator, arguments and types."""
    scope, marks = function.__globals__, node.decorator_list
    called = [mark.func for mark in marks if isinstance(mark, ast.Call)]
    if [isinstance(f, ast.Name) and scope.get(f.id) is kernel for f in called] != [True] * len(
        marks
    ) or len(marks) > 1:
        report(node, "nothing but `@kernel(...)` stands over a kernel")
    given = node.args
    if given.vararg or given.kwarg or given.defaults or given.kwonlyargs or given.posonlyargs:
        report(node, "arguments are written out, without defaults")
    for argument in given.args:
        if argument.annotation is None:
            report(argument, f"argument {argument.arg!r} has no type")
    if node.returns is None:
        report(node, "the result has no type")
    if getattr(node, "type_params", None):
        report(node, "no type parameters: a kernel has one kind of each argument")
    for part, kind in hints(function).items():
        if not is_kind(kind):
            said = "the result" if part == "return" else f"argument {part!r}"
            report(
                node,
                f"the type of {said}: float, int, bool or a record of these without behaviour; it is "
                f"{getattr(kind, '__name__', kind)}",
            )
    for what in differing(node, hints(function), scope):
        report(node, f"{what} is not the one that is written: {PLAIN}")


class Body:
    """Checks the statements of a function, tracking the kinds of its locals."""

    def __init__(self, function: types.FunctionType, kinds: Kinds, report: Report) -> None:
        hints = get_type_hints(function)
        self.result = hints.pop("return")
        self.arguments: dict[str, Kind] = hints
        self.kinds = kinds
        self.report = report

    def check(self, node: ast.FunctionDef) -> None:
        """Report every statement that is outside of the subset."""
        body = node.body[1:] if ast.get_docstring(node) else node.body
        if self._block(body, dict(self.arguments)) is not None:
            self.report(node, "a way through it ends without `return`")

    def _block(self, body: list[ast.stmt], names: dict[str, Kind]) -> dict[str, Kind] | None:
        """The locals after these statements; None if every path has returned."""
        for number, statement in enumerate(body):
            try:
                after = self._statement(statement, names)
            except Refused as refused:
                self.report(refused.node, refused.message)
                after = names
            if after is None:
                if number + 1 < len(body):
                    self.report(body[number + 1], "nothing reaches this")
                return None
            names = after
        return names

    def _statement(self, node: ast.stmt, names: dict[str, Kind]) -> dict[str, Kind] | None:
        if isinstance(node, ast.Return):
            if node.value is None:
                raise Refused(node, "return a value")
            kind = self.kinds.of(node.value, names)
            if not fits(kind, self.result):
                raise Refused(node, f"returns {shown(kind)}, its type says {shown(self.result)}")
            return None
        if isinstance(node, ast.If):
            self.kinds.truth(node.test, names)
            ways = [self._block(b, dict(names)) for b in (node.body, node.orelse)]
            return self._joined(node, [way for way in ways if way is not None])
        if isinstance(node, ast.Assign):
            return {**names, **self._assigned(node, names)}
        if isinstance(node, ast.For) and self.kinds.several and not node.orelse:
            return self._repeated(node, names)
        raise Refused(
            node, f"no {type(node).__name__.lower()} here: {INSTEAD.get(type(node), STATEMENTS)}"
        )

    def _repeated(self, node: ast.For, names: dict[str, Kind]) -> dict[str, Kind] | None:
        """The locals after a loop over written values, of which there is at least one."""
        before, rounds = names, 0
        while True:
            after = self._block(node.body, {**before, **self.kinds.items(node, before)})
            if after is None:
                raise Refused(node, "a loop goes through all its values: return after it")
            joined = self._joined(node, [before, after]) or {}
            if all(joined.get(name) == kind for name, kind in before.items()):
                return {**after, **joined}
            rounds += 1
            # a number that grows in each pass has no written bound
            grown = [n for n in joined if rounds > 1 and joined[n] != before[n]]
            before = joined | {n: int for n in grown if isinstance(joined[n], Literal)}

    def _joined(
        self, node: ast.If | ast.For, ways: list[dict[str, Kind]]
    ) -> dict[str, Kind] | None:
        if len(ways) < 2:
            return ways[0] if ways else None
        joined = {}
        for name in ways[0].keys() & ways[1].keys():
            both = merged(ways[0][name], ways[1][name])
            if both is None:
                what = f"{shown(ways[0][name])} here and {shown(ways[1][name])} there"
                raise Refused(node, f"{name!r} is {what}: give each a name of its own")
            joined[name] = both
        return joined

    def _assigned(self, node: ast.Assign, names: dict[str, Kind]) -> dict[str, Kind]:
        if len(node.targets) != 1:
            raise Refused(node, "assign one name at a time")
        target = node.targets[0]
        parts = target.elts if isinstance(target, ast.Tuple) else []
        if parts and isinstance(node.value, ast.Tuple) and self.kinds.several:
            given = [self.kinds.of(value, names) for value in node.value.elts]
            return self._taken_apart(node, parts, given, names)
        kind = self.kinds.of(node.value, names)
        if isinstance(target, ast.Name):
            self._keeps(node, target.id, names.get(target.id), kind)
            return {target.id: kind}
        if isinstance(target, ast.Attribute):
            raise Refused(node, "records are not changed: make a new one")
        fields = list(get_type_hints(kind).values()) if hasattr(kind, "_fields") else []
        return self._taken_apart(node, parts, fields, names)

    def _taken_apart(
        self, node: ast.Assign, parts: list[ast.expr], kinds: list[Kind], names: dict[str, Kind]
    ) -> dict[str, Kind]:
        if not parts or len(parts) != len(kinds):
            raise Refused(node, "assign to a name, or a record to as many names as it has fields")
        made: dict[str, Kind] = {}
        for part, kind in zip(parts, kinds, strict=True):
            if not isinstance(part, ast.Name) or part.id in made:
                raise Refused(node, "a record is taken apart into names, each once")
            self._keeps(node, part.id, names.get(part.id), kind)
            made[part.id] = kind
        return made

    def _keeps(self, node: ast.Assign, name: str, old: Kind | None, new: Kind) -> None:
        if old is not None and merged(old, new) is None:
            raise Refused(node, f"{name!r} was {shown(old)}: give {shown(new)} another name")


def _stored(name: ast.Name) -> bool:
    return isinstance(name.ctx, ast.Store)


def lint_all(names: Container[str] | None = None) -> list[Finding]:
    """Lint every registered kernel, and every step and finish of a fold; names: only these."""
    found = []
    for entry in REGISTRY.values():
        if names is not None and entry.name not in names:
            continue
        if entry.kind == "kernel":
            found += lint(entry.function)
        if isinstance(entry.function, Fold):
            for part in entry.function.kernels:
                known = entry_of(part)
                if known is None or known.kind != "kernel":
                    found.append(Finding(entry.name, 1, f"{part.__name__} is no kernel"))
    return found
