"""The pipeline behind a bridge: a CMASI client gets one response to each request, with reasons."""

from __future__ import annotations

import gzip
import re
import socket
import threading
from collections import Counter
from pathlib import Path
from typing import Any

from bridge_tools import ALL, TCP, tcp_server
from pipeline_messages import implementation, option, options
from pipeline_tools import PIPELINE, place, request, vehicle
from uxas_tools import LIMIT_S, Client, free_port, process, started, until, write_cfg

from cratous.bridge import lmcp

SERVICES = "".join(f'<Service Type="{name}"/>\n' for name in PIPELINE)
LEFT_OUT = ("MessageLoggerDataService",)


def joined(
    folder: Path, opened: list[Any], attributes: str = "", services: str = SERVICES
) -> tuple[Any, Any, Client]:
    """The process, what it says, and a client of it; attributes: of the bridge."""
    one, said, port = tcp_server(folder, attributes, more=services)
    opened.append(one)
    opened.append(Client(port))
    return one, said, opened[-1]


def send_one_vehicle_and_its_task(client: Client, shared: Path) -> None:
    """Vehicle 400 and task 1000 of the waterway example."""
    folder = shared / "examples/openuxas/waterway/inputs"
    for name in ("AirVehicleConfiguration_V400", "AirVehicleState_V400"):
        client.send(lmcp.xml.read_file(folder / f"{name}.xml", [])[0])
    (task,) = lmcp.xml.read_file(next((folder / "tasks").glob("1000*")), [])
    client.send(task)


def test_the_waterway_mission_for_a_cmasi_client(shared: Path, tmp_path: Path) -> None:
    """The example's own configuration; the client sends all messages and gets its plan by TCP."""
    folder = shared / "examples/openuxas/waterway"
    port, pub, pull = free_port(), free_port(), free_port()
    text = (folder / "cfg_run.xml").read_text()
    for old, new in (("15562", port), ("15560", pub), ("15561", pull)):
        text = text.replace(old, str(new))
    start, end = text.index('<Service Type="SendMessagesService"'), text.index("</Service>")
    path = tmp_path / "cfg.xml"
    text = text[:start] + text[end + len("</Service>") :]
    path.write_text(text.replace("<Bridge ", '<Bridge Trust="TRUE" '))
    bodies = []
    for name in ("AirVehicleConfiguration_V400", "AirVehicleConfiguration_V500"):
        bodies += lmcp.xml.read_file(folder / f"inputs/{name}.xml", [])
    for name in ("AirVehicleState_V400", "AirVehicleState_V500"):
        bodies += lmcp.xml.read_file(folder / f"inputs/{name}.xml", [])
    for name in sorted((folder / "inputs/tasks").iterdir()):
        bodies += lmcp.xml.read_file(name, [])
    options = [part for name in LEFT_OUT for part in ("--without", name)]
    with started(path, "-runUntil", "300", *options) as running:
        client = Client(port, running)
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
    one, said, client = joined(tmp_path, opened)
    send_one_vehicle_and_its_task(client, shared)
    request = lmcp.new("AutomationRequest", EntityList=[400], TaskList=[1000])
    for body in (
        request,
        request.copy(TaskList=[9]),
        request.copy(EntityList=[7]),
        request.copy(TaskRelationships="*(p1000)"),
        request,
    ):
        client.send(body)
    client.send(lmcp.new("PayloadDropTask", TaskID=5))
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
    assert "task 5 is a afrl.impact.PayloadDropTask: no service here does this kind" in reasons[5]
    assert said.has("task 5 is a afrl.impact.PayloadDropTask")
    assert not said.has("fails at")
    names = one.bus.names()
    assert not any("1000" in name for name in names), "the task's service has ended"
    assert one.bus.state("AutomationRequestValidatorService").asked == {}
    assert one.bus.state("PlanBuilderService").work == {}


def test_a_second_task_of_the_same_id_takes_the_place_of_the_first(
    tmp_path: Path, opened: list[Any]
) -> None:
    one, _, client = joined(tmp_path, opened)
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
    slow = SERVICES.replace(
        '"AutomationRequestValidatorService"',
        '"AutomationRequestValidatorService" MaxResponseTime_ms="1000"',
    )
    one, said, client = joined(tmp_path, opened, 'Trust="TRUE"', slow)
    send_one_vehicle_and_its_task(client, shared)
    until(lambda: "TaskInitialized" in client.kinds(), one)
    times: dict[str, int] = {}
    one.bus.tap(lambda e: times.setdefault(e.topic.rpartition(".")[2], e.time_ms))
    number = next(n for n, name in one.manager.services.items() if name == "PlanBuilderService")
    client.send(lmcp.new("KillService", ServiceID=number))
    request = lmcp.new("AutomationRequest", EntityList=[400], TaskList=[1000])
    client.send(request)
    for _ in range(9):
        client.send(lmcp.new("TaskPlanOptions", CorrespondingAutomationRequestID=77, TaskID=1000))
        client.send(lmcp.new("AssignmentCostMatrix", CorrespondingAutomationRequestID=77))
        client.send(lmcp.new("UniqueAutomationResponse", ResponseID=77))
    until(lambda: "AutomationResponse" in client.kinds(), one)
    assert times["AutomationResponse"] - times["UniqueAutomationRequest"] >= 1000
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
    one, said = process(write_cfg(tmp_path, SERVICES + body))
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


def test_a_client_s_task_service_takes_part_over_a_bridge(
    tmp_path: Path, opened: list[Any]
) -> None:
    """A kind of task that nobody here does, done by a client that says how it is flown."""
    one, _, client = joined(tmp_path, opened)
    for body in (*vehicle(1), lmcp.new("PayloadDropTask", TaskID=9)):
        client.send(body)
    client.send(lmcp.new("TaskInitialized", TaskID=9))
    client.send(request(9))

    def told(kind: str) -> Any:
        until(lambda: kind in client.kinds(), one)
        found = next(m for m in client.got if m.descriptor.endswith(f".{kind}"))
        return lmcp.binary.unpack(found.payload)

    number = told("UniqueAutomationRequest").RequestID
    parts = [option(9, 1, latitude=0.02), option(9, 2, latitude=0.04)]
    client.send(options(number, 9, *parts, composition=".(p1 p2)"))
    summary = told("TaskAssignmentSummary")
    assert [(t.TaskID, t.OptionID) for t in summary.TaskList] == [(9, 1), (9, 2)]
    for k in (1, 2):
        until(lambda k=k: client.kinds().count("TaskImplementationRequest") == k, one)
        asked = [m for m in client.got if m.descriptor.endswith(".TaskImplementationRequest")]
        body = lmcp.binary.unpack(asked[-1].payload)
        start = body.StartingWaypointID
        points = [
            lmcp.new("Waypoint", Number=start, Latitude=0.02 * k, AssociatedTasks=[9], Speed=20.0)
        ]
        assert (body.CorrespondingAutomationRequestID, body.TaskID, body.VehicleID) == (
            number,
            9,
            1,
        )
        end, end_ms = place(0.02 * k + 0.002), body.TimeThreshold + 1000
        client.send(implementation(body, points, FinalLocation=end, FinalTime=end_ms))
    (command,) = told("AutomationResponse").MissionCommandList
    assert [w.Latitude for w in command.WaypointList] == [0.02, 0.04, 0.04], (
        "and an end without a task"
    )
