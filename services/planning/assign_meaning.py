"""A problem's constraints as formulas over the times of its tasks, named in the user's terms.

Written from the meaning of the operators on composites, on purpose without the constraint rows
that the searches and checkers use: z3 judges schedules and clashes by these. Variables: `s<task>`
start, `e<task>` end [ms], `o<task>` place in the order of assignment, `c<k>_<v>` choice k is
flown by vehicle v, `f<k>_<j>_<v>` vehicle v flies choice j directly after choice k.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import z3

from cratous.services.planning.assign_problem import Part, parts
from cratous.spec import algebra
from cratous.spec.algebra.meaning import bounds_all, quote, tasks
from cratous.spec.assignment.search import TIME, AssignmentProblem


@dataclass(frozen=True)
class Named:
    """A constraint of the user's: its words, and what it says in each branch (by number)."""

    text: str
    formulas: tuple[tuple[int, Any], ...]


def start(task: int) -> Any:
    """The start of a task [ms]."""
    return z3.Int(f"s{task}")


def end(task: int) -> Any:
    """The end of a task [ms]."""
    return z3.Int(f"e{task}")


def place(task: int) -> Any:
    """The place of a task in the order of assignment."""
    return z3.Int(f"o{task}")


Said = list[tuple[str, Any, int]]
"""(words, formula, the task that it is about)."""


def meaning(
    term: algebra.Term, semantics: str = TIME, done: Iterable[int] = ()
) -> list[tuple[str, Any]]:
    """What a term without `+` says, as (words, formula), each timing for its tasks alone.

    done: tasks that are flown; what was said of them is past.
    """
    found: Said = []
    _say(term, semantics == TIME, found)
    gone = frozenset(done)
    return [(text, formula) for text, formula, task in found if task not in gone]


def past(problem: AssignmentProblem) -> list[Any]:
    """The times and places of the tasks that are flown."""
    said: list[Any] = []
    for number, (task, begun, ended) in enumerate(problem.done):
        said += [start(task) == begun, end(task) == ended]
        said.append(place(task) == number - len(problem.done))
    return said


def _say(term: algebra.Term, timed: bool, found: Said) -> tuple[int, ...]:
    """Add what a term says; the tasks that no timing inside it bounds."""
    if isinstance(term, algebra.Atom):
        free: tuple[int, ...] = (term.task,)
    else:
        inner = [_say(operand, timed, found) for operand in term.operands]
        free = tuple(task for part in inner for task in part)
        ordered = term.op in (algebra.SEQUENTIAL, algebra.TILDE)
        if ordered:
            for before, after in pairwise(term.operands):
                _in_order(term, before, after, timed, found)
        if ordered and term.suffix is not None and not bounds_all(term):
            t1, t2 = term.suffix.t1_ms, term.suffix.t2_ms
            for k, (before, _) in enumerate(pairwise(term.operands)):
                group = tasks(before)
                for task in inner[k + 1]:
                    after_it, within = _since(term.op, group, task)
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
        found.append((early, start(task) >= t1, task))
        late = f"{quote(term)}: p{task} ends at {t2} ms or earlier"
        found.append((late, end(task) <= t2, task))
    return ()


def _in_order(
    term: algebra.Op, before: algebra.Term, after: algebra.Term, timed: bool,
    found: Said,
) -> None:  # fmt: skip
    group, all_of = tasks(before), term.op == algebra.SEQUENTIAL
    join = z3.And if all_of else z3.Or
    for task in tasks(after):
        if timed:
            said = join([start(task) >= (end(a) if all_of else start(a)) for a in group])
        else:
            said = join([place(task) > place(a) for a in group])
        event = "ends" if all_of else "begins"
        found.append((f"{quote(term)}: p{task} not before {quote(before)} {event}", said, task))


def _since(
    op: str, group: Iterable[int], task: int
) -> tuple[Callable[[int], Any], Callable[[int], Any]]:
    """Starts at least, and ends at most, so long after the latest end or the earliest start."""
    if op == algebra.SEQUENTIAL:
        return (
            lambda t: z3.And([start(task) >= end(a) + t for a in group]),
            lambda t: z3.Or([end(task) <= end(a) + t for a in group]),
        )
    return (
        lambda t: z3.Or([start(task) >= start(a) + t for a in group]),
        lambda t: z3.And([end(task) <= start(a) + t for a in group]),
    )


