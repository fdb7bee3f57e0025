"""UxAS as a process: configurations and their refusals, services that come and go, virtual time."""

from __future__ import annotations

import signal
import socket
import sqlite3
import time
from pathlib import Path
from typing import Any

import pytest
from uxas_tools import LIMIT_S, free_port, process, started, write_cfg

from cratous.bridge import lmcp
from cratous.services.cli import main
from cratous.services.loading.problems import BadMission
from cratous.services.loading.uxas_settings import read
from cratous.services.uxas import manager
from cratous.spec.errors import BadInput

# --- configurations ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "root", "line", "text"),
    [
        ('<Service Type="HeloWorld"/>', "", 2, "unknown service type; expected HelloWorld"),
        ('<Service Type="HelloWorld" SendPeriod_s="1"/>', "", 2, "expected SendPeriod_ms"),
        ('<Service Type="HelloWorld" SendPeriod_ms="soon"/>', "", 2, "a whole number from 1"),
        ("<Service/>", "", 2, "no Type"),
        ('<Servise Type="HelloWorld"/>', "", 2, "unknown element"),
        ('<Service Type="HelloWorld"><Message/></Service>', "", 2, "unknown element"),
        ("", 'EntityId="7"', 1, "unknown attribute; expected EntityID"),
        ("", 'ConsoleLoggerSeverityLevel="LOUD"', 1, "DEBUG or INFO or WARN or ERROR"),
        ("", 'RunDuration_s="-1"', 1, "a number"),
        ("", 'HubPUB="tcp://127.0.0.1:1"', 1, "half of a pair"),
        ('\n<Bridge Type="TcpBridge"/>', "", 3, "unknown bridge type"),
        ('<Bridge Type="LmcpObjectNetworkTcpBridge" TcpAddress="5555"/>', "", 2, "not an address"),
        ('<Bridge Type="LmcpObjectNetworkTcpBridge" Server="maybe"/>', "", 2, "TRUE or FALSE"),
        (
            '<Bridge Type="LmcpObjectNetworkTcpBridge">\n<SubscribeToMessage/></Bridge>',
            "",
            3,
            "attribute missing",
        ),
        ('<Bridge Type="LmcpObjectNetworkSerialBridge"/>', "", 2, "attribute missing"),
        (
            '<Bridge Type="LmcpObjectNetworkZeroMqZyreBridge" NetworkDevice="no0"/>',
            "",
            2,
            "no such network device",
        ),
        (
            '<Bridge Type="LmcpObjectNetworkZeroMqZyreBridge" GossipEndpoint="tcp://h:1"/>',
            "",
            2,
            "gossip is not covered",
        ),
        ('<Service Type="Test_SimulationTime"/>\n' * 2, "", 3, "a second one in one process"),
        (
            '<Service Type="SendMessagesService"><Message MessageFileName="no.xml"/></Service>',
            "",
            2,
            "a message file is missing",
        ),
    ],
)
def test_a_bad_configuration_is_refused_with_file_and_line(
    tmp_path: Path, body: str, root: str, line: int, text: str
) -> None:
    path = write_cfg(tmp_path, body, root)
    if root.startswith("EntityId"):
        path.write_text(path.read_text().replace(' EntityID="100"', ""))
    with pytest.raises(BadInput) as caught:
        process(path)
    assert f"{path}:{line}" in str(caught.value)
    assert text in str(caught.value)


def test_all_problems_are_told_together(tmp_path: Path) -> None:
    path = write_cfg(
        tmp_path,
        '<Service Type="HeloWorld"/>\n<Bridge Type="B"/>\n<Service Type="TaskManagerServce"/>',
    )
    with pytest.raises(BadMission) as caught:
        process(path)
    assert [p.where.rpartition(":")[2] for p in caught.value.problems] == ["2", "3", "4"]


def test_types_are_left_out_if_asked(tmp_path: Path) -> None:
    path = write_cfg(tmp_path, '<Service Type="ExampleSparkService"/>')
    one, said = process(path, without=frozenset({"ExampleSparkService"}))
    assert said.has("ExampleSparkService is left out, as asked")
    assert not said.has("no service")
    one.close()


def test_a_service_that_nobody_has_is_a_warning_and_refused_by_strict(tmp_path: Path) -> None:
    kind = "ExampleSparkService"
    path = write_cfg(tmp_path, f'<Service Type="{kind}"/>')
    one, said = process(path)
    assert said.has(f"WARN {path}:2: no service {kind} here; what it does is not done")
    assert kind not in one.bus.names()
    one.close()
    with pytest.raises(BadInput, match=kind):
        manager.check(read(path, strict=True))


