"""Sorts what the bridge has delivered: messages for the UxAS end, lines for each ICAROUS instance."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cratous.bridge.link import LinkEvent
from cratous.bridge.loopback import Delivered
from cratous.bridge.text_protocol import Direction, Message, WireError
from cratous.services.flight.messages import Heard, Lost, Unreadable


class Arrivals(NamedTuple):
    """up: messages to the UxAS end, in order of arrival; down: (vehicle id, line), in order of arrival."""

    up: tuple[Heard | Lost | Unreadable, ...]
    down: tuple[tuple[int, Message], ...]


def arrivals(delivered: Iterable[Delivered], now_ms: int) -> Arrivals:
    """Sort what the bridge has delivered by receiver.

    An unreadable line is reported to the UxAS end in either direction. A closed connection is reported to the
    UxAS end only; the ICAROUS side reacts to the silence.
    """
    up, down = list[Heard | Lost | Unreadable](), list[tuple[int, Message]]()
    for vehicle_id, direction, record in delivered:
        if isinstance(record, WireError):
            text = f"unreadable line from {direction.value}: {record}"
            up.append(Unreadable(vehicle_id, now_ms, text))
        elif isinstance(record, Message) and direction is Direction.DOWN:
            down.append((vehicle_id, record))
        elif isinstance(record, Message):
            up.append(Heard(vehicle_id, now_ms, record))
        elif isinstance(record, LinkEvent) and direction is Direction.UP:
            up.append(Lost(vehicle_id, now_ms, record))
    return Arrivals(tuple(up), tuple(down))
