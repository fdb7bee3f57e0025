"""The message logger as a service: prefixes, skipping, text files, trouble, a small day of traffic."""

from __future__ import annotations

import importlib.util
import json
import resource
from pathlib import Path
from typing import Any

import pytest
from log_tools import STATE, full_disk

from cratous.bridge import lmcp
from cratous.services.bus import Bus, Envelope
from cratous.services.logs.entry import to_object
from cratous.services.logs.message_logger import WAITING_MOST, LogRule, MessageLogger
from cratous.services.logs.sqlite_log import SqliteLog
from cratous.spec.errors import BadInput

KEEP_ALIVE = "uxas.messages.uxnative.AutopilotKeepAlive"


def logged(path: Path) -> list[Any]:
    with SqliteLog(path) as log:
        log.verify()
        return list(log.entries())


def element(text: str) -> Any:
    return lmcp.xml.parse(text)


def feed(logger: MessageLogger, count: int = 6) -> Bus:
    bus = Bus(lmcp.full_names)
    bus.tap(logger.tap)
    for k in range(count):
        bus.now_ms = 500 * k
        bus.publish(lmcp.new("AirVehicleState", ID=400, Time=500 * k), "sim")
        bus.publish(lmcp.new(KEEP_ALIVE), "pilot")
        bus.run()
    return bus


def test_prefixes_choose_and_bytes_are_logged(tmp_path: Path) -> None:
    logger = MessageLogger(tmp_path, [LogRule("afrl"), LogRule("nobody")])
    feed(logger)
    logger.close()
    found = logged(tmp_path / "messageLog_0.sqlite")
    assert [e.topic for e in found] == [STATE] * 6
    assert [e.time_ms for e in found] == [500 * k for k in range(6)]
    assert found[2].body == lmcp.binary.pack(to_object(found[2]))
    assert to_object(found[2]).Time == 1000
    assert logger.prefixes == ("afrl", "nobody")


def test_messages_are_skipped_as_configured(tmp_path: Path) -> None:
    logger = MessageLogger.from_element(
        element(
            '<Service Type="MessageLoggerDataService">\n'
            ' <LogMessage MessageType="uxas" NumberMessagesToSkip="0"/>\n'
            ' <LogMessage MessageType="afrl" NumberMessagesToSkip="2"/></Service>'
        ),
        tmp_path,
        "cfg.xml",
    )
    feed(logger, 7)
    logger.close()
    found = logged(logger.log.path)
    assert [e.time_ms for e in found if e.topic == STATE] == [0, 1500, 3000]
    assert sum(e.topic == KEEP_ALIVE for e in found) == 7


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ('<Service>\n<LogMessage MessageType=""/></Service>', 2, "no message type"),
        ('<Service>\n\n<LogMesage MessageType="a"/></Service>', 3, "unknown element"),
        ('<Service LogFileMessageCountLimit="many"/>', 1, "wrong attribute"),
        ('<Service LogFileName="../up"/>', 1, "no name of a file"),
        ('<Service LogFileName=".hidden"/>', 1, "no name of a file"),
        ('<Service FilesPerSubDirectory="-1"/>', 1, "wrong attribute"),
        (
            '<Service>\n<LogMessage MessageType="a" NumberMessagesToSkip="1.5"/></Service>',
            2,
            "wrong attribute",
        ),
    ],
)
def test_a_wrong_configuration_is_refused(tmp_path: Path, text: str, line: int, what: str) -> None:
    with pytest.raises(BadInput, match=what) as caught:
        MessageLogger.from_element(element(text), tmp_path, "cfg.xml")
    assert caught.value.where == f"cfg.xml:{line}"
    assert not list(tmp_path.iterdir())


