"""What a module defines: one unit for each statement, one for each method of a class.

A table is made from the text of a file alone, so that a tree other than the running one can be read too. It is stored
in the private cache under the hash of that text.
"""

from __future__ import annotations

import ast
import copy
import functools
import hashlib
import json
import os
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cratous.core.files.private_cache import private_cache
from cratous.core.ledger import syntax_text
from cratous.core.ledger.syntax_text import Reading, imported, read, silent

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
CHANGES = frozenset(
    {
        "append", "add", "update", "setdefault", "extend", "insert", "pop", "popitem", "remove",
        "discard", "clear", "sort", "reverse", "setattr", "delattr", "__setitem__", "__setattr__",
    }
)  # fmt: skip
"""Calls that change the object they are called on or an argument."""
MARKS = frozenset(
    {
        "kernel", "driver", "dataclass", "cache", "lru_cache", "property", "cached_property",
        "contextmanager", "wraps", "staticmethod", "classmethod", "overload", "abstractmethod",
    }
)  # fmt: skip
"""Decorators that register what they mark nowhere, or only in the registry of kernels."""


@dataclass(frozen=True)
class Unit:
    """One statement at the top of a module, or one method of a class.

    kind: function, class, value, import, loose or method; name: what it binds, after its class;
    digest: of its contents; the other fields are those of `syntax_text.Reading`; methods: the units
    of a class's methods, by name.
    """

    kind: str
    digest: str
    name: str = ""
    names: tuple[str, ...] = ()
    attributes: tuple[str, ...] = ()
    imports: tuple[tuple[str, str, str], ...] = ()
    strings: tuple[str, ...] = ()
    asks: tuple[str, ...] = ()
    methods: tuple[tuple[str, int], ...] = ()
    bases: tuple[str, ...] = ()


@dataclass(frozen=True)
class Table:
    """The units of one file. bound: name -> its units, in order; stars: modules of `import *`.

    loose: statements that may change what others define; sentence: the docstring, whitespace normalised; digest: of
    the whole file's contents.
    """

    units: tuple[Unit, ...]
    bound: dict[str, tuple[int, ...]]
    loose: tuple[int, ...]
    stars: tuple[str, ...]
    sentence: str
    digest: str


def table(data: bytes, module: str, package: bool) -> Table:
    """The table of a module's text; package: it is an `__init__`. Raises SyntaxError."""
    parts = module.split(".")
    around = parts if package else parts[:-1]
    key = hashlib.sha256(_maker() + repr(around).encode() + data).hexdigest()
    if key not in _TABLES:
        _TABLES[key] = _table(data, tuple(around), key)
    return _TABLES[key]


_TABLES: dict[str, Table] = {}


def _table(data: bytes, around: tuple[str, ...], key: str) -> Table:
    kept = private_cache() / "tables" / key[:2] / key
    try:
        return restored(json.loads(kept.read_text(encoding="utf-8")))
    except (OSError, ValueError, KeyError, TypeError):
        made = make(data, list(around))
    try:
        kept.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        part = kept.with_name(f"{key}.{os.getpid()}")
        part.write_text(json.dumps(_kept(made), separators=(",", ":")), encoding="utf-8")
        part.replace(kept)
    except OSError:
        pass  # a folder that cannot be written is no error
    return made


@functools.cache
def _maker() -> bytes:
    """A digest of the code that makes tables: changed code makes new ones."""
    files = (Path(__file__), Path(str(syntax_text.__file__)))
    text = sys.version.encode() + b"".join(file.read_bytes() for file in files)
    return hashlib.sha256(text).digest()


def _kept(made: Table) -> dict[str, Any]:
    """The fields of a table and of its units, without copying the texts."""
    return {**vars(made), "units": [vars(unit) for unit in made.units]}


def restored(data: dict[str, Any]) -> Table:
    """A table from its stored fields. Raises KeyError or TypeError for malformed data."""
    units = []
    for row in data["units"]:
        pairs = {n: tuple(map(tuple, row.pop(n))) for n in ("imports", "methods")}
        lists = {n: tuple(v) if isinstance(v, list) else v for n, v in row.items()}
        fields: dict[str, Any] = {**lists, **pairs}
        units.append(Unit(**fields))
    bound = {name: tuple(found) for name, found in data["bound"].items()}
    rest = (tuple(data["loose"]), tuple(data["stars"]), data["sentence"], data["digest"])
    return Table(tuple(units), bound, *rest)


def make(data: bytes, around: list[str]) -> Table:
    """The table of a file's text; around: the package that contains it."""
    tree = ast.parse(data)
    maker = _Maker(around)
    for node in tree.body:
        maker.statement(node)
    for name, units in maker.rebound.items():
        maker.bound.setdefault(name, []).extend(units)
    said = hashlib.sha256("".join(unit.digest for unit in maker.units).encode()).hexdigest()
    return Table(
        tuple(maker.units),
        {name: tuple(dict.fromkeys(found)) for name, found in maker.bound.items()},
        tuple(maker.loose),
        tuple(maker.stars),
        " ".join((ast.get_docstring(tree) or "").split()),
        said,
    )