def test_a_bridge_whose_port_is_taken_leaves_nothing_open(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        busy, free = taken.getsockname()[1], free_port()
        tcp = '<Bridge Type="LmcpObjectNetworkTcpBridge" Server="TRUE" TcpAddress="tcp://127.0.0.1:{}"/>'
        path = write_cfg(tmp_path, tcp.format(free) + "\n" + tcp.format(busy))
        with pytest.raises(BadInput, match="cannot listen") as caught:
            process(path)
        assert caught.value.where == f"{path}:3"
        socket.create_server(("127.0.0.1", free)).close()


def test_the_command_refuses_checks_and_prints(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["uxas"]) == 2
    assert "cfg.xml" in capsys.readouterr().err
    write_cfg(tmp_path, '<Service Type="HelloWorld"/>')
    assert main(["uxas", "--check"]) == 0
    assert "1 services and bridges" in capsys.readouterr().out
    assert not (tmp_path / "log").exists()
    ctrl_c = signal.getsignal(signal.SIGINT)
    assert main(["uxas", "-version", "--virtual-time", "-runUntil", "3"]) == 0
    assert signal.getsignal(signal.SIGINT) is ctrl_c, "who called it in a process ends as before"
    assert "CMASI: 3" in capsys.readouterr().out
    assert (tmp_path / "datawork").is_dir()
    logs = list((tmp_path / "log").iterdir())
    assert len(logs) == 1
    assert "service 51 is HelloWorld" in logs[0].read_text()


# --- services -----------------------------------------------------------------------------------

HELLO = '<Service Type="HelloWorld" StringToSend="{}" SendPeriod_ms="{}"/>\n'


def trace(path: Path, until_s: float) -> list[tuple[Any, ...]]:
    one, _ = process(path, virtual=True)
    seen: list[tuple[Any, ...]] = []
    one.bus.tap(lambda e: seen.append((e.seq, e.time_ms, e.source, e.topic, repr(e.body))))
    one.run(until_s)
    one.close()
    return seen


@pytest.mark.shows("HelloWorld", "SendPeriod_ms", "KeyValuePair")
def test_virtual_time_gives_the_same_messages_at_exact_times(tmp_path: Path) -> None:
    path = write_cfg(tmp_path, HELLO.format("a", 300) + HELLO.format("b", 700))
    first, second = trace(path, 3600.0), trace(path, 3600.0)
    assert first == second
    assert len(first) > 15_000
    times = [
        t for _, t, source, topic, _ in first if source == "HelloWorld" and "KeyValue" in topic
    ]
    assert times == list(range(0, 3_600_001, 300))


@pytest.mark.shows("HelloWorld", "StringToSend", "KeyValuePair")
def test_greetings_are_heard_by_others_only(tmp_path: Path) -> None:
    path = write_cfg(tmp_path, HELLO.format("hi", 1000) + HELLO.format("ho", 1000))
    one, said = process(path, virtual=True)
    one.run(0.5)
    assert [s for s in said if "RECEIVED" in s] == [
        "*** RECEIVED:: Received Id[52] Sent Id[51] Message[hi] *** ",
        "*** RECEIVED:: Received Id[51] Sent Id[52] Message[ho] *** ",
    ]
    one.close()


def test_services_of_a_group_name_it_and_are_reached_by_it(tmp_path: Path) -> None:
    hello = '<Service Type="HelloWorld" MessageGroup="fusion"/>'
    one, said = process(write_cfg(tmp_path, hello), virtual=True)
    seen: list[Any] = []
    one.bus.tap(lambda e: "KeyValue" in e.topic and seen.append(e))
    one.bus.publish(lmcp.new("KeyValuePair", Key="k"), "test", "fusion")
    one.run(0.0)
    assert [e.group for e in seen] == ["fusion", ""] or [e.group for e in seen] == ["", "fusion"]
    assert said.has("Received Id[51] Sent Id[k]")
    one.close()


@pytest.mark.shows("SendMessagesService", "StartupComplete")
def test_messages_are_sent_once_periodically_and_to_addresses(tmp_path: Path) -> None:
    (tmp_path / "inputs").mkdir()
    (tmp_path / "inputs" / "pair.xml").write_text(
        '<KeyValuePair Series="CMASI"><Key>k</Key></KeyValuePair>'
    )
    path = write_cfg(
        tmp_path,
        """<Service Type="SendMessagesService" PathToMessageFiles="../elsewhere/">
        <Message MessageFileName="pair.xml" SendTime_ms="250"/>
        <Message MessageFileName="pair.xml" SendPeriod_ms="400" NumberTimesToSend="3"/>
        <Message MessageFileName="pair.xml" SendTime_ms="300" MessageKey="eid100.sid77"/>
        </Service>""",
    )
    one, said = process(path, virtual=True)
    seen: list[tuple[int, str]] = []
    one.bus.tap(lambda e: seen.append((e.time_ms, e.to)))
    one.run(10.0)
    pair = "afrl.cmasi.KeyValuePair"
    assert [s for s in seen if "Startup" not in s[1]] == [
        (0, pair),
        (250, pair),
        (300, "eid100.sid77"),
        (400, pair),
        (800, pair),
    ]
    assert said.has("inputs/pair.xml")
    one.close()


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("<int64>1<int64>", "XML"),
        ("<int64>1000/<int64>", "XML"),
        ("<int64>one</int64>", "int64"),
        ("<string>1</string>", "int64"),
    ],
)
def test_a_message_file_that_is_malformed_is_refused_with_its_line(
    tmp_path: Path, body: str, words: str
) -> None:
    """The list of eligible entities of a task; the original takes it for an empty one."""
    file = tmp_path / "task.xml"
    file.write_text(
        f'<MustFlyTask Series="CMASI">\n<EligibleEntities>\n{body}</EligibleEntities></MustFlyTask>'
    )
    send = f"""<Service Type="SendMessagesService" PathToMessageFiles="{tmp_path}">
        <Message MessageFileName="task.xml"/></Service>"""
    with pytest.raises(BadInput) as caught:
        process(write_cfg(tmp_path, send))
    assert f"{file}" in str(caught.value)
    assert words in str(caught.value)