@pytest.mark.shows("MessageLoggerDataService", "LogFileMessageCountLimit", "FilesPerSubDirectory")
def test_text_files_by_count_and_folder(tmp_path: Path) -> None:
    logger = MessageLogger.from_element(
        element(
            '<Service Type="MessageLoggerDataService" LogFileMessageCountLimit="4" '
            'FilesPerSubDirectory="2"><LogMessage MessageType="uxas"/>'
            '<LogMessage MessageType="afrl"/></Service>'
        ),
        tmp_path,
        "cfg.xml",
    )
    feed(logger, 6)  # 12 messages: 3 files in 2 folders
    made = sorted(p.relative_to(tmp_path).as_posix() for p in tmp_path.rglob("*.txt"))
    assert made == [
        "messageLog_0_0/messageLog_0_0.txt",
        "messageLog_0_0/messageLog_0_1.txt",
        "messageLog_0_1/messageLog_0_2.txt",
    ]
    text = (tmp_path / made[0]).read_text()  # before the logger is closed: nothing is held back
    assert text.startswith(f"0 {STATE}$lmcp|{STATE}|||$\n<AirVehicleState Series=")
    assert sum((tmp_path / name).read_text().count("$lmcp|") for name in made) == 12
    logger.close()


@pytest.mark.shows("MessageLoggerDataService", "LogFileName")
def test_the_files_are_called_as_the_configuration_says(tmp_path: Path) -> None:
    text = '<Service LogFileName="testfile" LogFileMessageCountLimit="9"><LogMessage MessageType="afrl"/></Service>'
    logger = MessageLogger.from_element(element(text), tmp_path, "cfg.xml")
    feed(logger, 1)
    logger.close()
    made = sorted(p.name for p in tmp_path.rglob("*") if p.is_file())
    assert made == ["testfile_0.sqlite", "testfile_0_0.txt"]


def test_an_older_log_stays(tmp_path: Path) -> None:
    for _ in range(3):
        MessageLogger(tmp_path).close()
    assert len(list(tmp_path.glob("messageLog_*.sqlite"))) == 3


def test_the_envelope_of_the_wire_is_kept(tmp_path: Path) -> None:
    raw = lmcp.binary.pack(lmcp.new("AirVehicleState", ID=9))[:-4] + b"\0\0\0\0"
    outside: dict[str, Any] = {
        "address": "eid100.sid5",
        "group": "g",
        "entity_id": 100,
        "service_id": 7,
    }
    logger = MessageLogger(tmp_path, [LogRule("eid")])
    envelope = Envelope(seq=4, time_ms=8, source="tcp", topic=STATE, body=None, raw=raw, **outside)
    state, said = logger.handle(logger.start(), envelope, 8)
    assert list(said) == []
    logger.stop(state)
    (entry,) = logged(logger.log.path)
    assert entry[5:9] == ("eid100.sid5", "g", "100", "7")
    assert entry.body == raw
    assert entry.seq == 0


def test_a_body_without_lmcp_form_is_logged_as_text_and_said(tmp_path: Path) -> None:
    body = lmcp.new("AirVehicleState")
    body.Airspeed = 1e300  # no 32-bit number
    logger = MessageLogger(tmp_path)
    _, said = logger.handle(logger.start(), Envelope(0, 0, "sim", STATE, body), 0)
    assert "Airspeed" in next(iter(said)).Info[0].Value
    logger.close()
    (entry,) = logged(logger.log.path)
    assert "1e300" in str(entry.body) or "1e+300" in str(entry.body)


def test_choosing_is_pure(tmp_path: Path) -> None:
    logger = MessageLogger(tmp_path, [LogRule("afrl", 1)])
    envelope = Envelope(0, 0, "sim", STATE, lmcp.new("AirVehicleState"))
    first = logger.start()
    assert [logger.choose(first, envelope)[1] for _ in range(3)] == [True] * 3
    second, _ = logger.choose(first, envelope)
    assert not logger.choose(second, envelope)[1]
    assert first.to_skip == {}
    logger.close()


def test_trouble_is_said_once_on_the_bus_and_again_when_it_is_over(tmp_path: Path) -> None:
    with full_disk(200_000):
        logger = MessageLogger(tmp_path, batch=50, hold=200, every_s=None)
        envelope = Envelope(0, 0, "sim", STATE, lmcp.new("AirVehicleState"))
        state, said = logger.start(), []
        for _ in range(2500):
            state, more = logger.handle(state, envelope, 0)
            said += list(more)
        assert [s.StatusType.name for s in said] == ["Error"]
        assert "cannot be written" in said[0].Info[0].Value
        assert said[0].Info[1].Value == "0", "it ends no request"
        old = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (-1, old[1]))
        assert logger.log.flush()
        state, more = logger.handle(state, envelope, 0)
        (back,) = more
        assert f"{logger.log.lost} messages lost" in back.Info[0].Value
        logger.close()


