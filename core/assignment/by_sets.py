"""The optimum if order rows do not bind times: tasks are distributed set by set.

Without waiting, a vehicle's last end depends only on its own tasks, so the least cost follows from tables over sets
of tasks: the shortest time for a set (`latest_tables` with one far latest end), and the best distribution of a set
among the vehicles from v on. The resulting chains need an order that the rows of all tasks allow; without one, the
value is only a bound.
"""

from __future__ import annotations

import numpy as np

from cratous.core.assignment.compiled import machine_searching
from cratous.core.assignment.instance import TABLE_MAX_MS, Instance, horizon
from cratous.core.assignment.layers import look_ahead
from cratous.core.assignment.search_records import Ahead
from cratous.core.assignment.tables import CELLS_MAX, latest_tables
from cratous.core.kernel import driver

HORIZON = 1073741823
"""The latest end from which times are counted back [ms]."""
SETS_TASKS = 16
"""Limit on tasks: three to this power distributions are examined for each vehicle."""


def best_deals(start: np.ndarray, ready: np.ndarray, team: int, value: np.ndarray) -> None:
    """value [V + 1, 2**n]: the least cost of doing a set with vehicles from v on (latest end, or their sum if
    `team`).
    """
    vehicles, sets = start.shape
    far = 1 << 40
    value[vehicles, :] = far
    value[vehicles, 0] = 0
    for v in range(vehicles - 1, -1, -1):
        for tasks in range(sets):
            if v == 0 and tasks != sets - 1:
                value[v, tasks] = far
                continue
            best = far
            part = tasks
            while True:
                end = 0
                if part != 0:
                    end = ready[v] + 1073741823 - int(start[v, part])
                if end < best:
                    rest = value[v + 1, tasks & ~part]
                    cost = end + rest if team else max(end, rest)
                    if cost < best:
                        best = cost
                if part == 0:
                    break
                part = (part - 1) & tasks
            value[v, tasks] = best


def is_sets(instance: Instance) -> bool:
    """Whether the tables over sets give the optimum of this instance."""
    i = instance
    free = (i.release == 0).all() and (i.due >= 1 << 40).all()
    plain = tuple(i.weight) in ((1, 0), (0, 1)) and not i.added.any()
    cells = (i.vehicles * i.duration.size + i.vehicles) << min(i.tasks, 40)
    small = i.tasks <= SETS_TASKS and cells <= CELLS_MAX and horizon(i) < TABLE_MAX_MS
    return bool(i.waits == 0 and free and plain and small)


@driver(checked_by=("latest_departure", "keeps_step"))
def by_sets(
    instance: Instance, ahead: Ahead | None = None
) -> tuple[int, tuple[tuple[int, int], ...] | None]:
    """(least cost over all distributions of the tasks, moves in an order that the rows allow or None)."""
    i = instance
    ahead = look_ahead(i) if ahead is None else ahead
    n, kinds = i.tasks, len(ahead.leader)
    latest = np.empty((kinds, i.duration.size, 1 << n), np.int32)
    start = np.empty((i.vehicles, 1 << n), np.int32)
    before = all_before(i)
    due = np.full(n, HORIZON, np.int64)
    relaxed = i._replace(need=before, release=i.release * 0, due=due)
    steps = latest.size * i.duration.size
    machine_searching(i, latest_tables, steps)(relaxed, ahead.kind_of, ahead.leader, latest, start)
    # a shared table permits every option: sets that a vehicle may not do are excluded here
    sets = np.arange(1 << n)
    for v in range(i.vehicles):
        start[v, (sets & ~int(ahead.able[v])) != 0] = -HORIZON
    value = np.empty((i.vehicles + 1, 1 << n), np.int64)
    machine_searching(i, best_deals, i.vehicles * n * value.size)(
        start, i.ready, int(i.weight[1]), value
    )
    cost = int(value[0, -1])
    if cost >= HORIZON:
        return 1 << 60, None
    return cost, _in_order(i, _chains(i, ahead, latest, start, value, before))


def all_before(instance: Instance) -> np.ndarray:
    """For each task the mask of all its direct and indirect predecessors."""
    i = instance
    before = i.need.copy()
    for r in range(i.ref_kind.size):
        if i.member_first[r + 1] - i.member_first[r] == 1:
            for j in range(i.tasks):
                if (int(i.ref_user[r]) >> j) & 1:
                    before[j] |= i.ref_group[r]
    for _ in range(i.tasks):
        for j in range(i.tasks):
            for k in range(i.tasks):
                if (int(before[j]) >> k) & 1:
                    before[j] |= before[k]
    return before


def _chains(
    i: Instance, ahead: Ahead, latest: np.ndarray, start: np.ndarray, value: np.ndarray,
    before: np.ndarray,
) -> list[list[int]]:  # fmt: skip
    """The options of each vehicle in order, read from the tables."""
    left, chains = (1 << i.tasks) - 1, []
    team = int(i.weight[1])
    for v in range(i.vehicles):
        part = left
        while True:
            end = int(i.ready[v]) + HORIZON - int(start[v, part]) if part else 0
            rest = int(value[v + 1, left & ~part])
            if (end + rest if team else max(end, rest)) == int(value[v, left]):
                break
            part = (part - 1) & left
        left &= ~part
        chain, table, at = [], start[v], i.duration.size
        while part:
            for o in range(i.duration.size):
                j = int(i.task[o])
                if not (part >> j) & 1 or int(before[j]) & part or not i.may[v, o]:
                    continue
                way, rest = int(i.travel[v, at, o]), part & ~(1 << j)
                after = min(HORIZON, int(latest[ahead.kind_of[v], o, rest]))
                if after - int(i.duration[o]) - way == int(table[part]):
                    chain.append(o)
                    table, at, part = latest[ahead.kind_of[v], o], o, rest
                    break
            else:
                raise RuntimeError("the tables lead to no chain: they were not made by this step")
        chains.append(chain)
    return chains


def _in_order(i: Instance, chains: list[list[int]]) -> tuple[tuple[int, int], ...] | None:
    """The moves of the chains in an order that the rows allow, or None if there is none."""
    done, at, moves = 0, [0] * len(chains), []
    moved = True
    while moved:
        moved = False
        for v, chain in enumerate(chains):
            while at[v] < len(chain) and opens(i, done, int(i.task[chain[at[v]]])):
                moves.append((v, chain[at[v]]))
                done |= 1 << int(i.task[chain[at[v]]])
                at[v] += 1
                moved = True
    return tuple(moves) if len(moves) == i.tasks else None


def opens(i: Instance, done: int, j: int) -> bool:
    """Whether the order rows let task j come after the tasks done."""
    if int(i.need[j]) & ~done:
        return False
    rows = range(int(i.row_first[j]), int(i.row_first[j + 1]))
    refs = [int(i.row_ref[p]) for p in rows]
    return all(i.ref_kind[r] == 1 or int(i.ref_group[r]) & done for r in refs)
