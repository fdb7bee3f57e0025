"""Packets injected into a v2 connection by an attacker who can listen but has no key."""

from __future__ import annotations

import random
import re
from collections import deque

from cratous.bridge.text_protocol.authenticated_lines import Seal

KEPT = 256
"""Number of recorded packets kept for replay."""


_HEAD = re.compile(rb"([0-9]{1,18}),([0-9]{1,18}),[0-9]{1,18},([0-9]{1,18}),")


class Forger:
    """Forges packets towards UxAS on one connection; `draw` selects them."""

    def __init__(self, vehicle_id: int, draw: random.Random) -> None:
        self._vehicle_id, self._draw = vehicle_id, draw
        self._key = draw.randbytes(32)
        self._heard: deque[bytes] = deque(maxlen=KEPT)
        self._last = (0, 0, 0)

    def hears(self, packet: bytes, up: bool) -> None:
        """Record a packet. up: sent by ICAROUS."""
        head = _HEAD.match(packet)
        if head is None:
            return
        self._heard.append(packet)
        if up:
            sequence, time_ms, acknowledged = map(int, head.groups())
            self._last = sequence, time_ms, acknowledged

    def packet(self, line: bytes) -> bytes:
        """A forged packet: a replay of either direction, or the line as ICAROUS's next packet with valid
        numbers and checksum but another key.
        """
        if self._heard and self._draw.random() < 1 / 2:
            return self._draw.choice(self._heard)
        sequence, time_ms, acknowledged = self._last
        seal = Seal(self._vehicle_id, self._key, self._key, sent=sequence, mark=acknowledged)
        return seal.wrap(line, time_ms)
