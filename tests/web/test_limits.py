"""What a client of a server of ours may hold, and how a server ends."""

from __future__ import annotations

import http.client
import socket
import subprocess
import sys
import threading
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import contextmanager, suppress

import pytest
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response, StreamingResponse
from starlette.routing import Route

from cratous.services.web import connection, server
from cratous.services.web.answers import body_of, in_thread
from cratous.services.web.server import WebServer

LIMIT_S = 120.0
SHORT_S = 0.4
BIG = b"a" * 30_000_000
"""More than lies in buffers of the system."""


class App:
    """Answers, and keeps who asks for `/wait` waiting until it is let go."""

    def __init__(self) -> None:
        self.go, self.waiting = threading.Event(), threading.Semaphore(0)
        self.app = Starlette(
            routes=[
                Route("/", self._quick), Route("/wait", self._wait),
                Route("/body", self._body, methods=["POST"]), Route("/big", self._big),
                Route("/parts", self._parts),
            ]
        )  # fmt: skip

    async def _quick(self, _: Request) -> Response:
        return PlainTextResponse("here")

    async def _wait(self, _: Request) -> Response:
        self.waiting.release()
        await in_thread(self.go.wait, LIMIT_S)
        return PlainTextResponse("gone")

    async def _big(self, _: Request) -> Response:
        return Response(BIG)

    async def _parts(self, _: Request) -> Response:
        async def parts() -> AsyncIterator[bytes]:
            for k in range(0, len(BIG), 100_000):
                yield BIG[k : k + 100_000]

        return StreamingResponse(parts())

    async def _body(self, request: Request) -> Response:
        return PlainTextResponse(str(len(await body_of(request, 100))))


@contextmanager
def running(app: App) -> Iterator[WebServer]:
    with WebServer(app.app, 0) as one:
        serving = threading.Thread(target=one.serve_forever)
        serving.start()
        try:
            yield one
        finally:
            one.shutdown()
            serving.join(LIMIT_S)
            app.go.set()
            assert not serving.is_alive()


@pytest.fixture
def app() -> App:
    return App()


def get(port: int, path: str) -> tuple[int, bytes]:
    line = http.client.HTTPConnection("127.0.0.1", port, timeout=LIMIT_S)
    try:
        line.request("GET", path)
        answer = line.getresponse()
        return answer.status, answer.read()
    finally:
        line.close()


def connected(port: int, *parts: bytes) -> socket.socket:
    one = socket.create_connection(("127.0.0.1", port), timeout=LIMIT_S)
    for part in parts:
        one.sendall(part)
    return one


def is_cut_off(one: socket.socket) -> bool:
    """Whether the server ends the connection without a word; waits for it."""
    with suppress(ConnectionResetError, BrokenPipeError):
        return one.recv(1) == b""
    return True


@pytest.mark.parametrize(
    "begun", [b"", b"GET / HT", b"POST /body HTTP/1.1\r\nHost: a\r\nContent-Length: 9\r\n\r\nab"]
)
def test_who_does_not_ask_in_time_is_cut_off(
    app: App, begun: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "REQUEST_S", SHORT_S)
    with running(app) as one:
        began_s = time.monotonic()
        assert is_cut_off(connected(one.port, begun))
        assert time.monotonic() - began_s > SHORT_S / 2
        # what it was told in between gains it nothing
        slow = connected(one.port, b"GET /")
        until_s = time.monotonic() + LIMIT_S
        with suppress(ConnectionResetError, BrokenPipeError):
            while time.monotonic() < until_s:
                slow.sendall(b"a")
                time.sleep(SHORT_S / 10)
        assert time.monotonic() < until_s


def test_who_has_asked_may_wait_longer(app: App, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connection, "REQUEST_S", SHORT_S)
    with running(app) as one:
        threading.Timer(3 * SHORT_S, app.go.set).start()
        assert get(one.port, "/wait") == (200, b"gone")


def test_who_sends_on_what_was_refused_is_cut_off(
    app: App, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "REQUEST_S", 3600.0)  # not only when its time is over
    head = b"POST /none HTTP/1.1\r\nHost: a\r\nContent-Length: 999999999\r\n\r\n"
    with running(app) as one:
        flood = connected(one.port, head)
        assert flood.recv(12) == b"HTTP/1.1 404"
        with suppress(ConnectionResetError, BrokenPipeError):
            for _ in range(999):
                flood.sendall(b"a" * 999_999)
            pytest.fail("it has read a gigabyte")


