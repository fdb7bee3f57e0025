"""Expected starts and ends of the remaining tasks, if every vehicle flies on at a given speed factor."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping

from cratous.core.routing.dubins import polyline_length_m
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.timing import opens_ms
from cratous.spec.constraint_rows import Row
from cratous.spec.mission.plan import PlanItem

MEASURED_MOST = 1000
_measured: dict[int, tuple[PlanItem, float, float]] = {}
"""Cached lengths of items by identity: the same items are asked for at each heartbeat."""


def _lengths_m(item: PlanItem) -> tuple[float, float]:
    """Lengths of an item's transit and of its path [m]."""
    known = _measured.get(id(item))
    if known is None or known[0] is not item:
        if len(_measured) >= MEASURED_MOST:
            _measured.clear()
        known = item, polyline_length_m(item.transit), polyline_length_m(item.path)
        _measured[id(item)] = known
    return known[1], known[2]


def expected_times(
    chains: Mapping[int, Chain],
    rows: tuple[Row, ...],
    real_starts: Mapping[int, int],
    real_ends: Mapping[int, int],
    failed: Collection[int],
    factor: float,
    now_ms: int,
) -> tuple[dict[int, int], dict[int, int]]:
    """Starts and ends by task [ms]: actual ones where known, expected ones otherwise.

    Transits are flown at `factor` times the planned speed, tasks at the planned speed. Tasks are taken in
    order of their planned starts, so each comes after those that its rows refer to.
    """
    starts, ends = dict(real_starts), dict(real_ends)
    free: dict[int, float] = {}
    todo: list[tuple[int, int, PlanItem, bool]] = []
    for vid in sorted(chains):
        chain = chains[vid].by_plan()
        item = chain.item
        pace = 1.0 if chain.phase is Phase.TASK else factor
        left_ms = 1000 * chain.left_m() / (item.speed_m_s * pace) if item else 0.0
        free[vid] = now_ms + left_ms
        if item is not None and chain.phase is Phase.TASK:
            ends[item.task_id] = math.ceil(free[vid])
        rest = chain.items[chain.k + (1 if chain.phase is Phase.TASK else 0) :]
        for n, later in enumerate(rest):
            arrived = n == 0 and chain.phase in (Phase.TRANSIT, Phase.WAIT)
            todo.append((later.start_ms, vid, later, arrived))
    for _, vid, item, arrived in sorted(todo, key=lambda t: (t[0], t[1])):
        if item.task_id in failed:
            continue
        transit_m, path_m = _lengths_m(item)
        way = 0.0 if arrived else transit_m
        speed = item.speed_m_s / 1000
        opens = opens_ms(item.task_id, rows, starts, ends)
        start = max(math.floor(free[vid] + way / (speed * factor)), opens)
        starts[item.task_id] = start
        free[vid] = start + path_m / speed
        ends[item.task_id] = math.floor(free[vid])
    return starts, ends
