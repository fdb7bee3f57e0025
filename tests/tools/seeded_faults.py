"""Faults to be found by campaigns: put into the code of this process, and taken out of it again.

The first is in what is proved, so the gate refuses to fly it unless that is asked for; the others are in services.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import pytest

from cratous.core.avoidance import prediction
from cratous.core.well_clear import StandardThresholds
from cratous.services.cli import campaign_flight
from cratous.services.flight import encounter
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Sensed
from cratous.spec.authority.cycle import MONITOR
from cratous.spec.mission import WellClear

BLIND_MS = 2000
"""For how long zones are not seen once ICAROUS has taken over."""
LEGS = 1000
"""One in so many is skipped."""


def separation(patch: pytest.MonkeyPatch) -> None:
    """Predictions keep a volume that is 5 % too small in each threshold: a proved part, so the gate refuses it."""
    patch.setattr(prediction._thresholds, "__code__", _small.__code__)


def _small(volume: WellClear) -> StandardThresholds:
    return StandardThresholds(
        0.95 * volume.dthr_m, 0.95 * volume.zthr_m, 0.95 * volume.tthr_s, 0.95 * volume.tcoa_s
    )


def zone(patch: pytest.MonkeyPatch) -> None:
    """An ICAROUS instance knows of no zone for the first two seconds of each takeover, the choice of its manoeuvre included."""
    right, began_ms = Instance.handle, dict[int, int]()

    def unseeing(self: Instance, state: Any, message: Any) -> Any:
        known = state.told.zones
        after, out = right(self, replace(state, told=replace(state.told, zones=())), message)
        return replace(after, told=replace(after.told, zones=known)), out

    def late(self: Instance, state: Any, message: Any) -> Any:
        vehicle = self.config.vehicle_id
        if isinstance(message, Sensed) and state.cycle.mode != MONITOR:
            blind = message.now_ms - began_ms.get(vehicle, message.now_ms) < BLIND_MS
            return (unseeing if blind else right)(self, state, message)
        after, out = right(self, state, message)
        if after.cycle.mode == MONITOR:
            return after, out
        began_ms[vehicle] = message.now_ms
        blindly, sent = unseeing(self, state, message)
        return (after, out) if blindly.cycle.mode == MONITOR else (blindly, sent)

    patch.setattr(Instance, "handle", late)


def waypoint(patch: pytest.MonkeyPatch) -> None:
    """One leg in a thousand leads past its point to the next one: which, its place decides."""
    right = encounter._Ours._go_on

    def hasty(self: Any, at_ms: int) -> None:
        chain = self._chain
        if is_skipped(chain.items[chain.k].path) and chain.k + 1 < len(chain.items):
            self._chain = replace(chain, k=chain.k + 1)
        right(self, at_ms)

    patch.setattr(encounter._Ours, "_go_on", hasty)


def is_skipped(path: Any) -> bool:
    """Whether the leg to this place is one of those."""
    digest = hashlib.sha256(repr(path).encode()).digest()
    return int.from_bytes(digest[:8], "big") % LEGS == 0


FAULTS: dict[str, Callable[[pytest.MonkeyPatch], None]] = {
    "separation": separation, "zone": zone, "waypoint": waypoint,
}  # fmt: skip


@contextmanager
def seeded(fault: str) -> Iterator[None]:
    """With a fault in the code; what the gate has said of the code is forgotten before and after."""
    with pytest.MonkeyPatch.context() as patch:
        FAULTS[fault](patch)
        campaign_flight.standing.cache_clear()
        try:
            yield
        finally:
            campaign_flight.standing.cache_clear()
