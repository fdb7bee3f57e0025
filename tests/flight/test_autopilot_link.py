"""ICAROUS with an autopilot of its own: what is taken of it, what goes to it, and when that counts."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import pytest
from bridge_flight import FRAME
from icarous_rig import state
from icarous_tools import PROJECTION, VOLUME
from uxas_tools import free_port

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.bridge.port import Address, address
from cratous.bridge.tcp_port import TcpPort
from cratous.bridge.text_port import TextPort
from cratous.services.flight.dynamics import Limits
from cratous.services.icarous.state import Config
from cratous.services.icarous_program.autopilot import COMMANDS_FROM, Autopilot, Reported
from cratous.services.icarous_program.program import Besides, Program
from cratous.services.icarous_program.step import Craft, IcarousEnd
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Daa

PLANE = Projection(FRAME)
CRAFT = Craft(Config(1, Daa(VOLUME), PROJECTION, 500), Limits(15.0, 33.0, 0.52, 5.0), 60.0)


def own(now_s: float) -> tp.OwnPosition:
    return tp.OwnPosition(now_s, 45.0, -121.0, 300.0, 300.0, 22.0, 0.0, 0.0, vehicle_id=1)


def plan() -> list[tp.Message]:
    lats = (45.0, 45.02, 45.04)
    points = [tp.Waypoint(3, 22.0, lat, -121.0, 300.0, k) for k, lat in enumerate(lats)]
    return [tp.SoftReset(), *points, tp.StartMission()]


class Vehicle:
    """The other end, and the link to it."""

    def __init__(self, opened: list[Any]) -> None:
        self.port = TcpPort(address("tcp://127.0.0.1:0", ("tcp",), free=True), server=True)
        where = Address("tcp", "127.0.0.1", self.port.bound[1], "tcp://autopilot")
        self.said = list[str]()
        self.link = Autopilot(1, where, PLANE, lambda _s, text: self.said.append(text))
        opened += [self.port, self.link]
        self.until(lambda: self.port.peers and self.link.there)

    def until(self, done: Callable[[], object]) -> list[Reported]:
        found, limit_s = list[Reported](), time.monotonic() + 60
        while not done():
            assert time.monotonic() < limit_s
            self.got = [inc.parts[0] for inc in self.port.step(time.monotonic())]
            found += self.link.step(time.monotonic())
        return found

    def tell(self, *bodies: Any) -> None:
        for body in bodies:
            self.port.send((wire.enclose(body.all_names[0], lmcp.binary.pack(body)).pack(),))

    def told(self, count: int) -> list[Reported]:
        found, limit_s = list[Reported](), time.monotonic() + 60
        while len(found) < count:
            assert time.monotonic() < limit_s
            self.port.step(time.monotonic())
            found += self.link.step(time.monotonic())
        return found


def at_waypoint(body: Any, number: int) -> Any:
    return body.copy(CurrentWaypoint=number)


def test_its_own_states_are_taken_and_waypoints_that_it_passes_counted(opened: list[Any]) -> None:
    vehicle = Vehicle(opened)
    body = state(1, 40.0, 2500)
    vehicle.tell(
        at_waypoint(body, 3), state(2, 0.0, 2500), at_waypoint(state(1, 60.0, 0), 5),  # none of its
        at_waypoint(state(1, 60.0, 3000), 3), at_waypoint(state(1, 71.0, 3500), 4),
    )  # fmt: skip
    vehicle.port.send((b"rubbish",))
    one, two, three = vehicle.told(3)
    assert [r.passed for r in (one, two, three)] == [0, 0, 1]
    line = one.line
    assert (line.time_s, line.vehicle_id, line.alt_abs_m) == (2.5, 1, 300.0)
    assert PLANE.to_local(line.lat_deg, line.long_deg) == pytest.approx((40.0, 0.0), abs=1e-3)
    assert (line.north_mps, line.east_mps) == pytest.approx((22.0, 0.0), abs=1e-9)
    vehicle.until(lambda: any("cannot be read" in text for text in vehicle.said))


def test_steering_goes_to_it_and_nothing_else_does(opened: list[Any]) -> None:
    vehicle = Vehicle(opened)
    assert not vehicle.link.steer(tp.SetVelocity(0.0, 20.0, 0.0)), "where it is is not known yet"
    vehicle.tell(state(1, 0.0, 1000))
    vehicle.told(1)
    assert not vehicle.link.steer(tp.SetMode("ACTIVE", 1))
    assert vehicle.link.steer(tp.SetVelocity(0.0, 20.0, 0.0))
    vehicle.until(lambda: vehicle.got)
    message = wire.parse(vehicle.got[0])
    body = lmcp.binary.received(message.payload, message.descriptor)[0]
    assert (type(body).__name__, body.VehicleID) == ("VehicleActionCommand", 1)
    assert body.CommandID == COMMANDS_FROM + 1
    (action,) = body.VehicleActionList
    assert (type(action).__name__, action.Heading, action.Speed) == ("FlightDirectorAction", 90, 20)


def test_it_counts_once_postn_has_not_come_for_a_while_after_a_plan_has(opened: list[Any]) -> None:
    vehicle = Vehicle(opened)
    where = Address("tcp", "127.0.0.1", free_port(), "tcp://uxas")
    port = TextPort(where, server=False)
    said = list[str]()
    program = Program(
        IcarousEnd(CRAFT), port, lambda _s, text: said.append(text), besides=Besides(None, vehicle.link)
    )  # fmt: skip
    opened.append(port)

    def reported(now_s: float, passed: int = 0) -> None:
        program._flown(Reported(own(now_s), passed))

    reported(1.0)
    assert program.state.now_ms is None, "without a plan nothing is flown by it"
    for line in (*plan(), own(1.0)):
        program._line(line)
    reported(2.5)
    assert program.state.now_ms == 1000
    reported(3.0)
    assert program.state.now_ms == 3000
    assert program.state.instance.told.heard_ms == 1000
    reported(3.5, passed=1)
    assert program.state.instance.told.next_index == 1
    assert any("no POSTN of UxAS" in text for text in said)
    vehicle.tell(state(1, 0.0, 1000))
    vehicle.told(1)
    program._say(tp.SetVelocity(0.0, 20.0, 0.0))
    vehicle.until(lambda: vehicle.got)
    program._line(own(4.0))
    assert any("POSTN comes again" in text for text in said)
    reported(5.0)
    assert program.state.now_ms == 4000


@pytest.mark.parametrize(
    ("field", "value"),
    [("u", math.nan), ("v", math.inf), ("Time", 2**62), ("Latitude", math.nan)],
)
def test_a_state_that_is_none_is_refused_and_the_next_one_counts(
    field: str, value: float, opened: list[Any]
) -> None:
    vehicle, right = Vehicle(opened), state(1, now_ms=2000)
    wrong = state(1, now_ms=1000)
    if field == "Latitude":
        wrong = wrong.copy(Location=wrong.Location.copy(Latitude=value))
    else:
        wrong = wrong.copy(**{field: value})
    vehicle.tell(wrong, right)
    assert [one.line.time_s for one in vehicle.told(1)] == [2.0]
    assert "state that is none of a vehicle" in str(vehicle.said)


def test_a_step_that_fails_ends_nothing(opened: list[Any], monkeypatch) -> None:
    port = TextPort(Address("tcp", "127.0.0.1", free_port(), "tcp://uxas"), server=False)
    opened.append(port)
    program = Program(IcarousEnd(CRAFT), port, lambda _s, _text: None)
    for line in (*plan(), own(1.0)):
        program._line(line)

    def fails(*_: Any) -> Any:
        raise ValueError("of this line")

    monkeypatch.setattr(IcarousEnd, "alone", fails)
    program._flown(Reported(own(4.0), 0))
    assert program.state.now_ms == 1000
    assert dict(program._tally.counts.refused) == {"line that the step fails at": 1}
