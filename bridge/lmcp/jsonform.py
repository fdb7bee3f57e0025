"""The canonical JSON form of LMCP objects, used by the log: fast and deterministic.

`{"$type": "CMASI/AirVehicleState", "ID": 400, ...}`: all fields, in the order of the wire, no blanks, enums by name,
the shortest digits that give back the same double. JSON has no numbers for not-a-number and the infinities: they are
written as "NaN", "Infinity" and "-Infinity".
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from functools import cache, partial
from keyword import iskeyword
from typing import Any

from cratous.bridge.lmcp.fast_json import plain_object
from cratous.bridge.lmcp.json_text import plain_text
from cratous.bridge.lmcp.model import ANY, INTEGER_RANGES, when_removed
from cratous.bridge.lmcp.objects import (
    LmcpEnum,
    LmcpObject,
    enums,
    real,
    types,
    unknown_field,
    within,
)
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import json_of

_encode = json.JSONEncoder(
    separators=(",", ":"), ensure_ascii=False, allow_nan=False, check_circular=False
).encode
_NON_FINITE = ("NaN", "Infinity", "-Infinity")
_NUMBERS, _NESTED = (int, float, bool), ("struct", "any", "enum")
_MAX_DEPTH = 64


@cache
def _plan(cls: Any) -> tuple[tuple[int, ...], tuple[int, ...], tuple[str, ...]]:
    """Positions (in the wire's order, `$type` being 0) of the reals and of the non-primitives."""
    reals, others = [], []
    for i, field in enumerate(cls.fields, 1):
        if field.array is not None or field.kind in ("enum", "struct", "any"):
            others.append(i)
        elif field.kind.startswith("real"):
            reals.append(i)
    return tuple(reals), tuple(others), ("$type", *cls.names)


def _plain(value: Any) -> Any:
    kind = type(value)
    if kind is list:
        return [_plain(v) for v in value]
    if isinstance(value, LmcpEnum):
        return value.name
    if isinstance(value, LmcpObject):
        return to_dict(value)
    return value


def to_dict(obj: LmcpObject) -> dict[str, Any]:
    """The JSON form as a dictionary; non-finite numbers are still floats in it."""
    cls: Any = type(obj)
    reals, others, keys = _plan(cls)
    values = [cls.type_name, *cls.values_of(obj)]
    for i in reals:
        if type(values[i]) is not float:
            values[i] = real(values[i])
    for i in others:
        values[i] = _plain(values[i])
    return dict(zip(keys, values, strict=True))


def _spell_non_finite(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
    if isinstance(value, list):
        return [_spell_non_finite(v) for v in value]
    if isinstance(value, dict):
        return {k: _spell_non_finite(v) for k, v in value.items()}
    return value


def to_data(obj: LmcpObject) -> dict[str, Any]:
    """The data encoded by `to_json`; for an object read from bytes, whose fields have their types."""
    cls: Any = type(obj)
    reals, others, keys = _plan(cls)
    values = [cls.type_name, *cls.values_of(obj)]
    for i in reals:
        value = real(values[i])
        values[i] = value if value - value == 0 else _spell_non_finite(value)
    for i in others:
        values[i] = _data(values[i])
    return dict(zip(keys, values, strict=True))


def _data(value: Any) -> Any:
    if type(value) is list:
        return [_data(one) for one in value]
    if isinstance(value, LmcpObject):
        return to_data(value)
    return _spell_non_finite(_plain(value))


def to_json(obj: LmcpObject) -> str:
    """One line of canonical JSON; BadInput if a field holds a value of another type."""
    plain = plain_text(obj)
    if plain is not None:
        return plain
    try:
        return _encode(to_dict(obj))
    except RecursionError:
        raise BadInput("nested too deeply", item=type(obj).__name__) from None
    except (ValueError, TypeError):  # a non-finite number, or a wrong or a numpy value
        return _encode(_spell_non_finite(to_dict(obj.copy().checked())))


def from_json(text: str | bytes, where: str = "") -> Any:
    """The object of a JSON text; BadInput (with `where`) for any other text."""
    if type(text) is str:
        plain = plain_object(text)
        if plain is not None:
            return plain
    return from_dict(json_of(text, where), where)


def from_dict(data: Any, where: str = "") -> Any:
    """The object of a dictionary in the JSON form; missing fields keep their default."""
    try:
        return _object(data, 0)
    except BadInput as err:
        err = within(err, "") if not where else err
        raise BadInput(
            err.what, where=where, item=err.item, expected=err.expected, got=err.got
        ) from None


def _object(data: Any, depth: int) -> LmcpObject:
    if not isinstance(data, dict) or not isinstance(data.get("$type"), str):
        raise BadInput("not an LMCP object", expected='{"$type": ...}', got=repr(data)[:60])
    if depth > _MAX_DEPTH:
        raise BadInput("nested too deeply", expected=f"at most {_MAX_DEPTH} levels")
    cls, names, read = _readers.get(data["$type"]) or _reader(data["$type"])
    if tuple(data) == names:  # all fields in the order of the wire, as we write them
        return read(cls.__new__(cls), data.values(), depth)
    kinds = _kinds(cls)
    values = {}
    for name, value in data.items():
        if name == "$type":
            continue
        kind = kinds.get(name)
        if kind is None:
            raise unknown_field(cls, name)
        if type(value) in _NUMBERS and kind not in _NESTED:
            values[name] = value
            continue
        try:
            values[name] = _value(kind, value, depth)
        except BadInput as err:
            raise within(err, f"{cls.__name__}.{name}") from None
    return cls(**values)


Reader = tuple[Any, tuple[str, ...], Callable[..., Any]]
_readers: dict[str, Reader] = {}
when_removed(lambda _series: _readers.clear())


def _reader(type_name: str) -> Reader:
    """For a type: its class, the field names of a complete object, and a generated function that fills a new object
    with its values, checking only the type of most of them."""
    cls: Any = types[type_name]
    scope: dict[str, Any] = {"given": partial(_given, cls), "listed": partial(_listed, cls)}
    named = "".join(f", v{i}" for i in range(len(cls.fields)))
    lines = [f"def read(obj, values, depth):\n    (_{named or ','}) = values"]
    for i, field in enumerate(cls.fields):
        if field.kind == "enum":
            scope[f"members{i}"] = dict(enums[field.type].__members__)
        fits, value = _fits(field, i)
        is_list = field.array is not None and field.kind in ("struct", "any")
        other = f"{'listed' if is_list else 'given'}({i}, v{i}, depth)"
        kept = f"{value} if {fits} else {other}" if fits else other
        plain = field.name.isidentifier() and not iskeyword(field.name)  # models may be foreign
        lines.append(
            f"    obj.{field.name} = {kept}"
            if plain
            else f"    setattr(obj, {field.name!r}, {kept})"
        )
    exec("\n".join([*lines, "    return obj"]), scope)
    found = _readers[type_name] = (cls, ("$type", *cls.names), scope["read"])
    return found


def _fits(field: Any, i: int) -> tuple[str, str]:
    """A condition on a value, and the expression to store if it holds; empty strings if there is none."""
    kind, name = field.kind, f"v{i}"
    if field.array is not None or kind in ("struct", "any", "char"):
        return "", name
    if kind == "enum":
        return f"type({name}) is str and {name} in members{i}", f"members{i}[{name}]"
    if kind in INTEGER_RANGES:
        low, high = INTEGER_RANGES[kind]
        return f"type({name}) is int and {low} <= {name} <= {high}", name
    if kind == "real32":
        return f"type({name}) is float and -3e38 < {name} < 3e38", name
    return f"type({name}) is {({'real64': 'float', 'bool': 'bool', 'string': 'str'})[kind]}", name


def _given(cls: Any, i: int, value: Any, depth: int) -> Any:
    """The value of a field in its stored form; BadInput, naming the field, if it is invalid."""
    field = cls.fields[i]
    try:
        plain = type(value) in _NUMBERS and field.kind not in _NESTED
        return cls._checks[field.name](value if plain else _value(field.kind, value, depth))
    except BadInput as err:
        raise within(err, f"{cls.__name__}.{field.name}") from None


def _listed(cls: Any, i: int, value: Any, depth: int) -> Any:
    """The same for a list of objects."""
    field = cls.fields[i]
    if type(value) is not list or field.array:
        return _given(cls, i, value, depth)
    try:
        made = [None if one is None else _value(field.kind, one, depth) for one in value]
        base = LmcpObject if field.type == ANY else types[field.type]
        if all(one is None or isinstance(one, base) for one in made):
            return made
        return cls._checks[field.name](made)
    except BadInput as err:
        raise within(err, f"{cls.__name__}.{field.name}") from None


@cache
def _kinds(cls: Any) -> dict[str, str]:
    """The kind of each field of a class."""
    return {field.name: field.kind for field in cls.fields}


def _value(kind: str, value: Any, depth: int) -> Any:
    if isinstance(value, list):
        return [_value(kind, v, depth) for v in value]
    if kind in ("struct", "any"):
        return None if value is None else _object(value, depth + 1)
    if kind.startswith("real") and isinstance(value, str) and value in _NON_FINITE:
        return float(value)
    if kind == "enum" and not isinstance(value, str):
        raise BadInput("wrong value", expected="the enum's name", got=repr(value)[:60])
    return value
