"""What waits to be written to one peer: whole messages, of which the first may be half gone."""

from __future__ import annotations

from collections import deque


class Outgoing:
    """Messages in order; `waiting`: how many bytes of them are not gone yet."""

    def __init__(self) -> None:
        self._messages: deque[bytes] = deque()
        self._gone = 0
        self.waiting = 0

    def __len__(self) -> int:
        """How many messages are not wholly gone."""
        return len(self._messages)

    def put(self, message: bytes) -> None:
        """Queue one more."""
        self._messages.append(message)
        self.waiting += len(message)

    def drop_oldest(self) -> None:
        """Forget the oldest of two or more of which nothing is gone: the first stays."""
        self.waiting -= len(self._messages[1])
        del self._messages[1]

    def next(self) -> memoryview:
        """What to write next, of one or more: the rest of the first message."""
        return memoryview(self._messages[0])[self._gone :]

    def took(self, count: int) -> None:
        """So many bytes of `next` are gone."""
        self._gone += count
        self.waiting -= count
        if self._gone == len(self._messages[0]):
            self._messages.popleft()
            self._gone = 0

    def clear(self) -> None:
        """Forget all of it."""
        self._messages.clear()
        self._gone = self.waiting = 0
