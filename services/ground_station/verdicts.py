"""The verdicts in a run's report.json, selected for the page; nothing is judged again."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from cratous.services.certify.report_input import read_report
from cratous.services.ground_station.proof_chains import proofs_of
from cratous.services.logs.records import from_data, to_data
from cratous.services.results.names import REPORT_NAME
from cratous.spec.errors import BadInput

NO_REPORT = "there is no report.json beside this log; `cratous monitor LOG` judges it"
OTHER_LOG = "report.json is of another log: its digest is not the one that this log was closed with"


class VerdictRow(NamedTuple):
    """A verdict of the report on the whole flight; time_ms: of its least margin, or of the violation."""

    requirement: str
    item: str
    verdict: str
    note: str
    margin: float | None
    unit: str
    time_ms: int | None
    vehicles: tuple[int, ...]
    title: str = ""


def verdicts_of(folder: Path | None, digest: str | None) -> dict[str, Any]:
    """Overall verdict, rows for the requirements and their parts, and their proofs; or why there
    are none.

    folder: of the run, None for a log alone; digest: recorded when the log was closed. Raises
    BadInput if report.json is damaged.
    """
    if folder is None or not (folder / REPORT_NAME).exists():
        return {"why_none": NO_REPORT}
    report = read_report(folder)
    where = str(folder / REPORT_NAME)
    log = report.get("log")
    if not isinstance(log, dict) or digest is None or log.get("digest") != digest:
        return {"why_none": OTHER_LOG}
    return {**shown(report, where), "proofs": proofs_of(report, where)}


def shown(report: dict[str, Any], where: str) -> dict[str, Any]:
    """The displayed verdicts of a report. Raises BadInput if one is damaged."""
    return {
        "overall": str(report.get("verdict")),
        "requirements": _rows(report, "requirements", where),
        "details": _rows(report, "constraints", where),
    }


def _rows(report: dict[str, Any], name: str, where: str) -> list[Any]:
    rows = report.get(name)
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise BadInput("does not fit", where=where, item=name, expected="a list of verdicts")
    try:
        return [
            to_data(
                from_data(
                    VerdictRow,
                    {key: row[key] for key in VerdictRow._fields if key in row},
                    f"{name}[{number}]",
                )
            )
            for number, row in enumerate(rows)
        ]
    except BadInput as error:
        error.where = error.where or where
        raise
