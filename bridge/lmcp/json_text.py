"""Fast writing of LMCP objects as canonical JSON, by one generated function per type.

Nearly all messages hold values of exactly their fields' types; their text is that of `jsonform`, in half of the time.
For any other object there is no text here, and `jsonform` writes it or says what is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from json.encoder import encode_basestring
from typing import Any

from cratous.bridge.lmcp.model import INTEGER_RANGES, when_removed
from cratous.bridge.lmcp.objects import LmcpEnum, LmcpObject

_PLAIN_NAME = re.compile(r"[A-Za-z0-9_/]+", re.ASCII)
_REAL = "type(%s) is float and %s - %s == 0.0"
_PLAIN = {
    "real32": (_REAL, "%s!r"),
    "real64": (_REAL, "%s!r"),
    "bool": ("type(%s) is bool", "words[%s]"),
    "string": ("type(%s) is str", "quoted(%s)"),
    **dict.fromkeys(INTEGER_RANGES, ("type(%s) is int", "%s")),
}
"""For a kind of field: the condition under which a value is plain, and the expression of its text."""
_WORDS = {False: "false", True: "true"}


class _NotPlain(Exception):
    """A value is not of its field's type."""


_writers: dict[type, Callable[[Any], str] | None] = {}
when_removed(lambda _series: _writers.clear())


def plain_text(obj: LmcpObject) -> str | None:
    """The canonical JSON of an object; None if a value in it is not plainly of its field's type."""
    try:
        return _written(obj)
    except (_NotPlain, RecursionError):
        return None


def _written(obj: LmcpObject) -> str:
    kind = type(obj)
    try:
        write = _writers[kind]
    except KeyError:
        write = _writers[kind] = _writer(kind)
    if write is None:
        raise _NotPlain
    return write(obj)


def _value(value: Any) -> str:
    """The text of any value that is not known better from its field."""
    kind = type(value)
    if kind is float and value - value == 0.0:
        return repr(value)
    if kind is int:
        return str(value)
    if kind is str:
        return str(encode_basestring(value))
    if kind is list:
        return f"[{','.join(map(_value, value))}]" if value else "[]"
    if value is None:
        return "null"
    if kind is bool:
        return "true" if value else "false"
    if isinstance(value, LmcpObject):
        return _written(value)
    if isinstance(value, LmcpEnum):
        return str(encode_basestring(value.name))
    raise _NotPlain


def _writer(cls: Any) -> Callable[[Any], str] | None:
    """A generated function that writes the objects of a class; None for a name with other characters than ours."""
    if not all(_PLAIN_NAME.fullmatch(name) for name in (cls.type_name, *cls.names)):
        return None
    names, conditions, parts = [], [], [f'"$type":"{cls.type_name}"']
    for i, field in enumerate(cls.fields):
        name, kind = f"v{i}", field.kind if field.array is None else "list"
        condition, text = _PLAIN.get(kind, ("", "value(%s)"))
        names.append(f"{name}, ")
        conditions += [condition.replace("%s", name)] if condition else []
        parts.append(f'"{field.name}":{{{text.replace("%s", name)}}}')
    lines = ["def write(obj):"]
    if names:
        lines.append(f"    ({''.join(names)}) = values_of(obj)")
    if conditions:
        lines += [f"    if not ({' and '.join(conditions)}):", "        raise NotPlain"]
    lines.append(f"    return f'{{{{{','.join(parts)}}}}}'")
    scope: dict[str, Any] = {
        "values_of": cls.values_of, "value": _value, "quoted": encode_basestring,
        "words": _WORDS, "NotPlain": _NotPlain,
    }  # fmt: skip
    exec("\n".join(lines), scope)
    made: Callable[[Any], str] = scope["write"]
    return made
