"""Refuting a cost for a plain instance, layer by layer, and finding solutions below it on the way.

`refute(instance, limit)` has one of three results: a solution below the limit (the best one, if no state was
dropped); no such solution exists; or states had to be dropped for lack of memory, and the least of their bounds is
what is still known.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from cratous.core.assignment.compiled import (
    CHILD,
    FIRST_NODES,
    is_brief,
    is_moderate,
    machine_after,
    machine_for,
    machine_for_pass,
    machine_searching,
)
from cratous.core.assignment.instance import FAR, TABLE_MAX_MS, Instance, horizon
from cratous.core.assignment.lower_bounds import (
    heads,
    nearest_ways,
    shortest_ways,
    ways_between_tasks,
    ways_hold,
    ways_to_tasks,
)
from cratous.core.assignment.refutation import cost_now, expand, place, rehash
from cratous.core.assignment.search_records import REFUTES, Ahead, Layer, Search, Tables
from cratous.core.assignment.tables import CELLS_MAX, latest_tables
from cratous.core.kernel import driver

EFFORT = 2_000_000
"""Maximum number of steps for one question to `deals`."""
DEALS_TASKS = 20
LATEST = (1 << 30) - 1
"""Upper bound of the end of any task in an instance with tables [ms] (`TABLE_MAX_MS`); tables have 32-bit entries."""
CHUNK = 32
"""Rows of a layer expanded between two calls of `stop`."""
ROOM_BYTES = 50_000_000
"""Memory limit of the states of one layer."""
KEPT_BYTES = 50_000_000
"""Memory limit of the results that are kept."""


@dataclass(frozen=True)
class Outcome:
    """The result of a refutation.

    moves: (vehicle, option) in order of the best completion found, or None; cost: of it; known: no completion that is
    not listed costs less than this (the limit, if no state was dropped); layers: states kept, and the origins of the
    states of each layer; counts: nodes, pruned by bound, by dealing, covered.
    """

    cost: int
    moves: tuple[tuple[int, int], ...] | None
    known: int
    nodes: int
    states: int
    origins: tuple[np.ndarray, ...]
    counts: tuple[int, ...]


def look_ahead(instance: Instance) -> Ahead:
    """Shortest routes, heads and tails, and which vehicles share a table."""
    given = (*instance[:-1], np.array(instance.waits))
    known = _AHEAD.of(given)
    if known is not None:
        return Ahead(*known)
    made = _look_ahead(instance)
    _AHEAD.put(given, made)
    return made


def _look_ahead(i: Instance) -> Ahead:
    reach = shortest(i, i.may)
    head, least, tail = machine_for_pass(i, heads)(i, reach)
    able = np.zeros(i.vehicles, np.int64)
    for v in range(i.vehicles):
        for o in range(i.duration.size):
            if i.may[v, o]:
                able[v] |= 1 << int(i.task[o])
    kinds: dict[bytes, int] = {}
    kind_of, leader = np.zeros(i.vehicles, np.int64), []
    many = np.bincount(i.task, minlength=i.tasks).max() > 1
    for v in range(i.vehicles):
        key = i.travel[v, :-1].tobytes() + (i.may[v].tobytes() if many else b"")
        if key not in kinds:
            kinds[key] = len(kinds)
            leader.append(v)
        kind_of[v] = kinds[key]
    legs = i.travel.size
    least_over = machine_for(i, nearest_ways, legs)
    nearest, cheapest = least_over(reach, i.may), least_over(i.added, i.may)
    return Ahead(  # type: ignore[call-arg]  # numba's results have no types
        *machine_for(i, ways_to_tasks, 2 * legs)(reach, cheapest, i.duration, i.task, i.may, i.tasks),
        *machine_for(i, ways_between_tasks, legs)(nearest, cheapest, i.duration, i.task, i.tasks),
        least, head, tail, able, kind_of, np.array(leader, np.int64),
    )  # fmt: skip


def shortest(instance: Instance, may: np.ndarray) -> np.ndarray:
    """The shortest routes with any stops at options that `may` allows, checked for every stop."""
    i = instance
    given = (i.travel, i.duration, may)
    known = _FOUND.of(given) if is_moderate(i) else None
    if known is not None:
        return known[0]
    steps = i.travel.size * i.duration.size
    reach: np.ndarray = machine_for(i, shortest_ways, steps)(i.travel, i.duration, may)
    if not machine_for(i, ways_hold, steps)(reach, i.travel, i.duration, may):
        raise RuntimeError("a way with stops is shorter than the shortest way that was found")
    if is_moderate(i):
        _FOUND.put(given, (reach,))
    return reach


class _Found:
    """Cache of the latest results, keyed by all arrays on which they depend: a planner asks many questions about the
    same instance. most: results kept, of KEPT_BYTES together; a larger one is not kept.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._made: dict[bytes, tuple[np.ndarray, ...]] = {}
        self._bytes = 0

    def of(self, given: Sequence[np.ndarray]) -> tuple[np.ndarray, ...] | None:
        """The stored arrays for these; None if there are none."""
        found = self._made.get(_key(given))
        return None if found is None else tuple(array.copy() for array in found)

    def put(self, given: Sequence[np.ndarray], made: Sequence[np.ndarray]) -> None:
        """Store what was computed, and checked, from these; the oldest are dropped."""
        key, size = _key(given), sum(array.nbytes for array in made)
        if size > KEPT_BYTES:
            return
        self._drop(key)
        while self._made and (len(self._made) >= self._most or self._bytes + size > KEPT_BYTES):
            self._drop(next(iter(self._made)))
        self._made[key] = tuple(array.copy() for array in made)
        self._bytes += size

    def forget_all(self) -> None:
        """Clear the cache."""
        self._made.clear()
        self._bytes = 0

    def _drop(self, key: bytes) -> None:
        self._bytes -= sum(array.nbytes for array in self._made.pop(key, ()))


