"""The section `simulation.bridge_faults` of a mission file as `BridgeFaults`; its schema sets the bounds."""

from __future__ import annotations

from typing import Any

from cratous.services.loading.document import Document
from cratous.services.loading.problems import refuse
from cratous.spec.errors import BadInput
from cratous.spec.mission.bridge_faults import BridgeFaults

AFTER = (
    ("reconnect_s", ("cut_s", "stops_reading_s")),
    ("reads_again_s", ("stops_reading_s",)),
    ("speaks_again_s", ("silent_s",)),
)
"""For each instant, those of which one has to precede it."""


def yaml_bridge_faults(document: Document) -> BridgeFaults:
    """The faults; BadMission if something is reopened or resumed that was not closed or stopped before."""
    data = document.data["simulation"]["bridge_faults"]
    refuse(_problems(document, data))
    found: dict[str, Any] = {}
    for name, value in data.items():
        if name.endswith("_s"):
            found[f"{name.removesuffix('_s')}_ms"] = round(float(value) * 1000)
        else:
            found[name] = int(value) if name == "seed" else float(value)
    return BridgeFaults(**found)


def _problems(document: Document, data: dict[str, Any]) -> list[BadInput]:
    return [
        BadInput(
            "nothing is broken before this instant",
            where=document.where(("simulation", "bridge_faults", later)),
            item=f"simulation.bridge_faults.{later}",
            expected=f"{' or '.join(before)} before {data[later]:g} s",
            got=", ".join(f"{name} {data[name]:g}" for name in before if name in data) or "none",
        )
        for later, before in AFTER
        if later in data and not _comes_before(data, before, data[later])
    ]


def _comes_before(data: dict[str, Any], names: tuple[str, ...], at_s: float) -> bool:
    return any(
        round(data[name] * 1000) in range(round(at_s * 1000)) for name in names if name in data
    )
