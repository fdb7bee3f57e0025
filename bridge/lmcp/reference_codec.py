"""LMCP objects in binary, field by field: the reference implementation, which reports what is wrong and where.

`lmcp.compiled` does the same much faster and falls back to this module for anything it does not accept, so that each
error has one place. Byte strings that other implementations read in different ways (a bool of 2, an enum value that
does not exist, a wrong class in a field) are refused.
"""

from __future__ import annotations

import struct
from functools import cache
from typing import Any

from cratous.bridge.lmcp import model
from cratous.bridge.lmcp.objects import LmcpObject, element_check, enums, types, within
from cratous.spec.errors import BadInput

CODES = {
    "bool": "B",
    "byte": "B",
    "char": "c",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "real32": "f",
    "real64": "d",
    "enum": "i",
}
OBJECT_HEAD = struct.Struct(">BqIH")
_SMALL_COUNT, _LARGE_COUNT = struct.Struct(">H"), struct.Struct(">I")
MAX_DEPTH = 64
# 0 where an enum begins with 1: "not set", as sent by clients of UxAS, which does not check it
UNSET = {"CMASI/ZoneAvoidanceType": "Physical"}
MAX_ELEMENTS = 1_000_000  # total in one message, of arrays other than of numbers


def pack(obj: LmcpObject) -> bytearray:
    """The bytes of an object with its header; BadInput if a value does not fit its field."""
    out = bytearray()
    for field, value in zip(obj.fields, obj.values_of(obj), strict=True):
        if field.array == 0 and isinstance(value, list):
            _count(field, value)  # before the elements are checked
    try:
        _pack_object(obj.copy().checked(), out, 0)
    except RecursionError:
        raise _too_deep() from None
    return out


def read(data: bytes, at: int, end: int, where: str, notes: list[str] | None = None) -> Any:
    """The object that occupies exactly data[at:end]; BadInput with the byte and the field's path.

    notes: if given, a 0 for an enum in UNSET is replaced by the value there, and noted.
    """
    reader = _Reader(data, at, end, notes)
    try:
        obj = reader.object(0)
    except BadInput as err:
        raise BadInput(
            err.what,
            where=f"{where}: byte {reader.began}",
            item=err.item,
            expected=err.expected,
            got=err.got,
        ) from None
    if obj is None or reader.at != reader.end:
        raise BadInput(
            "null message" if obj is None else "bytes behind the object",
            where=f"{where}: byte {reader.at}",
            expected="one object",
        )
    return obj


def _too_deep() -> BadInput:
    return BadInput("nested too deeply", expected=f"at most {MAX_DEPTH} levels")


def _pack_object(obj: LmcpObject | None, out: bytearray, depth: int) -> None:
    if obj is None:
        out.append(0)
        return
    if depth > MAX_DEPTH:
        raise _too_deep()
    loaded = model.load(obj.series)
    out += OBJECT_HEAD.pack(1, loaded.wire_id, obj.type_id, loaded.version)
    for field, value in zip(obj.fields, obj.values_of(obj), strict=True):
        if field.array is None:
            _pack_one(field, value, out, depth)
            continue
        if field.array == 0:
            out += _count(field, value)
        code = CODES.get(field.kind)
        if code and field.kind != "char":
            out += struct.pack(f">{len(value)}{code}", *value)
        else:
            for element in value:
                _pack_one(field, element, out, depth)


def _count(field: model.Field, value: Any) -> bytes:
    count = _LARGE_COUNT if field.large else _SMALL_COUNT
    if len(value) >= 256**count.size:
        raise BadInput(
            "array too long",
            item=field.name,
            expected=f"< {256**count.size} elements",
            got=f"{len(value)}",
        )
    return count.pack(len(value))


def _pack_one(field: model.Field, value: Any, out: bytearray, depth: int) -> None:
    if field.kind == "string":
        try:
            text = value.encode("utf-8")
        except UnicodeEncodeError:
            raise BadInput("text without UTF-8 form", item=field.name, got=repr(value)) from None
        if len(text) > 0xFFFF:
            raise BadInput(
                "text too long", item=field.name, expected="< 65536 bytes", got=f"{len(text)}"
            )
        out += _SMALL_COUNT.pack(len(text)) + text
    elif field.kind in ("struct", "any"):
        _pack_object(value, out, depth + 1)
    elif field.kind == "char":
        out += value.encode("latin-1")
    else:
        out += _one(field.kind).pack(value)


@cache
def _one(kind: str) -> struct.Struct:
    return struct.Struct(">" + CODES[kind])


