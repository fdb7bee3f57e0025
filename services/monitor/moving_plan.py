"""A plan against moving zones, at the times that it plans: a vehicle is taken to fly each way at a uniform speed.

The flight does not follow these rows: it is planned anew as a zone moves on. A way is checked leg by leg, a wait as a disc
that stands, against where the zone is then (legs by the kernels for flown legs, circles by leg_keeps). After its last
task a vehicle is taken to stay until the others are done.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import accumulate, pairwise

from cratous.core.schedule.rows import runs_forward
from cratous.services.mission.moving_zones import (
    exact_moving_leg_ok,
    moving_deciding,
    moving_disc_ok,
    moving_zones,
)
from cratous.services.monitor.plan_check import Path, ways_of
from cratous.spec.mission import Mission, MovingZone, Position
from cratous.spec.mission.guarantees import Kind, Outcome, Verdict
from cratous.spec.mission.plan import Plan, PlanItem


def check_in_time(mission: Mission, plan: Plan) -> list[Verdict]:
    """One verdict for each moving zone and planned vehicle: unknown where the plan, as it is, would meet the zone."""
    found, last_ms = [], max((item.end_ms for item in plan.items), default=0)
    for zone in moving_zones(mission):
        for vehicle in mission.vehicles:
            chain = plan.chain(vehicle.id)
            if chain:
                ways = ways_of(vehicle.position, chain)
                found.append(_verdict(zone, vehicle.id, ways, last_ms))
    return found


def meeting_lines(mission: Mission, plan: Plan) -> list[str]:
    """A line for each planned vehicle that would meet a moving zone if it flew the plan as it is."""
    checks = check_in_time(mission, plan)
    return [f"{c.item}: {c.note}" for c in checks if c.outcome is not Outcome.HOLDS]


def _verdict(
    zone: MovingZone, vehicle: int, ways: list[tuple[PlanItem, Path, Path]], last_ms: int
) -> Verdict:
    checks, met_ms, free_ms = 0, None, 0
    for item, transit, path in ways:
        parts = [
            *_stay(transit[0], free_ms, item.depart_ms),
            *_legs(transit, item.depart_ms, item.arrive_ms),
            *_wait(item, path[0]),
            *_legs(path, item.start_ms, item.end_ms),
        ]
        if item is ways[-1][0]:
            parts += _stay(path[-1], item.end_ms, last_ms)
        free_ms = item.end_ms
        for leg, times_ms, radius_m in parts:
            over = zone.until_ms is not None and runs_forward(zone.until_ms, times_ms[0])
            if over or not runs_forward(zone.from_ms, times_ms[1]):
                continue
            checks += 1
            if radius_m is None:
                clear = exact_moving_leg_ok(*leg, times_ms, zone)
            else:
                clear = moving_disc_ok(leg[0], radius_m, times_ms, zone)
            if not clear and met_ms is None:
                met_ms = times_ms[0]
    note = f"{checks} parts of legs and waits, where the zone is then"
    if met_ms is not None:
        note = (
            f"the plan as it is meets the zone from {met_ms / 1000:.1f} s on; "
            "in flight it is made anew as the zone moves on"
        )
    return Verdict(
        "G1",
        f"in time: moving zone {zone.id}, planned route of vehicle {vehicle}",
        Outcome.HOLDS if met_ms is None else Outcome.UNKNOWN,
        Kind.EXACT,
        note,
        time_ms=met_ms,
        vehicles=(vehicle,),
        checks=checks,
        method="leg_ok, for waits leg_keeps, in the frame of the zone",
        kernels=moving_deciding(zone),
    )


PART_MS = 1000
"""Longest part of a leg that is checked at once [ms]."""
Leg = tuple[Position, Position]
Part = tuple[Leg, tuple[int, int], float | None]
"""A leg, or with a radius a disc that stands, and from when until when it is flown [ms]."""


def _legs(way: Path, begin_ms: int, end_ms: int) -> Iterator[Part]:
    """The legs of a way at a uniform speed in parts of PART_MS, each from the millisecond before to that after."""
    lengths = [math.dist(p[:2], q[:2]) for p, q in pairwise(way)]
    whole = math.fsum(lengths)
    if not whole:
        for p, q in pairwise((*way, way[-1])):  # above or below each other: each all the time
            yield (p, q), (begin_ms, end_ms), None
        return
    shares = [0.0, *(gone / whole for gone in accumulate(lengths))]
    for (p, q), (first, last) in zip(pairwise(way), pairwise(shares), strict=True):
        from_ms, to_ms = (begin_ms + share * (end_ms - begin_ms) for share in (first, last))
        count = max(1, math.ceil((to_ms - from_ms) / PART_MS))
        places = [_along(p, q, k / count) for k in range(count + 1)]
        for k, part in enumerate(pairwise(places)):
            times = (from_ms + (to_ms - from_ms) * j / count for j in (k, k + 1))
            yield part, (math.floor(next(times)), math.ceil(next(times))), None


def _along(p: Position, q: Position, share: float) -> Position:
    return Position(*(a + share * (b - a) for a, b in zip(p, q, strict=True)))


def _stay(at: Position, begin_ms: int, end_ms: int) -> Iterator[Part]:
    """Where nothing is planned between two items."""
    if runs_forward(begin_ms + 1, end_ms):
        yield (at, at), (begin_ms, end_ms), None


def _wait(item: PlanItem, here: Position) -> Iterator[Part]:
    """The circle of a wait, or the place before a path that begins later, from the arrival to the start."""
    if item.hold is None:
        yield from _stay(here, item.arrive_ms, item.start_ms)
    elif runs_forward(item.arrive_ms + 1, item.start_ms):
        at = Position(item.hold.north_m, item.hold.east_m, item.hold.alt_m)
        yield (at, at), (item.arrive_ms, item.start_ms), item.hold.radius_m
