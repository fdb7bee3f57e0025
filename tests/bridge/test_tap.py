"""A tap on a CRATOUS bridge: what goes through it."""

from __future__ import annotations

import random
import resource
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from uxas_tools import free_port

from cratous.bridge.port import Address
from cratous.bridge.relay import BARRED, CLOSED, FAR, LOST, NEAR, OPENED
from cratous.bridge.tap import Copied, Tap
from cratous.spec.errors import BadInput


def at(port: int = 0, host: str = "127.0.0.1") -> Address:
    return Address("tcp", host, port, f"tcp://{host}:{port}")


# ---- what goes through ------------------------------------------------------------------------


@pytest.fixture
def taps() -> Iterator[Callable[[Address, Address], Tap]]:
    made: list[Tap] = []

    def tap(listens: Address, leads_to: Address) -> Tap:
        made.append(Tap(listens, leads_to))
        return made[-1]

    yield tap
    for one in made:
        one.close()
        with suppress(subprocess.TimeoutExpired):
            one.process.wait(5)
        one.process.kill()
        one.process.wait()


def taken(tap: Tap, until: Callable[[list[Copied]], bool]) -> list[Copied]:
    found: list[Copied] = []
    deadline = time.monotonic() + 120
    while not until(found):
        assert time.monotonic() < deadline, [one._replace(data=b"") for one in found[-5:]]
        found += tap.step()
        time.sleep(0.005)
    return found


def of(found: list[Copied], kind: int) -> bytes:
    return b"".join(one.data for one in found if one.kind == kind)


def read_all(sock: socket.socket, into: bytearray) -> None:
    with suppress(OSError):
        while data := sock.recv(65536):
            into += data


def test_both_ways_go_through_byte_for_byte_while_nobody_looks(taps) -> None:
    """More than the copy holds, in pieces of any size; the watcher takes nothing before the end, and is told."""
    draw = random.Random(4)
    sent = [draw.randbytes(24 << 20), draw.randbytes(3 << 20)]
    got = [bytearray(), bytearray()]
    with socket.create_server(("127.0.0.1", 0)) as server:
        tap = taps(at(), at(server.getsockname()[1]))
        client = socket.create_connection(tap.bound)
        far, _ = server.accept()
        with client, far:
            threads = [
                threading.Thread(target=read_all, args=(one, into))
                for one, into in ((client, got[0]), (far, got[1]))
            ]
            for thread in threads:
                thread.start()
            for one, data in ((far, sent[0]), (client, sent[1])):
                start = 0
                while start < len(data):
                    count = draw.choice((1, 100, 5000, 100_000))
                    one.sendall(data[start : start + count])
                    start += count
                one.shutdown(socket.SHUT_WR)
            for thread in threads:
                thread.join(300)
    assert [bytes(one) for one in got] == sent
    found = taken(tap, lambda f: {one.kind for one in f} >= {LOST, CLOSED})
    lost = sum(one.lost for one in found)
    assert len(of(found, NEAR)) + len(of(found, FAR)) + lost == sum(map(len, sent))
    assert lost > 0
    assert OPENED in {one.kind for one in found}


def test_what_is_copied_is_what_went_through(taps) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        tap = taps(at(), at(server.getsockname()[1]))
        client = socket.create_connection(tap.bound)
        far, _ = server.accept()
        with client, far:
            far.sendall(b"one\n")
            assert client.recv(100) == b"one\n"
            client.sendall(b"two\n")
            assert far.recv(100) == b"two\n"
            far.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            far.close()  # broken, not ended
            client.settimeout(60)
            with pytest.raises(ConnectionResetError):
                client.recv(100)
        found = taken(tap, lambda f: any(one.kind == CLOSED for one in f))
    assert (of(found, FAR), of(found, NEAR)) == (b"one\n", b"two\n")
    times = [one.time_ns for one in found]
    assert times == sorted(times)


def test_lines_are_not_cut_and_a_client_that_stops_is_given_no_more_than_it_can_read(taps) -> None:
    """The original's client dies of half a line, and of 65,535 bytes at once."""
    line = b"x" * 99 + b"\n"
    with socket.create_server(("127.0.0.1", 0)) as server:
        tap = taps(at(), at(server.getsockname()[1]))
        client = socket.create_connection(tap.bound)
        far, _ = server.accept()
        with client, far:
            # as UxAS's end writes them
            far.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            writer = threading.Thread(target=lambda: [far.sendall(line) for _ in range(20_000)])
            writer.start()
            time.sleep(0.5)
            total = 0
            client.settimeout(60)
            while total < len(line) * 20_000:
                data = client.recv(1 << 20)
                total += len(data)
                assert len(data) <= 32_768
                assert data.endswith(b"\n")
            writer.join()
        taken(tap, lambda f: any(one.kind == CLOSED for one in f))


def test_clients_meet_the_program_in_the_order_in_which_they_came(taps) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        tap = taps(at(), at(server.getsockname()[1]))
        clients = [socket.create_connection(tap.bound) for _ in range(20)]
        for number, one in enumerate(clients):
            one.sendall(b"%02d" % number)
        for number in range(20):
            far, _ = server.accept()
            far.settimeout(60)
            assert far.recv(2) == b"%02d" % number
            far.close()
        for one in clients:
            one.close()


def test_where_nobody_listens_the_client_is_sent_away_and_the_tap_stays(taps) -> None:
    port = free_port()
    tap = taps(at(), at(port))
    for _ in range(2):
        # reset as it is read from, or before it has seen that it is connected; a tap that is gone would refuse it
        with suppress(ConnectionResetError), socket.create_connection(tap.bound, 60) as client:
            assert client.recv(10) == b""
    with (
        socket.create_server(("127.0.0.1", port)) as server,
        socket.create_connection(tap.bound, 60),
    ):
        server.settimeout(60)
        server.accept()[0].close()


