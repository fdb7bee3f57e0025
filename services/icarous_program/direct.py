"""Direct link between the ICAROUS instances of several vehicles: each sends its own state, as authenticated
datagrams to a multicast group, and receives the others'. It does not depend on UxAS.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from cratous.bridge.multicast_port import MulticastPort
from cratous.bridge.port import Address, Report
from cratous.bridge.text_protocol import OwnPosition, StreamParser, encode
from cratous.bridge.text_protocol.datagrams import MOST_VEHICLES, Datagrams, Refused
from cratous.bridge.text_protocol.keys import Keys
from cratous.bridge.text_protocol.messages import Direction
from cratous.spec.errors import BadInput

NO_STATE = "direct line that is no state"


class State(NamedTuple):
    """A vehicle's own state, as received."""

    vehicle_id: int
    line: OwnPosition


class DirectLink:
    """One end of the direct link."""

    def __init__(self, vehicle_id: int, keys: Keys, where: Address, report: Report) -> None:
        """keys: the direct keys of this vehicle and of the others. BadInput for too many, or no group."""
        if len(keys.by_vehicle) > MOST_VEHICLES:
            raise BadInput(
                "too many vehicles for direct links",
                item="--direct",
                expected=f"{MOST_VEHICLES} with an instance at most",
                got=str(len(keys.by_vehicle)),
            )
        self._datagrams = Datagrams(vehicle_id, keys.by_vehicle)
        self._port = MulticastPort(where, report)
        self.counts = self._port.counts

    def fileno(self) -> int:
        """The descriptor to poll."""
        return self._port.fileno()

    def say(self, line: OwnPosition) -> None:
        """Send the own state to the others."""
        data = self._datagrams.wrap(encode(line), round(1000 * line.time_s))
        self._port.send(data)

    def step(self) -> list[State]:
        """The states received from the others; unauthenticated or malformed datagrams are dropped and
        counted.
        """
        found = list[State]()
        for data in self._port.step():
            said = self._datagrams.open(data)
            if isinstance(said, Refused):
                self._port.refuse(*said)
            elif said is not None:
                lines = StreamParser(Direction.DOWN).feed(said.line)
                states = [line for line in lines if isinstance(line, OwnPosition)]
                found += [State(said.vehicle_id, line) for line in states]
                self._refuse(said.vehicle_id, lines if not states else ())
        return found

    def _refuse(self, vehicle_id: int, lines: Iterable[object]) -> None:
        for line in lines:
            self._port.refuse(NO_STATE, f"vehicle {vehicle_id}: {str(line)[:80]}")

    def close(self) -> None:
        """Leave the multicast group."""
        self._port.close()
