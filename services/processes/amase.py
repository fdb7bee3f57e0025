"""AMASE as the simulator of a flight: connected at its port, given the mission's aircraft, and reconnected
when lost.

UxAS communicates with AMASE through here. AMASE's clock cannot be stopped over the network, so its states are
ignored before the flight begins: then the mission's aircraft are removed from AMASE, whatever it had loaded,
inserted at their start positions, and commanded, all at once. When the connection ends, AMASE is restarted or
its clock goes back, the same is done with the last known states, and flight time continues from there. A
connection without data counts as ended too, since the loss of a machine or of the network is not signalled.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from enum import Enum
from typing import Any

from cratous.bridge import envelope as wire
from cratous.bridge import lmcp
from cratous.bridge.port import Address, Incoming, Limits, address, is_due
from cratous.bridge.tcp_port import TcpPort
from cratous.core.authority.timeliness import lasted
from cratous.services.exporting.amase import traffic_events
from cratous.services.exporting.messages import Told
from cratous.services.mission.frames import Projection
from cratous.services.processes.amase_commands import (
    Standing,
    for_amase,
    seen,
    with_pixels,
    without_numbers,
)
from cratous.spec.errors import BadInput, CratousError
from cratous.spec.mission import Mission

ANSWERS_S = 10.0
"""Time limit for the first connection to AMASE [s]."""
RETURNS_S = 120.0
"""Longest absence of AMASE before the flight ends, from its last state until states of all aircraft arrive
again [s].
"""
SILENT_S = 10.0
"""AMASE counts as lost, and is reconnected, if states of all the mission's aircraft are missing for this long
[s].
"""
FIRST_MS = 500
"""Time of the first states of a flight [ms]: AMASE's interval of states."""
LIMITS = Limits(waiting_bytes=64 << 20)
SCHEME = "amase://"
COMMANDS = ("MissionCommand", "VehicleActionCommand")
NEEDED = ("SessionStatus", "AirVehicleState")
"""Messages read from AMASE; it also forwards other clients' messages, of kinds unknown here."""


class AmaseLost(CratousError):
    """AMASE is unavailable, or does not do what the flight requires."""

    exit_code = 3


class Phase(Enum):
    """Phase of the connection to AMASE: nothing sent yet, aircraft being removed, being inserted, or flying."""

    APART, CLEARING, PLACING, FLYING = range(4)


def amase_address(text: str) -> Address:
    """The TCP address behind `amase://HOST:PORT`; BadInput for another text."""
    scheme, item = text[: len(SCHEME)], "--simulator"
    wrong = BadInput("not an address of AMASE", item=item, expected="amase://HOST:PORT", got=text)
    if scheme != SCHEME:
        raise wrong
    try:
        return address(f"tcp://{text[len(SCHEME) :]}", ("tcp",), item=item)
    except BadInput:
        raise wrong from None


