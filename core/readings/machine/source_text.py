"""The compiler's input for a function: its text with everything it uses, as written.

Everything that is collected (functions, records, constants, modules) appears in the text under a unique name derived
from its qualified one, and the references of each function are renamed by their meaning in its own module. So two
helpers, records or constants of one bare name keep their own meanings.
"""

from __future__ import annotations

import ast
import builtins
import dis
import functools
import inspect
import math
import types
from collections.abc import Callable
from itertools import zip_longest
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np

from cratous.core.kernel import Fold, entry_of, qualified
from cratous.core.kernel.sources import text_of
from cratous.spec.errors import BadInput

NUMBERS = (bool, int, float)
LIBRARIES = ("math", "numpy")
"""Libraries known to the compiler itself."""


class SourceText:
    """A text under construction, callees first. flags: the compiler's, put before each function.

    entries: other flags, by function: for those called from Python.
    """

    def __init__(self, flags: str, entries: dict[Callable[..., Any], str] | None = None) -> None:
        self.flags = flags
        self.entries = entries or {}
        self.parts: list[str] = ["from typing import NamedTuple", "from numba import njit"]
        self._names: dict[str, str] = {}
        self._values: dict[str, Any] = {}

    @property
    def text(self) -> str:
        """Everything collected so far."""
        return "\n\n".join([*self.parts, ""])

    def add(self, item: Any) -> str:
        """Collect a function or record with everything it uses; returns its name in the text."""
        where = f"{item.__module__}.{item.__qualname__}"
        if "<locals>" in where and inspect.isfunction(item) and item.__closure__:
            raise BadInput("a function within another one cannot be compiled", item=where)
        name, new = self._name(where, item)
        if new:
            make = self._record if inspect.isclass(item) else self._function
            self.parts.append(make(item, name))
        return name

    def add_arguments(self, function: Callable[..., Any]) -> None:
        """Add the fields of the records that a function takes as arguments.

        Machine code reads them by position, so code compiled for other fields must not be found in the cache.
        """
        hints = get_type_hints(inspect.unwrap(function))
        self.parts += sorted({line for kind in hints.values() for line in _fields(kind)})

    def _name(self, where: str, value: Any) -> tuple[str, bool]:
        """A unique name, and whether it is new; two values of one name are an error."""
        if where in self._names:
            old = self._values[where]
            if old is not value and (type(old) is not type(value) or repr(old) != repr(value)):
                raise BadInput(
                    "two values have one name",
                    item=where,
                    expected="one",
                    got=f"{old!r}, {value!r}",
                )
            return self._names[where], False
        plain = "__".join(where.replace("<locals>", "locals").split("."))
        name, taken = plain, set(self._names.values())
        while name in taken:
            name += "_"
        self._names[where], self._values[where] = name, value
        return name, True

    # -- functions ------------------------------------------------------------------------
    def _function(self, function: Callable[..., Any], name: str) -> str:
        node = _definition(function)
        code = inspect.unwrap(function).__code__  # while its calls are counted it stands behind
        own = f"{function.__module__}.{function.__qualname__}"
        renamed: dict[str, str] = {}
        for used in sorted(_globals(code)):
            if _runs_part(function.__globals__.get(used)):
                continue  # what runs a part of a loop is the compiler's here
            if used in function.__globals__:
                renamed[used] = self._reference(function, used, own)
            elif not hasattr(builtins, used):
                raise BadInput(f"{used!r} is not defined", where=own)
        both = {*renamed, *renamed.values()} & _locals(code)
        if both:
            raise BadInput(
                f"{min(both)!r} is a name of the module and of the function too",
                where=own,
                expected="two names, so that it can be compiled",
            )
        made = ast.fix_missing_locations(_Renaming(self, function, renamed).visit(node))
        made.name = name
        return f"@{self.entries.get(function, self.flags)}\n{ast.unparse(made)}"

    def _reference(self, function: Callable[..., Any], used: str, own: str) -> str:
        """The name in the text for what a function's module calls `used`."""
        value = function.__globals__[used]
        return self.reference(value, f"{function.__module__}.{used}", own)

    def reference(self, value: Any, where: str, user: str) -> str:
        """The name in the text of a value; where: its qualified name; user: who uses it."""
        if isinstance(value, types.ModuleType):
            if value.__name__.split(".")[0] not in LIBRARIES:
                return where  # an attribute of it is meant (`_Renaming`)
            name, new = self._name(f"module.{value.__name__}", value)
            if new:
                self.parts.insert(0, f"import {value.__name__} as {name}")
            return name
        if _number(value):
            name, new = self._name(where, value)
            if new:
                self.parts.append(f"{name} = {_literal(value)}")
            return name
        code = inspect.isfunction(value) or (inspect.isclass(value) and hasattr(value, "_fields"))
        if code and _ours(value, user):
            return self.add(value)
        home = str(getattr(value, "__module__", "") or "").split(".")[0]
        if home in LIBRARIES and hasattr(value, "__name__"):
            name, new = self._name(f"{value.__module__}.{value.__name__}", value)
            if new:
                line = f"from {value.__module__} import {value.__name__} as {name}"
                self.parts.insert(0, line)
            return name
        plain = str(getattr(value, "__name__", ""))
        if getattr(builtins, plain, None) is value:
            return plain
        raise BadInput(
            f"{where.rpartition('.')[2]!r} cannot be compiled",
            where=user,
            expected="functions, NamedTuples and numbers of this package, kernels, numpy and math",
            got=f"a {'fold' if isinstance(value, Fold) else type(value).__name__}",
        )

    # -- records --------------------------------------------------------------------------
    def _record(self, record: Any, name: str) -> str:
        """A NamedTuple, and a function of the name that fixes the types of its fields.

        Kernels may write the integer literal 0 for a real field; machine code needs one type.
        """
        fields = get_type_hints(record)
        lines, casts = [f"class {name}_(NamedTuple):"], []
        for field, kind in fields.items():
            if hasattr(kind, "_fields"):
                self.add(kind)
            plain = kind in NUMBERS
            lines.append(f"    {field}: {kind.__name__ if plain else 'object'}")
            casts.append(f"{kind.__name__}({field})" if plain else field)
        lines += ["", "", f"@{self.flags}", f"def {name}({', '.join(fields)}):"]
        return "\n".join([*lines, f"    return {name}_({', '.join(casts)})"])


