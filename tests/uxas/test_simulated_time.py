"""Test_SimulationTime: states from outside are handled at the times that they tell, however they come."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from uxas_tools import Client, free_port, process, until, write_cfg

from cratous.bridge import lmcp


@pytest.mark.parametrize("at_once", [True, False])
def test_states_of_one_read_are_handled_each_at_its_time(
    tmp_path: Path, opened: list[Any], at_once: bool
) -> None:
    port = free_port()
    body = (
        f'<Bridge Type="LmcpObjectNetworkTcpBridge" Server="TRUE" TcpAddress="tcp://127.0.0.1:{port}"/>'
        '<Service Type="Test_SimulationTime"/>'
    )
    one, said = process(write_cfg(tmp_path, body))
    opened.append(one)
    handled: list[tuple[int, int, int]] = []
    one.bus.tap(
        lambda e: (
            e.topic.endswith("AirVehicleState")
            and handled.append((e.body.ID, e.body.Time, e.time_ms))
        )
    )
    client = Client(port)
    opened.append(client)
    (bridge,) = one.manager.bridges.values()
    until(lambda: bridge.port.peers == 1, one)
    times = (540, 1020, 1560, 2040)
    for time_ms in times:
        for vehicle in (1, 2):
            client.send(lmcp.new("AirVehicleState", ID=vehicle, Time=time_ms))
        if not at_once:
            until(lambda: one.bus.now_ms == time_ms, one)  # noqa: B023
    until(lambda: len(handled) == 8, one)
    assert handled == [(v, t, t) for t in times for v in (1, 2)]
    client.send(lmcp.new("AirVehicleState", ID=1, Time=1_700_000_000_000))
    until(lambda: said.has("time leaps to 1700000000000 ms"), one)
    assert one.bus.now_ms == 2040
