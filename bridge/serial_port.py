"""Sentinel frames over a serial line, as UxAS's serial bridge sends them (57600 baud, 8N1).

A line that fails (a cable, a modem) is reopened repeatedly; meanwhile outgoing messages are counted as lost.
"""

from __future__ import annotations

import os
from typing import Any

import serial
import zmq

from cratous.bridge import sentinel
from cratous.bridge.port import Incoming, Limits, Report, Tally, is_due
from cratous.bridge.send_queue import Outgoing
from cratous.spec.errors import BadInput

_RETRY_S = 1.0
STALLED = "the line is too slow"
GONE = "the line is not there"
LATE = "frame not finished in time"


class SerialPort:
    """A serial port for sentinel frames; `parts` of a message is its payload alone."""

    def __init__(
        self,
        device: str,
        baud: int = 57600,
        *,
        limits: Limits | None = None,
        report: Report = lambda _severity, _text: None,
        where: str = "",
    ) -> None:
        """Opens the device; BadInput if that fails (only this first time)."""
        self._device, self._baud = device, baud
        self._limits = limits or Limits()
        self._report = report
        self._tally = Tally(device, report)
        self.counts = self._tally.counts
        self._out = Outgoing()
        self._begun_s: float | None = None
        self._again_s: float | None = None
        self._now_s = 0.0
        self._stream = self._fresh()
        try:
            self._line: serial.Serial | None = self._open()
        except (serial.SerialException, OSError, ValueError) as error:
            raise BadInput(
                f"the serial line cannot be opened ({error})",
                where=where,
                item="SerialPortAddress",
                expected="a device and a baud rate that it knows",
                got=f"{device}, {baud} baud",
            ) from None

    @property
    def due_s(self) -> float | None:
        """When an incomplete frame times out, or the device is to be reopened [s, monotonic clock]; None: neither."""
        late = None if self._begun_s is None else self._begun_s + self._limits.frame_s
        return min((t for t in (late, self._again_s) if t is not None), default=None)

    def handles(self) -> list[tuple[Any, int]]:
        """The device to poll, with POLLOUT while bytes are queued."""
        if self._line is None:
            return []
        return [(self._line.fileno(), zmq.POLLIN | (zmq.POLLOUT if self._out else 0))]

    def step(self, now_s: float) -> list[Incoming]:
        """Read and write without blocking; the complete payloads in order. now_s: monotonic clock [s]."""
        self._now_s = now_s
        found: list[bytes] = []
        if self._line is None and is_due(self._again_s, now_s):
            self._reopen()
        if self._line is not None:
            try:
                data = self._line.read(65536)
                found += self._stream.feed(data)
            except (serial.SerialException, OSError) as error:
                self._lost_line(str(error))
            else:
                self._flush()
        if found or not self._stream.pending:
            self._begun_s = None
        if self._stream.pending and self._begun_s is None:
            self._begun_s = now_s
        late_s = None if self._begun_s is None else self._begun_s + self._limits.frame_s
        if is_due(late_s, now_s):
            self._tally.refuse(LATE, f"{self._limits.frame_s:g} s")
            found += self._stream.abandon()
            self._begun_s = None
        self.counts.received += len(found)
        return [Incoming((payload,), self._device) for payload in found]

    def send(self, parts: tuple[bytes, ...]) -> None:
        """Queue one message; when the queue is full, one is discarded according to `Limits.when_full`."""
        if self._line is None:
            self._tally.lose(GONE)
            return
        frame = sentinel.frame(b"".join(parts))
        room = self._limits.waiting_bytes
        if self._limits.when_full == "DropOldest":
            while self._out.waiting + len(frame) > room and len(self._out) > 1:
                self._out.drop_oldest()
                self._tally.lose(STALLED, "the oldest message")
        if self._out and self._out.waiting + len(frame) > room:
            self._tally.lose(STALLED, f"{self._out.waiting} bytes wait")
            return
        self._out.put(frame)
        self.counts.sent += 1
        self._flush()

    def close(self) -> None:
        """Write as much as possible of the queue, then close the device."""
        if self._line is not None:
            self._flush()
        if self._line is not None:
            if self._out:
                self._tally.lose("closed before all was sent", f"{len(self._out)} messages")
            self._line.close()
            self._line = None
        self._again_s = None

    def _fresh(self) -> sentinel.FrameStream:
        def dropped(drop: sentinel.Drop) -> None:
            self._tally.refuse(drop.reason, str(drop.error(self._device)))

        return sentinel.FrameStream(max_payload=self._limits.payload_bytes, on_drop=dropped)

    def _open(self) -> serial.Serial:
        return serial.Serial(self._device, self._baud, timeout=0, write_timeout=0)

    def _reopen(self) -> None:
        try:
            self._line = self._open()
        except (serial.SerialException, OSError):
            self._again_s = self._now_s + _RETRY_S
            return
        self._again_s = None
        self._stream = self._fresh()
        self._report("INFO", f"{self._device}: the line is there again")

    def _lost_line(self, why: str) -> None:
        self._report("WARN", f"{self._device}: the line is gone ({why}); trying again")
        if self._out:
            self.counts.lost[GONE] += len(self._out)
        self._out.clear()
        if self._line is not None:
            self._line.close()
        self._line = None
        self._again_s = self._now_s + _RETRY_S

    def _flush(self) -> None:
        assert self._line is not None
        try:
            while self._out:
                # pyserial's own write would wait in a busy loop for a line that accepts nothing
                self._out.took(os.write(self._line.fileno(), self._out.next()))
        except (BlockingIOError, InterruptedError):
            return
        except (serial.SerialException, OSError) as error:
            self._lost_line(str(error))
