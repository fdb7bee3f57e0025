"""Evaluation of a process-algebra term, from its tasks to the whole, with the proved kernels.

A term is data here: its nodes in postfix order, operands before their operator. The tasks of a node and when they ran
are passed upwards (`tasks_with`, `ran_with`); the window of tasks without a timing constraint downwards
(`window_of`); whether a node was done as it permits upwards again (`task_held`, `operands_held`). No branch is
enumerated: every operand of a `+` is evaluated once, however many choices there are.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import reduce
from typing import NamedTuple

from cratous.core.algebra.steps import (
    Held,
    Part,
    Ran,
    Window,
    operand_fits,
    operands_held,
    ran_with,
    task_held,
    tasks_with,
    window_of,
)
from cratous.core.kernel import driver
from cratous.spec.errors import BadInput

Times = Mapping[int, tuple[int, int]]

TASK, ALTERNATIVE = 0, 4
CODES, TIMINGS = range(5), range(3)
"""Codes of `spec.algebra.operators`."""
TIME_LIMIT_MS = 2**61
"""Every time and bound lies within this: the range of the proofs."""
ANY_TIME = Window(-TIME_LIMIT_MS, TIME_LIMIT_MS)
MASK_BITS = 62
"""Number of tasks in one mask; a term with more tasks has several masks."""
NO_RUN = Ran(False, 0, 0)


class Node(NamedTuple):
    """A task, or an operator over the `arity` terms before it; codes as in `spec.algebra.operators`.

    task: its id, 0 for an operator; t1_ms, t2_ms: the bounds of its timing, 0 without one.
    """

    op: int
    arity: int
    task: int
    timing: int
    t1_ms: int
    t2_ms: int


def operands_of(nodes: Sequence[Node]) -> tuple[tuple[int, ...], ...]:
    """For each node the indices of its operands. Raises BadInput unless the nodes are exactly one term."""
    found: list[tuple[int, ...]] = []
    open_terms: list[int] = []
    for place, node in enumerate(nodes):
        if node.op not in CODES or node.timing not in TIMINGS:
            raise BadInput(
                "a node of a term has a code that means nothing",
                item=f"node {place}",
                expected="operator 0 to 4, timing 0 to 2",
                got=f"operator {node.op}, timing {node.timing}",
            )
        least, most = (0, 0) if node.op == TASK else (1, len(open_terms))
        if node.arity not in range(least, most + 1):
            raise BadInput(
                "a node of a term has not its operands before it",
                item=f"node {place}",
                expected="no operand for a task, else 1 or more of the terms that stand open",
                got=f"{node.arity} operands, {len(open_terms)} open terms",
            )
        first = len(open_terms) - node.arity
        found.append(tuple(open_terms[first:]))
        open_terms[first:] = [place]
    if len(open_terms) != 1:
        raise BadInput("not one term", expected="one term", got=f"{len(open_terms)} terms")
    return tuple(found)


def untimed(nodes: Sequence[Node]) -> tuple[Node, ...]:
    """The same term without timings."""
    return tuple(Node(n.op, n.arity, n.task, 0, 0, 0) for n in nodes)


@driver(
    checked_by=(
        "tasks_with", "operand_fits", "ran_with", "window_of", "task_held", "operands_held",
    )
)  # fmt: skip
def term_parts(nodes: Sequence[Node], times: Times, needed: bool) -> tuple[Part, ...]:
    """The evaluated parts of all nodes, the whole term last.

    times: when each task ran that was begun, (start, end) [ms]; needed: every task of the branch has to be done, else
    a part of it suffices. A node's `allowed` is evaluated under the timings around it, its `fits` in the `+` whose
    operand it is (true for other nodes). Raises BadInput for nodes that are not one term, and for times outside the
    proofs' range.
    """
    _in_range(nodes, times)
    inside = operands_of(nodes)
    places = _places(nodes)
    masks, begun = _masks(nodes, inside, places), _of(places, times)
    ran: list[Ran] = []
    for node, operands in zip(nodes, inside, strict=True):
        own = Ran(True, *times[node.task]) if not operands and node.task in times else NO_RUN
        ran.append(reduce(ran_with, (ran[k] for k in operands), own))
    windows = _windows(nodes, inside, ran)
    parts: list[Part] = []
    fits = [True] * len(nodes)
    for place, (node, operands) in enumerate(zip(nodes, inside, strict=True)):
        if node.op == TASK:
            held = Held(task_held(needed, ran[place], windows[place]), node.task in times)
        else:
            if node.op == ALTERNATIVE:
                for k in operands:
                    sets = zip(masks[place], masks[k], begun, strict=True)
                    fits[k] = all(operand_fits(*one) for one in sets)
                    parts[k] = parts[k]._replace(fits=fits[k])
            held = operands_held([(parts[k],) for k in operands], node.op)
        parts.append(Part(True, held.allowed, held.whole, ran[place]))
    return tuple(parts)


def _in_range(nodes: Sequence[Node], times: Times) -> None:
    for name, low, high in (
        *((f"task {task}", start, end) for task, (start, end) in times.items()),
        *((f"node {place}", node.t1_ms, node.t2_ms) for place, node in enumerate(nodes)),
    ):
        if max(abs(low), abs(high)) >= TIME_LIMIT_MS:
            raise BadInput(
                "a time is out of range",
                item=name,
                expected="less than 2**61 ms either way",
                got=f"{low} and {high} ms",
            )


def _places(nodes: Sequence[Node]) -> dict[int, int]:
    """The index of each task of a term."""
    found: dict[int, int] = {}
    for node in nodes:
        if node.op == TASK:
            found.setdefault(node.task, len(found))
    return found


def _of(places: Mapping[int, int], tasks: Iterable[int]) -> list[int]:
    """A set of tasks of a term as masks; the bit of a task is its index."""
    masks = [0] * (len(places) // MASK_BITS + 1)
    for task in tasks:
        if task in places:
            group, bit = divmod(places[task], MASK_BITS)
            masks[group] += 1 << bit
    return masks


def _masks(
    nodes: Sequence[Node], inside: Sequence[tuple[int, ...]], places: Mapping[int, int]
) -> list[list[int]]:
    """The tasks of each node, as masks."""
    masks: list[list[int]] = []
    for node, operands in zip(nodes, inside, strict=True):
        own = _of(places, () if operands else (node.task,))
        for k in operands:
            own = [tasks_with(one, other) for one, other in zip(own, masks[k], strict=True)]
        masks.append(own)
    return masks


def _windows(
    nodes: Sequence[Node], inside: Sequence[tuple[int, ...]], ran: Sequence[Ran]
) -> list[Window]:
    """For each node, the window in which its tasks without timing constraint may run; for a task, when it may run."""
    windows = [ANY_TIME] * len(nodes)
    for place in reversed(range(len(nodes))):
        node, outer = nodes[place], windows[place]
        bounds = Window(node.t1_ms, node.t2_ms)
        if node.op == TASK:
            windows[place] = window_of(outer, TASK, node.timing, True, NO_RUN, bounds)
        before = NO_RUN
        for number, k in enumerate(inside[place]):
            windows[k] = window_of(outer, node.op, node.timing, number == 0, before, bounds)
            before = ran[k]
    return windows


def done_as_permitted(nodes: Sequence[Node], times: Times, needed: bool) -> bool:
    """Whether the tasks that ran are permitted by the term; needed: and are all tasks that one branch requires.

    Tasks that are not in the term are ignored.
    """
    return term_parts(nodes, times, needed)[-1].allowed


def may_be_done(nodes: Sequence[Node], done: frozenset[int], needed: bool) -> bool:
    """Whether exactly these tasks of a term may be done, at some times; needed: they are one whole branch.

    With all tasks at one instant and without timings, order in time holds for every task whose predecessors are done.
    """
    return done_as_permitted(untimed(nodes), dict.fromkeys(done, (0, 0)), needed)


def kept_operands(nodes: Sequence[Node], parts: Sequence[Part]) -> dict[int, int] | None:
    """For each `+` on the kept branch, by its index, the operand that is kept: the first that fits and was done as it
    permits. None if the term was not.
    """
    if not parts[-1].allowed:
        return None
    inside, kept = operands_of(nodes), dict[int, int]()
    todo = [len(nodes) - 1]
    while todo:
        place = todo.pop()
        operands = inside[place]
        if nodes[place].op == ALTERNATIVE:
            good = (n for n, k in enumerate(operands) if parts[k].fits and parts[k].allowed)
            kept[place] = next(good)
            operands = (operands[kept[place]],)
        todo += operands
    return kept
