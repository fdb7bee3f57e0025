"""ICAROUS behind the bridge as a step: what it believes, what it refuses, and when it speaks."""

from __future__ import annotations

import contextlib
import math
import socket
import time
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.bridge import text_protocol as tp
from cratous.bridge.port import Address
from cratous.bridge.text_port import TextPort
from cratous.bridge.text_protocol.handshake import ServerHandshake
from cratous.core.authority.gate import ICAROUS, UXAS, Gate
from cratous.core.avoidance.resolution import Choice
from cratous.services.flight.dynamics import Limits
from cratous.services.icarous import state as icarous
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.route_requests import Asking
from cratous.services.icarous.state import Config
from cratous.services.icarous_program.goal_reports import steering
from cratous.services.icarous_program.program import Program
from cratous.services.icarous_program.step import Craft, IcarousEnd, Note, Refuse, State, Tell
from cratous.spec.mission import Daa, Position

CRAFT = Craft(Config(1, Daa(VOLUME), PROJECTION, 500), Limits(15.0, 33.0, 0.52, 5.0), 60.0)
END = IcarousEnd(CRAFT)


def own(now_s: float, north_m: float = 0.0, speed: float = 22.0, **more: Any) -> tp.OwnPosition:
    lat, lon = PROJECTION.to_geodetic(north_m, 0.0)
    values = {"vehicle_id": 1, "east_mps": 0.0, "down_mps": 0.0, **more}
    return tp.OwnPosition(now_s, lat, lon, 300.0, 300.0, speed, **values)


def traffic(north_m: float, index: int = 9, speed: float = -22.0) -> tp.Traffic:
    lat, lon = PROJECTION.to_geodetic(north_m, 0.0)
    return tp.Traffic("TRAFFIC", lat, lon, 300.0, speed, 0.0, 0.0, index)


def way(*indices: int, total: int) -> list[tp.Message]:
    out: list[tp.Message] = [tp.SoftReset()]
    for k in indices:
        lat, lon = PROJECTION.to_geodetic(2000.0 * k, 0.0)
        out.append(tp.Waypoint(total, 22.0, lat, lon, 300.0, k))
    return [*out, tp.StartMission()]


def tell(state: State, *lines: tp.Message, end: IcarousEnd = END) -> tuple[State, list[Any]]:
    answers: list[Any] = []
    for line in lines:
        state, said = end.handle(state, line)
        answers += said
    return state, answers


def lines(answers: list[Any]) -> list[tp.Message]:
    return [answer.line for answer in answers if isinstance(answer, Tell)]


def refused(answers: list[Any]) -> list[str]:
    return [answer.why for answer in answers if isinstance(answer, Refuse)]


def encounter(end: IcarousEnd, lie_m: float = 0.0) -> tuple[State, list[Any], int]:
    """Head on, 60 heartbeats at most; the beat of the takeover, 0 for none. lie_m: OBJCT is off by it."""
    state, answers = tell(State(), *way(0, 1, 2, total=3), end=end)
    for k in range(60):
        t = k / 2
        state, said = tell(
            state, own(t, 22.0 * t), tp.Attitude(0, 0, 0), traffic(3000.0 - 22 * t + lie_m), end=end
        )
        answers += said
        if state.gate.owner == ICAROUS:
            return state, answers, k
    return state, answers, 0


def test_traffic_on_the_wire_decides_about_the_takeover() -> None:
    _, answers, beat = encounter(END)
    assert beat
    told = lines(answers)
    assert [type(line).__name__ for line in told[-3:]] == ["SetMode", "SetVelocity", "Heartbeat"]
    assert told[-3] == tp.SetMode("ACTIVE", 1)
    assert encounter(END, lie_m=90_000.0)[2] == 0
    # a traffic of ours that has to give way is waited for
    ours = Craft(CRAFT.config, CRAFT.limits, 60.0, frozenset({1, 9}))
    assert not 0 < encounter(IcarousEnd(ours))[2] <= beat


def test_every_heartbeat_is_answered_once() -> None:
    state, answers = tell(State(), *(own(t) for t in (0.0, 0.25, 0.5, 0.9, 1.0, 1.0)))
    assert [line.sequence for line in lines(answers) if isinstance(line, tp.Heartbeat)] == [1, 2, 3]
    assert state.now_ms == 1000


