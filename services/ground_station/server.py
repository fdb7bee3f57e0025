"""HTTP server of the page and its data, a recording or two, on the loopback interface unless
configured otherwise.

It answers only requests whose Host header names this server, since a foreign page could reach it
under a name of its own (DNS rebinding). On addresses other than 127.0.0.1 every request needs a
token (`guard`). It serves the page and the recording, and no file by a name from outside. For a
replay it accepts only GET and HEAD; while a mission is flown or edited also commands, from its own
page (Origin) with their token.
"""

from __future__ import annotations

import json
import mimetypes
import os
from collections.abc import Awaitable, Callable, Mapping
from importlib.resources import files
from types import MappingProxyType
from typing import Any, NamedTuple, Protocol

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import Request
from starlette.responses import FileResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from cratous.services.ground_station.access import Access
from cratous.services.ground_station.background import Beneath
from cratous.services.ground_station.guard import Guard
from cratous.services.ground_station.live_session import NotObeyed
from cratous.services.ground_station.page_data import Recording
from cratous.services.web.answers import body_of, in_thread, json_answer
from cratous.services.web.server import WebServer
from cratous.spec.errors import BadInput

LONGEST = 1000
"""Maximum size of a command [bytes]."""
PAGE, PAGE_OF_TWO, PAGE_OF_EDITOR = "index.html", "compare.html", "edit.html"
Order = Callable[[str, str, Any], dict[str, Any] | None]
"""Executes the order of a page, given its token and number; returns its answer, if any. Raises NotObeyed."""
Endpoint = Callable[[Request], Awaitable[Response]]
TYPES = {
    ".css": "text/css", ".html": "text/html", ".js": "text/javascript", ".png": "image/png",
    ".svg": "image/svg+xml",
}  # fmt: skip
"""Media types of the page's files, independent of the machine's tables."""


class Watched(Protocol):
    """Source of live data: a CRATOUS flight, or a running system; token: required for its orders."""

    token: str

    def told(self, first: int) -> dict[str, Any]:
        """The updates from a given number on, and the current status."""

    def who(self, token: str, page: str) -> str:
        """Role of the asking page."""

    def order(self, token: str, page: str, asked: Any) -> None:
        """Execute a command of a page. Raises NotObeyed, with the reason."""


class Commands(NamedTuple):
    """Requests that pages may make. orders: handlers by path; longest: maximum size of an order
    [bytes]; polled: data that pages may poll, by path; token: required by every order, and part of
    the printed address.
    """

    orders: Mapping[str, Order]
    longest: int = LONGEST
    polled: Mapping[str, Callable[[], dict[str, Any]]] = MappingProxyType({})
    token: str = ""


class GroundStation(WebServer):
    """The server; `serve_forever` answers until `shutdown`."""

    def __init__(
        self,
        recorded: Recording,
        port: int,
        access: Access,
        live: Watched | None = None,
        first: str = PAGE,
        commands: Commands | None = None,
    ) -> None:
        """port: 0 takes a free one; access: listening address and access control; live: the flight
        shown, if any; first: name of the first page; commands: permitted requests, by default those
        of the flight. Raises BadInput if the port is unavailable.
        """
        if commands is None:
            orders = {"/command": live.order} if live is not None and live.token else {}
            commands = Commands(orders, token="" if live is None else live.token)
        self.recorded, self.access = recorded, access
        self.beneath = Beneath()
        """Background of the map."""
        routes = [
            Route("/", _page(first)),
            Route("/recording.json", self._recording),
            *(Route(path, self._beneath) for path in ("/overlays.json", "/tiles.json")),
            *([] if live is None else [Route("/live.json", _told(live))]),
            *(Route(path, _polled(read)) for path, read in commands.polled.items()),
            *(
                Route(path, _order(obey, commands.longest), methods=["POST"])
                for path, obey in commands.orders.items()
            ),
            Mount("/", _Parts(packages=[(str(__package__), "page")])),
        ]
        app = Starlette(
            routes=routes,
            middleware=[Middleware(GZipMiddleware, compresslevel=3)],
            exception_handlers=_HANDLERS,
        )
        guarded = Guard(app, access, lambda: self.beneath.images)
        try:
            super().__init__(guarded, port, access.address, access.family)
        except OSError as error:
            raise BadInput(
                "cannot listen there", item="--port", expected=f"a free port of {access.host}",
                got=f"{port}: {os.strerror(error.errno or 0)}",
            ) from None  # fmt: skip
        self.url = access.url(self.port)
        self.whole_url = access.whole_url(self.port, commands.token)

    async def _recording(self, _: Request) -> Response:
        return await self.recorded.answer()

    async def _beneath(self, request: Request) -> Response:
        asked = request.url
        found = await in_thread(self.beneath.answer, asked.path, asked.query)
        if found is None:
            raise HTTPException(404)
        return json_answer(found)


