"""The published JSON Schema of report.json, against which reports are checked on writing and
reading.

`report.schema.json` is the file that `cratous certify --schema` prints. A test checks that its
definitions of mission and plan are those of the records.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from itertools import islice
from typing import Any

from cratous.spec.files.printable import printable
from cratous.spec.files.schema_check import Check, fits

SCHEMA_NAME = "report.schema.json"
FEW = 20
"""Maximum number of violations listed; a file that is no report has thousands."""
SHORT = 120


def schema_text() -> str:
    """The schema as published (JSON Schema, draft 2020-12)."""
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
    """Where a report violates the schema, at most FEW places: path and reason."""
    return [] if _fits()(report) else list(islice(_departures(report), FEW))


def _departures(report: Any) -> Iterator[str]:
    for error in _validator().iter_errors(report):
        path = "".join(
            f"[{part}]" if isinstance(part, int) else f".{_cut(str(part))}"
            for part in error.absolute_path
        )
        yield f"{path.removeprefix('.') or 'report'}: {_cut(error.message)}"


def _cut(text: str) -> str:
    shown = printable(text)
    # the end of the message says what was expected
    return shown if len(shown) <= SHORT else f"{shown[: SHORT // 2]}...{shown[-SHORT // 2 :]}"
