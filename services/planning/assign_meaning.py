"""A problem's constraints as formulas over the times of its tasks, named in the user's terms.

Written from the meaning of the operators on composites, deliberately without the constraint rows that
searches and checkers use: schedules and conflicts are judged by these, on the values of a schedule or by z3
(`assign_logic`). Variables: `s<task>` start, `e<task>` end [ms], `o<task>` position in the order of
assignment, `c<k>_<v>` choice k is flown by vehicle v, `f<j>_<k>_<v>` vehicle v flies choice k directly after
choice j, `laps<k>_<v>` number of its laps before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from cratous.services.planning.assign_logic import Logic
from cratous.services.planning.assign_problem import Part, parts
from cratous.spec import algebra
from cratous.spec.algebra.meaning import bounds_all, quote, tasks
from cratous.spec.assignment.search import TIME, AssignmentProblem


@dataclass(frozen=True)
class Named:
    """A constraint of the user: its words, and its formulas as (branch number, formula)."""

    text: str
    formulas: tuple[tuple[int, Any], ...]


def start(logic: Logic, task: int) -> Any:
    """The start of a task [ms]."""
    return logic.number(f"s{task}")


def end(logic: Logic, task: int) -> Any:
    """The end of a task [ms]."""
    return logic.number(f"e{task}")


def place(logic: Logic, task: int) -> Any:
    """The position of a task in the order of assignment."""
    return logic.number(f"o{task}")


Said = list[tuple[str, Any, int]]
"""(words, formula, task concerned)."""


def meaning(
    logic: Logic, term: algebra.Term, semantics: str = TIME, done: Iterable[int] = ()
) -> list[tuple[str, Any]]:
    """The constraints of a term without `+`, as pairs (words, formula); each timing constrains its own tasks
    only.

    done: tasks already flown, whose constraints are omitted.
    """
    found: Said = []
    _say(logic, term, semantics == TIME, found)
    gone = frozenset(done)
    return [(text, formula) for text, formula, task in found if task not in gone]


def past(logic: Logic, problem: AssignmentProblem) -> list[Any]:
    """The times and positions of the tasks already flown."""
    said: list[Any] = []
    for number, (task, begun, ended) in enumerate(problem.done):
        said += [start(logic, task) == begun, end(logic, task) == ended]
        said.append(place(logic, task) == number - len(problem.done))
    return said


def _say(logic: Logic, term: algebra.Term, timed: bool, found: Said) -> tuple[int, ...]:
    """Append the constraints of a term; returns its tasks without a timing inside it."""
    if isinstance(term, algebra.Atom):
        free: tuple[int, ...] = (term.task,)
    else:
        inner = [_say(logic, operand, timed, found) for operand in term.operands]
        free = tuple(task for part in inner for task in part)
        ordered = term.op in (algebra.SEQUENTIAL, algebra.TILDE)
        if ordered:
            for before, after in pairwise(term.operands):
                _in_order(logic, term, before, after, timed, found)
        if ordered and term.suffix is not None and not bounds_all(term):
            t1, t2 = term.suffix.t1_ms, term.suffix.t2_ms
            for k, (before, _) in enumerate(pairwise(term.operands)):
                group = tasks(before)
                for task in inner[k + 1]:
                    after_it, within = _since(logic, term.op, group, task)
                    early = f"{quote(term)}: p{task} starts {t1} ms after it may"
                    found.append((early, after_it(t1), task))
                    late = f"{quote(term)}: p{task} ends within {t2} ms"
                    found.append((late, within(t2), task))
            return inner[0]
    if term.suffix is None:
        return free
    for task in free:
        t1, t2 = term.suffix.t1_ms, term.suffix.t2_ms
        early = f"{quote(term)}: p{task} starts at {t1} ms or later"
        found.append((early, start(logic, task) >= t1, task))
        late = f"{quote(term)}: p{task} ends at {t2} ms or earlier"
        found.append((late, end(logic, task) <= t2, task))
    return ()


def _in_order(
    logic: Logic, term: algebra.Op, before: algebra.Term, after: algebra.Term, timed: bool,
    found: Said,
) -> None:  # fmt: skip
    group, all_of = tasks(before), term.op == algebra.SEQUENTIAL
    join = logic.each if all_of else logic.some
    for task in tasks(after):
        if timed:
            said = join(
                [
                    start(logic, task) >= (end(logic, a) if all_of else start(logic, a))
                    for a in group
                ]
            )
        else:
            said = join([place(logic, task) > place(logic, a) for a in group])
        event = "ends" if all_of else "begins"
        found.append((f"{quote(term)}: p{task} not before {quote(before)} {event}", said, task))


def _since(
    logic: Logic, op: str, group: Iterable[int], task: int
) -> tuple[Callable[[int], Any], Callable[[int], Any]]:
    """Formulas for a start at least, and an end at most, t after the latest end or the earliest start."""
    if op == algebra.SEQUENTIAL:
        return (
            lambda t: logic.each([start(logic, task) >= end(logic, a) + t for a in group]),
            lambda t: logic.some([end(logic, task) <= end(logic, a) + t for a in group]),
        )
    return (
        lambda t: logic.some([start(logic, task) >= start(logic, a) + t for a in group]),
        lambda t: logic.each([end(logic, task) <= start(logic, a) + t for a in group]),
    )


def constraints(logic: Logic, problem: AssignmentProblem) -> tuple[list[Named], list[Part]]:
    """All constraints that a user can change, by their words, and the branches."""
    branches = list(parts(problem)[0])
    said: dict[str, list[tuple[int, Any]]] = {}
    for k, branch in enumerate(branches):
        for text, formula in meaning(logic, branch.term, problem.semantics, _gone(problem)):
            said.setdefault(text, []).append((k, formula))
        for text, formula in windows(logic, problem, branch):
            said.setdefault(text, []).append((k, formula))
    return [Named(text, tuple(formulas)) for text, formulas in said.items()], branches


def windows(logic: Logic, problem: AssignmentProblem, branch: Part) -> Iterator[tuple[str, Any]]:
    """The release and due times of a branch's tasks, as (words, formula)."""
    for task, at in problem.release_ms:
        if task in branch.tasks:
            yield f"task {task} is released at {at} ms", start(logic, task) >= at
    for task, at in problem.due_ms:
        if task in branch.tasks:
            yield f"task {task} is due by {at} ms", end(logic, task) <= at


