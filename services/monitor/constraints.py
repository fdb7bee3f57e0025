"""G1: zones on every flown leg; order, timing and eligibility of what was really done when."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cratous.core.timing import eligible
from cratous.services.monitor.samples import Sample
from cratous.services.plan_check import term_rows
from cratous.services.times import row_verdict
from cratous.services.zones import distance_m, exact_leg_ok
from cratous.spec.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.plan import Plan

ACTIVE, COMPLETE = "Active", "Complete"


@dataclass
class Fence:
    """What has been seen of one vehicle and one zone."""

    checks: int = 0
    broken_ms: int | None = None


class ConstraintWatch:
    """Zones, order, timing and eligibility."""

    def __init__(self, mission: Mission, plan: Plan) -> None:
        self._mission = mission
        self._chosen = frozenset(item.task_id for item in plan.items)
        self._bits = {vehicle.id: 1 << k for k, vehicle in enumerate(mission.vehicles[:63])}
        self._protected = {v.id for v in mission.vehicles if v.protected}
        self._starts: dict[int, int] = {}
        self._ends: dict[int, int] = {}
        self._who: dict[int, int] = {}
        self._fences: dict[tuple[int, int], Fence] = {}
        self._tracks: dict[int, list[Position]] = {}
        self.violations: list[Verdict] = []

    def accept(self, chosen: frozenset[int]) -> None:
        """Another plan is flown from now on: these are its tasks and those already done."""
        self._chosen = chosen

    def change(self, known: Mission) -> None:
        """The mission is known to be this from now on."""
        self._mission = known

    def done(self) -> frozenset[int]:
        """The tasks that were flown to their end."""
        return frozenset(self._ends)

    def progress(self, body: Any) -> None:
        """A task began or ended."""
        if body.Phase.name == ACTIVE:
            self._starts.setdefault(body.TaskID, body.Time)
            self._who[body.TaskID] = body.VehicleID
        elif body.Phase.name == COMPLETE:
            self._ends[body.TaskID] = body.Time

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Check the leg of every protected vehicle of ours against every zone."""
        for vehicle in sorted(self._protected & before.keys() & after.keys()):
            p, q = before[vehicle].position, after[vehicle].position
            self._tracks.setdefault(vehicle, [p]).append(q)
            for zone in self._mission.zones:
                fence = self._fences.setdefault((vehicle, zone.id), Fence())
                fence.checks += 1
                if not exact_leg_ok(p, q, zone) and fence.broken_ms is None:
                    fence.broken_ms = before[vehicle].time_ms
                    self.violations.append(self._fence_verdict(vehicle, zone, fence))

    def _fence_verdict(self, vehicle: int, zone: Zone, fence: Fence) -> Verdict:
        broken = fence.broken_ms is not None
        distance = distance_m(self._tracks[vehicle], zone)
        note = f"{fence.checks} flown legs"
        if broken:
            note = f"entered at {(fence.broken_ms or 0) / 1000:.2f} s"
        return Verdict(
            "G1",
            f"zone: {zone.kind.value} {zone.id}, flight of vehicle {vehicle}",
            Outcome.VIOLATED if broken else Outcome.HOLDS,
            Kind.EXACT,
            note,
            time_ms=fence.broken_ms,
            vehicles=(vehicle,),
            margin=-distance if broken else distance,
            unit="m",
            checks=fence.checks,
            method="leg_ok: locate, meets_boundary",
        )

    def verdicts(self) -> list[Verdict]:
        """One verdict for each fence, row and assignment."""
        zones = {zone.id: zone for zone in self._mission.zones}
        found = [
            self._fence_verdict(vehicle, zones[zone], fence)
            for (vehicle, zone), fence in sorted(self._fences.items())
        ]
        times = {t: (self._starts[t], self._ends[t]) for t in self._starts if t in self._ends}
        wanted = term_rows(self._mission, self._chosen)
        if wanted is None:
            names = ", ".join(map(str, sorted(self._chosen)))
            note = f"tasks {names} are no complete choice of the mission's relations"
            found.append(
                Verdict("G1", "flight: choice", Outcome.VIOLATED, Kind.EXACT, note, checks=1)
            )
        for row in wanted or ():
            if all(task in times for task in (row.i, *row.group)):
                found.append(row_verdict(row, times, "flight"))
                continue
            missing = [t for t in (row.i, *row.group) if t not in times]
            note = f"not judged: task {', '.join(map(str, missing))} was not flown to its end"
            found.append(Verdict("G1", f"flight: {row.text}", Outcome.UNKNOWN, Kind.OBSERVED, note))
        for task, vehicle in sorted(self._who.items()):
            allowed = self._mission.task(task).eligible or tuple(self._bits)
            mask = sum(self._bits.get(v, 0) for v in set(allowed))
            good = eligible(mask, self._bits.get(vehicle, 0))
            found.append(
                Verdict(
                    "G1",
                    f"eligibility: task {task} in flight",
                    Outcome.HOLDS if good else Outcome.VIOLATED,
                    Kind.EXACT,
                    f"flown by vehicle {vehicle}",
                    vehicles=(vehicle,),
                    checks=1,
                    method="eligible",
                )
            )
        return found