@pytest.mark.shows("SendMessagesService", "PathToMessageFiles")
def test_message_files_lie_where_the_attribute_says(tmp_path: Path) -> None:
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "pair.xml").write_text(
            f'<KeyValuePair Series="CMASI"><Key>{name}</Key></KeyValuePair>'
        )
    send = f"""<Service Type="SendMessagesService" PathToMessageFiles="{tmp_path / "there"}">
        <Message MessageFileName="pair.xml" SendTime_ms="0"/></Service>"""
    one, _ = process(write_cfg(tmp_path, send), virtual=True)
    seen: list[str] = []
    one.bus.tap(lambda e: "KeyValue" in e.topic and seen.append(e.body.Key))
    one.run(0.0)
    assert seen == ["there"]
    one.close()


@pytest.mark.shows(
    "StatusReportService", "AutopilotKeepAlive", "KeepAliveExpiration_ms", "EntityExit"
)
def test_authority_expires_with_the_autopilots_sign_of_life(tmp_path: Path) -> None:
    report = (
        '<Service Type="StatusReportService" ReportPeriod_ms="1000" KeepAliveExpiration_ms="1500"/>'
    )
    one, _ = process(write_cfg(tmp_path, report), virtual=True)
    seen: list[Any] = []
    one.bus.tap(lambda e: "Onboard" in e.topic and seen.append(e.body))
    one.bus.publish(lmcp.new("EntityJoin", EntityID=9), "x")
    one.bus.publish(lmcp.new("EntityExit", EntityID=9), "x")
    one.bus.publish(
        lmcp.new("AutopilotKeepAlive", AutopilotEnabled=True, SpeedAuthorized=True), "x"
    )
    one.run(2.0)
    assert [r.ValidAuthorization for r in seen] == [True, False]
    assert [r.SpeedAuthorization for r in seen] == [True, False]
    assert seen[0].ConnectedEntities == []
    assert seen[0].VehicleID == 100
    one.close()


@pytest.mark.shows(
    "StatusReportService",
    "EntityState",
    "EntityJoin",
    "OnboardStatusReport",
    "VehicleID",
    "ReportPeriod_ms",
    "StaleStateTime_ms",
)
def test_reports_go_stale_with_the_states(tmp_path: Path) -> None:
    report = '<Service Type="StatusReportService" VehicleID="7" ReportPeriod_ms="1000" StaleStateTime_ms="2500"/>'
    one, _ = process(write_cfg(tmp_path, report), virtual=True)
    seen: list[Any] = []
    one.bus.tap(lambda e: "Onboard" in e.topic and seen.append(e.body))
    one.bus.publish(lmcp.new("EntityJoin", EntityID=9), "x")
    one.bus.publish(lmcp.new("AirVehicleState", ID=7, Time=5, AssociatedTasks=[3]), "x")
    one.bus.publish(lmcp.new("AirVehicleState", ID=8), "x")
    one.run(4.0)
    assert [r.ValidState for r in seen] == [True, True, False, False]
    assert (seen[0].VehicleTime, seen[0].ConnectedEntities, seen[0].CurrentTaskList) == (
        5,
        [9],
        [3],
    )
    one.close()