@pytest.mark.parametrize(
    ("line", "why"),
    [
        (own(4.0), "POSTN of an earlier time"),
        (own(6.0, speed=0.0), "POSTN that this airframe cannot fly"),
        (own(6.0, speed=4000.0), "POSTN that this airframe cannot fly"),
        (own(6.0, vehicle_id=2), "POSTN of another vehicle"),
        (traffic(0.0, index=1), "OBJCT of the vehicle itself"),
        (tp.StartMission(), "plan with waypoints missing"),
        (tp.FenceDone(3), "zone that is not whole: it is not in force"),
    ],
)
def test_what_cannot_be_so_is_refused(line: tp.Message, why: str) -> None:
    state, _ = tell(State(), *way(0, 1, total=2), own(5.0))
    part = way(0, 2, total=3)[:-1] if isinstance(line, tp.StartMission) else []
    state, _ = tell(state, *part)
    after, answers = tell(state, line)
    assert refused(answers) == [why]
    missing: dict[type[tp.Message], tp.Message] = {
        tp.StartMission: tp.LinesMissing("WAYPT", 0, 3, 1, 1),
        tp.FenceDone: tp.LinesMissing("GEOFN", 3, 0, 1, 0),
    }
    expected = missing.get(type(line))
    assert lines(answers) == ([] if expected is None else [expected])
    assert len(after.instance.told.waypoints) == 2
    assert after.now_ms == 5000


def test_an_offer_is_taken_by_the_way_on_and_by_the_original_at_once() -> None:
    offered = State(gate=Gate(ICAROUS, 2, True))
    for taking in (tp.StartMission(), tp.SoftReset(45.0, -121.0, 300.0)):
        assert tell(offered, taking)[0].gate == Gate(UXAS, 2, False)
    assert tell(offered, tp.SoftReset())[0].gate == offered.gate
    # a plan that is refused hands nothing back
    state, answers = tell(offered, *way(0, 2, total=3))
    assert refused(answers) == ["plan with waypoints missing"]
    assert state.gate == offered.gate
    assert tell(state, *way(0, 1, 2, total=3))[0].gate == Gate(UXAS, 2, False)
    owned = State(gate=Gate(ICAROUS, 1, False))
    assert tell(owned, tp.StartMission())[0].gate == owned.gate
    _, (mode,) = END.connected(owned)
    assert mode == Tell(tp.SetMode("ACTIVE", 1))
    _, (mode,) = END.connected(offered)
    assert mode == Tell(tp.SetMode("PASSIVE", 2))


def test_traffic_that_is_not_heard_of_is_dropped_and_said() -> None:
    state, answers = tell(State(), own(1.0), traffic(9000.0), *(own(1 + k) for k in range(1, 5)))
    assert (set(state.seen), refused(answers)) == ({9}, [])
    state, answers = tell(state, own(6.0))
    assert not state.seen
    assert [a for a in answers if isinstance(a, Note) and "no longer avoided" in a.text]


number = st.floats(-1e6, 1e6)
SPOTS = {"lat_deg": st.floats(44.0, 46.0), "long_deg": st.floats(-122.0, -120.0)}
ANY = st.one_of(
    st.builds(
        tp.OwnPosition, st.floats(0, 100), **SPOTS, alt_abs_m=number, alt_rel_m=number,
        north_mps=st.floats(-40, 40), east_mps=st.floats(-40, 40), down_mps=number,
    ),
    st.builds(
        tp.Traffic, st.just("TRAFFIC"), **SPOTS, alt_m=number, north_mps=number, east_mps=number,
        down_mps=number, index=st.integers(0, 5),
    ),
    st.builds(tp.Waypoint, st.integers(1, 4), number, **SPOTS, alt_m=number, index=st.integers(0, 3)),
    st.builds(tp.WaypointReached, st.integers(0, 300)),
    st.sampled_from([tp.StartMission(), tp.SoftReset(), tp.HardReset(), tp.FenceDone(1)]),
)  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(st.lists(ANY, max_size=12))
def test_whatever_can_stand_on_the_wire_leaves_the_gate_whole(told: list[tp.Message]) -> None:
    state, answers = State(), list[Any]()
    for line in told:
        before = state
        state, said = END.handle(state, line)
        answers += said
        assert state.gate.epoch >= before.gate.epoch
    beats = [line for line in lines(answers) if isinstance(line, tp.Heartbeat)]
    assert len(beats) == state.instance.beats


