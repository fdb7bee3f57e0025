"""The bridge breaks in flight: the vehicle's own ICAROUS still keeps it well clear."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import pytest
from flight_tools import VOLUME, flown, meeting, of_type, vehicle

from cratous.bridge import lmcp
from cratous.bridge.loopback import Bridge
from cratous.core.kernel import Vec2
from cratous.core.well_clear import StandardThresholds, violation_within
from cratous.services.bus import Bus
from cratous.services.flight.loop import fly
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Sensed, Wish
from cratous.services.pipeline.plan import make_plan
from cratous.spec.authority.cycle import TAKE_OVER
from cratous.spec.mission import Position, Simulation, Traffic, Velocity


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
    limits = StandardThresholds(VOLUME.dthr_m, VOLUME.zthr_m, VOLUME.tthr_s, VOLUME.tcoa_s)
    for _, group in itertools.groupby(states, key=lambda s: s.Time):
        a, b = group
        s = Vec2(a.North - b.North, a.East - b.East)
        v = Vec2(a.VelocityNorth - b.VelocityNorth, a.VelocityEast - b.VelocityEast)
        lost = violation_within(
            s, v, a.Altitude - b.Altitude, b.VelocityDown - a.VelocityDown, limits, 0.25
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


def test_an_instance_takes_no_vehicle_but_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """The ICAROUS of vehicle 2 claims vehicle 1 at each heartbeat: it gets its own, as if it had said so."""
    handle = Instance.handle

    def greedy(actor: Instance, state: Any, message: Any) -> Any:
        after, out = handle(actor, state, message)
        if actor.config.vehicle_id == 2 and isinstance(message, Sensed):
            out = (Wish(1, TAKE_OVER, "mine", 1), *out)
        return after, out

    monkeypatch.setattr(Instance, "handle", greedy)
    two = (vehicle(1, 0.0, 0.0), vehicle(2, 0.0, 5000.0))
    mission = replace(
        meeting(), vehicles=two, traffic=(), instances=(1, 2), simulation=Simulation(limit_ms=2000)
    )
    _, log = flown(mission)
    assert {g.VehicleID for g in of_type(log, "GateState")} == {2}


def test_a_bridge_that_nobody_needs_leaves_plan_and_flight_as_they_are() -> None:
    """The thesis: both programs, without affecting their internal processing."""
    # the other aircraft passes 20 km away
    far = Traffic(90, Position(2640.0, -20_000.0, 300.0), Velocity(22.0, 0.0, 0.0))
    mission = replace(meeting(), traffic=(far,))
    found = []
    for instances in (mission.instances, ()):
        one = replace(mission, instances=instances)
        plan = make_plan(one)
        result, log = flown(one, plan)
        kinds = ("AirVehicleState", "TruthState", "TaskProgress", "MissionCommand")
        said = [
            str(
                b.copy(Cooperative=False) if hasattr(b, "Cooperative") else b
            )  # who has an instance
            for b in log
            if type(b).__name__ in kinds
        ]
        found.append((plan.items, result.outcome, said))
    bridged, alone = found
    assert mission.instances
    assert len(bridged[2]) > 1000
    assert bridged == alone
