"""Neighbourhoods repaired by the exact search: windows of a few chains are reassigned optimally.

From two or three vehicles, a few consecutive tasks each are removed; what each flies before stays fixed, and what it
flies after becomes one task that comes last, on any of these vehicles. This is a problem of a dozen tasks, which
`refute` solves to the end: either something better is found or nothing in this neighbourhood is better. Rows about
tasks outside use their present times. A result is kept only if all chains, timed anew (`time_chains`), cost less, so
it is checked like any other solution.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from cratous.core.assignment.compiled import machine_for
from cratous.core.assignment.instance import FAR, Fleet, Instance, instance
from cratous.core.assignment.large_neighbourhoods import time_chains
from cratous.core.assignment.layers import refute
from cratous.core.assignment.search_records import ChainArrays, Times
from cratous.core.kernel import driver
from cratous.spec.constraint_rows import AFTER_END, NOT_AFTER, NOT_BEFORE, Row

WINDOW, WIDTH = 8, 1_000
"""Tasks that are removed, and states that are kept of a layer of the small search."""
Moves = tuple[tuple[int, int], ...]


class Chains(NamedTuple):
    """Tasks of each vehicle in order, option of each task, their times, cost, and order of starts."""

    of: list[list[int]]
    how: np.ndarray
    starts: np.ndarray
    ends: np.ndarray
    cost: int
    order: np.ndarray


class Small(NamedTuple):
    """The problem of a neighbourhood: the vehicles, its tasks (those of the windows first, then what follows them) as
    tuples of tasks, and for each of its options the original one.
    """

    of: Instance
    vehicles: tuple[int, ...]
    tasks: tuple[tuple[int, ...], ...]
    options: tuple[int, ...]


def timed_chains(i: Instance, of: list[list[int]], how: np.ndarray) -> Chains | None:
    """The chains with their earliest times; None if they block each other or miss a latest end."""
    n, vehicles = i.tasks, i.vehicles
    chain, length = np.zeros((vehicles, n), np.int64), np.zeros(vehicles, np.int64)
    for v, tasks in enumerate(of):
        chain[v, : len(tasks)], length[v] = tasks, len(tasks)
    starts, ends, order = (np.zeros(n, np.int64) for _ in range(3))
    chains = ChainArrays(chain, length, how, np.ones(n, np.int64))
    times = Times(starts, ends, np.zeros(vehicles + 1, np.int64))
    next_of = np.zeros(vehicles, np.int64)
    cost = int(machine_for(i, time_chains)(chains, times, order, next_of, i))
    if cost >= 1 << 60 or (ends > i.due).any():
        return None
    return Chains(of, how, starts, ends, cost, order)


def smooth(i: Instance, now: Chains) -> int:
    """The cost plus a small share of the sum of last ends, so that chains other than the longest count too."""
    share = 6 * i.vehicles
    return now.cost * share + sum(int(now.ends[tasks[-1]]) for tasks in now.of if tasks)


def neighbourhood(i: Instance, now: Chains, windows: dict[int, tuple[int, int]]) -> Small | None:
    """The small problem of windows (first, last + 1) of some vehicles; None if a row has a form that it does not
    support.
    """
    picked = tuple(sorted(windows))
    groups: list[tuple[int, ...]] = [
        (j,) for v in picked for j in now.of[v][windows[v][0] : windows[v][1]]
    ]
    groups += [tuple(now.of[v][windows[v][1] :]) for v in picked if now.of[v][windows[v][1] :]]
    whose = {j: g for g, group in enumerate(groups) for j in group}
    inside = {int(o): whose[int(i.task[o])] for o in range(i.duration.size) if i.task[o] in whose}
    options: list[tuple[int, int]] = []
    for g, group in enumerate(groups):
        if len(group) > 1:
            options.append((g, int(now.how[group[0]])))
        else:
            options += [(g, o) for o, of in inside.items() if of == g]
    last = {g: int(now.how[group[-1]]) for g, group in enumerate(groups) if len(group) > 1}
    tail = len(groups) - sum(1 for v in picked if now.of[v][windows[v][1] :])
    # how long after the start of its group a task starts without waiting
    offset: dict[int, int] = {}
    long: dict[int, int] = {}
    for g, group in enumerate(groups):
        at = 0
        for k, j in enumerate(group):
            if k:
                before = int(now.how[group[k - 1]])
                at += int(i.duration[before])
                ways = [int(i.travel[v, before, now.how[j]]) for v in picked]
                at += min(ways)
            offset[j] = at
        long[g] = at + int(i.duration[now.how[group[-1]]])
    rows = _rows(i, now, whose, offset, long)
    if rows is None:
        return None
    count = len(options)
    travel = np.full((len(picked), count + 1, count), FAR, np.int64)
    added, may = np.zeros_like(travel), np.zeros((len(picked), count), np.uint8)
    share = 6 * i.vehicles
    for w, v in enumerate(picked):
        first = windows[v][0]
        origin = int(now.how[now.of[v][first - 1]]) if first else i.duration.size
        for b, (g, o) in enumerate(options):
            can = all(i.may[v, now.how[j]] for j in groups[g]) if g in last else i.may[v, o]
            may[w, b] = can
            for a in range(count + 1):
                if a < count and (options[a][0] == g or options[a][0] >= tail):
                    continue  # nothing comes after what comes last
                place = origin if a == count else options[a][1]
                travel[w, a, b] = i.travel[v, place, o]
                added[w, a, b] = i.added[v, place, o] * share
    ready = [
        int(now.ends[now.of[v][windows[v][0] - 1]]) if windows[v][0] else int(i.ready[v])
        for v in picked
    ]
    made = instance(
        range(len(groups)), rows,
        [(g, long[g] if g in last else int(i.duration[o])) for g, o in options],
        Fleet(ready, may, travel, added), (int(i.weight[0]) * share, int(i.weight[1]) * share + 1), bool(i.waits),
    )  # fmt: skip
    return Small(made, picked, tuple(groups), tuple(o for _, o in options))


def _rows(
    i: Instance, now: Chains, whose: dict[int, int], offset: dict[int, int], long: dict[int, int]
) -> list[Row] | None:
    """The constraints of the groups: releases, latest ends, and rows between them and with tasks outside."""
    rows = []
    for j in range(i.tasks):
        mine = whose.get(j)
        if mine is not None:
            shift = offset[j]
            rows.append(Row(NOT_BEFORE, mine, (), max(0, int(i.release[j]) - shift), 0, ""))
            if i.due[j] < FAR:
                over = long[mine] - shift - int(i.duration[now.how[j]])
                rows.append(Row(NOT_AFTER, mine, (), 0, int(i.due[j]) + over, ""))
        for place in range(int(i.row_first[j]), int(i.row_first[j + 1])):
            r, lag = int(i.row_ref[place]), int(i.row_lo[place])
            if i.ref_kind[r] != 1:
                return None
            for m in (int(x) for x in i.member[i.member_first[r] : i.member_first[r + 1]]):
                other = whose.get(m)
                if mine is None and other is not None and i.waits:
                    # tasks outside keep their starts
                    over = long[other] - offset[m] - int(i.duration[now.how[m]])
                    by = int(now.starts[j]) - lag + over
                    rows.append(Row(NOT_AFTER, other, (), 0, by, ""))
                elif mine is not None and other is None and i.waits:
                    at = int(now.ends[m]) + lag - offset[j]
                    rows.append(Row(NOT_BEFORE, mine, (), max(0, at), 0, ""))
                elif mine is not None and other is not None and mine != other:
                    rest = long[other] - offset[m] - int(i.duration[now.how[m]])
                    rows.append(Row(AFTER_END, mine, (other,), lag - offset[j] - rest, 0, ""))
    return rows


def _windows(i: Instance, now: Chains, rng: random.Random) -> dict[int, tuple[int, int]]:
    """The windows of one neighbourhood: of the vehicle that ends last and another, or of any."""
    busy = [v for v in range(i.vehicles) if now.of[v]]
    end = {v: int(now.ends[now.of[v][-1]]) for v in busy}
    worst = max(busy, key=lambda v: (end[v], v))
    others = [v for v in range(i.vehicles) if v != worst]
    rng.shuffle(others)
    picked = others[: rng.choice((1, 1, 2))]
    if rng.random() < 0.7 or not picked:
        picked.append(worst)
    each = WINDOW // len(picked)
    # the windows of different vehicles are at about the same time
    at_ms = rng.uniform(0, max(end.values()))
    windows = {}
    for v in picked:
        tasks = now.of[v]
        middle = sum(int(now.ends[j]) <= at_ms for j in tasks)
        size = min(each, len(tasks))
        first = max(0, min(middle - size // 2, len(tasks) - size))
        windows[v] = (first, first + size)
    return windows


@driver(checked_by=("earliest_start", "weighted"))
def repaired(
    i: Instance,
    moves: Moves,
    rounds: int,
    seed: int,
    stop: Callable[[int], bool] | None = None,
) -> tuple[int, Moves, int]:
    """(cost, moves, nodes) after `rounds` neighbourhoods were searched to the end.

    The moves may be the given ones; 2**60 if these already block each other or are late.
    """
    of: list[list[int]] = [[] for _ in range(i.vehicles)]
    how = np.zeros(i.tasks, np.int64)
    for v, o in moves:
        of[v].append(int(i.task[o]))
        how[i.task[o]] = o
    now, nodes, rng = timed_chains(i, of, how), 0, random.Random(seed)
    if now is None:
        return 1 << 60, moves, 0
    share = 6 * i.vehicles
    for _ in range(rounds):
        if stop is not None and stop(nodes):
            break
        windows = _windows(i, now, rng)
        small = neighbourhood(i, now, windows)
        if small is None:
            break
        ends = [int(now.ends[now.of[v][-1]]) for v in small.vehicles if now.of[v]]
        legs = _legs(i, now, windows) * share
        weight = [int(w) for w in small.of.weight]
        limit = max(ends, default=0) * weight[0] + sum(ends) * weight[1] + legs
        found = refute(small.of, limit, WIDTH)
        nodes += found.nodes
        if found.moves is None:
            continue
        better = _applied(i, now, windows, small, found.moves)
        if better is not None and smooth(i, better) < smooth(i, now):
            now = better
    order = [int(j) for j in now.order]
    who = {j: v for v, tasks in enumerate(now.of) for j in tasks}
    return now.cost, tuple((who[j], int(now.how[j])) for j in order), nodes


def _legs(i: Instance, now: Chains, windows: dict[int, tuple[int, int]]) -> int:
    """The present cost of the legs into the windows and out of them."""
    total = 0
    for v, (first, last) in windows.items():
        tasks = now.of[v]
        for k in range(first, min(last + 1, len(tasks))):
            before = int(now.how[tasks[k - 1]]) if k else i.duration.size
            total += int(i.added[v, before, now.how[tasks[k]]])
    return total


def _applied(
    i: Instance, now: Chains, windows: dict[int, tuple[int, int]], small: Small, moves: Moves
) -> Chains | None:
    """The chains with the windows as reassigned by the small search."""
    of, how = [list(tasks) for tasks in now.of], now.how.copy()
    for v in small.vehicles:
        del of[v][windows[v][0] :]
    for w, b in moves:
        group = small.tasks[int(small.of.task[b])]
        of[small.vehicles[w]] += group
        if len(group) == 1:
            how[group[0]] = small.options[b]
    return timed_chains(i, of, how)
