"""Blame in words: who was in command where something does not hold, and which assumption had broken."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from cratous.spec.mission.guarantees import Outcome

Data = dict[str, Any]
SHOWN = 10
"""Number of rows printed at the end of a command; the report has all."""


def sentence(one: Data, over: bool = True) -> str:
    """Commander and broken assumptions at a violation, as an English sentence.

    over: the messages are complete; only then is it known which assumptions held or were not
    observed.
    """
    said = [
        f"{c['side']} had vehicle {c['vehicle']} since {_s(c['since_ms'])}" for c in one["command"]
    ]
    said += [
        f"{w['side']} had vehicle {w['vehicle']} at {_s(w['at_ms'])}, when there was a way out"
        for w in one["ways_out"]
    ]
    first, unseen = one["broken_first"], one["not_observed"]
    if first is not None:
        on = "" if first["bears"] else f", on which no theorem on {one['requirement']} rests"
        said.append(f"first broken assumption: {first['name']} at {_s(first['since_ms'])}{on}")
    elif over:
        said.append("no watched assumption had broken by then")
    if unseen and over:
        said.append(f"not observed: {', '.join(unseen)}")
    return "; ".join(said)


def lines(rows: Sequence[Data]) -> Iterator[str]:
    """The first rows as text, one line each; violations before unknown and excused ones."""
    order = sorted(rows, key=lambda one: one["verdict"] != Outcome.VIOLATED)
    for one in order[:SHOWN]:
        at = "" if one["time_ms"] is None else f" at {_s(one['time_ms'])}"
        yield f"blame, {one['requirement']} {one['item']}, {one['verdict']}{at}: {sentence(one)}"
    if len(order) > SHOWN:
        yield f"blame: {len(order) - SHOWN} rows more"


def _s(time_ms: int) -> str:
    return f"{time_ms / 1000:.2f} s"
