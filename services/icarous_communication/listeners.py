"""Addresses at which instances connect, the dialect spoken there, and for which vehicles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from cratous.bridge.port import Address
from cratous.bridge.text_protocol.dialects import Dialect
from cratous.bridge.text_protocol.keys import Keys

FORMS = "v2", "cratous", "original", "thesis"
"""The configurable dialects: `v2` is `cratous` in authenticated packets."""


class Door(NamedTuple):
    """An address at which the instances of some vehicles connect. ids: the vehicles, () for the lowest known;
    keys: set for v2.
    """

    where: Address
    dialect: Dialect = Dialect.CRATOUS
    ids: tuple[int, ...] = ()
    keys: Keys | None = None


@dataclass(frozen=True)
class Dialects:
    """The dialects of one service's peers. usual: for vehicles not in `others`."""

    usual: Dialect = Dialect.CRATOUS
    others: Mapping[int, Dialect] = field(default_factory=dict)

    @property
    def all(self) -> tuple[Dialect, ...]:
        """Every dialect that some peer may speak."""
        return (self.usual, *self.others.values())

    def of(self, vehicle_id: int) -> Dialect:
        """The dialect spoken with a vehicle's instance."""
        return self.others.get(vehicle_id, self.usual)

    def ours(self, vehicle_id: int) -> bool:
        """Whether the dialect of a vehicle's instance has heartbeats and epochs."""
        return self.of(vehicle_id).ours

    def original(self, vehicle_id: int) -> bool:
        """Whether a vehicle is flown by a client of the original's."""
        return self.of(vehicle_id) is Dialect.ORIGINAL


def form_of(text: str) -> Dialect:
    """The dialect of the lines for one of FORMS."""
    return Dialect.CRATOUS if text == "v2" else Dialect(text)
