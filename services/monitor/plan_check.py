"""Checks a plan against its mission with the proved kernels, and measures the margins.

Nothing is taken from the planner but its result: constraint rows are made anew from the mission's
process-algebra text, routes are checked leg by leg, times are recomputed from lengths and speeds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice, pairwise

from cratous.core.kernel import qualified
from cratous.core.schedule.choice import as_asked
from cratous.core.schedule.rows import eligible, row_holds, schedule_holds
from cratous.services.mission.times import Times, all_hold, row_verdict
from cratous.services.mission.zones import deciding, distance_m, exact_leg_ok
from cratous.spec.algebra import ALTERNATIVE, Atom, Term
from cratous.spec.algebra.meaning import branches, rows, tasks
from cratous.spec.algebra.partial import after_choices, kept_rows, may_be_done
from cratous.spec.constraint_rows import AFTER_END, Row
from cratous.spec.mission import Mission, Position, Zone
from cratous.spec.mission.asked import asked, term_of
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.plan import Plan, PlanItem, in_part_of

Path = tuple[Position, ...]

WHOLE = "plan: every task of one choice, once"
PART = "plan: a part that the relations permit"
"""A plan that leaves tasks out has this row as well. Of a flight the tasks served are judged instead of the first
one: a later plan may do what the first leaves out, or it may be withdrawn."""
CHOICES_MAX = 4096
"""So many branches of the same tasks are looked at for one whose rows hold."""
SPEED_TOLERANCE_MS = 2
"""Rounding of a route's flight time to whole milliseconds, at both of its ends."""


def check_plan(mission: Mission, plan: Plan) -> list[Verdict]:
    """One verdict for each constraint that the plan has to satisfy."""
    found = list(_complete(mission, plan))
    found += _eligibility(mission, plan)
    found += _chains(mission, plan)
    found += _relations(mission, plan)
    found += _zones(mission, plan)
    return found


def row_choices(mission: Mission, chosen: frozenset[int]) -> Iterator[tuple[Row, ...]]:
    """The constraint rows of each branch that consists of the chosen tasks, in the order of the text.

    Several branches may have the same tasks, as in `+(.(p1 p2) .(p2 p1))`; no more than CHOICES_MAX
    of them are looked at. Nothing comes where no branch has these tasks.
    """
    term = term_of(mission)
    if term is None:
        yield from () if chosen else ((),)
        return
    within = _within(term, chosen)
    made = branches(within) if within is not None else iter(())
    alike = (branch for branch in made if frozenset(tasks(branch)) == chosen)
    yield from (rows(branch) for branch in islice(alike, CHOICES_MAX))


def _within(term: Term, chosen: frozenset[int]) -> Term | None:
    """The term without the operands of `+` that need another task; None if nothing is left.

    So no branch is made that cannot consist of the chosen tasks: of twenty choices between two tasks
    one branch is left of a million.
    """
    if isinstance(term, Atom):
        return term if term.task in chosen else None
    inside = [_within(operand, chosen) for operand in term.operands]
    kept = tuple(operand for operand in inside if operand is not None)
    if not kept or (term.op != ALTERNATIVE and len(kept) < len(inside)):
        return None
    return replace(term, operands=kept)


def part_choices(mission: Mission, chosen: frozenset[int]) -> Iterator[tuple[Row, ...]]:
    """The rows on the chosen tasks of each branch that permits that just these of its tasks are done.

    No more than CHOICES_MAX branches are looked at.
    """
    term = term_of(mission)
    if term is None or not chosen:
        return
    for branch in islice(branches(after_choices(term, chosen)), CHOICES_MAX):
        if chosen <= set(tasks(branch)) and may_be_done(branch, chosen):
            yield kept_rows(branch, chosen)


def term_rows(mission: Mission, chosen: frozenset[int], times: Times) -> tuple[Row, ...] | None:
    """The constraint rows of the chosen tasks; None if no branch consists of them.

    Of several branches with these tasks it is the first whose rows hold of the times (ms), as far
    as their tasks have times; else the first of those with the fewest broken rows.
    """
    return _best_rows(row_choices(mission, chosen), times)


def _best_rows(choices: Iterator[tuple[Row, ...]], times: Times) -> tuple[Row, ...] | None:
    best: tuple[Row, ...] | None = None
    least = math.inf
    for choice in choices:
        known = [row for row in choice if all(t in times for t in (row.i, *row.group))]
        broken = sum(row_verdict(row, times, "").outcome is not Outcome.HOLDS for row in known)
        if broken < least:
            best, least = choice, broken
        if broken == 0:
            break
    return best


