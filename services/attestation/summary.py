"""Checks that a report agrees with its statement, and its summary with its rows."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any

from cratous.services.attestation.findings import Data
from cratous.services.attestation.names import STATEMENT_NAME
from cratous.services.attestation.statement import claim
from cratous.services.certify.limits import LIMITS, said_of_states
from cratous.services.certify.report_schema import departures
from cratous.services.results.names import FORMER, OWN, REPORT_NAME
from cratous.spec.mission.guarantees import REQUIREMENTS, Outcome, exit_code, worst

OF_FRAME = re.compile(
    r"Within [0-9.]+ km of the frame's origin, where everything of this mission lies, local distances "
    r"are off by at most [0-9.e+-]+ of themselves\."
)
"""The last of a report's limits."""


def summary_faults(report: Data, predicate: Data) -> list[str]:
    """Faults: the report must satisfy its schema, agree with the statement's claim, and be
    consistent with its own rows. predicate: of the statement.
    """
    if report["format"] == FORMER:
        return [f"{REPORT_NAME}: a report of {FORMER} has no schema"]
    wrong = [f"{REPORT_NAME}, by its schema: {line}" for line in departures(report)]
    if wrong:
        return wrong
    found = [
        f"{STATEMENT_NAME}: {key} is not that of {REPORT_NAME}"
        for key, value in claim(report).items()
        if predicate.get(key) != value
    ]
    if OWN in predicate and OWN not in report:
        found.append(f"{STATEMENT_NAME}: {OWN} is not in {REPORT_NAME}")
    return found + [f"{REPORT_NAME}: {text}" for text in (*_rows(report), *_sums(report))]


def _rows(report: Data) -> list[str]:
    """Faults of requirements, limits and rows: unknown or duplicate ones. `planned` and the judge
    check which rows must exist.
    """
    found = []
    known = [(one.id, one.title, one.text) for one in REQUIREMENTS]
    listed = [(one["requirement"], one["title"], one["text"]) for one in report["requirements"]]
    if listed != known:
        ids = ", ".join(one[0] for one in listed)
        expected = ", ".join(one[0] for one in known)
        found.append(
            f"its requirements are {ids or 'none'}, expected {expected} with their titles and texts"
        )
    ids_known = {one.id for one in REQUIREMENTS}
    rows = Counter((r["requirement"], r["source"], r["item"]) for r in report["constraints"])
    for (name, source, item), number in rows.items():
        if name not in ids_known:
            found.append(f"a row of {name}, which is no requirement: {item}")
        elif source == "plan" and name != "G1":
            found.append(f"a row of {name} on the plan, of which only G1 speaks: {item}")
        if number > 1:
            found.append(f"{number} rows of {name} on the same: {item}")
    *limits, of_frame = report["limits"] or [""]
    mission = report["mission"]
    of_states = said_of_states(
        bool(mission["instances"]), mission["daa"].get("sensing") is not None
    )
    if limits != [*LIMITS, *of_states] or not OF_FRAME.fullmatch(of_frame):
        found.append("its limits are not those that every report has")
    return found


def _sums(report: Data) -> list[str]:
    """Summary entries that contradict the rows."""
    rows, found = report["constraints"], []
    outcomes = []
    for wanted in report["requirements"]:
        name = wanted["requirement"]
        own = [Outcome(r["verdict"]) for r in rows if r["requirement"] == name]
        outcomes.append(worst(own))
        if outcomes[-1] != wanted["verdict"]:
            found.append(f"{name} is {wanted['verdict']}, its rows {outcomes[-1]}")
        if len(own) != wanted["constraints"]:
            found.append(f"{name} has {wanted['constraints']} constraints, its rows are {len(own)}")
    if report["proofs"]["problems"]:
        outcomes.append(Outcome.UNKNOWN)
    counts = {str(o): sum(row["verdict"] == o for row in rows) for o in Outcome}
    outcomes += [Outcome(one["verdict"]) for one in report.get(OWN, {}).get("requirements", ())]
    found += _differs("verdict", report["verdict"], str(worst(outcomes)))
    found += _differs("exit_code", report["exit_code"], exit_code(outcomes))
    return found + _differs("counts", report["counts"], counts)


def _differs(name: str, written: Any, counted: Any) -> list[str]:
    return [f"{name} is {written}, by its rows {counted}"] if written != counted else []
