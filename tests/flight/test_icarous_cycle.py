"""The cycle of ICAROUS: what its inbox takes, and takeover, offer and handback."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME, head_on

from cratous.bridge.text_protocol import (
    FenceDone,
    FenceVertex,
    Message,
    SetMode,
    SetVelocity,
    SoftReset,
    StartMission,
    Waypoint,
    WaypointReached,
)
from cratous.core.authority.gate import ICAROUS, UXAS, Gate
from cratous.core.avoidance.prediction import Intruder
from cratous.services.icarous import instance
from cratous.services.icarous.inbox import Told, hear
from cratous.services.icarous.return_to_path import persistence_ms
from cratous.spec.mission import Daa, Position


def waypoints(*places: Position) -> list[Message]:
    out: list[Message] = []
    for k, p in enumerate(places):
        lat, lon = PROJECTION.to_geodetic(p.north_m, p.east_m)
        out.append(Waypoint(k + 1, 22.0, lat, lon, p.alt_m, k))
    return [*out, StartMission()]


def vertices(count: int) -> list[Message]:
    out: list[Message] = []
    for k in range(count):
        lat, lon = PROJECTION.to_geodetic(
            500 * math.cos(2 * math.pi * k / count), 500 * math.sin(2 * math.pi * k / count)
        )
        out.append(FenceVertex("KEEPOUT", count, k + 1, lat, lon, 0.0, 500.0, 1))
    return out


def test_inbox_takes_waypoints_only_when_started() -> None:
    lines = waypoints(Position(0, 0, 300), Position(900, 0, 300))
    told = hear(Told(), tuple(lines[:-1]), PROJECTION, 0)
    assert told.waypoints == ()
    told = hear(told, (lines[-1], WaypointReached(0)), PROJECTION, 500)
    assert len(told.waypoints) == 2
    assert (told.next_index, told.heard_ms) == (1, 500)


def test_a_zone_counts_only_when_it_is_whole() -> None:
    told = hear(Told(), (*vertices(5), FenceDone(1)), PROJECTION, 0)
    assert [len(z.vertices) for z in told.zones] == [5]
    broken = [v for k, v in enumerate(vertices(5)) if k != 3]
    assert hear(Told(), (*broken, FenceDone(1)), PROJECTION, 0).zones == ()


# ---- the state machine ---------------------------------------------------------------------------


CONFIG = instance.Config(2, Daa(VOLUME), PROJECTION, 500)


def inputs(
    now_ms: int, gate: Gate, intruders: tuple[Intruder, ...], messages: list[Message] | None = None
) -> instance.Inputs:
    return instance.Inputs(now_ms, NORTH, ABILITY, intruders, gate, tuple(messages or ()))


def started() -> instance.State:
    way = waypoints(Position(-100, 0, 300), Position(3000, 0, 300), Position(4000, 0, 300))
    state, out = instance.step(
        CONFIG, instance.State(), inputs(0, Gate(UXAS, 0, False), (), [*way, WaypointReached(0)])
    )
    assert out.authority == ""
    return state


def test_cycle_of_takeover_offer_and_handback() -> None:
    state = started()
    state, out = instance.step(CONFIG, state, inputs(500, Gate(UXAS, 0, False), (head_on(1800.0),)))
    assert (out.authority, out.intruder_id, state.mode) == ("takeover", 9, instance.Mode.AVOID)
    assert SetMode("ACTIVE", 1) in out.messages
    assert any(isinstance(m, SetVelocity) for m in out.messages)
    owned, now = Gate(ICAROUS, 1, False), 500
    for _ in range(10):
        now += 500
        state, out = instance.step(CONFIG, state, inputs(now, owned, (), [SoftReset()]))
        assert out.velocity is not None
        if out.authority == "offer":
            break
    assert out.authority == "offer"
    assert SetMode("PASSIVE", 2) in out.messages
    assert now - 1000 >= persistence_ms(0)
    state, out = instance.step(CONFIG, state, inputs(now + 500, Gate(UXAS, 2, False), ()))
    assert state.mode is instance.Mode.MONITOR
    assert out.velocity is None


def test_offer_is_withdrawn_when_a_conflict_comes_up() -> None:
    state = started()
    state, _ = instance.step(CONFIG, state, inputs(500, Gate(UXAS, 0, False), (head_on(1800.0),)))
    for k in range(2, 12):
        state, out = instance.step(
            CONFIG, state, inputs(500 * k, Gate(ICAROUS, 1, False), (), [SoftReset()])
        )
        if out.authority == "offer":
            break
    assert state.mode is instance.Mode.HANDBACK
    state, out = instance.step(
        CONFIG, state, inputs(500 * k + 500, Gate(ICAROUS, 2, True), (head_on(1500.0),))
    )
    assert (out.authority, state.mode) == ("takeover", instance.Mode.AVOID)
    assert SetMode("ACTIVE", 3) in out.messages


def test_without_the_link_it_flies_on_and_offers_nothing() -> None:
    state = started()
    state, _ = instance.step(CONFIG, state, inputs(500, Gate(UXAS, 0, False), (head_on(1800.0),)))
    for k in range(6, 40):
        state, out = instance.step(CONFIG, state, inputs(500 * k, Gate(ICAROUS, 1, False), ()))
        assert out.authority == ""
        assert out.velocity is not None


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.booleans(), st.booleans(), st.floats(900, 4000)), max_size=12))
def test_authority_wishes_fit_the_gate(history: list[tuple[bool, bool, float]]) -> None:
    """Whatever happens: commands only while in command, offers only from command."""
    from cratous.core.authority.gate import gate_after, gate_offer, gate_takeover

    state, gate = started(), Gate(UXAS, 0, False)
    for k, (traffic, answer, distance) in enumerate(history, 1):
        there = (head_on(distance),) if traffic else ()
        state, out = instance.step(CONFIG, state, inputs(500 * k, gate, there, [SoftReset()]))
        if out.authority == "takeover":
            gate = gate_takeover(gate)
        elif out.authority == "offer":
            assert gate.owner == ICAROUS
            gate = gate_offer(gate)
        assert (out.velocity is not None) == (gate.owner == ICAROUS)
        if answer:
            gate = gate_after(gate, UXAS, gate.epoch)
