"""Bridges of a UxAS process: captured frames, clients that come again, export rules, bad input,
several processes on one bus, and a mission planned for a CMASI client."""

from __future__ import annotations

import gzip
import json
import re
import socket
import threading
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import zmq
from uxas_tools import LIMIT_S, Client, free_port, process, started, until, write_cfg

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp, sentinel
from cratous.bridge.zmq_curve import make_keys

ALL = "".join(f'<SubscribeToMessage MessageType="{c}"/>' for c in "aeul")
TCP = '<Bridge Type="LmcpObjectNetworkTcpBridge" Server="TRUE" TcpAddress="tcp://127.0.0.1:{}" {}>{}</Bridge>\n'
PAIR = '<Bridge Type="{}" Address{}="{}" Address{}="{}" {}>{}</Bridge>\n'
STATE = "afrl.cmasi.AirVehicleState"


def tcp_server(folder: Path, attributes: str = "", inside: str = ALL, more: str = "") -> Any:
    port = free_port()
    one, said = process(write_cfg(folder, more + TCP.format(port, attributes, inside)))
    return one, said, port


@pytest.fixture
def opened() -> Iterator[list[Any]]:
    """Everything in here is closed at the end."""
    made: list[Any] = []
    yield made
    for one in reversed(made):
        one.close()


def seen(one: Any, source: str = "") -> list[Any]:
    """What the bus delivers from now on, from one source or from all."""
    found: list[Any] = []
    one.bus.tap(lambda e: found.append(e) if not source or e.source == source else None)
    return found


def test_captured_frames_arrive_and_leave_byte_for_byte(
    shared: Path, tmp_path: Path, opened: list[Any]
) -> None:
    frames = sorted((shared / "vectors/openuxas/frames").glob("*.tcp.bin"))
    payloads = [sentinel.unframe(f.read_bytes()) for f in frames if "stream" not in f.name]
    assert len(payloads) == 36
    one, _, port = tcp_server(tmp_path)
    opened.append(one)
    messages = seen(one, "LmcpObjectNetworkTcpBridge")
    sender, listener = Client(port), Client(port)
    opened += [sender, listener]
    until(lambda: one.manager.bridges[51].port.peers == 2, one)
    sender.raw((shared / "vectors/openuxas/frames/waterway-stream.tcp.bin").read_bytes())
    until(lambda: len(messages) >= 29, one)
    stream = len(messages)
    for payload in payloads:
        sender.raw(sentinel.frame(payload))
    until(lambda: len(messages) == stream + 36, one)
    for payload, message in zip(payloads, messages[stream:], strict=True):
        came = wire.parse(payload)
        assert message.raw == came.payload
        assert message.to == came.address
        # as the original does it: what comes in by TCP bears the bridge's name
        assert (message.group, message.entity_id, message.service_id) == ("TcpBridge", 100, 51)
        assert lmcp.binary.pack(message.body) == came.payload
    # never its own imports: with ConsiderSelfGenerated they bear its own ids
    assert not [m for m in listener.read() if m.group]


def test_source_attributes_stay_where_messages_are_not_considered_ours(
    tmp_path: Path, opened: list[Any]
) -> None:
    alias = '<TransformReceivedMessage MessageType="afrl.cmasi.KeyValuePair" Alias="uxas.alias"/>'
    one, _, port = tcp_server(tmp_path, 'ConsiderSelfGenerated="FALSE"', ALL + alias)
    opened.append(one)
    messages = seen(one)
    client = Client(port)
    opened.append(client)
    client.send(lmcp.new("AirVehicleState", ID=4), 400, 7)
    client.send(lmcp.new("KeyValuePair"), 400, 7)
    until(lambda: len(messages) == 2, one)
    assert (messages[0].entity_id, messages[0].service_id) == (400, 7)
    assert messages[1].to == "uxas.alias"


