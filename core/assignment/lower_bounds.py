"""The steps by which lower bounds of an assignment are added up, each a kernel, and their loops.

The least that any completion spends: for every remaining task the shortest leg to it and its shortest duration, over
all vehicles, options and preceding places; the tasks that have to follow; routes with stops. The loops call only
these kernels, so the bounds are admissible by induction over the loop (theorems `assignment_least_*`). Definitions:
`spec.assignment.bounds`. Integers, milliseconds.
"""

from __future__ import annotations

import numpy as np

from cratous.core.assignment.instance import Instance
from cratous.core.assignment.steps import lacks_room, raised, room_step
from cratous.core.kernel import kernel


@kernel(implements="assignment.bounds.undercuts_none")
def least_of(best: int, counts: bool, value: int) -> int:
    """The least of the choices: those so far, and one more if it can be chosen.

    best: the least so far; counts: whether the next can be chosen; value: what it takes. In ms.
    """
    if counts:
        return min(best, value)
    return best


@kernel(implements="assignment.bounds.can_be_spent")
def add_least(total: int, is_open: bool, least: int) -> int:
    """The least that tasks take together: those so far, and one more if it is still to be done.

    total: of the tasks so far; is_open: whether the next is to be done; least: what it takes. In ms.
    """
    if is_open:
        return total + least
    return total


@kernel(
    implements="assignment.bounds.stop_is_no_shortcut",
    restates="the bounds of a search count on ways that no stop makes shorter",
)
def no_shortcut(direct: int, first: int, stay: int, second: int) -> bool:
    """True iff a route with a stop takes no less time than stated for the direct route.

    direct: without; first, second: before and after the stop; stay: the stop. All in ms.
    """
    return direct <= first + stay + second


@kernel(implements="assignment.bounds.may_be_last")
def tail_step(tail: int, lag: int, least: int, after: int) -> int:
    """The least time from the end of a task to the end of all, once one more task follows it.

    tail: so far; lag: from its end to the start of the other one; least: what that one takes;
    after: the least time after that one. All in ms.
    """
    return max(tail, lag + least + after)


