"""What a flight tells of itself besides commands, as LMCP messages: gates, authority, plan, conflicts."""

from __future__ import annotations

from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.gate import Gate
from cratous.services.flight.commands import SENDERS
from cratous.services.icarous.messages import Foresees
from cratous.services.logs.records import fingerprint, to_data
from cratous.spec.mission.plan import Plan


def gate_state(vehicle_id: int, now_ms: int, gate: Gate) -> Any:
    """How a vehicle's gate stands, as a `GateState`."""
    return lmcp.new(
        "GateState",
        VehicleID=vehicle_id,
        Time=now_ms,
        Owner=SENDERS[gate.owner],
        Epoch=gate.epoch,
        Offered=gate.offered,
    )


def authority_change(
    vehicle_id: int, now_ms: int, gate: Gate, reason: str, intruder_id: int
) -> Any:
    """Who commands a vehicle from now on, since which epoch and why, as an `AuthorityChange`."""
    return lmcp.new(
        "AuthorityChange",
        VehicleID=vehicle_id,
        Time=now_ms,
        Owner=SENDERS[gate.owner],
        Epoch=gate.epoch,
        Reason=reason,
        IntruderID=intruder_id,
    )


def plan_accepted(now_ms: int, plan: Plan, done: frozenset[int]) -> Any:
    """By which plan is flown from now on, as a `PlanAccepted`; `done` are the tasks already flown."""
    return lmcp.new(
        "PlanAccepted",
        Time=now_ms,
        Makespan=plan.makespan_ms,
        PlanHash=fingerprint(to_data(plan)),
        Tasks=sorted(done | {item.task_id for item in plan.items}),
    )


def conflict(foreseen: Foresees) -> Any:
    """What an ICAROUS instance foresees and does about it, as a `Conflict`."""
    return lmcp.new(
        "Conflict",
        VehicleID=foreseen.vehicle_id,
        IntruderID=foreseen.intruder_id,
        Time=foreseen.now_ms,
        TimeToViolation_s=foreseen.first_violation_s,
        Resolution=foreseen.resolution,
    )
