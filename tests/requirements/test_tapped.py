"""`cratous monitor --attach cratous://...`: the lines of a CRATOUS bridge held against requirements while they pass."""

from __future__ import annotations

import json
import socket
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from requirement_tools import all_closed, written
from uxas_tools import free_port

from cratous.bridge import text_protocol as tp
from cratous.bridge.link import Link
from cratous.bridge.port import Address
from cratous.bridge.relay import NEAR, OPENED, RECORD
from cratous.bridge.tap import Copied, Tap
from cratous.bridge.text_connection import Opened
from cratous.bridge.text_port import TextPort
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.handshake import DEFAULT_SECRET
from cratous.bridge.text_protocol.keys import Keys
from cratous.services.cli import main
from cratous.services.requirements import tapped_bridge

# long enough for a loaded machine, on which the two ends and the tap stand still for seconds
REQUIREMENTS = """trace every 100 ms gap 30 s begins with all
signal altitude: m from AirVehicleState[ID=3].Location.Altitude hold 30 s
signal climb: m/s from AirVehicleState[ID=3].VerticalSpeed hold 30 s
signal intruder: m from AirVehicleState[ID=9].Location.Altitude hold 30 s
signal has: bool from AuthorityChange[VehicleID=3].Owner is ICAROUS hold 1 h
signal steered: m/s from GatedCommand[VehicleID=3].Command.VehicleActionList.0.Speed hold 1 h
signal beat: 1 from Heartbeat[VehicleID=3, Direction=Up].Sequence hold 30 s
requirement FLOOR severity hazardous: altitude >= 90 m and intruder >= 90 m
requirement CLIMBS: climb > 0 m/s
requirement HAS: has
requirement STEERED: steered <= 25 m/s and beat >= 1
"""
KEY = {3: b"k" * 32}


def _position(altitude_m: float) -> tp.OwnPosition:
    return tp.OwnPosition(1.0, 37.1, -76.4, altitude_m, altitude_m, 22.0, 0.0, -1.5, vehicle_id=3)


DOWN = [
    tp.Traffic("TRAFFIC", 37.2, -76.3, 310.0, -20.0, 1.5, 0.0, 9),
    *(_position(altitude_m) for altitude_m in (300.0, 80.0, 300.0)),
]
UP = [tp.SetMode("ACTIVE", 1), tp.SetVelocity(15.0, 20.0, 0.0), tp.Heartbeat(7, 1.0)]


class Bridge:
    """UxAS's end and ICAROUS's, of which one speaks through the tap; each says its lines in turn."""

    def __init__(
        self,
        secret: str | Keys = DEFAULT_SECRET,
        dialect: Dialect = Dialect.CRATOUS,
        raw: bytes = b"",
    ) -> None:
        self.port, self.tap = free_port(), free_port()
        self.heard: dict[bool, list[Any]] = {True: [], False: []}
        self._dialect, self._raw, self._over = dialect, raw, threading.Event()
        at = Address("tcp", "127.0.0.1", self.port, "")
        self._uxas = TextPort(at, server=True, secret=secret, dialect=dialect)
        self._icarous = TextPort(at, server=False, secret=secret, dialect=dialect)
        self._thread = threading.Thread(target=self._talk, daemon=True)
        self._thread.start()

    def _talk(self) -> None:
        there = Address("tcp", "127.0.0.1", self.tap, "")
        opened: dict[bool, int] = {}
        said, said_s, dialled, looked_s = 0, 0.0, False, 0.0
        while not self._over.wait(0.02):
            now_s = time.monotonic()
            if not dialled and now_s - looked_s > 0.2:
                looked_s = now_s
                self._icarous.dial(now_s, there)
                dialled = True
            for up, port in ((False, self._icarous), (True, self._uxas)):
                for came in port.step(now_s):
                    if isinstance(came.what, Opened):
                        opened[not up] = came.key
                        if not up and self._dialect.ours:
                            port.send(came.key, tp.Hello(3))
                    elif isinstance(came.what, tp.Message):
                        self.heard[up].append(came.what)
                    elif not opened:
                        dialled = False  # the tap is not there yet
            # of one time the last line counts alone; what is no line is never heard
            come = self._heard_all(said) or now_s - said_s > 0.5
            if len(opened) == 2 and said < 4 and come:
                if said == 1 and self._raw:
                    link: Link = self._icarous._connections[opened[True]].link
                    link.send(self._raw)
                self._uxas.send(opened[False], DOWN[said])
                if said < len(UP):
                    self._icarous.send(opened[True], UP[said])
                said, said_s = said + 1, now_s

    def _heard_all(self, said: int) -> bool:
        """Whether both ends have heard the first lines, so many, of the other one."""
        up = [m for m in self.heard[True] if not isinstance(m, tp.Hello)]
        return len(self.heard[False]) >= said and len(up) >= min(said, len(UP))

    def close(self) -> None:
        self._over.set()
        self._thread.join(60)
        self._uxas.close()
        self._icarous.close()


