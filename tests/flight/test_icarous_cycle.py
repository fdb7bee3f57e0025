"""The ICAROUS instance as a step: pure, decided by its kernels; takeover, offer and handback."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace
from typing import Any

import pytest
from flight_tools import flown, meeting, of_type, plain_steps
from hypothesis import given, settings
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME, head_on

from cratous.bridge import text_protocol as tp
from cratous.core.authority.cycle import Cycle, Cycled, gate_wished, patience
from cratous.core.authority.gate import ICAROUS, UXAS, Gate, gate_accepts, gate_after
from cratous.core.avoidance.prediction import Intruder
from cratous.services.icarous import instance
from cratous.services.icarous.inbox import Told, hear
from cratous.services.icarous.instance import LINK_LOST_MS, Instance
from cratous.services.icarous.messages import Foresees, Line, Sensed, Steer, ToInstance, Up, Wish
from cratous.services.icarous.return_to_path import PERSIST_MS, RELAPSE_MS
from cratous.services.icarous.state import Config, State
from cratous.services.logs.records import from_data, to_data
from cratous.spec.authority.cycle import (
    AVOID,
    HANDBACK,
    MONITOR,
    NOTHING,
    OFFER,
    TAKE_OVER,
    WITHDRAW,
)
from cratous.spec.mission import Daa, Position, Simulation

BEAT_MS = 500
ICS = Instance(Config(2, Daa(VOLUME), PROJECTION, BEAT_MS))
FREE, OWNED, OFFERED = Gate(UXAS, 0, False), Gate(ICAROUS, 1, False), Gate(ICAROUS, 2, True)
NEAR = (head_on(1800.0),)
"""So near that everybody acts at once."""


def waypoints(*places: Position) -> list[tp.Message]:
    out: list[tp.Message] = []
    for k, p in enumerate(places):
        lat, lon = PROJECTION.to_geodetic(p.north_m, p.east_m)
        out.append(tp.Waypoint(len(places), 22.0, lat, lon, p.alt_m, k))
    return [*out, tp.StartMission()]


def vertices(count: int) -> list[tp.FenceVertex]:
    out: list[tp.FenceVertex] = []
    for k in range(count):
        lat, lon = PROJECTION.to_geodetic(
            500 * math.cos(2 * math.pi * k / count), 500 * math.sin(2 * math.pi * k / count)
        )
        out.append(tp.FenceVertex("KEEPOUT", count, k + 1, lat, lon, 0.0, 500.0, 1))
    return out


def heard(told: Told, *lines: tp.Message, now_ms: int = 0) -> Told:
    for line in lines:
        told = hear(told, line, PROJECTION, now_ms)
    return told


def test_inbox_takes_waypoints_only_when_started() -> None:
    lines = waypoints(Position(0, 0, 300), Position(900, 0, 300))
    told = heard(Told(), *lines[:-1])
    assert told.waypoints == ()
    told = heard(told, lines[-1], tp.WaypointReached(0), now_ms=500)
    assert len(told.waypoints) == 2
    assert (told.next_index, told.heard_ms) == (1, 500)


def test_a_plan_that_lost_its_tail_is_not_in_force() -> None:
    *sent, start = waypoints(*(Position(900.0 * k, 0, 300) for k in range(4)))
    for lost in range(1, 4):
        assert heard(Told(), *sent[:-lost], start).waypoints == ()
    counted = [replace(line, total=k) for k, line in enumerate(sent, 1)]  # type: ignore[call-arg]
    assert heard(Told(), *counted, start).waypoints == ()
    told = Told()
    for line in (*counted, start):
        told = hear(told, line, PROJECTION, 0, original=True)
    assert len(told.waypoints) == 4


def test_a_zone_counts_only_when_it_is_whole() -> None:
    told = heard(Told(), *vertices(5), tp.FenceDone(1))
    assert [len(z.vertices) for z in told.zones] == [5]
    broken = [v for k, v in enumerate(vertices(5)) if k != 3]
    assert heard(Told(), *broken, tp.FenceDone(1)).zones == ()
    # as many vertices as the total, and yet not the zone that was sent
    one, two, three, four, five = vertices(5)
    other = [replace(four, zone=2), replace(four, fence="KEEPIN"), replace(four, total=6)]
    other += [replace(four, floor_m=9.0), replace(four, ceiling_m=9.0), replace(four, vertex=3)]
    for wrong in other:
        assert heard(Told(), one, two, three, wrong, five, tp.FenceDone(1)).zones == ()
    assert heard(Told(), one, three, two, four, five, tp.FenceDone(1)).zones == ()
    assert heard(Told(), *vertices(5), tp.FenceDone(2)).zones == ()
    assert [z.id for z in heard(Told(), *vertices(5), tp.FenceDone()).zones] == [1]


# ---- the step ------------------------------------------------------------------------------------

WAY = (Position(-100, 0, 300), Position(3000, 0, 300), Position(4000, 0, 300))


def sensed(now_ms: int, gate: Gate, intruders: tuple[Intruder, ...] = ()) -> Sensed:
    return Sensed(now_ms, NORTH, ABILITY, intruders, gate)


def after(*messages: ToInstance, state: State = State()) -> tuple[State, list[Any]]:
    """The state after some messages, and what the last one led to."""
    out: tuple[Any, ...] = ()
    for message in messages:
        state, out = ICS.handle(state, message)
    return state, list(out)


def told_way() -> tuple[Line, ...]:
    return tuple(Line(0, line) for line in (*waypoints(*WAY), tp.WaypointReached(0)))


def started() -> State:
    state, out = after(*told_way(), sensed(0, FREE))
    assert out == [Up(2, tp.Heartbeat(1, 0.0))]
    return state


def of(out: list[Any], kind: type) -> list[Any]:
    return [message for message in out if isinstance(message, kind)]


def acts(out: list[Any]) -> list[int]:
    return [wish.act for wish in of(out, Wish)]


def beats(first: int, count: int, gate: Gate, *lines: tp.Message) -> list[ToInstance]:
    """Heartbeats from a number on, each after some lines."""
    out: list[ToInstance] = []
    for k in range(first, first + count):
        now_ms = BEAT_MS * k
        out += [*(Line(now_ms, line) for line in lines), sensed(now_ms, gate)]
    return out


ALL: tuple[ToInstance, ...] = (
    *(Line(0, line) for line in (*vertices(4), tp.FenceDone(1), tp.HardReset())),
    *told_way(),
    sensed(0, FREE),
    sensed(500, FREE, NEAR),
    Line(600, tp.SoftReset(45.0, -121.0, 300.0)),
    *beats(2, 6, OWNED, tp.SoftReset()),
    sensed(4000, OFFERED, NEAR),
    *beats(9, 6, Gate(ICAROUS, 3, False), tp.SoftReset()),
    sensed(8000, Gate(UXAS, 4, False)),
    sensed(8500, Gate(UXAS, 4, False), NEAR),
)


def test_a_step_changes_nothing_but_its_answer() -> None:
    modes = set()
    for state in plain_steps(ICS, State(), ALL):
        assert from_data(State, to_data(state)) == state
        modes.add(state.cycle.mode)
    assert modes == {MONITOR, AVOID, HANDBACK}


def test_a_step_touches_no_clock_chance_file_or_socket(monkeypatch: pytest.MonkeyPatch) -> None:
    import builtins
    import random
    import socket
    import time

    def refuse(*_: Any, **__: Any) -> Any:
        raise AssertionError("a step has touched the world")

    places: tuple[tuple[Any, str], ...] = (
        (time, "time"),
        (time, "monotonic"),
        (time, "perf_counter"),
        (random, "random"),
        (random.Random, "random"),
        (socket, "socket"),
        (builtins, "open"),
    )
    list(plain_steps(ICS, State(), ALL))  # what is imported or compiled at first use is no step's
    with monkeypatch.context() as closed:
        for owner, name in places:
            closed.setattr(owner, name, refuse)
        state = State()
        for message in ALL:
            state, _ = ICS.handle(state, message)
    assert state.cycle.mode == AVOID


def test_cycle_of_takeover_offer_and_handback() -> None:
    state, out = after(sensed(500, FREE, NEAR), state=started())
    (wish,), (foresees,), (steer,) = of(out, Wish), of(out, Foresees), of(out, Steer)
    assert (wish.act, wish.intruder_id, state.cycle.mode) == (TAKE_OVER, 9, AVOID)
    assert wish.reason == f"traffic: loss predicted in {foresees.first_violation_s:.1f} s"
    assert (foresees.intruder_id, steer.epoch) == (9, 1)
    assert [type(message) for message in out] == [Wish, Foresees, Steer, Up, Up, Up]
    up = [message.line for message in of(out, Up)]
    assert up[0] == tp.SetMode("ACTIVE", 1)
    assert isinstance(up[1], tp.SetVelocity)
    assert up[2] == tp.Heartbeat(2, 0.5)
    state, out = after(*beats(2, 3, OWNED, tp.SoftReset()), state=state)
    assert (acts(out), state.cycle.mode) == ([], AVOID)
    assert of(out, Steer)[0].epoch == 1
    state, out = after(*beats(5, 1, OWNED, tp.SoftReset()), state=state)
    assert (acts(out), state.cycle.mode) == ([OFFER], HANDBACK)
    assert of(out, Up)[0].line == tp.SetMode("PASSIVE", 2)
    assert of(out, Steer)[0].epoch == 2
    state, out = after(sensed(3000, Gate(UXAS, 2, False)), state=state)
    assert (state.cycle, out) == (
        Cycle(MONITOR, 0, True, 3000, False, 0),
        [Up(2, tp.Heartbeat(7, 3.0))],
    )
    assert (state.held, state.threats) == (None, ())


def test_an_offer_is_withdrawn_when_a_conflict_comes_up() -> None:
    state, _ = after(sensed(500, FREE, NEAR), *beats(2, 4, OWNED, tp.SoftReset()), state=started())
    assert state.cycle.mode == HANDBACK
    state, out = after(sensed(3000, OFFERED, (head_on(1500.0),)), state=state)
    assert (acts(out), state.cycle.mode) == ([WITHDRAW], AVOID)
    assert of(out, Up)[0].line == tp.SetMode("ACTIVE", 3)
    assert of(out, Steer)[0].epoch == 3
    assert of(out, Foresees)[0].resolution.startswith("offer withdrawn; heading")
    # told also where the manoeuvre is the one flown already, but then not twice
    again = replace(state, cycle=state.cycle._replace(mode=HANDBACK))
    _, out = after(sensed(3000, OFFERED, (head_on(1500.0),)), state=again)
    assert len(of(out, Foresees)) == 1
    _, out = after(sensed(3000, OWNED, (head_on(1500.0),)), state=state)
    assert of(out, Foresees) == []


def test_without_the_link_it_flies_on_and_offers_nothing() -> None:
    state, _ = after(sensed(500, FREE, NEAR), state=started())
    for message in beats(6, 34, OWNED):
        state, out = after(message, state=state)
        assert acts(out) == []
        assert len(of(out, Steer)) == 1
    # any line will do to count as heard, and the offer comes at once
    _, out = after(*beats(40, 1, OWNED, tp.SoftReset()), state=state)
    assert acts(out) == [OFFER]


def test_a_takeover_soon_after_a_handback_has_to_last_longer() -> None:
    for gap_ms, relapses in ((RELAPSE_MS - 1, 1), (RELAPSE_MS, 0)):
        handed = Cycle(MONITOR, 0, True, 10_000, False, 0)
        state = replace(started(), cycle=handed)
        state, out = after(sensed(10_000 + gap_ms, FREE, NEAR), state=state)
        assert acts(out) == [TAKE_OVER]
        assert state.cycle.relapses == relapses


def test_an_instance_that_was_started_anew_in_command_flies_on() -> None:
    state, out = after(*told_way(), sensed(0, OWNED))
    assert state.cycle.mode == AVOID
    assert [steer.epoch for steer in of(out, Steer)] == [1]
    assert acts(out) == []


def test_a_takeover_makes_for_the_waypoint_that_is_next() -> None:
    """Not for one that is told to be reached, though it lies ahead."""
    state, _ = after(Line(0, tp.WaypointReached(1)), sensed(500, FREE, NEAR), state=started())
    assert (state.cycle.mode, state.goal) == (AVOID, 2)


def test_another_way_is_flown_from_its_beginning() -> None:
    """Told while ICAROUS flies, as after an offer that was withdrawn: the goal was on the way before."""
    lines = told_way()
    state, _ = after(sensed(500, FREE, NEAR), state=started())
    state = replace(state, goal=2)
    other = [Line(900, line) for line in waypoints(Position(2500, 0, 300), Position(3500, 0, 300))]
    state, out = after(*other, state=state)
    assert (state.goal, out) == (0, [])
    state, out = after(sensed(1000, OWNED), state=state)
    assert (state.goal, len(of(out, Steer))) == (0, 1)
    assert after(lines[0], state=replace(state, goal=1))[0].goal == 1


def test_a_goal_beyond_the_end_is_the_end() -> None:
    state, _ = after(sensed(500, FREE, NEAR), state=started())
    state, out = after(sensed(1000, OWNED), state=replace(state, goal=7))
    assert (state.goal, len(of(out, Steer))) == (2, 1)


def test_a_zone_ahead_off_the_path_is_a_reason_to_take_over() -> None:
    state, _ = after(*(Line(0, line) for line in (*vertices(12), tp.FenceDone(1))))
    south = NORTH._replace(position=Position(-800.0, 0.0, 300.0))
    state, out = after(Sensed(500, south, ABILITY, (), FREE), state=state)
    (wish,) = of(out, Wish)
    assert (wish.act, wish.intruder_id) == (TAKE_OVER, 0)
    assert wish.reason.startswith("zone: loss predicted in ")
    away = south._replace(heading_rad=math.pi)
    state, _ = after(*(Line(0, line) for line in (*vertices(12), tp.FenceDone(1))))
    assert acts(after(Sensed(500, away, ABILITY, (), FREE), state=state)[1]) == []


def test_an_intruder_that_it_need_not_avoid_takes_no_vehicle() -> None:
    high = head_on(1800.0)
    high = high._replace(position=high.position._replace(alt_m=500.0))
    state, out = after(sensed(500, FREE, (high,)), state=started())
    assert (acts(out), state.threats) == ([], ())


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.booleans(), st.booleans(), st.booleans(), st.floats(900, 4000))))
def test_it_steers_exactly_while_its_gate_lets_it(
    history: list[tuple[bool, bool, bool, float]],
) -> None:
    """Whatever happens: one velocity a heartbeat while it commands, none else, all pass the gate; and
    no offer before as much time has passed since the takeover as is asked for."""
    state, gate, free_since = started(), FREE, 0
    for k, (traffic, answers, speaks, distance) in enumerate(history[:14], 1):
        there = (head_on(distance),) if traffic else ()
        if speaks:
            state, out = after(Line(BEAT_MS * k, tp.SoftReset()), state=state)
            assert out == []
        relapses = state.cycle.relapses
        state, out = after(sensed(BEAT_MS * k, gate, there), state=state)
        for wish in of(out, Wish):
            gate = gate_wished(gate, wish.act)
            assert wish.act != OFFER or BEAT_MS * k - free_since >= patience(relapses, PERSIST_MS)
            assert wish.act != OFFER or BEAT_MS * k - state.told.heard_ms <= LINK_LOST_MS
        if gate.owner == UXAS or TAKE_OVER in acts(out):
            free_since = BEAT_MS * k  # not earlier than this
        steers = of(out, Steer)
        assert len(steers) == (gate.owner == ICAROUS)
        assert all(gate_accepts(gate, ICAROUS, steer.epoch) for steer in steers)
        assert (state.cycle.mode == HANDBACK) == gate.offered
        assert out[-1] == Up(2, tp.Heartbeat(k + 1, BEAT_MS * k / 1000))
        if answers:
            gate = gate_after(gate, UXAS, gate.epoch)


# ---- in flight -----------------------------------------------------------------------------------


LIMIT_MS = 200_000


def owners(log: list[Any]) -> list[str]:
    """Whose the vehicle became, one after the other, up to LIMIT_MS."""
    return [c.Owner.name for c in of_type(log, "AuthorityChange") if c.Time < LIMIT_MS]


def test_the_kernels_of_the_cycle_decide_what_is_flown(monkeypatch: pytest.MonkeyPatch) -> None:
    """With one that never takes over nothing does, with one that never offers nothing is handed back."""
    result, log = flown(meeting())
    assert (result.outcome, result.takeovers) == ("complete", 1)
    assert owners(log) == ["ICAROUS", "UxAS"]
    for kernel, left in (("cycle_watched", []), ("cycle_flown", ["ICAROUS"])):
        with monkeypatch.context() as patch:
            patch.setattr(instance, kernel, lambda cycle, *_: Cycled(cycle, NOTHING))
            _, log = flown(replace(meeting(), simulation=Simulation(limit_ms=LIMIT_MS)))
        assert owners(log) == left


def test_the_kernel_of_notice_decides_who_flies(monkeypatch: pytest.MonkeyPatch) -> None:
    """An instance that never notices that its offer was taken has its commands dropped at the gate."""
    monkeypatch.setattr(instance, "cycle_begun", lambda cycle, commands, now: cycle)
    _, log = flown(meeting())
    assert {drop.Sender.name for drop in of_type(log, "CommandDropped")} == {"ICAROUS"}


def test_a_state_survives_a_restart() -> None:
    state, _ = after(*ALL)
    assert pickle.loads(pickle.dumps(state)) == state
