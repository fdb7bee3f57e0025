"""The part of a mission that leaves out least, where not all of it can be done.

Of two parts, the better one leaves out fewer tasks of the highest priority, then of the next, and so on; then
has more tasks; then costs less. The algebra defines what may be done without the left-out tasks
(`spec.algebra.partial`). The search is limited to parts without a conflict: a minimal set of tasks without a
schedule, found by leaving out one task after the other. Its result is assigned, certified and checked like
any plan.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass, field, replace
from itertools import islice

from cratous.core.assignment.anytime import NONE
from cratous.services.planning.assign import Limits, search
from cratous.services.planning.assign_problem import BRANCHES_MAX, not_all_of, parts, term_of
from cratous.spec.algebra import ALTERNATIVE, Op, Term, format_term
from cratous.spec.algebra.meaning import branches, rows, tasks
from cratous.spec.algebra.partial import largest_part, may_be_done, only
from cratous.spec.assignment.search import AssignmentProblem, Rows, Solution
from cratous.spec.constraint_rows import AFTER_END, AFTER_START

PROBES = 20_000
"""Nodes per query whether some tasks have a schedule."""
ASKED_MAX = 400
"""Most such queries; after that tasks are added one by one, by priority."""
ALIKE_MAX = 8
"""Most parts with equal omissions that are compared by cost."""

Part = tuple[int, frozenset[int]]
"""A branch of the relations by index, and its tasks that are done or to be done."""
Rank = tuple[tuple[int, ...], int]


@dataclass(frozen=True)
class Chosen:
    """The choice. parts: equal in what they leave out; sure: no part leaves out less, as far as the queries
    were decided.
    """

    parts: tuple[Part, ...]
    sure: bool


@dataclass
class Parts:
    """The parts of a problem's relations. priority: by task, higher takes precedence; begun: tasks no longer
    held back by any order.
    """

    problem: AssignmentProblem
    priority: Mapping[int, int]
    begun: frozenset[int] = frozenset()
    asked: int = 0
    sure: bool = True
    conflicts: dict[int, list[frozenset[int]]] = field(default_factory=dict)
    _known: dict[Part, bool | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.flown = frozenset(task for task, _, _ in self.problem.done)
        self.sure = not not_all_of(term_of(self.problem))
        # a flown task counts as done, whatever became of its predecessors
        self.begun |= self.flown
        able = {choice.task_id for choice in self.problem.choices if choice.vehicles}
        self.able = frozenset(able | self.flown)
        made = _branches(self.problem)
        self.branches = [branch for branch in made if self.flown <= set(tasks(branch))]
        self.levels = sorted(set(self.priority.values()), reverse=True)

    def kept(self, k: int, out: Set[int] = frozenset()) -> frozenset[int]:
        """The largest part of a branch without the tasks in `out`."""
        return largest_part(self.branches[k], self.able - out, self.begun)

    def left(self, part: Part) -> tuple[int, ...]:
        """The tasks of its branch that a part leaves out."""
        return tuple(task for task in tasks(self.branches[part[0]]) if task not in part[1])

    def rank(self, part: Part) -> Rank:
        """Sort key: number of left-out tasks by priority, then more tasks first."""
        out = [self.priority.get(task, 0) for task in self.left(part)]
        return tuple(out.count(level) for level in self.levels), -len(part[1])

    def question(self, part: Part) -> AssignmentProblem:
        """The problem of a part."""
        return restricted(self.problem, [_term(self.branches[part[0]], part[1])])

    def solve(self, part: Part) -> Solution:
        """A first schedule of a part, or the result that there is none."""
        asked = self.question(part)
        return search(asked, Limits(nodes=PROBES, gap=1.0), *parts(asked))

    def ask(self, part: Part) -> bool | None:
        """Whether a part has a schedule; None if undecided."""
        if part[1] == self.flown:
            return True
        if part not in self._known:
            self.asked += 1
            found = self.solve(part)
            self._known[part] = found.cost is not None or (False if found.bound >= NONE else None)
        return self._known[part]

    def conflict(self, part: Part) -> frozenset[int]:
        """For a part without a schedule, the smallest subset found that has none."""
        k, kept = part
        known = next((c for c in self.conflicts.get(k, ()) if c <= kept), None)
        if known is not None:
            return known
        for task in sorted(kept - self.flown, key=lambda t: (self.priority.get(t, 0), -t)):
            if task not in kept or self.asked >= ASKED_MAX:
                continue
            trial = largest_part(self.branches[k], kept - {task}, self.begun)
            if self.ask((k, trial)) is False:
                kept = trial
        self.conflicts.setdefault(k, []).append(kept)
        return kept

    def choose(self) -> Chosen:
        """The parts that leave out least; none if nothing can be done."""
        first = [(k, self.kept(k)) for k in range(len(self.branches))]
        queue = [(self.rank(part), number, part) for number, part in enumerate(first)]
        heapq.heapify(queue)
        seen, found, best = set(first), list[Part](), None
        while queue and len(found) < ALIKE_MAX:
            rank, _, part = queue[0]
            if part[1] == self.flown or (best is not None and rank != best):
                break
            if self.asked >= ASKED_MAX:
                found = found or [self._one_by_one(part[0])]
                self.sure = False
                break
            heapq.heappop(queue)
            has = False
            if not any(c <= part[1] for c in self.conflicts.get(part[0], ())):
                has = self.ask(part) or False
                self.sure = self.sure and self.ask(part) is not None
            if has:
                found, best = [*found, part], rank
                continue
            for task in sorted(self.conflict(part) - self.flown):
                less = part[0], largest_part(self.branches[part[0]], part[1] - {task}, self.begun)
                if less not in seen:
                    seen.add(less)
                    heapq.heappush(queue, (self.rank(less), len(seen), less))
        return Chosen(tuple(part for part in found if part[1] > self.flown), self.sure)

    def _one_by_one(self, k: int) -> Part:
        """A part of a branch to which no task can be added, built by priority."""
        kept, whole = self.flown, self.kept(k)
        for task in sorted(whole - kept, key=lambda t: (-self.priority.get(t, 0), t)):
            trial = kept | self.needed(k, task)
            if trial != kept and self.ask((k, trial)):
                kept = trial
        return k, kept

    def needed(self, k: int, task: int) -> frozenset[int]:
        """A task of a branch and all tasks that must be done for it."""
        found, todo = set(self.flown), [task]
        order = [row for row in rows(self.branches[k]) if row.kind in (AFTER_END, AFTER_START)]
        while todo:
            one = todo.pop()
            if one in found:
                continue
            found.add(one)
            for row in (row for row in order if row.i == one and one not in self.begun):
                group = [t for t in row.group if t not in found]
                if row.kind == AFTER_START:
                    group = group[:1] if len(group) == len(row.group) else []
                todo += group
        return frozenset(found)


def _term(branch: Term, kept: Set[int]) -> Term:
    term = only(branch, kept)
    assert term is not None
    return term


def restricted(problem: AssignmentProblem, terms: list[Term]) -> AssignmentProblem:
    """The problem restricted to these branches and the choices of their tasks."""
    wanted = {task for term in terms for task in tasks(term)}
    kept = [k for k, choice in enumerate(problem.choices) if choice.task_id in wanted]
    start = len(problem.choices)

    def table(vehicles: tuple[Rows, ...]) -> tuple[Rows, ...]:
        return tuple(tuple(tuple(v[a][k] for k in kept) for a in (*kept, start)) for v in vehicles)

    one = terms[0] if len(terms) == 1 else Op(ALTERNATIVE, tuple(terms))
    return replace(
        problem,
        choices=tuple(problem.choices[k] for k in kept),
        travel_ms=table(problem.travel_ms),
        distance_mm=table(problem.distance_mm),
        energy_mj=table(problem.energy_mj),
        relations=format_term(one),
        release_ms=tuple(entry for entry in problem.release_ms if entry[0] in wanted),
        due_ms=tuple(entry for entry in problem.due_ms if entry[0] in wanted),
        unable=frozenset(),
    )


def part_problem(problem: AssignmentProblem, planned: Set[int]) -> AssignmentProblem:
    """The problem of a part chosen by others: these tasks and the flown ones.

    The problem itself if they do not form a part, so that this is reported as for any plan.
    """
    kept = planned | {task for task, _, _ in problem.done}
    if any(set(tasks(branch)) == kept for branch in _branches(problem)):
        return problem
    fitting = (b for b in _branches(problem) if kept <= set(tasks(b)) and may_be_done(b, kept))
    terms = list(dict.fromkeys(_term(branch, kept) for branch in fitting))
    return restricted(problem, terms) if planned and terms else problem


def _branches(problem: AssignmentProblem) -> Iterator[Term]:
    return islice(branches(term_of(problem)), BRANCHES_MAX)
