"""Serves the page and what it shows, a recording or two, over HTTP, to this machine alone unless asked otherwise.

It answers only requests whose Host header names it as it is called, since a page of somewhere else could reach it
under a name of its own (DNS rebinding). At another address than 127.0.0.1 whatever is asked needs a token (`access`).
It gives out the page and the recording, and nothing of the disk by a name from outside. Of a replay it takes GET and
HEAD alone; while a mission is flown or edited, commands too, from its own page (Origin) with their token.
"""

from __future__ import annotations

import gzip
import json
import socket
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from socketserver import TCPServer
from types import MappingProxyType
from typing import Any, NamedTuple, Protocol
from urllib.parse import parse_qs

from cratous.services.ground_station.access import BEARER, Access
from cratous.services.ground_station.beneath import Beneath
from cratous.services.ground_station.live_session import LiveSession, NotObeyed
from cratous.spec.errors import BadInput
from cratous.spec.files.printable import json_text

REQUEST_S = 10.0
"""So long a client may take for its request."""
MOST_AT_ONCE = 32
LONGEST = 1000
"""Of a command [bytes]."""
PAGE, PAGE_OF_TWO, PAGE_OF_EDITOR = "index.html", "compare.html", "edit.html"
Order = Callable[[str, str, Any], dict[str, Any] | None]
"""Obeys what a page asks for, by its token and number; its answer, if there is one. Raises NotObeyed."""
TYPES = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml",
}
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self'{images}; connect-src 'self'; base-uri 'none'; form-action 'none'; "
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


def page_files(first: str = PAGE) -> dict[str, Answer]:
    """The files of the page by their path; first: of PAGES, which `/` is."""
    found = {}
    for file in files(__package__).joinpath("page").iterdir():
        kind = TYPES.get(file.name.rpartition(".")[2])
        if kind is not None:
            found[f"/{file.name}"] = Answer(HTTPStatus.OK, kind, file.read_bytes())
    pages = {page: found.pop(f"/{page}") for page in (PAGE, PAGE_OF_TWO, PAGE_OF_EDITOR)}
    return {**found, "/": pages[first]}


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


class Recording(Protocol):
    """What is shown."""

    def answer(self) -> Answer:
        """As JSON, or why there is none; waits until that is known."""


class ReadAnew:
    """What is read each time that a page opens."""

    def __init__(self, read: Callable[[], dict[str, Any]]) -> None:
        """read: gives it or raises BadInput."""
        self._read = read

    def answer(self) -> Answer:
        """See `Recording`."""
        try:
            return _json(HTTPStatus.OK, self._read())
        except BadInput as error:
            return _json(HTTPStatus.UNPROCESSABLE_ENTITY, error.data())


class LiveRecorded:
    """A mission that is flown: what it says, and once the flight has ended, its results."""

    def __init__(self, live: LiveSession, replay: Callable[[str], Recorded]) -> None:
        """replay: of a folder of results."""
        self._live, self._replay = live, replay
        self._results: Recorded | None = None
        self._opening = threading.Lock()

    def answer(self) -> Answer:
        """See `Recording`."""
        if self._live.status["state"] == "ended":
            with self._opening:
                self._results = self._results or self._replay(self._live.status["folder"])
            return self._results.answer()
        try:
            return _json(HTTPStatus.OK, {**self._live.begun(), "live": True})
        except BadInput as error:
            return _json(HTTPStatus.UNPROCESSABLE_ENTITY, error.data())


class Watched(Protocol):
    """What is shown while it happens: a flight of ours, or a running system; token: what its orders need."""

    token: str

    def told(self, first: int) -> dict[str, Any]:
        """The updates from a given number on, and the present status."""

    def who(self, token: str, page: str) -> str:
        """What a page may do that asks."""

    def order(self, token: str, page: str, asked: Any) -> None:
        """Obey a command of a page. Raises NotObeyed, with why."""