def test_a_command_that_is_not_known_is_answered_over_the_wire(opened: list[Any]) -> None:
    listener = socket.create_server(("127.0.0.1", 0))
    opened.append(listener)
    port = listener.getsockname()[1]
    where = Address("tcp", "127.0.0.1", port, f"tcp://127.0.0.1:{port}")
    program = Program(END, TextPort(where, server=False), lambda _severity, _text: None)
    opened.append(program._port)
    program.turn()
    uxas, _ = listener.accept()
    opened.append(uxas)
    uxas.settimeout(0.05)
    handshake, parser = ServerHandshake(), tp.StreamParser(tp.Direction.UP)
    uxas.sendall(handshake.start())
    got, until_s = list[Any](), time.monotonic() + 60
    while not any(isinstance(one, tp.NotKnown) for one in got):
        assert time.monotonic() < until_s, got
        program.turn()
        with contextlib.suppress(TimeoutError):
            data = uxas.recv(4096)
            if handshake.done:
                got += parser.feed(data)
                continue
            uxas.sendall(handshake.feed(data))
            if handshake.done:
                uxas.sendall(b"COMND,typeDIVE,\n")
                got += parser.feed(handshake.rest)
    assert got == [tp.Hello(1), tp.SetMode("PASSIVE", 0), tp.NotKnown("DIVE")]


def test_how_others_fly_is_forgotten_on_a_new_connection() -> None:
    """UxAS tells again what it knows; what it knows no more it does not tell."""
    lat, lon = PROJECTION.to_geodetic(2000.0, 0.0)
    told = [tp.WayOfAnother(2, 1, lat, lon, 300.0, 0), tp.VelocityOfAnother(3, 20.0, 0.0, 0.0)]
    state, _ = tell(State(), *way(0, 1, total=2), *told)
    assert state.instance.told.way_of(2)
    assert state.instance.told.steered
    state, _ = END.connected(state)
    assert (state.instance.told.others, state.instance.told.steered) == ((), ())
    assert state.instance.told.waypoints


def test_an_answer_of_a_former_connection_is_not_handed_back_onto() -> None:
    """UxAS keeps its answers as long as the connection: after that their numbers mean the direct way."""
    state, _ = tell(State(), tp.UxasPlans())
    asking = state.instance.asking._replace(
        number=7, answered=7, asked_ms=0, proposal=(Position(2000.0, 0.0, 300.0),)
    )
    state = replace(state, instance=replace(state.instance, asking=asking))
    state, _ = END.connected(state)
    assert state.instance.asking == Asking(number=7)
    state, _ = tell(state, tp.UxasPlans(), tp.RouteStart(7), tp.RouteEnd(7))
    assert (state.instance.asking.allowed, state.instance.asking.proposal) == (True, ())


def _course(line: tp.SetVelocity | tp.SetPosition, north_m: float, east_m: float) -> float:
    """The course that a steering line leads to, from here [rad]."""
    if isinstance(line, tp.SetVelocity):
        return math.atan2(line.east_mps, line.north_mps)
    north, east = PROJECTION.to_local(line.lat_deg, line.long_deg)
    return math.atan2(east - east_m, north - north_m)


def flown_round(end: IcarousEnd, beats: int = 0, alt_m: float = 300.0) -> list[tp.Message]:
    """All that ICAROUS says of a flight along a plan, past an aircraft that comes head on, until it offers control, and for
    so many heartbeats after that, in which nobody takes it. alt_m: of the vehicle, the plan and the other are at 300 m."""
    state, _ = tell(State(), *way(0, 1, 2, total=3), tp.WaypointReached(0), end=end)
    north_m, east_m, course, said = 0.0, 0.0, 0.0, list[tp.Message]()
    for k in range(400):
        lat, lon = PROJECTION.to_geodetic(north_m, east_m)
        speeds = 22 * math.cos(course), 22 * math.sin(course), 0.0
        here = tp.OwnPosition(k / 2, lat, lon, alt_m, alt_m, *speeds, vehicle_id=1)
        state, answers = tell(state, here, traffic(3000.0 - 11 * k), end=end)
        said += lines(answers)
        steered = [m for m in said if isinstance(m, tp.SetVelocity | tp.SetPosition)]
        if any(isinstance(m, tp.SetMode) and m.mode == "PASSIVE" for m in said):
            beats -= 1
        if beats < 0:
            return said
        if steered:
            off = _course(steered[-1], north_m, east_m) - course
            course += max(-0.12, min(0.12, math.remainder(off, math.tau)))
        north_m, east_m = north_m + 11 * math.cos(course), east_m + 11 * math.sin(course)
    raise AssertionError("control is not offered")


