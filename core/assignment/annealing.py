"""Fast heuristic assignments: a first leaf as in UxAS, and simulated annealing of the order of tasks.

A solution is an order of all tasks with a vehicle and an option each; its times are the earliest ones. Moves take out
one or a few tasks and insert them elsewhere. Random numbers come from a seeded counter, so that a result depends only
on the seed and the number of steps. Nothing is claimed of the result except its times, which the caller checks with
the proved kernels.
"""

from __future__ import annotations

import numpy as np

from cratous.core.assignment.instance import Instance
from cratous.core.assignment.search_records import Times
from cratous.core.assignment.steps import earliest_start, weighted


def put_all(to: np.ndarray, values: np.ndarray) -> None:
    """Fill an array with the values of another one of the same size.

    Without slices: their compiled size-mismatch error costs seconds of compile time.
    """
    for k in range(to.size):
        to[k] = values[k]


def decode(
    order: np.ndarray, who: np.ndarray, how: np.ndarray, times: Times, at: np.ndarray,
    i: Instance, stop: int,
) -> int:  # fmt: skip
    """The cost of a solution, with its times; 2**60 if the order or a leg does not exist.

    Each millisecond beyond a latest end costs 1000, so that a search can recover. Stops where the cost reaches
    `stop`. at [V]: the last option of each vehicle.
    """
    starts, ends, free = times.starts, times.ends, times.free
    travel, added, duration, ready = i.travel, i.added, i.duration, i.ready
    release, due, ref_kind, member_first = i.release, i.due, i.ref_kind, i.member_first
    member, row_first, row_ref, row_lo = i.member, i.row_first, i.row_ref, i.row_lo
    weight, waits = i.weight, i.waits
    n, vehicles, options = order.size, ready.size, duration.size
    for v in range(vehicles):
        free[v] = ready[v]
        at[v] = options
    for j in range(n):
        ends[j] = -1
    late = 0
    legs = 0
    last = 0
    for p in range(n):
        j = order[p]
        v = who[j]
        o = how[j]
        way = travel[v, at[v], o]
        if way >= 1 << 40:
            return 1 << 60
        ref = release[j]
        for place in range(row_first[j], row_first[j + 1]):
            r = row_ref[place]
            if ref_kind[r] == 1:
                at_ref = 0
                for m in range(member_first[r], member_first[r + 1]):
                    e = ends[member[m]]
                    if e < 0:
                        return 1 << 60
                    at_ref = max(at_ref, e)
            else:
                at_ref = 1 << 40
                for m in range(member_first[r], member_first[r + 1]):
                    if ends[member[m]] >= 0:
                        at_ref = min(at_ref, starts[member[m]])
                if at_ref == 1 << 40:
                    return 1 << 60
            if waits:
                ref = max(ref, at_ref + row_lo[place])
        legs += added[v, at[v], o]
        begin = earliest_start(free[v], way, 0, ref)
        starts[j] = begin
        ends[j] = begin + duration[o]
        free[v] = ends[j]
        at[v] = o
        last = max(last, ends[j])
        if ends[j] > due[j]:
            late += ends[j] - due[j]
        if last * weight[0] + late * 1000 >= stop:
            return 1 << 60
    team = 0
    for v in range(vehicles):
        if at[v] != options:
            team += free[v]
    free[vehicles] = team
    return weighted(last, team, legs, weight[0], weight[1]) + late * 1000


def leaf(order: np.ndarray, who: np.ndarray, how: np.ndarray, i: Instance) -> int:
    """Build the first leaf: always the child of least cost so far, then of the earliest end. Returns the number of
    nodes.

    -1: it ends in a state from which some task cannot be done.
    """
    travel, added, duration, ready = i.travel, i.added, i.duration, i.ready
    release, due, ref_kind, member_first = i.release, i.due, i.ref_kind, i.member_first
    member, row_first, row_ref, row_lo = i.member, i.row_first, i.row_ref, i.row_lo
    weight, waits = i.weight, i.waits
    task, may = i.task, i.may
    n, vehicles, options = release.size, ready.size, duration.size
    free, at = ready.copy(), np.full(vehicles, options, np.int64)
    starts, ends = np.zeros(n, np.int64), np.full(n, -1, np.int64)
    last = 0
    team = 0
    nodes = 0
    for p in range(n):
        best, best_end, bv, bo, best_begin = 1 << 60, 1 << 60, -1, -1, 0
        for o in range(options):
            j = task[o]
            if ends[j] >= 0:
                continue
            ref = release[j]
            open_now = True
            for place in range(row_first[j], row_first[j + 1]):
                r = row_ref[place]
                at_ref = 0 if ref_kind[r] == 1 else 1 << 40
                for m in range(member_first[r], member_first[r + 1]):
                    e = ends[member[m]]
                    if ref_kind[r] == 1:
                        if e < 0:
                            open_now = False
                        at_ref = max(at_ref, e)
                    elif e >= 0:
                        at_ref = min(at_ref, starts[member[m]])
                if at_ref == 1 << 40:
                    open_now = False
                if waits:
                    ref = max(ref, at_ref + row_lo[place])
            if not open_now:
                continue
            for v in range(vehicles):
                way = travel[v, at[v], o]
                if may[v, o] == 0 or way >= 1 << 40:
                    continue
                nodes += 1
                begin = earliest_start(free[v], way, 0, ref)
                end = begin + duration[o]
                before = free[v] if at[v] != options else 0
                cost = weighted(
                    max(last, end), team - before + end, added[v, at[v], o], weight[0], weight[1]
                )
                if end > due[j]:
                    cost += (end - due[j]) * 1000
                if cost < best or (cost == best and end < best_end):
                    best, best_end, bv, bo, best_begin = cost, end, v, o, begin
        if bv < 0:
            return -1
        j = task[bo]
        order[p], who[j], how[j] = j, bv, bo
        team += best_end - (free[bv] if at[bv] != options else 0)
        free[bv], at[bv] = best_end, bo
        starts[j], ends[j] = best_begin, best_end
        last = max(last, best_end)
    return nodes


