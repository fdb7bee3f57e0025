"""Descriptions of message types in words: docstrings of classes, and `cratous lmcp describe`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.bridge.lmcp import model


def type_text(field: model.Field) -> str:
    """The field's type as users write it: `int64`, `CMASI/Task[]`, `real64[2]`."""
    size = "" if field.array is None else "[]" if field.array == 0 else f"[{field.array}]"
    return f"{field.type}{size}"


def default_text(field: model.Field, enum_first: str = "") -> str:
    """The value that a new object has in the field."""
    if field.array is not None:
        return "empty" if field.array == 0 else "all zero"
    if field.kind in ("struct", "any"):
        return "null" if field.has_default or field.kind == "any" else f"a new {field.type}"
    if field.kind == "enum":
        return str(field.default) if field.has_default else enum_first
    if field.has_default:
        return repr(field.default).lower() if field.kind == "bool" else repr(field.default)
    return {"bool": "false", "string": "''", "char": "'\\0'"}.get(
        field.kind, "0.0" if field.kind.startswith("real") else "0"
    )


def field_line(field: model.Field) -> str:
    """One field: type, unit, default, and further properties in the model."""
    first = ""
    if field.kind == "enum":
        series, _, short = field.type.partition("/")
        first = next(iter(model.load(series).enums[short]))
    parts = [type_text(field)]
    if field.units:
        parts.append(f"[{field.units}]")
    parts.append(f"default {default_text(field, first)}")
    if field.nullable:
        parts.append("may be null")
    if field.large:
        parts.append("32-bit count")
    if field.max_length is not None:
        parts.append(f"the model says at most {field.max_length}")
    return f"{field.name}: {parts[0]}" + "".join(
        (" " if part.startswith("[") else ", ") + part for part in parts[1:]
    )


def docstring(series: model.Series, struct: model.Struct, fields: Iterable[model.Field]) -> str:
    """The docstring of a class: its names on the wire and in text, its parent, every field."""
    lines = [
        f"{series.full_name(struct.name)}: {series.name} type {struct.id}, version {series.version}."
    ]
    if struct.extends:
        lines.append(f"\nExtends {struct.extends}; the fields of its ancestors come first.")
    listed = [f"    {field_line(field)}" for field in fields]
    return "\n".join([*lines, *(["\nFields:", *listed] if listed else ["\nNo fields."])])


def pretty(obj: Any, indent: str = "") -> str:
    """An object over several lines, every field with its unit."""
    lines = [f"{type(obj.complete()).__name__} ({obj.type_name})"]
    for field in obj.fields:
        value, name = getattr(obj, field.name), f"{indent}  {field.name}:"
        if field.kind in ("struct", "any") and field.array is None and value is not None:
            lines.append(f"{name} {pretty(value, indent + '  ')}")
        elif field.array is not None and field.kind in ("struct", "any") and value:
            lines.append(name)
            for i, part in enumerate(value):
                text = "null" if part is None else pretty(part, indent + "    ")
                lines.append(f"{indent}    [{i}] {text}")
        else:
            text = "null" if value is None else repr(value)
            lines.append(f"{name} {text}" + (f" {field.units}" if field.units else ""))
    return "\n".join(lines)
