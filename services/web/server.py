"""Runs an application at a local address, with uvicorn."""

from __future__ import annotations

import asyncio
import socket
from contextlib import suppress
from types import FrameType
from typing import Self

from starlette.types import ASGIApp
from uvicorn import Config, Server

from cratous.services.web.connection import Connection, Connections

LOOPBACK = "127.0.0.1"
MOST_AT_ONCE = 128
"""Maximum number of connections and of responses in preparation; beyond it clients get status 503."""
QUEUE = 128
TICK_S = 1.0
"""Interval at which uvicorn updates the date header [s]."""


class _Server(Server):
    """Ends when notified, instead of uvicorn's polling ten times a second."""

    _told: tuple[asyncio.AbstractEventLoop, asyncio.Event] | None = None

    async def main_loop(self) -> None:
        ended = asyncio.Event()
        self._told = asyncio.get_running_loop(), ended
        while not await self.on_tick(0):
            with suppress(TimeoutError):
                async with asyncio.timeout(TICK_S):
                    await ended.wait()

    def end(self) -> None:
        """End the server, from any thread or a signal handler."""
        self.should_exit = True
        if self._told is not None:
            loop, ended = self._told
            with suppress(RuntimeError):  # the loop has already ended
                loop.call_soon_threadsafe(ended.set)

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        super().handle_exit(sig, frame)
        self.end()


class WebServer:
    """The socket is bound on creation, so that clients can connect; `serve_forever` answers them
    until `shutdown`.

    port: the listening port. Errors of a client are not logged: they do not concern the others.
    """

    def __init__(
        self,
        app: ASGIApp,
        port: int,
        address: str = LOOPBACK,
        family: socket.AddressFamily = socket.AF_INET,
    ) -> None:
        """port: 0 takes a free one. Raises OSError if it is unavailable."""
        both = family == socket.AF_INET6 and socket.has_dualstack_ipv6()
        self._socket = socket.create_server(
            (address, port), family=family, backlog=QUEUE, dualstack_ipv6=both
        )
        self.port: int = self._socket.getsockname()[1]
        self._server = _Server(
            Config(
                app, interface="asgi3", loop="asyncio", http=Connection, ws="none", lifespan="off",
                log_config=None, log_level="critical", access_log=False, proxy_headers=False,
                server_header=False, backlog=QUEUE, limit_concurrency=MOST_AT_ONCE,
                timeout_graceful_shutdown=0,
            )
        )  # fmt: skip
        self._server.server_state = Connections()

    def serve_forever(self) -> None:
        """Answer until `shutdown`, which may be called before; in the main thread also until SIGINT or SIGTERM."""
        self._server.run([self._socket])

    def shutdown(self) -> None:
        """End `serve_forever`, from any thread or a signal handler."""
        self._server.end()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()
