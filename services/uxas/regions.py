"""OperatingRegionStateService: maintains one operating region that contains all existing zones.

KeepInZone, KeepOutZone, RemoveZones -> OperatingRegion with id 0, which applies to requests that
name no region, whenever the zones change. A zone with start and end time -1 ms is removed. A
WaterZone does not apply to aircraft and is omitted. With an additional padding each zone is sent
again with that padding added.
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
"""Relative rounding error of numbers on the wire."""


class OperatingRegionStateService:
    """Stores the newest version of each zone by id."""

    name = "OperatingRegionStateService"
    subscribes: tuple[str, ...] = (
        "afrl.cmasi.KeepInZone",
        "afrl.cmasi.KeepOutZone",
        "afrl.cmasi.RemoveZones",
    )

    def __init__(self, padding_m: float = 0.0) -> None:
        """padding_m: additional padding of each zone [m]."""
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
        """Whether a zone was already padded by this service or another of its kind: equal except
        for that padding. Padding it again would never end; a zone with less padding is a different
        one, which is padded too.
        """
        if known is None or not self._padding_m:
            return False
        most = max(abs(body.Padding), abs(known.Padding), self._padding_m)
        times = floor((body.Padding - known.Padding + FLOAT * most) / self._padding_m)
        if not max(0, times):
            return False
        return bool(body.copy(Padding=known.Padding) == known)

    def _changed(self, before: Zones, after: Zones) -> tuple[Zones, list[Any]]:
        """The operating region, if the set of zones has changed."""
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
