"""Worker process: passes a task to its flier, unless the task is of another version."""

from __future__ import annotations

import atexit
import threading
from typing import Any

from cratous.services.campaign.flight_worker import Flier

_own = threading.local()


def attempt(task: dict[str, Any]) -> dict[str, Any]:
    """One attempt at a run: `{"result"}`, `{"lost"}`, or `{"other version"}`.

    task: function and memory_mb of the flier, time_s, the caller's version, and the run to fly
    (`run`).
    """
    flier = _flier(task["function"], task["memory_mb"])
    lost = flier.begin()
    if lost:
        return {"lost": lost}
    if flier.version != task["version"]:
        return {"other version": flier.version}
    return flier.fly(task["run"], task["time_s"])


def _flier(function: str, memory_mb: int) -> Flier:
    """The flier of this thread: a worker with several threads has several."""
    made = getattr(_own, "made", None)
    if made is None or made[:2] != (function, memory_mb):
        if made is not None:
            made[2].end()
        made = (function, memory_mb, Flier(function, memory_mb))
        atexit.register(made[2].end)
        _own.made = made
    flier: Flier = made[2]
    return flier


def end() -> None:
    """End the flier of this thread."""
    made = getattr(_own, "made", None)
    if made is not None:
        made[2].end()
        _own.made = None
