"""Checks a plan against its mission with the proved kernels, and measures the margins.

Only the planner's result is used: constraint rows are derived afresh from the mission's
process-algebra text, routes are checked leg by leg, times are recomputed from lengths and speeds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from cratous.core.kernel import qualified
from cratous.core.schedule.choice import as_asked
from cratous.core.schedule.rows import eligible, row_holds, schedule_holds
from cratous.services.mission.times import all_hold
from cratous.services.mission.zones import deciding, distance_m, exact_leg_ok, margin_m
from cratous.services.monitor.relations import branch_rows, by_term, is_choice, is_part
from cratous.spec.algebra.meaning import branches, tasks
from cratous.spec.constraint_rows import AFTER_END
from cratous.spec.mission import Mission, Position, SweptZone, Zone
from cratous.spec.mission.asked import asked, term_of
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.plan import Plan, PlanItem, in_part_of

Path = tuple[Position, ...]

WHOLE = "plan: every task of one choice, once"
PART = "plan: a part that the relations permit"
"""Additional row of a plan that leaves tasks out. In a flight the tasks served are judged instead:
a later plan may contain what the first leaves out, or the task may be withdrawn.
"""
SPEED_TOLERANCE_MS = 2
"""Rounding of a route's flight time to whole milliseconds, at both ends [ms]."""


def check_plan(mission: Mission, plan: Plan) -> list[Verdict]:
    """One verdict for each constraint that the plan has to satisfy."""
    found = list(_complete(mission, plan))
    found += _eligibility(mission, plan)
    found += _chains(mission, plan)
    found += _relations(mission, plan)
    found += _zones(mission, plan)
    return found


def _verdict(item: str, good: bool, note: str, method: str, **more: object) -> Verdict:
    outcome = Outcome.HOLDS if good else Outcome.VIOLATED
    return Verdict("G1", item, outcome, Kind.EXACT, note, method=method, **more)  # type: ignore[arg-type]


def _complete(mission: Mission, plan: Plan) -> Iterator[Verdict]:
    """Every task of one branch is planned exactly once, and no other; otherwise, whether it is a permitted part."""
    planned = sorted(item.task_id for item in plan.items)
    chosen = frozenset(planned)
    alike = is_choice(mission, chosen)
    wanted = chosen if alike else _first_choice(mission)
    known = sorted({*planned, *(task.id for task in mission.tasks), *wanted})
    in_part = {one.task_id: one for one in in_part_of(plan)}
    # a task planned in part does not count as planned
    whole = {t: 0 if t in in_part else planned.count(t) for t in known}
    counts = [(int(t in wanted), int(t in wanted), whole[t]) for t in known]
    twice = sorted({task for task in planned if planned.count(task) > 1})
    note = f"tasks planned: {', '.join(map(str, planned)) or 'none'}"
    if twice:
        note += f"; planned twice: {', '.join(map(str, twice))}"
    part = not alike and is_part(mission, chosen)
    if part:
        left = [t for t in asked(mission, frozenset(), chosen) if t not in chosen]
        note += f"; left out: {', '.join(map(str, left))}"
    elif not alike:
        note += "; they are no complete choice of the mission's relations"
    if in_part:
        part = part or alike
        note += f"; in part: {'; '.join(one.text for one in in_part.values())}"
    decided = (qualified(as_asked), *by_term(mission))
    yield _verdict(
        WHOLE, bool(as_asked(counts)), note, "as_asked", checks=len(known), kernels=decided
    )
    if part:
        once = bool(as_asked([(0, 1, planned.count(t)) for t in known]))
        yield _verdict(PART, once, note, "as_asked", checks=len(known), kernels=decided)


def _first_choice(mission: Mission) -> frozenset[int]:
    """The tasks of the relations' first branch; all tasks where there are no relations."""
    term = term_of(mission)
    if term is None:
        return frozenset(task.id for task in mission.tasks)
    return frozenset(tasks(next(iter(branches(term)))))


def _eligibility(mission: Mission, plan: Plan) -> Iterator[Verdict]:
    bits = {vehicle.id: 1 << k for k, vehicle in enumerate(mission.vehicles[:63])}
    for item in plan.items:
        allowed = mission.task(item.task_id).eligible or tuple(bits)
        mask = sum(bits.get(vehicle, 0) for vehicle in set(allowed))
        good = eligible(mask, bits.get(item.vehicle_id, 0))
        names = "every vehicle" if len(allowed) == len(bits) else ", ".join(map(str, allowed))
        yield _verdict(
            f"eligibility: task {item.task_id}",
            good,
            f"assigned to vehicle {item.vehicle_id}; eligible: {names}",
            "eligible",
            checks=1,
            kernels=(qualified(eligible),),
            vehicles=(item.vehicle_id,),
        )


def _length_m(path: Path) -> float:
    return math.fsum(math.dist(p[:2], q[:2]) for p, q in pairwise(path))


