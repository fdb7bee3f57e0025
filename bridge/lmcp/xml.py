"""LMCP in XML: reading (fields in any order, strictly checked); writing is in `xml_writing`.

`<Name Series="CMASI"> <Field>...</Field> ... </Name>`. Elements of primitive and enum arrays are in tags of their
type (`<int64>1</int64>`; another width of integer is accepted), structs in tags of theirs, null as `<null/>`, enums
by name. A missing field keeps its default. If a field is given twice, the last one counts, with a note; a field that
the type does not have is ignored with a note: OpenUxAS's own files do both. `strict` makes the second an error. No
entities, no network.
"""

from __future__ import annotations

import re
import struct as _struct
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.bridge.lmcp import model
from cratous.bridge.lmcp.objects import LmcpObject, enums, types, unknown_field
from cratous.bridge.lmcp.xml_text import mended, parse
from cratous.bridge.lmcp.xml_writing import dumps
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import integer_of
from cratous.spec.files.text_file import bytes_of

__all__ = [
    "LmcpNote",
    "dumps",
    "loads",
    "mended",
    "parse",
    "read_element",
    "read_file",
    "read_messages",
]

_INTEGER = re.compile(r"[+-]?[0-9]{1,20}\Z")
_REAL = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?\Z")
_HASH_LINE = re.compile(rb"^#[^\r\n]*", re.MULTILINE)
_NON_FINITE = {"NaN", "Infinity", "-Infinity", "nan", "inf", "-inf", "-nan", "Inf", "-Inf", "INF"}
# OpenUxAS's own files write int64 elements as <uint32>; the range of the field's type counts.
_TAGS: dict[str, set[str]] = {kind: set(model.INTEGER_RANGES) for kind in model.INTEGER_RANGES}
_TAGS |= {kind: {"real32", "real64"} for kind in ("real32", "real64")}


class LmcpNote(UserWarning):
    """Something in an XML file that is legal but may not be what its author intended."""


@dataclass(frozen=True)
class _Source:
    """The place of an element, and how irregularities are handled."""

    where: str
    notes: list[str]
    strict: bool
    finite: bool
    lenient: bool = False

    def place(self, element: Any) -> str:
        return f"{self.where}:{element.sourceline or 1}"

    def note(self, element: Any, text: str) -> None:
        self.notes.append(f"{self.place(element)}: {text}")


def read_file(
    path: str | Path,
    notes: list[str] | None = None,
    *,
    strict: bool = False,
    finite: bool = True,
) -> list[Any]:
    """The objects of an XML file: of its root, or of the children of a root that is not a struct.

    Notes go to `notes`, or become LmcpNote warnings. Raises BadInput for any error; also for NaN and the infinities,
    unless `finite` is False.
    """
    where = str(path)
    return loads(bytes_of(Path(path)), where, notes, strict=strict, finite=finite)


def read_messages(path: str | Path, notes: list[str]) -> list[Any]:
    """The objects of a message file of UxAS, whose reader accepts some of what `read_file` refuses.

    An empty value is the field's default, `<F><KIND>v</KIND></F>` is the value v of an enumeration, a file may hold
    several objects one after the other, and `xml_text.mended` lists the rest; each case is noted. Lines that begin
    with `#` are ignored. All else is refused as in `read_file`.
    """
    data = bytes_of(Path(path))
    data = _HASH_LINE.sub(b"", data)  # the line end is kept: line numbers stay the same
    data = mended(data, str(path), notes)
    head = re.match(rb"\s*(?:<\?xml[^>]*\?>)?", data)
    body = data[head.end() :] if head else data
    try:
        parse(data, str(path))
    except BadInput as problem:
        try:
            parts = len(parse(b"<Messages>" + body + b"</Messages>", str(path)))
        except BadInput:
            raise problem from None
        notes.append(f"{path}: {parts} objects one after the other, without a common root")
        data = b"<Messages>" + body + b"</Messages>"
    return loads(data, str(path), notes, lenient=True)


def loads(
    text: str | bytes,
    where: str = "text",
    notes: list[str] | None = None,
    *,
    strict: bool = False,
    finite: bool = True,
    lenient: bool = False,
) -> list[Any]:
    """The objects of an XML text; see `read_file`, and `read_messages` for lenient."""
    source = _Source(where, [], strict, finite, lenient)
    root = parse(text, where)
    if root.get("Series") is not None or len(model.series_with(root.tag)) > 0:
        objects = [_object(root, source)]
    else:
        objects = [_object(child, source) for child in root]
        if not objects:
            raise BadInput("no LMCP object", where=source.place(root), got=f"<{root.tag}/>")
    if notes is not None:
        notes.extend(source.notes)
    else:
        for note in source.notes:
            warnings.warn(LmcpNote(note), stacklevel=2)
    return objects


def read_element(
    element: Any,
    where: str = "text",
    notes: list[str] | None = None,
    *,
    strict: bool = False,
    finite: bool = True,
) -> Any:
    """The object of one element (of `parse`); the attribute Time of AMASE is left to the caller."""
    return _object(element, _Source(where, [] if notes is None else notes, strict, finite))


