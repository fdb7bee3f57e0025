"""Enumeration of all chains of an instance that could still cost less than a limit.

For problems with upper limits between tasks or with whole laps: there, earlier is not always better, so no state is
pruned by dominance. Depth first, least bound first. The instance is the problem without those limits, so its bounds
are valid for the problem; the caller (`chains_below`) gets each complete list of moves and returns its cost, and the
number of first moves that already rule it out (a schedule that is infeasible for the first moves alone stays
infeasible with more moves).

Each set of chains is listed in one order only: by start if tasks start in the order of assignment; otherwise a move
may not follow one of a later vehicle that did not make it possible.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cratous.core.assignment.compiled import CHILD, machine_searching
from cratous.core.assignment.instance import Instance
from cratous.core.assignment.layers import first_state, look_ahead, search_below
from cratous.core.assignment.refutation import bound, place
from cratous.core.assignment.search_records import REFUTES, Ahead, Search
from cratous.core.assignment.steps import opened
from cratous.core.assignment.tables import deals
from cratous.core.kernel import driver

Moves = tuple[tuple[int, int], ...]
Judge = Callable[[Moves, int], tuple[int, int]]
"""(moves, limit) -> (their cost, or the limit if it is not below it; how many of the first moves suffice for that
result).
"""
LEAF, EMPTY, TIRED = 1, 0, 2


def descend(
    stack: np.ndarray, kids: np.ndarray, count: np.ndarray, turn: np.ndarray, control: np.ndarray,
    limit: int, budget: int, search: Search,
) -> int:  # fmt: skip
    """Go on to the next complete list of moves: 1 found, 0 there is none, 2 the budget is spent.

    stack [n + 1, S]: states; kids [n, V K, 3]: per depth (bound, vehicle, option), sorted; count, turn [n]: how many,
    and which is next; control: depth, nodes, and whether the children of this depth have been generated.
    """
    i = search.instance
    may, task, twin, waits = i.may, i.task, i.twin, i.waits
    vehicles, options = may.shape
    n = i.release.size
    child, scratch = np.zeros(stack.shape[1], np.int64), np.zeros((4, 64), np.int64)
    everything = (1 << n) - 1
    spent = 0
    while control[0] >= 0:
        d = control[0]
        state = stack[d]
        if control[2] == 0:
            many = 0
            for o in range(options):
                j = task[o]
                if (state[0] >> j) & 1:
                    continue
                for v in range(vehicles):
                    if may[v, o] == 0:
                        continue
                    u = twin[v]
                    if waits and u != v and state[1 + v] == options and state[1 + u] == options:
                        continue
                    if waits == 0 and d > 0:
                        # this move was possible before the last one, so it is listed before it
                        w = kids[d - 1, turn[d - 1] - 1, 1]
                        if v < w:
                            done = stack[d - 1][0]
                            before = opened(done, i.need[j])
                            for p in range(i.row_first[j], i.row_first[j + 1]):
                                r = i.row_ref[p]
                                if i.ref_kind[r] == 2 and (i.ref_group[r] & done) == 0:
                                    before = False
                            if before:
                                continue
                    if not place(state, child, v, o, i, waits):
                        continue
                    spent += 1
                    low = bound(child, i, search.ahead)
                    if low >= limit:
                        continue
                    asked = d + 1 < n and search.deals
                    if asked and not deals(everything & ~child[0], child, search, scratch):
                        continue
                    p = many
                    while p > 0 and kids[d, p - 1, 0] > low:
                        for c in range(3):
                            kids[d, p, c] = kids[d, p - 1, c]
                        p -= 1
                    kids[d, p, 0], kids[d, p, 1], kids[d, p, 2] = low, v, o
                    many += 1
            count[d] = many
            turn[d] = 0
            control[2] = 1
            if spent >= budget:
                control[1] += spent
                return 2
        if turn[d] >= count[d] or kids[d, turn[d], 0] >= limit:
            control[0] = d - 1
            continue
        v, o = kids[d, turn[d], 1], kids[d, turn[d], 2]
        turn[d] += 1
        place(state, stack[d + 1], v, o, i, waits)
        if d + 1 == n:
            control[1] += spent
            return 1
        control[0] = d + 1
        control[2] = 0
    control[1] += spent
    return 0


@dataclass(frozen=True)
class Listed:
    """The result. moves: the best below the limit, or None; complete: all lists were examined."""

    cost: int
    moves: Moves | None
    complete: bool
    nodes: int
    leaves: int


@driver(checked_by=tuple(name for name in REFUTES if name != "covers_step"))
def chains_below(
    instance: Instance,
    limit: int,
    judge: Judge,
    nodes: int,
    stop: Callable[[int], bool] | None = None,
    ahead: Ahead | None = None,
) -> Listed:
    """The best moves that cost less than `limit` by `judge`, within `nodes` nodes.

    stop: called periodically with the number of nodes so far; True ends the search.
    """
    i, n = instance, instance.tasks
    ahead = look_ahead(i) if ahead is None else ahead
    search = search_below(i, ahead, limit)
    first = first_state(i)
    stack = np.zeros((n + 1, first.size), np.int64)
    stack[0] = first
    kids = np.zeros((n, i.vehicles * i.duration.size, 3), np.int64)
    count, turn, control = np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(3, np.int64)
    best, leaves = None, 0
    while True:
        left = nodes - int(control[1])
        if left <= 0 or (stop is not None and stop(int(control[1]))):
            return Listed(limit, best, False, int(control[1]), leaves)
        most = min(left, 20_000)
        run = machine_searching(i, descend, CHILD * most)
        found = run(stack, kids, count, turn, control, limit, most, search)
        if found == EMPTY:
            return Listed(limit, best, True, int(control[1]), leaves)
        if found == TIRED:
            continue
        leaves += 1
        moves = tuple(
            (int(kids[d, turn[d] - 1, 1]), int(kids[d, turn[d] - 1, 2])) for d in range(n)
        )
        # judging a list costs as much as many nodes
        control[1] += LEAF_NODES
        cost, enough = judge(moves, limit)
        if cost < limit:
            limit, best = cost, moves
        elif 0 < enough <= n:
            # siblings of the last of these moves remain
            control[0], control[2] = enough - 1, 1


LEAF_NODES = 200
"""Cost of judging one list of moves, in nodes."""
