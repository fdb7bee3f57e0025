"""Checks that the blame in a report follows from its rows, changes of command and assumptions.

It is recomputed here in plain Python, since a verifying process imports no kernel. Only the log
shows that the changes of command are those of the flight (`cratous certify`).
"""

from __future__ import annotations

from typing import Any

from cratous.services.assumptions.listing import State
from cratous.services.attestation.findings import Data
from cratous.services.results.names import ASSUMPTIONS, BLAME, REPORT_NAME
from cratous.spec.mission.guarantees import Outcome


def blame_faults(report: Data) -> list[str]:
    """Faults of the report's blame, by constraint. report: valid by its schema."""
    if BLAME not in report:
        return []
    made = blame_of(report)
    if len(made) != len(report[BLAME]):
        many = f"{len(report[BLAME])} rows of blame for {len(made)} constraints that do not hold"
        return [f"{REPORT_NAME}: {many}"]
    found = []
    for one, told in zip(made, report[BLAME], strict=True):
        wrong = ", ".join(key for key in one if one[key] != told[key])
        if wrong:
            name = f"{one['requirement']} {one['item']}"
            found.append(f"{REPORT_NAME}: the blame for {name} says otherwise: {wrong}")
    return found


def blame_of(report: Data) -> list[Data]:
    """The blame rows that a report must have."""
    return [
        _made(row, report)
        for row in report["constraints"]
        if row["source"] == "flight" and row["verdict"] != Outcome.HOLDS
    ]


def _made(row: Data, report: Data) -> Data:
    end = report["flight"]["end_ms"]
    at = end if row["time_ms"] is None else row["time_ms"]
    guarded = sorted(v["id"] for v in report["mission"]["vehicles"] if v["protected"])
    about = [n for n in guarded if not row["vehicles"] or n in row["vehicles"]]
    losses = (row.get("evidence") or {}).get("losses", [])
    ways = [(loss["own"], loss["way_out"]) for loss in losses if loss.get("way_out")]
    assumptions = report.get(ASSUMPTIONS, [])
    name = row["requirement"]
    return {
        **{key: row[key] for key in ("requirement", "item", "verdict", "time_ms")},
        "why": row["note"],
        "command": [command_then(number, report, at) for number in about],
        "ways_out": [
            {
                **command_then(own, report, way["time_ms"]),
                "at_ms": way["time_ms"],
                "manoeuvre": way["manoeuvre"],
            }
            for own, way in ways
            if own in guarded
        ],
        "broken_first": _first(name, assumptions, at),
        "not_observed": [
            one["name"]
            for one in assumptions
            if one["state"] == State.NOT_OBSERVED and name in one["guarantees"]
        ],
    }


def command_then(number: int, report: Data, at: int) -> Data:
    """The commander of vehicle `number` at an instant [ms], from a report's changes of command."""
    since, side = 0, "UxAS"
    told = [one for one in report["flight"]["authority"] if one["vehicle"] == number]
    for one in sorted(told, key=lambda one: one["time_ms"]):
        when = one["time_ms"]
        if when <= at and one["owner"] != side:
            since, side = when, one["owner"]
    return {"vehicle": number, "side": side, "since_ms": since}


def _first(name: str, assumptions: list[Data], at: int) -> dict[str, Any] | None:
    first = broken_then(assumptions, at)
    if first is None:
        return None
    told = {key: first[key] for key in ("name", "since_ms", "vehicle")}
    return {**told, "bears": name in first["guarantees"]}


def broken_then(assumptions: list[Data], at: int) -> Data | None:
    """The row of the assumption that had broken first by an instant [ms]."""
    broken = [one for one in assumptions if one["since_ms"] is not None]
    by_then = [one for one in broken if int(one["since_ms"]) <= at]
    return min(by_then, key=lambda one: int(one["since_ms"]), default=None)
