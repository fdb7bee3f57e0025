"""`cratous monitor --attach`: a running system watched while it runs, and judged as its log is."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
import zmq
from requirement_tools import all_closed, written
from uxas_tools import free_port

from cratous.bridge import envelope, lmcp, sentinel
from cratous.services.cli import main
from cratous.services.requirements.attached import Attached

# long enough for a loaded machine, on which what watches and what is watched stand still for seconds
REQUIREMENTS = """trace every 50 ms gap 30 s
signal altitude: m from AirVehicleState[ID=7].Location.Altitude hold 30 s
requirement FLOOR "never low" severity hazardous: altitude >= 90 m
requirement SINKS severity minor: altitude >= 200 m
requirement SOON: altitude < 250 m implies eventually within 10 s altitude >= 250 m
"""
ROOT = Path(__file__).parents[2]


def _message(altitude_m: float, vehicle: int = 7) -> bytes:
    state = lmcp.types["afrl.cmasi.AirVehicleState"]()
    state.ID = vehicle
    state.Location.Altitude = altitude_m
    name = "afrl.cmasi.AirVehicleState"
    message = envelope.AddressedMessage(
        name, envelope.LMCP, name, "", "7", "1", lmcp.binary.pack(state)
    )
    return message.pack()


def _state(altitude_m: float, vehicle: int = 7) -> bytes:
    return sentinel.frame(_message(altitude_m, vehicle))


LOOKED_AT: list[None] = []
"""One for each message that a watch of this process has looked at."""
HERE = threading.Event()
"""Whether the watch is one of this process."""


@pytest.fixture(autouse=True)
def _looked_at(monkeypatch) -> None:
    real = Attached._entry

    def entry(self: Attached, payload: bytes) -> Any:
        LOOKED_AT.append(None)
        return real(self, payload)

    monkeypatch.setattr(Attached, "_entry", entry)
    HERE.clear()


def _until_looked_at(before: int) -> None:
    """What is said next comes at another time than what was said: of one time the last value counts alone."""
    limit_s = time.monotonic() + 0.5  # what is no message is not looked at
    time.sleep(0.02)
    while HERE.is_set() and len(LOOKED_AT) == before and time.monotonic() < limit_s:
        time.sleep(0.005)
    time.sleep(0.005)


class Peer:
    """What is watched: listens, and says the same to each client in turn; a number is a pause [s]."""

    def __init__(self, *talks: list[bytes | float]) -> None:
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self.heard = b""
        self._talks = talks
        self._thread = threading.Thread(target=self._talk, daemon=True)
        self._thread.start()

    def _talk(self) -> None:
        for number, talk in enumerate(self._talks, 1):
            client, _ = self._listener.accept()
            with client, suppress(ConnectionError, TimeoutError):
                client.settimeout(120)
                for piece in talk:
                    if isinstance(piece, float):
                        time.sleep(piece)
                        continue
                    before = len(LOOKED_AT)
                    client.sendall(piece)
                    _until_looked_at(before)
                if number == len(self._talks):  # the last one stays until the other end goes
                    self.heard += client.recv(1000)

    def close(self) -> None:
        self._listener.close()
        self._thread.join(60)


@pytest.fixture
def peers() -> Iterator[Callable[..., Peer]]:
    yield from all_closed(Peer)


@pytest.fixture
def requirements(tmp_path: Path) -> Path:
    return written(tmp_path, REQUIREMENTS)


def _attach(port: int, requirements: Path, *more: str, seconds: float = 3.0) -> int:
    words = ["monitor", "--attach", f"127.0.0.1:{port}", "--requirements", str(requirements)]
    HERE.set()
    return main([*words, "--seconds", str(seconds), *more])


def test_what_is_watched_is_judged_as_its_log_is(peers, requirements, tmp_path, capsys):
    talk = [_state(300), _state(20, vehicle=8), _state(150), _state(80), _state(300), _state(240)]
    peer = peers(talk)
    log = tmp_path / "kept.sqlite"
    code = _attach(peer.port, requirements, "--keep", str(log), "--json")
    assert code == 1
    lines = capsys.readouterr().out
    events, _, result = lines.partition("\n{\n")
    first = [json.loads(line) for line in events.splitlines()]
    assert [(e["event"], e["requirement"]) for e in first] == [
        ("violated", "SINKS"),
        ("violated", "FLOOR"),
    ]
    assert first[0]["at_s"] <= first[1]["at_s"]
    live = json.loads("{\n" + result)
    assert [r["verdict"] for r in live["requirements"]] == ["violated", "violated", "undecided"]
    assert peer.heard == b""  # nothing is sent to what is watched
    assert main(["monitor", str(log), "--requirements", str(requirements), "--json"]) == 1
    again = json.loads(capsys.readouterr().out)
    assert again["requirements"] == live["requirements"]


def test_a_connection_that_is_lost_is_made_again_and_nothing_holds_then(
    peers, requirements, tmp_path, capsys
):
    peer = peers([_state(300), _state(310)], [_state(320), b"rubbish", _state(330)])
    log = tmp_path / "kept.sqlite"
    code = _attach(peer.port, requirements, "--keep", str(log), "--json")
    assert code == 3
    said = json.loads(capsys.readouterr().out)
    kinds = {finding["kind"] for finding in said["findings"]}
    assert {"cut", "refused"} <= kinds
    assert {r["verdict"] for r in said["requirements"]} == {"unknown"}
    assert said["requirements"][0]["holds"] >= 3
    assert main(["monitor", str(log), "--requirements", str(requirements), "--json"]) == 3
    words = capsys.readouterr()
    assert {r["verdict"] for r in json.loads(words.out)["requirements"]} == {"unknown"}
    assert "SOON: unknown" in words.err, "who reads only the exit code is told why it is no 0"


def test_of_a_peer_that_falls_silent_nothing_holds(peers, tmp_path, capsys):
    requirements = written(tmp_path, REQUIREMENTS.replace("30 s", "1 s"))
    peer, log = peers([_state(300), _state(310)]), tmp_path / "kept.sqlite"
    assert _attach(peer.port, requirements, "--keep", str(log), "--json") == 3
    said = json.loads(capsys.readouterr().out)
    assert "silent" in {finding["kind"] for finding in said["findings"]}
    assert {r["verdict"] for r in said["requirements"]} == {"unknown"}
    assert main(["monitor", str(log), "--requirements", str(requirements)]) == 3


def test_a_damaged_message_ends_no_watch(peers, requirements, capsys):
    whole = sentinel.unframe(_state(300))
    # the frame is whole, the message in it has another checksum
    damaged = sentinel.frame(whole[:-1] + bytes([whole[-1] ^ 1]))
    peer = peers([_state(300), damaged, _state(310)])
    assert _attach(peer.port, requirements, "--json", seconds=2.0) == 3
    said = json.loads(capsys.readouterr().out)
    assert "refused" in {finding["kind"] for finding in said["findings"]}
    assert said["requirements"][0]["holds"] == 2


def test_a_command_is_started_once_for_a_requirement(peers, requirements, tmp_path, capsys):
    peer = peers([_state(300), _state(80), _state(70), _state(60)])
    told = tmp_path / "told"
    script = (
        f"open({str(told)!r}, 'a').write(__import__('os').environ['CRATOUS_REQUIREMENT'] + ' ')"
    )
    assert (
        _attach(
            peer.port,
            requirements,
            "--on-violation",
            f'{sys.executable} -c "{script}"',
            seconds=2.0,
        )
        == 1
    )
    deadline = time.monotonic() + 120
    while (
        time.monotonic() < deadline and len(told.read_text().split() if told.exists() else []) < 2
    ):
        time.sleep(0.05)
    assert sorted(told.read_text().split()) == ["FLOOR", "SINKS"]
    assert "FLOOR [hazardous]: violated at " in capsys.readouterr().out


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_serves_counts_and_ends_with_its_verdicts_at_a_signal(peers, requirements, number):
    peer = peers([_state(300)] + [_state(300 + k) for k in range(400)])
    process = subprocess.Popen(
        [sys.executable, "-m", "cratous", "monitor", "--attach", f"127.0.0.1:{peer.port}",
         "--requirements", str(requirements), "--metrics", "0"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),
    )  # fmt: skip
    try:
        assert process.stderr is not None
        line = process.stderr.readline()
        url = re.search(r"http://127\.0\.0\.1:\d+/metrics", line)
        assert url, line
        deadline, text = time.monotonic() + 120, ""
        while time.monotonic() < deadline and 'requirement="FLOOR",verdict="holds"} 2' not in text:
            with urllib.request.urlopen(url[0], timeout=60) as answer:
                text = answer.read().decode()
            time.sleep(0.02)
        assert 'cratous_violated{requirement="FLOOR",severity="hazardous"} 0' in text
        assert 'cratous_samples_total{requirement="SOON",verdict="violated"} 0' in text
        with pytest.raises(urllib.request.HTTPError):
            urllib.request.urlopen(url[0].replace("/metrics", "/other"), timeout=60)
        process.send_signal(number)
        out, _ = process.communicate(timeout=120)
    finally:
        process.kill()
        process.wait()
    assert process.returncode == 0
    assert "FLOOR (never low) [hazardous]: holds" in out


def test_on_a_terminal_it_shows_a_table_while_it_watches(peers, requirements):
    import pty
    import select

    peer = peers([_state(300), 0.5, _state(150), 0.5] + [_state(300)] * 100)
    main_end, its_end = pty.openpty()
    words = [sys.executable, "-m", "cratous", "monitor", "--attach", f"127.0.0.1:{peer.port}"]
    words += ["--requirements", str(requirements), "--seconds", "3"]
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "140", "LINES": "40"}
    with subprocess.Popen(
        words, stdout=its_end, stderr=its_end, cwd=ROOT, env=environment
    ) as process:
        os.close(its_end)
        said, deadline = b"", time.monotonic() + 180
        while time.monotonic() < deadline:
            if not select.select([main_end], [], [], 1.0)[0]:
                continue
            try:
                data = os.read(main_end, 65536)
            except OSError:
                break
            if not data:
                break
            said += data
    os.close(main_end)
    assert process.returncode == 1
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", said.decode())
    live, _, end = text.partition("FLOOR (never low) [hazardous]: holds; samples")
    assert re.search(r"FLOOR \[hazardous\] +│ holds so far", live)
    assert re.search(r"SINKS \[minor\] +│ violated +│ +\d+ +│ 1 ", live)
    assert "altitude - 200 m = -50 m at" in live
    assert "SINKS [minor]: violated at " in live, "the event stands above the table"
    assert "so far" not in end


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--attach", "127.0.0.1:1"], "--requirements"),
        (["--attach", "nonsense", "--requirements", "{r}"], "--attach"),
        (["log.sqlite", "--attach", "127.0.0.1:1", "--requirements", "{r}"], "LOG or --attach"),
        ([], "LOG or --attach"),
        (["log.sqlite", "--seconds", "3"], "--seconds needs --attach"),
        (["log.sqlite", "--metrics", "0"], "--metrics needs --attach"),
        (["--attach", "127.0.0.1:1", "--requirements", "{r}", "--on-violation", "no-such-program"],
         "no-such-program"),
    ],
)  # fmt: skip
def test_what_does_not_go_together_is_bad_input(words, said, requirements, capsys):
    assert main(["monitor", *(word.format(r=requirements) for word in words)]) == 2
    assert said in capsys.readouterr().err


def test_nobody_there_is_said(requirements, monkeypatch, capsys):
    from cratous.services.cli import monitor_attach

    monkeypatch.setattr(monitor_attach, "WAIT_S", 0.3)
    port = free_port()
    assert _attach(port, requirements, seconds=20) == 2
    assert "no program listens there" in capsys.readouterr().err


def _whole(out: str) -> dict[str, Any]:
    """The result at the end, behind the lines of what happened."""
    found: dict[str, Any] = json.loads(out[out.index("{\n") :])
    return found


class Publisher:
    """A PUB socket, as a bridge of UxAS binds it: tells each talk to whoever has subscribed, then is gone for a moment."""

    def __init__(self, *talks: list[bytes]) -> None:
        self._context = zmq.Context()
        self._talks, self.port, self._over = talks, 0, threading.Event()
        self._bound = threading.Event()
        self._thread = threading.Thread(target=self._talk, daemon=True)
        self._thread.start()
        assert self._bound.wait(60)

    def _talk(self) -> None:
        for number, talk in enumerate(self._talks, 1):
            sock = self._context.socket(zmq.XPUB)  # which is told of subscriptions
            sock.linger = 500
            if self.port:
                sock.bind(f"tcp://127.0.0.1:{self.port}")
            else:
                self.port = sock.bind_to_random_port("tcp://127.0.0.1")
            self._bound.set()
            if sock.poll(120_000):
                assert sock.recv() == b"\x01"  # of everything
                for piece in talk:
                    before = len(LOOKED_AT)
                    sock.send(piece)
                    _until_looked_at(before)
                if number == len(self._talks):
                    self._over.wait(120)
            sock.close()
            time.sleep(0.3)

    def close(self) -> None:
        self._over.set()
        self._thread.join(60)
        self._context.destroy(linger=0)


@pytest.fixture
def publishers() -> Iterator[Callable[..., Publisher]]:
    made: list[Publisher] = []

    def publisher(*talks: list[bytes]) -> Publisher:
        made.append(Publisher(*talks))
        return made[-1]

    yield publisher
    for one in made:
        one.close()


def test_what_a_publisher_tells_is_judged_as_its_log_is(publishers, requirements, tmp_path, capsys):
    talk = [_message(300), _message(20, vehicle=8), _message(150), _message(80), _message(300)]
    peer, log = publishers(talk), tmp_path / "kept.sqlite"
    words = ["monitor", "--attach", f"zmq://127.0.0.1:{peer.port}"]
    words += ["--requirements", str(requirements), "--seconds", "4"]
    HERE.set()
    assert main([*words, "--keep", str(log), "--json"]) == 1
    live = _whole(capsys.readouterr().out)
    assert [r["verdict"] for r in live["requirements"]][:2] == ["violated", "violated"]
    assert main(["monitor", str(log), "--requirements", str(requirements), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["requirements"] == live["requirements"]


def test_a_publisher_that_goes_is_met_again_and_nothing_holds_then(
    publishers, requirements, capsys
):
    peer = publishers([_message(300), _message(310)], [_message(320), _message(330)])
    words = ["monitor", "--attach", f"zmq://127.0.0.1:{peer.port}", "--seconds", "6"]
    HERE.set()
    assert main([*words, "--requirements", str(requirements), "--json"]) == 3
    said = capsys.readouterr()
    found = _whole(said.out)
    assert found["requirements"][0]["verdict"] == "unknown"
    assert "a peer is gone" in said.err
    assert said.err.count("a peer has connected") == 2


def test_no_publisher_is_said(requirements, monkeypatch, capsys):
    from cratous.services.cli import monitor_attach

    monkeypatch.setattr(monitor_attach, "WAIT_S", 0.3)
    port = free_port()
    words = ["monitor", "--attach", f"zmq://127.0.0.1:{port}", "--seconds", "20"]
    assert main([*words, "--requirements", str(requirements)]) == 2
    assert "no program listens there" in capsys.readouterr().err
