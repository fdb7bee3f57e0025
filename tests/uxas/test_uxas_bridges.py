"""Bridges of a UxAS process: captured frames, clients that come again, export rules, bad input."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
import zmq
from bridge_tools import ALL, PAIR, TCP, seen, tcp_server
from uxas_tools import Client, free_port, process, until, write_cfg

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp, sentinel
from cratous.bridge.zmq_curve import make_keys

STATE = "afrl.cmasi.AirVehicleState"
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


def test_captured_frames_arrive_and_leave_byte_for_byte(
    shared: Path, tmp_path: Path, opened: list[Any]
) -> None:
    frames = sorted((shared / "vectors/openuxas/frames").glob("*.tcp.bin"))
    payloads = [sentinel.unframe(f.read_bytes()) for f in frames if "stream" not in f.name]
    assert len(payloads) == 36
    one, _, port = tcp_server(tmp_path, 'Trust="TRUE"')  # CreateNewService is among them
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
    beacon = free_port()
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


@pytest.mark.parametrize("trust", [False, True])
def test_only_trusted_peers_make_and_end_services(
    tmp_path: Path, opened: list[Any], trust: bool
) -> None:
    secret = tmp_path / "secret.xml"
    secret.write_text("<KeyValuePair><Key>of the machine</Key></KeyValuePair>")
    one, said, port = tcp_server(tmp_path, 'Trust="TRUE"' if trust else "")
    opened.append(one)
    before, client, bridge = one.bus.names(), Client(port), one.manager.bridges[51]
    opened.append(client)
    reads = f'<Service Type="SendMessagesService"><Message MessageFileName="{secret}"/></Service>'
    client.send(lmcp.new("CreateNewService", ServiceID=70, XmlConfiguration=reads))
    client.send(lmcp.new("KillService", ServiceID=-1))
    client.send(lmcp.new("KeyValuePair", Key="last"))
    heard = seen(one)
    until(lambda: any(getattr(e.body, "Key", "") == "last" for e in heard), one)
    assert one.manager.ended == trust
    assert (one.bus.names() == before) != trust
    refused = bridge.port.counts.refused
    assert sum(n for why, n in refused.items() if "not trusted" in why) == (0 if trust else 2)
    assert said.has("KillService over a bridge that is not trusted") != trust


def test_a_server_with_keys_but_no_list_says_that_anybody_is_let_in(
    tmp_path: Path, opened: list[Any]
) -> None:
    make_keys(tmp_path, "server")
    ports = [f"tcp://127.0.0.1:{free_port()}" for _ in range(2)]
    for listed in (False, True):
        (tmp_path / "known").mkdir(exist_ok=True)
        keys = 'CurveSecretKeyFile="server.key_secret"' + ' CurveClientKeys="known"' * listed
        body = PAIR.format(
            "LmcpObjectNetworkPublishPullBridge", "PUB", ports[0], "PULL", ports[1], keys, ALL
        )
        one, said = process(write_cfg(tmp_path, body))
        one.close()
        assert said.has("no CurveClientKeys: whoever has any key is let in") != listed
