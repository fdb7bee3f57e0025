"""Checks that a report has the mission, the plan and the circumstances that the log recorded."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cratous.services.attestation.findings import Data
from cratous.services.results.names import REPORT_NAME

ALIKE = ("command", "avoidance", "environment", "mission_hash")
PROOFS = ("line", "problems", "seal", "solver")
ADDED = {"mission": "source", "plan": "hash"}
"""Fields that a report adds to them."""


def recorded_faults(report: Data, meta: Mapping[str, Any]) -> list[str]:
    """Where the report contradicts the log. meta: recorded in the log, by name."""
    told, logged = _parts(report), _parts(meta)
    return [
        f"{REPORT_NAME}: {name} is not what the log recorded"
        for name in told
        if name in logged and told[name] != logged[name]
    ]


def not_recorded(meta: Mapping[str, Any], report: Data) -> list[str]:
    """Parts that the log lacks, since it was made before they were recorded."""
    return sorted(_parts(report).keys() - _parts(meta).keys())


def _parts(data: Mapping[str, Any]) -> dict[str, Any]:
    """The parts common to both, by name; values of a wrong type are skipped."""
    found = {name: data[name] for name in ALIKE if name in data}
    for name, added in ADDED.items():
        if isinstance(data.get(name), dict):
            found[name] = {key: value for key, value in data[name].items() if key != added}
    proofs = data.get("proofs")
    if isinstance(proofs, dict):
        found |= {f"proofs.{key}": proofs[key] for key in PROOFS if key in proofs}
    return found
