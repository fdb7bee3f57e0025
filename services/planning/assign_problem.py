"""Reading an assignment problem: is it sound, what are its branches, what are they as arrays.

Every mistake is named (BadInput with the item); nothing is repaired. A branch (one choice of every
`+`) is *plain* if its rows bound starts from below and single ends from above and waits are free;
only those go to the compiled search (`core.assignment_instance`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice

import numpy as np

from cratous.core.assignment_instance import (
    FAR,
    TASKS_MAX,
    TIME_MAX_MS,
    Instance,
    instance,
    is_plain,
)
from cratous.spec import algebra, algebra_meaning
from cratous.spec.assignment import ORDER, TIME, AssignmentProblem, Rows
from cratous.spec.errors import BadInput
from cratous.spec.plan import AFTER_END, AFTER_START, NOT_AFTER, NOT_BEFORE, Row

BRANCHES_MAX = 4096


@dataclass(frozen=True)
class Part:
    """One branch. term: without `+`; choices: indices of the problem's choices of its tasks."""

    term: algebra.Term
    tasks: tuple[int, ...]
    rows: tuple[Row, ...]
    choices: tuple[int, ...]
    plain: bool


def check(problem: AssignmentProblem) -> None:
    """Raise BadInput for a problem that means nothing: sizes, ids, numbers, eligibility."""
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
    for task in p.tasks:
        able = [c for c in p.choices if c.task_id == task and c.vehicles]
        _refuse(
            not able, f"no vehicle is eligible for task {task}", "choices", "one or more", "none"
        )
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


def _timeless(p: AssignmentProblem) -> None:
    """Refuse what lets a vehicle do two tasks at one instant: which comes first would be open."""
    for v, table in enumerate(p.travel_ms):
        for a, choice in enumerate(p.choices):
            if choice.duration_ms > 0 or p.vehicles[v] not in choice.vehicles:
                continue
            for k, way in enumerate(table[a]):
                other = p.choices[k].task_id != choice.task_id
                _refuse(
                    other and way == 0, "a task without duration has a way without length after it",
                    f"travel_ms[{v}][{a}][{k}]", "a duration or a way above 0", "both 0",
                )  # fmt: skip


def _range(p: AssignmentProblem) -> None:
    ways = sum(max((w or 0 for row in rows for w in row), default=0) for rows in p.travel_ms)
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
    """The relations as a term; AlgebraError for a text that is none, BadInput if a task is lost."""
    if not problem.relations.strip():
        return algebra.parallel_of(problem.tasks)
    term = algebra.parse(problem.relations, frozenset(problem.tasks), where=problem.name)
    lost = sorted(set(problem.tasks) - set(algebra_meaning.tasks(term)))
    _refuse(
        bool(lost), "tasks are left out of the relations", "relations", "every task in the text",
        " ".join(f"p{task}" for task in lost) + " missing",
    )  # fmt: skip
    return term


def parts(problem: AssignmentProblem) -> tuple[tuple[Part, ...], bool]:
    """The branches, and whether these are all of them."""
    term = term_of(problem)
    made = []
    free = all(c.lap_ms == 0 and c.lap_max_ms is None for c in problem.choices)
    for resolved in islice(algebra_meaning.branches(term), BRANCHES_MAX):
        tasks = algebra_meaning.tasks(resolved)
        rows = (*algebra_meaning.rows(resolved), *_windows(problem, tasks))
        choices = tuple(k for k, c in enumerate(problem.choices) if c.task_id in tasks)
        made.append(Part(resolved, tasks, rows, choices, free and is_plain(rows)))
    return tuple(made), algebra_meaning.count_branches(term) <= BRANCHES_MAX


def _windows(problem: AssignmentProblem, tasks: Sequence[int]) -> tuple[Row, ...]:
    found = [
        Row(NOT_BEFORE, t, (), at, 0, f"task {t} is released at {at} ms")
        for t, at in problem.release_ms if t in tasks
    ]  # fmt: skip
    found += [
        Row(NOT_AFTER, t, (), 0, at, f"task {t} is due by {at} ms")
        for t, at in problem.due_ms if t in tasks
    ]  # fmt: skip
    return tuple(found)


def has_lags(part: Part) -> bool:
    """Whether a row asks for a time between tasks, beyond their order."""
    return any(row.kind in (AFTER_END, AFTER_START) and row.lo > 0 for row in part.rows)


def arrays(problem: AssignmentProblem, part: Part) -> Instance:
    """The arrays of a plain branch. In semantics `order` with lags between tasks they keep both."""
    p, picked = problem, part.choices
    index = [*picked, len(p.choices)]
    shape = (len(p.vehicles), len(index), len(picked))
    travel, added = np.full(shape, FAR, np.int64), np.zeros(shape, np.int64)
    for v in range(len(p.vehicles)):
        for a, row in enumerate(index):
            for b, k in enumerate(picked):
                way = p.travel_ms[v][row][k]
                if way is None:
                    continue
                travel[v, a, b] = way
                for rows, per in (
                    (p.distance_mm, p.cost.distance),
                    (p.energy_mj, p.cost.energy),
                ):
                    if per and rows:
                        added[v, a, b] += per * (rows[v][row][k] or 0)
    may = [[int(v in p.choices[k].vehicles) for k in picked] for v in p.vehicles]
    options = [(p.choices[k].task_id, p.choices[k].duration_ms) for k in picked]
    weight = (p.cost.makespan, p.cost.team)
    return instance(
        part.tasks, part.rows, options, may, travel, added, p.ready_ms, weight, p.semantics == TIME
    )


def is_compiled(problem: AssignmentProblem, part: Part) -> bool:
    """Whether the compiled exact search covers the branch."""
    lagged = problem.semantics == ORDER and has_lags(part)
    return part.plain and not lagged and len(part.tasks) <= TASKS_MAX


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
                if value is not None:
                    _whole(value, f"{name}[{v}][{a}][{k}]")


def _whole(value: object, item: str) -> None:
    good = isinstance(value, int) and not isinstance(value, bool)
    _refuse(not good, "not an integer", item, "an integer, 0 or more", repr(value))
    assert isinstance(value, int)
    _refuse(value < 0, "below zero", item, "0 or more", value)
    _refuse(value >= 1 << 40, "too large", item, f"less than {1 << 40}", value)


def _twice(values: Sequence[object], item: str) -> None:
    seen: set[object] = set()
    for value in values:
        _refuse(value in seen, "given twice", item, "each once", value)
        seen.add(value)


def _refuse(wrong: bool, what: str, item: str, expected: str, got: object) -> None:
    if wrong:
        raise BadInput(what, item=item, expected=expected, got=str(got))
