"""User requirements as rows of the same form as those of G1 to G5 and their constraints, for views."""

from __future__ import annotations

from typing import Any

from cratous.services.results.names import OWN

Data = dict[str, Any]
SOURCE = "own"
"""Value of such a row's source, where constraints have `plan` or `flight`."""


def own_requirements(report: Data) -> list[Data]:
    """The report's rows of user requirements, in the order of their files; empty if it has none."""
    return list(report.get(OWN, {}).get("requirements", ()))


def digests(report: Data) -> dict[str, str]:
    """SHA-256 of each file of user requirements, by file name."""
    return {one["file"]: one["sha256"] for one in report.get(OWN, {}).get("files", ())}


def own_constraints(report: Data) -> list[Data]:
    """Each user requirement as a row like those of constraints; `own` holds the additional fields."""
    sha = digests(report)
    return [
        {
            "requirement": one["requirement"],
            "source": SOURCE,
            "item": one["title"] or one["requirement"],
            "verdict": one["verdict"],
            "kind": "observed",
            "margin": one["margin"],
            "unit": one["unit"],
            "time_ms": one["time_ms"],
            "vehicles": sorted({c["vehicle"] for c in (one["blame"] or {}).get("command", ())}),
            "note": one["note"],
            "method": f"{one['file']}, SHA-256 {sha.get(one['file'], '')}",
            "kernels": one["kernels"],
            "checks": one["checks"],
            "own": one,
        }
        for one in own_requirements(report)
    ]


def own_findings(report: Data) -> list[tuple[str, str]]:
    """Faults of their samples, and lint findings of their files: (what, why)."""
    own = report.get(OWN, {})
    found = [(f"samples for {one['file']}", one["text"]) for one in own.get("findings", ())]
    return found + [(f"lint of {one['file']}", one["text"]) for one in own.get("lint", ())]
