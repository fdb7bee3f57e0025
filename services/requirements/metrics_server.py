"""Serves the metrics of a watch over HTTP, on the loopback interface only."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

from cratous.services.web.server import LOOPBACK, WebServer
from cratous.spec.errors import BadInput

KIND = "text/plain; version=0.0.4; charset=utf-8"


@contextmanager
def served(port: int, text: Callable[[], str]) -> Iterator[int]:
    """Serve the text at http://127.0.0.1:PORT/metrics inside the block; yields the port (0 takes a free one)."""

    async def metrics(_: Request) -> Response:
        return Response(text(), headers={"Content-Type": KIND})

    try:
        server = WebServer(Starlette(routes=[Route("/metrics", metrics)]), port)
    except OSError as error:
        raise BadInput(
            "cannot listen", where=f"{LOOPBACK}:{port}", item="--metrics",
            expected="a free port of this machine", got=os.strerror(error.errno or 0),
        ) from None  # fmt: skip
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    with server:
        thread.start()
        try:
            yield server.port
        finally:
            server.shutdown()
            thread.join()