def test_what_has_no_form_for_the_log_ends_no_request(tmp_path: Path) -> None:
    """The cost matrix of many tasks is longer than an LMCP array: it is logged as text."""
    logger = MessageLogger(tmp_path)
    body = lmcp.new("KeyValuePair", Key="x" * 70_000)
    _, (said,) = logger.handle(logger.start(), Envelope(0, 0, "sim", STATE, body), 0)
    assert said.StatusType.name == "Warning"
    assert [(pair.Key, pair.Value) for pair in said.Info[1:]] == [("RequestID", "0")]
    logger.close()


def test_a_small_day_of_traffic(root: Path, tmp_path: Path) -> None:
    """Two minutes of it; the benchmark itself checks that nothing is lost or changed."""
    place = root / "bench" / "day_of_traffic.py"
    spec = importlib.util.spec_from_file_location("day_of_traffic", place)
    assert spec is not None
    assert spec.loader is not None
    day = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(day)
    figures = day.traffic(tmp_path, 1 / 30, 10)
    assert figures.sent == figures.logged == 2400 + 10
    assert figures.memory_end_mb - figures.memory_tenth_mb < 20
    found = logged(tmp_path / "messageLog_0.sqlite")
    assert len(found) == 2410


def test_the_text_is_written_after_the_messages_that_follow(tmp_path: Path) -> None:
    """A response does not wait for the text of the messages before it; the database has them."""
    logger = MessageLogger(tmp_path, text_limit=9)
    had: list[tuple[int, int]] = []

    class Answering:
        name, subscribes = "answering", (STATE, KEEP_ALIVE)

        def start(self) -> None:
            return None

        def handle(self, state: None, envelope: Envelope, now_ms: int) -> tuple[None, list[Any]]:
            texts = sum(p.read_text().count("$lmcp|") for p in tmp_path.glob("*.txt"))
            had.append((logger.log.count, texts))
            return None, [lmcp.new(KEEP_ALIVE)] if envelope.topic == STATE else []

    bus = Bus(lmcp.full_names)
    bus.add(logger)
    bus.add(Answering())
    bus.publish(lmcp.new("AirVehicleState"), "sim")
    bus.run_until(0)
    assert had == [(1, 0), (2, 0)]
    (text,) = tmp_path.glob("*.txt")
    assert text.read_text().count("$lmcp|") == 2
    for _ in range(WAITING_MOST):
        bus.publish(lmcp.new(KEEP_ALIVE), "sim")
    bus.run()
    written = sum(p.read_text().count("$lmcp|") for p in tmp_path.glob("*.txt"))
    assert written == WAITING_MOST + 2
    logger.stop(logger.start())


def test_text_without_a_form_in_a_file_costs_no_other_message(tmp_path: Path) -> None:
    """The texts of a burst are written together, and half of a surrogate pair has no UTF-8."""
    logger, faults = MessageLogger(tmp_path, text_limit=9), list[Any]()
    bus = Bus(lmcp.full_names, on_fault=lambda *fault: faults.append(fault))
    bus.add(logger)
    for key in ("first", "half \udc80", "last"):
        bus.publish(lmcp.new("KeyValuePair", Key=key), "sim")
    bus.run_until(0)
    bus.remove(logger.name)
    assert faults == []
    (text,) = tmp_path.glob("*.txt")
    heads = [line for line in text.read_text().splitlines() if "lmcp|afrl.cmasi.KeyValue" in line]
    assert len(heads) == 3
    assert "half \\udc80" in text.read_text()
    bodies = [entry.body for entry in logged(logger.log.path) if "KeyValuePair" in entry.topic]
    assert len(bodies) == 3
    assert json.loads(bodies[1])["Key"] == "half \udc80"