@dataclass
class _Maker:
    around: list[str]
    units: list[Unit] = field(default_factory=list)
    bound: dict[str, list[int]] = field(default_factory=dict)
    rebound: dict[str, list[int]] = field(default_factory=dict)
    loose: list[int] = field(default_factory=list)
    stars: list[str] = field(default_factory=list)

    def statement(self, node: ast.stmt) -> None:
        if silent(node):
            return
        if isinstance(node, FUNCTIONS):
            self.marked(node, self.unit("function", [node], node.name))
        elif isinstance(node, ast.ClassDef):
            self.marked(node, self.of_class(node))
        elif isinstance(node, ast.Import | ast.ImportFrom):
            self.imports(node)
        elif isinstance(node, ast.Assign | ast.AnnAssign) and _plain(node):
            if isinstance(node, ast.AnnAssign) and node.value is None:
                return  # says nothing to who looks the name up
            targets = [node.target] if isinstance(node, ast.AnnAssign) else node.targets
            names = [n.id for one in targets for n in ast.walk(one) if isinstance(n, ast.Name)]
            self.bind(names, self.unit("value", [node], *names[:1]))
        elif not _only_for_types(node):
            number = self.unit("loose", [node])
            self.loose.append(number)
            self.bind(_stored(node), number)
        else:
            for inner in node.body:  # type: ignore[attr-defined]
                self.statement(inner)

    def marked(self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef, n: int) -> None:
        """Bind a function or class; one with a decorator that may have registered it elsewhere counts as loose."""
        self.bind([node.name], n)
        if _told(node):
            self.loose.append(n)

    def bind(self, names: list[str], number: int) -> None:
        for name in names:
            self.bound.setdefault(name, []).append(number)

    def unit(self, kind: str, nodes: list[ast.stmt], name: str = "") -> int:
        return self.add(kind, name, read(nodes, self.around))

    def add(self, kind: str, name: str, found: Reading, **more: Any) -> int:
        number = len(self.units)
        for bound in found.rebinds:
            self.rebound.setdefault(bound, []).append(number)
        self.units.append(
            Unit(
                kind,
                hashlib.sha256(f"{kind} {found.text}".encode()).hexdigest(),
                name,
                tuple(sorted(found.names)),
                tuple(sorted(found.attributes)),
                tuple(sorted(found.imports)),
                tuple(found.strings),
                tuple(sorted(found.asks)),
                **more,
            )
        )
        return number

    def imports(self, node: ast.Import | ast.ImportFrom) -> None:
        for name, module, there in imported(node, self.around):
            if there == "*":
                self.stars.append(module)
                continue
            number = len(self.units)
            row = ((name, module, there),)
            self.units.append(Unit("import", "", name, imports=row))
            self.bind([name], number)

    def of_class(self, node: ast.ClassDef) -> int:
        """The class with the parts that are always included; its other methods are units of their own."""
        methods: dict[str, list[ast.stmt]] = {}
        always: list[ast.stmt] = []
        for inner in node.body:
            dunder = isinstance(inner, FUNCTIONS) and inner.name.startswith("__")
            if isinstance(inner, FUNCTIONS) and not dunder and not _told(inner):
                methods.setdefault(inner.name, []).append(inner)
            elif not silent(inner):
                always.append(inner)
        head = copy.copy(node)
        head.body = always
        numbers = [
            (name, self.unit("method", [*nodes], f"{node.name}.{name}"))
            for name, nodes in sorted(methods.items())
        ]
        bases = tuple(sorted(read(node.bases, self.around).names))
        found = read([head], self.around)
        return self.add("class", node.name, found, methods=tuple(numbers), bases=bases)


def _told(node: ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef) -> bool:
    """Whether it has an unknown decorator, which may have registered it elsewhere."""
    for mark in node.decorator_list:
        called = mark.func if isinstance(mark, ast.Call) else mark
        name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
        if name not in MARKS and name not in ("setter", "getter"):
            return True
    return False


def _plain(node: ast.Assign | ast.AnnAssign) -> bool:
    """Whether an assignment binds names and, as far as can be seen, changes nothing else."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    if not all(isinstance(t, ast.Name | ast.Tuple | ast.List) for t in targets):
        return False
    for part in ast.walk(node):
        if isinstance(part, ast.Attribute | ast.Subscript) and not isinstance(part.ctx, ast.Load):
            return False
        if isinstance(part, ast.Call):
            called = part.func
            name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
            if name in CHANGES:
                return False
        if isinstance(part, ast.NamedExpr):
            return False
    return True


def _only_for_types(node: ast.stmt) -> bool:
    """`if TYPE_CHECKING:`, whose body never runs."""
    if not isinstance(node, ast.If) or node.orelse:
        return False
    return ast.unparse(node.test) in ("TYPE_CHECKING", "typing.TYPE_CHECKING")


def _stored(node: ast.stmt) -> list[str]:
    """Every name that a statement may bind in the module."""
    found = [n.id for n in ast.walk(node) if isinstance(n, ast.Name) and not _read(n)]
    for inner in ast.walk(node):
        if isinstance(inner, ast.Import | ast.ImportFrom):
            found += [a.asname or a.name.partition(".")[0] for a in inner.names]
        elif isinstance(inner, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            found.append(inner.name)
    return found


def _read(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Load)