@pytest.mark.shows("Test_SimulationTime", "EntityState")
def test_simulated_time_stands_until_a_state_tells(tmp_path: Path) -> None:
    body = '<Service Type="Test_SimulationTime"/>\n' + HELLO.format("x", 1000)
    one, said = process(write_cfg(tmp_path, body))
    seen: list[int] = []
    one.bus.tap(lambda e: "KeyValue" in e.topic and seen.append(e.time_ms))
    for _ in range(5):
        one.turn(0.01)
    assert seen == [0]
    one.bus.publish(lmcp.new("AirVehicleState", Time=2500), "sim")
    one.turn(0.01)  # what comes with the next turn is of this time already
    assert (seen, one.bus.now_ms) == ([0, 1000, 2000], 2500)
    # a date, a number of no sense, or a simulation that begins anew is no time that passes
    for time_ms, count in ((1_700_000_000_000, 3), (2**62, 3), (0, 3), (700, 4), (690, 4)):
        one.bus.publish(lmcp.new("AirVehicleState", Time=time_ms), "sim")
        one.turn(0.01)
        assert len(seen) == count, time_ms
    assert said.has("time leaps to 1700000000000 ms")
    one.close()


def test_services_are_made_and_ended_at_run_time_and_leave_nothing(tmp_path: Path) -> None:
    port = free_port()
    tcp = f'<Bridge Type="LmcpObjectNetworkTcpBridge" Server="TRUE" TcpAddress="tcp://127.0.0.1:{port}"/>'
    one, said = process(write_cfg(tmp_path, HELLO.format("x", 100) + tcp))
    before = one.bus.names()

    def tell(kind: str, **fields: Any) -> None:
        one.bus.publish(lmcp.new(kind, **fields), "test")
        one.turn(0.001)

    hello = '&lt;Service Type="HelloWorld" StringToSend="new"&gt;'  # as UxAS sends it
    tell("CreateNewService", ServiceID=200, XmlConfiguration=hello)
    assert one.manager.services[200] == "HelloWorld[200]"
    tell("CreateNewService", ServiceID=200, XmlConfiguration=hello)
    assert said.has("the id is taken")
    tell("CreateNewService", XmlConfiguration='<Service Type="Nonsense"/>')
    assert said.has("unknown service type")
    tell("CreateNewService", XmlConfiguration="<Service")
    assert said.has("refused")
    tell("KillService", ServiceID=200)
    assert one.bus.names() == before
    assert one.bus.next_wake_ms() is not None
    tell("KillService", ServiceID=52)
    socket.create_server(("127.0.0.1", port)).close()  # its port is free again
    tell("KillService", ServiceID=51)
    assert one.bus.next_wake_ms() is None, "its timer is gone"
    assert one.bus.names() == ("ServiceManager",)
    tell("KillService", ServiceID=-1)
    assert one.manager.ended
    one.close()


def test_run_duration_and_kill_end_the_process(tmp_path: Path) -> None:
    path = write_cfg(tmp_path, HELLO.format("x", 100), 'RunDuration_s="1"')
    begun = time.monotonic()
    with started(path) as running:
        said, _ = running.communicate(timeout=LIMIT_S)
        assert running.returncode == 0, said
    assert time.monotonic() - begun >= 1.0


def test_the_message_logger_is_mounted_where_it_is_there(tmp_path: Path) -> None:
    pytest.importorskip("cratous.services.logs.message_logger")
    logger = (
        '<Service Type="MessageLoggerDataService" LogFileMessageCountLimit="100">'
        '<LogMessage MessageType="afrl" NumberMessagesToSkip="0"/></Service>\n'
    )
    path = write_cfg(tmp_path, logger + HELLO.format("x", 100))
    with pytest.raises(BadInput, match="no folder to write to"):
        process(path)
    one, said = process(path, virtual=True, data=tmp_path / "datawork")
    one.run(1.0)
    one.close()
    (log,) = (tmp_path / "datawork" / "SavedMessages").glob("*.sqlite")
    with sqlite3.connect(log) as database:
        (count,) = database.execute("SELECT count(*) FROM messages").fetchone()
    assert count == 11
    assert not said.has("fails")
