"""The files of an attestation, in a folder of their own beside or in the results."""

from __future__ import annotations

FOLDER = "attestation"
"""Where they are written in a results folder unless the user says otherwise."""
JUNIT_NAME, SARIF_NAME, CSV_NAME = "junit.xml", "report.sarif", "constraints.csv"
ARGUMENT_NAME, DRAWING_NAME = "argument.yaml", "argument.svg"
VIEWS = (JUNIT_NAME, SARIF_NAME, CSV_NAME, ARGUMENT_NAME, DRAWING_NAME)
STATEMENT_NAME = "statement.dsse.json"
