"""Reports of a flight as LMCP messages, other than commands: gates, authority, plan, conflicts, truth."""

from __future__ import annotations

from typing import Any

from cratous.bridge import lmcp
from cratous.bridge.text_protocol import SetMode
from cratous.core.authority.gate import ICAROUS, UXAS, Gate, epoch_given
from cratous.services.flight.commands import SENDERS
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.holding import Change
from cratous.services.icarous.messages import (
    Checks,
    Decides,
    Fails,
    Foresees,
    Guides,
    Hears,
    Merges,
    TakesOff,
    WithoutLink,
)
from cratous.services.logs.records import fingerprint, to_data
from cratous.services.mission.frames import Projection, compass, place_and_velocity
from cratous.spec.mission.plan import Plan


def gate_state(vehicle_id: int, now_ms: int, gate: Gate) -> Any:
    """A `GateState`: owner, epoch and offer of a vehicle's gate at now_ms [ms]."""
    return _of_gate("GateState", vehicle_id, now_ms, gate, Offered=gate.offered)


def hand_state(vehicle_id: int, now_ms: int, change: Change) -> Any:
    """A change of the held certificate, as a `HandState`: the hand before and after, and the offer."""
    kind, before, after, offer, permitted, intruder_id, reason = change
    # a refusal logs the offer, not the hand
    refused = kind == "Refused"
    return lmcp.new(
        "HandState",
        VehicleID=vehicle_id,
        Time=now_ms,
        Change=kind,
        Base=offer.base if refused else before.id,
        BaseExpiry=before.expiry_ms,
        ID=offer.id if refused else after.id,
        Sigma=offer.sigma_ms,
        Knowledge=offer.knowledge if refused else after.knowledge,
        Expiry=offer.expiry_ms if refused else after.expiry_ms,
        Surprises=after.surprises,
        Permitted=permitted,
        IntruderID=intruder_id,
        Reason=reason,
    )


def _of_gate(name: str, vehicle_id: int, now_ms: int, gate: Gate, **more: Any) -> Any:
    owner = SENDERS[gate.owner]
    return lmcp.new(name, VehicleID=vehicle_id, Time=now_ms, Owner=owner, Epoch=gate.epoch, **more)


def dropped(command: Any, now_ms: int, sender: int, gate: Gate) -> Any:
    """A `GatedCommand` that the gate rejected, as a `CommandDropped` with the reason."""
    reason = "sent by one without authority"
    if not epoch_given(gate, command.Epoch):
        reason = "of an epoch that was never given"
    elif command.Epoch != gate.epoch:
        reason = "of another epoch"
    return lmcp.new(
        "CommandDropped",
        VehicleID=command.VehicleID,
        Time=now_ms,
        Sender=SENDERS[sender],
        Epoch=command.Epoch,
        GateEpoch=gate.epoch,
        Reason=reason,
    )


def mode_refused(vehicle_id: int, now_ms: int, line: SetMode, epoch: int, gate: Gate) -> Any:
    """A SETMOD that says what cannot be true, as a `ModeRefused`."""
    reason = "of the present epoch, which began otherwise"
    if not epoch_given(gate, epoch):
        reason = "of an epoch that was never given"
    return lmcp.new(
        "ModeRefused",
        VehicleID=vehicle_id,
        Time=now_ms,
        Owner=SENDERS[ICAROUS if line.mode == "ACTIVE" else UXAS],
        Epoch=epoch,
        GateEpoch=gate.epoch,
        Reason=reason,
    )


def authority_change(
    vehicle_id: int, now_ms: int, gate: Gate, reason: str, intruder_id: int
) -> Any:
    """An `AuthorityChange`: who commands a vehicle from now_ms [ms] on, in which epoch and why."""
    more = {"Reason": reason, "IntruderID": intruder_id}
    return _of_gate("AuthorityChange", vehicle_id, now_ms, gate, **more)


def plan_accepted(now_ms: int, plan: Plan, done: frozenset[int]) -> Any:
    """A `PlanAccepted`: the plan in force from now_ms [ms] on; `done`: tasks already served."""
    return lmcp.new(
        "PlanAccepted",
        Time=now_ms,
        Makespan=plan.makespan_ms,
        PlanHash=fingerprint(to_data(plan)),
        Tasks=sorted(done | {item.task_id for item in plan.items}),
    )


def conflict(foreseen: Foresees) -> Any:
    """A conflict predicted by an ICAROUS instance and its resolution, as a `Conflict`."""
    return lmcp.new(
        "Conflict",
        VehicleID=foreseen.vehicle_id,
        IntruderID=foreseen.intruder_id,
        Time=foreseen.now_ms,
        TimeToViolation_s=foreseen.first_violation_s,
        Resolution=foreseen.resolution,
    )


def link_loss_state(said: WithoutLink) -> Any:
    """A vehicle's behaviour while UxAS is not heard, or that UxAS is heard again, as a `LinkLossState`."""
    return _mode_told("LinkLossState", said, Chosen=said.chosen)


def uxas_heard(said: Hears) -> Any:
    """A `UxasHeard`: a vehicle's ICAROUS no longer hears UxAS, or hears it again."""
    return lmcp.new(
        "UxasHeard",
        VehicleID=said.vehicle_id,
        Time=said.now_ms,
        Heard=said.heard,
        Last=said.last_ms,
    )


