"""DAIDALUS_WCV_Detection: predicts losses of well clear of a vehicle and the manoeuvres that avoid
them.

AirVehicleState of ownship and intruders -> WellClearViolationIntervals at each ownship state, from
the proved engine (`core.daa.session`); DAIDALUSConfiguration once, before the first. Intervals are
of (true) headings and airspeeds, as in DAIDALUS with wind; without wind these are courses and
ground speeds. A dimension that cannot be evaluated (own value out of range) is one NEAR interval
over the whole range, and a ServiceStatus gives the reason.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.authority.timeliness import in_time, lasted
from cratous.core.daa.session import Session
from cratous.services.bus import Envelope
from cratous.services.daa.intervals import OwnState, intervals_message
from cratous.services.uxas.daidalus.parameters import configuration_message
from cratous.services.uxas.daidalus.states import Wind, air_vector, aircraft, comparable, wind_of
from cratous.spec.daa.parameters import Parameters
from cratous.spec.errors import BadInput

STATE, STARTED = "afrl.cmasi.AirVehicleState", "uxas.messages.uxnative.StartupComplete"
REMOVED = "afrl.cmasi.RemoveEntities"
TELL_MS = 500
"""Usual interval of aircraft states [ms]: with a period of two intervals, half of the vehicles compute at each."""


class Known(NamedTuple):
    """Latest state of each vehicle, DAA session, whether the parameters were sent, active warnings,
    and time of the ownship state last evaluated [ms].
    """

    session: Session
    states: dict[int, Any]
    told: bool = False
    warned: frozenset[str] = frozenset()
    looked_ms: int = 0


Step = tuple[Known, Iterable[Any]]


def told_of(own: Any, wind: Wind) -> OwnState:
    """Ownship state as reported in the message: heading and airspeed."""
    at = own.Location
    return OwnState(
        own.ID,
        *air_vector(own, wind),
        own.VerticalSpeed,
        at.Altitude,
        at.Latitude,
        at.Longitude,
        own.Time / 1000,
    )


class DaidalusDetection:
    """Detection for one vehicle. period_ms: minimum interval between evaluations, staggered between vehicles."""

    subscribes: tuple[str, ...] = (STATE, STARTED, REMOVED)

    def __init__(self, name: str, vehicle: int, parameters: Parameters, period_ms: int = 0) -> None:
        self._period_ms = period_ms
        self.name, self._vehicle, self._parameters = name, vehicle, parameters
        self._stale_ms = int(1000 * parameters.lookahead_time_s)

    def start(self) -> Known:
        turn_ms = self._vehicle * TELL_MS % self._period_ms if self._period_ms else 0
        return Known(Session(self._parameters), {}, looked_ms=turn_ms - self._period_ms)

    def handle(self, state: Known, envelope: Envelope, now_ms: int) -> Step:
        body, topic = envelope.body, envelope.topic
        if topic == REMOVED:
            left = {n: s for n, s in state.states.items() if n not in body.EntityList}
            return state._replace(states=left), ()
        out: list[Any] = []
        if not state.told:
            out.append(configuration_message(self._vehicle, self._parameters))
            state = state._replace(told=True)
        if topic == STARTED:
            return state, out
        state = state._replace(states={**state.states, body.ID: body})
        early, late = sorted((state.looked_ms, int(body.Time)))
        if self._vehicle != body.ID or not lasted(early, late, self._period_ms):
            return state, out
        return self._look(state._replace(looked_ms=int(body.Time)), body, out)

    def _look(self, state: Known, own: Any, out: list[Any]) -> Step:
        wind = wind_of(own)
        others, why = [], []
        for number, other in sorted(state.states.items()):
            if number == own.ID:
                continue
            # an intruder's state may be earlier or later than the ownship's
            early, late = sorted((own.Time, other.Time))
            if not in_time(early, late, self._stale_ms):
                why.append(f"vehicle {number}: its state is too old, it is left out")
                continue
            if not comparable(own, other):
                why.append(
                    f"vehicle {number}: an altitude of another type, taken to be the own one"
                )
            seen = aircraft(own, other, wind)
            if not math.isfinite(sum(seen[1:7])):
                why.append(f"vehicle {number}: its state is not finite, it is left out")
                continue
            others.append(seen)
        try:
            me = aircraft(own, own, wind)
            instant = state.session.step(own.Time / 1000, me, others)
        except BadInput as error:
            why.append(f"nothing can be said: {error}")
            return self._warn(state, why, out)
        why += [f"{g.dimension}: {g.why}" for g in instant.guidance if g.why]
        out.append(intervals_message(told_of(own, wind), instant))
        return self._warn(state, why, out)

    def _warn(self, state: Known, why: list[str], out: list[Any]) -> Step:
        """Send a warning for each new reason, ignoring its numbers, and again if it recurs after a break."""
        kinds = {
            text: "".join(c for c in text if not c.isdigit() and c not in ".-e") for text in why
        }
        for text, kind in kinds.items():
            if kind not in state.warned:
                pairs = (("VehicleID", str(self._vehicle)), ("reason", text))
                info = [lmcp.new("KeyValuePair", Key=k, Value=v) for k, v in pairs]
                out.append(lmcp.new("ServiceStatus", StatusType="Warning", Info=info))
        return state._replace(warned=frozenset(kinds.values())), out
