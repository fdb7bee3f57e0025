"""Differences between two messages, or between two versions of a series."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from cratous.bridge.lmcp import describe, model
from cratous.bridge.lmcp.objects import LmcpObject


@dataclass(frozen=True)
class Difference:
    """One difference: its path, and the value on either side."""

    path: str
    first: str
    second: str

    def __str__(self) -> str:
        return f"{self.path}: {self.first} | {self.second}"


def of_objects(first: Any, second: Any, path: str = "") -> Iterator[Difference]:
    """The differences of two objects (or two values), in the order of the fields."""
    for value in (first, second):
        if isinstance(value, LmcpObject):
            value.complete()
    if isinstance(first, LmcpObject) and type(first) is type(second):
        for name in first.names:
            here = f"{path}.{name}" if path else f"{type(first).__name__}.{name}"
            yield from of_objects(getattr(first, name), getattr(second, name), here)
    elif isinstance(first, list) and isinstance(second, list):
        for i in range(max(len(first), len(second))):
            here = f"{path}[{i}]"
            if i >= len(first):
                yield Difference(here, "nothing", _text(second[i]))
            elif i >= len(second):
                yield Difference(here, _text(first[i]), "nothing")
            else:
                yield from of_objects(first[i], second[i], here)
    elif not _same(first, second):
        yield Difference(path or "message", _text(first), _text(second))


def _same(first: Any, second: Any) -> bool:
    if isinstance(first, float) and isinstance(second, float):
        # two NaNs count as equal; 0.0 and -0.0 do not, since they differ on the wire
        return repr(first) == repr(second)
    return type(first) is type(second) and bool(first == second)


def _text(value: Any) -> str:
    text = "null" if value is None else repr(value)
    return text if len(text) <= 200 else text[:197] + "..."


def of_series(first: model.Series, second: model.Series) -> Iterator[Difference]:
    """The differences of two series by which a message of one is misread or refused under the other."""
    for part in ("name", "version", "namespace"):
        yield from _differs(part, getattr(first, part), getattr(second, part))
    for name in (*first.enums, *(n for n in second.enums if n not in first.enums)):
        one, two = first.enums.get(name), second.enums.get(name)
        if one is None or two is None:
            yield Difference(name, "enum" if one else "nothing", "enum" if two else "nothing")
            continue
        for entry in (*one, *(e for e in two if e not in one)):
            yield from _differs(f"{name}.{entry}", one.get(entry), two.get(entry))
    for name in (*first.structs, *(n for n in second.structs if n not in first.structs)):
        yield from _structs(name, first.structs.get(name), second.structs.get(name))


def _structs(name: str, one: model.Struct | None, two: model.Struct | None) -> Iterator[Difference]:
    if one is None or two is None:
        sides = [f"type {side.id}" if side else "nothing" for side in (one, two)]
        yield Difference(name, *sides)
        return
    yield from _differs(f"{name} type", one.id, two.id)
    yield from _differs(f"{name} extends", one.extends, two.extends)
    fields = [{f.name: f for f in side.fields} for side in (one, two)]
    for field in (*fields[0], *(f for f in fields[1] if f not in fields[0])):
        lines = [_line(side.get(field)) for side in fields]
        yield from _differs(f"{name}.{field}", *lines)
    both = [[f for f in side if f in fields[0] and f in fields[1]] for side in fields]
    if both[0] != both[1]:
        yield Difference(f"{name} order", ", ".join(both[0]), ", ".join(both[1]))


def _line(field: model.Field | None) -> str | None:
    if field is None:
        return None
    text = f"{describe.type_text(field)}{' [' + field.units + ']' if field.units else ''}"
    if field.has_default:
        text += f" = {field.default}"
    return (
        text + (", 32-bit count" if field.large else "") + (", optional" if field.optional else "")
    )


def _differs(path: str, one: Any, two: Any) -> Iterator[Difference]:
    if one != two:
        sides = ["nothing" if side in (None, "") else str(side) for side in (one, two)]
        yield Difference(path, *sides)