def _gone(problem: AssignmentProblem) -> list[int]:
    return [task for task, _, _ in problem.done]


def choice(logic: Logic, k: int, v: int) -> Any:
    """Choice number k is flown by vehicle number v."""
    return logic.truth(chosen(k, v))


def chosen(k: int, v: int) -> str:
    """Name of the variable: choice number k is flown by vehicle number v."""
    return f"c{k}_{v}"


def flown_after(j: int, k: int, v: int) -> str:
    """Name of the variable: vehicle number v flies choice k directly after choice j; j past the last: first."""
    return f"f{j}_{k}_{v}"


def flights(logic: Logic, problem: AssignmentProblem, branch: Part) -> list[Any]:
    """The feasible flights of a branch: every task once, in chains, with travel and waiting."""
    p, said = problem, past(logic, problem)
    last = len(p.choices)
    able = [
        (k, v) for k in branch.choices for v, u in enumerate(p.vehicles) if u in p.choices[k].vehicles
    ]  # fmt: skip
    follows: dict[tuple[int, int, int], Any] = {}
    for k, v in able:
        for j in (last, *branch.choices):
            same = j != last and p.choices[j].task_id == p.choices[k].task_id
            if not same and (j == last or (j, v) in able) and p.travel_ms[v][j][k] is not None:
                follows[j, k, v] = logic.truth(flown_after(j, k, v))
    for task in branch.tasks:
        mine = [choice(logic, k, v) for k, v in able if p.choices[k].task_id == task]
        said.append(logic.one(mine))
        said += [
            start(logic, task) >= 0,
            place(logic, task) >= 0,
            place(logic, task) < len(branch.tasks),
        ]
    said.append(logic.differ([place(logic, task) for task in branch.tasks]))
    for k, v in able:
        task, duration = p.choices[k].task_id, p.choices[k].duration_ms
        into = [f for (_, b, u), f in follows.items() if (b, u) == (k, v)]
        out = [f for (a, _, u), f in follows.items() if (a, u) == (k, v)]
        said.append(
            logic.follows(choice(logic, k, v), end(logic, task) == start(logic, task) + duration)
        )
        said.append(choice(logic, k, v) == logic.some(into))
        said += [logic.few(into)] if len(into) > 1 else []
        said += [logic.few(out)] if len(out) > 1 else []
    for (j, k, v), flown in follows.items():
        task = p.choices[k].task_id
        way = p.travel_ms[v][j][k]
        assert way is not None
        free = p.ready_ms[v] if j == last else end(logic, p.choices[j].task_id)
        wait = start(logic, task) - free - way
        said.append(logic.follows(flown, _can_wait(logic, p, k, v, wait)))
        if j != last:
            said.append(logic.follows(flown, choice(logic, j, v)))
            said.append(
                logic.follows(flown, place(logic, task) > place(logic, p.choices[j].task_id))
            )
    for v in range(len(p.vehicles)):
        first = [f for (a, _, u), f in follows.items() if a == last and u == v]
        said += [logic.few(first)] if len(first) > 1 else []
    return said


def _can_wait(logic: Logic, p: AssignmentProblem, k: int, v: int, wait: Any) -> Any:
    most, lap = p.choices[k].lap_max_ms, p.choices[k].lap_ms
    if most is None:
        return wait >= 0
    if most <= 0:
        return wait == 0
    laps = logic.laps(f"laps{k}_{v}", wait, lap)
    looping = logic.each([laps >= 1, wait >= laps * lap, wait <= laps * most, wait > 0])
    return logic.some([wait == 0, looping])


def costs_less(logic: Logic, problem: AssignmentProblem, branch: Part, limit: int) -> list[Any]:
    """The cost of a branch's schedule is below the limit; for costs of end times only."""
    p = problem
    latest, said = logic.number("latest"), []
    lasts = [logic.number(f"last{v}") for v in range(len(p.vehicles))]
    for v in range(len(p.vehicles)):
        said.append(lasts[v] >= 0)
        for k in branch.choices:
            if p.vehicles[v] in p.choices[k].vehicles:
                said.append(
                    logic.follows(choice(logic, k, v), lasts[v] >= end(logic, p.choices[k].task_id))
                )
        said.append(latest >= lasts[v])
    said.append(p.cost.makespan * latest + p.cost.team * sum(lasts) < limit)
    return said