def constraints(problem: AssignmentProblem) -> tuple[list[Named], list[Part]]:
    """All constraints that a user can change, by their words, and the branches."""
    branches = list(parts(problem)[0])
    said: dict[str, list[tuple[int, Any]]] = {}
    for k, branch in enumerate(branches):
        for text, formula in meaning(branch.term, problem.semantics, _gone(problem)):
            said.setdefault(text, []).append((k, formula))
        for task, at in problem.release_ms:
            if task in branch.tasks:
                said.setdefault(f"task {task} is released at {at} ms", []).append(
                    (k, start(task) >= at)
                )
        for task, at in problem.due_ms:
            if task in branch.tasks:
                said.setdefault(f"task {task} is due by {at} ms", []).append((k, end(task) <= at))
    return [Named(text, tuple(formulas)) for text, formulas in said.items()], branches


def _gone(problem: AssignmentProblem) -> list[int]:
    return [task for task, _, _ in problem.done]


def choice(k: int, v: int) -> Any:
    """Choice number k is flown by vehicle number v."""
    return z3.Bool(f"c{k}_{v}")


def flights(problem: AssignmentProblem, branch: Part) -> list[Any]:
    """What vehicles can fly in a branch: every task once, in chains, with travel and waiting."""
    p, said = problem, past(problem)
    last = len(p.choices)
    able = [
        (k, v) for k in branch.choices for v, u in enumerate(p.vehicles) if u in p.choices[k].vehicles
    ]  # fmt: skip
    follows: dict[tuple[int, int, int], Any] = {}
    for k, v in able:
        for j in (last, *branch.choices):
            same = j != last and p.choices[j].task_id == p.choices[k].task_id
            if not same and (j == last or (j, v) in able) and p.travel_ms[v][j][k] is not None:
                follows[j, k, v] = z3.Bool(f"f{j}_{k}_{v}")
    for task in branch.tasks:
        mine = [choice(k, v) for k, v in able if p.choices[k].task_id == task]
        said.append(z3.PbEq([(c, 1) for c in mine], 1) if mine else z3.BoolVal(False))
        said += [start(task) >= 0, place(task) >= 0, place(task) < len(branch.tasks)]
    said.append(z3.Distinct([place(task) for task in branch.tasks]))
    for k, v in able:
        task, duration = p.choices[k].task_id, p.choices[k].duration_ms
        into = [f for (_, b, u), f in follows.items() if (b, u) == (k, v)]
        out = [f for (a, _, u), f in follows.items() if (a, u) == (k, v)]
        said.append(z3.Implies(choice(k, v), end(task) == start(task) + duration))
        said.append(choice(k, v) == z3.Or(into) if into else z3.Not(choice(k, v)))
        said += [z3.AtMost(*into, 1)] if len(into) > 1 else []
        said += [z3.AtMost(*out, 1)] if len(out) > 1 else []
    for (j, k, v), flown in follows.items():
        task = p.choices[k].task_id
        way = p.travel_ms[v][j][k]
        assert way is not None
        free = z3.IntVal(p.ready_ms[v]) if j == last else end(p.choices[j].task_id)
        wait = start(task) - free - way
        said.append(z3.Implies(flown, _can_wait(p, k, v, wait)))
        if j != last:
            said.append(z3.Implies(flown, choice(j, v)))
            said.append(z3.Implies(flown, place(task) > place(p.choices[j].task_id)))
    for v in range(len(p.vehicles)):
        first = [f for (a, _, u), f in follows.items() if a == last and u == v]
        said += [z3.AtMost(*first, 1)] if len(first) > 1 else []
    return said


def _can_wait(p: AssignmentProblem, k: int, v: int, wait: Any) -> Any:
    most, lap = p.choices[k].lap_max_ms, p.choices[k].lap_ms
    if most is None:
        return wait >= 0
    if most <= 0:
        return wait == 0
    laps = z3.Int(f"laps{k}_{v}")
    return z3.Or(wait == 0, z3.And(laps >= 1, wait >= laps * lap, wait <= laps * most, wait > 0))


def costs_less(problem: AssignmentProblem, branch: Part, limit: int) -> list[Any]:
    """The cost of a branch's schedule is below the limit; for costs of ends alone."""
    p = problem
    latest, said = z3.Int("latest"), []
    lasts = [z3.Int(f"last{v}") for v in range(len(p.vehicles))]
    for v in range(len(p.vehicles)):
        said.append(lasts[v] >= 0)
        for k in branch.choices:
            if p.vehicles[v] in p.choices[k].vehicles:
                said.append(z3.Implies(choice(k, v), lasts[v] >= end(p.choices[k].task_id)))
        said.append(latest >= lasts[v])
    said.append(p.cost.makespan * latest + p.cost.team * sum(lasts, z3.IntVal(0)) < limit)
    return said
