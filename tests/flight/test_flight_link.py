"""The bridge breaks in flight: the vehicle's own ICAROUS still keeps it well clear."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import pytest
from flight_tools import VOLUME, meeting

from cratous.bridge import lmcp
from cratous.bridge.loopback import Bridge
from cratous.core.kernel import Vec2
from cratous.core.well_clear import violation_within
from cratous.services.bus import Bus
from cratous.services.flight.loop import fly
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import (
    Simulation,
)


def test_link_cut_before_the_encounter(monkeypatch: pytest.MonkeyPatch) -> None:
    mission, count = meeting(), itertools.count()
    exchange = Bridge.exchange

    def cutting(bridge: Bridge) -> list[Any]:
        if next(count) == 40:
            bridge.cut(1)
        return exchange(bridge)

    monkeypatch.setattr(Bridge, "exchange", cutting)
    bus, log = Bus(lmcp.full_names), []
    bus.tap(lambda envelope: log.append(envelope.body))
    result = fly(mission, make_plan(mission), bus)
    status = [b for b in log if type(b).__name__ == "BridgeStatus"]
    assert [s.Alive for s in status] == [True, False]
    assert "link lost" in status[-1].Note
    # it takes over on its own, keeps clear, and without UxAS never hands back
    assert result.takeovers == 1
    assert result.outcome == "limit"
    states = [b for b in log if type(b).__name__ == "TruthState"]
    limits = (VOLUME.dthr_m, VOLUME.zthr_m, VOLUME.tthr_s, VOLUME.tcoa_s)
    for _, group in itertools.groupby(states, key=lambda s: s.Time):
        a, b = group
        s = Vec2(a.North - b.North, a.East - b.East)
        v = Vec2(a.VelocityNorth - b.VelocityNorth, a.VelocityEast - b.VelocityEast)
        lost = violation_within(
            s, v, a.Altitude - b.Altitude, b.VelocityDown - a.VelocityDown, *limits, 0.25
        )
        assert not lost


def test_silence_of_icarous_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    mission = replace(meeting(), traffic=(), simulation=Simulation(limit_ms=8000))
    send, count = Bridge.to_uxas, itertools.count()

    def silent(bridge: Bridge, vehicle_id: int, message: Any) -> bool:
        return next(count) > 6 or send(bridge, vehicle_id, message)

    monkeypatch.setattr(Bridge, "to_uxas", silent)
    bus, log = Bus(lmcp.full_names), []
    bus.tap(lambda envelope: log.append(envelope.body))
    fly(mission, make_plan(mission), bus)
    notes = [b.Note for b in log if type(b).__name__ == "BridgeStatus"]
    assert notes == ["connected", "silent since 3000 ms"]
