"""The assumptions under which each item is served: short ICAROUS stays, chains flown in time, no other failure."""

from __future__ import annotations

from dataclasses import dataclass, field

from cratous.core.authority.gate import ICAROUS, UXAS, gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.core.executive.steps import leg_given_up
from cratous.services.assumptions.authority import reported
from cratous.services.assumptions.given_up import LATE_BEATS, SETTLED, UNHEARD
from cratous.services.assumptions.observed import Message, Record
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS, MOST_TAKEOVERS
from cratous.spec.mission import GroundedVehicle, Mission
from cratous.spec.mission.changes import VEHICLE_HOLDS

GIVEN_UP = "blocked: "
"""Prefix of a task's note if its item was given up because of the time under ICAROUS."""


@dataclass
class _Chain:
    """One vehicle. since_ms: start of ICAROUS's sole command, None outside; takeovers, stay_ms:
    their number and the longest stay on the current item; most, longest_ms: maxima over all items;
    under_ms: total of all stays; items: those it was on its way to; done_ms: time at which it left
    the last.
    """

    since_ms: int | None = None
    takeovers: int = 0
    stay_ms: int = 0
    most: int = 0
    longest_ms: int = 0
    under_ms: int = 0
    done_under_ms: int = 0
    done_ms: int = 0
    task_id: int = 0
    items: set[int] = field(default_factory=set)


class ServedWatch:
    """Checks stays: times of sole command by ICAROUS, from a takeover or withdrawn offer to the
    next offer.

    UxAS counts takeovers and stays as it hears of them, each up to two heartbeats late. If an item
    is not subject to its time limit (vehicle on the ground, without link, or holding by command), a
    stay that is too long is not observed.
    """

    kinds = ("GateState", "TaskProgress", UNHEARD)

    def __init__(self, mission: Mission) -> None:
        simulation = mission.simulation
        self._late_ms = LATE_BEATS * simulation.heartbeat_ms
        self._longest_ms = round(1000 * LONGEST_LOOKAHEADS * mission.daa.lookahead_s)
        self._limit_ms = simulation.limit_ms
        self._chains = {v.id: _Chain() for v in mission.vehicles}
        ground = {v.id for v in mission.vehicles if isinstance(v, GroundedVehicle)}
        self._spared = ground | {c.vehicle for c in mission.changes if c.kind == VEHICLE_HOLDS}
        waits = "no vehicle was taken over on its way to an item"
        self._stays = Record("s", self._longest_ms / 1000, (leg_given_up,), waits=waits)
        self._time = Record("s", self._limit_ms / 1000, (in_time,), waits="no item was left")
        self._failed = Record("tasks", 0, waits="no task was settled")
        self._failures = 0

    def message(self, message: Message) -> None:
        """Process one message: commander of a vehicle, its current item, or the item's outcome."""
        if message.kind not in self.kinds:
            return
        body, now_ms = message.body, message.time_ms
        if message.kind == UNHEARD:
            self._spared.add(body.VehicleID)
            return
        chain = self._chains.get(body.VehicleID)
        if message.kind == "TaskProgress":
            self._progress(chain, message)
        elif chain is not None:
            gate = reported(body)
            alone = gate_accepts(gate, ICAROUS, gate.epoch) and not gate_accepts(
                gate, UXAS, gate.epoch
            )
            if alone and chain.since_ms is None:
                chain.since_ms = now_ms
                chain.takeovers += 1
            elif not alone and chain.since_ms is not None:
                self._stayed(body.VehicleID, chain, now_ms)
                chain.under_ms += now_ms - chain.since_ms
                chain.since_ms = None

    def _progress(self, chain: _Chain | None, message: Message) -> None:
        body, now_ms = message.body, message.time_ms
        phase = body.Phase.name
        if phase in SETTLED:
            other = phase != "Complete" and not body.Note.startswith(GIVEN_UP)
            self._failures += other
            self._failed.see(self._failures)
            text = f"task {body.TaskID} failed: {body.Note}"
            self._failed.check(not other, now_ms, body.VehicleID, text)
        if chain is None:
            return
        if phase in SETTLED:
            if body.TaskID in chain.items:
                self._left(body.VehicleID, chain, now_ms)
        elif body.TaskID:
            chain.task_id = body.TaskID
            chain.items.add(body.TaskID)

    def _stayed(self, vid: int, chain: _Chain, now_ms: int) -> None:
        """Check the current item's counts up to now_ms, an open stay included, against the limits."""
        if chain.since_ms is not None:
            late_ms = self._late_ms
            chain.stay_ms = max(chain.stay_ms, now_ms - chain.since_ms + late_ms)
        if not chain.task_id or not chain.takeovers:
            return
        could_ms = (chain.takeovers + 1) * chain.stay_ms
        given_up = leg_given_up(chain.takeovers, MOST_TAKEOVERS, could_ms, self._longest_ms)
        text = (
            f"vehicle {vid} was taken over {chain.takeovers} times on its way to task {chain.task_id}, for up to"
            f" {chain.stay_ms / 1000:g} s each time"
        )
        self._stays.see(could_ms / 1000)
        if given_up and vid in self._spared:
            if not self._stays.gaps:
                self._stays.gaps.append(f"{text}, and is not held to its time")
        else:
            self._stays.check(not given_up, now_ms, vid, text)

    def _left(self, vid: int, chain: _Chain, now_ms: int) -> None:
        """The vehicle leaves its current item."""
        self._stayed(vid, chain, now_ms)
        open_ms = 0 if chain.since_ms is None else now_ms - chain.since_ms
        chain.most = max(chain.most, chain.takeovers)
        chain.longest_ms = max(chain.longest_ms, chain.stay_ms)
        chain.done_ms, chain.done_under_ms = now_ms, chain.under_ms + open_ms
        chain.takeovers = chain.stay_ms = chain.task_id = 0

    def end(self, at_ms: int) -> None:
        """End of the messages at at_ms [ms]: open stays count up to here, and each chain is checked."""
        for vid, chain in self._chains.items():
            if chain.task_id:
                self._left(vid, chain, at_ms)
            if not chain.items:
                continue
            own_ms = chain.done_ms - chain.done_under_ms
            all_ms = own_ms + len(chain.items) * (chain.most + 1) * chain.longest_ms
            text = (
                f"UxAS flew the chain of vehicle {vid} for {own_ms / 1000:g} s, and with {len(chain.items)} items, up to"
                f" {chain.most} takeovers on one and stays of up to {chain.longest_ms / 1000:g} s that may last longer"
                " than the limit"
            )
            self._time.see(all_ms / 1000)
            self._time.check(in_time(0, all_ms, self._limit_ms), at_ms, vid, text)

    def records(self) -> dict[str, Record]:
        """The observations so far, by name of the assumption (see `Watch`)."""
        return {
            "stays bounded": self._stays,
            "flown in time": self._time,
            "no other failure": self._failed,
        }