def least_until(work: int, free: np.ndarray) -> int:
    """An instant before which the vehicles cannot have done the work [ms]; -1: unknown."""
    vehicles = free.size
    until = 1 << 40
    for v in range(vehicles):
        total, count = work, 0
        for w in range(vehicles):
            if free[w] <= free[v]:
                total += free[w]
                count += 1
        until = min(until, (total + count - 1) // count)
    # the work must not fit one instant sooner: only then it is a bound
    room = 0
    for v in range(vehicles):
        room = room_step(room, until - 1, free[v])
    if lacks_room(room, work):
        return until
    return -1


def shortest_ways(travel: np.ndarray, duration: np.ndarray, may: np.ndarray) -> np.ndarray:
    """[V, K + 1, K]: the shortest time from an end to a start, through any options on the way."""
    vehicles, options = may.shape
    reach = travel.copy()
    for v in range(vehicles):
        for k in range(options):
            if may[v, k] == 0:
                for a in range(options + 1):
                    reach[v, a, k] = 1 << 40
        for m in range(options):
            onward = reach[v, m]
            if may[v, m] and onward.min() < 1 << 40:  # from a last stop no way leads on
                for a in range(options + 1):
                    ways = reach[v, a]
                    via = int(ways[m] + duration[m])
                    for b in range(options):
                        ways[b] = least_of(ways[b], True, via + onward[b])
    return reach


def ways_hold(reach: np.ndarray, travel: np.ndarray, duration: np.ndarray, may: np.ndarray) -> bool:
    """Whether no route, with whatever stops, is shorter than `reach` states: checked for every leg that a vehicle may
    fly and for every stop, which is all that the induction over a chain needs.
    """
    vehicles, options = may.shape
    for v in range(vehicles):
        for a in range(options + 1):
            for b in range(options):
                if may[v, b] and not no_shortcut(reach[v, a, b], travel[v, a, b], 0, 0):
                    return False
        for m in range(options):
            onward, stay = reach[v, m], int(duration[m])
            if may[v, m] and onward.min() < 1 << 40:  # no way over a last stop is any way at all
                for a in range(options + 1):
                    ways = reach[v, a]
                    first = int(ways[m])
                    for b in range(options):
                        if not no_shortcut(ways[b], first, stay, onward[b]):
                            return False
    return True


def nearest_ways(reach: np.ndarray, may: np.ndarray) -> np.ndarray:
    """[K + 1, K]: the minimum of a table [V, K + 1, K] over the vehicles that may do the option."""
    vehicles, options = may.shape
    nearest = np.full((options + 1, options), 1 << 40, np.int64)
    for v in range(vehicles):
        for a in range(options + 1):
            for b in range(options):
                nearest[a, b] = least_of(nearest[a, b], may[v, b] != 0, reach[v, a, b])
    return nearest


def ways_to_tasks(
    reach: np.ndarray, cheapest: np.ndarray, duration: np.ndarray, task: np.ndarray,
    may: np.ndarray, n: int,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """[V, K + 1, n], twice: the least time from a vehicle's stop to the end of a task by any option
    of it, and the least that a leg there costs."""
    vehicles, options = may.shape
    soonest = np.full((vehicles, options + 1, n), 1 << 40, np.int64)
    extra = np.full((vehicles, options + 1, n), 1 << 40, np.int64)
    for v in range(vehicles):
        for a in range(options + 1):
            for o in range(options):
                j, counts = task[o], may[v, o] != 0
                soonest[v, a, j] = least_of(soonest[v, a, j], counts, reach[v, a, o] + duration[o])
                extra[v, a, j] = least_of(extra[v, a, j], counts, cheapest[a, o])
    return soonest, extra


def ways_between_tasks(
    nearest: np.ndarray, cheapest: np.ndarray, duration: np.ndarray, task: np.ndarray, n: int
) -> tuple[np.ndarray, np.ndarray]:
    """[n, n], twice: the least time from the end of a task to the end of another by any vehicle and
    any options of both, and the least that a leg between them costs."""
    options = task.size
    brief, extra = np.full((n, n), 1 << 40, np.int64), np.full((n, n), 1 << 40, np.int64)
    for k in range(options):
        for o in range(options):
            i, j = task[k], task[o]
            brief[i, j] = least_of(brief[i, j], i != j, nearest[k, o] + duration[o])
            extra[i, j] = least_of(extra[i, j], i != j, cheapest[k, o])
    return brief, extra


def heads(i: Instance, reach: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Per task: earliest start, shortest duration, and the least time after its end [ms].

    reach: [V, K + 1, K], the shortest time from one option's end to another's start by any way.
    """
    duration, task, may, ready, release = i.duration, i.task, i.may, i.ready, i.release
    ref_kind, member_first, member = i.ref_kind, i.member_first, i.member
    row_first, row_ref, row_lo = i.row_first, i.row_ref, i.row_lo
    n, vehicles, options = release.size, ready.size, duration.size
    head, least = release.copy(), np.full(n, 1 << 40, np.int64)
    for k in range(options):
        least[task[k]] = least_of(least[task[k]], True, duration[k])
    first = np.full(n, 1 << 40, np.int64)
    for v in range(vehicles):
        for k in range(options):
            first[task[k]] = least_of(
                first[task[k]], may[v, k] != 0, ready[v] + reach[v, options, k]
            )
    for j in range(n):
        head[j] = raised(head[j], first[j], 0)
    tail = np.zeros(n, np.int64)
    if i.waits == 0:
        return head, least, tail
    for _ in range(n):
        changed = False
        for k in range(n):
            for place in range(row_first[k], row_first[k + 1]):
                r = row_ref[place]
                lag = row_lo[place]
                higher = head[k]
                if ref_kind[r] == 1:
                    for m in range(member_first[r], member_first[r + 1]):
                        j = member[m]
                        higher = raised(higher, head[j] + least[j], lag)
                        after = tail_step(tail[j], lag, least[k], tail[k])
                        if after > tail[j]:
                            tail[j] = after
                            changed = True
                else:
                    at = 1 << 40
                    for m in range(member_first[r], member_first[r + 1]):
                        at = least_of(at, True, head[member[m]])
                    higher = raised(higher, at, lag)
                if higher > head[k]:
                    head[k] = higher
                    changed = True
        if not changed:
            break
    return head, least, tail


def least_work(i: Instance) -> tuple[int, int]:
    """The least that all tasks take together: legs and durations [ms]; and the least cost of their legs."""
    travel, added, duration, task, may = i.travel, i.added, i.duration, i.task, i.may
    vehicles, options = may.shape
    n = i.release.size
    brief, cheap = np.full(n, 1 << 40, np.int64), np.full(n, 1 << 40, np.int64)
    for o in range(options):
        j = task[o]
        for a in range(options + 1):
            other = a == options or task[min(a, options - 1)] != j
            for v in range(vehicles):
                counts = other and may[v, o] != 0
                brief[j] = least_of(brief[j], counts, travel[v, a, o] + duration[o])
                cheap[j] = least_of(cheap[j], counts, added[v, a, o])
    work = 0
    legs = 0
    for j in range(n):
        work = add_least(work, True, brief[j])
        legs = add_least(legs, True, cheap[j])
    return work, legs
