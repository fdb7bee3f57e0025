"""SARIF 2.1.0 of a report: each constraint not shown to hold, with its position in the mission
file.

User requirements are rules like G1 to G5, with positions in their files. The rule of G1 to G5 is
that its constraints are shown to hold: a violation is an error, an unknown constraint a warning, an
excused or unchecked one a note. What no row covers is a notification of the run. There is no time
stamp: the same subject and lines give the same bytes.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any
from urllib.parse import quote

from cratous.services.attestation.findings import Data, Subject, doubt, unshown
from cratous.services.certify.requirement_views import digests, own_constraints, own_requirements
from cratous.spec.files.printable import printable
from cratous.spec.mission.guarantees import Outcome

SCHEMA = (
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
)
LEVELS = {Outcome.VIOLATED: "error", Outcome.UNKNOWN: "warning"}
LineOf = Callable[[str], int | None]
"""The line of the mission file that a constraint concerns, by its name; None if unknown."""


def sarif(subject: Subject, line_of: LineOf) -> str:
    """The text of the file."""
    report = subject.report
    rules = [
        {
            "id": one["requirement"],
            "name": one["title"].title().replace(" ", ""),
            "shortDescription": {"text": printable(one["title"])},
            "fullDescription": {"text": printable(one["text"] or one["title"])},
        }
        for one in report["requirements"]
    ]
    rules += [_own_rule(one, digests(report)) for one in own_requirements(report)]
    numbers = {rule["id"]: number for number, rule in enumerate(rules)}
    rows = [*report["constraints"], *own_constraints(report)]
    findings = [row for row in rows if row["verdict"] == Outcome.VIOLATED or doubt(row)]
    notes = [
        {"level": "warning", "message": {"text": printable(f"{what}: {why}")}}
        for what, why in unshown(subject)
    ]
    run = {
        "tool": {
            "driver": {
                "name": report["product"]["name"],
                "version": report["product"]["version"],
                "rules": rules,
            }
        },
        "invocations": [{"executionSuccessful": True, "toolExecutionNotifications": notes}],
        "results": [_result(report, row, numbers, line_of) for row in findings],
        "properties": {
            "verdict": report["verdict"],
            "mission_hash": report["mission_hash"],
            "log_digest": report["log"]["digest"],
        },
    }
    data = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
    return json.dumps(data, indent=1, ensure_ascii=False) + "\n"


def _own_rule(one: Data, sha: dict[str, str]) -> Data:
    """The rule of a user requirement."""
    said = {"severity": one["severity"], "source": one["source"], "file": one["file"]}
    return {
        "id": one["requirement"],
        "name": one["requirement"],
        "shortDescription": {"text": printable(one["title"] or one["requirement"])},
        "fullDescription": {"text": printable(one["text"])},
        "properties": {
            **{k: printable(v) for k, v in said.items()},
            "sha256": sha.get(one["file"], ""),
        },
    }


def _result(report: Data, row: Data, numbers: dict[str, int], line_of: LineOf) -> Data:
    own = row.get("own")
    file = report["mission"]["source"] if own is None else own["file"]
    place: dict[str, Any] = {"artifactLocation": {"uri": quote(file)}}
    line = line_of(row["item"]) if own is None else own["line"]
    if line is not None:
        place["region"] = {"startLine": line}
    said = doubt(row) or f"{row['verdict']}: {row['note']}"
    return {
        "ruleId": row["requirement"],
        "ruleIndex": numbers[row["requirement"]],
        "level": LEVELS.get(row["verdict"], "note"),
        "message": {"text": printable(f"{row['item']}: {said}")},
        "locations": [
            {
                "physicalLocation": place,
                "logicalLocations": [{"fullyQualifiedName": printable(row["item"])}],
            }
        ],
        "properties": {
            key: row[key] for key in ("verdict", "source", "margin", "unit", "time_ms", "vehicles")
        },
    }
