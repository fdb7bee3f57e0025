"""Assignment of connections to vehicles: by HELLO, or by ascending vehicle id in order of arrival."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cratous.bridge.port import is_due

GRACE_S = 1.0
"""A connection that has sent nothing for this long is assumed never to send HELLO [s]."""


class Refusal(NamedTuple):
    """Why a connection is refused. why: a fixed reason, by which refusals are counted; detail: of this
    refusal, including what the peer sent.
    """

    why: str
    detail: str


class Seats:
    """The connections of one service. count: number of instances; ids: their vehicles, () for the lowest
    known ids.
    """

    def __init__(self, count: int, ids: tuple[int, ...]) -> None:
        self._count, self._ids = count, ids
        self._new: dict[int, float] = {}  # connections that may still send HELLO, with the deadline
        self._unnamed: list[int] = []
        self._vehicle: dict[int, int] = {}
        self._only: dict[int, tuple[int, ...]] = {}  # vehicles that a connection may speak for

    @property
    def come(self) -> int:
        """Number of instances connected, assigned or not."""
        return len(self._vehicle) + len(self._unnamed) + len(self._new)

    def vehicle(self, key: int) -> int | None:
        """The vehicle that a connection is assigned to; None while undecided."""
        return self._vehicle.get(key)

    def key(self, vehicle_id: int) -> int | None:
        """The connection assigned to a vehicle; None if there is none."""
        return next((k for k, vid in self._vehicle.items() if vid == vehicle_id), None)

    @property
    def vehicles(self) -> list[int]:
        """The vehicles whose instances are connected."""
        return sorted(self._vehicle.values())

    @property
    def due_s(self) -> float | None:
        """When `settle` is next due [s]; None if never."""
        return min(self._new.values(), default=None)

    def opened(self, key: int, now_s: float, only: tuple[int, ...] = ()) -> Refusal | None:
        """Register a new connection; returns why it is refused, None if it is not. only: vehicles accepted at
        its address, () for any.
        """
        if self.come >= self._count:
            return Refusal("too many", f"more instances than NumberOfUAVs = {self._count}")
        here = [k for k in (*self._new, *self._unnamed, *self._vehicle) if self._only[k] == only]
        if only and len(here) >= len(only):
            text = f"more instances than of the vehicles {', '.join(map(str, only))}, which come in here"
            return Refusal("too many", text)
        self._new[key], self._only[key] = now_s + GRACE_S, only
        return None

    def hello(self, key: int, vehicle_id: int) -> Refusal | None:
        """Assign connection `key` to the vehicle that its HELLO names; the reason if that is refused."""
        had = self._vehicle.get(key)
        if had is not None:
            text = f"a second HELLO: {vehicle_id} after {had}"
            return None if had == vehicle_id else Refusal("another HELLO", text)
        allowed = self._only.get(key) or self._ids
        if allowed and vehicle_id not in allowed:
            expected = ", ".join(map(str, allowed))
            text = f"HELLO of vehicle {vehicle_id}, expected one of {expected}"
            return Refusal("HELLO of a stranger", text)
        if vehicle_id in self._vehicle.values():
            return Refusal("vehicle taken", f"a second instance for vehicle {vehicle_id}")
        self._forget(key)
        self._vehicle[key] = vehicle_id
        return None

    def speaks(self, key: int) -> None:
        """Connection `key` began with a line other than HELLO: `settle` assigns its vehicle in order of arrival."""
        if key in self._new:
            del self._new[key]
            self._unnamed.append(key)

    def settle(self, known: Iterable[int], now_s: float) -> list[tuple[int, int]]:
        """Assign vehicles to connections without HELLO; returns the new (connection, vehicle) pairs.

        The lowest ids are assigned first, so all vehicles must be known before.
        """
        for key in [k for k, until_s in self._new.items() if is_due(until_s, now_s)]:
            self.speaks(key)
        ids = list(self._ids) or sorted(known)[: self._count]
        if not self._unnamed or len(ids) != self._count:
            return []
        given = list[tuple[int, int]]()
        for key in tuple(self._unnamed):
            own = self._only.get(key) or ids
            free = [vid for vid in own if vid not in self._vehicle.values()]
            if free:
                self._vehicle[key] = free[0]
                self._unnamed.remove(key)
                given.append((key, free[0]))
        return given

    def gone(self, key: int) -> int | None:
        """Remove a closed connection; returns its vehicle, None if it had none."""
        self._forget(key)
        self._only.pop(key, None)
        return self._vehicle.pop(key, None)

    def missing(self) -> str:
        """Which instances are connected and which are missing, in words."""
        named = sorted(self._vehicle.values())
        there = [f"vehicle {vid}" for vid in named]
        unnamed = len(self._unnamed) + len(self._new)
        there += [f"{unnamed} without a name"] if unnamed else []
        absent = [str(vid) for vid in self._ids if vid not in named]
        who = f" (of the vehicles {', '.join(absent)})" if absent else ""
        text = f"{self.come} of {self._count} ICAROUS instances are there"
        return f"{text} ({', '.join(there) or 'none'}); {self._count - self.come} missing{who}"

    def _forget(self, key: int) -> None:
        self._new.pop(key, None)
        if key in self._unnamed:
            self._unnamed.remove(key)