def anneal(
    order: np.ndarray, who: np.ndarray, how: np.ndarray, steps: int, seed: int, hot: float,
    i: Instance,
) -> int:  # fmt: skip
    """Improve a solution in place for `steps` steps; returns the cost of the best, which is left in the arrays.

    hot: initial temperature, as a share of the cost. One step takes a task out, or exchanges the positions of two,
    and is accepted by threshold accepting.
    """
    task, may = i.task, i.may
    n, vehicles, options = order.size, i.ready.size, i.duration.size
    free, at = np.zeros(vehicles + 1, np.int64), np.zeros(vehicles, np.int64)
    times = Times(np.zeros(n, np.int64), np.zeros(n, np.int64), free)
    trial, trial_who, trial_how = order.copy(), who.copy(), how.copy()
    best_order, best_who, best_how = order.copy(), who.copy(), how.copy()
    # not a literal: the compiler would compile `decode` a second time for it
    now = decode(order, who, how, times, at, i, int(1 << 60))  # noqa: RUF046
    best = now
    share = 6 * vehicles
    smooth = now + free[vehicles] // share
    x = np.int64(seed * 2 + 88172645463325253)
    for step in range(steps):
        x ^= x << 13
        x ^= (x >> 7) & np.int64(0x01FFFFFFFFFFFFFF)
        x ^= x << 17
        a = (x & 0xFFFF) % n
        b = ((x >> 16) & 0xFFFF) % n
        pick = (x >> 32) & 0xFF
        other = ((x >> 40) & 0x3FFFFF) % options
        put_all(trial, order)
        put_all(trial_who, who)
        put_all(trial_how, how)
        if pick < 40:
            # exchange the vehicles of two tasks, and possibly their positions
            ja, jb = trial[a], trial[b]
            if pick < 20:
                trial[a], trial[b] = jb, ja
            trial_who[ja], trial_who[jb] = trial_who[jb], trial_who[ja]
        elif pick < 80:
            # the same position, another vehicle or option
            j = trial[a]
            trial_who[j] = ((x >> 34) & 0x3FF) % vehicles
            if task[other] == j:
                trial_how[j] = other
        else:
            # take one out and insert it at b, with a random vehicle and option
            j = trial[a]
            if a < b:
                for k in range(a, b):
                    trial[k] = trial[k + 1]
            else:
                for k in range(a, b, -1):
                    trial[k] = trial[k - 1]
            trial[b] = j
            if pick < 220:
                trial_who[j] = ((x >> 34) & 0x3FF) % vehicles
            if task[other] == j:
                trial_how[j] = other
        good = (
            may[trial_who[trial[a]], trial_how[trial[a]]]
            and may[trial_who[trial[b]], trial_how[trial[b]]]
        )
        if not good:
            continue
        left = 1.0 - step / steps
        slack = now * hot * left * left * (((x >> 20) & 0xFFF) / 4096.0)
        stop = smooth + int(slack)
        cost = decode(trial, trial_who, trial_how, times, at, i, stop + 1)
        if cost >= 1 << 60:
            continue
        if cost < best:
            best = cost
            put_all(best_order, trial)
            put_all(best_who, trial_who)
            put_all(best_how, trial_how)
        if cost + free[vehicles] // share <= stop:
            now = cost
            smooth = cost + free[vehicles] // share
            put_all(order, trial)
            put_all(who, trial_who)
            put_all(how, trial_how)
    put_all(order, best_order)
    put_all(who, best_who)
    put_all(how, best_how)
    return best
