"""An application at an address of this machine, served by uvicorn."""

from __future__ import annotations

import socket
from typing import Self

from starlette.types import ASGIApp
from uvicorn import Config, Server

from cratous.services.web.connection import Connection, Connections

LOOPBACK = "127.0.0.1"
MOST_AT_ONCE = 128
"""Connections, and answers that are being made; who comes beyond is told 503."""
QUEUE = 128


class WebServer:
    """Bound at once, so that clients may come; they are answered by `serve_forever`, until `shutdown`.

    port: where it listens. What goes wrong with a client is not logged: it is no concern of the others.
    """

    def __init__(
        self,
        app: ASGIApp,
        port: int,
        address: str = LOOPBACK,
        family: socket.AddressFamily = socket.AF_INET,
    ) -> None:
        """port: 0 takes a free one. Raises OSError if it cannot be had."""
        both = family == socket.AF_INET6 and socket.has_dualstack_ipv6()
        self._socket = socket.create_server(
            (address, port), family=family, backlog=QUEUE, dualstack_ipv6=both
        )
        self.port: int = self._socket.getsockname()[1]
        self._server = Server(
            Config(
                app, interface="asgi3", loop="asyncio", http=Connection, ws="none", lifespan="off",
                log_config=None, log_level="critical", access_log=False, proxy_headers=False,
                server_header=False, backlog=QUEUE, limit_concurrency=MOST_AT_ONCE,
                timeout_graceful_shutdown=0,
            )
        )  # fmt: skip
        self._server.server_state = Connections()

    def serve_forever(self) -> None:
        """Answer until `shutdown`, which may come before; in the main thread also until SIGINT or SIGTERM."""
        self._server.run([self._socket])

    def shutdown(self) -> None:
        """End `serve_forever`, from any thread or a handler of signals."""
        self._server.should_exit = True

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()
