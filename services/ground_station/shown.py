"""What the first page shows, read once, anew for each page, or from a flight."""

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
    """What is shown."""

    async def answer(self) -> Response:
        """As JSON, or why there is none; waits until that is known. Raises BadInput."""


class Recorded:
    """The recording, read in a thread of its own: the page is there at once and says that it waits."""

    def __init__(self, read: Callable[[], dict[str, Any]], failed: Callable[[Exception], None]):
        """read: gives the recording or raises BadInput; failed: is told why there is none."""
        self._read, self._failed = read, failed
        self._told = Future[tuple[bytes, int]]()
        self._told.set_running_or_notify_cancel()  # who waits for it may go, and cancels nothing
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
    """What is read each time that a page opens."""

    def __init__(self, read: Callable[[], dict[str, Any]]) -> None:
        """read: gives it or raises BadInput."""
        self._read = read

    async def answer(self) -> Response:
        """See `Recording`."""
        return json_answer(await in_thread(self._read))


class LiveRecorded:
    """A mission that is flown: what it says, and once the flight has ended, its results."""

    def __init__(self, live: LiveSession, replay: Callable[[str], Recorded]) -> None:
        """replay: of a folder of results."""
        self._live, self._replay = live, replay
        self._results: Recorded | None = None

    async def answer(self) -> Response:
        """See `Recording`."""
        if self._live.status["state"] == "ended":
            self._results = self._results or self._replay(self._live.status["folder"])
            return await self._results.answer()
        return json_answer({**await in_thread(self._live.begun), "live": True})
