"""A connection of an HTTP client: uvicorn's, with the two limits that uvicorn has not.

A client has a time for its whole request, and when too many clients have asked nothing yet, the one that has been so
longest is cut off, so that silent clients take nobody's place. What uvicorn limits itself is said in `server`.
"""

from __future__ import annotations

import asyncio

from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.server import ServerState

REQUEST_S = 10.0
"""So long a client may take for its request."""
MOST_SILENT = 32
"""Connections without a whole request."""
MOST_UNREAD = 1 << 20
"""Of a request that is answered already [bytes]."""


class Connections(ServerState):
    """silent: the connections that have no whole request yet, the oldest first, and when each is cut off."""

    def __init__(self) -> None:
        super().__init__()
        self.silent: dict[Connection, asyncio.TimerHandle] = {}


class Connection(H11Protocol):
    """One client."""

    server_state: Connections
    unread = 0
    """Of the request that is answered already [bytes]."""

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._look()

    def data_received(self, data: bytes) -> None:
        if self.cycle is not None and self.cycle.response_complete and self.cycle.more_body:
            self.unread += len(data)
            if self.unread > MOST_UNREAD:
                self.transport.abort()
                return
        super().data_received(data)
        self._look()

    def on_response_complete(self) -> None:
        self.unread = 0
        super().on_response_complete()
        self._look()

    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(exc)
        self._is_heard()

    def _look(self) -> None:
        """Hold against it that it has asked nothing, unless it has."""
        silent = self.server_state.silent
        asked = self.cycle is not None and not (
            self.cycle.more_body or self.cycle.response_complete
        )
        if asked or self.transport.is_closing():
            self._is_heard()
        elif self not in silent:
            silent[self] = self.loop.call_later(REQUEST_S, self.transport.abort)
            if len(silent) > MOST_SILENT:
                oldest = next(iter(silent))
                oldest._is_heard()
                oldest.transport.abort()

    def _is_heard(self) -> None:
        due = self.server_state.silent.pop(self, None)
        if due is not None:
            due.cancel()
