"""The assumption that each sensed aircraft is within the bound of its track. Decided by
`disc_within`.

ICAROUS receives a position and a bound on its error (`SensedState`); the true position at the same
instant is in the log. Velocity bounds concern future positions, so they are not checked separately.
"""

from __future__ import annotations

import math

from cratous.core.authority.timeliness import lasted
from cratous.core.permit.tubes import disc_within
from cratous.services.assumptions.link import NO_INSTANCE
from cratous.services.assumptions.motion import Room, is_within
from cratous.services.assumptions.observations import Message, Record
from cratous.spec.mission import Mission, Position
from cratous.spec.mission.sensing import EXACT_STATES

NAME = "sensed within its bound"
FEW = 5
"""Number of instants without a true state, and of aircraft never sensed, that are listed."""


class SensedWatch:
    """Checks each sensed state, at each heartbeat."""

    kinds = ("SensedState", "TruthState")

    def __init__(self, mission: Mission) -> None:
        self._gone = {t.id: t.vanishes_ms for t in mission.traffic if t.vanishes_ms is not None}
        self._waiting: dict[tuple[int, int], list[Message]] = {}
        self._instances, self._there = mission.instances, set[int]()
        self._sensed = set[tuple[int, int]]()
        none = "" if mission.instances else NO_INSTANCE
        if mission.instances and mission.sensing is None:
            none = EXACT_STATES
        waits = "nothing was sensed"
        self._record = Record("", 1.0, (disc_within,), none, waits=waits)

    def message(self, message: Message) -> None:
        """Process a message; a sensed state waits for the true state of its instant."""
        body = message.body
        if message.kind == "SensedState":
            self._waiting.setdefault((body.Time, body.VehicleID), []).append(message)
            self._sensed.add((body.ObserverID, body.VehicleID))
        elif message.kind == "TruthState":
            self._there.add(body.VehicleID)
            for one in self._waiting.pop((body.Time, body.VehicleID), ()):
                self._hold(one, message)

    def _hold(self, sensed: Message, true: Message) -> None:
        body, place = sensed.body, true.body
        off = Position(
            body.North - place.North, body.East - place.East, body.Altitude - place.Altitude
        )
        room, beside = Room(body.HorizontalBound, body.VerticalBound), math.hypot(*off[:2])
        shares = [a / b if b else 0.0 for a, b in zip((beside, abs(off.alt_m)), room, strict=True)]
        self._record.see(max(shares))
        text = (
            f"what {body.ObserverID} sensed of aircraft {body.VehicleID} is {beside:.4g} m beside and "
            f"{abs(off.alt_m):.4g} m above or below it, with bounds of {room.wide_m:.4g} m and {room.high_m:.4g} m"
        )
        # a negative bound bounds nothing
        holds = min(0.0, *room) == 0 and is_within(off, room)
        self._record.check(holds, body.Time, body.ObserverID, text)

    def end(self, at_ms: int) -> None:
        """End of the messages: notes sensed states without a true state, unless the aircraft has
        vanished, and aircraft that were never sensed.
        """
        left = [
            (time_ms, number)
            for time_ms, number in sorted(self._waiting)
            if number not in self._gone or not lasted(self._gone[number], time_ms, 0)
        ]
        for time_ms, number in left[:FEW]:
            self._record.gaps.append(
                f"no true state of aircraft {number} of {time_ms / 1000:.2f} s came by {at_ms / 1000:.2f} s"
            )
        pairs = ((own, other) for own in self._instances for other in sorted(self._there))
        for own, other in [one for one in pairs if one not in self._sensed][:FEW]:
            self._record.gaps.append(f"{own} never sensed aircraft {other}")

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {NAME: self._record}
