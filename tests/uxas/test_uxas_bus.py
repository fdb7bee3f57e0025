"""Several processes on one bus: one order for all, keys at the hub, and a hub that is missing."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Any

import pytest
import zmq
from bridge_tools import seen
from uxas_tools import LIMIT_S, free_port, process, started, until, write_cfg

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.zmq_curve import make_keys

HUB = 'HubPUB="tcp://127.0.0.1:{}" HubPULL="tcp://127.0.0.1:{}"'
SATELLITE = 'HubSUB="tcp://127.0.0.1:{}" HubPUSH="tcp://127.0.0.1:{}" FirstServiceID="150"'
HELLO = '<Service Type="HelloWorld" StringToSend="{}" SendPeriod_ms="50"/>'


def test_two_processes_share_one_bus_and_a_third_observes(tmp_path: Path) -> None:
    ports = free_port(), free_port()
    for name in ("hub", "far"):
        (tmp_path / name).mkdir()
    hub = write_cfg(tmp_path / "hub", HELLO.format("near"), HUB.format(*ports))
    far = write_cfg(tmp_path / "far", HELLO.format("far"), SATELLITE.format(*ports))
    context: zmq.Context[Any] = zmq.Context()
    observer = context.socket(zmq.SUB)
    observer.subscribe("afrl.cmasi.KeyValuePair")
    observer.connect(f"tcp://127.0.0.1:{ports[0]}")
    ids: list[str] = []
    end = time.monotonic() + LIMIT_S
    with started(hub, "-runUntil", "600") as one, started(far, "-runUntil", "600") as two:
        while len(set(ids)) < 2 or len(ids) < 40:
            assert time.monotonic() < end, ids
            if observer.poll(100):
                message = wire.parse(observer.recv())
                body = lmcp.binary.unpack(message.payload)
                assert (body.Key, message.entity_id) == (message.service_id, "100")
                ids.append(message.service_id)
        for running in (one, two):
            running.terminate()
        heard = [running.communicate(timeout=LIMIT_S)[0] for running in (one, two)]
        assert (one.returncode, two.returncode) == (0, 0)
    context.destroy(linger=0)
    assert set(ids) == {"51", "151"}
    assert "Received Id[51] Sent Id[151] Message[far]" in heard[0]
    assert "Received Id[151] Sent Id[51] Message[near]" in heard[1]
    assert "Sent Id[51]" not in heard[0], "nobody hears himself"


def test_all_processes_see_one_order_and_keys_guard_the_hub(
    tmp_path: Path, opened: list[Any]
) -> None:
    ports = free_port(), free_port()
    for name in ("hub", "far", "known"):
        (tmp_path / name).mkdir()
    for name in ("server", "friend"):
        make_keys(tmp_path / "keys", name)
    (tmp_path / "known" / "friend.key").write_text((tmp_path / "keys/friend.key").read_text())
    keys = ' CurveSecretKeyFile="../keys/{}.key_secret"'
    hub, _ = process(
        write_cfg(
            tmp_path / "hub",
            "",
            HUB.format(*ports) + keys.format("server") + ' CurveClientKeys="../known"',
        )
    )
    opened.append(hub)
    path = write_cfg(
        tmp_path / "far",
        "",
        SATELLITE.format(*ports)
        + keys.format("friend")
        + ' CurveServerKeyFile="../keys/server.key"',
    )
    made: list[Any] = []
    joining = threading.Thread(target=lambda: made.append(process(path)[0]))
    joining.start()  # a satellite waits for its hub, which this thread turns
    until(lambda: not joining.is_alive(), hub)
    far = made[0]
    opened.append(far)
    at_hub, at_far = seen(hub), seen(far)
    for k in range(50):
        (hub, far)[k % 2].bus.publish(lmcp.new("TaskInitialized", TaskID=k), "ServiceManager")
        if k % 7 == 0:
            far.turn(0.0)
    until(lambda: len(at_far) >= 50, hub, far)
    orders = [[m.body.TaskID for m in found] for found in (at_hub, at_far)]
    assert orders[0] == orders[1]
    assert sorted(orders[0]) == list(range(50))


def test_a_satellite_without_a_hub_is_told_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from cratous.services.uxas import hub
    from cratous.spec.errors import BadInput

    monkeypatch.setattr(hub, "_JOIN_S", 0.3)
    path = write_cfg(tmp_path, "", SATELLITE.format(free_port(), free_port()))
    with pytest.raises(BadInput, match="no hub answers"):
        process(path)
    path = write_cfg(tmp_path, "", SATELLITE.format(1, 2).replace('FirstServiceID="150"', ""))
    with pytest.raises(BadInput, match="ids of its own"):
        process(path)
