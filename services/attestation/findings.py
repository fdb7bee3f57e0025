"""What a report shows of each constraint, as tools need it: shown, not shown, or not checked."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.services.certify.requirement_views import own_findings
from cratous.spec.mission.guarantees import Outcome

Data = dict[str, Any]


class Subject(NamedTuple):
    """Input of the views. report: confirmed from its log; unchecked: what nothing vouched for."""

    report: Data
    unchecked: tuple[str, ...]


def doubt(row: Data) -> str:
    """Why a constraint that is not violated is not shown to hold; empty if it is shown.

    A row that holds because there was nothing to check is in doubt: it shows nothing.
    """
    verdict, note = row["verdict"], row["note"] or "no reason is given"
    if verdict in (Outcome.UNKNOWN, Outcome.EXCUSED):
        return f"{verdict}: {note}"
    if verdict == Outcome.HOLDS and not row["checks"]:
        return f"nothing was checked: {note}"
    return ""


def unshown(subject: Subject) -> list[tuple[str, str]]:
    """What no row of the report covers, or nothing vouches for: (what, why)."""
    report = subject.report
    found = [
        (f"{row['requirement']}: {row['title']}", "unknown: nothing was observed")
        for row in report["requirements"]
        if not row["constraints"]
    ]
    found += [
        (f"vehicle {number}", "not covered: the vehicle is not protected")
        for number in report["not_covered"]
    ]
    found += [
        (f"proof of {one['kernel']}", f"not proved: {one['what']}")
        for one in report["proofs"]["problems"]
    ]
    found += own_findings(report)
    for text in subject.unchecked:
        what, _, why = text.partition(": ")
        found.append((what, f"not checked: {why or what}"))
    return found