def test_subscriptions_are_prefixes_and_kill_service_is_never_exported(
    tmp_path: Path, opened: list[Any]
) -> None:
    inside = (
        '<SubscribeToMessage MessageType="afrl.cmasi.Air"/><SubscribeToMessage MessageType="uxas"/>'
    )
    one, _, port = tcp_server(tmp_path, inside=inside)
    opened.append(one)
    client = Client(port)
    opened.append(client)
    until(lambda: one.manager.bridges[51].port.peers == 1, one)
    for kind in ("AirVehicleState", "EntityState", "KillService", "TaskInitialized"):
        one.bus.publish(lmcp.new(kind), "test")
    until(lambda: len(client.read()) == 2, one)
    assert client.kinds() == ["AirVehicleState", "TaskInitialized"]


BAD = [
    ("1.6 GB", b"+=+=+=+=1600000000#@#@#@#@LMCP", "1600000000"),
    ("unknown series", None, "unknown message series"),
    ("other version", None, "other version of a series"),
    ("unknown type", None, "unknown message type"),
    ("wrong checksum", None, "wrong checksum"),
    ("truncated", None, "wrong length"),
    ("no envelope", sentinel.frame(b"no dollars at all"), "no end of the address"),
    ("json", sentinel.frame(b"a.b$json|a.b||1|2${}"), "unknown content type"),
    ("bad id", sentinel.frame(b"a.b$lmcp|a.b||x|2$LMCP"), "wrong length|too short|not an id"),
    ("garbage", bytes(range(256)) * 100, "outside of a frame"),
]


def spoiled(name: str) -> bytes:
    data = bytearray(lmcp.binary.pack(lmcp.new("AirVehicleState", ID=1)))
    if name == "unknown series":
        data[9:17] = b"NOSERIES"
    elif name == "unknown type":
        data[17:21] = b"\x00\x00\xff\xff"
    elif name == "other version":
        data[21:23] = b"\x00\x63"
    if name == "wrong checksum":
        data[-1] ^= 1
    else:
        data[-4:] = bytes(4)  # not computed
    if name == "truncated":
        data = data[:-20]
    return sentinel.frame(wire.enclose(STATE, bytes(data)).pack())


@pytest.mark.parametrize(("name", "data", "reason"), BAD, ids=[b[0] for b in BAD])
def test_bad_input_is_refused_with_a_reason_and_others_are_unaffected(
    tmp_path: Path, opened: list[Any], name: str, data: bytes | None, reason: str
) -> None:
    one, said, port = tcp_server(tmp_path)
    opened.append(one)
    messages = seen(one)
    bad, good = Client(port), Client(port)
    opened += [bad, good]
    bad.raw(spoiled(name) if data is None else data)
    good.send(lmcp.new("AirVehicleState", ID=77))
    until(lambda: messages, one)
    bad.send(lmcp.new("AirVehicleState", ID=78))
    until(lambda: len(messages) == 2, one)
    assert [m.body.ID for m in messages] == [77, 78]
    assert any(line.startswith("WARN") and re.search(reason, line) for line in said), said
    assert sum(one.manager.bridges[51].port.counts.refused.values()) == 1


def test_the_robustness_cases_of_the_original(
    shared: Path, tmp_path: Path, opened: list[Any]
) -> None:
    """Every case that ends the original or makes it deaf: the next good frame arrives here."""
    cases = json.loads((shared / "vectors/openuxas/frames/tcp_robustness.json").read_text())
    payload = sentinel.unframe(
        (shared / "vectors/openuxas/frames/TaskInitialized.tcp.bin").read_bytes()
    )
    whole = sentinel.frame(payload)
    inputs = {
        "garbage prefix": b"garbage" + whole,
        "wrong size": whole.replace(b"+118#", b"+117#"),
        "non-digit size": whole.replace(b"118#", b"abc#"),
        "negative size": whole.replace(b"118#", b"-18#"),
        "empty size": whole.replace(b"118#", b"#"),
        "size too large for int": whole.replace(b"118#", b"99999999999#"),
        "wrong checksum": whole.replace(b"9221?", b"9222?"),
        "empty checksum": whole.replace(b"9221?", b"?"),
        "missing head": whole[8:],
        "1 MB garbage": bytes(1 << 20),
        "truncated": whole[:60],
    }
    assert len(cases) >= 32
    one, said, port = tcp_server(tmp_path)
    opened.append(one)
    messages = seen(one)
    for data in inputs.values():
        client = Client(port)
        expected = len(messages) + 1
        client.raw(data)
        client.raw(whole + whole)
        until(lambda n=expected: len(messages) >= n, one)
        client.close()
    assert not said.has("fails at")


