"""The published JSON Schema of report.json: what is written and what is read is held against it.

`report.schema.json` is the file that `cratous certify --schema` prints. Its definitions of mission and
plan are those of the records (`record_definitions`), the rest of it is written by hand.
"""

from __future__ import annotations

import dataclasses
import json
import types
from collections.abc import Iterator
from enum import Enum
from functools import cache
from importlib.resources import files
from itertools import islice
from typing import Any, Union, get_args, get_origin, get_type_hints

from cratous.services.results.names import FORMAT
from cratous.spec.errors import BadInput
from cratous.spec.files.printable import printable

SCHEMA_NAME = "report.schema.json"
FEW = 20
"""So many departures are listed; a report that is another thing altogether has thousands."""
SHORT = 120
PLAIN = {bool: "boolean", int: "integer", float: "number", str: "string"}


def schema_text() -> str:
    """The schema as it is published (JSON Schema, draft 2020-12)."""
    return files("cratous.services.certify").joinpath(SCHEMA_NAME).read_text("utf-8")


@cache
def _validator() -> Any:
    from jsonschema import Draft202012Validator

    return Draft202012Validator(json.loads(schema_text()))


def departures(report: Any) -> list[str]:
    """Where a report is not what the schema says, FEW places at most: path, and what is wrong there."""
    return list(islice(_departures(report), FEW))


def _departures(report: Any) -> Iterator[str]:
    for error in _validator().iter_errors(report):
        path = "".join(
            f"[{part}]" if isinstance(part, int) else f".{_cut(str(part))}"
            for part in error.absolute_path
        )
        yield f"{path.removeprefix('.') or 'report'}: {_cut(error.message)}"


def _cut(text: str) -> str:
    shown = printable(text)
    # the end says what was expected
    return shown if len(shown) <= SHORT else f"{shown[: SHORT // 2]}...{shown[-SHORT // 2 :]}"


def checked(report: dict[str, Any], where: str) -> dict[str, Any]:
    """The report, if it is as the schema says; BadInput with the first departure otherwise."""
    found = departures(report)
    if found:
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        raise BadInput(
            "the report is not as its schema says", where=where, item=found[0].partition(": ")[0],
            expected=f"a report of the format {FORMAT} (cratous certify --schema)",
            got=found[0].partition(": ")[2] + more,
        )  # fmt: skip
    return report


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
    return record.__subclasses__() if dataclasses.is_dataclass(record) else []


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
