"""The JSON Schema of our JSON form of LMCP, made from the models.

`spec/lmcp/lmcp.schema.json` is the published one, of all series of the product; `cratous lmcp schema` prints it, or
that of some types, also of loaded series. The schema describes what `from_json` accepts: `$type` is required, a
missing field has its default, unknown fields are refused. It cannot express that a text has at most 65535 bytes in
UTF-8.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.bridge.lmcp import describe, model
from cratous.bridge.lmcp.objects import types

DIALECT = "https://json-schema.org/draft/2020-12/schema"
_REAL = {"anyOf": [{"type": "number"}, {"enum": ["NaN", "Infinity", "-Infinity"]}]}
_NULL = {"type": "null"}


def schema(names: Iterable[str] = ()) -> dict[str, Any]:
    """The schema of objects of the named types (in any of the three ways); of all types if none is named."""
    chosen = [types[name].type_name for name in names] or [types[n].type_name for n in types]
    defs: dict[str, Any] = {"real": _REAL}
    for name in chosen:
        _define(name, defs)
    return {
        "$schema": DIALECT,
        "title": "LMCP messages in the JSON form of CRATOUS",
        "anyOf": [_ref(name) for name in chosen],
        "$defs": dict(sorted(defs.items())),
    }


def _ref(name: str) -> dict[str, str]:
    return {"$ref": "#/$defs/" + name.replace("~", "~0").replace("/", "~1")}


def _heirs(name: str) -> list[str]:
    """The types that a field of this type may hold: itself and all that extend it."""
    if name == model.ANY:
        return [types[n].type_name for n in types]
    return [types[n].type_name for n in types if issubclass(types[n], types[name])]


def _define(name: str, defs: dict[str, Any]) -> None:
    if name in defs:
        return
    cls = types[name]
    properties: dict[str, Any] = {"$type": {"const": name}}
    defs[name] = {
        "type": "object",
        "description": cls.all_names[0],
        "properties": properties,
        "required": ["$type"],
        "additionalProperties": False,
    }
    for field in cls.fields:
        one = _one(field, defs)
        if field.array is None:
            value = {**one, "description": describe.field_line(field).partition(": ")[2]}
        else:
            value = {"type": "array", "items": one}
            if field.array:
                value |= {"minItems": field.array, "maxItems": field.array}
        properties[field.name] = value


def _one(field: model.Field, defs: dict[str, Any]) -> dict[str, Any]:
    kind = field.kind
    if kind in ("struct", "any"):
        key = f"any {field.type}"
        if key not in defs:
            heirs = _heirs(field.type)
            defs[key] = {"anyOf": [_ref(name) for name in heirs]}
            for name in heirs:
                _define(name, defs)
        nullable = field.nullable or field.array is not None
        return {"anyOf": [_ref(key), _NULL]} if nullable else dict(_ref(key))
    if kind == "enum":
        series, _, short = field.type.partition("/")
        defs.setdefault(field.type, {"enum": list(model.load(series).enums[short])})
        return dict(_ref(field.type))
    if kind in model.INTEGER_RANGES:
        low, high = model.INTEGER_RANGES[kind]
        return {"type": "integer", "minimum": low, "maximum": high}
    if kind.startswith("real"):
        return dict(_ref("real"))
    if kind == "char":
        return {"type": "string", "minLength": 1, "maxLength": 1}
    return {"type": "boolean" if kind == "bool" else "string"}