@pytest.mark.parametrize("dialect", list(tp.Dialect))
def test_the_waypoint_with_which_it_goes_on_is_said_as_it_hands_back(dialect: tp.Dialect) -> None:
    said = flown_round(IcarousEnd(replace(CRAFT, dialect=dialect)))
    places = [k for k, line in enumerate(said) if isinstance(line, tp.GoToWaypoint)]
    if dialect is tp.Dialect.ORIGINAL:
        assert not places
        return
    (k,) = places
    assert said[k] == tp.GoToWaypoint(1)
    following = said[k + 1]
    assert isinstance(following, tp.SetMode)
    assert following.mode == "PASSIVE"


def test_where_the_straight_way_to_a_waypoint_is_flown_its_place_is_said() -> None:
    """As the original's ICAROUS has it: SETPOS where the direct path is free, SETVEL while it avoids."""
    said = flown_round(END, beats=12)
    steered = [m for m in said if isinstance(m, tp.SetVelocity | tp.SetPosition)]
    places = [m for m in steered if isinstance(m, tp.SetPosition)]
    assert isinstance(steered[0], tp.SetVelocity), "the turn away is no way to a waypoint"
    assert places
    for place in places:
        north, east = PROJECTION.to_local(place.lat_deg, place.long_deg)
        assert min(abs(north - 2000.0 * k) for k in (1, 2)) < 0.1
        assert abs(east) < 0.1
        assert place.alt_m == pytest.approx(300.0)


def test_a_place_at_another_altitude_is_not_flown_straight_to() -> None:
    """A loiter at the place would climb; the manoeuvre that was looked at is level."""
    said = flown_round(END, beats=12, alt_m=320.0)
    assert not any(isinstance(m, tp.SetPosition) for m in said)
    assert any(isinstance(m, tp.SetVelocity) for m in said)


STRAIGHT = Choice("turn", 0.0, 22.0, 0.0, 0.0, True, None)


@pytest.mark.parametrize(
    ("choice", "distance_m", "said"),
    [
        (STRAIGHT, 2000.0, tp.SetPosition),
        (STRAIGHT, 100.0, tp.SetVelocity),  # it would circle there
        (STRAIGHT._replace(clear=False), 2000.0, tp.SetVelocity),
        (STRAIGHT._replace(climb_m_s=1.0), 2000.0, tp.SetVelocity),
        (STRAIGHT._replace(heading_rad=0.1), 2000.0, tp.SetVelocity),
        (STRAIGHT._replace(speed_m_s=25.0), 2000.0, tp.SetVelocity),
    ],
)
def test_a_place_is_said_of_a_far_one_that_is_flown_straight_to_and_free_alone(
    choice: Choice, distance_m: float, said: type[tp.Message]
) -> None:
    told = Told(waypoints=(Position(distance_m, 0.0, 300.0),), started=True)
    state = icarous.State(told=told, held=choice)
    sensed = Sensed(0, NORTH, ABILITY, (), Gate(ICAROUS, 1, False))
    line = tp.SetVelocity(22.0, 0.0, 0.0)
    assert type(steering(line, state, sensed, PROJECTION)) is said


def test_what_it_is_told_to_forget_is_forgotten_and_nothing_else() -> None:
    corners = ((0.0, 9000.0), (0.0, 9100.0), (100.0, 9100.0))
    places = [PROJECTION.to_geodetic(*corner) for corner in corners]
    fence = [tp.FenceVertex("KEEPOUT", 3, k, *p, 0.0, 900.0, 1) for k, p in enumerate(places, 1)]
    state, _ = tell(State(), *way(0, 1, 2, total=3), *fence, tp.FenceDone(1))
    told = state.instance.told
    assert len(told.zones) == 1
    assert (len(told.waypoints), told.started) == (3, True)
    without, answers = tell(state, tp.ForgetFences())
    assert not refused(answers)
    assert (without.instance.told.zones, without.instance.told.waypoints) == ((), told.waypoints)
    without, answers = tell(state, tp.ForgetWaypoints())
    assert not refused(answers)
    assert (without.instance.told.zones, without.instance.told.waypoints) == (told.zones, ())
    without, answers = tell(state, tp.StopMission())
    assert not refused(answers)
    assert not without.instance.told.started
    assert tell(without, tp.StartMission())[0].instance.told.started
