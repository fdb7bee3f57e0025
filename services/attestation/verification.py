"""Verifies signed results: signature, digests of evidence and views, and the verdicts, judged
again.

The verifying process imports neither planner nor pilot nor monitor nor a kernel: the verdicts on
the flight are those of the independent judge (`cratous.judge`), which is passed in. From the core
it reads only the ledger's records, for the argument, and uses the operators' kernels if a report
has user requirements, which are evaluated again from their texts. What it cannot decide, or has no
counterpart for, is listed and never taken as shown.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cratous.services.attestation.argument_check import argued
from cratous.services.attestation.assumptions_check import assumption_faults, assumptions_not_judged
from cratous.services.attestation.blame_check import blame_faults
from cratous.services.attestation.dsse import ENVELOPE_BYTES, opened
from cratous.services.attestation.findings import Data, Subject
from cratous.services.attestation.log_check import not_recorded, recorded_faults
from cratous.services.attestation.names import STATEMENT_NAME
from cratous.services.attestation.planned import plan_faults, plan_not_judged
from cratous.services.attestation.rebuilt_pages import Again, View, pages_again, sarif_faults
from cratous.services.attestation.requirements_check import own_faults, own_not_judged
from cratous.services.attestation.signed_files import Place, file_faults, not_judged, view_faults
from cratous.services.attestation.statement import PREDICATE_TYPE, RESULTS, STATEMENT_TYPE
from cratous.services.attestation.statement import VIEWS as MADE
from cratous.services.attestation.summary import summary_faults
from cratous.services.attestation.verdicts_check import held
from cratous.services.certify.report_input import read_report
from cratous.services.results.names import LOG_NAME
from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import text_of
from cratous.spec.mission.guarantees import Outcome

SUBJECT = re.compile(rf"({RESULTS}|{MADE})/([A-Za-z0-9][A-Za-z0-9._-]{{0,80}})")
MOST_SUBJECTS = 100


@dataclass
class Verification:
    """The findings. refused: what differs from what was signed, or from the evidence.

    own: number of user requirements whose verdict, margins and blame were recomputed from the log;
    expected: rows on the flight that the judge expects; recomputed: those that it confirms;
    undecided: those that it cannot decide, and an argument that this ledger does not give, in
    words; not_checked: what certifying could not check, by the statement; not_judged: what was not
    examined here. verdict: of the report; verified_verdict: verdict confirmed by the judge
    (`judged.Held`), at best unknown if anything is undecided, empty if refused.
    """

    refused: list[str] = field(default_factory=list)
    own: int = 0
    expected: int = 0
    recomputed: int = 0
    undecided: list[str] = field(default_factory=list)
    not_checked: list[str] = field(default_factory=list)
    not_judged: list[str] = field(default_factory=list)
    files: int = 0
    verdict: str = ""
    verified_verdict: str = ""
    exit_code: int = 1


def verify(place: Place, public: Any, judged: Any, view: View) -> Verification:
    """Check results and views against their statement and against the judge.

    public: of `dsse.public_key`; judged: returns the judgement of a results folder
    (`cratous.judge.judge`); view: makes the human-readable views (`full_report.views.view`).
    BadInput if there is nothing to verify: no statement, or no results.
    """
    envelope = text_of(place.views / STATEMENT_NAME, ENVELOPE_BYTES, "a signed statement")
    payload, wrong = opened(envelope, public)
    if wrong:
        return Verification([f"{STATEMENT_NAME}: {wrong}"])
    statement, wrong = _read(payload)
    if wrong:
        return Verification([f"{STATEMENT_NAME}: {wrong}"])
    named, predicate = statement["subject"], statement["predicate"]
    found = Verification(file_faults(place, named), files=len(named))
    if found.refused:  # their contents are not what was signed
        return found
    report = read_report(place.results)
    found.refused = summary_faults(report, predicate)
    if found.refused:
        return found
    subject = Subject(report, tuple(predicate["not_checked"]))
    argument = argued(place.views, named, subject)
    judgement = judged(place.results)
    answer = held(report, judgement)
    recorded = [*recorded_faults(report, judgement.meta), *plan_faults(report)]
    # a plan or mission that was not flown needs no pages
    pages = Again([], []) if recorded else pages_again(place, named, subject, view)
    found.refused = view_faults(place, named, subject) + argument.refused + pages.refused
    found.refused += [*sarif_faults(place, named, subject), *recorded]
    found.refused += [*assumption_faults(report, judgement.meta), *blame_faults(report)]
    found.refused += answer.refused
    faults, found.own = own_faults(report, judgement.meta, place.results / LOG_NAME)
    found.refused += faults
    found.undecided = answer.undecided + argument.undecided
    found.expected, found.recomputed = answer.expected, answer.confirmed
    found.not_checked = list(subject.unchecked)
    silent = not_recorded(judgement.meta, report)
    found.not_judged = [f"{name}: the log says nothing of it" for name in silent]
    found.not_judged += [*argument.not_judged, *pages.not_judged, *plan_not_judged(report)]
    found.not_judged += [
        *assumptions_not_judged(report, judgement.meta),
        *not_judged(report),
        *own_not_judged(report),
    ]
    found.verdict = report["verdict"]
    if not found.refused:
        open_ = bool(argument.undecided) and answer.verdict == Outcome.HOLDS
        found.verified_verdict = str(Outcome.UNKNOWN) if open_ else answer.verdict
        sure = report["exit_code"] != 0 or found.verified_verdict == Outcome.HOLDS
        found.exit_code = report["exit_code"] if sure else 3
    return found


def _read(payload: bytes) -> tuple[Data, str]:
    """(statement, fault)"""
    try:
        data = json.loads(payload)
        subjects = data["subject"]
        named = {one["name"]: one["digest"]["sha256"] for one in subjects}
        known = data["_type"] == STATEMENT_TYPE and data["predicateType"] == PREDICATE_TYPE
        unchecked = data["predicate"]["not_checked"]
    except (ValueError, KeyError, TypeError, RecursionError):
        return {}, "not an in-toto statement"
    listed = isinstance(unchecked, list) and all(isinstance(text, str) for text in unchecked)
    if not known or not listed:
        return {}, "not a statement on a report of ours"
    if len(named) != len(subjects) or len(named) > MOST_SUBJECTS:
        return {}, "a file is named twice, or far too many are"
    for name, sha in named.items():
        if not SUBJECT.fullmatch(str(name)) or not isinstance(sha, str):
            return {}, "a subject is no file of results or views"
    return {**data, "subject": named}, ""


def signed_folder(results: Path, out: Path | None, default: str) -> Place:
    """The folders of results and views; BadInput if there are no results."""
    if not results.is_dir():
        raise BadInput(
            "there is no such folder",
            where=str(results),
            expected="an output folder of cratous run",
        )
    return Place(results, out or results / default)
