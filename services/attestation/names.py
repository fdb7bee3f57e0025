"""The files of an attestation, in a folder of their own beside or in the results."""

from __future__ import annotations

FOLDER = "attestation"
"""Where they are written in a results folder unless the user says otherwise."""
JUNIT_NAME, SARIF_NAME, CSV_NAME = "junit.xml", "report.sarif", "constraints.csv"
ARGUMENT_NAME, DRAWING_NAME = "argument.yaml", "argument.svg"
VIEWS = (JUNIT_NAME, SARIF_NAME, CSV_NAME, ARGUMENT_NAME, DRAWING_NAME)
"""What is written if none is named."""
PDF_NAME, FULL_NAME, FULL_PDF_NAME = "report.pdf", "full.html", "full.pdf"
MCAP_NAME = "run.mcap"
ALL_VIEWS = (*VIEWS, PDF_NAME, FULL_NAME, FULL_PDF_NAME, MCAP_NAME)
"""Those too that are written only where they are named."""
STATEMENT_NAME = "statement.dsse.json"
_REPORTLAB, _MCAP = (("reportlab", "5.1.0"),), (("mcap", "1.6.0"), ("zstandard", "0.25.0"))
WRITTEN_BY = {PDF_NAME: _REPORTLAB, FULL_PDF_NAME: _REPORTLAB, MCAP_NAME: _MCAP}
"""The packages that write these, and their versions that the extras name: others write other bytes."""
