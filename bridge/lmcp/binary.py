"""LMCP in binary: big endian, every object with its own type, a checksum at the end.

`LMCP`, uint32 size of the root object, the object, uint32 sum of all bytes before it (0 stands for "not computed" and
is accepted). An object is one byte 0 for null, or 1, series id (int64), type id (uint32), version (uint16) and all
fields, oldest ancestor first. Byte strings that other implementations read in different ways (a bool of 2, an enum
value that does not exist, a wrong class in a field, bytes after the end) are refused here.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from typing import Any

from cratous.bridge.bytesum import byte_sum
from cratous.bridge.lmcp import compiled, lazy_messages, model, reference_codec
from cratous.bridge.lmcp.objects import LmcpObject, types
from cratous.bridge.lmcp.reference_codec import MAX_DEPTH, MAX_ELEMENTS
from cratous.spec.errors import BadInput

__all__ = [
    "MAX_DEPTH",
    "MAX_ELEMENTS",
    "MAX_MESSAGE",
    "lazy",
    "pack",
    "prepare",
    "received",
    "split",
    "unpack",
]

TAG = b"LMCP"
MAX_MESSAGE = 64 * 1024 * 1024  # bytes of one message
_HEAD = struct.Struct(">4sI")
_SUM = struct.Struct(">I")
_LEAST = _HEAD.size + 1 + _SUM.size
_AT = _HEAD.size
_left = compiled.left
_readers, _writers = compiled.tables(LmcpObject, False)


def prepare(classes: Iterable[type[LmcpObject]]) -> None:
    """Make the functions that read and write these classes, and those of the objects in their fields, which the
    first message of each would otherwise wait for.
    """
    left, done = [*classes], set[type[LmcpObject]]()
    while left:
        cls = left.pop()
        if cls not in done:
            done.add(cls)
            compiled.functions(cls)
            left += [types[field.type] for field in cls.fields if field.kind == "struct"]


def pack(obj: LmcpObject) -> bytes:
    """The whole message of an object; BadInput if a value does not fit its field.

    A message from `lazy` whose fields were not read is passed on unchanged.
    """
    raw = obj.raw_message()
    if raw is not None:
        return raw
    parts: list[bytes] = [b""]
    try:
        _writers[type(obj)](obj, parts.append, 0)
        body: bytes | bytearray = b"".join(parts)
    except compiled.GIVES_UP:
        body = reference_codec.pack(obj)
    if len(body) > MAX_MESSAGE:
        raise _long("", len(body))
    message = _HEAD.pack(TAG, len(body)) + body
    return message + _SUM.pack(byte_sum(message))


def unpack(data: bytes, where: str = "message") -> Any:
    """The object of exactly one message.

    Raises BadInput, with the byte and the path of the field, for anything else: a wrong tag, length or checksum, a
    message longer than MAX_MESSAGE, more levels than MAX_DEPTH, more than MAX_ELEMENTS array elements (other than
    numbers), unknown series, types and versions, wrong values, text that is not UTF-8.
    """
    data = bytes(data)
    _checked(data, where)
    end = len(data) - 4
    _left[0] = MAX_ELEMENTS
    try:
        obj, at = _readers[data[_AT : _AT + 15]](data[:end], _AT + 15, 0)
        if at == end:
            return obj
    except compiled.GIVES_UP:
        pass
    return reference_codec.read(data, _AT, end, where)


def lazy(data: bytes, where: str = "message") -> Any:
    """Like `unpack`, but fields are read on first access.

    Length, checksum, and that the type is known are checked at once; any other error raises BadInput at the first
    access to a field (other than the leading numbers, which are read separately; `complete()` reads all). The object
    has its class (isinstance, topics) from the start. While only leading numbers were read, `pack` returns the
    message unchanged.
    """
    data = bytes(data)
    _checked(data, where)
    head = data[_AT : _AT + 15]
    cls = _lazy_classes.get(head)
    if cls is None:
        if len(data) < _AT + 15 + 4 or head[0] != 1:
            return reference_codec.read(data, _AT, len(data) - 4, where)  # raises the error
        try:
            found = reference_codec.class_of(*reference_codec.OBJECT_HEAD.unpack(head)[1:])
        except BadInput:
            return reference_codec.read(data, _AT, len(data) - 4, where)
        if not found.names:
            return unpack(data, where)
        cls = _lazy_classes[head] = lazy_messages.class_of(found, _fill)
    obj = _new(cls)
    _set_raw(obj, "_raw", (data, where))
    return obj


def _fill(obj: Any, fill: Any, data: bytes, where: str) -> None:
    """Read the fields of a lazy object."""
    end = len(data) - 4
    _left[0] = MAX_ELEMENTS
    try:
        if fill(obj, data[:end], _AT + 15, 0) == end:
            return
    except compiled.GIVES_UP:
        pass
    read = reference_codec.read(data, _AT, end, where)
    for name in read.names:
        setattr(obj, name, getattr(read, name))


_new, _set_raw = object.__new__, object.__setattr__  # past the lazy __setattr__
_lazy_classes: dict[bytes, Any] = {}
model.when_removed(lambda _series: _lazy_classes.clear())


def received(data: bytes, where: str = "message") -> tuple[Any, bytes, list[str]]:
    """Reads a message from a client: the object, its message in correct form, and notes on irregularities.

    Like `unpack`, but two irregularities of clients that UxAS accepts are accepted and noted: pylmcp (OpenUxAS's own
    Python client) leaves the null flag of the object out of the length, and sends a zone without a type. The checksum
    must be that of the bytes as received. Raises BadInput.
    """
    notes: list[str] = []
    if len(data) >= _LEAST and _HEAD.unpack_from(data) == (TAG, len(data) - 13):
        (given,) = _SUM.unpack_from(data, len(data) - 4)
        if given == byte_sum(memoryview(data)[:-4]):
            notes.append("the length leaves out a byte")
            data = _HEAD.pack(TAG, len(data) - 12) + data[_HEAD.size : -4]
            data += _SUM.pack(byte_sum(data))
    try:
        return unpack(data, where), data, notes
    except BadInput:
        _checked(data, where)
        unset: list[str] = []
        obj = reference_codec.read(data, _AT, len(data) - 4, where, unset)
        if not unset:
            raise
        return obj, pack(obj), notes + unset


def split(data: bytes, where: str = "messages") -> Iterator[bytes]:
    """Splits bytes that contain complete messages one after the other."""
    at = 0
    while at < len(data):
        if len(data) - at < _LEAST:
            raise _short(f"{where}: byte {at}", len(data) - at)
        tag, size = _HEAD.unpack_from(data, at)
        if tag != TAG:
            raise _not_lmcp(f"{where}: byte {at}", tag)
        if size + 12 > len(data) - at:
            raise _length(f"{where}: byte {at}", size, len(data) - at)
        yield data[at : at + size + 12]
        at += size + 12


def _checked(data: bytes, where: str) -> None:
    if len(data) < _LEAST:
        raise _short(where, len(data))
    tag, size = _HEAD.unpack_from(data)
    if tag != TAG:
        raise _not_lmcp(f"{where}: byte 0", tag)
    if size + 12 != len(data):
        raise _length(f"{where}: byte 4", size, len(data))
    if size > MAX_MESSAGE:
        raise _long(where, size)
    (given,) = _SUM.unpack_from(data, len(data) - 4)
    if given and given != (total := byte_sum(memoryview(data)[:-4])):
        place = f"{where}: byte {len(data) - 4}"
        raise BadInput("wrong checksum", where=place, expected=f"{total}", got=f"{given}")


def _short(where: str, size: int) -> BadInput:
    return BadInput("message too short", where=where, expected=f"{_LEAST} bytes", got=f"{size}")


def _not_lmcp(where: str, tag: bytes) -> BadInput:
    return BadInput("not an LMCP message", where=where, expected="b'LMCP'", got=repr(tag))


def _length(where: str, size: int, got: int) -> BadInput:
    return BadInput("wrong length of message", where=where, expected=f"{size + 12}", got=f"{got}")


def _long(where: str, size: int) -> BadInput:
    return BadInput(
        "message too long", where=where, expected=f"at most {MAX_MESSAGE} bytes", got=f"{size}"
    )
