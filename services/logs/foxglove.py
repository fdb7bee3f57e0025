"""JSON Schemas of LMCP types, in the form that Foxglove reads.

Foxglove needs `"type": "object"` at the top and one plain type for each property, so nested types
are inlined, an enum is a string, and a field that may be null is omitted from the message when it
is null (reading it back gives null again). A recursive type is any object. NaN and the infinities
have no JSON number: they are written as text.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from cratous.bridge import lmcp


@cache
def schema_of(topic: str) -> dict[str, Any]:
    """The JSON Schema of a type, by its full name; BadInput for an unknown type."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **_struct(lmcp.types[topic], ()),
        "title": topic,
    }


def _struct(cls: Any, above: tuple[Any, ...]) -> dict[str, Any]:
    if cls in above:
        return {"type": "object"}
    properties: dict[str, Any] = {"$type": {"type": "string"}}
    for field in cls.fields:
        one = _one(field, (*above, cls))
        properties[field.name] = one if field.array is None else {"type": "array", "items": one}
    return {"type": "object", "properties": properties}


def _one(field: Any, above: tuple[Any, ...]) -> dict[str, Any]:
    units = {"description": field.units} if getattr(field, "units", "") else {}
    if field.kind == "struct":
        return _struct(lmcp.types[field.type], above)
    if field.kind == "any":
        return {"type": "object"}
    if field.kind == "enum":
        return {"type": "string", "enum": list(lmcp.enums[field.type].__members__)}
    if field.kind == "bool":
        return {"type": "boolean"}
    if field.kind in ("string", "char"):
        return {"type": "string"}
    return {"type": "number" if field.kind.startswith("real") else "integer", **units}


def without_null(data: Any) -> Any:
    """The JSON form without fields that are null; elements of arrays are kept."""
    if isinstance(data, dict):
        return {key: without_null(value) for key, value in data.items() if value is not None}
    return [without_null(value) for value in data] if isinstance(data, list) else data
