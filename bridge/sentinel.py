"""Sentinel frames: how UxAS and AMASE put messages on TCP and serial lines.

    +=+=+=+= <length> #@#@#@#@ <payload> !%!%!%!% <sum> ?^?^?^?^      (without the blanks)

length and sum are decimal ASCII; length counts the payload's bytes, sum is their plain sum modulo
2^32. The length delimits the payload, which may contain any bytes, sentinels too.

    stream = FrameStream(on_drop=log)
    for payload in stream.feed(received): ...

`FrameStream` takes bytes in any segmentation and returns the same payloads for each. Anything else
is dropped, counted and reported with its position in the stream, and reading resumes at the next
head sentinel: one byte after the head of a malformed frame, or after a frame whose only error is its
sum. It holds no more than the bytes received of one frame within `max_payload`; the announced length
is not allocated. A frame that is never completed blocks the line until its length has arrived: a
bridge calls `abandon` after a timeout by its own clock. Format: UxAS 3.2, OpenAMASE.
"""

from __future__ import annotations

import re
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass

from cratous.bridge.bytesum import byte_sum
from cratous.spec.errors import BadInput

HEAD, BODY, TAIL, END = b"+=+=+=+=", b"#@#@#@#@", b"!%!%!%!%", b"?^?^?^?^"
MAX_PAYLOAD = 16 * 1024 * 1024  # [bytes]; ten times the largest message of the UxAS examples
_DIGITS = 10  # the most digits of a uint32
_NUMBER = re.compile(rb"[0-9]{1,10}")
_KEPT_DROPS = 100

# Reasons of drops: keys of `FrameStream.counts`.
OUTSIDE = "bytes outside of a frame"
BAD_LENGTH = "wrong length field"
TOO_LONG = "payload longer than the limit"
NO_TAIL = "no tail sentinel where the payload ends"
BAD_SUM_FIELD = "wrong checksum field"
BAD_SUM = "wrong checksum"
UNFINISHED = "unfinished frame"


@dataclass(frozen=True, slots=True)
class Drop:
    """Data that are not a frame: reason (a constant of this module), position in the stream [bytes from its start],
    and what was expected and got, for people."""

    reason: str
    offset: int
    expected: str = ""
    got: str = ""

    def error(self, where: str = "stream") -> BadInput:
        """The drop as the error that users see."""
        return BadInput(
            self.reason, where=f"{where}: byte {self.offset}", expected=self.expected, got=self.got
        )


def frame(payload: bytes) -> bytes:
    """The frame of a payload.

    >>> frame(b"abc")
    b'+=+=+=+=3#@#@#@#@abc!%!%!%!%294?^?^?^?^'
    """
    return b"".join(
        (HEAD, b"%d" % len(payload), BODY, payload, TAIL, b"%d" % byte_sum(payload), END)
    )


def unframe(data: bytes, where: str = "frame") -> bytes:
    """The payload of exactly one frame; otherwise BadInput with the error and its byte."""
    stream = FrameStream(max_payload=max(len(data), 1))
    payloads = stream.feed(data)
    if stream.pending:
        payloads += stream.close()
    if stream.drops:
        raise stream.drops[0].error(where)
    if len(payloads) != 1:
        raise BadInput("not one frame", where=where, expected="1 frame", got=f"{len(payloads)}")
    return payloads[0]


