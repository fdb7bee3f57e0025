"""The LMCP message models, read from `spec/lmcp/<SERIES>.json` one series at a time.

A model says which enums and structs a series has; every field has a primitive type, or names an
enum or a struct as `SERIES/Name`. `LmcpObject` as a type means any struct.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import cratous.spec
from cratous.spec.errors import BadInput

# The order decides which type a short name means that several series have (TaskProgress).
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

    array: None for one value, 0 for a variable array, n for exactly n elements. `large` arrays
    have a 32-bit count on the wire. `default` is None also for a struct that starts as null.
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
    )


@cache
def load(series: str) -> Series:
    """The model of one series; BadInput for a name that no model has."""
    if series not in SERIES:
        raise BadInput(
            "unknown message series", item=series, expected=" or ".join(SERIES), got=repr(series)
        )
    text = (_FOLDER / f"{series}.json").read_text("utf-8")
    data = json.loads(text)
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
    return tuple(s for s in SERIES if _in_series(s, name))


@cache
def resolve(name: str) -> tuple[str, str]:
    """(series, short name) of a type named in any of the three ways; BadInput if unknown."""
    if "/" in name:
        series, _, short = name.partition("/")
        if series in SERIES and _in_series(series, short):
            return series, short
    elif "." in name:
        space, _, short = name.rpartition(".")
        for series in SERIES:
            if load(series).namespace.replace("/", ".") == space and _in_series(series, short):
                return series, short
    else:
        for series in SERIES:
            if _in_series(series, name):
                return series, name
    raise BadInput("unknown message type", item=name, expected="a type of " + ", ".join(SERIES))
