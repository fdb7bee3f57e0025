"""Latest departures for every set of tasks: the look-ahead of the search.

`latest[g, k, S]`: the latest instant at which a vehicle (of kind g) can leave option k and still do all tasks of S,
alone and in an order that the rows allow, each between its earliest start and its latest end. A state can be
completed only if the remaining tasks can be distributed so that every vehicle leaves in time: `deals`. By induction
over S from the kernel `latest_departure`.
"""

from __future__ import annotations

import numpy as np

from cratous.core.assignment.instance import Instance
from cratous.core.assignment.search_records import Search
from cratous.core.assignment.steps import keeps_step, latest_departure

CELLS_MAX = 48_000_000
"""Maximum number of cells of a table (4 bytes each)."""


def latest_tables(
    i: Instance, kind_of: np.ndarray, leader: np.ndarray, latest: np.ndarray, start: np.ndarray
) -> None:
    """Fill latest [kinds, K, 2**n] and start [V, 2**n].

    kind_of: [V] which vehicles share a table; leader: [kinds] a vehicle of each kind, whose legs between options are
    those of all of them. i.travel: shortest routes through any options, so that a vehicle late for some tasks is late
    for more. A shared table permits every option: which vehicle may fly it is checked in `start` and in `deals`.
    """
    travel, duration, task, may = i.travel, i.duration, i.task, i.may
    need, release, due = i.need, i.release, i.due
    n, options, vehicles = need.size, duration.size, may.shape[0]
    never = -1073741824
    for g in range(leader.size):
        v = leader[g]
        alone = 0
        for w in range(vehicles):
            if kind_of[w] == g:
                alone += 1
        for k in range(options):
            latest[g, k, 0] = 1073741823
        for chosen in range(1, 1 << n):
            for k in range(options):
                if (chosen >> task[k]) & 1:
                    continue
                best = never
                for o in range(options):
                    j = task[o]
                    if (chosen >> j) & 1 == 0 or (need[j] & chosen) != 0:
                        continue
                    if alone == 1 and may[v, o] == 0:
                        continue
                    if travel[v, k, o] >= 1 << 40:
                        continue
                    after = int(latest[g, o, chosen & ~(1 << j)])
                    leave = latest_departure(
                        due[j], after, release[j], duration[o], travel[v, k, o]
                    )
                    if leave > best:
                        best = leave
                latest[g, k, chosen] = best
    for v in range(vehicles):
        g = kind_of[v]
        start[v, 0] = 1073741823
        for chosen in range(1, 1 << n):
            best = never
            for o in range(options):
                j = task[o]
                if (chosen >> j) & 1 == 0 or (need[j] & chosen) != 0 or may[v, o] == 0:
                    continue
                if travel[v, options, o] >= 1 << 40:
                    continue
                after = int(latest[g, o, chosen & ~(1 << j)])
                leave = latest_departure(
                    due[j], after, release[j], duration[o], travel[v, options, o]
                )
                if leave > best:
                    best = leave
            start[v, chosen] = best


def deals(left: int, state: np.ndarray, search: Search, scratch: np.ndarray) -> bool:
    """Whether the remaining tasks can be distributed so that every vehicle leaves in time.

    state: as in `core.assignment.refutation`: of each vehicle its last option (K: none yet) and when it is free;
    scratch: [4, 64]. Tasks are assigned one by one, those with the least slack first; a vehicle that is late for some
    is late for more. Stops after `search.effort` steps with True, which prunes nothing.
    """
    able, kind_of = search.ahead.able, search.ahead.kind_of
    latest, start = search.tables.latest, search.tables.start
    vehicles, options = search.instance.may.shape
    at, free = state[1 : 1 + vehicles], state[1 + vehicles : 1 + 2 * vehicles]
    line, tight, turn, parts = scratch[0], scratch[1], scratch[2], scratch[3]
    count = 0
    for j in range(62):
        if (left >> j) & 1 == 0:
            continue
        room = -(1 << 60)
        for v in range(vehicles):
            if (able[v] >> j) & 1:
                if at[v] == options:
                    by = int(start[v, 1 << j])
                else:
                    by = int(latest[kind_of[v], at[v], 1 << j])
                room = max(room, by - free[v])
        if room < 0:
            return False
        p = count
        while p > 0 and tight[p - 1] > room:
            tight[p] = tight[p - 1]
            line[p] = line[p - 1]
            p -= 1
        tight[p] = room
        line[p] = j
        count += 1
    for v in range(vehicles):
        parts[v] = 0
    p = 0
    turn[0] = 0
    steps = 0
    while p < count:
        j = line[p]
        v = turn[p]
        dealt = False
        while v < vehicles:
            steps += 1
            if (able[v] >> j) & 1:
                more = parts[v] | (1 << j)
                if at[v] == options:
                    by = int(start[v, more])
                else:
                    by = int(latest[kind_of[v], at[v], more])
                if keeps_step(True, free[v], by):
                    dealt = True
                    break
            v += 1
        if steps > search.effort:
            return True
        if dealt:
            parts[v] |= 1 << j
            turn[p] = v
            p += 1
            turn[p] = 0
        else:
            p -= 1
            if p < 0:
                return False
            parts[turn[p]] &= ~(1 << line[p])
            turn[p] += 1
    return True
