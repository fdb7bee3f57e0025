"""The published JSON Schema of report.json: what is written and what is read is held against it.

`report.schema.json` is the file that `cratous certify --schema` prints. That its definitions of mission
and plan are those of the records is tested.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from itertools import islice
from typing import Any

from cratous.spec.files.printable import printable
from cratous.spec.files.schema_fits import Check, fits

SCHEMA_NAME = "report.schema.json"
FEW = 20
"""So many departures are listed; a report that is another thing altogether has thousands."""
SHORT = 120
WHOLE = re.compile("-?[0-9]+")


def schema_text() -> str:
    """The schema as it is published (JSON Schema, draft 2020-12)."""
    return files("cratous.services.certify").joinpath(SCHEMA_NAME).read_text("utf-8")


@cache
def _schema() -> dict[str, Any]:
    schema: dict[str, Any] = json.loads(schema_text())
    return schema


@cache
def _fits() -> Check:
    return fits(_schema())


@cache
def _validator() -> Any:
    from jsonschema import Draft202012Validator

    return Draft202012Validator(_schema())


def departures(report: Any) -> list[str]:
    """Where a report is not what the schema says, FEW places at most: path, and what is wrong there."""
    return [] if _fits()(report) else list(islice(_departures(report), FEW))


def _departures(report: Any) -> Iterator[str]:
    for error in _validator().iter_errors(_without_tracks(report)):
        path = "".join(
            f"[{part}]" if isinstance(part, int) else f".{_cut(str(part))}"
            for part in error.absolute_path
        )
        yield f"{path.removeprefix('.') or 'report'}: {_cut(error.message)}"


def _without_tracks(report: Any) -> Any:
    """The same without tracks, where they are as the schema has them: it takes long over each of their numbers."""
    flight = report.get("flight") if isinstance(report, dict) else None
    tracks = flight.get("tracks") if isinstance(flight, dict) else None
    if not isinstance(flight, dict) or not isinstance(tracks, dict):
        return report
    if all(map(_is_track, tracks, tracks.values())):
        return {**report, "flight": {**flight, "tracks": {}}}
    return report


def _is_track(number: Any, rows: Any) -> bool:
    """Rows of five numbers each, below the number of an aircraft."""
    if not isinstance(number, str) or WHOLE.fullmatch(number) is None or type(rows) is not list:
        return False
    return all(
        type(row) is list and len(row) == 5 and {float, int}.issuperset(map(type, row))
        for row in rows
    )


def _cut(text: str) -> str:
    shown = printable(text)
    # the end says what was expected
    return shown if len(shown) <= SHORT else f"{shown[: SHORT // 2]}...{shown[-SHORT // 2 :]}"
