"""Verifies what was signed: signature, digests of evidence and views, and the verdicts, judged again.

The process that does this imports neither planner nor pilot nor monitor nor a kernel: the verdicts on
the flight are those of the independent judge (`cratous.judge`), which is handed in. What it cannot
decide, or what it has no counterpart of, is listed and never taken as shown.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from cratous.services.attestation.dsse import ENVELOPE_BYTES, opened
from cratous.services.attestation.findings import Data
from cratous.services.attestation.names import STATEMENT_NAME, VIEWS
from cratous.services.attestation.statement import (
    PREDICATE_TYPE,
    RESULTS,
    STATEMENT_TYPE,
    claim,
    digest,
)
from cratous.services.attestation.statement import VIEWS as MADE
from cratous.services.certify.report_input import read_report
from cratous.services.certify.report_schema import departures
from cratous.services.results.names import (
    BESIDE_LOG,
    CERTIFICATE_NAME,
    FORMER,
    HTML_NAME,
    LOG_NAME,
    MANIFEST_NAME,
    MAP_NAME,
    NAMES,
    REPORT_NAME,
)
from cratous.spec.errors import BadInput
from cratous.spec.files.text_file import text_of
from cratous.spec.mission.guarantees import Outcome, exit_code, worst

NEEDED = (REPORT_NAME, HTML_NAME, MAP_NAME, LOG_NAME, MANIFEST_NAME)
"""What every statement covers of the results."""
SUBJECT = re.compile(rf"({RESULTS}|{MADE})/([A-Za-z0-9][A-Za-z0-9._-]{{0,80}})")
MOST_SUBJECTS = 100


class Place(NamedTuple):
    """Where the files are. results: the folder of the run; views: that of views and statement."""

    results: Path
    views: Path

    def of(self, where: str, name: str) -> Path:
        """The file of a subject."""
        return (self.results if where == RESULTS else self.views) / name


@dataclass
class Verification:
    """What verifying found. refused: what is not as it was signed, or not as the evidence says.

    recomputed: verdicts on the flight that the judge confirms; undecided: those it cannot; not_judged:
    what it does not judge at all, in words.
    """

    refused: list[str] = field(default_factory=list)
    recomputed: int = 0
    undecided: list[str] = field(default_factory=list)
    not_judged: list[str] = field(default_factory=list)
    files: int = 0
    verdict: str = ""
    exit_code: int = 1


def verify(place: Place, public: Any, judged: Any) -> Verification:
    """Hold results and views against their statement and against the judge.

    public: of `dsse.public_key`; judged: gives the judgement of a results folder (`cratous.judge.judge`).
    BadInput where there is nothing to verify: no statement, or no results.
    """
    found = Verification()
    envelope = text_of(place.views / STATEMENT_NAME, ENVELOPE_BYTES, "a signed statement")
    payload, wrong = opened(envelope, public)
    if wrong:
        found.refused.append(f"{STATEMENT_NAME}: {wrong}")
        return found
    statement, wrong = _read(payload)
    if wrong:
        found.refused.append(f"{STATEMENT_NAME}: {wrong}")
        return found
    _hold_files(place, statement["subject"], found)
    if found.refused:  # nothing that they say is what was signed
        return found
    report = read_report(place.results)
    _hold_claim(report, statement["predicate"], found)
    if not found.refused:
        _judge(report, judged(place.results), found)
    found.not_judged += [str(text) for text in statement["predicate"]["not_checked"]]
    return found


def _read(payload: bytes) -> tuple[Data, str]:
    """(statement, what is wrong with it)."""
    try:
        data = json.loads(payload)
        subjects = data["subject"]
        named = {one["name"]: one["digest"]["sha256"] for one in subjects}
        known = data["_type"] == STATEMENT_TYPE and data["predicateType"] == PREDICATE_TYPE
        listed = isinstance(data["predicate"]["not_checked"], list)
    except (ValueError, KeyError, TypeError, RecursionError):
        return {}, "not an in-toto statement"
    if not known or not listed:
        return {}, "not a statement on a report of ours"
    if len(named) != len(subjects) or len(named) > MOST_SUBJECTS:
        return {}, "a file is named twice, or far too many are"
    for name, sha in named.items():
        if not SUBJECT.fullmatch(str(name)) or not isinstance(sha, str):
            return {}, "a subject is no file of results or views"
    return {**data, "subject": named}, ""


def _hold_files(place: Place, named: dict[str, str], found: Verification) -> None:
    """Every file that is named is there with its digest, and none that should be named is not."""
    for name, stated in named.items():
        file = place.of(*name.split("/", 1))
        try:
            got = digest(file) if file.is_file() else "no such file"
        except OSError as error:
            got = error.strerror or "it cannot be read"
        found.files += 1
        if got != stated:
            found.refused.append(f"{name}: SHA-256 signed {stated}, found {got}")
    there = [f"{MADE}/{name}" for name in VIEWS if (place.views / name).exists()]
    there += [f"{RESULTS}/{name}" for name in NAMES if (place.results / name).exists()]
    needed = [f"{RESULTS}/{name}" for name in NEEDED]
    for name in sorted({*there, *needed} - set(named)):
        found.refused.append(f"{name}: the statement does not cover it")
    for name in BESIDE_LOG:
        if (place.results / name).exists():
            found.refused.append(f"{RESULTS}/{name}: SQLite would read it as part of the log")


def _hold_claim(report: Data, predicate: Data, found: Verification) -> None:
    """The report is of its schema, says what the statement claims, and agrees with its own rows."""
    if report["format"] == FORMER:
        found.refused.append(f"{REPORT_NAME}: a report of {FORMER} has no schema")
        return
    found.refused += [f"{REPORT_NAME}, by its schema: {line}" for line in departures(report)]
    if found.refused:
        return
    for key, value in claim(report).items():
        if predicate.get(key) != value:
            found.refused.append(f"{STATEMENT_NAME}: {key} is not that of {REPORT_NAME}")
    rows = report["constraints"]
    outcomes = []
    for wanted in report["requirements"]:
        name = wanted["requirement"]
        outcome = worst([Outcome(r["verdict"]) for r in rows if r["requirement"] == name])
        outcomes.append(outcome)
        if outcome != wanted["verdict"]:
            found.refused.append(
                f"{REPORT_NAME}: {name} is {wanted['verdict']}, its rows {outcome}"
            )
    if report["proofs"]["problems"]:
        outcomes.append(Outcome.UNKNOWN)
    _same(found, "verdict", report["verdict"], str(worst(outcomes)))
    _same(found, "exit_code", report["exit_code"], exit_code(outcomes))
    counts = {str(o): sum(row["verdict"] == o for row in rows) for o in Outcome}
    _same(found, "counts", report["counts"], counts)


def _same(found: Verification, name: str, written: Any, counted: Any) -> None:
    if written != counted:
        found.refused.append(f"{REPORT_NAME}: {name} is {written}, by its rows {counted}")


def _judge(report: Data, judgement: Any, found: Verification) -> None:
    """Hold the verdicts on the flight against those of the judge."""
    found.refused += [f"{REPORT_NAME}: {one.line()}" for one in judgement.disagreements]
    for one in judgement.answers:
        if one.confirmed:
            found.recomputed += 1
        else:
            said = f"the judge says {one.judge}" if one.judge else "the judge has no such row"
            found.undecided.append(f"{one.guarantee} {one.item}: {one.monitor}, {said}")
    plan = sum(row["source"] == "plan" for row in report["constraints"])
    found.not_judged.append(f"{plan} verdicts on the plan: cratous certify makes them again")
    if report["plan"]["certificate"]:
        found.not_judged.append(f"{CERTIFICATE_NAME}: cratous certify-plan checks it")
    found.not_judged.append("proofs of the kernels: cratous prove makes them again (in a checkout)")
    found.verdict = report["verdict"]
    found.exit_code = 1 if found.refused else report["exit_code"]
    if found.undecided and found.exit_code == 0:
        found.exit_code = 3


def signed_folder(results: Path, out: Path | None, default: str) -> Place:
    """Where results and views are; BadInput if there are no results."""
    if not results.is_dir():
        raise BadInput(
            "there is no such folder",
            where=str(results),
            expected="an output folder of cratous run",
        )
    return Place(results, out or results / default)
