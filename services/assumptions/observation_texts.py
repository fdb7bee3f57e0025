"""Observations of the assumptions, as text."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from cratous.services.assumptions.listing import State

GROUNDLESS = "unknown at best: the theorems are of gates on board, and of their assumptions some are broken here"
"""Verdict text for a flight in processes with broken assumptions."""


def sentence(row: dict[str, Any]) -> str:
    """A broken assumption in one line of text."""
    guarantees = " and ".join(row["guarantees"])
    return (
        f"broken at {row['since_ms'] / 1000:.2f} s: {row['text']}: {row['note']}; {guarantees} without ground since: "
        f"{row['lost']}; still holds: {row['stands']}"
    )


def measured(row: dict[str, Any]) -> str:
    """Worst observed and worst assumed value, with unit if there is one; empty without a measure."""
    if row["observed"] is None or row["bound"] is None:
        return ""
    return f"worst {row['observed']:.4g}, bound {row['bound']:.4g} {row['unit']}".rstrip()


def lines(rows: Iterable[dict[str, Any]]) -> Iterator[str]:
    """All assumptions as text, one line each."""
    for row in rows:
        if row["state"] == State.BROKEN:
            yield f"assumption {row['name']}: {sentence(row)}"
            continue
        said = "; ".join(part for part in (measured(row), row["note"]) if part)
        yield f"assumption {row['name']}: {row['state']}{f' ({said})' if said else ''}"
