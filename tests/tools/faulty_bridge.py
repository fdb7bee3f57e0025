"""A bridge that loses, repeats, delays and reorders lines, falls silent, breaks, and forges SETMOD lines."""

from __future__ import annotations

import random
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest.mock import patch

from cratous.bridge.loopback import Bridge, Delivered
from cratous.bridge.text_protocol import Direction, SetMode
from cratous.bridge.text_protocol.parser import Record

FAULTS = ("loss", "repeat", "delay", "reorder", "silence", "cut", "forge")


@contextmanager
def faulty(kind: str, seed: int) -> Iterator[None]:
    """While it is open, every `Bridge` has this fault, the same for the same seed."""
    rng, exchange = random.Random(f"{kind}/{seed}"), Bridge.exchange
    later: list[tuple[int, Delivered]] = []
    rounds = [0]
    begins, ends = sorted(rng.sample(range(20, 300), 2))

    def broken(bridge: Bridge) -> list[Delivered]:
        rounds[0] += 1
        now = rounds[0]
        if kind == "cut" and now == begins:
            bridge.cut(rng.choice(bridge.vehicle_ids))
        came = exchange(bridge)
        if kind == "silence":
            return [] if begins <= now <= ends else came
        if kind == "forge":
            return came + _forged(rng, bridge)
        if kind == "reorder":
            rng.shuffle(came)
            return came
        out = [late for due, late in later if due <= now]
        later[:] = [(due, late) for due, late in later if due > now]
        for one in came:
            if not isinstance(one.record, Record) or rng.random() > 0.3:
                out.append(one)
            elif kind == "repeat":
                out += [one, one]
                later.append((now + rng.randrange(1, 60), one))
            elif kind == "delay":
                later.append((now + rng.randrange(1, 60), one))
        return out

    with patch.object(Bridge, "exchange", broken):
        yield


def _forged(rng: random.Random, bridge: Bridge) -> list[Any]:
    if rng.random() > 0.3:
        return []
    line = SetMode(rng.choice(("ACTIVE", "PASSIVE")), rng.randrange(6))
    return [Delivered(rng.choice(bridge.vehicle_ids), Direction.UP, line)]
