"""Identifies results of versions without a manifest, by content."""

from __future__ import annotations

import json
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

from cratous.services.results.names import (
    CERTIFICATE_NAME,
    FORMAT,
    HTML_NAME,
    LOG_NAME,
    MAP_NAME,
    REPORT_NAME,
)


def former_files(folder: Path) -> set[str]:
    """The files of a folder that were written together with its report; empty without a report."""
    report = _json(folder / REPORT_NAME)
    if report.get("format") != FORMAT or not isinstance(report.get("mission_hash"), str):
        return set()
    plan = report.get("plan")
    certificate = plan.get("certificate") if isinstance(plan, dict) else None
    found = {REPORT_NAME}
    if report["mission_hash"] in _text(folder / HTML_NAME):
        found.add(HTML_NAME)
    if 'aria-label="Map of the flight"' in _text(folder / MAP_NAME):
        found.add(MAP_NAME)
    if _flown(folder / LOG_NAME) == report["mission_hash"]:
        found.add(LOG_NAME)
    if certificate and _json(folder / CERTIFICATE_NAME).get("sha256") == certificate:
        found.add(CERTIFICATE_NAME)
    return found


def _text(path: Path) -> str:
    try:
        if path.is_symlink() or not path.is_file():
            return ""
        return path.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return ""


def _json(path: Path) -> dict[str, Any]:
    try:
        data = json.loads(_text(path))
    except (ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}


def _flown(path: Path) -> str:
    """The mission for which a CRATOUS log was recorded."""
    if path.is_symlink() or not path.is_file():
        return ""
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as log:
            rows = log.execute("SELECT value FROM meta WHERE key = 'mission_hash'").fetchall()
        return str(json.loads(rows[0][0])) if rows else ""
    except (sqlite3.Error, ValueError, TypeError):
        return ""
