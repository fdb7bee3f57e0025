"""Verdicts of the plan check and of the monitor as the rows and the summary of a report."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.services.assumptions.listing import State
from cratous.services.certify.command import flown_in_processes
from cratous.services.monitor.plan_check import PART, WHOLE
from cratous.services.monitor.required_rows import END, PLAN_ROWS, Row, Watched, missing, promised
from cratous.spec.mission.guarantees import REQUIREMENTS, Outcome, Verdict, worst


def constraint_rows(verdicts: Iterable[Verdict], source: str) -> list[dict[str, Any]]:
    """One row per single constraint; verdicts on a whole requirement are skipped and derived again.

    source: "plan" for the check before the flight, "flight" for the monitor.
    """
    return [
        {
            "requirement": verdict.requirement,
            "item": verdict.item,
            "source": source,
            "verdict": str(verdict.outcome),
            "kind": str(verdict.kind),
            "margin": verdict.margin,
            "unit": verdict.unit,
            "time_ms": verdict.time_ms,
            "vehicles": list(verdict.vehicles),
            "note": verdict.note,
            "method": verdict.method,
            "kernels": list(verdict.kernels),
            "checks": verdict.checks,
            **({"evidence": verdict.evidence} if verdict.evidence is not None else {}),
        }
        for verdict in verdicts
        if verdict.item
    ]


def broken_of(assumptions: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """The rows of broken assumptions; assumptions: of `Monitor.assumptions`."""
    return [row for row in assumptions if row["state"] == State.BROKEN]


def without_ground(command: str, assumptions: Iterable[dict[str, Any]]) -> bool:
    """True for a flight in processes with a broken assumption. The theorems assume a gate on board:
    such a flight is at best unknown, whatever was observed.
    """
    return flown_in_processes(command) and bool(broken_of(assumptions))


def plan_rows(checks: Iterable[Verdict]) -> list[dict[str, Any]]:
    """The rows of a plan that was flown; a partial plan has no row on the whole plan."""
    rows = constraint_rows(checks, "plan")
    part = any(row["item"] == PART for row in rows)
    return [row for row in rows if not (part and row["item"] == WHOLE)]


def _instead(expected: list[Row], present: set[str]) -> list[Row]:
    """The rows on a plan, with the row of a partial plan in place of that of the whole if it is present."""
    return [row for row in expected if row.item != WHOLE or PART not in present]


def with_promised(rows: list[dict[str, Any]], seen: Watched) -> list[dict[str, Any]]:
    """The rows, and an unknown row for each promised one that is missing."""
    flown = {row["item"] for row in rows if (row["requirement"], row["source"]) == ("G1", "flight")}
    wanted = {
        "plan": _instead(list(PLAN_ROWS), {row["item"] for row in rows}),
        "flight": list(promised(seen, flown)),
    }
    found = list(rows)
    for source, expected in wanted.items():
        there = [(row["requirement"], row["item"]) for row in rows if row["source"] == source]
        found += constraint_rows(missing(expected, there), source)
    return found


def requirement_rows(rows: Iterable[dict[str, Any]]) -> list[dict[str, Any]]:
    """One row per requirement: its worst constraint, and where the margin is least.

    A requirement without constraints is unknown.
    """
    by_id: dict[str, list[dict[str, Any]]] = {entry.id: [] for entry in REQUIREMENTS}
    for row in rows:
        by_id.setdefault(row["requirement"], []).append(row)
    texts = {entry.id: entry for entry in REQUIREMENTS}
    found = []
    for name, group in by_id.items():
        verdict = worst([Outcome(row["verdict"]) for row in group])
        telling = [row for row in group if row["verdict"] == verdict]
        measured = [row for row in telling if row["margin"] is not None]
        # margins in different units cannot be compared; distances are preferred
        chosen = min(
            measured,
            key=lambda row: (row["unit"] != "m", row["margin"]),
            # no margin: prefer a row that names a task, then the row with the most checks
            default=max(telling, key=lambda row: (row["item"] != END, row["checks"]), default=None),
        )
        found.append(
            {
                "requirement": name,
                "title": texts[name].title if name in texts else name,
                "text": texts[name].text if name in texts else "",
                "verdict": str(verdict),
                "constraints": len(group),
                "checks": sum(row["checks"] for row in group),
                "margin": chosen["margin"] if chosen else None,
                "unit": chosen["unit"] if chosen else "",
                "time_ms": chosen["time_ms"] if chosen else None,
                "vehicles": chosen["vehicles"] if chosen else [],
                "item": chosen["item"] if chosen else "",
                "note": chosen["note"] if chosen else "nothing was observed",
            }
        )
    return found
