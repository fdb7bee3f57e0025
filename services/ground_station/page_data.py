"""Data of the first page: read once, read again for each page, or from a flight."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Protocol

from starlette.responses import Response

from cratous.services.ground_station.live_session import LiveSession
from cratous.services.web.answers import JSON, in_thread, json_answer, json_bytes
from cratous.spec.errors import BadInput


class Recording(Protocol):
    """Source of the displayed data."""

    async def answer(self) -> Response:
        """The JSON response, or the reason for its absence; waits until it is known. Raises BadInput."""


class Recorded:
    """Reads the recording in its own thread: the page opens immediately and shows that it waits."""

    def __init__(self, read: Callable[[], dict[str, Any]], failed: Callable[[Exception], None]):
        """read: returns the recording or raises BadInput; failed: called with the reason if there is none."""
        self._read, self._failed = read, failed
        self._told = Future[tuple[bytes, int]]()
        self._told.set_running_or_notify_cancel()  # a disconnecting client cancels nothing
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        try:
            self._told.set_result((json_bytes(self._read()), 200))
        except BadInput as error:
            self._told.set_result((json_bytes(error.data()), 422))
            self._failed(error)
        except Exception as error:
            told = f"internal error of CRATOUS: {type(error).__name__}: {error}"
            self._told.set_result((json_bytes({"error": told}), 500))
            self._failed(error)

    async def answer(self) -> Response:
        """See `Recording`."""
        body, status = await asyncio.wrap_future(self._told)
        return Response(body, status, media_type=JSON)


class ReadAnew:
    """Data that are read again each time a page opens."""

    def __init__(self, read: Callable[[], dict[str, Any]]) -> None:
        """read: returns the data or raises BadInput."""
        self._read = read

    async def answer(self) -> Response:
        """See `Recording`."""
        return json_answer(await in_thread(self._read))


class LiveRecorded:
    """A mission in flight: its data and, after the end of the flight, its results."""

    def __init__(self, live: LiveSession, replay: Callable[[str], Recorded]) -> None:
        """replay: returns the recording of a results folder."""
        self._live, self._replay = live, replay
        self._results: Recorded | None = None

    async def answer(self) -> Response:
        """See `Recording`."""
        if self._live.status["state"] == "ended":
            self._results = self._results or self._replay(self._live.status["folder"])
            return await self._results.answer()
        return json_answer({**await in_thread(self._live.begun), "live": True})
