"""The files of a results folder."""

from __future__ import annotations

import re

FORMAT = "cratous-report/2"
FORMER = "cratous-report/1"
"""It listed the whole ledger as proofs, and no kernels of a verdict."""
REPORT_NAME, HTML_NAME, MAP_NAME = "report.json", "report.html", "map.svg"
LOG_NAME, CERTIFICATE_NAME = "log.sqlite", "certificate.json"
MANIFEST_NAME = "manifest.json"
COMMANDED_NAME = "mission.yaml"
"""The mission with what an operator commanded in flight, of a flight with commands."""
NAMES = (REPORT_NAME, HTML_NAME, MAP_NAME, LOG_NAME, CERTIFICATE_NAME, MANIFEST_NAME)
BESIDE_LOG = tuple(LOG_NAME + end for end in ("-journal", "-wal", "-shm"))
"""SQLite would take these for part of a new log."""
ASSUMPTIONS = "assumptions"
"""Where a log's meta has the assumptions of the system theorems that broke while it was flown."""
HEARD = "uxas_heard"
"""Whether a log's meta says that each ICAROUS tells if it hears UxAS; where it does not, a silence is not told."""
BLAME = "blame"
"""Where a report says who was in command where something does not hold."""
OWN = "own"
"""Where a report has requirements of the user's own; a log's meta names their files, of a flight with some."""
OF_PROCESSES = re.compile(
    r"(cfg|messages|scenario)\.xml|(simulator|uxas|icarous_[1-9][0-9]{0,18})\.txt"
)
"""What processes of a flight were given, and what they said (`cratous run --processes`)."""
