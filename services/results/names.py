"""Names of the files in a results folder."""

from __future__ import annotations

import re

FORMAT = "cratous-report/2"
FORMER = "cratous-report/1"
"""The former report format: listed the whole ledger as proofs, and no kernels for verdicts."""
REPORT_NAME, HTML_NAME, MAP_NAME = "report.json", "report.html", "map.svg"
LOG_NAME, CERTIFICATE_NAME = "log.sqlite", "certificate.json"
MANIFEST_NAME = "manifest.json"
COMMANDED_NAME = "mission.yaml"
"""The mission with the operator's commands, for a flight with commands."""
NAMES = (REPORT_NAME, HTML_NAME, MAP_NAME, LOG_NAME, CERTIFICATE_NAME, MANIFEST_NAME)
BESIDE_LOG = tuple(LOG_NAME + end for end in ("-journal", "-wal", "-shm"))
"""Files that SQLite would treat as part of a new log."""
ASSUMPTIONS = "assumptions"
"""Meta entry of a log: assumptions of the system theorems that broke in flight."""
HEARD = "uxas_heard"
"""Meta entry of a log: whether each ICAROUS reports if it hears UxAS; without it silences are not reported."""
BLAME = "blame"
"""Entry of a report: who was in command where something does not hold."""
OWN = "own"
"""Entry of a report: user requirements; of a log's meta: their files, for a flight with some."""
OF_PROCESSES = re.compile(
    r"(cfg|messages|scenario)\.xml|(simulator|uxas|icarous_[1-9][0-9]{0,18})\.txt"
)
"""Input and output files of the processes of a flight (`cratous run --processes`)."""