@pytest.mark.parametrize(
    "asked",
    [
        b"GET /parts HTTP/1.1\r\nHost: a\r\n\r\n",
        b"GET /big HTTP/1.1\r\nHost: a\r\n\r\n",
        b"GET /big HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n",
        b"GET /big HTTP/1.1\r\nHost: a\r\n\r\n" * 3,
    ],
    ids=["parts", "whole", "the last", "several"],
)
def test_who_does_not_read_what_it_asked_for_is_cut_off(
    app: App, asked: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "REQUEST_S", SHORT_S)
    with running(app) as one:
        state = one._server.server_state
        idle = connected(one.port)
        with suppress(OSError):
            idle.sendall(asked)
        assert idle.recv(4) == b"HTTP"
        until_s = time.monotonic() + LIMIT_S
        while state.connections:
            assert time.monotonic() < until_s
            time.sleep(SHORT_S / 10)
        assert not state.silent
        idle.close()


@pytest.mark.parametrize("path", ["parts", "big"])
def test_who_reads_slowly_gets_all_of_it(
    app: App, path: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pause_s = 0.3  # far shorter than what it is given, of which it takes more than two
    monkeypatch.setattr(connection, "REQUEST_S", 5 * pause_s)
    ask = f"GET /{path} HTTP/1.1\r\nHost: a\r\n\r\n".encode()
    with running(app) as one:
        line, got = connected(one.port, ask), 0
        began_s = time.monotonic()
        while got <= len(BIG):  # of all of it more, by its head
            part = line.recv(1_000_000)
            assert part
            got += len(part)
            time.sleep(pause_s if got < len(BIG) / 2 else 0)
        assert time.monotonic() - began_s > 2 * connection.REQUEST_S


@pytest.mark.parametrize("first", [b"0\r\n\r\n", b""])
def test_what_is_no_http_after_an_answer_is_not_told(
    app: App, first: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    head = b"GET / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n"
    with running(app) as one:
        line = connected(one.port, head + first)
        assert line.recv(12) == b"HTTP/1.1 200"
        line.sendall(b"zz\r\nzz\r\n\r\n")
        with suppress(ConnectionResetError):
            while line.recv(1000):
                pass
    assert not caplog.records


@pytest.mark.parametrize(
    "request_", [b"Content-Length: 101\r\n\r\n", b"Transfer-Encoding: chunked\r\n\r\n" + b"a\r\n0123456789\r\n" * 11]
)  # fmt: skip
def test_a_body_that_is_too_long_is_refused_before_it_has_come(app: App, request_: bytes) -> None:
    with running(app) as one:
        line = connected(one.port, b"POST /body HTTP/1.1\r\nHost: a\r\n" + request_)
        assert line.recv(12) == b"HTTP/1.1 413"
        good = b"Transfer-Encoding: chunked\r\n\r\n" + b"a\r\n0123456789\r\n" * 10 + b"0\r\n\r\n"
        line = connected(one.port, b"POST /body HTTP/1.1\r\nHost: a\r\n" + good)
        assert line.recv(12) == b"HTTP/1.1 200"


def test_so_many_are_answered_at_once_and_the_next_is_told(
    app: App, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server, "MOST_AT_ONCE", 4)
    with running(app) as one:
        ask = b"GET /wait HTTP/1.1\r\nHost: a\r\n\r\n"
        held = [connected(one.port, ask) for _ in range(3)]
        for _ in held:
            assert app.waiting.acquire(timeout=LIMIT_S)
        assert get(one.port, "/")[0] == 503
        app.go.set()
        for line in held:
            assert line.recv(12) == b"HTTP/1.1 200"
            line.close()
        until_s = time.monotonic() + LIMIT_S
        while get(one.port, "/")[0] != 200:
            assert time.monotonic() < until_s


def test_it_ends_while_somebody_waits(app: App) -> None:
    with running(app) as one:
        waits = connected(one.port, b"GET /wait HTTP/1.1\r\nHost: a\r\n\r\n")
        assert app.waiting.acquire(timeout=LIMIT_S)
        began_s = time.monotonic()
        one.shutdown()
        waits.recv(1)
        assert time.monotonic() - began_s < LIMIT_S / 2


def test_one_that_is_to_end_before_it_begins_ends_at_once(app: App) -> None:
    with WebServer(app.app, 0) as one:
        one.shutdown()
        one.serve_forever()


def test_a_port_that_is_taken_is_no_place_to_listen(app: App) -> None:
    with WebServer(app.app, 0) as one, pytest.raises(OSError, match="in use"):
        WebServer(app.app, one.port)


@pytest.mark.parametrize(
    "module", ["cratous.services.cli.run", "cratous.services.cli.job", "cratous.services.cli.serve",
               "cratous.services.cli.serve_flight", "cratous.services.requirements.metrics"],
)  # fmt: skip
def test_who_serves_nothing_loads_no_server(module: str) -> None:
    code = f"import sys, {module}; print(*{{'starlette', 'uvicorn', 'anyio', 'h11'}} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""