def test_a_client_that_comes_again_is_served_again(tmp_path: Path, opened: list[Any]) -> None:
    one, said, port = tcp_server(tmp_path)
    opened.append(one)
    messages = seen(one, "LmcpObjectNetworkTcpBridge")
    for count in range(1, 4):
        client = Client(port)
        client.send(lmcp.new("AirVehicleState", ID=count))
        until(lambda n=count: len(messages) == n, one)
        one.bus.publish(lmcp.new("TaskInitialized", TaskID=count), "test")
        until(lambda c=client: c.read(), one)
        client.close()
        until(lambda: one.manager.bridges[51].port.peers == 0, one)
    assert said.has("is gone")


def test_a_client_bridge_talks_to_a_server_bridge_that_starts_later_and_again(
    tmp_path: Path, opened: list[Any]
) -> None:
    port = free_port()
    (tmp_path / "c").mkdir()
    body = TCP.replace("TRUE", "FALSE").format(port, "", ALL)
    path = write_cfg(tmp_path / "c", body)
    path.write_text(path.read_text().replace('EntityID="100"', 'EntityID="200"'))
    client, _ = process(path)
    opened.append(client)
    until(lambda: True, client)
    for count in range(2):
        server, _ = process(write_cfg(tmp_path, TCP.format(port, "", ALL)))
        messages = seen(server)
        until(lambda c=client: c.manager.bridges[51].port.peers == 1, client, server)
        client.bus.publish(lmcp.new("TaskInitialized", TaskID=count), "test")
        until(lambda m=messages: m, client, server)
        assert messages[0].body.TaskID == count
        server.close()
        until(lambda c=client: c.manager.bridges[51].port.peers == 0, client)


@pytest.mark.parametrize("scheme", ["tcp", "ipc", "udp"])
def test_publish_pull_and_subscribe_push(tmp_path: Path, opened: list[Any], scheme: str) -> None:
    names = [f"{scheme}://127.0.0.1:{free_port()}" for _ in range(2)]
    if scheme == "ipc":
        names = [f"ipc://{tmp_path}/{n}" for n in ("pub", "pull")]
    (tmp_path / "far").mkdir()
    near, _ = process(
        write_cfg(
            tmp_path,
            PAIR.format(
                "LmcpObjectNetworkPublishPullBridge", "PUB", names[0], "PULL", names[1], "", ALL
            ),
        )
    )
    external = ALL + '<SubscribeToExternalMessage MessageType="uxas"/>'
    path = write_cfg(
        tmp_path / "far",
        PAIR.format(
            "LmcpObjectNetworkSubscribePushBridge", "SUB", names[0], "PUSH", names[1], "", external
        ),
    )
    path.write_text(path.read_text().replace('EntityID="100"', 'EntityID="200"'))
    far, _ = process(path)
    opened += [near, far]
    at_near, at_far = seen(near), seen(far)
    far.bus.publish(lmcp.new("AirVehicleState", ID=5), "ServiceManager")
    until(lambda: at_near, near, far)
    assert (at_near[0].entity_id, at_near[0].body.ID) == (200, 5)

    def heard() -> bool:
        near.bus.publish(lmcp.new("TaskInitialized", TaskID=1), "ServiceManager")
        return any(m.topic.endswith("TaskInitialized") for m in at_far)

    until(heard, near, far)
    # a foreign entity's message is delivered inside, never exported again
    assert not any(m.topic == STATE and m.source.startswith("Lmcp") for m in at_far)


