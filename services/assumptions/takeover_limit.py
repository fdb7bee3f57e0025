"""The assumption that the executive counts takeovers on each item and gives up an item with too many."""

from __future__ import annotations

from dataclasses import dataclass

from cratous.core.authority.timeliness import lasted
from cratous.core.executive.steps import leg_given_up
from cratous.services.assumptions.authority import icarous_has
from cratous.services.assumptions.link import DeliveryWatch
from cratous.services.assumptions.observations import Message, Record
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS, MOST_TAKEOVERS
from cratous.services.mission.merging import merging_ms
from cratous.spec.mission import GroundedVehicle, Mission
from cratous.spec.mission.changes import VEHICLE_HOLDS

TO_ITEM, SETTLED = ("Transit", "Active"), ("Complete", "Failed")
LATE_BEATS = 4
"""Heartbeats by which UxAS may learn late of a takeover: two for its start, two for its end."""
UNHEARD, LINKED, BEAT = "LinkLossState", "Linked", "Heartbeat"


@dataclass
class _Leg:
    """One vehicle on an item. task_id: 0 if there is none; since_ms: time of the takeover, None under UxAS."""

    task_id: int = 0
    takeovers: int = 0
    under_ms: int = 0
    since_ms: int | None = None

    def flown_ms(self, now_ms: int) -> int:
        """Total time under ICAROUS on the item up to now_ms [ms]."""
        return self.under_ms + (now_ms - self.since_ms if self.since_ms is not None else 0)


class GivenUpWatch:
    """Checks takeovers, and time under ICAROUS, on each item against the executive's limits.

    Vehicles that start on the ground or fly without their link are not subject to the time limit;
    vehicles that hold by command to neither limit, since no item is given up while they hold.
    Excess in these cases is not observed. UxAS does not hear of takeovers without the link, so they
    count on no item. If lines of ICAROUS came late or were lost, UxAS knew less than is seen here:
    excess is then not observed.
    """

    kinds = ("AuthorityChange", "TaskProgress", UNHEARD, BEAT)

    def __init__(self, mission: Mission) -> None:
        self._legs = {v: _Leg() for v in mission.instances}
        self._beat_ms = mission.simulation.heartbeat_ms
        longest_ms = round(1000 * LONGEST_LOOKAHEADS * mission.daa.lookahead_s)
        longest_ms += LATE_BEATS * self._beat_ms
        self._longest_ms = {v: longest_ms + merging_ms(mission, v) for v in mission.instances}
        self._last_ms: dict[int, int] = {}
        self._alone: set[int] = set()
        self._delivery = DeliveryWatch(mission)
        ground = {v.id for v in mission.vehicles if isinstance(v, GroundedVehicle)}
        self._holders = {c.vehicle for c in mission.changes if c.kind == VEHICLE_HOLDS}
        self._spared = ground | self._holders
        waits = "no vehicle was taken over on its way to an item"
        self._record = Record("takeovers", MOST_TAKEOVERS + 1, (leg_given_up, lasted), waits=waits)

    def message(self, message: Message) -> None:
        """Process one message: commander and current plan item of each vehicle."""
        if message.kind not in self.kinds:
            return
        if message.kind == BEAT:
            self._delivery.message(message)
            return
        vid, now_ms = message.body.VehicleID, message.time_ms
        if message.kind == "TaskProgress" and not vid:
            self._left(message.body.TaskID, now_ms)
            return
        leg = self._legs.get(vid)
        if leg is None:
            return
        if message.kind == UNHEARD:
            self._spared.add(vid)
            linked = message.body.Mode.name == LINKED
            (self._alone.discard if linked else self._alone.add)(vid)
        elif message.kind == "AuthorityChange":
            self._changes(vid, leg, message)
        elif message.body.Phase.name in TO_ITEM and message.body.TaskID != leg.task_id:
            self._time(vid, leg, now_ms)
            since_ms = None if leg.since_ms is None else now_ms
            self._legs[vid] = _Leg(message.body.TaskID, since_ms=since_ms)
        elif message.body.Phase.name in SETTLED:
            self._left(message.body.TaskID, now_ms, vid)

    def _left(self, task_id: int, now_ms: int, only: int = 0) -> None:
        """A task is settled: ends the item of each vehicle on its way to it, or waiting with it unassigned."""
        for vid, leg in self._legs.items():
            if leg.task_id == task_id and vid == (only or vid):
                self._time(vid, leg, now_ms)
                self._legs[vid] = _Leg(since_ms=leg.since_ms)

    def _changes(self, vid: int, leg: _Leg, message: Message) -> None:
        now_ms = message.time_ms
        if not icarous_has(message.body):
            self._time(vid, leg, now_ms)
            leg.under_ms, leg.since_ms = leg.flown_ms(now_ms), None
            return
        apart = vid not in self._last_ms or lasted(self._last_ms[vid], now_ms, self._beat_ms)
        text = f"vehicle {vid} was taken over twice between two heartbeats"
        self._record.check(apart, now_ms, vid, text)
        self._last_ms[vid], leg.since_ms = now_ms, now_ms
        if not leg.task_id or vid in self._alone or vid in self._holders:
            return
        given_up = leg_given_up(leg.takeovers, MOST_TAKEOVERS, 0, self._longest_ms[vid])
        leg.takeovers += 1
        self._record.see(leg.takeovers)
        text = f"takeover {leg.takeovers} of vehicle {vid} on its way to task {leg.task_id}"
        self._allowed(not given_up, now_ms, vid, text)

    def _time(self, vid: int, leg: _Leg, now_ms: int) -> None:
        """Check the time under ICAROUS on an item that ends now."""
        if not leg.task_id:
            return
        flown_ms = leg.flown_ms(now_ms)
        given_up = leg_given_up(0, MOST_TAKEOVERS, flown_ms, self._longest_ms[vid])
        text = f"vehicle {vid} was flown for {flown_ms / 1000:g} s by ICAROUS on its way to task {leg.task_id}"
        if vid in self._spared:
            if given_up and not self._record.gaps:
                self._record.gaps.append(f"{text}, and is not held to its time")
            return
        self._allowed(not given_up, now_ms, vid, text)

    def _allowed(self, holds: bool, now_ms: int, vid: int, text: str) -> None:
        """Record an excess as a break if UxAS had heard what is seen here; otherwise as not observed."""
        if not holds:
            self._delivery.end(now_ms)
        (delivery,) = self._delivery.records().values()
        if holds or delivery.broken is None:
            self._record.check(holds, now_ms, vid, text)
        elif not self._record.gaps:
            self._record.gaps.append(f"{text}, and UxAS heard of it late: {delivery.broken.text}")

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: items still under way are checked against their time as well."""
        for vid, leg in self._legs.items():
            self._time(vid, leg, at_ms)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {"items given up": self._record}
