"""Builds the report of a flight from its log alone; if the log is incomplete, nothing in flight holds."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from cratous.core.files.whole_file import write_atomically
from cratous.services.assumptions.listing import State
from cratous.services.certify.flight_record import flown_of
from cratous.services.certify.rejudge import not_as_flown, subject, watched_and_told
from cratous.services.certify.report import Judged, build_report, report_text, write_report
from cratous.services.certify.requirements_judged_again import named, shown, together
from cratous.services.certify.verdicts import constraint_rows, plan_rows
from cratous.services.logs.log import read_meta
from cratous.services.logs.source import DOUBTS, NO_END, doubts
from cratous.services.mission.wind import known_at
from cratous.services.requirements.requirement_files import OwnFile
from cratous.services.results.names import LOG_NAME, OWN, REPORT_NAME
from cratous.spec.errors import BadInput
from cratous.spec.mission.guarantees import Outcome


class FromLog(NamedTuple):
    """The report, and the entries that the log does not determine, with the reason."""

    report: dict[str, Any]
    unchecked: list[str]


def report_of(log: Path, own: Sequence[OwnFile] = ()) -> FromLog:
    """The report derived from the log. BadInput if it is not a flight log or was altered after writing."""
    from cratous.services.monitor.plan_check import check_plan

    # the rows themselves say if the flight was not observed to its end
    doubted = [DOUBTS[one] for one in doubts(log) if one not in NO_END]
    wrong = not_as_flown(log)
    if wrong:
        raise BadInput(wrong[0].partition(": ")[2], where=str(log))
    mission, plan = subject(log)
    meta = read_meta(log)
    flown, silent, of_proofs, _ = flown_of(meta, {}, str(log))
    unchecked = [f"{key}: {why}" for key, why in sorted(silent.items())]
    if of_proofs:
        unchecked.append(
            "proofs: they are those of the ledger today, which is another than at the flight"
        )
    flown = replace(flown, own=together((), meta, own))
    given = [file.named for file in flown.own]
    unchecked += [
        f"{OWN}: the flight was flown with {shown(one)}, which is not given"
        for one in named(meta)
        if one not in given
    ]
    watched, told = watched_and_told(log, mission)
    rows = [_doubted(row, doubted) for row in constraint_rows(watched.verdicts, "flight")]
    rows += plan_rows(check_plan(known_at(mission, 0), plan))
    assumptions = [_not_held(row, doubted) for row in watched.assumptions]
    judged = Judged(rows, assumptions, watched.commands, told)
    report = build_report(mission, plan, judged, log, flown)
    said = [f"{one[0].upper()}{one[1:]}: nothing in flight holds." for one in doubted]
    report["limits"] = [*said, *report["limits"]]
    if plan.certificate:
        unchecked.append("certificate: it is not in the log")
    return FromLog(json.loads(report_text(report)), unchecked)


def _doubted(row: dict[str, Any], doubted: Sequence[str]) -> dict[str, Any]:
    """A row of an incomplete log: `holds` becomes `unknown`."""
    if not doubted or row["verdict"] != Outcome.HOLDS:
        return row
    return {**row, "verdict": str(Outcome.UNKNOWN), "note": f"{doubted[0]}; else: {row['note']}"}


def _not_held(row: dict[str, Any], doubted: Sequence[str]) -> dict[str, Any]:
    """An assumption row of an incomplete log: `held` becomes `not observed`."""
    if not doubted or row["state"] != State.HELD:
        return row
    note = f"{doubted[0]}; else: {row['note'] or 'held'}"
    return {**row, "state": str(State.NOT_OBSERVED), "note": note}


def write_from_log(log: Path, folder: Path, own: Sequence[OwnFile] = ()) -> FromLog:
    """Create a results folder from a log: the log, the report and its pages; BadInput if one exists already."""
    kept = folder / LOG_NAME
    if kept.exists() and log.resolve() != kept.resolve():
        raise BadInput(
            "there is another log already", where=str(kept), expected="another folder: -o DIR"
        )
    if (folder / REPORT_NAME).exists():
        raise BadInput(
            "there is a report already", where=str(folder / REPORT_NAME), expected="another folder: -o DIR"
        )  # fmt: skip
    made = report_of(log, own)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not kept.exists():
            write_atomically(kept, log.read_bytes(), "the log")
    except OSError as error:
        raise BadInput(
            "cannot be written", where=str(folder), got=error.strerror or str(error)
        ) from None
    write_report(made.report, folder)
    return made
