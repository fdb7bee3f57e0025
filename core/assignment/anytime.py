"""Anytime search of a plain instance: first leaf, annealing, refutation.

The returned bound is proved by the refutation whose origins are returned with it. All results depend only on the seed
and the limits, except that `stop`, if it reads a clock, determines how far the search gets.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from cratous.core.assignment.annealing import anneal, leaf
from cratous.core.assignment.by_sets import by_sets, is_sets
from cratous.core.assignment.compiled import machine_for, machine_for_pass
from cratous.core.assignment.instance import FAR, TASKS_MAX, Instance
from cratous.core.assignment.large_neighbourhoods import rebuild
from cratous.core.assignment.layers import (
    Outcome,
    first_state,
    look_ahead,
    refute,
    shortest,
)
from cratous.core.assignment.lower_bounds import heads, least_until, least_work
from cratous.core.assignment.refutation import bound
from cratous.core.assignment.search_records import REFUTES, Ahead
from cratous.core.assignment.steps import earliest_start, raised, soonest_end, weighted
from cratous.core.kernel import driver
from cratous.core.schedule.rows import later

Moves = tuple[tuple[int, int], ...]
NONE = 1 << 60
MOVE = 30
"""Elementary steps of one step of annealing."""


@dataclass
class Proof:
    """Evidence that no solution of an instance costs less than `bound`.

    kind: `tables` (from the tables over sets), `layers` (a refutation of `limit` by `origins`), `chains` (all chains
    below it were listed, in `limit` nodes), or `estimate` (the first state's bound).
    """

    kind: str
    bound: int
    limit: int = 0
    origins: tuple[np.ndarray, ...] = field(default=(), repr=False)


def greedy(instance: Instance) -> tuple[int, Moves | None]:
    """(nodes, the first leaf's moves, or None if it ends in a dead end)."""
    i, n = instance, instance.tasks
    order, who, how = np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(n, np.int64)
    nodes = int(machine_for_pass(i, leaf)(order, who, how, i))
    if nodes < 0:
        return n, None
    return nodes, tuple((int(who[j]), int(how[j])) for j in order)


def improve(
    instance: Instance, moves: Moves, steps: int, seed: int, hot: float = 0.15
) -> tuple[int, Moves]:
    """(cost, moves) of the best solution that annealing finds from these moves in `steps` steps.

    The cost is NONE if even that misses a latest end.
    """
    i, n = instance, instance.tasks
    order = np.array([i.task[o] for _, o in moves], np.int64)
    who, how = np.zeros(n, np.int64), np.zeros(n, np.int64)
    for v, o in moves:
        who[i.task[o]], how[i.task[o]] = v, o
    cost = int(machine_for(i, anneal, 1 + MOVE * steps)(order, who, how, steps, seed, hot, i))
    found = tuple((int(who[j]), int(how[j])) for j in order)
    late = cost >= NONE or any(end > i.due[i.task[o]] for _, o, _, _, end in timed(i, found))
    return NONE if late else cost, found


def rebuilt(
    instance: Instance, moves: Moves, rounds: int, seed: int, hot: float = 0.01
) -> tuple[int, Moves]:
    """(cost, moves) of the best solution after `rounds` rounds of removal and reinsertion.

    The cost is NONE if even that misses a latest end, or nothing could be reinserted.
    """
    i, n = instance, instance.tasks
    order = np.array([i.task[o] for _, o in moves], np.int64)
    who, how = np.zeros(n, np.int64), np.zeros(n, np.int64)
    for v, o in moves:
        who[i.task[o]], how[i.task[o]] = v, o
    apart = np.full((n, n), FAR, np.int64)
    ways = i.travel.min(axis=0)
    for a in range(i.duration.size):
        for b in range(i.duration.size):
            j, k = i.task[a], i.task[b]
            apart[j, k] = min(apart[j, k], ways[a, b]) if j != k else -1
    near = np.argsort(apart, axis=1, kind="stable")
    cost = int(machine_for(i, rebuild)(order, who, how, rounds, seed, hot, near, i))
    found = tuple((int(who[j]), int(how[j])) for j in order)
    late = cost >= NONE or any(end > i.due[i.task[o]] for _, o, _, _, end in timed(i, found))
    return NONE if late else cost, found


def timed(instance: Instance, moves: Moves) -> list[tuple[int, int, int, int, int]]:
    """(vehicle, option, arrival, start, end) of moves, at their earliest times [ms]."""
    i = instance
    free, at = [int(r) for r in i.ready], [i.duration.size] * i.vehicles
    starts: dict[int, int] = {}
    ends: dict[int, int] = {}
    found = []
    for v, o in moves:
        j = int(i.task[o])
        arrive = free[v] + int(i.travel[v, at[v], o])
        ref = int(i.release[j])
        for p in range(int(i.row_first[j]), int(i.row_first[j + 1])) if i.waits else ():
            r = int(i.row_ref[p])
            members = [int(m) for m in i.member[i.member_first[r] : i.member_first[r + 1]]]
            if i.ref_kind[r] == 1:
                at_ref = max(ends[m] for m in members)
            else:
                at_ref = min(starts[m] for m in members if m in starts)
            ref = raised(ref, at_ref, int(i.row_lo[p]))
        begin = earliest_start(free[v], arrive - free[v], 0, ref)
        starts[j], ends[j] = begin, begin + int(i.duration[o])
        free[v], at[v] = ends[j], o
        found.append((v, o, arrive, begin, ends[j]))
    return found


def estimate(instance: Instance, ahead: Ahead | None = None) -> int:
    """A bound without a search: the first state's, or above 62 tasks `rough_bound`."""
    i = instance
    if i.tasks > TASKS_MAX:
        return rough_bound(i)
    ahead = look_ahead(i) if ahead is None else ahead
    return int(machine_for_pass(i, bound)(first_state(i), i, ahead))


def rough_bound(instance: Instance) -> int:
    """A bound from the longest path through the rows and the least work of all tasks shared by all vehicles."""
    i = instance
    head, least, tail = machine_for_pass(i, heads)(i, shortest(i, i.may))
    work, legs = machine_for(i, least_work)(i)
    last = int(machine_for(i, least_until)(int(work), i.ready))
    for j in range(i.tasks):
        last = later(last, soonest_end(int(head[j]), int(head[j]), int(least[j])) + int(tail[j]))
    return weighted(last, int(work), int(legs), int(i.weight[0]), int(i.weight[1]))


@driver(checked_by=REFUTES)
def settle_bound(
    instance: Instance,
    limit: int,
    width: int,
    stop: Callable[[int], bool] | None = None,
    ahead: Ahead | None = None,
) -> tuple[int, Moves | None, Proof, Outcome | None]:
    """The optimum below `limit` as far as `width` allows: (cost, moves or None, proof, search).

    moves None: nothing below the limit was found; the proof's bound is what is certain.
    """
    if instance.tasks > TASKS_MAX:
        return limit, None, Proof("estimate", estimate(instance)), None
    ahead = look_ahead(instance) if ahead is None else ahead
    low = estimate(instance, ahead)
    if low >= limit:
        return limit, None, Proof("estimate", low), None
    if is_sets(instance):
        cost, moves = by_sets(instance, ahead)
        if moves is not None or cost >= limit:
            found = moves if cost < limit else None
            return min(cost, limit), found, Proof("tables", cost), None
    done = refute(instance, limit, width, ahead, stop)
    known = min(done.known, done.cost)
    if known < low:
        return done.cost, done.moves, Proof("estimate", low), done
    complete = done.known >= limit
    kind = Proof("layers", known, limit, done.origins) if complete else Proof("estimate", low)
    return done.cost, done.moves, kind, done
