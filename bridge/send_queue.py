"""The queue of data for one peer: whole messages, of which the first may be partly written."""

from __future__ import annotations

from collections import deque


class Outgoing:
    """Queue of messages for one peer; `waiting`: number of bytes not written yet."""

    def __init__(self) -> None:
        self._messages: deque[bytes] = deque()
        self._gone = 0
        self.waiting = 0

    def __len__(self) -> int:
        """The number of messages not completely written."""
        return len(self._messages)

    def put(self, message: bytes) -> None:
        """Append a message."""
        self._messages.append(message)
        self.waiting += len(message)

    def drop_oldest(self) -> None:
        """Drop the second of two or more messages: the first, which may be partly written, stays."""
        self.waiting -= len(self._messages[1])
        del self._messages[1]

    def next(self) -> memoryview:
        """The bytes to write next: the rest of the first message. There must be one."""
        return memoryview(self._messages[0])[self._gone :]

    def took(self, count: int) -> None:
        """Remove the first `count` bytes of `next`, which were written."""
        self._gone += count
        self.waiting -= count
        if self._gone == len(self._messages[0]):
            self._messages.popleft()
            self._gone = 0

    def clear(self) -> None:
        """Discard all queued messages."""
        self._messages.clear()
        self._gone = self.waiting = 0