class Amase:
    """The connection to a running AMASE, and the port for UxAS. Close it when done."""

    def __init__(self, where: Address, tell: Callable[[str], None]) -> None:
        """Connect; BadInput if there is no answer."""
        self.where, self._tell = where, tell
        self._port = TcpPort(where, server=False, limits=LIMITS)
        loopback = address("tcp://127.0.0.1:0", ("tcp",), free=True)
        self._uxas = TcpPort(loopback, server=True, limits=LIMITS)
        self.port = self._uxas.bound[1]
        """Port at which UxAS finds AMASE, on this machine."""
        self._phase = Phase.APART
        self._told: dict[int, tuple[Any, Any]] = {}
        self._last: dict[int, Any] = {}
        self._standing: dict[int, Standing] = {}
        self._instant: dict[int, Any] = {}
        self._clear = 0
        self._newest_ms = self._ahead_ms = 0
        self._flown_ms = 0
        self._away_s: float | None = None
        self._was_there = False
        self._now_s = self._news_s = time.monotonic()
        self._gone = ""
        self.met_again: list[str] = []
        """A report of each loss and return of AMASE."""
        try:
            self._answered()
        except BaseException:
            self.close()
            raise

    @property
    def name(self) -> str:
        """Its address in the user's form."""
        return f"{SCHEME}{self.where.text.removeprefix('tcp://')}"

    @property
    def flies(self) -> bool:
        """Whether states of all aircraft have arrived since they were inserted."""
        return self._phase is Phase.FLYING

    def close(self) -> None:
        """Close the connections to AMASE and UxAS."""
        self._port.close()
        self._uxas.close()

    def _answered(self) -> None:
        until_s = time.monotonic() + ANSWERS_S
        while not self._port.peers:
            now_s = time.monotonic()
            self._port.step(now_s)
            if is_due(until_s, now_s):
                raise BadInput(
                    "no answer at this address",
                    where=self.name,
                    item="--simulator",
                    expected="OpenAMASE with a scenario loaded, at its port (5555)",
                    got=f"no connection within {ANSWERS_S:g} s",
                )
            time.sleep(0.01)
        self._was_there = True

    # the flight -----------------------------------------------------------------------------------

    def begin(self, mission: Mission, told: Told) -> None:
        """Begin the flight: insert the mission's aircraft at their start positions, with the commands so far."""
        plane = Projection(mission.frame)
        for vehicle, made, state in zip(
            mission.vehicles, told.configurations, told.states, strict=True
        ):
            self._told[state.ID] = with_pixels(made, vehicle), state
        for one in mission.traffic:
            configuration, state = (body for body, _ in traffic_events(one, plane)[:2])
            self._told[one.id] = configuration, state
            self._uxas.send((_framed(configuration),))
        self._last = {number: state for number, (_, state) in self._told.items()}
        self._news_s = time.monotonic()
        self._lost("")

    def step(self, now_s: float) -> tuple[list[Any], int]:
        """Process input. Returns what the flight receives from its simulator, and the number of messages;
        AmaseLost if the flight cannot continue.
        """
        heard: list[Any] = []
        self._now_s = now_s
        asked, told = self._uxas.step(now_s), self._port.step(now_s)
        if self._uxas.peers:
            self._uxas.shut()  # no other client may command through here
        for incoming in asked:
            heard += self._commanded(_body(incoming, "UxAS"))
        if self._port.peers:
            self._back()
        elif self._was_there:
            self._was_there = False
            if self._told:
                self._lost("its connection has ended")
        for incoming in told:
            heard += self._from_amase(incoming)
        if self._told and is_due(self._news_s + SILENT_S, now_s):
            self._silent()
        if self._away_s is not None and is_due(self._away_s + RETURNS_S, now_s):
            raise AmaseLost(f"{self.name} {self._missing()} for {RETURNS_S:g} s")
        return heard, len(asked) + len(told)

    def _missing(self) -> str:
        if not self._port.peers:
            return "has not been met again"
        if self._phase is Phase.APART or (self._phase is Phase.CLEARING and not self._clear):
            return "has told no time: its clock has not run"
        if self._phase is Phase.CLEARING:
            return "has kept aircraft that were to be taken out"
        return "has not told states of all aircraft of the mission"

    def _commanded(self, body: Any) -> list[Any]:
        """A message of UxAS: a command is forwarded, and kept for a restart of AMASE."""
        if type(body).__name__ not in COMMANDS:
            return []
        standing = self._standing.setdefault(body.VehicleID, Standing())
        made = for_amase(body, standing, self._last.get(body.VehicleID))
        if self._phase is Phase.FLYING:
            self._send(made)
        return [body]

    def _back(self) -> None:
        if not self._was_there:
            # even a stopped process accepts connections: it counts as back with its first message
            self._was_there, self._news_s = True, self._now_s

    def _silent(self) -> None:
        """AMASE has been silent for too long: reconnect, since messages on that connection may never arrive."""
        self._port.redial("silent")
        self._lost(f"it has not told states of all aircraft of the mission for {SILENT_S:g} s")
        self._was_there, self._news_s = False, self._now_s

    def _lost(self, why: str) -> None:
        """Discard AMASE's state. why: how the connection was lost, "" at the start of the flight."""
        if self._phase is Phase.FLYING:
            at = f"at {self._flown_ms / 1000:.1f} s"
            self._tell(f"{self.name} is lost {at}: {why}; waiting {RETURNS_S:g} s for it")
            self._gone = f"{at} ({why})"
        if self._away_s is None:
            self._away_s = time.monotonic()
        self._phase = Phase.APART
        if self._port.peers:
            self._clearing()

    def _clearing(self) -> None:
        """Remove the mission's aircraft from AMASE, so that states arriving later are of those inserted."""
        self._phase, self._clear, self._instant = Phase.CLEARING, 0, {}
        self._newest_ms = 0
        self._remove()

    def _remove(self) -> None:
        self._send([lmcp.new("RemoveEntities", EntityList=sorted(self._told))])

    def _placing(self) -> None:
        self._phase, self._instant = Phase.PLACING, {}
        made = list[Any]()
        for number, (configuration, _) in sorted(self._told.items()):
            made += [configuration, self._last[number].copy(Time=0)]
        for number, standing in sorted(self._standing.items()):
            made += standing.again(self._last.get(number))
        # together: one that is inserted an instant after another would be behind it
        self._port.send_together([_framed(body) for body in made])

    # what AMASE tells -----------------------------------------------------------------------------

    def _answers(self) -> list[Any]:
        """The first message since the loss; data still in transit on the old connection is ignored."""
        if self._told and self._port.peers:
            if self._flown_ms:
                self._tell(f"{self.name} answers again")
            self._news_s = self._now_s
            self._clearing()
        return []

    def _from_amase(self, incoming: Incoming) -> list[Any]:
        if self._phase is Phase.APART:
            return self._answers()
        body = _body(incoming, self.name, NEEDED)
        kind = type(body).__name__
        if kind == "SessionStatus":
            return self._tick(body)
        if kind != "AirVehicleState" or not body.Time:
            return []
        if body.ID not in self._told:
            if self._phase is Phase.CLEARING:  # reported at each of its instants
                return []
            raise AmaseLost(
                f"{self.name} has an aircraft {body.ID}, which the mission has not; "
                "load a scenario without others, as `cratous export --format amase` writes it"
            )
        self._instant[body.ID] = body
        whole = self._instant.keys() == self._told.keys()
        if self._phase is Phase.PLACING and whole:
            return self._placed()
        if whole:
            self._news_s = self._now_s
        return self._state(body) if self._phase is Phase.FLYING else []

    def _tick(self, body: Any) -> list[Any]:
        """Process AMASE's time, which precedes the states of that time."""
        if not lasted(self._newest_ms, body.ScenarioTime, 0):
            self._newest_ms = 0
            self._lost("its clock has gone back")
            return []
        self._newest_ms = body.ScenarioTime
        if self._phase is not Phase.FLYING:
            self._news_s = self._now_s
        if self._phase is Phase.CLEARING:
            # the first instant may have begun before the removal, and its scenario may insert them later
            if self._clear and not self._instant:
                self._placing()
            elif self._instant:
                self._remove()
            self._clear += 1
        self._instant = {}
        return []

    def _placed(self) -> list[Any]:
        """All aircraft are inserted: flight time continues by the time that they have flown since."""
        came_s = max(_flown_s(self._last[n], state) for n, state in self._instant.items())
        first = not self._flown_ms
        time_ms = self._flown_ms + (FIRST_MS if first else max(1, round(1000 * came_s)))
        self._ahead_ms = time_ms - min(int(state.Time) for state in self._instant.values())
        self._phase, self._away_s = Phase.FLYING, None
        if not first:
            self.met_again.append(self._gone)
            self._tell(f"{self.name} flies again, from {time_ms / 1000:.1f} s on")
        return [one for _, body in sorted(self._instant.items()) for one in self._state(body)]

    def _state(self, body: Any) -> list[Any]:
        """A state in flight time, for UxAS and the log."""
        wrong = without_numbers(body)
        if wrong:
            raise AmaseLost(f"{self.name} tells a {wrong} of aircraft {body.ID} that is no number")
        state = body.copy(
            Time=int(body.Time) + self._ahead_ms,
            PayloadStateList=[seen(one) for one in body.PayloadStateList if one is not None],
        )
        self._flown_ms = max(self._flown_ms, state.Time)
        self._last[state.ID] = state
        self._uxas.send((_framed(state),))
        return [state]

    def _send(self, bodies: Iterable[Any]) -> None:
        for body in bodies:
            self._port.send((_framed(body),))


def _flown_s(before: Any, after: Any) -> float:
    """Time of flight from the insertion point, from an aircraft's speed [s]; 0 if it does not move."""
    here, there = before.Location, after.Location
    north = math.radians(there.Latitude - here.Latitude)
    east = math.radians(there.Longitude - here.Longitude) * math.cos(math.radians(here.Latitude))
    speed = float(after.Groundspeed)
    return 6_371_000.0 * math.hypot(north, east) / speed if speed > 1.0 else 0.0


def _framed(body: Any) -> bytes:
    return wire.enclose(body.all_names[0], lmcp.binary.pack(body)).pack()


def _body(incoming: Incoming, name: str, kinds: tuple[str, ...] = ()) -> Any:
    """The object of a message; None if its kind is not among the given ones."""
    try:
        message = wire.parse(incoming.parts[0])
        if kinds and message.descriptor.rpartition(".")[2] not in kinds:
            return None
        return lmcp.binary.received(message.payload, message.descriptor)[0]
    except BadInput as error:
        raise AmaseLost(f"what {name} says cannot be read: {error}") from error
