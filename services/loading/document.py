"""A YAML file as plain data, with the line of each value; ambiguous YAML is refused.

YAML 1.1 has surprising readings (`010` is 8, `1:30` is 90, duplicate keys, unbounded aliases). A
mission file must have one meaning, so these are refused.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cratous.spec.errors import BadInput
from cratous.spec.files.limits import DIGITS, MISSION_BYTES, MISSION_DEPTH, MISSION_NODES, at_most
from cratous.spec.files.text_file import text_of

INTEGER_MAX = 2**53
"""Integers up to this value are exact as doubles."""
_SURPRISING = re.compile(r"^[-+]?(0[0-9_]+|[0-9][0-9_]*(:[0-5]?[0-9])+(\.[0-9_]*)?)$")
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ud800-\udfff]")
_FLOAT = re.compile(r"^[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+$")

Key = tuple[str | int, ...]


@dataclass(frozen=True)
class Document:
    """Plain data and the line (from 1) of each value."""

    path: str
    data: Any
    lines: dict[Key, int]

    def where(self, key: Key) -> str:
        """`file:line` of a value, or of the nearest enclosing one."""
        while key and key not in self.lines:
            key = key[:-1]
        return f"{self.path}:{self.lines.get(key, 1)}"


def item_name(key: Key) -> str:
    """`vehicles[1].id` for ("vehicles", 1, "id")."""
    text = ""
    for part in key:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def item_key(item: str) -> Key:
    """The inverse of `item_name`."""
    parts = re.findall(r"[^.\[\]]+|\[\d+\]", item)
    return tuple(int(part[1:-1]) if part.startswith("[") else part for part in parts)


def read_document(path: Path) -> Document:
    """Read a YAML file; BadInput with the line if it is missing, unreadable or ambiguous."""
    return parse_document(text_of(path, MISSION_BYTES, "a mission file"), str(path))


def parse_document(text: str, where: str) -> Document:
    """The same, from a text."""
    import yaml

    try:
        _refuse_costly(text, where)
        root = yaml.compose(text, Loader=loader())
        if root is None:
            raise BadInput("the file is empty", where=where, expected="a mission")
        lines: dict[Key, int] = {}
        data = _plain(root, (), lines, where)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"{where}:{mark.line + 1}:{mark.column + 1}" if mark else where
        raise BadInput(f"not valid YAML: {error.problem or error.context}", where=place) from None
    except yaml.YAMLError as error:
        raise BadInput(f"not valid YAML: {error}", where=where) from None
    return Document(where, data, lines)


def loader() -> Any:
    """The YAML loader class."""
    import yaml

    return getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # the first is libyaml: ten times faster


def _refuse_costly(text: str, where: str) -> None:
    """Refuse aliases, excessive depth and size from the event stream, before any object is built."""
    import yaml

    depth = 0
    for count, event in enumerate(yaml.parse(text, Loader=loader())):
        place = f"{where}:{event.start_mark.line + 1 if event.start_mark else 1}"
        if isinstance(event, yaml.AliasEvent):
            raise BadInput(
                "aliases are not allowed",
                where=place,
                expected="the value written out",
                got=f"*{event.anchor}",
            )
        if isinstance(event, (yaml.SequenceStartEvent, yaml.MappingStartEvent)):
            depth += 1
        elif isinstance(event, (yaml.SequenceEndEvent, yaml.MappingEndEvent)):
            depth -= 1
        at_most(depth, MISSION_DEPTH, "nested too deeply", place, "levels")
        at_most(count, MISSION_NODES, "too many values", place, "of them")


def _plain(node: Any, key: Key, lines: dict[Key, int], where: str) -> Any:
    import yaml

    line = node.start_mark.line + 1
    lines.setdefault(key, line)
    if isinstance(node, yaml.MappingNode):
        return _mapping(node, key, lines, where)
    if isinstance(node, yaml.SequenceNode):
        return [_plain(part, (*key, k), lines, where) for k, part in enumerate(node.value)]
    return _scalar(node, f"{where}:{line}", item_name(key))


def _mapping(node: Any, key: Key, lines: dict[Key, int], where: str) -> dict[str, Any]:
    import yaml

    found: dict[str, Any] = {}
    for name, value in node.value:
        place = f"{where}:{name.start_mark.line + 1}"
        if not isinstance(name, yaml.ScalarNode):
            raise BadInput("a key must be a plain word", where=place, item=item_name(key))
        _scalar(name, place, item_name(key))
        if name.value in found:
            raise BadInput("given twice", where=place, item=item_name((*key, name.value)))
        lines[(*key, name.value)] = name.start_mark.line + 1
        found[name.value] = _plain(value, (*key, name.value), lines, where)
    return found


def _scalar(node: Any, where: str, item: str) -> Any:
    text, kind = node.value, node.tag.rpartition(":")[2]
    if not text.isprintable() and _CONTROL.search(text):
        raise BadInput(
            "a control character or half a character",
            where=where,
            item=item,
            expected="a text that can be shown",
            got=text[:60],
        )
    if kind in ("int", "float") and _SURPRISING.match(text):
        raise BadInput(
            "a number that can be read in two ways",
            where=where,
            item=item,
            expected="a plain decimal number",
            got=text,
        )
    if kind not in ("null", "bool", "int", "float", "str", "timestamp"):
        raise BadInput(
            "tags are not allowed",
            where=where,
            item=item,
            expected="a plain value",
            got=str(node.tag)[:60],
        )
    if kind == "null":
        return None
    if kind == "bool":
        return text.lower() in ("true", "yes", "on")
    if kind in ("int", "float") and len(text) > DIGITS:
        raise BadInput(
            "a number with too many digits",
            where=where,
            item=item,
            expected=f"at most {DIGITS}",
            got=f"{text[:37]}...",
        )
    if kind == "int":
        value = int(text.replace("_", ""), 0)
        if abs(value) > INTEGER_MAX:
            raise BadInput(
                "a number out of range",
                where=where,
                item=item,
                expected=f"a whole number up to {INTEGER_MAX}",
                got=text,
            )
        return value
    if kind == "float":
        return _number(text, where, item)
    if kind == "str" and node.style in (None, "") and len(text) <= DIGITS and _FLOAT.match(text):
        return _number(text, where, item)
    return text


def _number(text: str, where: str, item: str) -> float:
    words = {".inf": "inf", "+.inf": "inf", "-.inf": "-inf", ".nan": "nan"}
    value = float(words.get(text.lower(), text.replace("_", "")))
    if value - value != 0:
        raise BadInput(
            "not a finite number", where=where, item=item, expected="a finite number", got=text
        )
    return value
