"""Whether a kernel checks a driver's output before anyone can use it: determined from the source text.

A driver is re-checked by a kernel if it returns no value that the kernel has not accepted. Each `return` gives names
that a condition on the path to it has passed to the kernel, or it is a refusal: it raises, or returns None or a
`Refusal`. The condition is a call of the kernel or fold, or of a function of `core` that is true only where the
kernel accepted. The values have immutable types, so what was checked is what is returned. How the value was computed
does not matter; what acceptance means is given by the kernel's definition.
"""

from __future__ import annotations

import ast
import dataclasses
import sys
import types
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Union, get_args, get_origin, get_type_hints

from cratous.core.kernel import Entry, Refusal, entry_of
from cratous.core.kernel.sources import ours, text_of

Names = frozenset[str]
Said = Mapping[str, Names]
"""For each name, the kernels that have accepted its present value."""
NOBODY: Names = frozenset()
DEPTH = 4
"""The depth to which nested calls are followed to find the accepting kernel."""


def rechecked_by(entry: Entry) -> tuple[str, ...]:
    """The kernels and folds that check every value that a driver returns; empty if there are none."""
    function = entry.function
    if entry.kind != "driver" or not isinstance(function, types.FunctionType):
        return ()
    node = _definition(function)
    own = vars(sys.modules[function.__module__]).get(function.__name__) is function
    if node is None or not own or not _is_fixed(_result(function)):
        return ()  # what stands under its name is not what is written, or it may change after a check
    reader = _Reader(node, function.__globals__)
    reader.block(node.body, {})
    return tuple(sorted(frozenset.intersection(*reader.results))) if reader.results else ()


class _Reader:
    """Follows a driver's statements. results: for each return other than a refusal, the kernels that accepted the
    value."""

    def __init__(self, node: ast.FunctionDef, scope: Mapping[str, Any]) -> None:
        arguments, bound = _arguments(node), _bound(node)
        self.scope = _without(scope, arguments | bound)
        self.given = arguments - bound
        self.results: list[Names] = []

    def block(self, body: Iterable[ast.stmt], said: Said) -> Said | None:
        """Read statements in order; returns who has accepted what after them, None if they do not complete."""
        now: Said = said
        for statement in body:
            match statement:
                case ast.Return(value=value):
                    self._returned(value, now)
                    return None
                case ast.Raise():
                    return None
                case ast.If(test=test, body=yes, orelse=no):
                    # what the condition binds may have been accepted before
                    bound = _bound(test)
                    now = _without(now, bound)
                    true, false = put_to(test, self.scope), put_to(_denied(test), self.scope)
                    ways = (
                        self.block(yes, _more(now, _without(true, bound))),
                        self.block(no, _more(now, _without(false, bound))),
                    )
                    open_ways = [way for way in ways if way is not None]
                    if not open_ways:
                        return None
                    now = _common(open_ways)
                case ast.FunctionDef() | ast.ClassDef():
                    now = _without(now, {statement.name})
                case _:
                    # at the start of a loop nothing is known of the names that it binds
                    now = _without(now, _bound(statement))
                    for inner in _bodies(statement):
                        self.block(inner, now)
        return now

    def _returned(self, value: ast.expr | None, said: Said) -> None:
        if value is None or self._refuses(value):
            return
        parts = value.elts if isinstance(value, ast.Tuple) else [value]
        made: list[Names] = []
        for part in parts:
            if isinstance(part, ast.Name) and part.id in self.given:
                continue  # an argument that is returned unchanged
            # a constant, or a value built here, was not checked
            made.append(said.get(part.id, NOBODY) if isinstance(part, ast.Name) else NOBODY)
        self.results.append(frozenset.intersection(*made) if made else NOBODY)

    def _refuses(self, value: ast.expr) -> bool:
        match value:
            case ast.Constant(value=known):
                return known is None
            case ast.Call(func=ast.Name(id=name)):
                kind = self.scope.get(name)
                return isinstance(kind, type) and issubclass(kind, Refusal)
        return False


