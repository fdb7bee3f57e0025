"""Names of the files of an attestation, in a folder beside or inside the results."""

from __future__ import annotations

FOLDER = "attestation"
"""Default subfolder of a results folder."""
JUNIT_NAME, SARIF_NAME, CSV_NAME = "junit.xml", "report.sarif", "constraints.csv"
ARGUMENT_NAME, DRAWING_NAME = "argument.yaml", "argument.svg"
VIEWS = (JUNIT_NAME, SARIF_NAME, CSV_NAME, ARGUMENT_NAME, DRAWING_NAME)
"""The views written if none is named."""
PDF_NAME, FULL_NAME, FULL_PDF_NAME = "report.pdf", "full.html", "full.pdf"
MCAP_NAME = "run.mcap"
ALL_VIEWS = (*VIEWS, PDF_NAME, FULL_NAME, FULL_PDF_NAME, MCAP_NAME)
"""All views, including those written only if named."""
STATEMENT_NAME = "statement.dsse.json"
_REPORTLAB, _MCAP = (("reportlab", "5.1.0"),), (("mcap", "1.6.0"), ("zstandard", "0.25.0"))
WRITTEN_BY = {PDF_NAME: _REPORTLAB, FULL_PDF_NAME: _REPORTLAB, MCAP_NAME: _MCAP}
"""Packages that write these views, with the versions fixed by the extras: other versions write other bytes."""
