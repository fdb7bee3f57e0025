"""What JSON Schema the records of missions and plans would have, by their type hints."""

from __future__ import annotations

import dataclasses
import types
from enum import Enum
from typing import Any, Union, get_args, get_origin, get_type_hints

PLAIN = {bool: "boolean", int: "integer", float: "number", str: "string"}


def record_definitions(*records: type) -> dict[str, Any]:
    """Definitions of JSON Schema for records as `services.logs.records.to_data` writes them, by name.

    Every field is required and no other is allowed; a record that has subclasses is one of them.
    """
    found: dict[str, Any] = {}
    for record in records:
        _reference(record, found)
    return found


def _reference(record: type, found: dict[str, Any]) -> dict[str, Any]:
    name = record.__name__
    if name not in found:
        found[name] = {}  # a record may hold one of its own kind
        found[name] = _record(record, found)
    own = {"$ref": f"#/$defs/{name}"}
    below = [_reference(one, found) for one in _subclasses(record)]
    return {"anyOf": [own, *below]} if below else own


def _subclasses(record: type) -> list[type]:
    if not dataclasses.is_dataclass(record):
        return []
    # one that adds no field looks the same in a file
    own = {field.name for field in dataclasses.fields(record)}
    return [
        one
        for one in record.__subclasses__()
        if {field.name for field in dataclasses.fields(one)} != own
    ]


def _record(record: type, found: dict[str, Any]) -> dict[str, Any]:
    hints = get_type_hints(record)
    names = (
        [field.name for field in dataclasses.fields(record)]
        if dataclasses.is_dataclass(record)
        else list(getattr(record, "_fields", ()))
    )
    return {
        "type": "object",
        "properties": {name: _schema(hints[name], found) for name in names},
        "required": names,
        "additionalProperties": False,
    }


def _schema(hint: Any, found: dict[str, Any]) -> dict[str, Any]:
    """The schema of one type hint; TypeError for one that records do not use."""
    origin = get_origin(hint)
    if origin in (Union, types.UnionType):
        return {"anyOf": [_schema(option, found) for option in get_args(hint)]}
    if hint is type(None):
        return {"type": "null"}
    if origin is tuple:
        parts = get_args(hint)
        if len(parts) == 2 and parts[1] is Ellipsis:
            return {"type": "array", "items": _schema(parts[0], found)}
        rows = [_schema(part, found) for part in parts]
        return {"type": "array", "prefixItems": rows, "items": False, "minItems": len(rows)}
    if isinstance(hint, type) and issubclass(hint, Enum):
        return {"enum": [member.value for member in hint]}
    if hint in PLAIN:
        return {"type": PLAIN[hint]}
    if dataclasses.is_dataclass(hint) or hasattr(hint, "_fields"):
        return _reference(hint, found)
    raise TypeError(f"no schema for {hint}")
