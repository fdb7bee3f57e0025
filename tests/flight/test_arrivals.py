"""What comes over the bridge: sorted, in order, and nothing of it lost."""

from __future__ import annotations

from typing import Any

import pytest
from flight_tools import flown, meeting

from cratous.bridge.link import LinkEvent
from cratous.bridge.loopback import Bridge, Delivered
from cratous.bridge.text_protocol import Direction, Heartbeat, StartMission, WireError
from cratous.services.flight.arrivals import arrivals
from cratous.services.flight.messages import Heard, Lost, Unreadable
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Line

UP, DOWN = Direction.UP, Direction.DOWN


def test_each_thing_goes_where_it_belongs_in_order() -> None:
    wrong, ended = (
        WireError(1, 1, "no such message", "", "HELLO"),
        LinkEvent("closed", "by the peer"),
    )
    beat, start = Heartbeat(3, 0.5), StartMission()
    came = [
        Delivered(1, UP, beat),
        Delivered(2, DOWN, start),
        Delivered(1, DOWN, wrong),
        Delivered(1, DOWN, ended),
        Delivered(1, UP, ended),
    ]
    found = arrivals(came, 500)
    assert found.down == ((2, start),)
    assert found.up[0] == Heard(1, 500, beat)
    assert isinstance(found.up[1], Unreadable)
    assert "no such message" in found.up[1].text
    assert DOWN.value in found.up[1].text
    assert found.up[2:] == (Lost(1, 500, ended),)


def test_each_line_for_icarous_is_read_once_and_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    delivered, read, held = list[Any](), list[Any](), list[Delivered]()
    exchange, handle = Bridge.exchange, Instance.handle
    calls = iter(range(10**9))

    def late(self: Bridge) -> list[Delivered]:
        """What goes down comes with the second exchange of a heartbeat instead of the first."""
        came = [*held, *exchange(self)]
        held.clear()
        if next(calls) % 2 == 0:
            held.extend(one for one in came if one.direction is DOWN)
            came = [one for one in came if one.direction is UP]
        delivered.extend(one.record for one in came if one.direction is DOWN)
        return came

    def handled(self: Instance, state: Any, message: Any) -> Any:
        if isinstance(message, Line):
            read.append(message.line)
        return handle(self, state, message)

    monkeypatch.setattr(Bridge, "exchange", late)
    monkeypatch.setattr(Instance, "handle", handled)
    result, _ = flown(meeting())
    assert result.outcome == "complete"
    assert len(read) > 1000
    assert read == delivered
