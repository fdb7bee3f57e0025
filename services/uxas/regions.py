"""OperatingRegionStateService: one operating region of all zones that are there.

KeepInZone, KeepOutZone, RemoveZones -> OperatingRegion with the id of the service's entity (1 where
that is 0), whenever the zones change. A WaterZone binds no aircraft and is left out.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Envelope

Kinds = dict[int, str]


class OperatingRegionStateService:
    """Keeps the ids of zones by kind."""

    name = "OperatingRegionStateService"
    subscribes: tuple[str, ...] = (
        "afrl.cmasi.KeepInZone",
        "afrl.cmasi.KeepOutZone",
        "afrl.cmasi.RemoveZones",
    )

    def __init__(self, region: int) -> None:
        self._region = region

    def start(self) -> Kinds:
        return {}

    def handle(self, state: Kinds, envelope: Envelope, now_ms: int) -> tuple[Kinds, Iterable[Any]]:
        body, kind = envelope.body, envelope.topic.rpartition(".")[2]
        if kind == "RemoveZones":
            made = {n: k for n, k in state.items() if n not in body.ZoneList}
        else:
            made = {**state, body.ZoneID: kind}
        if made == state:
            return state, ()
        zones = {
            field: sorted(n for n, k in made.items() if k == of)
            for field, of in (("KeepInAreas", "KeepInZone"), ("KeepOutAreas", "KeepOutZone"))
        }
        return made, [lmcp.new("OperatingRegion", ID=self._region, **zones)]
