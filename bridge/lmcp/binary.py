"""LMCP in binary: big endian, every object with its own type, a checksum at the end.

`LMCP`, uint32 size of the root object, the object, uint32 sum of all bytes before it (0 stands for
"not computed" and is accepted). An object is one byte 0 for null, or 1, series id (int64), type
id (uint32), version (uint16) and all fields, oldest ancestor first. Where other implementations
read a byte string in different ways (a bool of 2, an enum value that does not exist, a wrong class
in a field, bytes behind the end) this one refuses it.
"""

from __future__ import annotations

import struct
from functools import cache
from typing import Any

from cratous.bridge.lmcp import model
from cratous.bridge.lmcp.objects import LmcpObject, element_check, enums, types, within
from cratous.spec.errors import BadInput

_CODES = {
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
_HEAD = struct.Struct(">4sI")
_OBJECT = struct.Struct(">BqIH")
_SUM = struct.Struct(">I")
_SMALL_COUNT, _LARGE_COUNT = struct.Struct(">H"), struct.Struct(">I")
_MAX_DEPTH = 64


def pack(obj: LmcpObject) -> bytes:
    """The whole message of an object; BadInput if a value does not fit its field."""
    body = bytearray()
    _pack_object(obj.copy().checked(), body)
    message = _HEAD.pack(b"LMCP", len(body)) + body
    return message + _SUM.pack(sum(message) & 0xFFFFFFFF)


def unpack(data: bytes, where: str = "message") -> Any:
    """The object of exactly one message; BadInput says what is wrong with it."""
    if len(data) < _HEAD.size + 1 + _SUM.size:
        raise BadInput("message too short", where=where, expected="13 bytes", got=f"{len(data)}")
    tag, size = _HEAD.unpack_from(data)
    if tag != b"LMCP":
        raise BadInput("not an LMCP message", where=where, expected="b'LMCP'", got=repr(tag))
    if size + 12 != len(data):
        raise BadInput(
            "wrong length of message", where=where, expected=f"{size + 12}", got=f"{len(data)}"
        )
    (given,) = _SUM.unpack_from(data, len(data) - 4)
    if given and given != (total := sum(data[:-4]) & 0xFFFFFFFF):
        raise BadInput("wrong checksum", where=where, expected=f"{total}", got=f"{given}")
    reader = _Reader(data, _HEAD.size, len(data) - 4)
    try:
        obj = reader.object(0)
    except BadInput as err:
        raise BadInput(
            err.what,
            where=f"{where}: byte {reader.at}",
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


def _pack_object(obj: LmcpObject | None, out: bytearray) -> None:
    if obj is None:
        out.append(0)
        return
    loaded = model.load(obj.series)
    out += _OBJECT.pack(1, loaded.wire_id, obj.type_id, loaded.version)
    for field, value in zip(obj.fields, obj.values_of(obj), strict=True):
        if field.array is None:
            _pack_one(field, value, out)
            continue
        if field.array == 0:
            count = _LARGE_COUNT if field.large else _SMALL_COUNT
            if len(value) >= 256**count.size:
                raise BadInput(
                    "array too long", item=field.name, expected=f"< {256**count.size} elements"
                )
            out += count.pack(len(value))
        code = _CODES.get(field.kind)
        if code and field.kind != "char":
            out += struct.pack(f">{len(value)}{code}", *value)
        else:
            for element in value:
                _pack_one(field, element, out)


def _pack_one(field: model.Field, value: Any, out: bytearray) -> None:
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
        _pack_object(value, out)
    elif field.kind == "char":
        out += value.encode("latin-1")
    else:
        out += _one(field.kind).pack(value)


@cache
def _one(kind: str) -> struct.Struct:
    return struct.Struct(">" + _CODES[kind])


class _Reader:
    """A place in the bytes of one message."""

    def __init__(self, data: bytes, at: int, end: int) -> None:
        self.data, self.at, self.end = data, at, end

    def take(self, size: int) -> int:
        """Step over `size` bytes and give where they start."""
        start = self.at
        if start + size > self.end:
            raise BadInput(
                "message ends too early", expected=f"{size} bytes", got=f"{self.end - start}"
            )
        self.at = start + size
        return start

    def object(self, depth: int) -> Any:
        if depth > _MAX_DEPTH:
            raise BadInput("nested too deeply", expected=f"at most {_MAX_DEPTH} levels")
        flag = self.data[self.take(1)]
        if flag == 0:
            return None
        if flag != 1:
            raise BadInput("wrong object header", expected="0 or 1", got=f"{flag}")
        self.at -= 1
        _, series_id, type_id, version = _OBJECT.unpack_from(self.data, self.take(_OBJECT.size))
        cls = _class_of(series_id, type_id, version)
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
            form = struct.Struct(f">{count}{_CODES[field.kind]}")
            return list(form.unpack_from(self.data, self.take(form.size)))
        return [self.one(field, depth) for _ in range(count)]

    def one(self, field: model.Field, depth: int) -> Any:
        if field.kind in ("struct", "any"):
            return element_check(field)(self.object(depth + 1))
        if field.kind == "string":
            (length,) = _SMALL_COUNT.unpack_from(self.data, self.take(2))
            start = self.take(length)
            try:
                return bytes(self.data[start : start + length]).decode("utf-8")
            except UnicodeDecodeError as err:
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
                raise BadInput(
                    "wrong value", expected=" or ".join(members.__members__), got=f"{value}"
                )
            return members(value)
        return value


@cache
def _class_of(series_id: int, type_id: int, version: int) -> type[Any]:
    for name in model.SERIES:
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
        raise BadInput("unknown message type", item=name, got=f"type {type_id}")
    raw = series_id.to_bytes(8, "big", signed=True)
    raise BadInput("unknown message series", expected=" or ".join(model.SERIES), got=repr(raw))
