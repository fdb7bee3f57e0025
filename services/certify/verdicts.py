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
    """One row per single constraint (verdicts on a whole requirement are made again).

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
    """The rows of the assumptions that are broken; rows: of `Monitor.assumptions`."""
    return [row for row in assumptions if row["state"] == State.BROKEN]


def without_ground(command: str, assumptions: Iterable[dict[str, Any]]) -> bool:
    """True of a flight in processes in which an assumption is broken. The theorems are of a gate on board: such a
    flight is at best unknown, whatever was seen of it."""
    return flown_in_processes(command) and bool(broken_of(assumptions))


def plan_rows(checks: Iterable[Verdict]) -> list[dict[str, Any]]:
    """The rows of a plan that was flown: of a plan of a part, that it is one."""
    rows = constraint_rows(checks, "plan")
    part = any(row["item"] == PART for row in rows)
    return [row for row in rows if not (part and row["item"] == WHOLE)]


def _instead(expected: list[Row], present: set[str]) -> list[Row]:
    """The rows on a plan, with that of a part in place of that of the whole if it is present."""
    return [row for row in expected if row.item != WHOLE or PART not in present]


def with_promised(rows: list[dict[str, Any]], seen: Watched) -> list[dict[str, Any]]:
    """The rows, and an unknown one for each that is promised and not among them."""
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
    """One row per requirement: the worst of its constraints, and where the margin is least.

    A requirement on which no constraint speaks is unknown.
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
        # margins of different units cannot be compared; distances are what people look for first
        chosen = min(
            measured,
            key=lambda row: (row["unit"] != "m", row["margin"]),
            # nothing is measured: what names a task, then the row that most was seen for
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