class _Renaming(ast.NodeTransformer):
    """Renames a function's references to their names in the text, and removes annotations."""

    def __init__(self, text: SourceText, function: Any, renamed: dict[str, str]) -> None:
        self.text, self.function, self.renamed = text, function, renamed

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.stmt:
        node.returns = None
        return self.generic_visit(node)  # type: ignore[return-value]

    def visit_arg(self, node: ast.arg) -> ast.arg:
        return ast.arg(node.arg)

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return ast.Name(self.renamed.get(node.id, node.id), node.ctx)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        """A call of our own code with number literals converted to the callee's types, so that it is compiled only
        once. `within(f, n)(...)` is `f(...)`.
        """
        chosen = node.func.func if isinstance(node.func, ast.Call) else None
        if isinstance(chosen, ast.Name) and _runs_part(self.function.__globals__.get(chosen.id)):
            node.func = node.func.args[0]  # type: ignore[attr-defined]
        called = self.function.__globals__.get(getattr(node.func, "id", ""))
        local = getattr(node.func, "id", "") not in self.renamed
        kinds = {} if local or called is None else _parameters(called)
        if kinds and not any(isinstance(one, ast.Starred) for one in node.args):
            each = zip_longest(node.args, [*kinds.values()][: len(node.args)])
            node.args = [self._typed(one, kind) for one, kind in each]
            for word in node.keywords:
                word.value = self._typed(word.value, kinds.get(word.arg or ""))
        return self.generic_visit(node)  # type: ignore[return-value]

    def _typed(self, given: ast.expr, kind: Any) -> ast.expr:
        """A number literal converted to this type; anything else unchanged."""
        if isinstance(given, ast.Tuple) and get_origin(kind) is tuple:
            parts = get_args(kind)
            if len(parts) != len(given.elts) or ... in parts:
                return given
            each = zip(given.elts, parts, strict=True)
            return ast.Tuple([self._typed(*one) for one in each], ast.Load())
        value: Any = None
        sign = isinstance(given, ast.UnaryOp) and isinstance(given.op, ast.USub)
        written = given.operand if isinstance(given, ast.UnaryOp) and sign else given
        if isinstance(written, ast.Constant):
            value = written.value
            if sign and type(value) is int and value:
                value = -value
            elif sign:
                return given
        elif isinstance(given, ast.Name) and given.id in self.renamed:
            value = self.function.__globals__[given.id]
        if type(value) is int and abs(value) > EXACT:
            return given
        if kind is float and type(value) is int and value:  # a 0 has no sign, which a 0.0 has
            return ast.Constant(float(value))
        if kind not in _TYPED or type(value) is not kind:
            return given
        home = self.text.reference(np, "numpy", "numpy")
        return ast.Call(
            ast.Attribute(ast.Name(home, ast.Load()), _TYPED[kind], ast.Load()),
            [ast.Constant(value)], [],
        )  # fmt: skip

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        if isinstance(node.value, ast.Name) and node.value.id in self.renamed:
            module = self.function.__globals__[node.value.id]
            library = isinstance(module, types.ModuleType) and module.__name__.split(".")[0]
            if library and library not in LIBRARIES:
                where = f"{module.__name__}.{node.attr}"
                user = f"{self.function.__module__}.{self.function.__qualname__}"
                found = self.text.reference(getattr(module, node.attr), where, user)
                return ast.Name(found, ast.Load())
        return self.generic_visit(node)  # type: ignore[return-value]

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.stmt | None:
        if node.value is None:
            return None
        return self.generic_visit(ast.Assign([node.target], node.value))  # type: ignore[return-value]


