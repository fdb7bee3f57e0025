"""The sections of a report in order: two pages, or all."""

from __future__ import annotations

from cratous.services.attestation.findings import Subject
from cratous.services.certify.trace import traced
from cratous.services.full_report import account, front, observed, subject
from cratous.services.full_report.document import Document


def document(about: Subject, full: bool) -> Document:
    """The pages of a confirmed report. full: all sections after the first page, otherwise only the flight."""
    report = about.report
    first = (front.verdict_page(report), front.flight_page(report))
    chains = traced(report) if full else {}
    rest = (
        (
            *subject.sections(report, chains),
            observed.trajectory(report, chains),
            observed.runtime(report),
            account.proofs(report, chains["names"]),
            observed.assumptions(report),
            account.coverage(about, chains),
            account.discrepancies(about),
            account.tools(report),
            account.argued(about),
            account.reproduction(report),
        )
        if full
        else ()
    )
    product, mission = report["product"], report["mission"]
    said = (
        f"Flight report by {product['name']} {product['version']}, mission {report['mission_hash'][:16]}; "
        f"{len(mission['vehicles'])} vehicles, {len(mission['tasks'])} tasks, {len(mission['zones'])} zones, "
        f"{len(mission['traffic'])} traffic"
    )
    return Document(mission["name"], said, (*first, *rest))
