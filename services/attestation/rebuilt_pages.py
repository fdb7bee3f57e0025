"""Rebuilds pages, map, SARIF, full report, PDF and MCAP, and compares the signed files with them.

All except MCAP, which contains the log's messages, are made from the report alone. A difference is
tampering if the running code is that of the report. Other code may make other pages: then they are
reported as not examined.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from importlib.metadata import version
from typing import Any, NamedTuple

from cratous.core import ledger
from cratous.services.attestation.findings import Subject
from cratous.services.attestation.names import (
    FULL_NAME,
    FULL_PDF_NAME,
    MCAP_NAME,
    PDF_NAME,
    SARIF_NAME,
    WRITTEN_BY,
)
from cratous.services.attestation.sarif import sarif
from cratous.services.attestation.signed_files import Place
from cratous.services.attestation.statement import RESULTS
from cratous.services.attestation.statement import VIEWS as MADE
from cratous.services.certify.html import map_svg, render
from cratous.services.certify.running_code import code_digest
from cratous.services.results.names import HTML_NAME, LOG_NAME, MAP_NAME, REPORT_NAME
from cratous.spec.errors import BadInput, CratousError
from cratous.spec.files.limits import DOCUMENT_BYTES, json_of
from cratous.spec.mission.guarantees import REQUIREMENTS

WITH_LEDGER = (FULL_NAME, FULL_PDF_NAME)
"""Views whose section on the assurance argument depends on the ledger at the time of writing."""
OF_MISSION = {one.id for one in REQUIREMENTS}
View = Callable[[Subject, str], bytes]
"""Makes one of the human-readable views, or MCAP, by its name."""


class Again(NamedTuple):
    """Findings in words. refused: tampering; not_judged: what could not be rebuilt here."""

    refused: list[str]
    not_judged: list[str]


def pages_again(place: Place, named: dict[str, str], subject: Subject, view: View) -> Again:
    """Compare each of these signed files, if present, with what the report gives."""
    found = Again([], [])
    for called, make in _makers(named, subject, view):
        try:
            made = make()
        except ModuleNotFoundError as error:
            found.not_judged.append(
                f"{called}: what stands in it, as {error.name} is not installed"
            )
            continue
        except CratousError as error:
            found.refused.append(f"{called}: {_of(called)} gives none: {error}")
            continue
        if _is(place, called, made):
            continue
        why = _other(called, subject)
        if why:
            found.not_judged.append(f"{called}: {why} makes another one")
        else:
            found.refused.append(f"{called}: it is not what {_of(called)} gives")
    if f"{MADE}/{SARIF_NAME}" in named:
        lines = f"{MADE}/{SARIF_NAME}: whether its lines of the mission file are right"
        found.not_judged.append(lines)
    return found


def _makers(
    named: dict[str, str], subject: Subject, view: View
) -> Iterator[tuple[str, Callable[[], bytes]]]:
    yield f"{RESULTS}/{HTML_NAME}", lambda: render(subject.report).encode()
    yield f"{RESULTS}/{MAP_NAME}", lambda: map_svg(subject.report).encode()
    for name in (FULL_NAME, PDF_NAME, FULL_PDF_NAME, MCAP_NAME):
        if f"{MADE}/{name}" in named:
            yield f"{MADE}/{name}", lambda name=name: view(subject, name)  # type: ignore[misc]


def _of(called: str) -> str:
    """The source from which a file is made."""
    return LOG_NAME if called.endswith(MCAP_NAME) else REPORT_NAME


def _is(place: Place, called: str, made: bytes) -> bool:
    with place.of(*called.split("/", 1)).open("rb") as stream:
        return stream.read(len(made) + 1) == made


def _other(called: str, subject: Subject) -> str:
    """Why a file may legitimately differ; empty if it may not."""
    told = subject.report["environment"].get("code")
    if told is None or told["digest"] != code_digest():
        return "the code that runs here, which is not that of the report,"
    name = called.split("/")[1]
    for package, wanted in WRITTEN_BY.get(name, ()):
        if version(package) != wanted:
            return f"{package} {version(package)}, where {wanted} is asked for,"
    if name in WITH_LEDGER and _seal() != subject.report["proofs"]["seal"]:
        return "the ledger that is here, which is not that of the report,"
    return ""


def _seal() -> str:
    try:
        return str(ledger.read()["seal"])
    except CratousError:
        return ""


def sarif_faults(place: Place, named: dict[str, str], subject: Subject) -> list[str]:
    """Whether a signed SARIF file contains what the report gives, with any line numbers of the mission file."""
    called = f"{MADE}/{SARIF_NAME}"
    if called not in named:
        return []
    with (place.views / SARIF_NAME).open("rb") as stream:
        there = stream.read(DOCUMENT_BYTES + 1)
    lines = _lines(there)
    made = sarif(subject, lines.get).encode()
    return [] if there == made else [f"{called}: it is not what {REPORT_NAME} gives"]


def _lines(text: bytes) -> dict[str, int | None]:
    """By constraint, the line in a SARIF file; empty for an invalid file."""
    try:
        results: Any = json_of(text, SARIF_NAME)["runs"][0]["results"]
        found = {}
        for one in results:
            if one["ruleId"] not in OF_MISSION:  # its line is in the report
                continue
            place = one["locations"][0]
            name = place["logicalLocations"][0]["fullyQualifiedName"]
            line = place["physicalLocation"].get("region", {}).get("startLine")
            found[name] = line if type(line) is int and line > 0 else None
    except (BadInput, json.JSONDecodeError, KeyError, IndexError, TypeError, AttributeError):
        return {}
    return found