def _object(element: Any, source: _Source) -> Any:
    cls = _class_of(element, source)
    fields = {f.name: f for f in cls.fields}
    values: dict[str, Any] = {}
    _no_text(element, source)
    for name in element.keys():  # noqa: SIM118 (an lxml element, not a dictionary)
        if name not in ("Series", "Time"):
            source.note(element, f"attribute {name} of {element.tag} is not used")
    for child in element:
        field = fields.get(child.tag)
        if field is None:
            unknown = unknown_field(cls, child.tag, source.place(child))
            if source.strict:
                raise unknown
            source.notes.append(f"{unknown}; not used")
            continue
        if field.name in values:
            source.note(
                child,
                f"{cls.__name__}.{field.name} is given twice; the last one counts",
            )
        if source.lenient and _left_empty(field, child):
            source.note(child, f"{cls.__name__}.{field.name} is empty: its default is taken")
            values.pop(field.name, None)
            continue
        values[field.name] = _field_value(field, child, source)
    try:
        return cls(**values)
    except BadInput as err:
        raise BadInput(
            err.what,
            where=source.place(element),
            item=err.item,
            expected=err.expected,
            got=err.got,
        ) from None


def _no_text(element: Any, source: _Source) -> None:
    pieces = [element.text, *(child.tail for child in element)]
    for text in pieces:
        if text and text.strip():
            raise BadInput(
                "text between elements",
                where=source.place(element),
                item=element.tag,
                expected="elements only",
                got=repr(text.strip())[:60],
            )


def _class_of(element: Any, source: _Source) -> type[LmcpObject]:
    series, name = element.get("Series"), element.tag
    known = model.series_with(name)
    if series is None and len(known) > 1:
        raise BadInput(
            "type of several series",
            where=source.place(element),
            item=name,
            expected=" or ".join(f'Series="{s}"' for s in known),
            got="no Series",
        )
    full = f"{series or (known[0] if known else '')}/{name}"
    if full not in types:
        raise BadInput(
            "unknown message type",
            where=source.place(element),
            item=name,
            expected=" or ".join(f'{name} of Series="{s}"' for s in known) or "a known type",
            got=full.strip("/"),
        )
    return types[full]


def _field_value(field: model.Field, element: Any, source: _Source) -> Any:
    if element.attrib:
        source.note(element, f"attributes of field {field.name} are not used")
    if field.array is not None:
        _no_text(element, source)
        if field.kind in ("struct", "any"):
            return [_struct_or_null(child, source) for child in element]
        tag = field.type.rpartition("/")[2]
        for child in element:
            if child.tag not in _TAGS.get(field.kind, {tag}):
                raise BadInput(
                    "wrong element in an array",
                    where=source.place(child),
                    item=field.name,
                    expected=f"<{tag}>",
                    got=f"<{child.tag}>",
                )
        return [_primitive(field, child, source) for child in element]
    if field.kind in ("struct", "any"):
        _no_text(element, source)
        if len(element) > 1:
            raise BadInput(
                "more than one object in a field",
                where=source.place(element[1]),
                item=field.name,
                expected="one object",
                got=f"{len(element)}",
            )
        value = _struct_or_null(element[0], source) if len(element) else None
        if value is None and not field.nullable:
            raise BadInput(
                "required field is null",
                where=source.place(element),
                item=field.name,
                expected=field.type,
                got="null",
            )
        return value
    return _primitive(field, element, source)


def _left_empty(field: model.Field, element: Any) -> bool:
    scalar = field.array is None and field.kind not in ("string", "char", "struct", "any")
    return scalar and not len(element) and not (element.text or "").strip()


def _struct_or_null(element: Any, source: _Source) -> Any:
    if element.tag == "null":
        return None
    return _object(element, source)


def _primitive(field: model.Field, element: Any, source: _Source) -> Any:
    def wrong(expected: str) -> BadInput:
        return BadInput(
            "wrong value",
            where=source.place(element),
            item=field.name,
            expected=expected,
            got=repr(text[:60]),
        )

    text = element.text or ""
    if source.lenient and field.kind == "enum" and len(element) == 1:
        kind = field.type.partition("/")[2]
        if element[0].tag == kind and not len(element[0]):
            source.note(element, f"{field.name}: its value is read from <{kind}>")
            element, text = element[0], element[0].text or ""
    if len(element):
        text = f"<{element[0].tag}>"
        raise wrong(f"one value ({field.kind})")
    if field.kind == "string":
        return text
    if field.kind == "char":
        return text
    text = text.strip()
    if field.kind == "enum":
        members = enums[field.type]
        if text not in members.__members__:
            raise wrong(f"{members.__name__}: {' or '.join(members.__members__)}")
        return members[text]
    if field.kind == "bool":
        if text.lower() not in ("true", "false", "1", "0"):
            raise wrong("true or false")
        return text.lower() in ("true", "1")
    if field.kind in ("real32", "real64"):
        if not _REAL.match(text) and (source.finite or text not in _NON_FINITE):
            raise wrong("a number")
        value = float(text)
        if source.finite and value - value != 0:  # overflows a double
            raise wrong("a number within real64")
        if field.kind == "real64" or value != value:
            return value
        try:
            # Rounded to the field's own precision, so that a file has the same meaning for other tools.
            return float(_struct.unpack(">f", _struct.pack(">f", value))[0])
        except OverflowError:
            raise wrong("a number within real32") from None
    if not _INTEGER.match(text):
        raise wrong(field.kind)
    low, high = model.INTEGER_RANGES[field.kind]
    number = integer_of(text, low, high)
    if number is None:
        raise wrong(f"{field.kind} from {low} to {high}")
    return number
