"""`cratous log`: list, filter, follow, export, import, replay, on real files and sockets."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from cratous.bridge import envelope, lmcp
from cratous.bridge.sentinel import FrameStream
from cratous.services.cli import main
from cratous.services.logs import replay
from cratous.services.logs.entry import Entry
from cratous.services.logs.files import framed
from cratous.services.logs.source import open_log
from cratous.services.logs.store import Gap, LogStore
from cratous.spec.errors import BadInput

STATE = "afrl.cmasi.AirVehicleState"
COUNT = 8


def fill(store: LogStore) -> None:
    for k in range(COUNT):
        body = lmcp.binary.pack(lmcp.new("AirVehicleState", ID=400 + k % 2, Time=100 * k))
        store.write(Entry(0, 100 * k, "sim", STATE, body, None, None, "100", "7"))


@pytest.fixture
def log(tmp_path: Path) -> Path:
    with LogStore(tmp_path / "log.sqlite", every_s=None) as store:
        fill(store)
    return tmp_path / "log.sqlite"


def test_list(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["log", "list", str(log.parent), "--verify"]) == 0
    out = capsys.readouterr().out
    assert "8 messages of 1 types (sqlite)" in out
    assert "(verified)" in out
    assert main(["log", "list", str(log), "--json", "--entity", "401"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["count"] == 4
    assert data["types"] == [{"topic": STATE, "messages": 4, "first_ms": 100, "last_ms": 700}]
    assert data["closed"]
    assert data["missing"] == []


def test_what_is_lost_is_listed_with_exit_code_3(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = LogStore(tmp_path / "log.sqlite", every_s=None)
    store.keep(Entry(0, 0, "s", "t", "{}"))
    store.keep(Entry(9, 9, "s", "t", "{}"))
    store.keep_gap(Gap(5, 4, 1000, 2000, "disk full"))
    store.close()
    assert main(["log", "list", str(tmp_path)]) == 3
    out = capsys.readouterr().out
    assert "MISSING: 4 messages from 1.000 to 2.000 s were lost: disk full" in out
    assert "MISSING: 4 numbers are missing and nothing says why" in out


def test_filter(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["log", "filter", str(log), "--type", "EntityState", "--from", "+0.2",
                 "--to", "0.5", "--json"]) == 0  # fmt: skip
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [line["time_ms"] for line in lines] == [200, 300, 400, 500]
    assert lines[0]["body"]["$type"] == "CMASI/AirVehicleState"
    assert main(["log", "filter", str(log), "--limit", "2"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 2


@pytest.mark.parametrize(
    "arguments",
    [
        ["filter", "--type", "AirVehicelState"],
        ["filter", "--from", "soon"],
        ["filter", "--from", "inf"],
        ["export", "-o", "x.doc"],
        ["replay", "--rate", "-1"],
        ["replay", "--connect", "nowhere"],
        ["replay", "--connect", "tcp://127.0.0.1:1"],
        ["replay", "--connect", "tcp://127.0.0.1:1", "--form", "json"],
        ["replay", "--connect", "tcp://127.0.0.1:1", "--listen", "tcp://127.0.0.1:0"],
    ],
)
def test_wrong_arguments(log: Path, arguments: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(log.parent)
    assert main(["log", arguments[0], str(log), *arguments[1:]]) == 2


@pytest.mark.parametrize("command", ["list", "filter", "replay"])
def test_no_such_log(command: str, tmp_path: Path) -> None:
    assert main(["log", command, str(tmp_path / "x")]) == 2


def test_export_and_import(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    there, back = log.with_name("x.mcap"), log.with_name("back.sqlite")
    assert main(["log", "export", str(log), "-o", str(there)]) == 0
    assert main(["log", "import", str(there), "-o", str(back)]) == 0
    assert "8 messages written" in capsys.readouterr().out
    assert main(["log", "import", str(there), "-o", str(back)]) == 2  # no log is replaced
    with open_log(log) as one, open_log(back) as other:
        assert list(one.entries()) == list(other.entries())
    short = log.with_name("short.mcap")
    short.write_bytes(there.read_bytes()[:-60])
    assert main(["log", "import", str(short), "-o", str(log.with_name("y.sqlite"))]) == 2
    assert main(["log", "import", str(short), "-o", str(log.with_name("y.sqlite")),
                 "--salvage"]) == 3  # fmt: skip
    assert log.with_name("y.sqlite").exists()


def test_what_a_format_cannot_hold_is_said_with_exit_code_3(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with LogStore(tmp_path / "log.sqlite", every_s=None) as store:
        store.write(Entry(0, 0, "s", "unknown.X.1", b"LMCP...."))
    assert main(["log", "export", str(tmp_path), "-o", str(tmp_path / "x.xml")]) == 3
    assert "1 messages left out" in capsys.readouterr().err
    assert main(["log", "export", str(tmp_path), "-o", str(tmp_path / "x.mcap")]) == 3
    assert "1 messages kept as bytes" in capsys.readouterr().err
    assert main(["log", "filter", str(tmp_path)]) == 3


def test_follow_in_another_process(tmp_path: Path) -> None:
    path = tmp_path / "log.sqlite"
    follower = subprocess.Popen(
        [sys.executable, "-m", "cratous", "log", "follow", str(path), "--json", "--for", "120"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        store = LogStore(path, batch=2, every_s=0.01)
        fill(store)
        assert follower.stdout is not None
        first = json.loads(follower.stdout.readline())  # while the log is still open
        assert first["body"]["ID"] == 400
        store.close()
        # what `readline` took from the pipe is in the buffer of this stream alone
        rest = follower.stdout.read()
        assert follower.stderr is not None
        told = follower.stderr.read()
        follower.wait(120)
    finally:
        follower.kill()
        follower.communicate()
    assert len(rest.splitlines()) == COUNT - 1
    assert "the log is closed" in told
    assert follower.returncode == 0


def receive(peer: socket.socket, count: int) -> list[envelope.AddressedMessage]:
    stream, found = FrameStream(), []
    peer.settimeout(60)
    while len(found) < count:
        data = peer.recv(4096)
        if not data:
            break
        found += [envelope.parse(payload) for payload in stream.feed(data)]
    return found


def test_replay_to_a_server(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found: list[envelope.AddressedMessage] = []
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            peer, _ = server.accept()
            with peer:
                peer.sendall(b"x" * 300_000)  # a simulator that talks too
                found.extend(receive(peer, COUNT))

        thread = threading.Thread(target=serve)
        thread.start()
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        assert main(["log", "replay", str(log), "--connect", address, "--rate", "4"]) == 0
        thread.join(60)
    assert "8 messages sent" in capsys.readouterr().err
    assert [m.address for m in found] == [STATE] * COUNT
    assert (found[0].entity_id, found[0].service_id) == ("100", "7")
    assert [lmcp.binary.unpack(m.payload).Time for m in found] == [100 * k for k in range(COUNT)]


def test_replay_to_a_client(log: Path) -> None:
    replayer = subprocess.Popen(
        [sys.executable, "-m", "cratous", "log", "replay", str(log), "--rate", "0",
         "--listen", "tcp://127.0.0.1:0"],
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert replayer.stderr is not None
        address = replayer.stderr.readline().split()[-1]
        with socket.create_connection(replay.parse_address(address), timeout=900) as client:
            assert len(receive(client, COUNT)) == COUNT
        assert replayer.wait(120) == 0
    finally:
        replayer.kill()
        assert replayer.stderr is not None
        replayer.stderr.close()


def test_replay_to_standard_output(log: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "cratous", "log", "replay", str(log), "--rate", "0",
         "--form", "frames"],
        capture_output=True, timeout=900,
    )  # fmt: skip
    assert done.returncode == 0
    assert len(FrameStream().feed(done.stdout)) == COUNT


class Line:
    """A line with a clock of its own; sending takes 30 ms."""

    def __init__(self) -> None:
        self.now = 0.0
        self.sent: list[float] = []

    def send(self, data: bytes) -> None:
        self.sent.append(self.now)
        self.now += 0.03

    def wait(self, seconds: float) -> None:
        self.now += seconds


@pytest.mark.parametrize(
    ("rate", "times"),
    [
        (1.0, [0.1 * k for k in range(COUNT)]),
        (2.0, [0.05 * k for k in range(COUNT)]),  # what sending takes does not add up
        (10.0, [0.03 * k for k in range(COUNT)]),  # as fast as the line is
        (0.0, [0.03 * k for k in range(COUNT)]),
    ],
)
def test_rates(log: Path, rate: float, times: list[float]) -> None:
    line = Line()
    with open_log(log) as source:
        sent = replay.replay(
            source.entries(), line, framed, rate, lambda *_: None, lambda: line.now
        )
    assert sent == COUNT
    assert line.sent == pytest.approx(times)


def test_a_peer_that_does_not_read_or_leaves_is_an_error() -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        out = replay.TcpOut(ours, stall_s=0.05)
        with pytest.raises(BadInput, match="does not read"):
            out.send(b"x" * 100_000_000)
        theirs.close()
        with pytest.raises(BadInput, match="lost"):
            out.wait(5)


def test_waiting_reads_what_the_peer_sends() -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        out = replay.TcpOut(ours)
        theirs.sendall(b"hello")
        start = time.monotonic()
        out.wait(0.05)
        assert time.monotonic() - start >= 0.05
        assert out.received == 5


def test_slips_of_the_pen_are_told_with_what_was_meant(
    log: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for arguments, told in (
        (("filter", str(log), "--type", "AirVehicleStat"), "expected AirVehicleState"),
        (("filter", str(log), "--from", "noon"), "--from"),
        (("follow", str(log.with_name("later.sqlite")), "--for", "0"), "is not there yet"),
    ):
        assert main(["log", *arguments]) == 2
        assert told in capsys.readouterr().err
    assert main(["lmcp", "decode", str(log)]) == 2
    assert "`cratous log` reads logs" in capsys.readouterr().err