def test_impact_bridges_speak_two_parts(tmp_path: Path, opened: list[Any]) -> None:
    context: zmq.Context[Any] = zmq.Context()
    pub, pull = context.socket(zmq.PUB), context.socket(zmq.PULL)
    ports = [sock.bind_to_random_port("tcp://127.0.0.1") for sock in (pub, pull)]
    inside = ALL + '<SubscribeToExternalMessage MessageType="lmcp:CMASI"/>'
    one, said = process(
        write_cfg(
            tmp_path,
            PAIR.format(
                "ImpactSubscribePushBridge",
                "SUB",
                f"tcp://127.0.0.1:{ports[0]}",
                "PUSH",
                f"tcp://127.0.0.1:{ports[1]}",
                'ExternalID="300" ThrottleConfigurationForwarding="TRUE"',
                inside,
            ),
        )
    )
    opened.append(one)
    messages = seen(one)
    config = lmcp.new("AirVehicleConfiguration", ID=1)
    for body in (config, config.copy(), config.copy(Label="new"), lmcp.new("AirVehicleState")):
        one.bus.publish(body, "ServiceManager")
    one.bus.run()
    got = []
    until(lambda: pull.poll(0) and (got.append(pull.recv_multipart()) or len(got) == 3), one)
    assert [g[0] for g in got] == [b"lmcp:CMASI:AirVehicleConfiguration"] * 2 + [
        b"lmcp:CMASI:AirVehicleState"
    ]
    inside_count = len(messages)

    def heard() -> bool:
        pub.send_multipart([b"lmcp:CMASI:AirVehicleState", b"broken"])
        pub.send_multipart([b"lmcp:CMASI:AirVehicleState", got[2][1]])
        return len(messages) > inside_count

    until(heard, one)
    assert (messages[-1].entity_id, messages[-1].group) == (300, "fusion")
    assert said.has("refused")
    context.destroy(linger=0)


def test_zyre_bridges_find_each_other_and_tell_who_joins_and_leaves(
    tmp_path: Path, opened: list[Any]
) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        beacon = probe.getsockname()[1]
    bridge = (
        '<Bridge Type="LmcpObjectNetworkZeroMqZyreBridge" NetworkDevice="lo" BeaconPort="{}">'
        '<SubscribeToExternalMessage MessageType="{}"/></Bridge>'
    )
    made = []
    for entity, wanted in ((100, "afrl.cmasi"), (200, "uxas"), (300, "eid3")):
        folder = tmp_path / str(entity)
        folder.mkdir()
        path = write_cfg(folder, bridge.format(beacon, wanted))
        path.write_text(path.read_text().replace('EntityID="100"', f'EntityID="{entity}"'))
        one, _ = process(path)
        made.append((one, seen(one)))
    opened += [one for one, _ in made]
    (first, at_first), (second, at_second), (third, at_third) = made
    all_three = [one for one, _ in made]
    until(lambda: all(len(o.manager.bridges[51].entities) == 2 for o in all_three), *all_three)
    assert sorted(m.body.EntityID for m in at_first if m.topic.endswith("Join")) == [200, 300]
    second.bus.publish(lmcp.new("AirVehicleState", ID=5), "ServiceManager")
    first.bus.publish(lmcp.new("TaskInitialized", TaskID=6), "ServiceManager")
    first.bus.publish(lmcp.new("TaskInitialized", TaskID=7), "ServiceManager", "eid300.sid50")

    def came(messages: list[Any], kind: str, entity: int) -> list[Any]:
        return [m.body for m in messages if m.topic.endswith(kind) and m.entity_id == entity]

    until(lambda: came(at_first, "AirVehicleState", 200), *all_three)
    until(lambda: came(at_second, "TaskInitialized", 100), *all_three)
    until(lambda: came(at_third, "TaskInitialized", 100), *all_three)
    assert [b.TaskID for b in came(at_second, "TaskInitialized", 100)] == [6]
    assert [b.TaskID for b in came(at_third, "TaskInitialized", 100)] == [7]
    assert not came(at_third, "AirVehicleState", 200)
    second.close()
    until(lambda: any(m.topic.endswith("EntityExit") for m in at_first), first, third)


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
    with started(hub, "-runUntil", "20") as one, started(far, "-runUntil", "20") as two:
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


PIPELINE = "".join(
    f'<Service Type="{name}"/>\n'
    for name in (
        "TaskManagerService",
        "AutomationRequestValidatorService",
        "RoutePlannerVisibilityService",
        "RouteAggregatorService",
        "AssignmentTreeBranchBoundService",
        "PlanBuilderService",
    )
)
LEFT_OUT = ("AutomationDiagramDataService", "MessageLoggerDataService")


