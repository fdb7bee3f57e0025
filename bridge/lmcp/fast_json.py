"""Fast reading of JSON texts of LMCP objects in the form in which we write them, by one pattern per type.

Nearly all messages of a log have this form: all fields in the order of the wire, numbers of usual size, texts without
escapes, lists empty or of integers. A text that matches is JSON, and the result is that of `jsonform` in a third of
the time; for any other text there is no result. A type with a field that patterns do not support has no pattern.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from keyword import iskeyword
from typing import Any, NamedTuple

from cratous.bridge.lmcp.model import INTEGER_RANGES, when_removed
from cratous.bridge.lmcp.objects import enums, types
from cratous.spec.errors import BadInput

Read = Callable[[tuple[Any, ...]], Any]
NESTED_MAX, GROUPS_MAX, LIST_MAX = 4, 200, 1000
_HEAD = '{"$type":"'
_REAL = r"(-?(?:0|[1-9][0-9]{0,17})(?:\.[0-9]{1,20}(?:e-[0-9]{1,2})?|e-[0-9]{1,2}))"
_TEXT = r'"([^"\\\x00-\x1f\ud800-\udfff]{0,1000})"'


class _Plain(NamedTuple):
    """fullmatch: of the pattern; made: builds the object from the pattern's groups."""

    fullmatch: Callable[[str], re.Match[str] | None]
    made: Read


_known: dict[str, _Plain | None] = {}
when_removed(lambda _series: _known.clear())


def plain_object(text: str) -> Any:
    """The object; None where the text does not have this form, which does not mean that it is invalid."""
    if not text.startswith(_HEAD):
        return None
    name = text[10 : text.find('"', 10)]
    try:
        plain = _known[name]
    except KeyError:
        try:
            plain = _plain(name)
        except (BadInput, KeyError):
            return None  # unknown type
        _known[name] = plain
    if plain is None:
        return None
    found = plain.fullmatch(text)
    return None if found is None else plain.made(found.groups())


class _NoPattern(Exception):
    """Patterns do not support a field's kind."""


class _Maker:
    """Generates the pattern of a type, and the source of the function that builds its object."""

    def __init__(self) -> None:
        self.groups = 0
        self.scope: dict[str, Any] = {}
        self.lines: list[str] = []

    def object_(self, type_name: str, depth: int = 0) -> tuple[str, str]:
        """The pattern, and the name of the variable that holds the object."""
        if depth > NESTED_MAX:
            raise _NoPattern
        cls: Any = types[type_name]
        number = len(self.scope)
        self.scope[f"c{number}"] = cls
        self.lines.append(f" o{number} = c{number}.__new__(c{number})")
        parts = [re.escape(f'{_HEAD}{type_name}"')]
        for field in cls.fields:
            if not field.name.isidentifier() or iskeyword(field.name):
                raise _NoPattern
            pattern, value = self.field(field, depth)
            parts.append(re.escape(f',"{field.name}":') + pattern)
            self.lines.append(f" o{number}.{field.name} = {value}")
        return "".join([*parts, r"\}"]), f"o{number}"

    def field(self, field: Any, depth: int) -> tuple[str, str]:
        """The pattern of a value, and the expression that evaluates to it."""
        kind = field.kind
        if field.array is not None:
            if field.array or kind == "any":  # of a fixed length
                raise _NoPattern
            if kind in INTEGER_RANGES:
                one, group = _whole(kind), self.group()
                listed = rf"\[((?:{one}(?:,{one}){{0,{LIST_MAX}}})?)\]"
                return listed, f"[*map(int, {group}.split(','))] if {group} else []"
            return r"\[\]", "[]"
        if kind == "struct":
            return self.object_(types[field.type].type_name, depth + 1)
        if kind in INTEGER_RANGES:
            return f"({_whole(kind)})", f"int({self.group()})"
        if kind in ("real32", "real64"):
            return _REAL, f"float({self.group()})"
        if kind == "bool":
            return "(true|false)", f"{self.group()} == 'true'"
        if kind == "string":
            return _TEXT, self.group()
        if kind == "enum":
            members = dict(enums[field.type].__members__)
            name = f"m{len(self.scope)}"
            self.scope[name] = members
            return f'"({"|".join(map(re.escape, members))})"', f"{name}[{self.group()}]"
        raise _NoPattern

    def group(self) -> str:
        """The name of the variable of the next group."""
        self.groups += 1
        if self.groups > GROUPS_MAX:
            raise _NoPattern
        return f"g{self.groups - 1}"


def _whole(kind: str) -> str:
    """Pattern of integers with so few digits that each is within the range of this kind."""
    low, high = INTEGER_RANGES[kind]
    return f"{'-?' if low < 0 else ''}(?:0|[1-9][0-9]{{0,{len(str(high)) - 2}}})"


def _plain(type_name: str) -> _Plain | None:
    maker = _Maker()
    try:
        pattern, made = maker.object_(type_name)
    except _NoPattern:
        return None
    taken = "".join(f"g{i}, " for i in range(maker.groups))
    unpacked = [f" ({taken}) = groups"] if taken else []
    text = "\n".join(["def made(groups):", *unpacked, *maker.lines, f" return {made}"])
    exec(text, maker.scope)
    return _Plain(re.compile(pattern).fullmatch, maker.scope["made"])