class Commands(NamedTuple):
    """What pages may send. orders: what answers them, by path; longest: the most bytes of an order; polled: what pages may
    read again and again, by path; token: every order needs it, and the printed address contains it."""

    orders: Mapping[str, Order]
    longest: int = LONGEST
    polled: Mapping[str, Callable[[], dict[str, Any]]] = MappingProxyType({})
    token: str = ""


class GroundStation(ThreadingHTTPServer):
    """The server; `serve_forever` answers until `shutdown`."""

    daemon_threads = True
    request_queue_size = 128

    def __init__(
        self,
        recorded: Recording,
        port: int,
        access: Access,
        live: Watched | None = None,
        first: str = PAGE,
        commands: Commands | None = None,
    ) -> None:
        """port: 0 takes a free one; access: where it listens and who is let in; live: the flight that is shown, if any;
        first: which page shows it; commands: what pages may ask for, by default those of the flight. Raises
        BadInput if the port cannot be had."""
        self.recorded, self.live, self.pages = recorded, live, page_files(first)
        if commands is None:
            orders = {"/command": live.order} if live is not None and live.token else {}
            commands = Commands(orders, token="" if live is None else live.token)
        self.commands, self.token = commands, commands.token
        self.beneath = Beneath()
        """What the map shows beneath all else."""
        self.access = access
        self.address_family = self.access.family
        self._places = threading.Semaphore(MOST_AT_ONCE)
        self._asking: dict[Any, None] = {}
        self._lock = threading.Lock()
        try:
            super().__init__((self.access.address, port), _Handler)
        except OSError as error:
            raise BadInput(
                "cannot listen there", item="--port", expected=f"a free port of {self.access.host}",
                got=f"{port}: {error.strerror}",
            ) from None  # fmt: skip
        self.url = self.access.url(self.server_port)
        self.whole_url = self.access.whole_url(self.server_port, self.token)

    def server_bind(self) -> None:
        TCPServer.server_bind(self)  # that of HTTPServer asks name servers who this is
        self.server_name, self.server_port = self.access.host, self.server_address[1]

    def process_request(self, request: Any, client_address: Any) -> None:
        if not self._places.acquire(blocking=False):
            self._cut_off()
            self._places.acquire()  # further clients wait in the queue of the socket
        with self._lock:
            self._asking[request] = None
        super().process_request(request, client_address)

    def _cut_off(self) -> None:
        """Disconnect the client whose request has been pending longest, so that idle clients cannot take all places."""
        with self._lock:
            oldest = next(iter(self._asking), None)
            if oldest is not None:
                del self._asking[oldest]
                with suppress(OSError):  # it is gone already
                    oldest.shutdown(socket.SHUT_RDWR)

    def asked(self, request: Any) -> None:
        """A client has sent its request."""
        with self._lock:
            self._asking.pop(request, None)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.asked(request)
            self._places.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A client that went away is no concern of the others."""


class _Handler(BaseHTTPRequestHandler):
    """One request of one client."""

    server: GroundStation
    timeout = REQUEST_S
    server_version, sys_version = "cratous", ""
    shown: str | None = None
    """How the request shows the token."""

    def parse_request(self) -> bool:
        whole = super().parse_request()
        if whole and self.command != "POST":  # of which the body is still to come
            self.server.asked(self.connection)
        return whole

    def do_GET(self) -> None:
        self._send(self._found(), body=True)

    def do_HEAD(self) -> None:
        self._send(self._found(), body=False)

    def do_POST(self) -> None:
        self.close_connection = True
        refused = self._refused()
        if refused is None and not self.server.commands.orders:
            self.send_error(HTTPStatus.NOT_IMPLEMENTED)
            return
        self._send(refused or self._order(), body=True)

    def _refused(self) -> Answer | None:
        """The refusal of a request that calls the server by another name, or without the token; None for its own."""
        access, port = self.server.access, self.server.server_port
        hosts = self.headers.get_all("Host", [])
        if not access.called(hosts, self.connection.getsockname(), port):
            told = f"this server is {self.server.url} and answers to no other name"
            return _json(HTTPStatus.MISDIRECTED_REQUEST, {"error": told})
        if not access.token:
            return None
        self.shown = access.shown_by(self.headers, self.path.partition("?")[2], port)
        if self.shown is None:
            told = (
                "this server needs the token of the address that was printed where it was started"
            )
            return _json(HTTPStatus.UNAUTHORIZED, {"error": told})
        return None

    def _order(self) -> Answer:
        """A command of a page."""
        obey, longest = self.server.commands.orders.get(self.path), self.server.commands.longest
        if obey is None:
            return _json(HTTPStatus.NOT_FOUND, {"error": "there is no such page"})
        if self.headers.get("Origin", "") != f"http://{self.headers['Host'].lower()}":
            return _json(HTTPStatus.FORBIDDEN, {"error": "commands come from this page alone"})
        if self.headers.get("Content-Type") != "application/json":
            return _json(HTTPStatus.UNSUPPORTED_MEDIA_TYPE, {"error": "expected JSON"})
        length = self.headers.get("Content-Length", "")
        if not (
            length.isascii()
            and length.isdigit()
            and len(length) < 10
            and 0 < int(length) <= longest
        ):
            told = f"expected 1 to {longest} bytes, with Content-Length"
            return _json(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, {"error": told})
        try:
            content = self.rfile.read(int(length))
            self.server.asked(self.connection)
            asked = json.loads(content)
        except (ValueError, RecursionError):
            return _json(HTTPStatus.BAD_REQUEST, {"error": "this is no JSON"})
        try:
            answer = obey(*self._sender(), asked)
        except NotObeyed as refused:
            return _json(HTTPStatus(refused.status), {"error": refused.why})
        except BadInput as error:
            return _json(HTTPStatus.UNPROCESSABLE_ENTITY, error.data())
        except Exception as error:
            told = f"internal error of CRATOUS: {type(error).__name__}: {error}"
            return _json(HTTPStatus.INTERNAL_SERVER_ERROR, {"error": told})
        return _json(HTTPStatus.OK, {"done": True} if answer is None else answer)

    def _sender(self) -> tuple[str, str]:
        """Token and number of the page, as it gives them."""
        return self.headers.get("X-Cratous-Token", ""), self.headers.get("X-Cratous-Page", "")[:64]

    def _told(self, live: Watched, query: str) -> Answer:
        """What is new of the flight, from the number of an update on."""
        first = parse_qs(query).get("from", ["0"])[0]
        if not (first.isascii() and first.isdigit() and len(first) < 10):
            told = f"expected from=N, the number of an update; got {first[:20]!r}"
            return _json(HTTPStatus.BAD_REQUEST, {"error": told})
        return _json(HTTPStatus.OK, {**live.told(int(first)), "who": live.who(*self._sender())})

    def _found(self) -> Answer:
        refused = self._refused()
        if refused is not None:
            return refused
        path, _, query = self.path.partition("?")
        if path == "/recording.json":
            return self.server.recorded.answer()
        if path == "/live.json" and self.server.live is not None:
            return self._told(self.server.live, query)
        try:
            beneath = self.server.beneath.answer(path, query)
        except NotObeyed as refused_:
            return _json(HTTPStatus(refused_.status), {"error": refused_.why})
        except BadInput as error:
            return _json(HTTPStatus.UNPROCESSABLE_ENTITY, error.data())
        if beneath is not None:
            return _json(HTTPStatus.OK, beneath)
        if path in self.server.commands.polled:
            return _json(HTTPStatus.OK, self.server.commands.polled[path]())
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
        if answer.status is HTTPStatus.UNAUTHORIZED:
            self.send_header("WWW-Authenticate", BEARER.strip())
        if self.shown == "address":
            self.send_header("Set-Cookie", self.server.access.kept(self.server.server_port))
        self.end_headers()
        if body:
            self.wfile.write(content)

    def end_headers(self) -> None:
        images = self.server.beneath.images
        for name, value in HEADERS.items():
            self.send_header(name, value.format(images=f" {images}" if images else ""))
        super().end_headers()

    def log_message(self, format: str, *args: Any) -> None:
        """Requests are not told on the terminal."""
