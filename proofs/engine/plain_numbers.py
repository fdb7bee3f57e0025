"""Numbers that a theorem's statement computes by itself must be computed exactly.

Where a theorem gives a function plain numbers, Python computes with them, and no solver sees it:
`1 / 49 * 49 != 1` is true of doubles, and false. Symbolic values, fractions and integers are exact,
so nothing is wrong unless a double comes up. Mixed with symbolic values a double is refused as it
is; here the rest is looked for. A claim in which a double could come up is stated once more, with
functions that look at every value that they compute. The lines of the claim and of its file are
among them; a function of another file that is called without being lifted is not looked into.
"""

from __future__ import annotations

import ast
import builtins
import copy
import dis
import functools
import inspect
import types
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any

from cratous.core.kernel.sources import text_of
from cratous.proofs.engine.lift import REPLACED, Visit
from cratous.spec.errors import BadInput

COMPUTED = (ast.BinOp, ast.UnaryOp, ast.Call)
"""What rounds. A double that is only named or compared is the rational that it is."""
HARMLESS = (abs, min, max, len, all, any, sum, range, bool, int, tuple, isinstance, zip, enumerate)
"""What gives no double unless it is given one."""


class Inexact(BadInput):
    """A double came up in what a theorem states."""


class _Look:
    """Hands on a value; raises Inexact for a double. No function, so that it is not lifted."""

    def __init__(self, function: Callable[..., Any], texts: Sequence[str]) -> None:
        self.function, self.texts = function, texts

    def __call__(self, value: Any, number: int) -> Any:
        if _plain(value, float | complex):
            module = self.function.__module__.removeprefix("cratous.")
            raise Inexact(
                f"`{self.texts[number]}` is computed in doubles, not in real numbers",
                where=f"{module}.{self.function.__name__}",
                expected="symbolic numbers (`c.real(...)` and a premise), or fractions.Fraction",
                got=repr(value),
            )
        return value


class _Watching(ast.NodeTransformer):
    """Puts every value that is computed through `look`."""

    def __init__(self, look: str) -> None:
        self.look = look
        self.texts: list[str] = []

    def visit(self, node: Any) -> Any:
        if isinstance(node, ast.pattern):
            return node
        if isinstance(node, ast.AugAssign):
            old = copy.deepcopy(node.target)
            old.ctx = ast.Load()
            value = ast.BinOp(old, node.op, node.value)
            node = ast.copy_location(ast.Assign([node.target], value), node)
        if not isinstance(node, COMPUTED):
            return self.generic_visit(node)
        self.texts.append(ast.unparse(node))
        number = ast.Constant(len(self.texts) - 1)
        inner: Any = self.generic_visit(node)
        call = ast.Call(ast.Name(self.look, ast.Load()), [inner, number], [])
        return ast.copy_location(call, node)


def _definition(function: Callable[..., Any]) -> ast.FunctionDef | None:
    """The function's syntax without decorators and annotations; None if it cannot be read."""
    try:
        node = ast.parse(text_of(function)).body[0]
    except (OSError, TypeError, SyntaxError):
        return None
    if not isinstance(node, ast.FunctionDef):
        return None
    node.decorator_list, node.returns = [], None
    # the defaults are those of the function that is there
    node.args.defaults, node.args.kw_defaults = [], [None] * len(node.args.kwonlyargs)
    for argument in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs):
        argument.annotation = None
    return node


def watching(function: types.FunctionType) -> types.FunctionType:
    """The same function, but Inexact is raised where it computes a double.

    A function that could make none stays as it is; Inexact if the source of another is not there.
    """
    node = _definition(function)
    if node is None:
        if not _could(function):
            return function
        raise Inexact(
            "plain numbers are given to a function whose source cannot be read",
            where=function.__name__,
            expected="a function written with `def` in a file, or symbolic numbers",
        )
    watch = _Watching("_look")
    node.body = [watch.visit(statement) for statement in node.body]
    module = ast.fix_missing_locations(ast.Module([node], []))
    scope = function.__globals__ | dict(inspect.getclosurevars(function).nonlocals)
    scope["_look"] = _Look(function, watch.texts)
    exec(compile(module, inspect.getsourcefile(function) or "?", "exec"), scope)
    made: types.FunctionType = scope[function.__name__]
    made.__defaults__, made.__kwdefaults__ = function.__defaults__, function.__kwdefaults__
    return made


