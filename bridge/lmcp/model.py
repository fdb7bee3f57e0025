"""The LMCP message models: the product's own, and those that are loaded at run time.

A model lists the enums and structs of a series; every field has a primitive type, or names an enum or a struct as
`SERIES/Name`. `LmcpObject` as a type means any struct. The product's own are read from `spec/lmcp/<SERIES>.json` one
series at a time; `lmcp.mdm` adds others from MDM files.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import cratous.spec
from cratous.spec.errors import BadInput

# The order decides which type a short name in several series means (TaskProgress).
SERIES = (
    "CRATOUS",
    "CMASI",
    "UXTASK",
    "ROUTE",
    "IMPACT",
    "UXNATIVE",
    "VEHICLES",
    "PERCEIVE",
    "DAIDALUS",
)
INTEGER_RANGES = {
    "byte": (0, 2**8 - 1),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
}
ANY = "LmcpObject"
_FOLDER = Path(cratous.spec.__path__[0]) / "lmcp"
_NO_DEFAULT = object()


@dataclass(frozen=True)
class Field:
    """One field: `kind` is the primitive's own name, or "enum", "struct" or "any".

    array: None for one value, 0 for a variable array, n for exactly n elements. `large` arrays have a 32-bit count on
    the wire. `default` is None also for a struct that is initially null. `max_length` is the model's limit of an
    array's length; no implementation enforces it.
    """

    name: str
    type: str
    kind: str
    array: int | None
    large: bool
    has_default: bool
    default: Any
    units: str
    optional: bool
    max_length: int | None = None

    @property
    def nullable(self) -> bool:
        """True iff null is a legal value of the field (never true of arrays)."""
        return self.kind in ("struct", "any") and (self.optional or self.has_default)


@dataclass(frozen=True)
class Struct:
    """A struct without its ancestors' fields; `extends` is `SERIES/Name` or empty."""

    name: str
    series: str
    id: int
    extends: str
    fields: tuple[Field, ...]


@dataclass(frozen=True)
class Series:
    """One series: its name, namespace with slashes, version, enums and structs by name."""

    name: str
    namespace: str
    version: int
    enums: dict[str, dict[str, int]]
    structs: dict[str, Struct]

    @property
    def wire_id(self) -> int:
        """The name padded with NUL to 8 bytes, read as a big-endian signed integer."""
        return int.from_bytes(self.name.encode("ascii").ljust(8, b"\0"), "big", signed=True)

    def full_name(self, name: str) -> str:
        """The dotted name of one of its types, e.g. `afrl.cmasi.Task`."""
        return f"{self.namespace.replace('/', '.')}.{name}"


def _field(data: dict[str, Any]) -> Field:
    array = data.get("array")
    default = data.get("default", _NO_DEFAULT)
    return Field(
        name=data["name"],
        type=data["type"],
        kind=data.get("kind", data["type"]),
        array=0 if array == "variable" else array,
        large=data.get("large", False),
        has_default=default is not _NO_DEFAULT,
        default=None if default is _NO_DEFAULT else default,
        units=data.get("units", ""),
        optional=data.get("optional", False),
        max_length=data.get("max_length"),
    )


_added: dict[str, Series] = {}


def known() -> tuple[str, ...]:
    """The names of all series: the product's own, then those added, in the order of adding."""
    return (*SERIES, *_added)


def add(models: Iterable[Series]) -> tuple[str, ...]:
    """Register series together (they may refer to each other); returns the names that are new.

    A series that is known already must be the same. Raises BadInput, and then adds none, for one that differs or that
    refers to a type that does not exist.
    """
    fresh: dict[str, Series] = {}
    for one in models:
        old = fresh.get(one.name) or (load(one.name) if one.name in known() else None)
        if old is None:
            fresh[one.name] = one
        elif old != one:
            raise BadInput(
                "another model of a series that is known",
                item=one.name,
                expected=f"version {old.version} as it is known",
                got=f"version {one.version}"
                + ("" if old.version != one.version else ", different"),
            )
    everything = {**{name: load(name) for name in known()}, **fresh}
    for one in fresh.values():
        for other in everything.values():
            if other is not one and one.namespace == other.namespace:
                raise BadInput(
                    "two series of one namespace",
                    item=one.name,
                    got=f"{one.namespace}, {other.name}",
                )
        _refers_to_what_exists(one, everything)
    _added.update(fresh)
    load.cache_clear()
    series_with.cache_clear()
    return tuple(fresh)


def remove(series: str) -> None:
    """Remove a series that was added; classes made from it stay valid, but are no longer found."""
    if _added.pop(series, None) is None:
        raise BadInput("not a series that was added", item=series)
    for cached in (load, series_with, resolve):
        cached.cache_clear()
    for forget in _when_removed:
        forget(series)


_when_removed: list[Callable[[str], None]] = []


def when_removed(forget: Callable[[str], None]) -> None:
    """Register a callback `forget(series)` for when a series is removed, to clear caches."""
    _when_removed.append(forget)


def _refers_to_what_exists(one: Series, everything: dict[str, Series]) -> None:
    def part(kind: str, name: str, item: str) -> None:
        series, _, short = name.partition("/")
        if series not in everything or short not in getattr(everything[series], kind):
            raise BadInput(
                f"unknown {kind[:-1]}", item=item, expected="a type that exists", got=name
            )

    for struct in one.structs.values():
        item, seen = f"{one.name}/{struct.name}", set()
        at = struct
        while at.extends:
            part("structs", at.extends, item)
            if at.extends in seen or at.extends == item:
                raise BadInput("struct that extends itself", item=item, got=at.extends)
            seen.add(at.extends)
            series, _, short = at.extends.partition("/")
            at = everything[series].structs[short]
        for field in struct.fields:
            if field.kind in ("enum", "struct"):
                part(f"{field.kind}s", field.type, f"{item}.{field.name}")


@cache
def load(series: str) -> Series:
    """The model of one series; BadInput for an unknown name."""
    if series in _added:
        return _added[series]
    if series not in SERIES:
        raise BadInput(
            "unknown message series", item=series, expected=" or ".join(known()), got=repr(series)
        )
    return from_dict(json.loads((_FOLDER / f"{series}.json").read_text("utf-8")))


def from_dict(data: dict[str, Any]) -> Series:
    """The model in a file of `spec/lmcp`; its form is not checked (`lmcp.mdm` does)."""
    structs = {
        s["name"]: Struct(
            s["name"],
            data["series"],
            s["id"],
            s.get("extends", ""),
            tuple(_field(f) for f in s["fields"]),
        )
        for s in data["structs"]
    }
    return Series(data["series"], data["namespace"], data["version"], data["enums"], structs)


def _in_series(series: str, name: str) -> bool:
    model = load(series)
    return name in model.structs or name in model.enums


@cache
def series_with(name: str) -> tuple[str, ...]:
    """The series that have a type of that short name; loads every model."""
    return tuple(s for s in known() if _in_series(s, name))


@cache
def resolve(name: str) -> tuple[str, str]:
    """(series, short name) of a type named in any of the three ways; BadInput if unknown."""
    if "/" in name:
        series, _, short = name.partition("/")
        if series in known() and _in_series(series, short):
            return series, short
    elif "." in name:
        space, _, short = name.rpartition(".")
        for series in known():
            if load(series).namespace.replace("/", ".") == space and _in_series(series, short):
                return series, short
    else:
        for series in known():
            if _in_series(series, name):
                return series, name
    raise BadInput("unknown message type", item=name, expected="a type of " + ", ".join(known()))
