"""An assignment problem without alternatives as arrays: the input of the compiled searches.

Vehicles, options and tasks are numbered from 0; all times are integer ms. An instance is *plain*: its rows bound
starts from below (kinds 1, 2, 5) or single ends from above (kind 6), and a vehicle may wait for any time. In a plain
instance, an earlier state stays earlier, which dominance relies on. All other problems are searched by
`core.assignment.problem`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from cratous.spec.constraint_rows import AFTER_END, AFTER_START, NOT_AFTER, NOT_BEFORE, Row

FAR = 1 << 40
"""No route [ms]; every real time of an instance is far below (`TIME_MAX_MS`)."""
TIME_MAX_MS = 1 << 38
"""Sums of times in an instance stay below this: eight years."""
TABLE_MAX_MS = 1 << 29
"""Tables have 32-bit entries: they are built if all times stay below this (six days)."""
TASKS_MAX = 62


class Instance(NamedTuple):
    """Arrays: V vehicles, K options, n tasks, R references of order rows.

    travel, added: [V, K + 1, K], row K is the vehicle's start; duration, task: [K];
    may: [V, K]; ready: [V]; release, due, need: [n] (need: tasks that must be placed before);
    ref_kind (1 latest end, 2 earliest start), ref_group, ref_user (masks of tasks): [R];
    member_first: [R + 1] into member, the tasks of each reference (masks are for 62 tasks at most);
    row_first: [n + 1] into row_ref, row_lo; twin: [V] the first vehicle that is the same;
    weight: per makespan, per team time; waits: 0 if order rows bind no times (semantics `order`).
    """

    travel: np.ndarray
    added: np.ndarray
    duration: np.ndarray
    task: np.ndarray
    may: np.ndarray
    ready: np.ndarray
    release: np.ndarray
    due: np.ndarray
    need: np.ndarray
    ref_kind: np.ndarray
    ref_group: np.ndarray
    ref_user: np.ndarray
    member_first: np.ndarray
    member: np.ndarray
    row_first: np.ndarray
    row_ref: np.ndarray
    row_lo: np.ndarray
    twin: np.ndarray
    weight: np.ndarray
    waits: int

    @property
    def vehicles(self) -> int:
        """The number of vehicles."""
        return int(self.may.shape[0])

    @property
    def tasks(self) -> int:
        """The number of tasks, all of which have to be done."""
        return int(self.release.shape[0])


def is_plain(rows: Sequence[Row]) -> bool:
    """Whether rows only bound starts from below and single ends from above."""
    return all(row.kind in (AFTER_END, AFTER_START, NOT_BEFORE, NOT_AFTER) for row in rows)


class Fleet(NamedTuple):
    """When vehicles are ready [V, ms], which options they may do, and what their legs take and cost, as arrays of
    `Instance` or their source.
    """

    ready: Sequence[int]
    may: Any
    travel: Any
    added: Any


def instance(
    tasks: Sequence[int],
    rows: Sequence[Row],
    options: Sequence[tuple[int, int]],
    fleet: Fleet,
    weight: tuple[int, int],
    waits: bool,
) -> Instance:
    """The arrays of one branch. options: (task id, duration) of those of its tasks.

    fleet: over these options. Tasks are numbered in the order given; rows must be plain. A task that
    no row precedes has an empty `need`.
    """
    number = {task: k for k, task in enumerate(tasks)}
    ready = fleet.ready
    n, vehicles = len(tasks), len(ready)
    release, due = np.zeros(n, np.int64), np.full(n, FAR, np.int64)
    need = np.zeros(n, np.int64)
    refs: dict[tuple[int, tuple[int, ...]], int] = {}
    masks = n <= TASKS_MAX
    listed: list[list[tuple[int, int]]] = [[] for _ in tasks]
    users: list[int] = []
    for row in rows:
        i = number[row.i]
        if row.kind == NOT_BEFORE:
            release[i] = max(release[i], row.lo)
        elif row.kind == NOT_AFTER:
            due[i] = min(due[i], row.hi)
        else:
            group = tuple(number[task] for task in row.group)
            if masks and row.kind == AFTER_END:
                need[i] |= _mask(group)
            key = (1 if row.kind == AFTER_END else 2, group)
            place = refs.setdefault(key, len(refs))
            if place == len(users):
                users.append(0)
            if masks:
                users[place] |= 1 << i
            listed[i].append((place, row.lo))
    travel = np.ascontiguousarray(fleet.travel, np.int64)
    may = np.ascontiguousarray(fleet.may, np.uint8)
    added = np.ascontiguousarray(fleet.added, np.int64)
    twin = np.arange(vehicles)
    for v in range(vehicles):
        for w in range(v):
            same = ready[v] == ready[w] and (may[v] == may[w]).all()
            if same and (travel[v] == travel[w]).all() and (added[v] == added[w]).all():
                twin[v] = w
                break
    first = np.cumsum([0, *[len(rows_of) for rows_of in listed]]).astype(np.int64)
    flat = [pair for rows_of in listed for pair in rows_of]
    return Instance(
        travel,
        added,
        np.array([duration for _, duration in options], np.int64),
        np.array([number[task] for task, _ in options], np.int64),
        may,
        np.array(ready, np.int64),
        release,
        due,
        need,
        np.array([kind for kind, _ in refs], np.int64),
        np.array([_mask(group) if masks else 0 for _, group in refs], np.int64),
        np.array(users, np.int64),
        np.cumsum([0, *[len(group) for _, group in refs]]).astype(np.int64),
        np.array([task for _, group in refs for task in group], np.int64),
        first,
        np.array([place for place, _ in flat], np.int64),
        np.array([lo for _, lo in flat], np.int64),
        twin,
        np.array(weight, np.int64),
        int(waits),
    )


def _mask(group: Sequence[int]) -> int:
    return sum(1 << task for task in group)


def horizon(i: Instance) -> int:
    """Upper bound of the end of any schedule without needless waiting [ms]."""
    ways = i.travel[i.travel < FAR]
    longest = int(ways.max()) if ways.size else 0
    lags = int(i.row_lo.sum()) if i.row_lo.size else 0
    times = int(i.ready.max()) + int(i.release.sum()) + int(i.duration.sum())
    return times + i.tasks * longest + lags
