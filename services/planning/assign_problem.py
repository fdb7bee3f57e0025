"""Validation of an assignment problem, its branches, and their arrays.

Every error is named (BadInput with the item); nothing is repaired. A branch (one choice of every `+`) is
*plain* if its rows bound starts from below and single ends from above, and waits are free; then its arrays
(`core.assignment.instance`) express it exactly. For any other they are a relaxation: their bound is a lower
bound of the branch.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from cratous.core.assignment.instance import (
    FAR,
    TASKS_MAX,
    TIME_MAX_MS,
    Fleet,
    Instance,
    instance,
    is_plain,
)
from cratous.core.assignment.layers import look_ahead
from cratous.core.assignment.settlement import Settler
from cratous.core.schedule.rows import runs_forward
from cratous.spec import algebra, constraint_rows
from cratous.spec.algebra import meaning as algebra_meaning
from cratous.spec.assignment.search import ORDER, TIME, AssignmentProblem, Rows
from cratous.spec.errors import BadInput

WHOLE_END = 1 << 40
"""Numbers of a problem are below this."""
BRANCHES_MAX = 4096
"""Most resolutions of the alternatives examined, the first ones."""


@dataclass(frozen=True)
class Part:
    """One branch.

    term: without `+`; tasks: those still to do; rows: their constraints; orders: number of leading rows that
    are order only; choices: indices of the problem's choices for its tasks; done: (task, start, end) of flown
    tasks.
    """

    term: algebra.Term
    tasks: tuple[int, ...]
    rows: tuple[constraint_rows.Row, ...]
    orders: int
    choices: tuple[int, ...]
    plain: bool
    done: tuple[tuple[int, int, int], ...] = ()


def check(problem: AssignmentProblem) -> None:
    """Raise BadInput for an invalid problem: sizes, ids, numbers, eligibility."""
    p = problem
    _refuse(not p.vehicles, "there is no vehicle", "vehicles", "at least one", "none")
    _refuse(not p.choices, "there is no task to do", "choices", "at least one", "none")
    _refuse(len(p.vehicles) > 62, "too many vehicles", "vehicles", "at most 62", len(p.vehicles))
    _twice(p.vehicles, "vehicles")
    _twice([(c.task_id, c.option_id) for c in p.choices], "choices")
    _refuse(
        p.semantics not in (TIME, ORDER), "no such semantics", "semantics", "time or order",
        repr(p.semantics),
    )  # fmt: skip
    _refuse(
        len(p.ready_ms) != len(p.vehicles), "one ready time for each vehicle", "ready_ms",
        str(len(p.vehicles)), len(p.ready_ms),
    )  # fmt: skip
    for v, ready in enumerate(p.ready_ms):
        _whole(ready, f"ready_ms[{v}]")
    for k, choice in enumerate(p.choices):
        item = f"choices[{k}]"
        _whole(choice.duration_ms, f"{item}.duration_ms")
        _whole(choice.lap_ms, f"{item}.lap_ms")
        for v_id in choice.vehicles:
            _refuse(
                v_id not in p.vehicles, "no such vehicle", f"{item}.vehicles", str(p.vehicles), v_id
            )
    _done(p)
    for name, value in vars(p.cost).items():
        _whole(value, f"cost.{name}")
    for name in ("release_ms", "due_ms"):
        for task, value in getattr(p, name):
            _refuse(task not in p.tasks, "no such task", name, "a task of the problem", task)
            _whole(value, f"{name}, task {task}")
    _table(p, p.travel_ms, "travel_ms")
    for name in ("distance_mm", "energy_mj"):
        if getattr(p, name):
            _table(p, getattr(p, name), name)
    _refuse(
        bool(p.cost.distance and not p.distance_mm), "distance counts but is not given",
        "distance_mm", "a table like travel_ms", "none",
    )  # fmt: skip
    _refuse(
        bool(p.cost.energy and not p.energy_mj), "energy counts but is not given", "energy_mj",
        "a table like travel_ms", "none",
    )  # fmt: skip
    _timeless(p)
    _range(p)


def _done(p: AssignmentProblem) -> None:
    """Reject flown tasks that are still to do, end before they begin, or begin after vehicles depart."""
    _twice([task for task, _, _ in p.done], "done")
    for task, start, end in p.done:
        _refuse(task in p.tasks, "a task is flown and to be flown", "done", "one of both", task)
        _whole(start, f"done, task {task}")
        _whole(end, f"done, task {task}")
        wrong = not runs_forward(start, end)
        _refuse(wrong, "a task ends before it begins", "done", f"{start} or later", end)
        _refuse(
            not runs_forward(start, min(p.ready_ms)), "a flown task begins after a vehicle sets off", "done",
            f"task {task} by {min(p.ready_ms)}", start,
        )  # fmt: skip


def _timeless(p: AssignmentProblem) -> None:
    """Reject two tasks at the same instant for one vehicle, whose order would be undetermined."""
    for v, table in enumerate(p.travel_ms):
        for a, choice in enumerate(p.choices):
            if choice.duration_ms > 0 or p.vehicles[v] not in choice.vehicles:
                continue
            for k, way in enumerate(table[a]):
                other = p.choices[k].task_id != choice.task_id
                _refuse(
                    other and way == 0, "a task without duration has a way without length after it",
                    f"travel_ms[{v}][{a}][{k}]",
                    "a duration or a way above 0 (the search goes by starts, and would not see every "
                    "order of tasks at one instant)", "both 0",
                )  # fmt: skip


def _range(p: AssignmentProblem) -> None:
    ways = sum(
        max((max(filter(None, row), default=0) for row in rows), default=0) for rows in p.travel_ms
    )
    horizon = max(p.ready_ms) + sum(c.duration_ms for c in p.choices) + len(p.tasks) * ways
    horizon += sum(value for _, value in p.release_ms)
    _refuse(
        horizon >= TIME_MAX_MS,
        "times are too long",
        "travel_ms",
        f"less than {TIME_MAX_MS} ms in all",
        horizon,
    )


def term_of(problem: AssignmentProblem) -> algebra.Term:
    """The relations as a term; AlgebraError for invalid text, BadInput if a task is missing."""
    known = (*(task for task, _, _ in problem.done), *problem.tasks)
    if not problem.relations.strip():
        return algebra.parallel_of((*known, *sorted(problem.unable)))
    named = problem.unable | frozenset(known)
    term = algebra.parse(problem.relations, named, where=problem.name)
    lost = sorted(named - set(algebra_meaning.tasks(term)))
    _refuse(
        bool(lost), "tasks are left out of the relations", "relations", "every task in the text",
        " ".join(f"p{task}" for task in lost) + " missing",
    )  # fmt: skip
    return term


@functools.lru_cache(maxsize=8)
def parts(problem: AssignmentProblem) -> tuple[tuple[Part, ...], bool]:
    """The branches that some vehicles can do, and whether these are all of them.

    BadInput if every branch contains a task that no vehicle can do; empty if no branch contains the flown
    tasks.
    """
    term, made = term_of(problem), []
    able = {c.task_id for c in problem.choices if c.vehicles}
    flown = {task for task, _, _ in problem.done}
    free = all(c.lap_ms == 0 and c.lap_max_ms is None for c in problem.choices)
    unable: set[int] | None = None
    for resolved in islice(algebra_meaning.branches(term), BRANCHES_MAX):
        inside = algebra_meaning.tasks(resolved)
        if not flown <= set(inside):
            continue
        tasks = tuple(task for task in inside if task not in flown)
        cannot = set(tasks) - able
        unable = cannot if unable is None else unable & cannot
        if cannot:
            continue
        rows, orders = _rows(problem, resolved, flown)
        choices = tuple(k for k, c in enumerate(problem.choices) if c.task_id in tasks)
        plain = free and is_plain(rows)
        made.append(Part(resolved, tasks, rows, orders, choices, plain, problem.done))
    cut = not_all_of(term)
    for task in sorted(unable or ()):
        _refuse(
            not (made or cut),
            f"no vehicle is eligible for task {task}",
            "choices",
            "one or more",
            "none",
        )
    return tuple(made), not cut


def not_all_of(term: algebra.Term) -> str:
    """A note that not all branches of a term were searched; "" if all were."""
    count = algebra_meaning.count_branches(term)
    if count <= BRANCHES_MAX:
        return ""
    return f"of {count} ways to choose among alternatives the first {BRANCHES_MAX} were looked at"


def _rows(
    problem: AssignmentProblem, term: algebra.Term, flown: set[int]
) -> tuple[tuple[constraint_rows.Row, ...], int]:
    """The rows about tasks still to do, order rows first, and the number of those."""
    times = {task: (start, end) for task, start, end in problem.done}
    order = algebra_meaning.rows(untimed(term))
    timing = algebra_meaning.rows(term)[len(order) :]
    binds = problem.semantics == TIME
    first = [r for row in order if row.i not in flown for r in _without(row, times, binds)]
    rest = [r for row in timing if row.i not in flown for r in _without(row, times, True)]
    tasks = [task for task in algebra_meaning.tasks(term) if task not in flown]
    return (*first, *rest, *_windows(problem, tasks)), len(first)


def untimed(term: algebra.Term) -> algebra.Term:
    """The term without its timings."""
    if isinstance(term, algebra.Atom):
        return replace(term, suffix=None)
    return replace(term, suffix=None, operands=tuple(untimed(part) for part in term.operands))


def _without(
    row: constraint_rows.Row, times: Mapping[int, tuple[int, int]], binds: bool
) -> tuple[constraint_rows.Row, ...]:
    """A row once some tasks of its group are flown; no remaining task starts before those did.

    binds: an order row binds times too; otherwise flown tasks satisfy it.
    """
    gone = [times[task] for task in row.group if task in times]
    left = tuple(task for task in row.group if task not in times)
    if not gone:
        return (row,)
    if row.kind == constraint_rows.AFTER_END:
        known = row._replace(
            kind=constraint_rows.NOT_BEFORE, group=(), lo=max(e for _, e in gone) + row.lo
        )
        return (*((known,) if binds else ()), *((row._replace(group=left),) if left else ()))
    if row.kind == constraint_rows.AFTER_START:
        known = row._replace(
            kind=constraint_rows.NOT_BEFORE, group=(), lo=min(s for s, _ in gone) + row.lo
        )
        return (known,) if binds else ()
    if row.kind == constraint_rows.WITHIN_START:
        return (
            row._replace(
                kind=constraint_rows.NOT_AFTER, group=(), hi=min(s for s, _ in gone) + row.hi
            ),
        )
    if row.kind == constraint_rows.WITHIN_END and not left:
        return (
            row._replace(
                kind=constraint_rows.NOT_AFTER, group=(), hi=max(e for _, e in gone) + row.hi
            ),
        )
    return (row,)


def _windows(problem: AssignmentProblem, tasks: Sequence[int]) -> tuple[constraint_rows.Row, ...]:
    found = [
        constraint_rows.Row(constraint_rows.NOT_BEFORE, t, (), at, 0, f"task {t} is released at {at} ms")
        for t, at in problem.release_ms if t in tasks
    ]  # fmt: skip
    found += [
        constraint_rows.Row(constraint_rows.NOT_AFTER, t, (), 0, at, f"task {t} is due by {at} ms")
        for t, at in problem.due_ms if t in tasks
    ]  # fmt: skip
    return tuple(found)


def binding(problem: AssignmentProblem, part: Part) -> tuple[constraint_rows.Row, ...]:
    """The rows that bind times: with semantics `order`, pure order rows do not."""
    return part.rows[part.orders :] if problem.semantics == ORDER else part.rows


def arrays(problem: AssignmentProblem, part: Part) -> Instance:
    """The arrays of a branch: exact if `is_exact`, else a relaxation."""
    p, picked = problem, part.choices
    index = [*picked, len(p.choices)]
    shape = (len(p.vehicles), len(index), len(picked))
    travel, added = np.full(shape, FAR, np.int64), np.zeros(shape, np.int64)
    weighed = [
        (rows, per)
        for rows, per in ((p.distance_mm, p.cost.distance), (p.energy_mj, p.cost.energy))
        if per and rows
    ]
    for v in range(len(p.vehicles)):
        for a, row in enumerate(index):
            ways = p.travel_ms[v][row]
            travel[v, a] = [FAR if (way := ways[k]) is None else way for k in picked]
            for rows, per in weighed:
                costs = rows[v][row]
                added[v, a] += [0 if ways[k] is None else per * (costs[k] or 0) for k in picked]
    may = [[int(v in p.choices[k].vehicles) for k in picked] for v in p.vehicles]
    options = [(p.choices[k].task_id, p.choices[k].duration_ms) for k in picked]
    weight = (p.cost.makespan, p.cost.team)
    plain = [
        row
        for k, row in enumerate(part.rows)
        if is_plain((row,))
        and (
            k < part.orders
            or p.semantics == TIME
            or row.kind in (constraint_rows.NOT_BEFORE, constraint_rows.NOT_AFTER)
        )
    ]
    fleet = Fleet(p.ready_ms, may, travel, added)
    return instance(part.tasks, plain, options, fleet, weight, p.semantics == TIME)


def is_exact(problem: AssignmentProblem, part: Part) -> bool:
    """Whether the arrays express the branch exactly."""
    lagged = any(
        row.kind in (constraint_rows.AFTER_END, constraint_rows.AFTER_START)
        for row in part.rows[part.orders :]
    )
    return part.plain and not (problem.semantics == ORDER and lagged)


def settler(problem: AssignmentProblem, part: Part, made: Instance) -> Settler:
    """The settler that computes times in a branch whose arrays are not exact."""
    laps = tuple((problem.choices[k].lap_ms, problem.choices[k].lap_max_ms) for k in part.choices)
    ahead = look_ahead(made) if len(part.tasks) <= TASKS_MAX else None
    return Settler(made, ahead, part.tasks, binding(problem, part), laps, part.done)


def _table(p: AssignmentProblem, rows: Sequence[Rows], name: str) -> None:
    size = len(p.choices)
    _refuse(
        len(rows) != len(p.vehicles),
        "one table for each vehicle",
        name,
        str(len(p.vehicles)),
        len(rows),
    )
    for v, table in enumerate(rows):
        _refuse(
            len(table) != size + 1, "a row of the table is missing", f"{name}[{v}]",
            f"{size + 1} rows, the last from the start", len(table),
        )  # fmt: skip
        for a, row in enumerate(table):
            _refuse(
                len(row) != size,
                "a row has a wrong length",
                f"{name}[{v}][{a}]",
                str(size),
                len(row),
            )
            for k, value in enumerate(row):
                if value is None or (type(value) is int and 0 <= value < WHOLE_END):
                    continue  # a large table has a million values
                _whole(value, f"{name}[{v}][{a}][{k}]")


def _whole(value: object, item: str) -> None:
    """Refuse a value that is not a whole number from 0 to WHOLE_END."""
    if type(value) is int and 0 <= value < WHOLE_END:
        return
    good = isinstance(value, int) and not isinstance(value, bool)
    _refuse(not good, "not an integer", item, "an integer, 0 or more", repr(value))
    assert isinstance(value, int)
    _refuse(value < 0, "below zero", item, "0 or more", value)
    _refuse(value >= WHOLE_END, "too large", item, f"less than {WHOLE_END}", value)


def _twice(values: Sequence[object], item: str) -> None:
    seen: set[object] = set()
    for value in values:
        _refuse(value in seen, "given twice", item, "each once", value)
        seen.add(value)


def _refuse(wrong: bool, what: str, item: str, expected: str, got: object) -> None:
    if wrong:
        raise BadInput(what, item=item, expected=expected, got=str(got))
