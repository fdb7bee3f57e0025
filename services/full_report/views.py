"""The views of this package by name, as bytes."""

from __future__ import annotations

from cratous.services.attestation.findings import Subject
from cratous.services.attestation.names import FULL_NAME, FULL_PDF_NAME
from cratous.services.full_report.page import html
from cratous.services.full_report.pdf import pdf
from cratous.services.full_report.sections import document


def view(subject: Subject, name: str) -> bytes:
    """The bytes of a view, determined by the report, the list of what was not checked, and the
    ledger.

    subject: confirmed from its log; name: of `attestation.names`. Raises ModuleNotFoundError for a
    PDF without reportlab, which the command line reports as NotInstalled.
    """
    if name == FULL_NAME:
        return html(document(subject, full=True)).encode("utf-8", "backslashreplace")
    return pdf(document(subject, full=name == FULL_PDF_NAME))
