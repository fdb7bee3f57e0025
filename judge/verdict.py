"""What the judge says: rows, each on one thing that the mission asks for."""

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
    """One verdict. subject: what it is on, as a key that a monitor's row can be held against.

    at_ms: when it was violated first; checks: how many single decisions stand behind it; parts: of a row
    on order or timing, each (in the words of a report, verdict).
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
    """Violated before unknown before holds; nothing at all is unknown."""
    for verdict in (VIOLATED, UNKNOWN):
        if verdict in verdicts:
            return verdict
    return HOLDS if verdicts else UNKNOWN


def doubted(row: Row, reason: str) -> Row:
    """The row where something is missing: what seemed to hold is unknown."""
    if not reason or row.verdict != HOLDS:
        return row
    return replace(row, verdict=UNKNOWN, note=f"{reason}; else: {row.note}")


def seconds(ms: float) -> str:
    """An instant in words."""
    return f"{ms / 1000:.2f} s"
