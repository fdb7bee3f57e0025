"""The constraints of a report as CSV, for spreadsheets: no cell is interpreted as a formula."""

from __future__ import annotations

import csv
import io

from cratous.services.attestation.findings import Subject, unshown
from cratous.services.certify.requirement_views import own_constraints
from cratous.spec.files.printable import cell

COLUMNS = (
    "requirement", "source", "item", "verdict", "kind", "margin", "unit", "time_ms", "vehicles",
    "checks", "note", "method", "kernels",
)  # fmt: skip
LISTS = ("vehicles", "kernels")
NOT_SHOWN = "not shown"


def table(subject: Subject) -> str:
    """The text of the file: a row per constraint, then one per item that was not shown."""
    stream = io.StringIO()
    out = csv.writer(stream, lineterminator="\n")
    out.writerow(COLUMNS)
    for row in (*subject.report["constraints"], *own_constraints(subject.report)):
        cells = {**row, **{name: " ".join(map(str, row[name])) for name in LISTS}}
        out.writerow([cell(cells[name]) for name in COLUMNS])
    for what, why in unshown(subject):
        cells = {"source": "report", "item": what, "verdict": NOT_SHOWN, "note": why}
        out.writerow([cell(cells.get(name)) for name in COLUMNS])
    return stream.getvalue()