def put_to(test: ast.expr, scope: Mapping[str, Any], depth: int = 0) -> dict[str, Names]:
    """The names that kernels have accepted where a condition is true, with those kernels."""
    match test:
        case ast.UnaryOp(op=ast.Not(), operand=ast.UnaryOp(op=ast.Not(), operand=inner)):
            return put_to(inner, scope, depth)
        case ast.UnaryOp(op=ast.Not(), operand=ast.BoolOp(op=ast.Or(), values=parts)):
            return _all_put([_denied(part) for part in parts], scope, depth)
        case ast.BoolOp(op=ast.And(), values=parts):
            return _all_put(parts, scope, depth)
        case ast.Call(func=ast.Name(id="bool"), args=[inner], keywords=[]) if "bool" not in scope:
            return put_to(inner, scope, depth)
        case ast.Call(
            func=ast.Name(id="all"),
            args=[ast.GeneratorExp(elt=each, generators=[ast.comprehension(iter=over, ifs=[])])],
            keywords=[],
        ) if "all" not in scope:
            kernels = frozenset().union(*put_to(each, scope, depth).values())
            return dict.fromkeys(_names(over), kernels) if kernels else {}
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
            kernels = _yes_of(scope.get(name), depth)
            names = frozenset().union(*map(_handed, args))
            return dict.fromkeys(names, kernels) if kernels else {}
    return {}


def _all_put(parts: Iterable[ast.expr], scope: Mapping[str, Any], depth: int) -> dict[str, Names]:
    found: dict[str, Names] = {}
    for part in parts:
        found = _more(found, put_to(part, scope, depth))
    return found


def _yes_of(value: Any, depth: int) -> Names:
    """The kernels that have accepted where a call of this is true: itself, or those that it depends on."""
    entry = entry_of(value)
    if entry is not None:
        return NOBODY if entry.kind == "driver" else frozenset([entry.name])
    if depth >= DEPTH or not isinstance(value, types.FunctionType) or not _in_core(value):
        return NOBODY
    node = _definition(value)
    if node is None:
        return NOBODY
    scope = _without(value.__globals__, _arguments(node) | _bound(node))
    results = _truths(node.body, NOBODY, scope, depth + 1)
    return frozenset.intersection(*results) if results else NOBODY


def _in_core(function: Callable[..., Any]) -> bool:
    # in a package with kernels of its own, all folders but `spec`
    return ours(function) and function.__module__.split(".")[1:2] != ["spec"]


def _truths(
    body: Iterable[ast.stmt], known: Names, scope: Mapping[str, Any], depth: int
) -> list[Names]:
    """For each return of a function that may be true: the kernels that have accepted by then.

    known: those that have accepted on the path to here.
    """
    found: list[Names] = []
    for statement in body:
        match statement:
            case ast.Return(value=value):
                if not (isinstance(value, ast.Constant) and value.value is False):
                    found.append(known | _said_in(value, scope, depth))
                return found
            case ast.If(test=test, body=yes, orelse=no):
                found += _truths(yes, known | _said_in(test, scope, depth), scope, depth)
                found += _truths(no, known, scope, depth)
                if isinstance(yes[-1], ast.Return | ast.Raise) and not no:
                    known |= _said_in(_denied(test), scope, depth)
            case ast.FunctionDef() | ast.ClassDef():
                pass
            case _:
                for inner in _bodies(statement):
                    found += _truths(inner, known, scope, depth)
    return found


def _said_in(value: ast.expr | None, scope: Mapping[str, Any], depth: int) -> Names:
    if value is None:
        return NOBODY
    return frozenset().union(*put_to(value, scope, depth).values())


# ---- types that cannot change ------------------------------------------------------------------
PLAIN = (int, float, bool, str, type(None))


def _result(function: Callable[..., Any]) -> Any:
    try:
        return get_type_hints(function).get("return", Any)
    except (NameError, TypeError):
        return Any