@pytest.fixture
def bridges() -> Iterator[Callable[..., Bridge]]:
    yield from all_closed(Bridge)


@pytest.fixture
def requirements(tmp_path: Path) -> Path:
    return written(tmp_path, REQUIREMENTS)


def _watch(bridge: Bridge, requirements: Path, *more: str) -> int:
    words = ["monitor", "--attach", f"cratous://127.0.0.1:{bridge.port}"]
    words += ["--listen", f"127.0.0.1:{bridge.tap}", "--requirements", str(requirements)]
    return main([*words, "--seconds", "3", "--json", *more])


def _result(out: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(out[out.index("\n{\n") + 1 :])
    return found


def _verdicts(result: dict[str, Any]) -> dict[str, str]:
    return {one["name"]: one["verdict"] for one in result["requirements"]}


@pytest.mark.parametrize("kind", ["plain", "v2 with its key", "v2 without"])
def test_lines_are_judged_as_they_pass_and_as_the_log_is(
    kind, bridges, requirements, tmp_path, capsys
):
    bridge = bridges(DEFAULT_SECRET if kind == "plain" else Keys(KEY))
    log, keys = tmp_path / "kept.sqlite", tmp_path / "keys"
    keys.mkdir()
    (keys / "vehicle_3.key").write_text(KEY[3].hex())
    given = ["--keys", str(keys)] if kind == "v2 with its key" else []
    assert _watch(bridge, requirements, "--keep", str(log), *given) == 1
    said = capsys.readouterr()
    live = _result(said.out)
    assert _verdicts(live) == {
        "FLOOR": "violated", "CLIMBS": "holds", "HAS": "holds", "STEERED": "holds",
    }  # fmt: skip
    kinds = {one["kind"] for one in live["findings"]}
    assert ("unsealed" in kinds) == (kind != "v2 with its key")
    assert ("not authenticated" in said.err) == (kind != "v2 with its key")
    # whoever reaches the bridge may have said it: each row, and each event, says so
    sure = kind == "v2 with its key"
    assert {one["unauthenticated"] for one in live["requirements"]} == {not sure}
    events = [json.loads(line) for line in said.out.splitlines() if line.startswith('{"event"')]
    assert {one["unauthenticated"] for one in events} == {not sure}
    # both ends have heard all that the other one said
    assert [m for m in bridge.heard[True] if not isinstance(m, tp.Hello)] == UP
    assert bridge.heard[False] == DOWN
    assert main(["monitor", str(log), "--requirements", str(requirements), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["requirements"] == live["requirements"]
    assert main(["monitor", str(log), "--requirements", str(requirements)]) == 1
    lines = [one for one in capsys.readouterr().out.splitlines() if "; samples: " in one]
    told = [one.endswith("; as told by an unauthenticated source") for one in lines]
    assert told == [not sure] * 4
    assert main(["log", "filter", str(log), "--json"]) == 0
    assert ("not authenticated" in capsys.readouterr().out) == (kind != "v2 with its key")


def test_of_the_original_the_vehicle_is_that_of_its_position(bridges, tmp_path, capsys):
    bridge, file = bridges(dialect=Dialect.ORIGINAL), tmp_path / "r.req"
    head = REQUIREMENTS[: REQUIREMENTS.index("signal beat")]
    file.write_text(
        head + "requirement FLOOR: altitude >= 90 m\nrequirement STEERED: steered <= 20 m/s\n"
    )
    assert _watch(bridge, file) == 1
    assert _verdicts(_result(capsys.readouterr().out)) == {
        "FLOOR": "violated",
        "STEERED": "violated",
    }


def test_hostile_lines_end_no_watch_and_nothing_holds(bridges, requirements, capsys):
    raw = b"SETMOD,type_ACTIVE_,epochnan,\n\xff\xfe\x00\nSETVEL,north1e400,\n" + b"A" * 9000 + b"\n"
    assert _watch(bridges(raw=raw), requirements) == 1
    said = capsys.readouterr()
    live = _result(said.out)
    assert _verdicts(live) == {
        "FLOOR": "violated", "CLIMBS": "unknown", "HAS": "unknown", "STEERED": "unknown",
    }  # fmt: skip
    assert "refused" in {one["kind"] for one in live["findings"]}


@pytest.mark.parametrize(
    ("signal", "said"),
    [
        ("m/s from AirVehicleState[ID=1].Airspeed", "no line of the bridge tells this field"),
        ("m from TruthState[VehicleID=1].North", "no line of the bridge gives this message"),
        (
            "bool from AirVehicleState[ID=1].Mode is Loiter",
            "no line of the bridge tells this field",
        ),
    ],
)
def test_a_signal_that_no_line_tells_is_refused_before_anything_is_tapped(
    signal, said, tmp_path, capsys
):
    file = tmp_path / "r.req"
    kind = signal.partition(" ")[0]
    formula = "x" if kind == "bool" else f"x >= 1 {kind}"
    file.write_text(f"trace every 1 s\nsignal x: {signal}\nrequirement R: {formula}\n")
    words = ["monitor", "--attach", "cratous://127.0.0.1:1", "--listen", "127.0.0.1:0"]
    assert main([*words, "--requirements", str(file)]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--attach", "cratous://127.0.0.1:1"], "--listen"),
        (["--attach", "cratous://nobody", "--listen", "127.0.0.1:0"], "--attach"),
        (["--attach", "cratous://127.0.0.1:1", "--listen", "nonsense"], "--listen"),
        (["--attach", "127.0.0.1:1", "--listen", "127.0.0.1:0"], "--listen is of a tap"),
        (["--attach", "127.0.0.1:1", "--keys", "x"], "--keys is of a tap"),
        (
            ["--attach", "cratous://127.0.0.1:1", "--listen", "127.0.0.1:0", "--keys", "no-such"],
            "there is no such folder",
        ),
        (["log.sqlite", "--listen", "127.0.0.1:0"], "--listen needs --attach"),
    ],
)
def test_what_does_not_fit_is_bad_input(words, said, requirements, capsys):
    assert main(["monitor", *words, "--requirements", str(requirements)]) == 2
    assert said in capsys.readouterr().err


def test_that_nobody_comes_is_said(requirements, monkeypatch, capsys):
    from cratous.services.cli import monitor_attach

    monkeypatch.setattr(monitor_attach, "TAP_WAIT_S", 0.3)
    words = ["monitor", "--attach", f"cratous://127.0.0.1:{free_port()}", "--listen", "127.0.0.1:0"]
    assert main([*words, "--requirements", str(requirements)]) == 2
    assert "no program has connected to the tap" in capsys.readouterr().err


class Flood:
    """A tap at which more has come than is ever looked at; came_ns: when, None for always just now."""

    stands, process = True, None

    def __init__(self, came_ns: int | None) -> None:
        self._came_ns, self._kind = came_ns, OPENED

    def handles(self) -> list[Any]:
        return []

    def step(self) -> Iterator[Copied]:
        time_ns = time.monotonic_ns() if self._came_ns is None else self._came_ns
        kind, self._kind = self._kind, NEAR
        yield Copied(kind, 1, time_ns, b"" if kind == OPENED else b"x\n")

    def close(self) -> None:
        pass


@pytest.mark.parametrize("came_ns", [1, None])
def test_a_watch_ends_in_a_flood_and_what_came_before_is_left_out_by_name(
    came_ns: int | None, monkeypatch
) -> None:
    monkeypatch.setattr(tapped_bridge, "REST_S", 0.2)
    found: list[str] = []
    flood: Any = Flood(came_ns)
    one = tapped_bridge.Tapped(
        flood, lambda _: None, lambda *_: None, lambda kind, _: found.append(kind)
    )
    begun_s = time.monotonic()
    turns = iter([False, False, True])
    assert list(one.messages(10.0, lambda _: next(turns))) == []
    assert time.monotonic() - begun_s < 60
    assert ("left out" in found) == (came_ns is not None)


class Behind:
    """A tap whose relay hands over late, and in parts, what has passed before the end of the watch."""

    process = None

    def __init__(self) -> None:
        self.stands = True
        self._ours, theirs = socket.socketpair()
        passed = (OPENED, b""), (NEAR, b"what is no opening\n")
        data = [RECORD.pack(kind, 1, 1, len(said)) + said for kind, said in passed]
        parts = data[0], data[1][:5], data[1][5:]
        self._tap = Tap.__new__(Tap)
        self._tap._ours, self._tap._part = self._ours, b""
        self._ours.setblocking(False)

        def hand_over() -> None:
            for part in parts:
                time.sleep(0.03)
                theirs.sendall(part)
            self.stands = False
            theirs.shutdown(socket.SHUT_WR)

        threading.Thread(target=hand_over, daemon=True).start()
        self._theirs = theirs
        self.handles, self.step = self._tap.handles, self._tap.step

    def close(self) -> None:
        self._ours.close()
        self._theirs.close()


def test_what_the_relay_hands_over_late_is_looked_at_still(monkeypatch) -> None:
    monkeypatch.setattr(tapped_bridge, "POLL_S", 60.0)  # so long it may take to be late
    monkeypatch.setattr(tapped_bridge, "REST_S", 60.0)
    found: list[str] = []
    tap: Any = Behind()
    one = tapped_bridge.Tapped(
        tap, lambda _: None, lambda *_: None, lambda kind, _: found.append(kind)
    )
    assert list(one.messages(10.0, lambda _: True)) == []
    assert found == ["refused"]


def test_a_file_of_a_key_that_holds_none_is_bad_input(requirements, tmp_path, capsys):
    (tmp_path / "vehicle_3.key").write_text("no key")
    words = [
        "--attach",
        "cratous://127.0.0.1:1",
        "--listen",
        "127.0.0.1:0",
        "--keys",
        str(tmp_path),
    ]
    assert main(["monitor", *words, "--requirements", str(requirements)]) == 2
    said = capsys.readouterr().err
    assert "vehicle_3.key" in said
    assert "no key of the bridge" in said
