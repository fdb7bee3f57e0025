"""Reads report.json as untrusted text, before it has been compared with its log."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from cratous.services.results.names import FORMAT, FORMER, REPORT_NAME
from cratous.services.results.ownership import is_plain
from cratous.spec.errors import BadInput

LARGEST_BYTES = 1 << 28
DEEPEST = 60
"""Maximum nesting depth; our own reports have less than half of it."""


def read_report(folder: Path) -> dict[str, Any]:
    """The report.json of a folder as data; BadInput if it is missing, damaged or of another format."""
    path = folder / REPORT_NAME
    if not path.exists():
        raise BadInput(
            "there is no such file", where=str(path), expected="the output folder of cratous run"
        )
    if not is_plain(path):
        raise BadInput("not a file", where=str(path), expected="a report", got="something else")
    try:
        if path.stat().st_size > LARGEST_BYTES:
            raise BadInput(
                "too large for a report", where=str(path), expected=f"{LARGEST_BYTES} bytes at most",
                got=f"{path.stat().st_size}",
            )  # fmt: skip
        data = json.loads(
            path.read_text(encoding="utf-8"), parse_constant=_no_number, parse_float=_finite,
            object_pairs_hook=_once,
        )  # fmt: skip
    except OSError as error:
        raise BadInput("cannot be read", where=str(path), got=error.strerror or "") from None
    except RecursionError:
        raise BadInput("nested too deeply", where=str(path), expected="a report") from None
    except ValueError as error:
        raise BadInput(f"not JSON ({error})", where=str(path)) from None
    if not isinstance(data, dict) or data.get("format") not in (FORMAT, FORMER):
        got = data.get("format", "none") if isinstance(data, dict) else "no mapping"
        raise BadInput("another format", where=str(path), expected=FORMAT, got=repr(got)[:80])
    if _depth(data) > DEEPEST:
        raise BadInput("nested too deeply", where=str(path), expected=f"{DEEPEST} levels at most")
    return data


def _no_number(text: str) -> float:
    raise ValueError(f"{text} is no number")


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text[:40]} is too large")
    return value


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):  # readers differ in which duplicate they take
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"{twice[:40]!r} stands twice in one object")
    return found


def _depth(data: Any) -> int:
    level, depth = [data], 0
    while level:
        depth += 1
        level = [
            part
            for one in level
            if isinstance(one, (dict, list))
            for part in (one.values() if isinstance(one, dict) else one)
        ]
    return depth
