"""Typing stubs of the message classes, so that editors complete fields and mypy checks them.

The classes are made from the models on first use; the stubs `messages/<series>.pyi` are written from the same models
by `python -m cratous.bridge.lmcp.generate`, and a test checks that they are up to date. `cratous lmcp describe
--stubs` prints those of any series, also of a loaded one.
"""

from __future__ import annotations

import re

from cratous.bridge.lmcp import describe, model

_PYTHON = {"bool": "bool", "string": "str", "char": "str", "real32": "float", "real64": "float"}


def stub(series: str) -> str:
    """The text of a series' stub file."""
    loaded = model.load(series)
    used = {series}
    body: list[str] = []
    for name, entries in loaded.enums.items():
        body.append(f"\nclass {name}(LmcpEnum):")
        body += [f"    {entry} = {value}" for entry, value in entries.items()]
    for name in _parents_first(loaded):
        body += _struct(loaded, loaded.structs[name], used)
    text = "\n".join(body)
    base = [name for name in ("LmcpEnum", "LmcpObject") if re.search(rf"\b{name}\b", text)]
    lines = [f'"""Messages of {series}, version {loaded.version}. Generated; do not edit."""', ""]
    if "Iterable[" in text:
        lines += ["from collections.abc import Iterable", ""]
    for module in sorted(s.lower() for s in used):
        if f"_{module}." in text:
            lines.append(f"from cratous.bridge.lmcp.messages import {module} as _{module}")
    if base:
        lines.append(f"from cratous.bridge.lmcp.objects import {', '.join(base)}")
    return "\n".join(lines) + f"\n{text}\n"


def _parents_first(loaded: model.Series) -> list[str]:
    done: list[str] = []

    def visit(name: str) -> None:
        series, _, parent = loaded.structs[name].extends.partition("/")
        if series == loaded.name and parent not in done:
            visit(parent)
        if name not in done:
            done.append(name)

    for name in loaded.structs:
        visit(name)
    return done


def _type(full: str, used: set[str]) -> str:
    # Always with the module: within a class a field may have the name of its type.
    series, _, name = full.partition("/")
    used.add(series)
    return f"_{series.lower()}.{name}"


def _field_type(field: model.Field, used: set[str]) -> str:
    if field.kind == "any":
        name = "LmcpObject"
    elif field.kind in ("enum", "struct"):
        name = _type(field.type, used)
    else:
        name = _PYTHON.get(field.kind, "int")
    if field.array is not None:
        return f"list[{name}]"
    return f"{name} | None" if field.nullable else name


def _argument_type(field: model.Field, used: set[str]) -> str:
    name = _field_type(field, used)
    if field.kind == "enum":
        one = _type(field.type, used) + " | str"
        return one if field.array is None else f"Iterable[{one}]"
    return name.replace("list[", "Iterable[") if field.array is not None else name


def _struct(loaded: model.Series, struct: model.Struct, used: set[str]) -> list[str]:
    base = _type(struct.extends, used) if struct.extends else "LmcpObject"
    series, _, parent = struct.extends.partition("/")
    if series == loaded.name:
        base = parent
    lines = [f"\nclass {struct.name}({base}):"]
    lines.append(f'    """{loaded.full_name(struct.name)}: {loaded.name} type {struct.id}."""')
    if struct.fields:
        lines.append("")
    for field in struct.fields:
        lines.append(f"    {field.name}: {_field_type(field, used)}")
        lines.append(f'    """{describe.field_line(field).partition(": ")[2]}."""')
    fields = _all_fields(struct)
    if not fields:
        return [*lines, "    def __init__(self) -> None: ..."]
    lines += ["    def __init__(", "        self,", "        *,"]
    lines += [f"        {f.name}: {_argument_type(f, used)} = ...," for f in fields]
    return [*lines, "    ) -> None: ..."]


def _all_fields(struct: model.Struct) -> tuple[model.Field, ...]:
    if not struct.extends:
        return struct.fields
    series, _, name = struct.extends.partition("/")
    return _all_fields(model.load(series).structs[name]) + struct.fields
