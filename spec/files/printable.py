"""External text made safe for display: on a console, in a log, a report, a message or a table.

Control characters can rewrite what a terminal shows, line breaks forge log lines, bidirectional marks reorder text,
and a spreadsheet runs a cell that begins like a formula.
"""

from __future__ import annotations

import json
import unicodedata
from typing import Any

_HIDDEN = frozenset(("Cc", "Cf", "Cs", "Zl", "Zp"))
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")


def printable(text: object, keep: str = "") -> str:
    r"""The text with every character that does not stand for itself written out, but for `keep`.

    >>> printable("ok\x1b[2J\n")
    'ok\\x1b[2J\\n'
    """
    shown = str(text)
    if shown.isprintable():
        return shown
    return "".join(
        c if c in keep or unicodedata.category(c) not in _HIDDEN else _escaped(c) for c in shown
    )


def _escaped(c: str) -> str:
    return c.encode("unicode_escape").decode("ascii")  # half a character as well


def json_text(data: Any) -> str:
    """Data as one line of JSON: unescaped if that can be displayed, else in equivalent ASCII."""
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return text if text.isprintable() else json.dumps(data, separators=(",", ":"))


def cell(value: Any) -> Any:
    """A value for a CSV cell: a text that a spreadsheet would run is prefixed with an apostrophe.

    Numbers, and texts that are numbers, stay unchanged.
    """
    if not isinstance(value, str):
        return value
    if not value.startswith(_FORMULA) or _is_number(value):
        return printable(value, keep="\t\n")
    return "'" + printable(value, keep="\t\n")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return text == text.strip()
