"""An in-toto statement (version 1) on a report: digests of the evidence and of all views, and the
claim.

Subjects are `results/NAME` for the files of the results folder, including the message log, and
`views/NAME` for those made from its report for other tools.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

from cratous.services.attestation.findings import Data, Subject
from cratous.services.results.names import OWN
from cratous.services.results.ownership import digest_of
from cratous.spec.errors import BadInput

STATEMENT_TYPE = "https://in-toto.io/Statement/v1"
PREDICATE_TYPE = "urn:cratous:constraint-satisfaction:1"
RESULTS, VIEWS = "results", "views"
CLAIMED = ("verdict", "exit_code", "counts", "mission_hash", "not_covered", "limits")
"""Entries of report.json that the statement repeats."""


def claim(report: Data) -> Data:
    """The claim of a statement, as in report.json."""
    return {
        **{key: report[key] for key in CLAIMED},
        "product": report["product"],
        **({OWN: _own(report[OWN])} if OWN in report else {}),
        "log_digest": report["log"]["digest"],
        "ledger": {key: report["proofs"][key] for key in ("seal", "line", "solver")},
    }


def _own(own: Data) -> Data:
    """For user requirements: digests of the files, verdicts by id."""
    return {
        "files": [{"file": one["file"], "sha256": one["sha256"]} for one in own["files"]],
        "verdicts": {one["requirement"]: one["verdict"] for one in own["requirements"]},
    }


def statement(subject: Subject, results: Iterable[Path], views: Iterable[Path]) -> bytes:
    """The statement to be signed: canonical JSON. unchecked is part of the claim.

    BadInput for a file that cannot be read or is no regular file.
    """
    files = [(RESULTS, path) for path in results] + [(VIEWS, path) for path in views]
    subjects = [
        {"name": f"{where}/{path.name}", "digest": {"sha256": _digest(path)}}
        for where, path in files
    ]
    data = {
        "_type": STATEMENT_TYPE,
        "subject": sorted(subjects, key=lambda one: str(one["name"])),
        "predicateType": PREDICATE_TYPE,
        "predicate": {**claim(subject.report), "not_checked": list(subject.unchecked)},
    }
    return json.dumps(data, sort_keys=True, separators=(",", ":"), ensure_ascii=False).encode()


def _digest(path: Path) -> str:
    try:
        found = digest_of(path)
    except OSError as error:
        raise BadInput("cannot be read", where=str(path), got=error.strerror or "") from None
    if not found:
        raise BadInput(
            "not a file", where=str(path), expected="a file to sign", got="something else"
        )
    return found
