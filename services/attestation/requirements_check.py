"""Evaluates the user requirements of a report again from the log: the report contains their texts.

The code used here imports neither planner nor pilot nor the monitor of G1 to G5: only the
language's reader, the log, and the operators' kernels. Commander and broken assumption are compared
with the report's changes of command and assumptions, in plain Python.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cratous.services.assumptions.listing import State
from cratous.services.attestation.blame_check import broken_then, command_then
from cratous.services.attestation.findings import Data
from cratous.services.results.names import ASSUMPTIONS, OWN, REPORT_NAME
from cratous.spec.errors import BadInput

LINT = "lint"


def own_faults(report: Data, meta: Mapping[str, Any], log: Path) -> tuple[list[str], int]:
    """(Differences from what files and log give, number of verdicts evaluated again).

    report: valid by its schema; meta: recorded in the log; log: the raw evidence.
    """
    if OWN not in report and OWN not in meta:
        return [], 0
    from cratous.services.certify.differences import differences
    from cratous.services.certify.requirements_judged_again import files_in
    from cratous.services.certify.user_requirements import own_section

    files, wrong = files_in(report, dict(meta))
    if wrong:
        return [f"{REPORT_NAME}: {text}" for text in wrong], 0
    made = json.loads(json.dumps(own_section(files, log, _told(report), None)))
    # a log may name an empty list of files; the report then has none
    there = report.get(OWN, {part: [] for part in made})
    wrong = _rows(there["requirements"], made["requirements"])
    for part in ("files", "findings"):
        wrong += differences(there[part], made[part], f"{OWN}.{part}")
    return [f"{REPORT_NAME}: {text}" for text in wrong], len(made["requirements"])


def _rows(there: list[Data], made: list[Data]) -> list[str]:
    """Differences of the rows, apart from z3's lint; rows are matched by id."""
    from cratous.services.certify.differences import differences

    names, wanted = [one["requirement"] for one in there], [one["requirement"] for one in made]
    found = [f"{OWN} lacks the requirement {name}" for name in wanted if name not in names]
    found += [
        f"{OWN} has a requirement that is in no file: {name}"
        for name in names
        if name not in wanted
    ]
    if not found and names != wanted:
        found.append(f"{OWN} has its requirements in another order, or one twice")
    by_name = {one["requirement"]: one for one in made}
    for one in there:
        if (again := by_name.get(one["requirement"])) is not None:
            found += differences(_judged(one), _judged(again), f"{OWN} {one['requirement']}")
    return found


def _judged(row: Data) -> Data:
    return {key: value for key, value in row.items() if key != LINT}


def own_not_judged(report: Data) -> list[str]:
    """The user's requirements that were not checked here, in words."""
    if not report.get(OWN):
        return []
    from cratous.services.requirements.requirement_files import files_of, other_libraries

    said = "lint of requirements of the user's own (cratous certify asks z3 again)"
    try:
        files = files_of(report[OWN].get("files"))
    except BadInput:  # refused elsewhere
        return [said]
    return [said, *other_libraries(files)]


def _told(report: Data) -> Any:
    from cratous.services.certify.requirement_blame import Told

    guarded = tuple(sorted(v["id"] for v in report["mission"]["vehicles"] if v["protected"]))
    assumptions = report.get(ASSUMPTIONS, [])
    unseen = tuple(one["name"] for one in assumptions if one["state"] == State.NOT_OBSERVED)
    return Told(
        guarded,
        lambda number, at_ms: command_then(number, report, at_ms),
        lambda at_ms: _first(assumptions, at_ms),
        unseen,
    )


def _first(assumptions: list[Data], at_ms: int) -> Data | None:
    first = broken_then(assumptions, at_ms)
    if first is None:
        return None
    return {key: first[key] for key in ("name", "since_ms", "vehicle", "guarantees")}
