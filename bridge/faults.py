"""The bridge of one process over connections that fail, in virtual time: the same faults for the same seed.

Lines are what fails: they are changed, held back and dropped before they go to the sockets, so the parsers
read what a broken wire would give them. The handshake of a connection that is opened anew is left alone.
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
"""Bytes that wait for a peer that does not read; with more its connection breaks."""
EPOCHS = 6
"""Forged modes are of the epochs below this."""


class _Waiting(NamedTuple):
    """Bytes on their way to one end, which arrive at the first exchange from `due_ms` on."""

    due_ms: int
    data: bytes


Way = tuple[int, Direction]


class FaultyBridge(Bridge):
    """A `Bridge` whose connections fail as `faults` says; `now_ms` is to be set at each beat."""

    def __init__(
        self,
        vehicle_ids: Sequence[int],
        faults: BridgeFaults,
        *,
        segmenter: Segmenter | None = None,
    ) -> None:
        self._faults = faults
        self._waiting: dict[Way, list[_Waiting]] = {}
        self._random: dict[Way, random.Random] = {}
        self._done: set[str] = set()
        super().__init__(vehicle_ids, segmenter=segmenter)
        for vid in self.vehicle_ids:
            for direction in Direction:
                self._waiting[vid, direction] = []
                self._random[vid, direction] = random.Random(f"{faults.seed} {vid} {direction}")

    def exchange(self) -> list[Delivered]:
        """What arrives now, as of `Bridge.exchange`."""
        if self._is_time("cut", self._faults.cut_ms):
            for vid in self.vehicle_ids:
                self._break(vid)
        self._transmit()
        return super().exchange()

    def opened_anew(self) -> list[int]:
        """The vehicles whose broken connections are opened anew now, once."""
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
        """The end of a connection: what was on its way is lost."""
        for direction in Direction:
            self._waiting[vid, direction].clear()
        if self.alive(vid):
            self.cut(vid)

    def _hand_over(self, vehicle_id: int, direction: Direction, data: bytes) -> bool:
        """Let a line be lost, changed, repeated or delayed; False if the connection is dead."""
        if not self.alive(vehicle_id):
            return False
        faults, draw = self._faults, self._random[vehicle_id, direction]
        if draw.random() < faults.loss:
            return True
        if draw.random() < faults.truncation:
            data = data[: draw.randrange(1, len(data))]
        if draw.random() < faults.corruption:
            k = draw.randrange(len(data))
            data = data[:k] + bytes((data[k] ^ draw.randrange(1, 256),)) + data[k + 1 :]
        for _ in range(1 + (draw.random() < faults.repeat)):
            due_ms = self.now_ms + draw.randint(0, faults.delay_ms)
            self._waiting[vehicle_id, direction].append(_Waiting(due_ms, data))
        return True

    def _transmit(self) -> None:
        """Give to the sockets what is due; what comes of it is in the exchange that follows."""
        for (vid, direction), waiting in self._waiting.items():
            if direction is Direction.UP:
                self._forge(vid)
            if direction is Direction.DOWN and self._does_not_read():
                if sum(len(one.data) for one in waiting) > MOST_WAITING:
                    self._break(vid)
                continue
            due = sorted((w for w in waiting if w.due_ms <= self.now_ms), key=lambda w: w.due_ms)
            waiting[:] = [w for w in waiting if w.due_ms > self.now_ms]
            for one in self._reordered(due, self._random[vid, direction]):
                super()._hand_over(vid, direction, one.data)

    def _does_not_read(self) -> bool:
        begin, end = self._faults.stops_reading_ms, self._faults.reads_again_ms
        return begin is not None and begin <= self.now_ms and (end is None or self.now_ms < end)

    def _reordered(self, due: list[_Waiting], draw: random.Random) -> list[_Waiting]:
        for k in range(len(due)):
            if draw.random() < self._faults.reorder:
                due.insert(draw.randrange(len(due)), due.pop(k))
        return due

    def _forge(self, vid: int) -> None:
        draw = self._random[vid, Direction.UP]
        if self._faults.forged_modes and draw.random() < self._faults.forged_modes:
            line = SetMode(draw.choice(("ACTIVE", "PASSIVE")), draw.randrange(EPOCHS))
            super()._hand_over(vid, Direction.UP, encode(line))