def _verdict(item: str, good: bool, note: str, method: str, **more: object) -> Verdict:
    outcome = Outcome.HOLDS if good else Outcome.VIOLATED
    return Verdict("G1", item, outcome, Kind.EXACT, note, method=method, **more)  # type: ignore[arg-type]


def _complete(mission: Mission, plan: Plan) -> Iterator[Verdict]:
    """Every task of one branch is planned exactly once, and no other; if not, whether it is a part."""
    planned = sorted(item.task_id for item in plan.items)
    chosen = frozenset(planned)
    alike = any(True for _ in row_choices(mission, chosen))
    wanted = chosen if alike else _first_choice(mission)
    known = sorted({*planned, *(task.id for task in mission.tasks), *wanted})
    in_part = {one.task_id: one for one in in_part_of(plan)}
    # what is done in part is not done as it is asked
    whole = {t: 0 if t in in_part else planned.count(t) for t in known}
    counts = [(int(t in wanted), int(t in wanted), whole[t]) for t in known]
    twice = sorted({task for task in planned if planned.count(task) > 1})
    note = f"tasks planned: {', '.join(map(str, planned)) or 'none'}"
    if twice:
        note += f"; planned twice: {', '.join(map(str, twice))}"
    part = not alike and any(True for _ in part_choices(mission, chosen))
    if part:
        left = [t for t in asked(mission, frozenset(), chosen) if t not in chosen]
        note += f"; left out: {', '.join(map(str, left))}"
    elif not alike:
        note += "; they are no complete choice of the mission's relations"
    if in_part:
        part = part or alike
        note += f"; in part: {'; '.join(one.text for one in in_part.values())}"
    decided = (qualified(as_asked),)
    yield _verdict(
        WHOLE, bool(as_asked(counts)), note, "as_asked", checks=len(known), kernels=decided
    )
    if part:
        yield _verdict(PART, not twice, note, "may_be_done", checks=1)


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


def _ways(start: Position, chain: tuple[PlanItem, ...]) -> list[tuple[PlanItem, Path, Path]]:
    """Each item with its transit and its path, joined to where the aircraft was before.

    A gap in the plan becomes a leg like any other: it takes time, and it has to obey the zones.
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
    """Each vehicle flies its items one after the other, no faster than planned and than it can."""
    for vehicle in mission.vehicles:
        free_ms = 0
        chain = plan.chain(vehicle.id)
        if not chain:
            continue
        faults = []
        for item, transit, path in _ways(vehicle.position, chain):
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
    wanted = term_rows(mission, frozenset(times), times)
    if wanted is None:
        wanted = _best_rows(part_choices(mission, frozenset(times)), times)
    if wanted is None:
        return
    for row in wanted:
        yield row_verdict(row, times, "plan")
    yield _verdict(
        "plan: all order and timing rows at once",
        all_hold(wanted, times),
        f"{len(wanted)} rows",
        "schedule_holds",
        checks=len(wanted),
        kernels=(qualified(schedule_holds),),
    )


def _circle(item: PlanItem) -> Path:
    """A polygon around the circle of a wait: what is flown lies within it."""
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
        for vehicle in mission.vehicles:
            ways: list[Path] = []
            for item, transit, path in _ways(vehicle.position, plan.chain(vehicle.id)):
                ways += [transit, _circle(item), path]
            ways = [way for way in ways if way]
            if ways:
                yield _zone_verdict(zone, vehicle.id, ways)


def _zone_verdict(zone: Zone, vehicle_id: int, ways: list[Path]) -> Verdict:
    checks, bad = 0, ""
    for way in ways:
        for p, q in zip(way, way[1:] or way, strict=False):
            checks += 1
            if not bad and not exact_leg_ok(p, q, zone):
                bad = f"leg ({p.north_m:.1f}, {p.east_m:.1f}) to ({q.north_m:.1f}, {q.east_m:.1f})"
    distance = min(distance_m(way, zone) for way in ways)
    return _verdict(
        f"zone: {zone.kind.value} {zone.id}, planned route of vehicle {vehicle_id}",
        not bad,
        bad or f"{checks} legs",
        "leg_ok: locate, meets_boundary",
        checks=checks,
        vehicles=(vehicle_id,),
        margin=-distance if bad else distance,
        unit="m",
        kernels=deciding(zone),
    )
