"""The judge's result: rows, each on one subject that the mission requires."""

from __future__ import annotations

from dataclasses import dataclass, replace

HOLDS, VIOLATED, UNKNOWN = "holds", "violated", "unknown"
GUARANTEES = {
    "G1": "zones, order, timing, eligibility",
    "G2": "well clear",
    "G3": "served",
    "G4": "authority",
    "G5": "bridge",
}


@dataclass(frozen=True)
class Row:
    """One verdict. subject: key that can be matched with a monitor's row.

    at_ms: time of the first violation; checks: number of decisions behind it; parts: for order or
    timing, pairs (words of a report, verdict).
    """

    guarantee: str
    subject: tuple[str, ...]
    item: str
    verdict: str
    note: str
    at_ms: int | None = None
    checks: int = 0
    parts: tuple[tuple[str, str], ...] = ()


def worst(verdicts: list[str]) -> str:
    """Violated before unknown before holds; unknown if there is none."""
    for verdict in (VIOLATED, UNKNOWN):
        if verdict in verdicts:
            return verdict
    return HOLDS if verdicts else UNKNOWN


def doubted(row: Row, reason: str) -> Row:
    """The row with missing data: `holds` becomes unknown."""
    if not reason or row.verdict != HOLDS:
        return row
    return replace(row, verdict=UNKNOWN, note=f"{reason}; else: {row.note}")


def seconds(ms: float) -> str:
    """A time in words."""
    return f"{ms / 1000:.2f} s"