def ways_of(start: Position, chain: tuple[PlanItem, ...]) -> list[tuple[PlanItem, Path, Path]]:
    """Each item with its transit and its path, joined to the aircraft's previous position.

    A gap in the plan becomes a leg like any other: it takes time and has to respect the zones.
    """
    found, here = [], start
    for item in chain:
        transit = (here, *item.transit)
        path = (transit[-1], *item.path)
        found.append((item, transit, path))
        here = path[-1]
    return found


def _follows(later_ms: int, earlier_ms: int, gap_ms: int = 0) -> bool:
    return row_holds(AFTER_END, later_ms, later_ms, earlier_ms, gap_ms, 0)


def _chains(mission: Mission, plan: Plan) -> Iterator[Verdict]:
    """Each vehicle flies its items in sequence, no faster than planned and than its maximum speed."""
    for vehicle in mission.vehicles:
        free_ms = 0
        chain = plan.chain(vehicle.id)
        if not chain:
            continue
        faults = []
        for item, transit, path in ways_of(vehicle.position, chain):
            for way, begin_ms, end_ms in (
                (transit, item.depart_ms, item.arrive_ms),
                (path, item.start_ms, item.end_ms),
            ):
                speed = min(item.speed_m_s, vehicle.max_speed_m_s)
                need_ms = math.floor(_length_m(way) / speed * 1000) - SPEED_TOLERANCE_MS
                if not _follows(end_ms, begin_ms, need_ms):
                    faults.append(f"task {item.task_id}: {end_ms - begin_ms} ms, needs {need_ms}")
            departs = _follows(item.depart_ms, free_ms)
            if not (departs and _follows(item.start_ms, item.arrive_ms, item.wait_ms)):
                faults.append(f"task {item.task_id}: its times do not follow on each other")
            free_ms = item.end_ms
        yield _verdict(
            f"chain: vehicle {vehicle.id}",
            not faults,
            "; ".join(faults)
            or f"{len(chain)} task{'' if len(chain) == 1 else 's'}, done at {free_ms / 1000:.3f} s",
            "row_holds",
            checks=4 * len(chain),
            kernels=(qualified(row_holds),),
            vehicles=(vehicle.id,),
        )


def _relations(mission: Mission, plan: Plan) -> Iterator[Verdict]:
    times = {item.task_id: (item.start_ms, item.end_ms) for item in plan.items}
    chosen = frozenset(times)
    kept = branch_rows(mission, chosen, times)
    if kept is None:
        kept = branch_rows(mission, chosen, times, part=True)
    if kept is None:
        return
    for row in kept.rows:
        yield kept.verdict(row, times, "plan")
    yield kept.judged(
        _verdict(
            "plan: all order and timing rows at once",
            all_hold(kept.rows, times),
            f"{len(kept.rows)} rows",
            "schedule_holds",
            checks=len(kept.rows),
            kernels=(qualified(schedule_holds), *kept.kernels),
        )
    )


def _circle(item: PlanItem) -> Path:
    """A polygon that encloses the circle of a wait."""
    if item.hold is None or item.wait_ms <= 0:
        return ()
    h = item.hold
    r = h.radius_m / math.cos(math.pi / 36)
    turns = [2 * math.pi * k / 36 for k in range(37)]
    return tuple(
        Position(h.north_m + r * math.cos(a), h.east_m + r * math.sin(a), h.alt_m) for a in turns
    )


def _zones(mission: Mission, plan: Plan) -> Iterator[Verdict]:
    for zone in mission.zones:
        name = f"zone: {zone.kind.value} {zone.id}"
        # the zone itself is somewhere else later: `moving_plan`
        name += ", region at the start" if isinstance(zone, SweptZone) else ""
        for vehicle in mission.vehicles:
            ways: list[Path] = []
            for item, transit, path in ways_of(vehicle.position, plan.chain(vehicle.id)):
                ways += [transit, _circle(item), path]
            ways = [way for way in ways if way]
            if ways:
                yield _zone_verdict(name, zone, vehicle.id, ways)


def _zone_verdict(name: str, zone: Zone, vehicle_id: int, ways: list[Path]) -> Verdict:
    checks, bad = 0, ""
    for way in ways:
        for p, q in zip(way, way[1:] or way, strict=False):
            checks += 1
            if not bad and not exact_leg_ok(p, q, zone):
                bad = f"leg ({p.north_m:.1f}, {p.east_m:.1f}) to ({q.north_m:.1f}, {q.east_m:.1f})"
    distance = min(distance_m(way, zone) for way in ways)
    return _verdict(
        f"{name}, planned route of vehicle {vehicle_id}",
        not bad,
        bad or f"{checks} legs",
        "leg_ok: locate, meets_boundary",
        checks=checks,
        vehicles=(vehicle_id,),
        margin=margin_m(distance, bool(bad)),
        unit="m",
        kernels=deciding(zone),
    )
