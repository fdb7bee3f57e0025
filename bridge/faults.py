"""The bridge of one process over failing connections, in virtual time: the same faults for the same seed.

Faults act on lines: they are changed, delayed and dropped before they reach the sockets, so the parsers read what a
faulty link would deliver. The handshake of a reopened connection is not affected.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import NamedTuple

from cratous.bridge.loopback import Bridge, Delivered, Segmenter
from cratous.bridge.text_protocol.format import encode
from cratous.bridge.text_protocol.messages import Direction, SetMode
from cratous.spec.mission.bridge_faults import BridgeFaults

MOST_WAITING = 65536
"""The most bytes waiting for a peer that does not read; beyond it the connection breaks."""
EPOCHS = 6
"""Forged modes carry epochs below this."""


class _Waiting(NamedTuple):
    """Bytes in transit to one end, which arrive at the first exchange from `due_ms` on."""

    due_ms: int
    data: bytes


class FailingWay:
    """Lines of one vehicle's connection in one direction: lost, changed, repeated and delayed according to `faults`."""

    def __init__(self, faults: BridgeFaults, vehicle_id: int, direction: Direction) -> None:
        self._faults, self._direction = faults, direction
        self._random = random.Random(f"{faults.seed} {vehicle_id} {direction}")
        self._waiting: list[_Waiting] = []

    def take(self, data: bytes, now_ms: int) -> None:
        """Queue one line sent at now_ms [ms of flight]: lost, truncated, corrupted, repeated or delayed as drawn."""
        faults, draw = self._faults, self._random
        if draw.random() < faults.loss:
            return
        if draw.random() < faults.truncation:
            if len(data) < 2:  # an empty line has no byte to lose
                return
            data = data[: draw.randrange(1, len(data))]
        if draw.random() < faults.corruption:
            k = draw.randrange(len(data))
            data = data[:k] + bytes((data[k] ^ draw.randrange(1, 256),)) + data[k + 1 :]
        for _ in range(1 + (draw.random() < faults.repeat)):
            self._waiting.append(_Waiting(now_ms + draw.randint(0, faults.delay_ms), data))

    def due(self, now_ms: int) -> list[bytes]:
        """The lines that arrive by now_ms [ms of flight], in order of arrival; none while ICAROUS does not read."""
        if self._direction is Direction.DOWN and self._faults.icarous_does_not_read(now_ms):
            return []
        due = sorted((w for w in self._waiting if w.due_ms <= now_ms), key=lambda w: w.due_ms)
        self._waiting = [w for w in self._waiting if w.due_ms > now_ms]
        for k in range(len(due)):
            if self._random.random() < self._faults.reorder:
                due.insert(self._random.randrange(len(due)), due.pop(k))
        return [one.data for one in due]

    def breaks(self, now_ms: int) -> bool:
        """True if ICAROUS does not read at now_ms [ms of flight] and more than MOST_WAITING bytes wait for it."""
        if self._direction is Direction.UP or not self._faults.icarous_does_not_read(now_ms):
            return False
        return sum(len(one.data) for one in self._waiting) > MOST_WAITING

    def forged(self) -> bytes:
        """The bytes of a forged SETMOD that arrives at this exchange; empty if none does."""
        faults, draw = self._faults, self._random
        if not faults.forged_modes or draw.random() >= faults.forged_modes:
            return b""
        return encode(SetMode(draw.choice(("ACTIVE", "PASSIVE")), draw.randrange(EPOCHS)))

    def clear(self) -> None:
        """Discard the lines in transit: the connection has ended."""
        self._waiting.clear()


class FaultyBridge(Bridge):
    """A `Bridge` whose connections fail as `faults` says; the caller sets `now_ms` [ms of flight] at each heartbeat."""

    def __init__(
        self,
        vehicle_ids: Sequence[int],
        faults: BridgeFaults,
        *,
        segmenter: Segmenter | None = None,
    ) -> None:
        self._faults = faults
        self._ways: dict[tuple[int, Direction], FailingWay] = {}
        self._done: set[str] = set()
        super().__init__(vehicle_ids, segmenter=segmenter)
        for vid in self.vehicle_ids:
            for direction in Direction:
                self._ways[vid, direction] = FailingWay(faults, vid, direction)

    def exchange(self) -> list[Delivered]:
        """What arrives by `now_ms`, ordered as in `Bridge.exchange`; cuts all connections at `faults.cut_ms`."""
        if self._is_time("cut", self._faults.cut_ms):
            for vid in self.vehicle_ids:
                self._break(vid)
        self._transmit()
        return super().exchange()

    def opened_anew(self) -> list[int]:
        """The vehicles whose broken connections are reopened at `faults.reconnect_ms`, once; else empty."""
        if not self._is_time("reconnect", self._faults.reconnect_ms):
            return []
        broken = [vid for vid in self.vehicle_ids if not self.alive(vid)]
        self.reopen(broken)
        return broken

    def _is_time(self, what: str, at_ms: int | None) -> bool:
        if at_ms is None or self.now_ms < at_ms or what in self._done:
            return False
        self._done.add(what)
        return True

    def _break(self, vid: int) -> None:
        """A connection ends: its lines in transit are lost."""
        for direction in Direction:
            self._ways[vid, direction].clear()
        if self.alive(vid):
            self.cut(vid)

    def _hand_over(self, vehicle_id: int, direction: Direction, data: bytes) -> bool:
        """Apply the faults to a line in transit; False if the connection is dead."""
        if not self.alive(vehicle_id):
            return False
        self._ways[vehicle_id, direction].take(data, self.now_ms)
        return True

    def _transmit(self) -> None:
        """Pass the lines that are due to the sockets; the exchange that follows delivers them."""
        for (vid, direction), way in self._ways.items():
            if direction is Direction.UP and (line := way.forged()):
                super()._hand_over(vid, Direction.UP, line)
            if way.breaks(self.now_ms):
                self._break(vid)
            for data in way.due(self.now_ms):
                super()._hand_over(vid, direction, data)