def test_the_waterway_mission_for_a_cmasi_client(shared: Path, tmp_path: Path) -> None:
    """The example's own configuration; the client sends all messages and gets its plan by TCP."""
    folder = shared / "examples/openuxas/waterway"
    port, pub, pull = free_port(), free_port(), free_port()
    text = (folder / "cfg_run.xml").read_text()
    for old, new in (("15562", port), ("15560", pub), ("15561", pull)):
        text = text.replace(old, str(new))
    start, end = text.index('<Service Type="SendMessagesService"'), text.index("</Service>")
    path = tmp_path / "cfg.xml"
    path.write_text(text[:start] + text[end + len("</Service>") :])
    bodies = []
    for name in ("AirVehicleConfiguration_V400", "AirVehicleConfiguration_V500"):
        bodies += lmcp.xml.read_file(folder / f"inputs/{name}.xml", [])
    for name in ("AirVehicleState_V400", "AirVehicleState_V500"):
        bodies += lmcp.xml.read_file(folder / f"inputs/{name}.xml", [])
    for name in sorted((folder / "inputs/tasks").iterdir()):
        bodies += lmcp.xml.read_file(name, [])
    options = [part for name in LEFT_OUT for part in ("--without", name)]
    with started(path, "-runUntil", "300", *options) as running:
        client = Client(port)
        for body in bodies[:-1]:
            client.send(body)
        client.wait("TaskInitialized")
        client.send(bodies[-1])
        response = client.wait("AutomationResponse")
        summary = client.wait("TaskAssignmentSummary")
        segment = client.wait("MissionCommand")
        client.send(lmcp.new("KillService", ServiceID=-1))
        assert running.wait(LIMIT_S) == 0
    client.close()
    (command,) = response.MissionCommandList
    assert command.VehicleID == 400, "as the original assigns it"
    assert len(command.WaypointList) > 50
    assert len(segment.WaypointList) == 15, "as its waypoint manager is told"
    assert summary.TaskList[0].TimeTaskCompleted < 729_820, "the original's makespan"
    assert {path.name for path in (tmp_path / "log").iterdir()}


def test_each_request_gets_one_response_in_order_with_reasons(
    shared: Path, tmp_path: Path, opened: list[Any]
) -> None:
    one, said, port = tcp_server(tmp_path, more=PIPELINE)
    opened.append(one)
    client = Client(port)
    opened.append(client)
    folder = shared / "examples/openuxas/waterway/inputs"
    for name in ("AirVehicleConfiguration_V400", "AirVehicleState_V400"):
        client.send(lmcp.xml.read_file(folder / f"{name}.xml", [])[0])
    (task,) = lmcp.xml.read_file(next((folder / "tasks").glob("1000*")), [])
    client.send(task)
    request = lmcp.new("AutomationRequest", EntityList=[400], TaskList=[1000])
    for body in (
        request,
        request.copy(TaskList=[9]),
        request.copy(EntityList=[7]),
        request.copy(TaskRelationships="*(p1000)"),
        request,
    ):
        client.send(body)
    client.send(lmcp.new("CommRelayTask", TaskID=5))
    client.send(request.copy(TaskList=[5]))
    until(lambda: client.kinds().count("AutomationResponse") == 6, one)
    client.send(lmcp.new("RemoveTasks", TaskList=[1000]))
    client.send(request)
    until(lambda: client.kinds().count("AutomationResponse") == 7, one)
    answers = [
        lmcp.binary.unpack(m.payload)
        for m in client.got
        if m.descriptor == "afrl.cmasi.AutomationResponse"
    ]
    assert [len(a.MissionCommandList) for a in answers] == [1, 0, 0, 0, 1, 0, 0]
    reasons = [" ".join(p.Value for p in a.Info) for a in answers]
    for k, text in (
        (1, "task 9 does not exist"),
        (2, "vehicle 7"),
        (3, "TaskRelationships|expected"),
        (6, "task 1000"),
    ):
        assert re.search(text, reasons[k]), reasons[k]
    assert reasons[5], "a kind of task that is not covered is named"
    assert said.has("unknown service type") or said.has("not covered yet")
    assert not said.has("fails at")
    names = one.bus.names()
    assert not any("1000" in name for name in names), "the task's service has ended"
    assert one.bus.state("AutomationRequestValidatorService").asked == {}
    assert one.bus.state("PlanBuilderService").work == {}


