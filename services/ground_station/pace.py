"""Pacing of a flight: paused, single steps, or at a multiple of real time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

RATES = (0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0)
STEP_MS = 1000


class Ended(Exception):
    """The flight has to stop."""


class Pace:
    """Paces a flight. `wait` is called by the flight, everything else by the operator's side.

    A flight that falls behind its rate does not catch up later. It starts paused.
    """

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._rate, self._paused, self._ended = 1.0, True, False
        self._now_ms, self._until_ms = 0, 0
        self._since: tuple[float, int] | None = None
        """Reference for the rate: clock [s] and flight time [ms]."""

    @property
    def rate(self) -> float:
        """Seconds of flight per second of the clock."""
        return self._rate

    @property
    def paused(self) -> bool:
        """Whether the flight is paused, or will be after its step."""
        return self._paused

    def play(self) -> None:
        """Resume at the current rate."""
        with self._changed:
            self._paused, self._since = False, None
            self._changed.notify_all()

    def pause(self) -> None:
        """Pause the flight."""
        with self._changed:
            self._paused, self._until_ms = True, self._now_ms
            self._changed.notify_all()

    def end(self) -> None:
        """Stop the flight: its next `wait` raises Ended."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def fly_to(self, time_ms: int) -> None:
        """Fly up to a time at full speed, then pause."""
        with self._changed:
            self._paused, self._until_ms = True, time_ms
            self._changed.notify_all()

    def step(self) -> None:
        """Fly one second at full speed, then pause."""
        with self._changed:
            self._paused, self._until_ms = True, self._now_ms + STEP_MS
            self._changed.notify_all()

    def set_rate(self, rate: float) -> None:
        """Set the rate to one of RATES."""
        with self._changed:
            self._rate, self._since = rate, None
            self._changed.notify_all()

    def due(self, time_ms: int) -> float | None:
        """Seconds until the flight may reach a time, at most 0 if now; None if paused."""
        if self._paused:
            return 0.0 if time_ms <= self._until_ms else None
        now_s = time.monotonic()
        if self._since is None:
            self._since = (now_s, self._now_ms)
        left_s = self._since[0] + (time_ms - self._since[1]) / 1000 / self._rate - now_s
        if left_s < 0:
            self._since = (now_s, time_ms)
        return left_s

    def wait(self, time_ms: int, standing: Callable[[], None]) -> None:
        """Return when the flight may reach that time [ms]; `standing` is called when it is paused. Raises Ended."""
        told = False
        while True:
            with self._changed:
                if self._ended:
                    raise Ended
                left_s = self.due(time_ms)
                if left_s is not None and left_s <= 0:
                    self._now_ms = time_ms
                    return
                if told or left_s is not None:
                    told = told and left_s is None
                    self._changed.wait(left_s)
                    continue
            standing()
            told = True
