"""G1: zones on every flown leg; order, timing and eligibility of the tasks as flown."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import atan2, hypot
from typing import Any

from cratous.core.algebra.steps import Ran, in_order
from cratous.core.authority.timeliness import in_time
from cratous.core.kernel import qualified
from cratous.core.schedule.choice import as_asked
from cratous.core.schedule.rows import eligible, runs_forward
from cratous.services.mission.moving_zones import (
    exact_moving_leg_ok,
    moving_deciding,
    seen,
    standing,
)
from cratous.services.mission.wind import in_wind, wind_at
from cratous.services.mission.zone_times import Bound, judged_zones
from cratous.services.mission.zones import deciding, distance_m, exact_leg_ok, margin_m
from cratous.services.monitor.avoidable import Appeared, avoidable
from cratous.services.monitor.observation import Ending, Presence
from cratous.services.monitor.relations import branch_rows, by_term, is_choice
from cratous.services.monitor.required_rows import (
    CHOICE,
    Watched,
    eligible_item,
    fence_item,
)
from cratous.services.monitor.samples import Sample
from cratous.spec.constraint_rows import AFTER_END, AFTER_START, Row
from cratous.spec.mission import Mission, MovingZone, Position, Zone, ZoneKind
from cratous.spec.mission.changes import known_at, requested_ms
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.plan import Pose

ACTIVE, COMPLETE, FAILED = "Active", "Complete", "Failed"
WAITS = {AFTER_END: 1, AFTER_START: 2}
"""Constraint rows by which a task waits for others, with the code of their operator."""


@dataclass
class Fence:
    """Observed state of one vehicle and one zone.

    first, last: positions of the vehicle's track between which the zone applied to it; over: the
    zone appeared where the vehicle was not allowed to be; left_ms: time since which the vehicle
    complies; again_ms: time of the next violation; appeared: state of the vehicle when the zone
    appeared, None for a zone present from the start or if not observed; could: what could have been
    kept, once asked.
    """

    first: int
    last: int
    checks: int = 0
    broken_ms: int | None = None
    over: bool = False
    left_ms: int | None = None
    again_ms: int | None = None
    appeared: Appeared | None = None
    could: tuple[str, dict[str, Any]] | None = None

    def words(self, kind: ZoneKind, so_far: bool) -> str:
        """How a zone was violated, in words; so_far: during the flight, when the outcome is not known yet."""
        at = f"{(self.broken_ms or 0) / 1000:.2f} s"
        out = kind is ZoneKind.KEEP_OUT
        if not self.over:
            return f"{'entered' if out else 'left'} at {at}"
        where, kept, broke = (
            ("over", "left it", "entered it") if out else ("beside", "entered it", "left it")
        )
        said = f"it appeared {where} the vehicle at {at}"
        if so_far:
            return said
        if self.left_ms is None:
            return f"{said}, which did not {'leave' if out else 'enter'} it"
        again = "" if self.again_ms is None else f", and {broke} at {self.again_ms / 1000:.2f} s"
        took_s = (self.left_ms - (self.broken_ms or 0)) / 1000
        return f"{said}, which {kept} by {self.left_ms / 1000:.2f} s, at most {took_s:.2f} s later{again}"


class ConstraintWatch:
    """Watches zones, order, timing and eligibility. `presence`: observation spans of each aircraft."""

    def __init__(self, mission: Mission, presence: Presence) -> None:
        self._mission, self._presence = mission, presence
        self._bits = {vehicle.id: 1 << k for k, vehicle in enumerate(mission.vehicles[:63])}
        self._protected = {v.id for v in mission.vehicles if v.protected}
        self._starts: dict[int, int] = {}
        self._ends: dict[int, int] = {}
        self._who: dict[int, list[int]] = {}
        self._failed: set[int] = set()
        self._fences: dict[tuple[int, int], Fence] = {}
        self._tracks: dict[int, list[tuple[int, Position]]] = {}
        self._came: dict[int, tuple[Sample, Sample]] = {}  # last observed leg of each vehicle
        self.violations: list[Verdict] = []

    def progress(self, body: Any) -> None:
        """Process the start or end of a task."""
        if body.Phase.name == ACTIVE:
            self._starts.setdefault(body.TaskID, body.Time)
            flown_by = self._who.setdefault(body.TaskID, [])
            if body.VehicleID not in flown_by:
                flown_by.append(body.VehicleID)
        elif body.Phase.name == COMPLETE:
            self._ends[body.TaskID] = body.Time
        elif body.Phase.name == FAILED:
            self._failed.add(body.TaskID)

    def step(self, before: dict[int, Sample], after: dict[int, Sample]) -> None:
        """Check the leg of every protected vehicle against every known zone."""
        for vehicle in sorted(self._protected & before.keys() & after.keys()):
            here = before[vehicle], after[vehicle]
            p, q = here[0].position, here[1].position
            track = self._tracks.setdefault(vehicle, [(here[0].time_ms, p)])
            track.append((here[1].time_ms, q))
            for bound in judged_zones(self._mission, after[vehicle].time_ms):
                if not bound.binds(before[vehicle].time_ms):
                    continue
                zone, last = bound.zone, len(track) - 1
                fence = self._fences.setdefault((vehicle, zone.id), Fence(last - 1, last))
                at_once = in_time(bound.since_ms, here[0].time_ms, 0)
                late = not isinstance(zone, MovingZone) and zone not in self._mission.zones
                if not fence.checks and at_once and late:
                    came = self._came.get(vehicle, here)
                    fence.appeared = _appeared(came if came[1] == here[0] else here, here[0])
                fence.last = last
                fence.checks += 1
                self._leg(vehicle, here, bound)
            self._came[vehicle] = here

    def _leg(
        self, vehicle: int, here: tuple[Sample, Sample], bound: Bound[Zone] | Bound[MovingZone]
    ) -> None:
        """Check one flown leg against a zone."""
        zone, fence = bound.zone, self._fences[vehicle, bound.zone.id]
        leg, at_ms = (here[0].position, here[1].position), here[0].time_ms
        if isinstance(zone, MovingZone):
            clear = exact_moving_leg_ok(*leg, (at_ms, here[1].time_ms), zone)
        else:
            clear = exact_leg_ok(*leg, zone)
        if clear and fence.broken_ms is not None and fence.left_ms is None:
            fence.left_ms = at_ms
        elif not clear and fence.broken_ms is None:
            fence.broken_ms = at_ms
            late, first = fence.appeared is not None, fence.checks == 1
            fence.over = (
                late and first and isinstance(zone, Zone) and not exact_leg_ok(leg[0], leg[0], zone)
            )
            self.violations.append(self._fence_verdict(vehicle, zone, fence, so_far=True))
        elif not clear and fence.left_ms is not None and fence.again_ms is None:
            fence.again_ms = at_ms

    def _could_keep(self, number: int, zone: Zone, fence: Fence) -> tuple[str, dict[str, Any]]:
        """What could have been kept of a zone that appeared in flight."""
        assert fence.appeared is not None
        if fence.could is None:
            at_ms = fence.appeared.at_ms
            vehicle = next(v for v in self._mission.vehicles if v.id == number)
            able = in_wind(vehicle, wind_at(self._mission, at_ms)) or vehicle
            step_ms = self._mission.simulation.step_ms
            # of moving zones the regions that are in force
            bound = known_at(self._mission, at_ms).zones
            fence.could = avoidable(fence.appeared, able, zone, bound, step_ms / 1000)
        return fence.could

    def _fence_verdict(
        self,
        vehicle: int,
        zone: Zone | MovingZone,
        fence: Fence,
        unseen: str = "",
        so_far: bool = False,
    ) -> Verdict:
        broken = fence.broken_ms is not None
        track = self._tracks[vehicle][fence.first : fence.last + 1]
        note = f"{fence.checks} flown legs"
        if isinstance(zone, MovingZone):
            distance = distance_m([seen(p, at, zone) for at, p in track], standing(zone))
            note, kernels = f"{note}, where the zone was then", moving_deciding(zone)
        else:
            distance, kernels = distance_m([p for _, p in track], zone), deciding(zone)
        outcome, evidence = Outcome.HOLDS, None
        if broken:
            note, outcome = fence.words(zone.kind, so_far), Outcome.VIOLATED
            late = fence.appeared is not None and not fence.over
            if late and not so_far and isinstance(zone, Zone):
                could, evidence = self._could_keep(vehicle, zone, fence)
                note = f"{note}; {could}"
        elif unseen:
            note, outcome = f"{note}; {unseen}", Outcome.UNKNOWN
        return Verdict(
            "G1",
            fence_item(zone, vehicle),
            outcome,
            Kind.EXACT,
            note,
            time_ms=fence.broken_ms,
            vehicles=(vehicle,),
            margin=margin_m(distance, broken),
            unit="m",
            checks=fence.checks,
            method="leg_ok: locate, meets_boundary",
            evidence=evidence,
            kernels=kernels,
        )

    def verdicts(self, seen: Watched, ending: Ending) -> list[Verdict]:
        """One verdict for each observed zone, constraint row and task assignment."""
        zones, relations = self._zones(seen, ending), self._relations(seen, ending)
        return [
            *zones,
            *relations,
            *self._eligibility(seen, ending),
            *self._never_begun(seen, ending),
        ]

    def _zones(self, seen: Watched, ending: Ending) -> Iterator[Verdict]:
        for zone, since_ms, until_ms in judged_zones(self._mission, seen.end_ms):
            held_ms = seen.end_ms if until_ms is None else min(until_ms, seen.end_ms)
            for vehicle in sorted(self._protected):
                fence = self._fences.get((vehicle, zone.id))
                if fence is not None:
                    unseen = self._presence.unseen(vehicle, (since_ms, held_ms), ending)
                    yield self._fence_verdict(vehicle, zone, fence, unseen)

    def _relations(self, seen: Watched, ending: Ending) -> Iterator[Verdict]:
        """Verdicts that no task outside the chosen branch was begun, and on the branch's rows."""
        wanted = {task.id for task in seen.asked.tasks}
        beside = sorted(self._starts.keys() & wanted - set(seen.tasks))
        names = ", ".join(map(str, seen.tasks)) or "none"
        note = f"tasks {names} are asked for"
        if beside:
            note += f", and tasks {', '.join(map(str, beside))} were begun besides"
        # each task at most once, and only if requested
        begun = [(0, int(t in seen.tasks), int(t in self._starts)) for t in sorted(wanted)]
        outcome = Outcome.HOLDS if ending.over else Outcome.UNKNOWN
        outcome = outcome if as_asked(begun) else Outcome.VIOLATED
        chosen = frozenset(seen.tasks)
        if not is_choice(seen.asked, chosen):
            outcome, note = Outcome.UNKNOWN, f"{note}, which are no choice of the relations"
        yield Verdict(
            "G1", CHOICE, outcome, Kind.EXACT, note, checks=len(begun), method="as_asked",
            kernels=(qualified(as_asked), *by_term(seen.asked)),
        )  # fmt: skip
        times = {t: (self._starts[t], self._ends[t]) for t in self._starts if t in self._ends}
        kept = branch_rows(seen.asked, chosen, times)
        for row in kept.rows if kept is not None else ():
            missing = [t for t in (row.i, *row.group) if t not in times]
            if kept is not None and not missing:
                found = kept.verdict(row, times, "flight")
                late = self._asked_late(row) if found.outcome is Outcome.VIOLATED else ""
                yield replace(found, note=f"{found.note}{late}")
                continue
            yield self._unfinished(row, missing, ending)

    def _unfinished(self, row: Row, missing: list[int], ending: Ending) -> Verdict:
        """Verdict on a row with tasks not flown to their end: violated where a task did not wait at all."""
        item = f"flight: {row.text}"
        start = self._starts.get(row.i)
        if ending.over and start is not None and row.kind in WAITS:
            begun = [self._starts[task] for task in row.group if task in self._starts]
            before = Ran(bool(begun), min(begun, default=0), max(begun, default=0))
            is_whole = all(task in self._ends for task in row.group)
            if not in_order(WAITS[row.kind], is_whole, before, Ran(True, start, start)):
                event = "ended" if row.kind == AFTER_END else "begun"
                names = ", ".join(map(str, sorted(set(row.group) & set(missing))))
                note = f"task {row.i} began, though task {names} had not {event} by then"
                note += self._asked_late(row)
                return Verdict(
                    "G1", item, Outcome.VIOLATED, Kind.EXACT, note, time_ms=start, checks=1,
                    method="in_order", kernels=(qualified(in_order),),
                )  # fmt: skip
        note = f"not judged: task {', '.join(map(str, missing))} was not flown to its end"
        return Verdict("G1", item, Outcome.UNKNOWN, Kind.OBSERVED, note)

    def _asked_late(self, row: Row) -> str:
        """Which predecessors of a row were requested only after the waiting task had begun, in words."""
        start, said = self._starts.get(row.i), ""
        for task in row.group if row.kind in WAITS and start is not None else ():
            since = requested_ms(self._mission, task)
            if since is not None and start is not None and runs_forward(start + 1, since):
                said += f"; task {task} was asked for only at {since / 1000:.2f} s"
        return said

    def _eligibility(self, seen: Watched, ending: Ending) -> Iterator[Verdict]:
        known = {task.id: task for task in self._mission.tasks}
        for task, flown_by in sorted(self._who.items()):
            if task not in known:
                continue
            allowed = known[task].eligible or tuple(self._bits)
            mask = sum(self._bits.get(v, 0) for v in set(allowed))
            good = all(eligible(mask, self._bits.get(vehicle, 0)) for vehicle in flown_by)
            outcome, note = Outcome.HOLDS if good else Outcome.VIOLATED, "flown by vehicle "
            note += ", ".join(map(str, flown_by))
            given_up = ending.over and task in self._failed
            if good and task in seen.tasks and task not in self._ends and not given_up:
                outcome, note = Outcome.UNKNOWN, f"{note}, not to its end"
            yield Verdict(
                "G1",
                eligible_item(task),
                outcome,
                Kind.EXACT,
                note,
                vehicles=tuple(flown_by),
                checks=len(flown_by),
                method="eligible",
                kernels=(qualified(eligible),),
            )

    def _never_begun(self, seen: Watched, ending: Ending) -> Iterator[Verdict]:
        """Eligibility verdicts for tasks reported as failed before any vehicle began them."""
        for task in sorted(self._failed & set(seen.tasks)):
            flown = len(self._who.get(task, ())) + int(task in self._ends)
            # the question here is that it was flown zero times
            if ending.over and as_asked([(0, 0, flown)]):
                yield Verdict(
                    "G1", eligible_item(task), Outcome.HOLDS, Kind.OBSERVED, "nobody began it",
                    checks=1, method="as_asked", kernels=(qualified(as_asked),),
                )  # fmt: skip


def _appeared(leg: tuple[Sample, Sample], now: Sample) -> Appeared:
    """State of a vehicle at `now`. leg: the leg by which it arrived there, or else the one that follows."""
    a, b = (sample.position for sample in leg)
    north, east = b.north_m - a.north_m, b.east_m - a.east_m
    speed = hypot(north, east) / ((leg[1].time_ms - leg[0].time_ms) / 1000)
    return Appeared(now.time_ms, Pose(*now.position, atan2(east, north)), speed)