class _Reader:
    """A position in the bytes of one message."""

    def __init__(self, data: bytes, at: int, end: int, notes: list[str] | None = None) -> None:
        self.data, self.at, self.end, self.notes = data, at, end, notes
        self.left = MAX_ELEMENTS
        self.began = at  # start of what was read last, for error messages

    def take(self, size: int) -> int:
        """Advance by `size` bytes; returns their position."""
        start = self.began = self.at
        if start + size > self.end:
            raise BadInput(
                "message ends too early", expected=f"{size} bytes", got=f"{self.end - start}"
            )
        self.at = start + size
        return start

    def object(self, depth: int) -> Any:
        flag = self.data[self.take(1)]
        if flag == 0:
            return None
        if depth > MAX_DEPTH:
            raise _too_deep()
        if flag != 1:
            raise BadInput("wrong object header", expected="0 or 1", got=f"{flag}")
        self.at -= 1
        _, series_id, type_id, version = OBJECT_HEAD.unpack_from(
            self.data, self.take(OBJECT_HEAD.size)
        )
        cls = class_of(series_id, type_id, version)
        values = {}
        for field in cls.fields:
            try:
                values[field.name] = self.field(field, depth)
            except BadInput as err:
                raise within(err, f"{cls.__name__}.{field.name}") from None
        return cls(**values)

    def field(self, field: model.Field, depth: int) -> Any:
        if field.array is None:
            return self.one(field, depth)
        if field.array:
            count = field.array
        else:
            head = _LARGE_COUNT if field.large else _SMALL_COUNT
            (count,) = head.unpack_from(self.data, self.take(head.size))
        if count > self.end - self.at:  # every element has at least one byte
            raise BadInput(
                "message ends too early", expected=f"{count} elements", got=f"{self.end - self.at}"
            )
        if field.kind in ("real32", "real64") or field.kind in model.INTEGER_RANGES:
            form = struct.Struct(f">{count}{CODES[field.kind]}")
            return list(form.unpack_from(self.data, self.take(form.size)))
        self.left -= count
        if self.left < 0:
            raise BadInput("too many elements", expected=f"at most {MAX_ELEMENTS} in a message")
        return [self.one(field, depth) for _ in range(count)]

    def one(self, field: model.Field, depth: int) -> Any:
        if field.kind in ("struct", "any"):
            start = self.at
            value = self.object(depth + 1)
            try:
                return element_check(field)(value)
            except BadInput:
                self.began = start
                raise
        if field.kind == "string":
            (length,) = _SMALL_COUNT.unpack_from(self.data, self.take(2))
            start = self.take(length)
            try:
                return bytes(self.data[start : start + length]).decode("utf-8")
            except UnicodeDecodeError as err:
                self.began = start + err.start
                raise BadInput("text that is not UTF-8", got=str(err.reason)) from None
        form = _one(field.kind)
        (value,) = form.unpack_from(self.data, self.take(form.size))
        if field.kind == "char":
            return value.decode("latin-1")
        if field.kind == "bool":
            if value > 1:
                raise BadInput("wrong value", expected="0 or 1", got=f"{value}")
            return bool(value)
        if field.kind == "enum":
            members = enums[field.type]
            if value not in members._value2member_map_:
                if value == 0 and field.type in UNSET and self.notes is not None:
                    self.notes.append(f"{field.name}=0 is taken for {UNSET[field.type]}")
                    return members[UNSET[field.type]]
                raise BadInput(
                    "wrong value", expected=" or ".join(members.__members__), got=f"{value}"
                )
            return members(value)
        return value


def class_of(series_id: int, type_id: int, version: int) -> type[Any]:
    """The class of an object header; BadInput for an unknown type or another version."""
    return _class_of(series_id, type_id, version)


@cache
def _class_of(series_id: int, type_id: int, version: int) -> type[Any]:
    for name in model.known():
        loaded = model.load(name)
        if loaded.wire_id != series_id:
            continue
        if loaded.version != version:
            raise BadInput(
                "other version of a series",
                item=name,
                expected=f"version {loaded.version}",
                got=f"{version}",
            )
        for struct_ in loaded.structs.values():
            if struct_.id == type_id:
                return types[f"{name}/{struct_.name}"]
        raise BadInput(
            "unknown message type",
            item=name,
            expected=f"type 1 to {max(s.id for s in loaded.structs.values())}",
            got=f"type {type_id}",
        )
    raw = series_id.to_bytes(8, "big", signed=True).rstrip(b"\0")
    raise BadInput("unknown message series", expected=" or ".join(model.known()), got=repr(raw))


model.when_removed(lambda _series: _class_of.cache_clear())
