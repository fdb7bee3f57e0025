"""The times in the section `bridge` of a mission file as `BridgeTimes`; the schema sets the bounds."""

from __future__ import annotations

from collections.abc import Iterator

from cratous.core.authority.timeliness import lasted
from cratous.services.loading.document import Document, item_name
from cratous.services.loading.problems import refuse
from cratous.services.loading.yaml_link_loss import FEWEST_BEATS
from cratous.spec.errors import BadInput
from cratous.spec.mission import Simulation
from cratous.spec.mission.bridge_times import USUAL, BridgeTimes

LOST, SAFE = "lost_link_after_s", "safe_state_after_s"
INSTEAD = {
    "link_loss": "link_loss.after_s says it",
    "sensing": "nothing is flown without the link",
    "merging": "nothing is flown without the link",
}
"""Sections with which LOST would have no effect, and why."""


def yaml_bridge_times(document: Document, simulation: Simulation) -> BridgeTimes:
    """The times of the bridge; BadMission if they are inconsistent."""
    data = document.data.get("bridge", {})
    lost_ms = round(1000 * float(data.get(LOST, USUAL.lost_link_after_ms / 1000)))
    safe_ms = round(1000 * float(data.get(SAFE, USUAL.safe_state_after_ms / 1000)))
    if LOST in data:
        refuse([*_problems(document, simulation, lost_ms)])
    return BridgeTimes(lost_ms, safe_ms)


def _problems(document: Document, simulation: Simulation, lost_ms: int) -> Iterator[BadInput]:
    key, got = ("bridge", LOST), f"{lost_ms / 1000:g} s"
    least_ms = FEWEST_BEATS * simulation.heartbeat_ms
    expected = [
        ("this silence says nothing", f"at least {least_ms / 1000:g} s, {FEWEST_BEATS} heartbeats")
    ]
    found = [] if lasted(0, lost_ms, least_ms) else expected
    found += [
        (f"has no effect: {why}", f"no section {section} beside it, or no {LOST}")
        for section, why in INSTEAD.items()
        if section in document.data
    ]
    for what, wanted in found:
        yield BadInput(
            what, where=document.where(key), item=item_name(key), expected=wanted, got=got
        )
