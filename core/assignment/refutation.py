"""Refuting a cost: all states of a plain instance from which a lower cost could still be reached.

A state contains what matters for the continuation: the tasks done, where each vehicle is and when it is free, the
references of rows that are still open, and the instant before which no later task starts (tasks are added in the
order of their starts; later ones wait if they must). Layer by layer, a child is pruned if a bound shows that it
cannot be completed below the limit, or if another state of its layer is nowhere later (`covers_step`). If no state is
dropped for lack of memory, the last layer contains the optimum, or nothing is below the limit.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cratous.core.assignment.instance import Instance
from cratous.core.assignment.lower_bounds import add_least, least_of, least_until
from cratous.core.assignment.search_records import Ahead, Layer, Search
from cratous.core.assignment.steps import (
    covers_step,
    earliest_start,
    opened,
    raised,
    soonest_end,
    weighted,
)
from cratous.core.assignment.tables import deals
from cratous.core.schedule.rows import later


def place(state: np.ndarray, child: np.ndarray, v: int, o: int, i: Instance, floors: int) -> bool:
    """Write into `child` the state after vehicle v does option o next; False if it cannot.

    A state: done, V x last option (K: none), V x free, floor, added, R references. A reference that no remaining task
    reads is 0; one of which nothing is done is -1.
    """
    travel, ref_kind, ref_group = i.travel, i.ref_kind, i.ref_group
    vehicles = travel.shape[0]
    done = state[0]
    j = i.task[o]
    way = travel[v, state[1 + v], o]
    if (done >> j) & 1 or not opened(done, i.need[j]) or way >= 1 << 40:
        return False
    base = 3 + 2 * vehicles
    ref = i.release[j]
    for p in range(i.row_first[j], i.row_first[j + 1]):
        r = i.row_ref[p]
        if ref_kind[r] == 2 and (ref_group[r] & done) == 0:
            return False
        if i.waits:
            ref = raised(ref, state[base + r], i.row_lo[p])
    floor = state[1 + 2 * vehicles] if floors else 0
    begin = earliest_start(state[1 + vehicles + v], way, floor, ref)
    end = begin + i.duration[o]
    if end > i.due[j]:
        return False
    for c in range(state.size):
        child[c] = state[c]
    child[0] = done | (1 << j)
    child[1 + v] = o
    child[1 + vehicles + v] = end
    if floors:
        child[1 + 2 * vehicles] = begin
    child[2 + 2 * vehicles] = state[2 + 2 * vehicles] + i.added[v, state[1 + v], o]
    for r in range(ref_kind.size):
        c = base + r
        if (i.ref_user[r] & ~child[0]) == 0:
            child[c] = 0
        elif i.waits and (ref_group[r] >> j) & 1:
            if ref_kind[r] == 1:
                child[c] = max(child[c], end)
            elif state[c] < 0:
                child[c] = begin
            else:
                child[c] = min(child[c], begin)
    return True


def cost_now(state: np.ndarray, vehicles: int, options: int, weight: np.ndarray) -> int:
    """The cost of the tasks done; it does not decrease along a chain of states."""
    last = 0
    team = 0
    for v in range(vehicles):
        if state[1 + v] != options:
            last = max(last, state[1 + vehicles + v])
            team += state[1 + vehicles + v]
    return weighted(last, team, state[2 + 2 * vehicles], weight[0], weight[1])


def bound(state: np.ndarray, i: Instance, ahead: Ahead) -> int:
    """A lower bound of the cost of all completions of the state. 2**60: there is none."""
    vehicles, options = i.may.shape
    n, due, weight = i.release.size, i.due, i.weight
    to_task, to_task_added = ahead.to_task, ahead.to_task_added
    apart, apart_added = ahead.apart, ahead.apart_added
    done = state[0]
    last = 0
    team = 0
    for v in range(vehicles):
        if state[1 + v] != options:
            last = later(last, state[1 + vehicles + v])
            team += state[1 + vehicles + v]
    work = 0
    legs = state[2 + 2 * vehicles]
    for j in range(n):
        if (done >> j) & 1:
            continue
        soonest = 1 << 40
        brief = 1 << 40
        extra = 1 << 40
        for v in range(vehicles):
            at = state[1 + v]
            soonest = least_of(soonest, True, state[1 + vehicles + v] + to_task[v, at, j])
            brief = least_of(brief, True, to_task[v, at, j])
            extra = least_of(extra, True, to_task_added[v, at, j])
        for k in range(n):
            counts = (done >> k) & 1 == 0 and k != j
            brief = least_of(brief, counts, apart[k, j])
            extra = least_of(extra, counts, apart_added[k, j])
        end = soonest_end(soonest, ahead.head[j], ahead.least[j])
        if end > due[j] or brief >= 1 << 40:
            return 1 << 60
        last = later(last, end + ahead.tail[j])
        work = add_least(work, True, brief)
        legs = add_least(legs, True, extra)
    if work > 0:
        last = later(last, least_until(work, state[1 + vehicles : 1 + 2 * vehicles]))
    return weighted(last, team + work, legs, weight[0], weight[1])


def covered_by(one: np.ndarray, other: np.ndarray, vehicles: int) -> bool:
    """Whether state `one` is nowhere later than `other`, with the same tasks and places."""
    for c in range(1 + vehicles):
        if one[c] != other[c]:
            return False
    ok = True
    for c in range(1 + vehicles, one.size):
        ok = covers_step(ok, one[c], other[c])
        if not ok:
            return False
    return ok


def key_of(state: np.ndarray, vehicles: int, size: int) -> Any:
    """A hash of the parts that must be equal for one state to cover another, below size (a power of 2)."""
    mixed = np.int64(1469598103934665603)
    for c in range(1 + vehicles):
        mixed = (mixed ^ state[c]) * np.int64(1099511628211)
        mixed ^= (mixed >> 29) & np.int64(0x7FFFFFFFF)
    return mixed & (size - 1)


def expand(
    parents: np.ndarray, first: int, count: int, kept: int, layer: Layer, limit: int,
    search: Search, counts: np.ndarray,
) -> tuple[int, int]:  # fmt: skip
    """The children of parents[first:count] that could cost less than `limit`: (how many, next row).

    layer: filled up to `kept`. Stops before a row whose children might not fit into it. counts: nodes, pruned by
    bound, by dealing, covered.
    """
    i, into, origin, rank = search.instance, layer.states, layer.origin, layer.rank
    table, chain = layer.table, layer.chain
    may, task, twin, n = i.may, i.task, i.twin, i.release.size
    vehicles, options = may.shape
    child, scratch = np.zeros(parents.shape[1], np.int64), np.zeros((4, 64), np.int64)
    size = table.size
    everything = (1 << n) - 1
    for p in range(first, count):
        if kept + vehicles * options > into.shape[0]:
            return kept, p
        state = parents[p]
        for o in range(options):
            if (state[0] >> task[o]) & 1:
                continue
            for v in range(vehicles):
                if may[v, o] == 0:
                    continue
                # of equally capable unused vehicles, the first is used first
                if twin[v] != v and state[1 + v] == options and state[1 + twin[v]] == options:
                    continue
                if not place(state, child, v, o, i, i.waits):
                    continue
                counts[0] += 1
                low = bound(child, i, search.ahead)
                if low >= limit:
                    counts[1] += 1
                    continue
                place_in = key_of(child, vehicles, size)
                other = table[place_in]
                hidden = False
                while other >= 0:
                    if rank[other] >= 0 and covered_by(into[other], child, vehicles):
                        hidden = True
                        break
                    other = chain[other]
                if hidden:
                    counts[3] += 1
                    continue
                if search.deals and not deals(everything & ~child[0], child, search, scratch):
                    counts[2] += 1
                    continue
                other = table[place_in]
                while other >= 0:
                    if rank[other] >= 0 and covered_by(child, into[other], vehicles):
                        rank[other] = -1
                    other = chain[other]
                into[kept] = child
                origin[kept, 0], origin[kept, 1], origin[kept, 2] = p, v, o
                rank[kept] = low
                chain[kept] = table[place_in]
                table[place_in] = kept
                kept += 1
    return kept, count


def rehash(
    into: np.ndarray, kept: int, table: np.ndarray, chain: np.ndarray, vehicles: int
) -> None:
    """Rebuild the hash table of the states after it has grown."""
    table[:] = -1
    for k in range(kept):
        place_in = key_of(into[k], vehicles, table.size)
        chain[k] = table[place_in]
        table[place_in] = k


def closed(
    parents: np.ndarray, origin: np.ndarray, into: np.ndarray, table: np.ndarray,
    chain: np.ndarray, limit: int, search: Search,
) -> int:  # fmt: skip
    """Whether a layer lists all children of `parents` that could cost less than `limit`.

    origin [m, 3] gives how each state of the layer comes from a parent; the states are recomputed into `into`. A
    child may be missing only if a state of the layer covers it, or a bound or the dealing of tasks rules it out. -1:
    yes; else the number of a parent with a missing child, or -2 - k if entry k is not a possible move.
    """
    i = search.instance
    may, twin, n = i.may, i.twin, i.release.size
    vehicles, options = may.shape
    child, scratch = np.zeros(parents.shape[1], np.int64), np.zeros((4, 64), np.int64)
    table[:] = -1
    size = table.size
    for k in range(origin.shape[0]):
        p, v, o = origin[k, 0], origin[k, 1], origin[k, 2]
        if p < 0 or p >= parents.shape[0] or v < 0 or v >= vehicles or o < 0 or o >= options:
            return -2 - k
        if may[v, o] == 0 or not place(parents[p], child, v, o, i, i.waits):
            return -2 - k
        into[k] = child
        place_in = key_of(child, vehicles, size)
        chain[k] = table[place_in]
        table[place_in] = k
    everything = (1 << n) - 1
    for p in range(parents.shape[0]):
        state = parents[p]
        for o in range(options):
            for v in range(vehicles):
                if may[v, o] == 0:
                    continue
                if twin[v] != v and state[1 + v] == options and state[1 + twin[v]] == options:
                    continue
                if not place(state, child, v, o, i, i.waits):
                    continue
                other = table[key_of(child, vehicles, size)]
                there = False
                while other >= 0:
                    if covered_by(into[other], child, vehicles):
                        there = True
                        break
                    other = chain[other]
                if there:
                    continue
                low = bound(child, i, search.ahead)
                if low >= limit:
                    continue
                if search.deals and not deals(everything & ~child[0], child, search, scratch):
                    continue
                return p
    return -1
