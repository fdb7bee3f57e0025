"""LMCP objects as XML: fields in the order of the wire, elements of arrays in tags of their type."""

from __future__ import annotations

import re
from typing import Any

from cratous.bridge.lmcp import model
from cratous.bridge.lmcp.base import LmcpObject, within
from cratous.spec.errors import BadInput

_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", "\r": "&#13;"})
_ILLEGAL = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def dumps(obj: LmcpObject) -> str:
    """XML text of an object, fields in the order of the wire, two blanks of indentation."""
    lines: list[str] = []
    try:
        _write(obj.complete(), lines, "")
    except RecursionError:
        raise BadInput("nested too deeply", item=type(obj).__name__) from None
    return "\n".join(lines) + "\n"


def _write(obj: LmcpObject | None, lines: list[str], pad: str) -> None:
    if obj is None:
        lines.append(f"{pad}<null/>")
        return
    name = type(obj).__name__
    lines.append(f'{pad}<{name} Series="{obj.series}">')
    for field in obj.fields:
        try:
            value = obj._checks[field.name](getattr(obj, field.name))
            _write_field(field, value, lines, pad + "  ")
        except BadInput as err:
            raise within(err, f"{name}.{field.name}") from None
    lines.append(f"{pad}</{name}>")


def _write_field(field: model.Field, value: Any, lines: list[str], pad: str) -> None:
    nested = field.kind in ("struct", "any")
    if field.array is None and not nested:
        lines.append(f"{pad}<{field.name}>{_text_of(field, value)}</{field.name}>")
        return
    lines.append(f"{pad}<{field.name}>")
    if field.array is None:
        _write(value, lines, pad + "  ")
    elif nested:
        for i, element in enumerate(value):
            try:
                _write(element, lines, pad + "  ")
            except BadInput as err:
                raise within(err, f"[{i}]") from None
    else:
        tag = field.type.rpartition("/")[2]
        lines += [f"{pad}  <{tag}>{_text_of(field, element)}</{tag}>" for element in value]
    lines.append(f"{pad}</{field.name}>")


def _text_of(field: model.Field, value: Any) -> str:
    if field.kind == "enum":
        return str(value.name)
    if field.kind == "bool":
        return "true" if value else "false"
    if field.kind in ("string", "char"):
        bad = _ILLEGAL.search(value)
        if bad:
            raise BadInput(
                "text that XML cannot hold",
                expected="no control characters",
                got=repr(bad.group()),
            )
        return str(value).translate(_ESCAPES)
    if isinstance(value, float):
        text = repr(value)
        return {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}.get(text, text)
    return str(value)
