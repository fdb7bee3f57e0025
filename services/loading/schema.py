"""Validates a document against the JSON Schema of missions or campaigns, with errors for users."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import Any

from cratous.services.loading.document import Document, Key, item_name
from cratous.spec.errors import BadInput
from cratous.spec.files.schema_check import Check, fits

_KINDS = {
    "object": "a mapping",
    "array": "a list",
    "string": "a text",
    "integer": "a whole number",
    "number": "a number",
    "boolean": "true or false",
}


@cache
def mission_schema() -> dict[str, Any]:
    """The published JSON Schema (draft 2020-12)."""
    text = files("cratous.spec.mission").joinpath("mission.schema.json").read_text("utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


@cache
def _fits_mission() -> Check:
    """The mission validator, created once: this takes longer than checking a small mission."""
    return fits(mission_schema())


def schema_problems(document: Document, schema: dict[str, Any] | None = None) -> list[BadInput]:
    """All violations of a schema (the mission's unless another is given), in file order."""
    asked = schema or mission_schema()
    check = fits(asked) if schema else _fits_mission()
    if check(document.data):
        return []
    from jsonschema import Draft202012Validator

    found: list[tuple[Key, BadInput]] = []
    for error in Draft202012Validator(asked).iter_errors(document.data):
        found.extend(_problems(document, error))
    order = [(document.lines.get(key, 0), str(key), problem) for key, problem in found]
    return [problem for _, _, problem in sorted(order, key=lambda row: row[:2])]


def _problems(document: Document, error: Any) -> list[tuple[Key, BadInput]]:
    key: Key = tuple(error.absolute_path)
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        return [
            _problem(document, (*key, name), "unknown entry", _nearest(name, known), "it")
            for name in error.instance
            if name not in known
        ]
    if error.validator == "required":
        missing = [name for name in error.validator_value if name not in error.instance]
        name = next(name for name in missing if f"'{name}'" in error.message)
        meaning = error.schema["properties"][name].get("description", "")
        return [_problem(document, (*key, name), "missing", meaning or name, "nothing", key)]
    what, expected = _words(error)
    got = json.dumps(error.instance, ensure_ascii=False, default=str)
    got = got if len(got) <= 80 else f"{got[:77]}..."
    return [_problem(document, key, what, expected, got)]


def _words(error: Any) -> tuple[str, str]:
    """The fault, and what was expected."""
    meaning = error.schema.get("description", "") if isinstance(error.schema, dict) else ""
    limit = error.validator_value
    bounds = {
        "minimum": "at least",
        "maximum": "at most",
        "exclusiveMinimum": "more than",
    }
    if error.validator in bounds:
        return "out of range", f"{bounds[error.validator]} {limit:g} ({meaning})"
    if error.validator == "type":
        return "wrong type", f"{_KINDS.get(limit, limit)} ({meaning})" if meaning else str(limit)
    if error.validator == "enum":
        return "unknown value", "one of " + ", ".join(str(value) for value in limit)
    if error.validator in ("minItems", "maxItems"):
        few = error.validator == "minItems"
        return (
            "too few entries" if few else "too many entries",
            f"{'at least' if few else 'at most'} {limit} ({meaning})",
        )
    if error.validator == "pattern":
        return "not a valid name", "letters, digits, '_' and '-', at most 64 characters"
    return "does not fit", meaning or str(error.message)


def _nearest(name: str, known: dict[str, Any]) -> str:
    from difflib import get_close_matches

    close = get_close_matches(name, list(known), n=1)
    return f"{close[0]}?" if close else "one of " + ", ".join(known)


def _problem(
    document: Document, key: Key, what: str, expected: str, got: str, line_of: Key | None = None
) -> tuple[Key, BadInput]:
    where = document.where(key if line_of is None else line_of)
    if got == "it":
        got = str(key[-1])
    return key, BadInput(what, where=where, item=item_name(key), expected=expected, got=got)
