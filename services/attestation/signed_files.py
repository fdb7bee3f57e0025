"""Checks that the files of results and views are the signed ones, and that the views follow from the report."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from cratous.services.attestation.findings import Data, Subject
from cratous.services.attestation.junit import junit
from cratous.services.attestation.names import (
    ALL_VIEWS,
    CSV_NAME,
    JUNIT_NAME,
)
from cratous.services.attestation.statement import RESULTS
from cratous.services.attestation.statement import VIEWS as MADE
from cratous.services.attestation.table import table
from cratous.services.results.names import (
    BESIDE_LOG,
    CERTIFICATE_NAME,
    HTML_NAME,
    LOG_NAME,
    MANIFEST_NAME,
    MAP_NAME,
    NAMES,
    REPORT_NAME,
)
from cratous.services.results.ownership import digest_of

NEEDED = (REPORT_NAME, HTML_NAME, MAP_NAME, LOG_NAME, MANIFEST_NAME)
"""Files of the results that every statement covers."""
MADE_AGAIN: dict[str, Callable[[Subject], str]] = {JUNIT_NAME: junit, CSV_NAME: table}
"""Views determined by report and statement alone; the argument needs the ledger (`argument_check`)."""


class Place(NamedTuple):
    """Folders. results: of the run; views: of views and statement."""

    results: Path
    views: Path

    def of(self, where: str, name: str) -> Path:
        """The file of a subject."""
        return (self.results if where == RESULTS else self.views) / name


def file_faults(place: Place, named: dict[str, str]) -> list[str]:
    """Files that differ from the signed ones: every named file must exist with its SHA-256, and no
    required file may be unnamed. named: signed SHA-256 by subject.
    """
    found = []
    for name, stated in named.items():
        try:
            got, why = digest_of(place.of(*name.split("/", 1))), "no such file"
        except OSError as error:
            got, why = "", error.strerror or "it cannot be read"
        if not got or got != stated:
            found.append(f"{name}: SHA-256 signed {stated}, found {got or why}")
    there = [f"{MADE}/{name}" for name in ALL_VIEWS if (place.views / name).exists()]
    there += [f"{RESULTS}/{name}" for name in NAMES if (place.results / name).exists()]
    needed = [f"{RESULTS}/{name}" for name in NEEDED]
    found += [
        f"{name}: the statement does not cover it"
        for name in sorted({*there, *needed} - set(named))
    ]
    found += [
        f"{RESULTS}/{name}: SQLite would read it as part of the log"
        for name in BESIDE_LOG
        if (place.results / name).exists()
    ]
    return found


def view_faults(place: Place, named: dict[str, str], subject: Subject) -> list[str]:
    """Views that differ from what the report gives, byte for byte; and a missing certificate."""
    found = []
    for name, make in MADE_AGAIN.items():
        if f"{MADE}/{name}" not in named:
            continue
        made = make(subject).encode()
        with (place.views / name).open("rb") as stream:
            same = stream.read(len(made) + 1) == made
        if not same:
            found.append(f"{MADE}/{name}: it is not what {REPORT_NAME} gives")
    if subject.report["plan"]["certificate"] and f"{RESULTS}/{CERTIFICATE_NAME}" not in named:
        found.append(f"{RESULTS}/{CERTIFICATE_NAME}: the plan names it, and it is not there")
    return found


def not_judged(report: Data) -> list[str]:
    """What was not checked here, in words."""
    found = [
        f"all else in {REPORT_NAME} but its verdicts: margins, times, notes, checks, kernels, tracks, counts of "
        "messages, error of the frame (cratous certify)",
    ]
    if report["plan"]["certificate"]:
        found.append(f"{CERTIFICATE_NAME} (cratous certify-plan checks it)")
    return [*found, "proofs of the kernels (cratous prove makes them again, in a checkout)"]
