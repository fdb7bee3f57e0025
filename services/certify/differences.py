"""Lists the places where two reports, or two pages, differ, with the text around each."""

from __future__ import annotations

import json
import re
from typing import Any

from cratous.services.logs.records import canonical

BEFORE, AFTER = 25, 45
SHORT = 70
NOTHING = object()


def differences(written: Any, found: Any, path: str = "") -> list[str]:
    """Every place where two JSON values differ, by its path; 1, 1.0 and true are different."""
    whole = (dict, list)
    if (
        isinstance(written, whole)
        and isinstance(found, whole)
        and canonical(written) == canonical(found)
    ):
        return []
    if isinstance(written, dict) and isinstance(found, dict):
        return [
            line
            for key in sorted({*written, *found})
            for line in differences(
                written.get(key, NOTHING), found.get(key, NOTHING), _below(path, key)
            )
        ]
    if isinstance(written, list) and isinstance(found, list):
        lines = [
            line
            for number, (one, other) in enumerate(zip(written, found, strict=False))
            for line in differences(one, other, f"{path}[{number}]")
        ]
        if len(written) != len(found):
            lines.append(f"{path}: written {len(written)} entries, found {len(found)}")
        return lines
    if NOTHING not in (written, found) and canonical(written) == canonical(found):
        return []
    if isinstance(written, str) and isinstance(found, str):
        one, other = _around(written, found)
        return [f"{path}: written {one}, found {other}"]
    return [f"{path}: written {_brief(written)}, found {_brief(found)}"]


def text_difference(name: str, written: bytes, expected: str) -> str:
    """The first place where a file differs from the expected text."""
    text = written.decode("utf-8", errors="replace")
    at = _first(text, expected)
    line = expected.count("\n", 0, at) + 1
    one, other = _around(text, expected)
    return f"{name}, line {line}: written {one}, expected {other}"


def _below(path: str, key: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_./-]{1,80}", key):
        return f"{path}[{_brief(key)}]"
    return f"{path}.{key}" if path else key


def _first(one: str, other: str) -> int:
    """Length of the common prefix of two texts."""
    low, high = 0, min(len(one), len(other))
    while low < high:
        middle = (low + high + 1) // 2
        if one[:middle] == other[:middle]:
            low = middle
        else:
            high = middle - 1
    return low


def _around(one: str, other: str) -> tuple[str, str]:
    if max(len(one), len(other)) <= SHORT:
        return _text(one), _text(other)
    at = _first(one, other)
    start = max(0, at - BEFORE)
    return _cut(one, start, at + AFTER), _cut(other, start, at + AFTER)


def _cut(text: str, start: int, end: int) -> str:
    return "..." * (start > 0) + _text(text[start:end]) + "..." * (end < len(text))


def _text(text: str) -> str:
    # no control character reaches the terminal
    return json.dumps(text, ensure_ascii=True).replace("\x7f", "\\u007f")


def _brief(value: Any) -> str:
    if value is NOTHING:
        return "nothing"
    if isinstance(value, str):
        return _cut(value, 0, SHORT)
    text = json.dumps(value, ensure_ascii=True, sort_keys=True).replace("\x7f", "\\u007f")
    return text if len(text) <= SHORT else f"{text[:SHORT]}..."