def _is_fixed(kind: Any) -> bool:
    """Whether values of this type are immutable: numbers, and records and tuples of such."""
    if kind in PLAIN:
        return True
    if get_origin(kind) in (Union, types.UnionType):
        return all(map(_is_fixed, get_args(kind)))
    if get_origin(kind) is tuple:
        return all(_is_fixed(part) for part in get_args(kind) if part is not Ellipsis)
    if not isinstance(kind, type):
        return False
    frozen = dataclasses.is_dataclass(kind) and kind.__dataclass_params__.frozen  # type: ignore[attr-defined]
    if frozen or hasattr(kind, "_fields"):
        return all(map(_is_fixed, get_type_hints(kind).values()))
    return False


# ---- syntax --------------------------------------------------------------------------------------
def _definition(function: Callable[..., Any]) -> ast.FunctionDef | None:
    try:
        node = ast.parse(text_of(function)).body[0]
    except (OSError, SyntaxError):
        return None
    if not isinstance(node, ast.FunctionDef):
        return None
    # an inner function may change a name that was checked, and another one a name of the module
    no = (ast.Yield, ast.YieldFrom, ast.Global, ast.Nonlocal)
    return None if any(isinstance(n, no) for n in ast.walk(node)) else node


def _arguments(node: ast.FunctionDef) -> Names:
    a = node.args
    plain = [*a.posonlyargs, *a.args, *a.kwonlyargs]
    return frozenset(arg.arg for arg in [*plain, *filter(None, (a.vararg, a.kwarg))])


def _bound(node: ast.AST) -> Names:
    """Names that a statement may bind."""
    found = {
        n.id for n in ast.walk(node) if isinstance(n, ast.Name) and not isinstance(n.ctx, ast.Load)
    }
    for n in ast.walk(node):
        if n is not node and isinstance(n, ast.FunctionDef | ast.ClassDef):
            found.add(n.name)
        elif isinstance(n, ast.Import | ast.ImportFrom):
            found |= {(alias.asname or alias.name).split(".")[0] for alias in n.names}
        elif isinstance(n, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and n.name:
            found.add(n.name)
        elif isinstance(n, ast.MatchMapping) and n.rest:
            found.add(n.rest)
    return frozenset(found)


def _bodies(statement: ast.stmt) -> list[list[ast.stmt]]:
    """The blocks within a compound statement."""
    parts: list[Any] = [
        statement,
        *getattr(statement, "handlers", ()),
        *getattr(statement, "cases", ()),
    ]
    fields = ("body", "orelse", "finalbody")
    return [body for part in parts for name in fields if (body := getattr(part, name, None))]


def _names(node: ast.AST) -> Names:
    return frozenset(n.id for n in ast.walk(node) if isinstance(n, ast.Name))


def _handed(argument: ast.expr) -> Names:
    """The names whose values an argument hands on; not those from which it computes another value."""
    match argument:
        case ast.Name(id=name):
            return frozenset([name])
        case ast.Starred(value=inner) | ast.Attribute(value=inner):
            return _handed(inner)
        case ast.Tuple(elts=parts) | ast.List(elts=parts):
            return frozenset().union(*map(_handed, parts))
        case ast.ListComp(elt=each, generators=[ast.comprehension(iter=over, ifs=[]) as loop]):
            return _handed(over) if _handed(each) & _bound(loop.target) else NOBODY
    return NOBODY


def _denied(test: ast.expr) -> ast.expr:
    return ast.UnaryOp(ast.Not(), test)


def _without(said: Mapping[str, Any], names: Iterable[str]) -> dict[str, Any]:
    gone = set(names)
    return {name: value for name, value in said.items() if name not in gone}


def _more(said: Said, new: Said) -> dict[str, Names]:
    return {name: said.get(name, NOBODY) | new.get(name, NOBODY) for name in {*said, *new}}


def _common(ways: list[Said]) -> dict[str, Names]:
    """What all of these paths have in common."""
    shared = set.intersection(*[set(way) for way in ways])
    return {name: frozenset.intersection(*[way[name] for way in ways]) for name in shared}
