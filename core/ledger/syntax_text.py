"""What a piece of code says, and what it looks up outside itself, from its syntax tree.

The text omits what has no meaning at run time: comments, layout, docstrings and `pass`. The look-ups over-approximate
those at run time: a name that is not certainly local counts as one of the module, and an attribute counts by its name
alone, whatever object it belongs to.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

WORD = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")
PATTERN = re.compile(r"[\w.*]*[a-z][\w.*]*")
IDENTIFIERS = re.compile(r"[A-Za-z_][\w.]*")
SILENT = frozenset({"ctx", "type_comment", "kind", "type_ignores"})
BY_NAME = frozenset({"getattr", "setattr", "delattr", "hasattr"})
"""Functions that access an attribute by a written name, or else any attribute."""
ANY_ATTRIBUTE = frozenset({"vars", "attrgetter", "methodcaller", "__dict__", *BY_NAME})
"""Means of accessing attributes whose names are not written."""
REGISTERED = frozenset({"REGISTRY", "load_all"})
"""Means of accessing all registered items."""
ANYTHING = frozenset(
    {
        "eval", "exec", "open", "globals", "__import__", "importlib", "import_module", "__globals__",
        "read_text", "read_bytes", "environ", "getenv", "modules", "__subclasses__", *REGISTERED,
    }
)  # fmt: skip
"""Means of accessing any code or file, all registered items, or external state."""
OPENERS = frozenset({"os", "io", "gzip", "bz2", "lzma", "codecs", "tokenize", "builtins"})
"""Modules whose `open` counts even if not called; for other names it may be a record field."""
EVERY = "*"
"""Represents every attribute."""
MARKS = frozenset({"kernel", "fold"})
"""They name a definition, whose own key is stored beside the function's."""


@dataclass
class Reading:
    """The result of reading one piece of code.

    names: what it looks up outside itself, with the attributes that follow, as `module.name`; attributes: every
    attribute that it names; imports: (name, module, name there) of imports inside functions; strings: texts that
    could be names, in order, with `*` for parts known only at run time; rebinds: names of its module that it binds at
    run time; asks: the words of ANY_ATTRIBUTE and ANYTHING by which it looks something up.
    """

    parts: list[str] = field(default_factory=list)
    names: set[str] = field(default_factory=set)
    attributes: set[str] = field(default_factory=set)
    imports: set[tuple[str, str, str]] = field(default_factory=set)
    strings: list[str] = field(default_factory=list)
    rebinds: set[str] = field(default_factory=set)
    asks: set[str] = field(default_factory=set)

    @property
    def text(self) -> str:
        """The text of the code."""
        return "".join(self.parts)


def read(nodes: Iterable[ast.AST], package: list[str]) -> Reading:
    """Read some statements of one module; package: the base of its relative imports."""
    reader = _Reader(package)
    for node in nodes:
        reader.node(node)
    return reader.found


def silent(node: ast.AST) -> bool:
    """True iff it is a statement without effect: a docstring or `pass`."""
    text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    return text or isinstance(node, ast.Pass)


def module_of(node: ast.ImportFrom, package: list[str]) -> str:
    """The module that an import names, in full."""
    if not node.level:
        return node.module or ""
    up = package[: len(package) - node.level + 1]
    return ".".join([*up, *([node.module] if node.module else [])])


