"""Serves the page and one recording over HTTP, to this machine alone.

It listens on 127.0.0.1 and answers only requests whose Host header names it so, since a page of
somewhere else could reach it under a name of its own (DNS rebinding). It takes GET and HEAD alone,
gives out the files of the page and the recording, and nothing of the disk by a name from outside.
"""

from __future__ import annotations

import gzip
import threading
from collections.abc import Callable
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from typing import Any, NamedTuple

from cratous.spec.errors import BadInput
from cratous.spec.files.printable import json_text

HOST = "127.0.0.1"
REQUEST_S = 10.0
"""So long a client may take for its request."""
MOST_AT_ONCE = 32
TYPES = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml",
}
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Answer(NamedTuple):
    """A whole answer; packed: the body by gzip, for who takes that."""

    status: HTTPStatus
    kind: str
    body: bytes
    packed: bytes | None = None


def page_files() -> dict[str, Answer]:
    """The files of the page by their path."""
    found = {}
    for file in files(__package__).joinpath("page").iterdir():
        kind = TYPES.get(file.name.rpartition(".")[2])
        if kind is not None:
            found[f"/{file.name}"] = Answer(HTTPStatus.OK, kind, file.read_bytes())
    found["/"] = found.pop("/index.html")
    return found


class Recorded:
    """The recording, read in a thread of its own: the page is there at once and says that it waits."""

    def __init__(self, read: Callable[[], dict[str, Any]], failed: Callable[[Exception], None]):
        """read: gives the recording or raises BadInput; failed: is told why there is none."""
        self._read, self._failed = read, failed
        self._answer: Answer | None = None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            self._answer = _json(HTTPStatus.OK, self._read())
        except BadInput as error:
            self._answer = _json(HTTPStatus.UNPROCESSABLE_ENTITY, error.data())
            self._failed(error)
        except Exception as error:
            told = f"internal error of CRATOUS: {type(error).__name__}: {error}"
            self._answer = _json(HTTPStatus.INTERNAL_SERVER_ERROR, {"error": told})
            self._failed(error)

    def answer(self) -> Answer:
        """The recording as JSON, or why there is none; waits until that is known."""
        self._thread.join()
        assert self._answer is not None
        return self._answer


def _json(status: HTTPStatus, data: dict[str, Any]) -> Answer:
    body = json_text(data).encode()
    return Answer(status, "application/json", body, gzip.compress(body, 3))


class GroundStation(ThreadingHTTPServer):
    """The server; `serve_forever` answers until `shutdown`."""

    daemon_threads = True

    def __init__(self, recorded: Recorded, port: int) -> None:
        """port: 0 takes a free one. Raises BadInput if it cannot be had."""
        self.recorded, self.pages = recorded, page_files()
        self._places = threading.Semaphore(MOST_AT_ONCE)
        try:
            super().__init__((HOST, port), _Handler)
        except OSError as error:
            raise BadInput(
                "cannot listen there", item="--port", expected="a free port of this machine",
                got=f"{port}: {error.strerror}",
            ) from None  # fmt: skip
        number = self.server_address[1]
        self.names = {f"{name}:{number}" for name in (HOST, "localhost")}
        self.url = f"http://{HOST}:{number}/"

    def process_request(self, request: Any, client_address: Any) -> None:
        self._places.acquire()  # further clients wait in the queue of the socket
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._places.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A client that went away is no concern of the others."""


class _Handler(BaseHTTPRequestHandler):
    """One request of one client."""

    server: GroundStation
    timeout = REQUEST_S
    server_version, sys_version = "cratous", ""

    def do_GET(self) -> None:
        self._send(self._found(), body=True)

    def do_HEAD(self) -> None:
        self._send(self._found(), body=False)

    def _found(self) -> Answer:
        hosts = self.headers.get_all("Host", [])
        if len(hosts) != 1 or hosts[0].lower() not in self.server.names:
            told = f"this server is {self.server.url} and answers to no other name"
            return _json(HTTPStatus.MISDIRECTED_REQUEST, {"error": told})
        path = self.path.partition("?")[0]
        if path == "/recording.json":
            return self.server.recorded.answer()
        found = self.server.pages.get(path)
        return found or _json(HTTPStatus.NOT_FOUND, {"error": "there is no such page"})

    def _send(self, answer: Answer, body: bool) -> None:
        packed = answer.packed is not None and "gzip" in self.headers.get("Accept-Encoding", "")
        content = answer.packed if packed and answer.packed is not None else answer.body
        self.send_response(answer.status)
        self.send_header("Content-Type", answer.kind)
        self.send_header("Content-Length", str(len(content)))
        if packed:
            self.send_header("Content-Encoding", "gzip")
        self.end_headers()
        if body:
            self.wfile.write(content)

    def end_headers(self) -> None:
        for name, value in HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def log_message(self, format: str, *args: Any) -> None:
        """Requests are not told on the terminal."""
