"""The sections of a report in order: two pages, or all."""

from __future__ import annotations

from cratous.services.attestation.findings import Subject
from cratous.services.certify.trace import traced
from cratous.services.full_report import (
    assurance_sections,
    first_pages,
    planning_sections,
    runtime_sections,
)
from cratous.services.full_report.document import Document


def document(about: Subject, full: bool) -> Document:
    """The pages of a confirmed report. full: all sections after the first page, otherwise only the flight."""
    report = about.report
    first = (first_pages.verdict_page(report), first_pages.flight_page(report))
    chains = traced(report) if full else {}
    rest = (
        (
            *planning_sections.sections(report, chains),
            runtime_sections.trajectory(report, chains),
            runtime_sections.runtime(report),
            assurance_sections.proofs(report, chains["names"]),
            runtime_sections.assumptions(report),
            assurance_sections.coverage(about, chains),
            assurance_sections.discrepancies(about),
            assurance_sections.tools(report),
            assurance_sections.argued(about),
            assurance_sections.reproduction(report),
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