class _Reader:
    def __init__(self, package: list[str]) -> None:
        self.found, self.package = Reading(), package
        self.scopes: list[tuple[frozenset[str], frozenset[str]]] = []
        self.called: ast.expr | None = None

    def node(self, node: ast.AST) -> None:
        special = SPECIAL.get(type(node))
        if special is None:
            self.plain(node)
        else:
            special(self, node)

    def plain(self, node: ast.AST) -> None:
        write = self.found.parts.append
        write(f"{type(node).__name__}(")
        for name in node._fields:
            value = getattr(node, name, None)
            if name in SILENT or value is None or value == []:
                continue  # later versions of Python have more fields, which are empty
            write(f"{name}=")
            if isinstance(value, ast.AST):
                self.node(value)
            elif isinstance(value, list):
                self.several(value)
            else:
                write(f"{value!r},")
        write(")")

    def several(self, values: list[object]) -> None:
        write = self.found.parts.append
        write("[")
        for value in values:
            if not isinstance(value, ast.AST):
                write(f"{value!r},")
            elif not silent(value):
                self.node(value)
        write("]")

    # -- names ------------------------------------------------------------------------------------
    def name(self, node: ast.Name) -> None:
        self.found.parts.append(f"N{node.id},")
        self.look(node.id, (), isinstance(node.ctx, ast.Load))
        if node.id in BY_NAME and node is not self.called:
            self.found.asks.add(node.id)  # handed on: nobody sees what it is asked for

    def look(self, name: str, after: tuple[str, ...], asks: bool = True) -> None:
        for local, outer in reversed(self.scopes):
            if name in outer:
                break
            if name in local:
                return
        self.found.names.add(".".join((name, *after)))
        if asks:
            self.ask(name)

    def ask(self, name: str) -> None:
        if name in ANYTHING or (name in ANY_ATTRIBUTE and name not in BY_NAME):
            self.found.asks.add(name)

    def attribute(self, node: ast.Attribute) -> None:
        after: list[str] = []
        inner: ast.expr = node
        while isinstance(inner, ast.Attribute):
            after.insert(0, inner.attr)
            inner = inner.value
        self.found.attributes.update(after)
        root = inner.id if isinstance(inner, ast.Name) else ""
        for name in after:
            if self.counts(name, root, node):
                self.ask(name)
        self.found.parts.append(f"A{'.'.join(after)}(")
        if isinstance(inner, ast.Name):
            self.found.parts.append(f"N{inner.id},")
            self.look(inner.id, tuple(after))
        else:
            self.node(inner)
        self.found.parts.append(")")

    def counts(self, name: str, root: str, node: ast.Attribute) -> bool:
        """Whether an attribute may be a dynamic look-up rather than a field of the name."""
        if name == "open":
            return node is self.called or root in OPENERS or root[:1].isupper()
        if name in ("eval", "globals"):
            return root == "builtins"
        return name != "modules" or node is not self.called  # nobody calls `sys.modules`

    def call(self, node: ast.Call) -> None:
        called = node.func.attr if isinstance(node.func, ast.Attribute) else ""
        if isinstance(node.func, ast.Name):
            called = node.func.id
        if called in BY_NAME:
            given = node.args[1] if len(node.args) > 1 else None
            if isinstance(given, ast.Constant) and isinstance(given.value, str):
                self.found.attributes.add(given.value)
            elif called != "hasattr":
                self.found.asks.add(called)
        self.called = node.func
        if called not in MARKS:
            return self.plain(node)
        # a definition is identified by its contents, not by its location
        kept = [word for word in node.keywords if word.arg != "implements"]
        write = self.found.parts.append
        write(f"Call {len(node.keywords) - len(kept)}(")
        self.node(node.func)
        self.several([*node.args])
        self.several([*kept])
        write(")")

    def constant(self, node: ast.Constant) -> None:
        if isinstance(node.value, str) and WORD.fullmatch(node.value):
            self.found.strings.append(node.value)
            self.found.parts.append("S,")
        else:
            self.found.parts.append(f"C{type(node.value).__name__} {node.value!r},")

    def joined(self, node: ast.JoinedStr) -> None:
        self.pattern(node.values)
        self.plain(node)

    def added(self, node: ast.BinOp) -> None:
        if isinstance(node.op, ast.Add):
            self.pattern([node.left, node.right])
        self.plain(node)

    def pattern(self, parts: list[ast.expr]) -> None:
        """A text composed at run time: it could be any name that its written parts fit."""
        known = [p.value if isinstance(p, ast.Constant) else "*" for p in parts]
        text = "".join(p if isinstance(p, str) else "" for p in known)
        written = any(isinstance(p, ast.Constant) and isinstance(p.value, str) for p in parts)
        if written and "*" in text and PATTERN.fullmatch(text):
            self.found.strings.append(text)

    def annotation(self, node: ast.expr | None) -> None:
        if node is None:
            self.found.parts.append("-,")
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            self.found.parts.append(f"C{node.value!r},")
            for name in IDENTIFIERS.findall(node.value):
                self.look(name, ())
        else:
            self.node(node)

    def argument(self, node: ast.arg) -> None:
        self.found.parts.append(f"arg {node.arg}:")
        self.annotation(node.annotation)

    def annotated(self, node: ast.AnnAssign) -> None:
        self.found.parts.append("AnnAssign(")
        self.node(node.target)
        self.annotation(node.annotation)
        if node.value is not None:
            self.node(node.value)
        self.found.parts.append(")")

    # -- scopes -----------------------------------------------------------------------------------
    def scope(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) -> None:
        self.found.parts.append(f"{type(node).__name__} {getattr(node, 'name', '')}(")
        if not isinstance(node, ast.Lambda):
            self.several([*node.decorator_list])
            self.several([*getattr(node, "type_params", [])])
            self.annotation(node.returns)
        self.node(node.args)  # defaults and annotations belong to what is around
        inside = [node.body] if isinstance(node, ast.Lambda) else [*node.body]
        bound: set[str] = set()
        outer: set[str] = set()
        around: set[str] = set()
        kinds = {"global": outer, "nonlocal": around}
        for what, name in _bindings(inside):
            kinds.get(what, bound).add(name)
        self.found.rebinds |= outer & bound
        bound |= {a.arg for a in ast.walk(node.args) if isinstance(a, ast.arg)}
        self.scopes.append((frozenset(bound - outer - around), frozenset(outer)))
        self.several([*inside])
        self.scopes.pop()
        self.found.parts.append(")")

    def inner_import(self, node: ast.Import | ast.ImportFrom) -> None:
        for bound, module, name in imported(node, self.package):
            self.found.imports.add((bound, module, name))
            self.found.parts.append(f"import {bound},")


