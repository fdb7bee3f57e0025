"""LMCP objects in binary, fast: one reading and one writing function generated for each class.

A generated function takes adjacent fields of fixed size in one `struct` call, looks up enums, booleans and the
classes of nested objects in dictionaries, and checks the type of every value that it writes. It diagnoses nothing
itself: anything it does not accept raises, and the message goes through `lmcp.reference_codec`, which reports the error (or
converts the value, as the constructor would). So both accept the same messages, which
`tests/bridge/test_lmcp_compiled.py` checks.
"""

from __future__ import annotations

import keyword
import re
import struct
from collections.abc import Callable
from typing import Any

from cratous.bridge.lmcp import model
from cratous.bridge.lmcp.objects import LmcpObject, enums, types
from cratous.bridge.lmcp.reference_codec import (
    CODES,
    MAX_DEPTH,
    MAX_ELEMENTS,
    OBJECT_HEAD,
    class_of,
)
from cratous.spec.errors import BadInput

Reads = Callable[[bytes, int, int], tuple[Any, int]]
Writes = Callable[[Any, Callable[[bytes], None], int], None]
HEAD_SIZE = OBJECT_HEAD.size


# Elements that the message being read may still have. If two threads share it, the worst that happens is
# that a message is read by the careful functions without need.
left = [MAX_ELEMENTS]


class NotFast(Exception):
    """The careful functions must process this message."""


# Exceptions that a generated function may raise for irregular bytes or values.
GIVES_UP = (
    NotFast, struct.error, KeyError, IndexError, UnicodeError, OverflowError, TypeError,
    AttributeError, BadInput, RecursionError,
)  # fmt: skip


def head_of(cls: Any) -> bytes:
    """The header of an object of a class: not null, series, type and version."""
    loaded = model.load(cls.series)
    return OBJECT_HEAD.pack(1, loaded.wire_id, cls.type_id, loaded.version)


def _read_null(_data: bytes, at: int, _depth: int) -> tuple[None, int]:
    return None, at - HEAD_SIZE + 1


def _write_null(_obj: None, put: Callable[[bytes], None], _depth: int) -> None:
    put(b"\0")


class Readers(dict[bytes, Reads]):
    """From an object's header to its reading function, for the classes that a field may hold."""

    def __init__(self, base: type, nullable: bool) -> None:
        self.base, self.nullable = base, nullable

    def __missing__(self, head: bytes) -> Reads:
        if self.nullable and head[:1] == b"\0":
            return _read_null
        if len(head) != HEAD_SIZE or head[0] != 1:
            raise NotFast
        cls = class_of(*OBJECT_HEAD.unpack(head)[1:])
        if not issubclass(cls, self.base):
            raise NotFast
        made = self[head] = functions(cls)[0]
        return made


class Writers(dict[type, Writes]):
    """From an object's class to its writing function, for the classes that a field may hold."""

    def __init__(self, base: type, nullable: bool) -> None:
        self.base = base
        if nullable:
            self[type(None)] = _write_null

    def __missing__(self, cls: type) -> Writes:
        if not issubclass(cls, self.base):
            raise NotFast
        made = self[cls] = functions(cls)[1]
        return made


_made: dict[type, tuple[Reads, Writes]] = {}
_tables: dict[tuple[type, bool], tuple[Readers, Writers]] = {}


def functions(cls: Any) -> tuple[Reads, Writes]:
    """(reader of the fields after the header, writer of header and fields) of a class."""
    found = _made.get(cls)
    if found is None:
        real = cls.__dict__.get("real_class")  # of a class of `lmcp.lazy_messages`
        found = _made[cls] = _Maker(cls).functions() if real is None else _of_lazy(real)
    return found


def _of_lazy(cls: Any) -> tuple[Reads, Writes]:
    reads, writes = functions(cls)

    def write(obj: Any, put: Callable[[bytes], None], depth: int) -> None:
        writes(obj.complete(), put, depth)

    return reads, write


Fills = Callable[[Any, bytes, int, int], int]


def fillers(cls: Any) -> tuple[Fills, Fills, frozenset[str], int]:
    """Readers that fill an existing object: (obj, data, at, depth) -> end.

    One for all fields; one for the leading fields at fixed positions; the names of the latter, and their size.
    """
    return _Maker(cls).fillers()


def tables(base: type, nullable: bool) -> tuple[Readers, Writers]:
    """The tables of the classes that a field of this declared class may hold."""
    key = (base, nullable)
    if key not in _tables:
        _tables[key] = Readers(base, nullable), Writers(base, nullable)
    return _tables[key]


def _forget(_series: str) -> None:
    for readers, _ in _tables.values():
        readers.clear()


model.when_removed(_forget)

_FIELD = re.compile(r"\bo\.(\w+)")
_PYTHON = {"bool": "bool", "string": "str", "char": "str", "real32": "float", "real64": "float"}


