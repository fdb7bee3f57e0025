"""Format of argument.yaml: as gsn2x reads it, and validated before it is written."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.resources import files
from typing import Any

import yaml

from cratous.services.argument.elements import Element, State
from cratous.services.argument.escaping import plain_text
from cratous.spec.files.schema_check import Check, fits

SCHEMA_NAME = "argument.schema.json"
Data = dict[str, Any]


def schema_text() -> str:
    """The schema as published (JSON Schema, draft 2020-12)."""
    return files("cratous.services.argument").joinpath(SCHEMA_NAME).read_text("utf-8")


@cache
def _check() -> Check:
    return fits(json.loads(schema_text()))


@cache
def _validator() -> Any:
    from jsonschema import Draft202012Validator

    return Draft202012Validator(json.loads(schema_text()))


def document(elements: Iterable[Element]) -> Data:
    """The elements as plain data, by id."""
    found: Data = {}
    for one in elements:
        entry: Data = {"text": plain_text(one.shown)}
        if one.supported_by:
            entry["supportedBy"] = list(one.supported_by)
        if one.in_context_of:
            entry["inContextOf"] = list(one.in_context_of)
        if one.undeveloped:
            entry["undeveloped"] = True
        if one.state is not State.SUPPORTED:
            entry["classes"] = [one.state.replace(" ", "-")]
        found[one.id] = entry
    return found


def yaml_text(data: Data, header: Iterable[str] = ()) -> str:
    """The text of argument.yaml; header: comment lines. The same data gives the same bytes."""
    head = "".join(f"# {plain_text(line)}\n" for line in header)
    return head + yaml.safe_dump(data, sort_keys=False, allow_unicode=True, width=100)


def faults(data: Any) -> list[str]:
    """Where an argument is malformed: violates its schema, has unresolved ids, several top goals, or cycles."""
    found: list[str] = []
    if not _check()(data):
        found = [f"{_path(e.absolute_path)}: {e.message}" for e in _validator().iter_errors(data)]
    return found or [*_unresolved(data), *_circles(data), *_tops(data)]


def _path(parts: Iterable[Any]) -> str:
    return ".".join(map(str, parts)) or "argument"


def _below(entry: Data) -> list[str]:
    return [*entry.get("supportedBy", ()), *entry.get("inContextOf", ())]


def _unresolved(data: Data) -> Iterator[str]:
    for name, entry in data.items():
        yield from (
            f"{name}: there is no element {other}" for other in _below(entry) if other not in data
        )


def _circles(data: Data) -> Iterator[str]:
    """Elements on cycles, found by removing each element once all its parents are removed."""
    above = dict.fromkeys(data, 0)
    for entry in data.values():
        for other in _below(entry):
            if other in above:
                above[other] += 1
    todo = [name for name, count in above.items() if not count]
    while todo:
        for other in _below(data[todo.pop()]):
            if other in above:
                above[other] -= 1
                if not above[other]:
                    todo.append(other)
    yield from (f"{name}: it leads back to itself" for name, count in above.items() if count)


def _tops(data: Data) -> Iterator[str]:
    """All elements without a parent, unless there is a single one and it is a goal."""
    led_to = {other for entry in data.values() for other in _below(entry)}
    tops = [name for name in data if name not in led_to]
    if len(tops) != 1 or not tops[0].startswith("G"):
        yield f"argument: expected one top goal, got {', '.join(tops) or 'none'}"