def imported(
    node: ast.Import | ast.ImportFrom, package: list[str]
) -> Iterator[tuple[str, str, str]]:
    """(name that is bound, module, name there or nothing) of an import statement."""
    for alias in node.names:
        if isinstance(node, ast.ImportFrom):
            yield alias.asname or alias.name, module_of(node, package), alias.name
        elif alias.asname:
            yield alias.asname, alias.name, ""
        else:
            yield alias.name.partition(".")[0], alias.name.partition(".")[0], ""


def _bindings(nodes: Iterable[ast.AST]) -> Iterator[tuple[str, str]]:
    """What the code of one scope binds, as ("bound", name), and what it declares as bound outside.

    The loop variables of comprehensions are not included: outside these the name is another.
    """
    for node in nodes:
        kind = type(node)
        if kind is ast.Name:
            if not isinstance(node.ctx, ast.Load):  # type: ignore[attr-defined]
                yield "bound", node.id  # type: ignore[attr-defined]
            continue
        if kind in (ast.Global, ast.Nonlocal):
            what = "global" if kind is ast.Global else "nonlocal"
            yield from ((what, name) for name in node.names)  # type: ignore[attr-defined]
        elif kind in (ast.Import, ast.ImportFrom):
            for alias in node.names:  # type: ignore[attr-defined]
                yield "bound", alias.asname or alias.name.partition(".")[0]
        elif kind in (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef):
            yield "bound", node.name  # type: ignore[attr-defined]
            # what comes before the body is evaluated here, and may bind with :=
            yield from _bindings(node.decorator_list)  # type: ignore[attr-defined]
            continue
        elif kind is ast.Lambda:
            continue
        elif kind is ast.comprehension:
            yield from _bindings([node.iter, *node.ifs])  # type: ignore[attr-defined]
            continue
        elif kind in (ast.ExceptHandler, ast.MatchAs, ast.MatchStar):
            if node.name:  # type: ignore[attr-defined]
                yield "bound", node.name  # type: ignore[attr-defined]
        elif kind is ast.MatchMapping and node.rest:  # type: ignore[attr-defined]
            yield "bound", node.rest  # type: ignore[attr-defined]
        yield from _bindings(ast.iter_child_nodes(node))


SPECIAL: dict[type[ast.AST], Callable[[_Reader, Any], None]] = {
    ast.Name: _Reader.name,
    ast.Attribute: _Reader.attribute,
    ast.Call: _Reader.call,
    ast.Constant: _Reader.constant,
    ast.JoinedStr: _Reader.joined,
    ast.BinOp: _Reader.added,
    ast.arg: _Reader.argument,
    ast.AnnAssign: _Reader.annotated,
    ast.FunctionDef: _Reader.scope,
    ast.AsyncFunctionDef: _Reader.scope,
    ast.Lambda: _Reader.scope,
    ast.Import: _Reader.inner_import,
    ast.ImportFrom: _Reader.inner_import,
}