class FrameStream:
    """The payloads in one direction of a connection; see the module.

    max_payload: longest payload accepted [bytes]. max_strays: number of consecutive drops after which the stream is
    given up (`spoiled`) and no longer read; None: never. on_drop: called with every Drop, as soon as it is certain.
    frames: number of payloads so far. counts: drops by reason. dropped_bytes: all bytes that belonged to no payload's
    frame. drops: the last 100 drops. pending: bytes held back until the following ones decide. None of these but
    `pending` depends on how the bytes were segmented.
    """

    def __init__(
        self,
        *,
        max_payload: int = MAX_PAYLOAD,
        max_strays: int | None = None,
        on_drop: Callable[[Drop], None] | None = None,
    ) -> None:
        if max_payload < 1:
            raise BadInput("wrong limit", item="max_payload", expected="> 0", got=str(max_payload))
        self.max_payload, self.max_strays = max_payload, max_strays
        self.spoiled = False
        self.frames = 0
        self.dropped_bytes = 0
        self.counts: Counter[str] = Counter()
        self.drops: deque[Drop] = deque(maxlen=_KEPT_DROPS)
        self._on_drop = on_drop
        self._buffer = bytearray()
        self._start = 0  # position in the stream of the buffer's first byte
        self._in_step = True  # the last data were a frame, or nothing has been read yet
        self._strays = 0  # drops since the last frame
        self._need = 0  # bytes that the buffer must hold before the next decision

    @property
    def pending(self) -> int:
        """Bytes held back; a value above 0 for long indicates a peer that does not complete its frame."""
        return len(self._buffer)

    def feed(self, data: bytes | bytearray | memoryview) -> list[bytes]:
        """Take the next bytes of the stream; returns the payloads that they complete, in order."""
        if self.spoiled:
            self.dropped_bytes += len(data)
            self._start += len(data)
            return []
        self._buffer += data
        if len(self._buffer) < self._need:
            return []
        return self._read()

    def abandon(self) -> list[bytes]:
        """Give up the incomplete frame: it is dropped as UNFINISHED, and the bytes after its head are read again.

        Returns the payloads of complete frames after its head.
        """
        if self._buffer.startswith(HEAD[:1]) and self._buffer:
            self._drop(UNFINISHED, 0, "the rest of the frame", f"{len(self._buffer)} bytes")
            self._skip(len(self._buffer) if self._strayed() else 1)
        return self._read()

    def close(self) -> list[bytes]:
        """The stream has ended: like `abandon`, until nothing is left."""
        payloads: list[bytes] = []
        while self._buffer:
            payloads += self.abandon()
        return payloads

    def _drop(self, reason: str, at: int, expected: str = "", got: str = "") -> None:
        drop = Drop(reason, self._start + at, expected, got)
        self.counts[reason] += 1
        self.drops.append(drop)
        self._in_step = False
        if self._on_drop is not None:
            self._on_drop(drop)

    def _skip(self, size: int) -> None:
        del self._buffer[:size]
        self._start += size
        self.dropped_bytes += size

    def _read(self) -> list[bytes]:
        """The payloads of everything that can be decided with the bytes received."""
        payloads: list[bytes] = []
        buffer, at = self._buffer, 0  # everything before `at` is decided
        while True:
            head = buffer.find(HEAD, at)
            if head < 0:
                head = len(buffer) - _tail_overlap(buffer, at)
            if head > at:
                if self._in_step:
                    self._drop(OUTSIDE, at, HEAD.decode(), _shown(bytes(buffer[at : at + 1])))
                self.dropped_bytes += head - at
                at = head
            size, payload = self._frame(at)
            if size == 0:
                break
            at += size
            if payload is None:
                self.dropped_bytes += size
                if self._strayed():
                    self.dropped_bytes += len(buffer) - at
                    at = len(buffer)
                    break
            else:
                payloads.append(payload)
                self.frames += 1
                self._in_step = True
                self._strays = 0
        del buffer[:at]
        self._start += at
        self._need = max(0, self._need - at)
        return payloads

    def _strayed(self) -> bool:
        """Count a drop; returns whether the stream is given up."""
        self._strays += 1
        self.spoiled = self._strays == self.max_strays
        return self.spoiled

    def _frame(self, at: int) -> tuple[int, bytes | None]:
        """Decode at a head: (bytes consumed, payload or None); (0, None) if more bytes are needed."""
        buffer, held = self._buffer, len(self._buffer)
        if held < at + len(HEAD) + 1:
            self._need = held + 1
            return 0, None
        length, start = self._number(at, at + len(HEAD), BODY, BAD_LENGTH)
        if length is None:
            return start, None
        if length > self.max_payload:
            self._drop(TOO_LONG, at, f"at most {self.max_payload} bytes", f"{length}")
            return 1, None
        end = start + length
        self._need = end + len(TAIL) + 1
        if held < self._need:
            # The payload is not searched: a frame within it is part of it.
            return 0, None
        if buffer[end : end + len(TAIL)] != TAIL:
            got = _shown(bytes(buffer[end : end + len(TAIL)]))
            self._drop(NO_TAIL, at, f"{TAIL.decode()} after {length} bytes", got)
            return 1, None
        given, after = self._number(at, end + len(TAIL), END, BAD_SUM_FIELD)
        if given is None:
            return after, None
        payload = bytes(buffer[start:end])
        total = byte_sum(payload)
        done = after - at
        if total != given:
            self._drop(BAD_SUM, at, f"{total}", f"{given}")
            return done, None
        return done, payload

    def _number(self, at: int, begin: int, mark: bytes, reason: str) -> tuple[int | None, int]:
        """The number from `begin` up to its end mark, and the position after it; else None, and the number of bytes
        consumed from the head on: 0 if more are needed, 1 if it is dropped for `reason`."""
        buffer = self._buffer
        number = _NUMBER.match(buffer, begin)
        after = number.end() if number else begin
        found = bytes(buffer[after : after + len(mark)])
        if not number or not mark.startswith(found):
            got = _until_wrong(bytes(buffer[begin : after + len(mark)]), mark)
            self._drop(reason, at, f"1 to {_DIGITS} digits and {mark.decode()}", got)
            return None, 1
        if len(found) < len(mark):
            self._need = len(buffer) + 1
            return None, 0
        return int(number.group()), after + len(mark)


def _shown(data: bytes) -> str:
    return repr(data)[1:]


def _until_wrong(data: bytes, sentinel: bytes) -> str:
    """Digits and the beginning of a sentinel, up to and including the first wrong byte."""
    digits = _NUMBER.match(data)
    at = digits.end() if digits else 0
    for expected in sentinel if digits else b"":
        if data[at] != expected:
            break
        at += 1
    return _shown(data[: at + 1])


def _tail_overlap(buffer: bytearray, at: int) -> int:
    """The number of bytes at the end, from `at` on, that may be the beginning of a head."""
    for size in range(min(len(HEAD) - 1, len(buffer) - at), 0, -1):
        if buffer.endswith(HEAD[:size]):
            return size
    return 0
