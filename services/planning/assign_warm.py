"""Compile the assignment searches to machine code, on small problems."""

from __future__ import annotations

import functools

import numpy as np

from cratous.core.assignment.annealing import anneal, leaf
from cratous.core.assignment.anytime import estimate, greedy, improve, rebuilt, rough_bound
from cratous.core.assignment.by_sets import by_sets
from cratous.core.assignment.chains import chains_below, descend
from cratous.core.assignment.compiled import MODERATE_TASKS, machine_for
from cratous.core.assignment.instance import Instance
from cratous.core.assignment.large_neighbourhoods import rebuild, time_chains
from cratous.core.assignment.layers import first_state, look_ahead, refute, shortest
from cratous.core.assignment.lower_bounds import heads
from cratous.core.assignment.refutation import bound, closed, expand, rehash
from cratous.core.assignment.refutation_check import least_cost
from cratous.core.assignment.repair import repaired
from cratous.core.readings.machine.compiled import is_kept
from cratous.services.planning.assign_problem import arrays, parts
from cratous.spec.assignment.search import ORDER, TIME, AssignmentProblem, Choice

_LOOPS = (anneal, rebuild, descend, time_chains, expand, rehash, closed)


def read() -> None:
    """Load the cached machine code of an assignment with time semantics, if all of it is available."""
    if all(is_kept(loop) for loop in _LOOPS):
        warm_search(simple_instance(TIME))
        warm_refutation(wide_instance(TIME))


@functools.cache
def warm() -> None:
    """Compile everything, so that no time limit is spent on that."""
    for semantics in (TIME, ORDER):
        warm_search(simple_instance(semantics))
        if semantics == ORDER:
            by_sets(simple_instance(semantics))
        warm_refutation(wide_instance(semantics))
        warm_passes(wide_instance(semantics))


def warm_search(i: Instance) -> None:
    """Compile first leaves, improvement, chain enumeration and bounds."""
    _, moves = greedy(i)
    assert moves is not None
    improve(i, moves, 1, 1)
    rebuilt(i, moves, 1, 1)
    repaired(i, moves, 1, 1)
    chains_below(i, 9, lambda moves, limit: (limit, len(moves)), 1_000)
    estimate(i, look_ahead(i))


def warm_refutation(i: Instance) -> None:
    """Compile the exact refutation, the growth of its table, and the check of its result."""
    refute(i, 9, 1)
    table, whole = np.full(16, -1, np.int64), np.empty(0, np.int64)
    machine_for(i, rehash)(np.empty((0, 1), np.int64), 0, table, whole, i.vehicles)
    least_cost(i, 9, [np.empty((0, 3), np.int64)])


def warm_passes(i: Instance) -> None:
    """Compile the passes over all tasks and moves, which are compiled for very large problems."""
    order = [np.zeros(i.tasks, np.int64) for _ in range(3)]
    machine_for(i, leaf)(*order, i)
    machine_for(i, bound)(first_state(i), i, look_ahead(i))
    machine_for(i, heads)(i, shortest(i, i.may))
    rough_bound(i)


def simple_instance(semantics: str) -> Instance:
    """An assignment problem of tasks in sequence; smaller ones are begun in CPython."""
    return _instance(".", (1,), semantics)


def wide_instance(semantics: str) -> Instance:
    """An assignment problem of tasks that any of four vehicles may serve; with fewer combinations it would be solved
    in CPython."""
    return _instance("|", (1, 2, 3, 4), semantics)


def _instance(operator: str, vehicles: tuple[int, ...], semantics: str) -> Instance:
    count = MODERATE_TASKS + 1
    rows = tuple(tuple(None if a == b else 1 for b in range(count)) for a in range(count + 1))
    choices = tuple(Choice(task, 1, 1, vehicles) for task in range(1, count + 1))
    relations = f"{operator}({' '.join(f'p{one.task_id}' for one in choices)})"
    p = AssignmentProblem(
        "", vehicles, (0,) * len(vehicles), choices, (rows,) * len(vehicles), relations,
        semantics=semantics,
    )  # fmt: skip
    return arrays(p, parts(p)[0][0])