EXACT = 2**53
"""Every integer up to this is exactly a double."""
_TYPED = {int: "int64", bool: "bool_"}
"""Conversions of a number literal, so that the compiler sees only its type."""


@functools.cache
def _parameters(called: Any) -> dict[str, Any]:
    """The types of a function's parameters or a record's fields, by name; empty for code that is not ours."""
    if inspect.isclass(called) and hasattr(called, "_fields"):
        return get_type_hints(called)
    if not inspect.isfunction(called):
        return {}
    plain = inspect.unwrap(called)
    try:
        hints = get_type_hints(plain)
    except NameError:  # types that only the checker imports
        return {}
    return {name: hints.get(name) for name in inspect.signature(plain).parameters}


def _definition(function: Callable[..., Any]) -> ast.FunctionDef:
    """The function's syntax without decorators and docstring."""
    node = ast.parse(text_of(function)).body[0]
    if not isinstance(node, ast.FunctionDef):
        raise BadInput("this is no function definition", item=function.__qualname__)
    node.decorator_list = []
    if ast.get_docstring(node) is not None:
        node.body = node.body[1:] or [ast.Pass()]
    return node


def _fields(kind: Any) -> list[str]:
    """A line for a record and for each record in it; empty for other types."""
    if not (inspect.isclass(kind) and hasattr(kind, "_fields")):
        return []
    parts = get_type_hints(kind)
    inner = [line for part in parts.values() for line in _fields(part)]
    return [f"# {kind.__module__}.{kind.__qualname__}: {', '.join(kind._fields)}", *inner]


def _codes(code: types.CodeType) -> list[types.CodeType]:
    inner = [part for part in code.co_consts if isinstance(part, types.CodeType)]
    return [code, *[one for part in inner for one in _codes(part)]]


def _globals(code: types.CodeType) -> set[str]:
    """The names that a function looks up in its module, in inner code too."""
    return {
        str(step.argval)
        for one in _codes(code)
        for step in dis.get_instructions(one)
        if step.opname in ("LOAD_GLOBAL", "LOAD_NAME")
    }


def _locals(code: types.CodeType) -> set[str]:
    return {
        n for one in _codes(code) for n in (*one.co_varnames, *one.co_cellvars, *one.co_freevars)
    }


def _number(value: Any) -> bool:
    if isinstance(value, tuple):
        return type(value) is tuple and all(_number(part) for part in value)
    return type(value) in NUMBERS


def _literal(value: Any) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(map(_literal, value))}{',' if len(value) == 1 else ''})"
    return repr(value) if math.isfinite(value) else f"float({str(value)!r})"


def _runs_part(value: Any) -> bool:
    """Whether it is what chooses how a part of a loop runs (`core.readings.tiered.within`)."""
    return inspect.isfunction(value) and qualified(value) == "cratous.core.readings.tiered.within"


def _ours(value: Any, user: str) -> bool:
    """Whether it belongs to the product or the user's own package, or is a registered kernel."""
    home = value.__module__.split(".")[0]
    return home in ("cratous", user.split(".")[0]) or entry_of(value) is not None
