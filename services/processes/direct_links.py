"""Direct links between the ICAROUS processes of a flight: address and keys."""

from __future__ import annotations

from collections.abc import Collection
from contextlib import closing
from typing import NamedTuple

from cratous.bridge.multicast_port import MulticastPort
from cratous.bridge.port import Address
from cratous.bridge.text_protocol.datagrams import MOST_VEHICLES
from cratous.bridge.text_protocol.keys import DIRECT_VARIABLE, Keys, new_keys
from cratous.spec.errors import BadInput


class DirectLinks(NamedTuple):
    """where: the multicast group; keys: of all vehicles, given to each of their processes."""

    where: Address
    keys: Keys

    @property
    def words(self) -> tuple[str, ...]:
        """Additional command-line arguments of `cratous icarous`."""
        return ("--direct", f"{self.where.host}:{self.where.port}")

    @property
    def private(self) -> dict[str, str]:
        """Environment variables for these processes only."""
        return self.keys.environment(DIRECT_VARIABLE)


def direct_links(where: Address, instances: Collection[int]) -> DirectLinks:
    """The links of these vehicles, with new keys; BadInput for an address that cannot be joined, too many
    vehicles, or a single one.
    """
    if len(instances) not in range(2, MOST_VEHICLES + 1):
        raise BadInput(
            "direct links are between vehicles that ICAROUS protects",
            item="--direct",
            expected=f"2 to {MOST_VEHICLES} of them",
            got=str(len(instances)),
        )
    with closing(MulticastPort(where, lambda *_: None)):
        pass  # checked before anything is started
    return DirectLinks(where, new_keys(instances))