class _Maker:
    """Generates the source of the two functions of one class, and compiles them."""

    def __init__(self, cls: Any) -> None:
        self.cls = cls
        self.space: dict[str, Any] = {
            "new": object.__new__, "C": cls, "HEAD": head_of(cls), "NotFast": NotFast,
            "B": {0: False, 1: True}, "unpack_from": struct.unpack_from, "pack": struct.pack,
            "INT": {int}, "FLOAT": {float}, "left": left,
        }  # fmt: skip
        self.read: list[str] = []
        self.write: list[str] = []
        self.count = 0
        self.group: list[tuple[str, str, str, str]] = []  # code, target, value, conversion
        self.checks: list[str] = []
        self.front: tuple[list[str], frozenset[str], int] | None = None

    def functions(self) -> tuple[Reads, Writes]:
        if any(keyword.iskeyword(name) for name in self.cls.names):
            return _give_up, _give_up
        self.body()
        lines = ["def read(data, at, depth):", f" if depth > {MAX_DEPTH}: raise NotFast"]
        lines += [" o = new(C)", *(" " + line for line in self.read), " return o, at", ""]
        lines += ["def write(o, put, depth):", f" if depth > {MAX_DEPTH}: raise NotFast"]
        lines += [" " + line for line in self.write]
        exec(compile("\n".join(lines), f"<lmcp {self.cls.type_name}>", "exec"), self.space)
        return self.space["read"], self.space["write"]

    def body(self) -> None:
        for field in self.cls.fields:
            self.field(field)
        self.flush()

    def fillers(self) -> tuple[Fills, Fills, frozenset[str], int]:
        if any(keyword.iskeyword(name) for name in self.cls.names):
            return _give_up, _give_up, frozenset(), 0
        self.body()
        front = self.front or ([], frozenset(), 0)
        made = []
        for lines in (self.read, front[0]):
            text = ["def fill(o, data, at, depth):", *(" " + line for line in lines), " return at"]
            exec(compile("\n".join(text), f"<lmcp {self.cls.type_name}>", "exec"), self.space)
            made.append(self.space["fill"])
        return made[0], made[1], front[1], front[2]

    def name(self, prefix: str, value: Any = None) -> str:
        self.count += 1
        name = f"{prefix}{self.count}"
        if value is not None:
            self.space[name] = value
        return name

    def field(self, field: model.Field) -> None:
        if field.array is None:
            if field.kind == "string":
                self.string(field)
            elif field.kind in ("struct", "any"):
                self.object(field)
            else:
                self.fixed(field)
        elif field.array and field.kind in CODES and field.kind not in ("bool", "char", "enum"):
            self.fixed_array(field)
        else:
            self.array(field)

    def fixed(self, field: model.Field) -> None:
        value, target = self.name("v"), f"o.{field.name}"
        self.write_value(field.name, value)
        convert, code = "", CODES[field.kind]
        if field.kind == "enum":
            members = enums[field.type]
            table = self.name("E", dict(members._value2member_map_))
            convert = f"{table}[{value}]"
            self.checks.append(f"type({value}) is not {self.name('M', members)}")
        elif field.kind == "bool":
            convert = f"B[{value}]"
            self.checks.append(f"{value} is not True and {value} is not False")
        elif field.kind == "char":
            convert = f"{value}.decode('latin-1')"
            self.checks.append(f"type({value}) is not str")
        else:
            self.checks.append(f"type({value}) is not {_PYTHON.get(field.kind, 'int')}")
        packed = f"{value}.encode('latin-1')" if field.kind == "char" else value
        if convert:
            self.group.append((code, value, packed, f"{target} = {convert}"))
        else:
            self.group.append((code, target, packed, ""))

    def write_value(self, name: str, value: str) -> None:
        self.write.append(f"{value} = o.{name}")

    def count_field(self, large: bool, name: str, value: str) -> None:
        """Add a length or count at the end of the preceding group."""
        self.group.append(("I" if large else "H", name, value, ""))
        self.flush()

    def flush(self) -> None:
        """Emit the group of adjacent fields of fixed size."""
        head = "" if self.space.get("begun") else "15s"
        self.space["begun"] = True
        if self.checks:
            self.write.append(f"if {' or '.join(self.checks)}: raise NotFast")
            self.checks = []
        if not self.group:
            if head:
                self.write.append("put(HEAD)")
            return
        codes = "".join(code for code, *_ in self.group)
        form = struct.Struct(">" + codes)
        unpack = self.name("U", form.unpack_from)
        targets = ", ".join(target for _, target, _, _ in self.group)
        self.read.append(f"{targets}{',' * (len(self.group) == 1)} = {unpack}(data, at)")
        self.read.append(f"at += {form.size}")
        self.read += [convert for *_, convert in self.group if convert]
        if self.front is None:
            targets = " ".join(part for _, target, _, made in self.group for part in (target, made))
            names = frozenset(_FIELD.findall(targets)) & frozenset(self.cls.names)
            if any(f.array is not None for f in self.cls.fields if f.name in names):
                names = frozenset()  # a list read by somebody could be changed
            self.front = list(self.read), names, form.size
        pack = self.name("P", struct.Struct(f">{head}{codes}").pack)
        values = ", ".join(value for _, _, value, _ in self.group)
        self.write.append(f"put({pack}({'HEAD, ' if head else ''}{values}))")
        self.group = []

    def string(self, field: model.Field) -> None:
        n, value = self.name("n"), self.name("v")
        self.write_value(field.name, value)
        self.write.append(f"if type({value}) is not str: raise NotFast")
        self.write.append(f"{value} = {value}.encode()")
        self.count_field(False, n, f"len({value})")
        self.write.append(f"if {value}: put({value})")
        self.read.append(f"{n} += at")
        self.read.append(f"o.{field.name} = data[at:{n}].decode()")
        self.read.append(f"at = {n}")

    def object(self, field: model.Field) -> None:
        self.flush()
        reads, writes = self.tables(field, field.nullable)
        value = self.name("v")
        self.read.append(f"o.{field.name}, at = {reads}[data[at:at+15]](data, at + 15, depth + 1)")
        self.write_value(field.name, value)
        self.write.append(f"{writes}[type({value})]({value}, put, depth + 1)")

    def tables(self, field: model.Field, nullable: bool) -> tuple[str, str]:
        base = LmcpObject if field.kind == "any" else types[field.type]
        readers, writers = tables(base, nullable)
        return self.name("R", readers), self.name("W", writers)

    def fixed_array(self, field: model.Field) -> None:
        """An array of numbers of fixed length: its elements are part of the group."""
        value = self.name("v")
        self.write_value(field.name, value)
        size, kind = field.array or 0, _PYTHON.get(field.kind, "int").upper()
        self.write.append(
            f"if type({value}) is not list or len({value}) != {size} "
            f"or set(map(type, {value})) != {kind}: raise NotFast"
        )
        parts = [self.name("a") for _ in range(size)]
        for i, part in enumerate(parts):
            made = f"o.{field.name} = [{', '.join(parts)}]" if i == size - 1 else ""
            self.group.append((CODES[field.kind], part, f"{value}[{i}]", made))

    def array(self, field: model.Field) -> None:
        n, value, kind = self.name("n"), self.name("v"), field.kind
        self.write_value(field.name, value)
        self.write.append(f"if type({value}) is not list: raise NotFast")
        if field.array:
            self.flush()
            self.read.append(f"{n} = {field.array}")
            self.write.append(f"if len({value}) != {field.array}: raise NotFast")
        else:
            self.count_field(field.large, n, f"len({value})")
        target = f"o.{field.name}"
        if kind in ("struct", "any", "string", "enum", "bool", "char"):
            self.read.append(f"if {n}:")
            self.read.append(f" left[0] -= {n}")
            self.read.append(" if left[0] < 0: raise NotFast")
        if kind in ("struct", "any"):
            reads, writes = self.tables(field, True)
            self.read += [
                f"{target} = {value} = []",
                f"for _ in range({n}):",
                f" x, at = {reads}[data[at:at+15]](data, at + 15, depth + 1)",
                f" {value}.append(x)",
            ]
            self.write.append(f"for x in {value}: {writes}[type(x)](x, put, depth + 1)")
        elif kind == "string":
            self.read += [
                f"{target} = {value} = []",
                f"for _ in range({n}):",
                " x = at + 2",
                " at = x + (data[at] << 8) + data[at + 1]",
                f" {value}.append(data[x:at].decode())",
            ]
            self.write += [
                f"for x in {value}:",
                " if type(x) is not str: raise NotFast",
                " x = x.encode()",
                " put(pack('>H', len(x)))",
                " put(x)",
            ]
        else:
            self.numbers(field, n, value, target)

    def numbers(self, field: model.Field, n: str, value: str, target: str) -> None:
        code, size = CODES[field.kind], struct.calcsize(">" + CODES[field.kind])
        packed, made = f"*{value}", "list({})"
        if field.kind == "enum":
            members = enums[field.type]
            table = self.name("E", dict(members._value2member_map_))
            made = f"[{table}[x] for x in {{}}]"
            good = self.name("M", {members})
        elif field.kind == "bool":
            made, good = "[B[x] for x in {}]", self.name("M", {bool})
        elif field.kind == "char":
            made, good = "[x.decode('latin-1') for x in {}]", self.name("M", {str})
            packed = f"*[x.encode('latin-1') for x in {value}]"
        else:
            good = _PYTHON.get(field.kind, "int").upper()
        got = made.format(f"unpack_from(f'>{{{n}}}{code}', data, at)")
        self.read.append(f"if {n}:")
        self.read.append(f" {target} = {got}")
        self.read.append(f" at += {size} * {n}")
        self.read.append(f"else: {target} = []")
        self.write.append(f"if {value}:")
        self.write.append(f" if set(map(type, {value})) != {good}: raise NotFast")
        self.write.append(f" put(pack(f'>{{len({value})}}{code}', {packed}))")


def _give_up(*_: Any) -> Any:
    raise NotFast
