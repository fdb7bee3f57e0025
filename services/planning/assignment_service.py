"""AssignmentTreeBranchBoundService: from the cost matrix to who does what, or why nobody can."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.core.assignment import START, Assignment
from cratous.services.bus import Envelope
from cratous.services.planning import mission_assign, reasons
from cratous.services.planning.desk import Desk, Inputs, status
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission


class Assigned(NamedTuple):
    """Results by request id: the assignment, or the reasons why there is none."""

    found: dict[int, Assignment]
    failed: dict[int, tuple[str, ...]]


class AssignmentTreeBranchBoundService:
    """AssignmentCostMatrix -> TaskAssignmentSummary, or an error status with the reasons.

    In the summary TimeThreshold is the instant at which the task starts, so that a later
    departure becomes a wait; TimeTaskCompleted is its end (ms after mission start).
    """

    name = "AssignmentTreeBranchBoundService"
    subscribes: tuple[str, ...] = ("uxas.messages.task.AssignmentCostMatrix",)

    def __init__(self, desk: Desk) -> None:
        self._desk = desk

    def start(self) -> Assigned:
        return Assigned({}, {})

    def handle(
        self, state: Assigned, envelope: Envelope, now_ms: int
    ) -> tuple[Assigned, Iterable[Any]]:
        matrix = envelope.body
        key = matrix.CorrespondingAutomationRequestID
        inputs = self._desk.inputs(key)
        travel_ms = travel_of(inputs, matrix.CostMatrix)
        why = reasons.why_none(inputs)
        found = self._found(inputs, travel_ms, why)
        if found.assignment is None:
            failed = {**state.failed, key: found.reasons}
            return state._replace(failed=failed), [
                status(key, "Error", [("reason", text) for text in found.reasons])
            ]
        result = inputs.assigned = found.assignment
        inputs.certificate = found.certificate
        listed = [
            lmcp.new(
                "TaskAssignment",
                TaskID=inputs.options[placed.candidate].task_id,
                OptionID=inputs.options[placed.candidate].option_id,
                AssignedVehicle=inputs.mission.vehicles[placed.vehicle].id,
                TimeThreshold=placed.start_ms,
                TimeTaskCompleted=placed.end_ms,
            )
            for placed in result.placed
        ]
        summary = lmcp.new(
            "TaskAssignmentSummary",
            CorrespondingAutomationRequestID=key,
            OperatingRegion=matrix.OperatingRegion,
            TaskList=listed,
        )
        known = {**state.found, key: result}
        return state._replace(found=known), [status(key, "Information", facts(result)), summary]

    def _found(
        self, inputs: Inputs, travel_ms: mission_assign.Travel, why: tuple[str, ...]
    ) -> mission_assign.Found:
        """The assignment; else what no vehicle can do or reach, or which constraints clash."""
        try:
            problem = inputs.problem(travel_ms)
            found = mission_assign.assign(
                problem, mission_assign.limits_of(inputs.mission), places_in(inputs.mission)
            )
        except BadInput as error:
            # only what is said of tasks better elsewhere is no mistake of ours
            if not why:
                raise
            return mission_assign.Found(None, None, why or (str(error),))
        return found if found.assignment is not None or not why else replace(found, reasons=why)


def travel_of(inputs: Inputs, rows: Iterable[Any]) -> mission_assign.Travel:
    """The ways of an AssignmentCostMatrix in indices of vehicles and options."""
    times: dict[tuple[int, int, int], int] = {}
    for row in rows:
        before = (row.IntialTaskID, row.IntialTaskOption)
        times[
            inputs.vehicle_index[row.VehicleID],
            START if before == (0, 0) else inputs.index[before],
            inputs.index[row.DestinationTaskID, row.DestinationTaskOption],
        ] = row.TimeToGo

    def travel_ms(vehicle: int, before: int, to: int) -> int | None:
        return times.get((vehicle, before, to))

    return travel_ms


def facts(result: Assignment) -> list[tuple[str, str]]:
    """What is known of an assignment, for a status: `optimal` only with a certificate."""
    return [
        ("cost_ms", str(result.cost)),
        ("status", result.status),
        ("bound", str(result.bound) if result.bound > 0 else "unknown"),
        ("gap", f"{result.gap:.6f}" if result.bound > 0 else "unknown"),
        ("nodes", str(result.nodes)),
        ("certificate", result.digest),
    ]


def places_in(mission: Mission) -> reasons.Places:
    """Where a text of the relations stands in the mission's file, if it is still there."""

    def where(text: str) -> str:
        try:
            lines = Path(mission.source).read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError):
            return ""
        found = [k for k, line in enumerate(lines, 1) if text in line]
        return f"{mission.source}:{found[0]}" if found else ""

    return where
