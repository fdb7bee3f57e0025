"""Finds the line of a mission file that a constraint concerns, if the file is the one flown."""

from __future__ import annotations

import re
from pathlib import Path

from cratous.services.attestation.findings import Data
from cratous.services.attestation.sarif import LineOf
from cratous.services.loading.document import Document, Key
from cratous.spec.errors import BadInput

SUBJECTS = (
    (r"zone: keep_(?:in|out) (-?\d+),", ("zones", "zone")),
    (r"(?:task|eligibility: task) (-?\d+)\b", ("tasks", "task")),
    (r"(?:well clear of|authority over vehicle|chain: vehicle) (-?\d+)", ("vehicles",)),
    (r"heartbeat (?:from|to) the ICAROUS instance of (-?\d+)", ("vehicles",)),
)
ROWS = re.compile(r"(?:flight|plan): ")
"""Prefix of constraints from the task relations."""


def lines_of(report: Data, file: Path | None) -> tuple[LineOf, str]:
    """A function that finds the lines, and why there are none (empty if there are).

    file: the mission file; None for the path in the report. A file that does not give the mission
    flown has other lines, so none is returned; BadInput if the user named it.
    """
    from cratous.services.certify.report import mission_hash
    from cratous.services.loading import load
    from cratous.services.loading.document import read_document

    place = file or Path(report["mission"]["source"])
    if file is None and (place.suffix not in (".yaml", ".yml") or not place.is_file()):
        return _nowhere, f"lines of {place}: the mission file is not here (--mission)"
    try:
        if mission_hash(load(place, report["mission"]["seed"])) != report["mission_hash"]:
            raise BadInput(
                "not the mission that was flown", where=str(place),
                expected=f"the mission with the hash {report['mission_hash']}", got="another",
            )  # fmt: skip
        document = read_document(place)
    except BadInput as error:
        if file is not None:
            raise
        return _nowhere, f"lines of {place}: {error.what}"
    return lambda item: line(document, item), ""


def _nowhere(_item: str) -> int | None:
    return None


def line(document: Document, item: str) -> int:
    """The line of a constraint's subject; the first line of the file if it concerns the whole mission."""
    for pattern, sections in SUBJECTS:
        found = re.match(pattern, item)
        if found:
            return _line_of_id(document, sections, int(found[1]))
    if ROWS.match(item):
        return document.lines.get(("relations",), 1)
    return 1


def _line_of_id(document: Document, sections: tuple[str, ...], number: int) -> int:
    for key, at in document.lines.items():
        inside = {part for part in key if isinstance(part, str)}
        if key[-1:] == ("id",) and inside & set(sections) and _value(document, key) == number:
            return at
    return 1


def _value(document: Document, key: Key) -> object:
    found = document.data
    for part in key:
        found = found[part]
    return found
