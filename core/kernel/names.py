"""Qualified names for display: shortest unambiguous suffixes, patterns, near misses.

A name is `package.module.function`. A name or pattern that matches nothing raises an error with the nearest names,
never an empty answer.
"""

from __future__ import annotations

import difflib
import fnmatch
from collections.abc import Iterable
from pathlib import Path

from cratous.spec.errors import BadInput

NEAR = 3
"""Number of near names offered for an unknown one."""


def candidates(text: str, names: Iterable[str]) -> list[str]:
    """The names that equal this text, or end with it after a dot."""
    return sorted(name for name in names if f".{name}".endswith(f".{text}"))


def near(text: str, names: Iterable[str]) -> list[str]:
    """The names most similar to this text, as a whole or by their last part."""
    plain = text.strip("*?").rpartition(".")[2]
    ends: dict[str, list[str]] = {}
    for name in names:
        ends.setdefault(name.rpartition(".")[2], []).append(name)
    close = difflib.get_close_matches(plain, ends, NEAR, 0.5)
    close += [end for end in sorted(ends) if plain and plain in end and end not in close]
    return [name for end in close for name in sorted(ends[end])][:NEAR]


def short(names: Iterable[str]) -> dict[str, str]:
    """For each name its shortest suffix, in whole parts, that no other of them has."""
    every = sorted(set(names))
    count: dict[str, int] = {}
    for name in every:
        for end in _ends(name):
            count[end] = count.get(end, 0) + 1
    return {name: next((e for e in _ends(name) if count[e] == 1), name) for name in every}


def _ends(name: str) -> list[str]:
    parts = name.split(".")
    return [".".join(parts[k:]) for k in reversed(range(len(parts)))]


def fits(name: str, pattern: str) -> bool:
    """True iff the pattern matches the name, or a suffix of it in whole parts."""
    return any(fnmatch.fnmatchcase(end, pattern) for end in _ends(name))


def matching(
    patterns: Iterable[str],
    names: Iterable[str],
    what: str,
    item: str = "",
    others: Iterable[str] = (),
) -> list[str]:
    """The names that match one of the patterns. what: the kind of thing named, for the error.

    Raises BadInput for a pattern that matches none; others: further names to suggest.
    """
    every, found = sorted(set(names)), set()
    for pattern in patterns:
        mine = {name for name in every if fits(name, pattern)}
        if not mine:
            raise BadInput(
                f"no {what} matches",
                item=item,
                expected=_offer(near(pattern, [*every, *others]), what),
                got=pattern,
            )
        found |= mine
    return sorted(found)


def _offer(names: list[str], what: str) -> str:
    offered = " or ".join(short(names)[name] for name in names)
    return f"the name of a {what}" + (f", such as {offered}" if offered else "")


def files(folder: Path, pattern: str) -> list[Path]:
    """The files below a folder that match a pattern, sorted; raises BadInput if there are none."""
    found = sorted(file for file in folder.glob(pattern) if file.is_file())
    if not found:
        raise BadInput("no file matches", where=folder.name, expected=pattern, got="nothing")
    return found
