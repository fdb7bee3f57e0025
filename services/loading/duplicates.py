"""Ids that an automation request lists more than once: each counts once, at its first place, and that is said."""

from __future__ import annotations

from typing import Any

LISTS = {"EntityList": "vehicle", "TaskList": "task"}


def counted_once(request: Any) -> tuple[Any, list[str]]:
    """An AutomationRequest without duplicates in its lists, and a note for each id that was listed several times."""
    kept, notes = dict[str, list[int]](), list[str]()
    for name, what in LISTS.items():
        listed = getattr(request, name)
        first = list(dict.fromkeys(listed))
        if len(first) == len(listed):
            continue
        kept[name] = first
        for number in first:
            times = listed.count(number)
            if times > 1:
                notes.append(f"{what} {number} is listed {times} times in {name}, and counts once")
    return (request.copy(**kept) if kept else request), notes
