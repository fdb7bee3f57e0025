"""Numbers that a theorem's statement computes by itself must be computed exactly.

Where a theorem gives a function plain numbers, Python computes with them and the solver does not see it: `1 / 49 * 49
!= 1` is true of doubles but false. Symbolic values, fractions and integers are exact, so only doubles are a problem.
A double mixed with symbolic values is refused anyway; the rest is found here. A claim in which a double could arise
is stated once more, with functions that check every value that they compute. This covers the claim and its file; a
function of another file that is called without being lifted is not looked into.
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
"""Operations that may round. A double that is only named or compared stands for the rational that it is."""
HARMLESS = (abs, min, max, len, all, any, sum, range, bool, int, tuple, isinstance, zip, enumerate)
"""Functions that return no double unless they are given one."""


class Inexact(BadInput):
    """A statement of a theorem computed a double."""


class _Look:
    """Returns a value unchanged; raises Inexact for a double. An object, not a function, so that it is not lifted."""

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
    """Wraps every computed value in `look`."""

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
    # defaults are taken from the function object
    node.args.defaults, node.args.kw_defaults = [], [None] * len(node.args.kwonlyargs)
    for argument in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs):
        argument.annotation = None
    return node


def watching(function: types.FunctionType) -> types.FunctionType:
    """The same function, raising Inexact wherever it computes a double.

    A function that cannot compute one is returned as it is. Raises Inexact if the source of another function is
    missing.
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
    """The claim with its file's functions, all instrumented."""
    made = {name: watching(function) for name, function in own.items()}
    whole = watching(claim)
    for function in (whole, *made.values()):
        if "_look" in function.__globals__:
            function.__globals__.update(made)
    return whole


def _plain(value: Any, kinds: Any = int | float | Fraction) -> bool:
    """Whether the value contains a plain number of these kinds."""
    if isinstance(value, tuple | list):
        return any(_plain(part, kinds) for part in value)
    return isinstance(value, kinds) and not isinstance(value, bool)


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """The code object and those of the comprehensions and functions in it."""
    yield code
    for part in code.co_consts:
        if isinstance(part, types.CodeType):
            yield from _codes(part)


def _divides(code: types.CodeType) -> bool:
    """Whether the code contains a division, a power, or a double."""
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
    """The objects that the function can reach beside its arguments."""
    scope = vars(builtins) | function.__globals__
    kept = [cell.cell_contents for cell in function.__closure__ or ()]
    defaults = [*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values()]
    return [*(scope.get(name) for name in _names(function)), *kept, *defaults]


@functools.cache
def _could(function: types.FunctionType) -> bool:
    """Whether the function could make a double of integers and fractions."""
    kinds = types.ModuleType | types.BuiltinFunctionType | type
    return _divides(function.__code__) or any(
        isinstance(value, kinds)
        and not any(value is harmless for harmless in HARMLESS)
        and not (isinstance(value, type) and issubclass(value, tuple))
        for value in _used(function)
    )


@functools.cache
def _owns(function: types.FunctionType) -> bool:
    """Whether the function has a double available that no argument brought."""
    constants = [code.co_consts for code in _codes(function.__code__)]
    return _plain((*_used(function), *constants), float | complex)


@functools.cache
def _literals(function: types.FunctionType) -> bool:
    """Whether some operation, call or assignment in the function reads none of its locals, or a written number is the
    value of something on some way: of a field, in a loop, by `if` within an expression."""
    node = _definition(function)
    names = function.__code__.co_varnames

    def alone(part: ast.AST) -> bool:
        loaded = [n for n in ast.walk(part) if isinstance(n, ast.Name) and n.id in names]
        return not any(isinstance(name.ctx, ast.Load) for name in loaded)

    if node is None:
        return True
    beside: set[int] = set()  # numbers that become a term with what they stand beside
    for part in ast.walk(node):
        operands = _operands(part)
        if isinstance(part, ast.Return) or not all(map(alone, operands)):
            beside |= set(map(id, operands))
    kinds = ast.BinOp | ast.Assign | ast.AnnAssign | ast.Call
    return any(
        (isinstance(n, kinds) and alone(n)) or (_is_number(n, function) and id(n) not in beside)
        for n in ast.walk(node)
    )


def _operands(node: ast.AST) -> list[ast.expr]:
    """The operands of an operation or comparison, or of min or max; what a function returns, which is joined."""
    match node:
        case ast.BinOp(left=left, right=right):
            return [left, right]
        case ast.Compare(left=left, comparators=more):
            return [left, *more]
        case ast.Call(func=ast.Name(id="min" | "max"), args=args):
            return args
        case ast.Return(value=ast.expr() as value):
            return list(_ways(value))
    return []


def _ways(value: ast.expr) -> Iterator[ast.expr]:
    """What a value is on each way through its conditions."""
    if isinstance(value, ast.IfExp):
        yield from (*_ways(value.body), *_ways(value.orelse))
    else:
        yield value


def _is_number(node: ast.AST, function: types.FunctionType) -> bool:
    """Whether a node is a written number or the name of one."""
    if isinstance(node, ast.Name | ast.Attribute) and isinstance(node.ctx, ast.Load):
        name = node.id if isinstance(node, ast.Name) else node.attr
        return _plain(function.__globals__.get(name))
    return isinstance(node, ast.Constant) and _plain(node.value)


def doubtful(visits: Iterable[Visit]) -> bool:
    """Whether a double could have arisen in what was lifted; False only where none did."""
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
    """Raise Inexact if a claim, which made these visits, computed with a double somewhere.

    state: states the claim, or a claim in its place. Does nothing where no double can have arisen.
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
