"""The assumptions under which each item is served: short ICAROUS stays, chains flown in time, no other failure."""

from __future__ import annotations

from dataclasses import dataclass, field

from cratous.core.authority.gate import ICAROUS, UXAS, Gate, epoch_given, gate_accepts
from cratous.core.authority.timeliness import in_time
from cratous.core.executive.steps import leg_given_up
from cratous.services.assumptions.authority import UNTOUCHED, reported, sender_of
from cratous.services.assumptions.observations import Message, Record
from cratous.services.assumptions.takeover_limit import LATE_BEATS, SETTLED, TO_ITEM, UNHEARD
from cratous.services.mission.leg_bounds import LONGEST_LOOKAHEADS, MOST_TAKEOVERS
from cratous.spec.mission import GroundedVehicle, Mission
from cratous.spec.mission.changes import TASK_REMOVED, VEHICLE_HOLDS

GIVEN_UP = "blocked: "
"""Prefix of a task's note if its item was given up because of the time under ICAROUS."""


@dataclass
class _Chain:
    """One vehicle. gate: as last reported; since_ms: start of ICAROUS's sole command, None outside; takeovers, stay_ms:
    their number and the longest stay on the current item; most, longest_ms: maxima over earlier items; under_ms: total
    of all stays; items: those it was on its way to; done_ms: time at which it left the last."""

    gate: Gate = UNTOUCHED
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

    UxAS counts takeovers and stays as it hears of them, each up to two heartbeats late. If an item is not subject to its
    time limit (vehicle on the ground, without link, or holding by command), a stay that is too long is not observed.
    Neither are stays and times where a gate report is missing, nor failures where a task is not seen to its end.
    """

    kinds = (
        "AuthorityChange",
        "GateState",
        "GatedCommand",
        "PlanAccepted",
        "TaskProgress",
        UNHEARD,
    )

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
        self._removed = {c.task for c in mission.changes if c.kind == TASK_REMOVED}
        self._accepted: tuple[int, ...] = ()
        self._open: set[int] = set()
        self._settled: set[int] = set()

    def message(self, message: Message) -> None:
        """Process one message: commander of a vehicle, its current item, or the item's outcome."""
        if message.kind not in self.kinds:
            return
        body = message.body
        if message.kind == UNHEARD:
            self._spared.add(body.VehicleID)
            return
        if message.kind == "PlanAccepted":
            self._accepted = tuple(body.Tasks)
            return
        chain = self._chains.get(body.VehicleID)
        if message.kind == "TaskProgress":
            self._progress(chain, message)
        elif chain is None:
            return
        elif message.kind == "GateState":
            self._gate(chain, message)
        elif message.kind == "AuthorityChange" or sender_of(body) == ICAROUS:
            self._unreported(chain, chain.gate, message)

    def _gate(self, chain: _Chain, message: Message) -> None:
        """Process a gate report: a stay of ICAROUS may begin or end."""
        gate, now_ms = reported(message.body), message.time_ms
        self._unreported(chain, chain.gate._replace(epoch=chain.gate.epoch + 1), message)
        chain.gate = gate
        alone = gate_accepts(gate, ICAROUS, gate.epoch) and not gate_accepts(gate, UXAS, gate.epoch)
        if alone and chain.since_ms is None:
            chain.since_ms = now_ms
            chain.takeovers += 1
        elif not alone and chain.since_ms is not None:
            self._stayed(message.body.VehicleID, chain, now_ms)
            chain.under_ms += now_ms - chain.since_ms
            chain.since_ms = None

    def _unreported(self, chain: _Chain, known: Gate, message: Message) -> None:
        """Note the first message with an epoch that was never reported."""
        body = message.body
        if self._time.gaps or epoch_given(known, body.Epoch):
            return
        gap = (
            f"at {message.time_ms / 1000:.2f} s vehicle {body.VehicleID} is in epoch {body.Epoch}, and its gate was last"
            f" reported in epoch {chain.gate.epoch}"
        )
        self._time.gaps.append(gap)
        self._stays.gaps.append(gap)

    def _progress(self, chain: _Chain | None, message: Message) -> None:
        body, now_ms = message.body, message.time_ms
        phase = body.Phase.name
        self._open.add(body.TaskID)
        if phase in SETTLED:
            self._settled.add(body.TaskID)
            other = phase != "Complete" and not body.Note.startswith(GIVEN_UP)
            self._failures += other
            self._failed.see(self._failures)
            text = f"task {body.TaskID} failed: {body.Note}"
            self._failed.check(not other, now_ms, body.VehicleID, text)
        if not body.VehicleID:  # it is settled, or waits unassigned
            for vid, one in self._chains.items():
                if one.task_id and one.task_id == body.TaskID:
                    self._left(vid, one, now_ms)
        elif chain is None:
            return
        elif phase in SETTLED:
            if body.TaskID in chain.items:
                self._left(body.VehicleID, chain, now_ms)
        elif body.TaskID and (phase in TO_ITEM or not chain.task_id):
            if chain.task_id not in (0, body.TaskID):  # another plan has it do this first
                self._left(body.VehicleID, chain, now_ms)
            chain.task_id = body.TaskID
            chain.items.add(body.TaskID)

    def _stayed(self, vid: int, chain: _Chain, now_ms: int) -> None:
        """Check the counts of all items up to now_ms together, an open stay included, against the limits, since
        `spec.system.serving.Bounds` are the same for each."""
        if chain.since_ms is not None:
            late_ms = self._late_ms
            chain.stay_ms = max(chain.stay_ms, now_ms - chain.since_ms + late_ms)
        if not chain.task_id or not (chain.takeovers or chain.stay_ms):
            return
        most, stay_ms = max(chain.most, chain.takeovers), max(chain.longest_ms, chain.stay_ms)
        could_ms = (most + 1) * stay_ms
        given_up = leg_given_up(most, MOST_TAKEOVERS, could_ms, self._longest_ms)
        where = f"task {chain.task_id}" if chain.takeovers == most else "an earlier task"
        text = (
            f"vehicle {vid} was taken over {most} times on its way to {where}, and on its chain ICAROUS stayed for up to"
            f" {stay_ms / 1000:g} s"
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
        open_still = sorted((self._open | {*self._accepted}) - self._settled - self._removed)
        self._failed.gaps += [f"task {one} was not seen to its end" for one in open_still[:1]]
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
