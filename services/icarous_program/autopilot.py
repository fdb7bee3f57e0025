"""A direct connection from a vehicle's ICAROUS to its autopilot: state and steering while UxAS is not heard.

It speaks LMCP over TCP like AMASE's port of a vehicle (`cratous sim --vehicle ID=HOST:PORT`): AirVehicleState
in, VehicleActionCommand out.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.port import Address, Report, Tally
from cratous.bridge.tcp_port import TcpPort
from cratous.bridge.text_protocol import Message, OwnPosition, encode
from cratous.services.flight.dynamics import AirState
from cratous.services.icarous_communication.state import air_state
from cratous.services.icarous_communication.steering import action_of, command_of
from cratous.services.mission.frames import Projection
from cratous.spec.errors import BadInput

COMMANDS_FROM = 2**41
"""Ids of the commands start here, apart from those of other senders."""


class Reported(NamedTuple):
    """A state of the vehicle; passed: how often the autopilot has moved on to another waypoint so far."""

    line: OwnPosition
    passed: int


class Autopilot:
    """The connection to the autopilot, re-established whenever it ends."""

    def __init__(
        self, vehicle_id: int, where: Address, projection: Projection, report: Report
    ) -> None:
        self._vehicle_id, self._projection = vehicle_id, projection
        self._port = TcpPort(where, server=False, report=report)
        self._tally = Tally(where.text, report)
        self._air: AirState | None = None
        self._waypoint, self._passed, self._commands = 0, 0, 0

    @property
    def there(self) -> bool:
        """Whether it is connected."""
        return bool(self._port.peers)

    def handles(self) -> list[tuple[Any, int]]:
        """Sockets to poll, each with its flags."""
        return self._port.handles()

    def step(self, now_s: float) -> list[Reported]:
        """The vehicle's states received since the last call."""
        found = list[Reported]()
        for incoming in self._port.step(now_s):
            try:
                message = wire.parse(incoming.parts[0])
                body = lmcp.binary.received(message.payload, message.descriptor)[0]
            except BadInput as error:
                self._tally.refuse("message that cannot be read", str(error))
                continue
            # states from the scenario file have no time
            if (
                type(body).__name__ == "AirVehicleState"
                and self._vehicle_id == body.ID
                and body.Time
            ):
                try:
                    found.append(self._state(body))
                except BadInput as error:
                    self._tally.refuse("state that is none of a vehicle", str(error))
        return found

    def _state(self, body: Any) -> Reported:
        """A state as POSTN. BadInput for one that POSTN cannot carry: a non-finite value, no position, or no
        time.
        """
        air = air_state(body, self._projection)
        alt_m, v = air.position.alt_m, air.velocity
        line = OwnPosition(
            time_s=body.Time / 1000,
            lat_deg=body.Location.Latitude,
            long_deg=body.Location.Longitude,
            alt_abs_m=alt_m,
            alt_rel_m=alt_m,
            north_mps=v.north_m_s,
            east_mps=v.east_m_s,
            down_mps=v.down_m_s,
            vehicle_id=self._vehicle_id,
        )
        encode(line)
        self._air = air
        self._passed += self._waypoint not in (0, body.CurrentWaypoint)
        self._waypoint = body.CurrentWaypoint
        return Reported(line, self._passed)

    def steer(self, line: Message) -> bool:
        """Send a steering line to the autopilot. Returns False for other lines, or while no state or
        connection exists.
        """
        if self._air is None or not self.there:
            return False
        action = action_of(line, self._air, None, self._projection)
        if action is None:
            return False
        self._commands += 1
        body = command_of(self._vehicle_id, COMMANDS_FROM + self._commands, action)
        self._port.send((wire.enclose(body.all_names[0], lmcp.binary.pack(body)).pack(),))
        return True

    def close(self) -> None:
        """Close the connection."""
        self._port.close()
