"""A connection of an HTTP client: uvicorn's, with the three limits that uvicorn has not.

A client has a time for its whole request, and when too many clients have asked nothing yet, the one that has been so
longest is cut off, so that silent clients take nobody's place. One that does not read its answers is cut off, too.
What uvicorn limits itself is said in `server`.
"""

from __future__ import annotations

import asyncio

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.server import ServerState

REQUEST_S = 10.0
"""So long a client may take for its request."""
MOST_SILENT = 32
"""Connections without a whole request."""
MOST_UNREAD = 1 << 20
"""Of a request that is answered already [bytes]."""
LEAST_READ = 1 << 14
"""Of answers, in REQUEST_S [bytes]."""


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
    reading: asyncio.TimerHandle | None = None
    """When it has to have read more of its answers; None while nearly all of them are sent."""

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

    def pause_writing(self) -> None:
        super().pause_writing()
        self._wait_for_reader()
        self._look()

    def resume_writing(self) -> None:
        self._has_read()
        super().resume_writing()
        self._look()

    def connection_lost(self, exc: Exception | None) -> None:
        super().connection_lost(exc)
        self._has_read()
        self._is_heard()

    def send_400_response(self, msg: str) -> None:
        if self.conn.our_state in (h11.IDLE, h11.SEND_RESPONSE):
            super().send_400_response(msg)
        else:  # what is no HTTP follows an answer
            self.transport.abort()

    def _wait_for_reader(self) -> None:
        left = self.transport.get_write_buffer_size()
        self.reading = self.loop.call_later(REQUEST_S, self._look_whether_read, left)

    def _look_whether_read(self, before: int) -> None:
        if before - self.transport.get_write_buffer_size() < LEAST_READ:
            self.transport.abort()
        else:
            self._wait_for_reader()

    def _has_read(self) -> None:
        if self.reading is not None:
            self.reading.cancel()
            self.reading = None

    def _look(self) -> None:
        """Hold against it that it has asked nothing, unless it has, or is still reading what it asked for."""
        silent = self.server_state.silent
        asked = self.cycle is not None and not (
            self.cycle.more_body or self.cycle.response_complete
        )
        if asked or self.reading is not None:
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
