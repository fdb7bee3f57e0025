"""A connection of an HTTP client: uvicorn's, with three additional limits.

A client has a time limit for its whole request. If too many clients have sent no request yet, the
oldest of them is disconnected, so that silent clients block nobody. A client that does not read its
responses is disconnected too. uvicorn's own limits are set in `server`.
"""

from __future__ import annotations

import asyncio

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.server import ServerState

REQUEST_S = 10.0
"""Time limit for a client's request [s]."""
MOST_SILENT = 32
"""Maximum number of connections without a complete request."""
MOST_UNREAD = 1 << 20
"""Maximum amount of a request body that arrives after its response [bytes]."""
LEAST_READ = 1 << 14
"""Minimum amount of response data that a client has to read in REQUEST_S [bytes]."""


class Connections(ServerState):
    """silent: connections without a complete request, oldest first, each with the timer that disconnects it."""

    def __init__(self) -> None:
        super().__init__()
        self.silent: dict[Connection, asyncio.TimerHandle] = {}


class Connection(H11Protocol):
    """The connection of one client."""

    server_state: Connections
    unread = 0
    """Amount of the request body received after its response [bytes]."""
    reading: asyncio.TimerHandle | None = None
    """Timer by which it has to read more response data; None unless the write buffer is full."""

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
        else:  # data that are not HTTP after a response
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
        """Start the time limit for a request, or stop it if a request is being answered or its
        response is being read.
        """
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
