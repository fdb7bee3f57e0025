"""The aircraft, the autopilot and the gate of one vehicle."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.authority.gate import ICAROUS, UXAS
from cratous.core.routing.polylines import Track
from cratous.services.flight.autopilot import Circle, Fly, Follow, decide, track_progress
from cratous.services.flight.commands import (
    decode,
    gated,
    loiter_command,
    path_command,
    velocity_command,
)
from cratous.services.flight.dynamics import (
    AirState,
    Limits,
    Steering,
    advance,
    steer,
    turn_radius_m,
    turn_rate_rad_s,
)
from cratous.services.flight.messages import Choose, Commanded, Move, Say, ToVehicle, Wished
from cratous.services.flight.vehicle import State, VehicleNode
from cratous.services.icarous.messages import Wish
from cratous.services.mission.frames import Projection
from cratous.spec.authority.cycle import OFFER, TAKE_OVER, WITHDRAW
from cratous.spec.mission import Frame, Position, Vehicle, Velocity
from cratous.spec.mission.plan import Hold

LIMITS = Limits(15.0, 33.0, math.radians(35), 4.0)
DT_S = 0.25
FRAME = Frame(45.0, -121.0, 0.0)


def state(heading: float = 0.0, speed: float = 22.0) -> AirState:
    return AirState(Position(0.0, 0.0, 300.0), heading, speed, 0.0)


@given(st.floats(-4, 4), st.floats(-4, 4), st.floats(0, 60), st.floats(-20, 20))
def test_no_step_exceeds_the_limits(now: float, to: float, speed: float, climb: float) -> None:
    before = state(math.remainder(now, 2 * math.pi))
    after = steer(before, Steering(to, speed, climb), LIMITS, DT_S)
    turned = abs(math.remainder(after.heading_rad - before.heading_rad, 2 * math.pi))
    assert turned <= turn_rate_rad_s(22.0, LIMITS.max_bank_rad) * DT_S + 1e-9
    assert abs(after.speed_m_s - before.speed_m_s) <= LIMITS.max_acceleration_m_s2 * DT_S + 1e-9
    assert LIMITS.min_speed_m_s <= after.speed_m_s <= LIMITS.max_speed_m_s
    assert abs(after.climb_m_s) <= LIMITS.max_climb_m_s


def test_turn_takes_the_shorter_side() -> None:
    after = steer(state(math.radians(170)), Steering(math.radians(-170), 22.0, 0.0), LIMITS, DT_S)
    assert math.radians(170) < after.heading_rad <= math.pi


def test_step_is_straight() -> None:
    after = advance(state(math.pi / 2), DT_S)
    assert after.position.east_m == pytest.approx(5.5)
    assert after.position.north_m == pytest.approx(0.0)


def wavy(radius_m: float) -> Track:
    """An S of two half circles of a radius, between straight ends."""
    points = [Position(-200.0, 0.0, 300.0), Position(0.0, 0.0, 300.0)]
    for k in range(1, 41):
        a = math.pi * k / 40
        points.append(Position(radius_m * math.sin(a), radius_m * (1 - math.cos(a)), 300.0))
    for k in range(1, 41):
        a = math.pi * k / 40
        points.append(
            Position(-radius_m * math.sin(a), 2 * radius_m + radius_m * (1 - math.cos(a)), 300.0)
        )
    points.append(Position(200.0, 4 * radius_m, 300.0))
    return Track(tuple(points))


def fly_track(track: Track, start: AirState, speed: float) -> tuple[float, float]:
    """Largest distance from the track after the first 100 m, and the length flown to its end."""
    command, now, worst, flown = Follow(track, speed), start, 0.0, 0.0
    for _ in range(2000):
        command, progress = track_progress(command, now, DT_S)
        if progress.passed:
            return worst, flown
        if progress.after_m > 100:
            worst = max(worst, abs(command.offset_m))
        now = advance(steer(now, decide(command, now, LIMITS, DT_S), LIMITS, DT_S), DT_S)
        flown += now.speed_m_s * DT_S
    raise AssertionError("the end of the track was never passed")


@pytest.mark.parametrize("speed", [16.0, 22.0, 30.0])
def test_track_is_followed_within_metres(speed: float) -> None:
    track = wavy(1.1 * turn_radius_m(speed, LIMITS.max_bank_rad))
    start = AirState(Position(-200.0, 0.0, 300.0), 0.0, speed, 0.0)
    worst, flown = fly_track(track, start, speed)
    assert worst < 3.0
    assert flown == pytest.approx(track.length_m, rel=0.005, abs=speed * DT_S)


def test_track_is_joined_from_the_side_without_overshoot() -> None:
    track = Track((Position(0.0, 0.0, 300.0), Position(3000.0, 0.0, 300.0)))
    command, now = Follow(track, 22.0), state()._replace(position=Position(0.0, 150.0, 300.0))
    offsets = []
    for _ in range(300):
        command, _ = track_progress(command, now, DT_S)
        offsets.append(command.offset_m)
        now = advance(steer(now, decide(command, now, LIMITS, DT_S), LIMITS, DT_S), DT_S)
    assert offsets[0] == pytest.approx(150.0)
    assert min(offsets) > -5.0
    assert abs(offsets[-1]) < 0.5


def test_search_for_the_nearest_place_does_not_jump_to_a_crossing_leg() -> None:
    cross = Track(
        tuple(
            Position(n, e, 0.0)
            for n, e in ((0, 0), (1000, 0), (1000, 500), (500, 500), (500, -500))
        )
    )
    near = cross.nearest(Position(500.0, 0.0, 0.0), 480.0, 50.0)
    assert near.s_m == pytest.approx(500.0)


@pytest.mark.parametrize("clockwise", [True, False])
def test_circle_is_held(clockwise: bool) -> None:
    hold = Hold(500.0, 300.0, 320.0, 150.0, clockwise)
    command, now = Circle(hold, 22.0), state()
    radii, before, turns = [], now.heading_rad, 0.0
    for k in range(1200):
        now = advance(steer(now, decide(command, now, LIMITS, DT_S), LIMITS, DT_S), DT_S)
        if k > 600:
            p = now.position
            radii.append(math.hypot(p.north_m - 500.0, p.east_m - 300.0))
            turns += math.remainder(now.heading_rad - before, 2 * math.pi)
        before = now.heading_rad
    assert max(abs(r - 150.0) for r in radii) < 3.0
    assert (turns > 0) == clockwise
    assert now.position.alt_m == pytest.approx(320.0, abs=0.5)


VEHICLE = Vehicle(
    7, "seven", Position(0.0, 0.0, 300.0), 0.0, 22.0, 15.0, 33.0, math.radians(35), 4.0, True
)


NODE = VehicleNode(VEHICLE, Projection(FRAME), DT_S, 60.0)


def after(*messages: ToVehicle, state: State = NODE.first()) -> tuple[State, list[Any]]:
    """The state after some messages, and what the last one led to."""
    out: tuple[Any, ...] = ()
    for message in messages:
        state, out = NODE.handle(state, message)
    return state, [said.body for said in out if isinstance(said, Say)]


def wished(act: int) -> Wished:
    return Wished(0, Wish(7, act, "why", 90))


def velocity(epoch: int, sender: int, now_ms: int = 0) -> Commanded:
    command = velocity_command(7, 1, Velocity(20.0, 5.0, -1.0))
    return Commanded(now_ms, gated(7, epoch, sender, command))


def test_commands_survive_the_way_over_lmcp() -> None:
    projection = Projection(FRAME)
    fly = decode(projection, velocity_command(7, 1, Velocity(20.0, -5.0, -1.0)), 0.0)
    assert isinstance(fly, Fly)
    assert fly.velocity == pytest.approx((20.0, -5.0, -1.0))
    points = (Position(10.0, 20.0, 300.0), Position(900.0, -400.0, 320.0))
    follow = decode(projection, path_command(projection, 7, 1, points, 21.0), 0.0)
    assert isinstance(follow, Follow)
    for got, sent in zip(follow.track.points, points, strict=True):
        assert got == pytest.approx(sent, abs=1e-4)
    hold = Hold(100.0, 200.0, 310.0, 120.0, False)
    circle = decode(projection, loiter_command(projection, 7, 1, hold, 20.0), 0.0)
    assert isinstance(circle, Circle)
    assert not circle.hold.clockwise
    got = circle.hold
    assert (got.north_m, got.east_m, got.alt_m, got.radius_m) == pytest.approx(
        (100.0, 200.0, 310.0, 120.0), abs=1e-4
    )


def test_gate_refuses_what_is_stale_or_without_authority() -> None:
    state, out = after(velocity(0, UXAS))
    assert out == []
    state, (dropped,) = after(velocity(0, ICAROUS, 250), state=state)
    assert (dropped.VehicleID, dropped.Time, dropped.GateEpoch) == (7, 250, 0)
    assert dropped.Sender.name == "ICAROUS"
    state, _ = after(wished(TAKE_OVER), state=state)
    _, (stale,) = after(velocity(0, ICAROUS, 500), state=state)
    assert "epoch" in stale.Reason
    _, (without,) = after(velocity(1, UXAS, 500), state=state)
    assert "authority" in without.Reason
    assert after(velocity(1, ICAROUS, 500), state=state)[1] == []


def test_handback_is_complete_with_the_first_command_of_the_new_epoch() -> None:
    state, _ = after(wished(TAKE_OVER), wished(OFFER))
    assert state.gate.owner == ICAROUS
    state, out = after(velocity(2, ICAROUS), state=state)
    assert out == []
    state, out = after(velocity(2, UXAS), state=state)
    assert [type(body).__name__ for body in out] == ["GateState", "AuthorityChange"]
    assert (state.gate.owner, state.gate.offered, state.takeovers) == (UXAS, False, 1)
    assert len(after(velocity(2, ICAROUS, 250), state=state)[1]) == 1


def test_withdrawn_offer_makes_the_answer_stale() -> None:
    state, _ = after(wished(TAKE_OVER), wished(OFFER), wished(WITHDRAW))
    state, out = after(velocity(2, UXAS), state=state)
    assert len(out) == 1
    assert state.gate.owner == ICAROUS


def test_vehicle_without_a_new_command_loiters_past_the_end() -> None:
    projection = Projection(FRAME)
    points = (Position(0.0, 0.0, 300.0), Position(300.0, 0.0, 300.0))
    path = gated(7, 0, UXAS, path_command(projection, 7, 1, points, 22.0))
    state, _ = after(Commanded(0, path))
    farthest = 0.0
    for _ in range(800):
        state, _ = after(Choose(0), Move(), state=state)
        farthest = max(farthest, math.hypot(*state.air.position[:2]))
    assert isinstance(state.command, Circle)
    assert farthest < 800.0