def _page(name: str) -> Endpoint:
    for end, kind in TYPES.items():
        mimetypes.add_type(kind, end)

    async def answer(_: Request) -> Response:
        return FileResponse(str(files(__package__).joinpath("page", name)))

    return answer


class _Parts(StaticFiles):
    """The files that pages load; the pages themselves are not among them, only the one at `/` is served."""

    def get_path(self, scope: Scope) -> str:
        if (path := super().get_path(scope)) in (PAGE, PAGE_OF_TWO, PAGE_OF_EDITOR):
            raise HTTPException(404)
        return path


def _sender(request: Request) -> tuple[str, str]:
    """Token and number of the page, as sent by it."""
    headers = request.headers
    return headers.get("x-cratous-token", ""), headers.get("x-cratous-page", "")[:64]


def _told(live: Watched) -> Endpoint:
    """New data of the flight, from an update number on."""

    async def answer(request: Request) -> Response:
        first = request.query_params.get("from", "0")
        if not (first.isascii() and first.isdigit() and len(first) < 10):
            raise HTTPException(
                400, f"expected from=N, the number of an update; got {first[:20]!r}"
            )
        told = await in_thread(live.told, int(first))
        return json_answer({**told, "who": live.who(*_sender(request))})

    return answer


def _polled(read: Callable[[], dict[str, Any]]) -> Endpoint:
    async def answer(_: Request) -> Response:
        return json_answer(await in_thread(read))

    return answer


def _order(obey: Order, longest: int) -> Endpoint:
    """Handles a command of a page."""

    async def answer(request: Request) -> Response:
        headers = request.headers
        if request.url.query:  # a token in the address is not accepted for commands
            raise HTTPException(404)
        if headers.get("origin") != f"http://{headers['host'].lower()}":
            raise HTTPException(403, "commands come from this page alone")
        if headers.get("content-type") != "application/json":
            raise HTTPException(415, "expected JSON")
        content = await body_of(request, longest)
        try:
            asked = json.loads(content)
        except (ValueError, RecursionError):
            raise HTTPException(400, "this is no JSON") from None
        done = await in_thread(obey, *_sender(request), asked)
        return json_answer({"done": True} if done is None else done)

    return answer


async def _not_there(_: Request, error: Exception) -> Response:
    return json_answer({"error": "there is no such page"}, 404)


async def _refused(_: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    return json_answer({"error": error.detail}, error.status_code, **(error.headers or {}))


async def _not_obeyed(_: Request, error: Exception) -> Response:
    assert isinstance(error, NotObeyed)
    return json_answer({"error": error.why}, error.status)


async def _bad_input(_: Request, error: Exception) -> Response:
    assert isinstance(error, BadInput)
    return json_answer(error.data(), 422)


async def _failed(_: Request, error: Exception) -> Response:
    told = f"internal error of CRATOUS: {type(error).__name__}: {error}"
    return json_answer({"error": told}, 500)


_HANDLERS: dict[Any, Callable[[Request, Exception], Awaitable[Response]]] = {
    404: _not_there, HTTPException: _refused, NotObeyed: _not_obeyed, BadInput: _bad_input,
    Exception: _failed,
}  # fmt: skip
