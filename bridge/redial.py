"""Connections that are re-established whenever they end, with increasing pauses; blocks only for the look-up of a
host name."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from cratous.bridge.port import Address, is_due
from cratous.bridge.text_port import TextPort

PAUSE_S = (0.1, 2.0)
"""First and longest pause between attempts to connect [s]."""


@dataclass
class _Target:
    where: Address
    key: int | None = None
    again_s: float | None = None  # None: immediately
    pause_s: float = PAUSE_S[0]
    why: str = ""  # why the last attempt or connection ended
    opened_s: float | None = None


class Redial:
    """Keeps one connection of a port to each of several addresses, with growing pauses between attempts."""

    def __init__(self, port: TextPort, where: Iterable[Address]) -> None:
        self._port, self._targets = port, [_Target(one) for one in where]

    @property
    def due_s(self) -> float | None:
        """When `step` has to connect [s]; None while every address has a connection or a pending attempt."""
        times = [one.again_s or 0.0 for one in self._targets if one.key is None]
        return min(times, default=None)

    def step(self, now_s: float) -> None:
        """Connect to every address without a connection whose pause is over at now_s [s]."""
        for one in self._targets:
            if one.key is None and (one.again_s is None or is_due(one.again_s, now_s)):
                one.key = self._port.dial(now_s, one.where)

    def opened(self, key: int, now_s: float) -> None:
        """The handshake on connection `key` is complete at now_s [s].

        If the connection lasts PAUSE_S[1] seconds, the pauses after its end start again from the shortest.
        """
        for one in self._targets:
            if one.key == key:
                one.opened_s = now_s

    def ended(self, key: int, why: str, now_s: float) -> str:
        """Connection `key` ended at now_s [s] because of `why`; returns what to report, empty if the last one ended
        alike."""
        said = ""
        for one in self._targets:
            if one.key == key:
                if one.opened_s is not None and is_due(one.opened_s + PAUSE_S[1], now_s):
                    one.pause_s, one.why = PAUSE_S[0], ""
                one.opened_s = None
                said = "" if why == one.why else f"{one.where.text}: {why}"
                one.key, one.again_s, one.why = None, now_s + one.pause_s, why
                one.pause_s = min(2 * one.pause_s, PAUSE_S[1])
        return said
