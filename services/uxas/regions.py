"""OperatingRegionStateService: one operating region of all zones that are there.

KeepInZone, KeepOutZone, RemoveZones -> OperatingRegion with the id 0, which binds whoever names no region, whenever
the zones change. A zone that begins and ends at -1 ms is taken out. A WaterZone
binds no aircraft and is left out. With an additional padding each zone is sent again, padded by so much more.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import floor
from typing import Any

from cratous.bridge import lmcp
from cratous.services.bus import Envelope

Zones = dict[int, Any]
REGION, REMOVED_MS = 0, -1
FLOAT = 1e-6
"""So far a number is rounded on the wire, of itself."""


class OperatingRegionStateService:
    """Keeps the zones by id, each as last received."""

    name = "OperatingRegionStateService"
    subscribes: tuple[str, ...] = (
        "afrl.cmasi.KeepInZone",
        "afrl.cmasi.KeepOutZone",
        "afrl.cmasi.RemoveZones",
    )

    def __init__(self, padding_m: float = 0.0) -> None:
        """padding_m: by how much more each zone is padded [m]."""
        self._padding_m = padding_m

    def start(self) -> Zones:
        return {}

    def handle(self, state: Zones, envelope: Envelope, now_ms: int) -> tuple[Zones, Iterable[Any]]:
        body = envelope.body
        if envelope.topic.endswith(".RemoveZones"):
            return self._changed(state, {n: z for n, z in state.items() if n not in body.ZoneList})
        if body.StartTime == body.EndTime == REMOVED_MS:
            return self._changed(state, {n: z for n, z in state.items() if n != body.ZoneID})
        if self._ours(state.get(body.ZoneID), body):
            return state, ()
        made, out = self._changed(state, {**state, body.ZoneID: body})
        if self._padding_m:
            out = [body.copy(Padding=body.Padding + self._padding_m), *out]
        return made, out

    def _ours(self, known: Any, body: Any) -> bool:
        """Whether a zone is what we have made of it, or another service of this kind has: padded by as much more, and
        the same else. To pad that again would never end; by less it is another zone, which is to be padded too."""
        if known is None or not self._padding_m:
            return False
        most = max(abs(body.Padding), abs(known.Padding), self._padding_m)
        times = floor((body.Padding - known.Padding + FLOAT * most) / self._padding_m)
        if not max(0, times):
            return False
        return bool(body.copy(Padding=known.Padding) == known)

    def _changed(self, before: Zones, after: Zones) -> tuple[Zones, list[Any]]:
        """The region, if other zones are there than before."""
        zones = _ids(after)
        if zones == _ids(before):
            return after, []
        return after, [lmcp.new("OperatingRegion", ID=REGION, **zones)]


def _ids(state: Zones) -> dict[str, list[int]]:
    kinds = (("KeepInAreas", "KeepInZone"), ("KeepOutAreas", "KeepOutZone"))
    return {
        field: sorted(n for n, zone in state.items() if type(zone).__name__ == of)
        for field, of in kinds
    }