def _key(given: Sequence[np.ndarray]) -> bytes:
    digest = hashlib.sha256(repr([(array.shape, array.dtype.char) for array in given]).encode())
    for array in given:
        digest.update(np.ascontiguousarray(array).data)
    return digest.digest()


_FOUND, _AHEAD = _Found(64), _Found(16)


def forget() -> None:
    """Clear the caches, so that results, and the number of kernel calls, depend only on the questions asked from now
    on.
    """
    _FOUND.forget_all()
    _AHEAD.forget_all()


def tables(instance: Instance, ahead: Ahead, limit: int) -> Tables:
    """Latest departures for everything to end so that the cost is below the limit."""
    i, due = instance, instance.due.copy()
    if i.weight[0] > 0:
        due = np.minimum(due, (limit - 1) // int(i.weight[0]) - ahead.tail)
    full = due
    due = np.minimum(due, LATEST)
    kinds, n = len(ahead.leader), i.tasks
    if i.weight[0] == 0 and (i.due >= FAR).all():
        return Tables(0, i.due, np.zeros((1, 1, 1), np.int32), np.zeros((1, 1), np.int32))
    too_long = horizon(i) >= TABLE_MAX_MS
    if n > DEALS_TASKS or too_long or (kinds * i.duration.size + i.vehicles) << n > CELLS_MAX:
        return Tables(0, full, np.zeros((1, 1, 1), np.int32), np.zeros((1, 1), np.int32))
    latest = np.empty((kinds, i.duration.size, 1 << n), np.int32)
    start = np.empty((i.vehicles, 1 << n), np.int32)
    anywhere = shortest(i, np.ones_like(i.may))
    need = i.need if i.waits else i.need * 0
    relaxed = i._replace(travel=anywhere, need=need, release=ahead.head, due=due)
    steps = latest.size * i.duration.size
    machine_searching(i, latest_tables, steps)(relaxed, ahead.kind_of, ahead.leader, latest, start)
    return Tables(1, due, latest, start)


def search_below(instance: Instance, ahead: Ahead, limit: int) -> Search:
    """The search for solutions that cost less than the limit."""
    looked = tables(instance, ahead, limit)
    return Search(instance._replace(due=looked.due), ahead, looked, looked.used, EFFORT)


def first_state(instance: Instance) -> np.ndarray:
    """The state in which nothing is done."""
    v, options = instance.vehicles, instance.duration.size
    refs = [-1 if kind == 2 else 0 for kind in instance.ref_kind]
    return np.array([0, *[options] * v, *instance.ready, 0, 0, *refs], np.int64)


@driver(checked_by=REFUTES)
def refute(
    instance: Instance,
    limit: int,
    width: int,
    ahead: Ahead | None = None,
    stop: Callable[[int], bool] | None = None,
) -> Outcome:
    """Whether anything costs less than `limit`; at most `width` states are kept of a layer.

    stop: called periodically with the number of nodes so far; True ends the search.
    """
    i = instance
    ahead = look_ahead(i) if ahead is None else ahead
    search = search_below(i, ahead, limit)
    brief = is_brief(i)
    layer, ranks = first_state(i)[None, :], np.zeros(1, np.int64)
    counts, known = np.zeros(4, np.int64), limit
    origins: list[np.ndarray] = []
    states, fan = 1, i.vehicles * i.duration.size
    most = max(4 * fan, min(4 * width, ROOM_BYTES // (8 * (layer.shape[1] + 6))))
    for depth in range(i.tasks):
        if depth + 1 == i.tasks:
            search = search._replace(deals=0)
        room, first, kept, halted = min(most, 1024 + 2 * fan), 0, 0, False
        into, origin = np.empty((room, layer.shape[1]), np.int64), np.empty((room, 3), np.int64)
        rank, chain = np.empty(room, np.int64), np.empty(room, np.int64)
        table = np.full(2048, -1, np.int64)
        while first < len(layer) and not halted:
            made = Layer(into, origin, rank, table, chain)
            few = brief and counts[0] <= FIRST_NODES
            end = min(len(layer), first + CHUNK)
            kept, first = machine_after(few, i, expand, CHILD * (end - first) * fan)(
                layer, first, end, kept, made, limit, search, counts
            )
            halted = stop is not None and stop(int(counts[0]))
            if kept + fan > room and first < len(layer):
                if room >= most:
                    break
                room = min(most, 4 * room)
                into, origin = _longer(into, room), _longer(origin, room)
                rank, chain = _longer(rank, room), np.empty(room, np.int64)
                table = np.empty(1 << (2 * room - 1).bit_length(), np.int64)
                machine_searching(i, rehash, CHILD * kept)(into, kept, table, chain, i.vehicles)
        if first < len(layer) or halted:
            # children of the states from here on are dropped
            known = min(known, int(ranks[min(first, len(layer) - 1) :].min()))
        alive = np.flatnonzero(rank[:kept] >= 0)
        if len(alive) > width:
            by_rank = alive[np.argsort(rank[alive], kind="stable")]
            known = min(known, int(rank[by_rank[width]]))
            alive = np.sort(by_rank[:width])
        layer, ranks = into[alive], rank[alive]
        states += len(layer)
        origins.append(origin[alive].astype(np.int32))
        if halted or len(layer) == 0:
            if len(layer):
                known = min(known, int(ranks.min()))
            return Outcome(
                limit, None, known, int(counts[0]), states, tuple(origins), tuple(counts)
            )
    costs = [cost_now(s, i.vehicles, i.duration.size, i.weight) for s in layer]
    best = int(np.argmin(costs))
    moves: list[tuple[int, int]] = []
    row = best
    for found in reversed(origins):
        row, v, o = (int(x) for x in found[row])
        moves.append((v, o))
    cost = int(costs[best])
    return Outcome(
        cost, tuple(reversed(moves)), min(known, limit), int(counts[0]), states, tuple(origins),
        tuple(counts),
    )  # fmt: skip


def _longer(array: np.ndarray, room: int) -> np.ndarray:
    longer = np.empty((room, *array.shape[1:]), array.dtype)
    longer[: len(array)] = array
    return longer


def replay(instance: Instance, moves: tuple[tuple[int, int], ...]) -> list[np.ndarray]:
    """The states along a list of moves, including the first; ValueError for an impossible move."""
    i, state = instance, first_state(instance)
    states = [state]
    for v, o in moves:
        child = np.zeros_like(state)
        if not i.may[v, o] or not place(state, child, v, o, i, i.waits):
            raise ValueError("the moves are not possible in this order")
        state = child
        states.append(state)
    return states