def test_beyond_loopback_v2_alone_passes(taps) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        tap = taps(at(host="*"), at(server.getsockname()[1]))
        for opening, passes in ((b"CRATOUS-2,", True), (b"ICAROUS-UxAS_LMCP", False)):
            with socket.create_connection(("127.0.0.1", tap.bound[1]), 10) as client:
                far, _ = server.accept()
                with far:
                    far.sendall(opening)
                    got = b""
                    with suppress(ConnectionError):
                        got = client.recv(100)
                    assert got == (opening if passes else b"")
    found = taken(tap, lambda f: any(one.kind == BARRED for one in f))
    assert b"ICAROUS" not in of(found, FAR)


def test_when_the_watch_ends_what_is_connected_goes_on_and_then_the_relay_ends(taps) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        tap = taps(at(), at(server.getsockname()[1]))
        client = socket.create_connection(tap.bound)
        far, _ = server.accept()
        far.sendall(b"before\n")
        assert client.recv(100) == b"before\n"
        tap.close()
        for k in range(20):
            far.sendall(b"%d\n" % k)
            assert client.recv(100) == b"%d\n" % k
            time.sleep(0.01)
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection(tap.bound, 2)
        assert tap.stands
        client.close()
        assert far.recv(10) == b""
        far.close()
    assert tap.process.wait(60) == 0


def test_a_watcher_that_is_killed_ends_nothing() -> None:
    code = (
        "import sys, time\n"
        "from cratous.bridge.port import Address\n"
        "from cratous.bridge.tap import Tap\n"
        "at = lambda p: Address('tcp', '127.0.0.1', p, '')\n"
        "tap = Tap(at(0), at(int(sys.argv[1])))\n"
        "print(tap.bound[1], tap.process.pid, flush=True)\n"
        "time.sleep(600)\n"
    )
    with socket.create_server(("127.0.0.1", 0)) as server:
        words = [sys.executable, "-c", code, str(server.getsockname()[1])]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as watcher:
            assert watcher.stdout is not None
            port, pid = map(int, watcher.stdout.readline().split())
            client = socket.create_connection(("127.0.0.1", port))
            far, _ = server.accept()
            watcher.kill()
            watcher.wait()
            time.sleep(0.1)
            far.sendall(b"still\n")
            client.settimeout(60)
            assert client.recv(100) == b"still\n"
            client.close()
            far.close()
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        try:
            with open(f"/proc/{pid}/stat") as file:
                if file.read().rpartition(")")[2].split()[0] == "Z":
                    return
        except OSError:
            return
        time.sleep(0.05)
    pytest.fail("the relay has stayed")


def test_bad_addresses_are_bad_input() -> None:
    with (
        socket.create_server(("127.0.0.1", 0)) as taken_port,
        pytest.raises(BadInput, match="cannot listen"),
    ):
        Tap(at(taken_port.getsockname()[1]), at(1))
    with pytest.raises(BadInput, match="unknown host"):
        Tap(at(), at(1, "no-such-host.invalid"))


def test_more_clients_than_there_are_handles_end_no_connection(taps) -> None:
    with socket.create_server(("127.0.0.1", 0), backlog=200) as server:
        tap = taps(at(), at(server.getsockname()[1]))
        client = socket.create_connection(tap.bound)
        far, _ = server.accept()
        resource.prlimit(tap.process.pid, resource.RLIMIT_NOFILE, (24, 24))
        others = []
        for _ in range(60):
            with suppress(ConnectionResetError):  # one without a handle may be reset at once
                others.append(socket.create_connection(tap.bound))
        time.sleep(0.3)
        with client, far:
            far.settimeout(60)
            client.sendall(b"one\n")
            assert far.recv(100) == b"one\n"
        for one in others:
            one.close()
        assert tap.stands


def test_the_relay_has_no_key_of_a_vehicle(taps, monkeypatch) -> None:
    monkeypatch.setenv("CRATOUS_BRIDGE_KEY_3", "00" * 32)
    tap = taps(at(), at(1))
    limit_s = time.monotonic() + 60
    # empty until the kernel has set up the new program
    while not (environment := Path(f"/proc/{tap.process.pid}/environ").read_bytes()):
        assert time.monotonic() < limit_s
    assert b"CRATOUS_BRIDGE_KEY_3" not in environment


def test_a_flood_does_not_keep_who_watches_from_ending(taps) -> None:
    """What comes is given in parts, so that it is looked in between whether to end."""
    over = threading.Event()
    with socket.create_server(("127.0.0.1", 0)) as server:
        tap = taps(at(), at(server.getsockname()[1]))
        client = socket.create_connection(tap.bound)
        far, _ = server.accept()

        def flood() -> None:
            with suppress(OSError):
                while not over.is_set():
                    client.sendall(b"x" * 65536)

        threads = [
            threading.Thread(target=flood),
            threading.Thread(target=read_all, args=(far, bytearray())),
        ]
        with client, far:
            for thread in threads:
                thread.start()
            time.sleep(0.5)
            most, looks, limit_s = 0, 0, time.monotonic() + 60
            while looks < 5:
                assert time.monotonic() < limit_s, "nothing comes"
                count = 0
                for one in tap.step():
                    count += len(one.data)
                    time.sleep(0.005)  # it is looked at
                    if count > 8 << 20:
                        break
                most, looks = max(most, count), looks + bool(count)
            over.set()
        for thread in threads:
            thread.join(60)
    assert 0 < most <= 1 << 18