def take_off_state(said: TakesOff) -> Any:
    """A `TakeOffState`: how a vehicle leaves the ground, or why it waits."""
    return _mode_told("TakeOffState", said)


def merge_state(said: Merges) -> Any:
    """A `MergeState`: the stage, request and slot of a vehicle that merges, and the election as it knows it."""
    return lmcp.new(
        "MergeState",
        VehicleID=said.vehicle_id,
        Time=said.now_ms,
        Stage=said.stage,
        Term=said.term,
        Leader=said.leader,
        Request=said.request,
        Slot=said.slot,
        Reason=said.reason,
    )


def failure_state(said: Fails) -> Any:
    """A `FailureState`: the failure that a vehicle's ICAROUS declares, and the intruder concerned."""
    return lmcp.new(
        "FailureState",
        VehicleID=said.vehicle_id,
        Time=said.now_ms,
        Failure=said.failure,
        IntruderID=said.intruder_id,
        Reason=said.reason,
    )


def failure_check(said: Checks) -> Any:
    """A `FailureCheck`: what a failure follows from at a heartbeat, and which one is due next."""
    seen = said.seen
    return lmcp.new(
        "FailureCheck",
        VehicleID=said.vehicle_id,
        Time=said.now_ms,
        OnGround=said.on_ground,
        Stopped=seen.stopped,
        Flies=seen.flies,
        Without=seen.without,
        Since=seen.since_ms,
        Surprised=seen.surprised,
        Expiry=seen.expiry_ms,
        Failure=said.due.kind,
        DueBy=said.due.by_ms,
    )


def cognition_state(said: Decides) -> Any:
    """A `CognitionState`: the mode of a vehicle's ICAROUS from now on, and the conditions for it."""
    conditions = {name.capitalize(): value for name, value in said.seen._asdict().items()}
    return lmcp.new(
        "CognitionState",
        VehicleID=said.vehicle_id,
        Time=said.now_ms,
        Mode=said.mode,
        Resolution=said.resolution,
        IntruderID=said.intruder_id,
        Skipped=said.skipped,
        **conditions,
    )


def of_instance(
    said: Foresees | WithoutLink | Fails | Checks | TakesOff | Hears | Merges | Decides,
) -> Any:
    """An instance's notice for the record, as a message."""
    match said:
        case Foresees():
            return conflict(said)
        case WithoutLink():
            return link_loss_state(said)
        case Fails():
            return failure_state(said)
        case Checks():
            return failure_check(said)
        case TakesOff():
            return take_off_state(said)
        case Hears():
            return uxas_heard(said)
        case Merges():
            return merge_state(said)
        case Decides():
            return cognition_state(said)


def _mode_told(name: str, said: WithoutLink | TakesOff, **more: Any) -> Any:
    ours = {"VehicleID": said.vehicle_id, "Time": said.now_ms, "Mode": said.mode}
    return lmcp.new(name, **ours, Heard=said.heard_ms, Reason=said.reason, **more)


def guidance(told: Guides, projection: Projection) -> Any:
    """A vehicle's alerts and bands as WellClearViolationIntervals, with directions and speeds over ground."""
    from cratous.services.daa.intervals import OwnState, intervals_message

    now, place = told.motion, told.motion.position
    at = projection.to_geodetic(place.north_m, place.east_m)
    heading, seconds = compass(now.heading_rad), told.now_ms / 1000
    own = (told.vehicle_id, heading, now.speed_m_s, now.climb_m_s, place.alt_m, *at, seconds)
    return intervals_message(OwnState(*own), told.instant)


def truth(vehicle_id: int, s: AirState, now_ms: int, cooperative: bool) -> Any:
    """An aircraft's true position and velocity until the next step, as a `TruthState` for the monitor."""
    return lmcp.new(
        "TruthState",
        VehicleID=vehicle_id,
        Time=now_ms,
        **place_and_velocity(s.position, s.velocity),
        Heading=compass(s.heading_rad),
        Cooperative=cooperative,
    )


def mission_change(now_ms: int, what: str, answer: str) -> Any:
    """A mission change and the reaction to it, as a `MissionChange`."""
    return lmcp.new("MissionChange", Time=now_ms, What=what, Consequence=answer)


def mission_end(now_ms: int, outcome: str) -> Any:
    """A `MissionEnd`: the flight has ended at now_ms [ms], and its outcome."""
    return lmcp.new("MissionEnd", Time=now_ms, Outcome=outcome)


def heartbeat(vehicle_id: int, now_ms: int, direction: str, sequence: int) -> Any:
    """A heartbeat of the bridge: direction "Down" to ICAROUS or "Up" from it."""
    return lmcp.new(
        "Heartbeat", VehicleID=vehicle_id, Time=now_ms, Direction=direction, Sequence=sequence
    )


def bridge_status(vehicle_id: int, alive: bool, now_ms: int, note: str) -> Any:
    """A `BridgeStatus`: whether a vehicle's instance is heard at now_ms [ms], and why this is reported."""
    return lmcp.new("BridgeStatus", VehicleID=vehicle_id, Time=now_ms, Alive=alive, Note=note)