def test_a_second_task_of_the_same_id_takes_the_place_of_the_first(
    tmp_path: Path, opened: list[Any]
) -> None:
    one, _, port = tcp_server(tmp_path, more=PIPELINE)
    opened.append(one)
    client = Client(port)
    opened.append(client)
    for x in (1.0, 2.0):
        point = lmcp.new("Location3D", Latitude=x)
        client.send(lmcp.new("PointSearchTask", TaskID=3, SearchLocation=point))
    until(lambda: client.kinds().count("TaskInitialized") == 2, one)
    assert client.kinds().count("KillService") == 0
    assert [n for n in one.bus.names() if "[3]" in n] == ["CmasiPointSearchTaskService[3]"]
    world = one.host.shared["contexts"].world
    assert world.task(3).body.SearchLocation.Latitude == 2.0


def test_a_request_without_a_response_is_answered_in_time_and_strays_do_not_end_it(
    shared: Path, tmp_path: Path, opened: list[Any]
) -> None:
    slow = PIPELINE.replace(
        '"AutomationRequestValidatorService"',
        '"AutomationRequestValidatorService" MaxResponseTime_ms="1000"',
    )
    one, said, port = tcp_server(tmp_path, more=slow)
    opened.append(one)
    client = Client(port)
    opened.append(client)
    folder = shared / "examples/openuxas/waterway/inputs"
    for name in ("AirVehicleConfiguration_V400", "AirVehicleState_V400"):
        client.send(lmcp.xml.read_file(folder / f"{name}.xml", [])[0])
    (task,) = lmcp.xml.read_file(next((folder / "tasks").glob("1000*")), [])
    client.send(task)
    until(lambda: "TaskInitialized" in client.kinds(), one)
    number = next(n for n, name in one.manager.services.items() if name == "PlanBuilderService")
    client.send(lmcp.new("KillService", ServiceID=number))
    request = lmcp.new("AutomationRequest", EntityList=[400], TaskList=[1000])
    client.send(request)
    until(lambda: one.bus.state("AutomationRequestValidatorService").work == 1, one)
    begun_ms = one.bus.now_ms
    for _ in range(9):
        client.send(lmcp.new("TaskPlanOptions", CorrespondingAutomationRequestID=77, TaskID=1000))
        client.send(lmcp.new("AssignmentCostMatrix", CorrespondingAutomationRequestID=77))
        client.send(lmcp.new("UniqueAutomationResponse", ResponseID=77))
    until(lambda: "AutomationResponse" in client.kinds(), one)
    assert one.bus.now_ms - begun_ms >= 500
    assert one.bus.state("AutomationRequestValidatorService").work == 0
    reasons = [p.Value for p in client.wait("AutomationResponse").Info]
    assert reasons == ["no response within MaxResponseTime_ms = 1000"]
    assert not said.has("fails at")


def test_a_recorded_simulator_session_tells_the_world(
    shared: Path, tmp_path: Path, opened: list[Any]
) -> None:
    """The bytes that OpenAMASE sent to a client, sent to ours."""
    data = gzip.decompress(
        (shared / "vectors/amase/session-waterway-rate10.tcp.bin.gz").read_bytes()
    )
    server = socket.create_server(("127.0.0.1", 0))
    opened.append(server)
    body = TCP.replace("TRUE", "FALSE").format(server.getsockname()[1], "", ALL)
    one, said = process(write_cfg(tmp_path, PIPELINE + body))
    opened.append(one)
    kinds: Counter[str] = Counter()
    one.bus.tap(lambda e: kinds.update([e.topic.rpartition(".")[2]]))
    until(lambda: one.manager.bridges[57].port.peers == 1, one)
    peer, _ = server.accept()
    opened.append(peer)
    sending = threading.Thread(target=peer.sendall, args=(data,))
    sending.start()
    until(lambda: kinds["AirVehicleState"] >= 3331 and kinds["SessionStatus"] >= 1672, one)
    sending.join()
    assert kinds["AirVehicleState"] == 3331
    states = {body.ID: body for body in one.host.shared["contexts"].world.of("state")}
    assert sorted(states) == [400, 500]
    assert states[400].Time > 600_000, "the newest state of each is kept"
    assert not one.manager.bridges[57].port.counts.refused
    assert not said.has("fails at")