def _together(claim: types.FunctionType, own: dict[str, types.FunctionType]) -> types.FunctionType:
    """The claim, watched, with the functions of its file, watched as well."""
    made = {name: watching(function) for name, function in own.items()}
    whole = watching(claim)
    for function in (whole, *made.values()):
        if "_look" in function.__globals__:
            function.__globals__.update(made)
    return whole


def _plain(value: Any, kinds: Any = int | float | Fraction) -> bool:
    """There is a number of these kinds in the value, not a symbolic one."""
    if isinstance(value, tuple | list):
        return any(_plain(part, kinds) for part in value)
    return isinstance(value, kinds) and not isinstance(value, bool)


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """The code and that of the comprehensions and functions in it."""
    yield code
    for part in code.co_consts:
        if isinstance(part, types.CodeType):
            yield from _codes(part)


def _divides(code: types.CodeType) -> bool:
    """Written in it is a division, a power, or a double."""
    return any(
        _plain(part.co_consts, float | complex)
        or any(
            i.opname == "BINARY_OP" and i.argrepr.rstrip("=") in ("/", "**")
            for i in dis.get_instructions(part)
        )
        for part in _codes(code)
    )


def _names(function: types.FunctionType) -> set[str]:
    return {name for code in _codes(function.__code__) for name in code.co_names}


def _used(function: types.FunctionType) -> list[Any]:
    """What the function can get at beside its arguments."""
    scope = vars(builtins) | function.__globals__
    kept = [cell.cell_contents for cell in function.__closure__ or ()]
    defaults = [*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values()]
    return [*(scope.get(name) for name in _names(function)), *kept, *defaults]


@functools.cache
def _could(function: types.FunctionType) -> bool:
    """The function could make a double of integers and fractions."""
    kinds = types.ModuleType | types.BuiltinFunctionType | type
    return _divides(function.__code__) or any(
        isinstance(value, kinds)
        and not any(value is harmless for harmless in HARMLESS)
        and not (isinstance(value, type) and issubclass(value, tuple))
        for value in _used(function)
    )


@functools.cache
def _owns(function: types.FunctionType) -> bool:
    """The function has a double at hand that no argument brought."""
    constants = [code.co_consts for code in _codes(function.__code__)]
    return _plain((*_used(function), *constants), float | complex)


@functools.cache
def _literals(function: types.FunctionType) -> bool:
    """The function computes with what it has written down alone, or keeps it under a name."""
    node = _definition(function)
    names = function.__code__.co_varnames

    def alone(part: ast.AST) -> bool:
        loaded = [n for n in ast.walk(part) if isinstance(n, ast.Name) and n.id in names]
        return not any(isinstance(name.ctx, ast.Load) for name in loaded)

    kinds = ast.BinOp | ast.Assign | ast.AnnAssign | ast.Call
    return node is None or any(isinstance(n, kinds) and alone(n) for n in ast.walk(node))


def doubtful(visits: Iterable[Visit]) -> bool:
    """Could a double have come up in what was lifted? Never False where one did."""
    seen = [v for v in visits if isinstance(v.function, types.FunctionType)]
    given = [v.function for v in seen if _plain(v.lifted.value)]
    names = {function.__name__ for function in given}

    def could(visit: Visit) -> bool:
        known = visit.function
        assert isinstance(known, types.FunctionType)
        numbers = _plain(visit.args) or _literals(known)
        # by a name of its own, or as an attribute of a module
        calls = any(value is one for value in _used(known) for one in given)
        return _could(known) and (numbers or calls or not names.isdisjoint(_names(known)))

    return any(_plain(v.args, float | complex) or _owns(v.function) or could(v) for v in seen)


def hold(
    state: Callable[[Callable[..., Any]], Any],
    claim: Callable[..., Any],
    visits: Sequence[Visit],
) -> None:
    """Raises Inexact if a claim, which made these visits, was computed with a double somewhere.

    state: states the claim, or one that stands for it. Nothing is done where no double can have
    come up.
    """
    assert isinstance(claim, types.FunctionType)
    own = {
        name: value
        for name, value in claim.__globals__.items()
        if isinstance(value, types.FunctionType) and value.__module__ == claim.__module__
    }
    alone = any(_divides(f.__code__) or _owns(f) for f in (claim, *own.values()))
    if not alone and not doubtful(visits):
        return
    functions = {v.function for v in visits if isinstance(v.function, types.FunctionType)}
    watched = {function: watching(function) for function in functions}
    REPLACED.update(watched)
    try:
        state(_together(claim, own))
    finally:
        for function in watched:
            del REPLACED[function]
