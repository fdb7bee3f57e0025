"""The best partial assignment of a mission, with certificate, and why each left-out task cannot be done."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from cratous.core.assignment.problem import Assignment
from cratous.services.planning import mission_assign, reasons
from cratous.services.planning.assign import Limits
from cratous.services.planning.mission_assign import Found
from cratous.services.planning.partial import PROBES, Part, Parts, restricted
from cratous.spec.algebra.meaning import rows, tasks
from cratous.spec.algebra.partial import may_be_done, only, waits_for
from cratous.spec.assignment.search import AssignmentProblem
from cratous.spec.errors import NoPlan
from cratous.spec.mission.plan import ORDER, TIME, LeftOut, Remedy

MORE = 100
"""Further queries for finding reasons."""
TOLD_MAX = 3
"""Most conflicting constraints reported per task."""


class NothingDone(NoPlan):
    """Nothing of a mission can be done. of: reasons by task, where they are known separately."""

    def __init__(self, reasons: tuple[str, ...], of: Mapping[int, str]) -> None:
        self.of = dict(of)
        super().__init__(reasons)


def assign_part(
    problem: AssignmentProblem,
    limits: Limits,
    all_of: Parts,
    unable: Mapping[int, str],
    remedies: Callable[[int], tuple[Remedy, ...]],
) -> Found:
    """The best assignment of the part that leaves out least; none, with the reason for each task, if nothing
    can be done.

    unable: why no vehicle can do a task at all; remedies: changes that would let some vehicle do it.
    """
    chosen = all_of.choose()
    terms = [only(all_of.branches[k], kept) for k, kept in chosen.parts]
    made = restricted(problem, list(dict.fromkeys(term for term in terms if term is not None)))
    if not chosen.parts:
        return Found(None, None, left_out=_nothing(all_of, unable), sure=chosen.sure)
    nodes = None if limits.nodes is None else max(limits.nodes, PROBES)
    found = mission_assign.assign(made, replace(limits, nodes=nodes))
    if found.assignment is None:
        return found
    done = set(found.assignment.branch.tasks)
    part = next(part for part in chosen.parts if part[1] == done)
    left = (*_Reasons(all_of, part, unable, remedies).all(), *_other_choices(all_of, part, unable))
    assignment = _numbered(found.assignment, made, problem)
    return replace(found, assignment=assignment, left_out=left, sure=chosen.sure)


def _nothing(all_of: Parts, unable: Mapping[int, str]) -> tuple[LeftOut, ...]:
    """Why each task of any branch cannot be done, if none can; without remedies."""
    found: dict[int, LeftOut] = {}
    for k, branch in enumerate(all_of.branches):
        if not found.keys() >= set(tasks(branch)) - all_of.flown:
            part = k, all_of.flown
            for one in _Reasons(all_of, part, unable, lambda _task: ()).all():
                found.setdefault(one.task_id, one)
    return tuple(found[task] for task in sorted(found))


def _other_choices(all_of: Parts, part: Part, unable: Mapping[int, str]) -> tuple[LeftOut, ...]:
    """Why the other operands of a `+` are not done, if nothing of that `+` is; without remedies."""
    k, kept = part
    told = set(tasks(all_of.branches[k]))
    found: dict[int, LeftOut] = {}
    for other, branch in enumerate(all_of.branches):
        new = set(tasks(branch)) - told - found.keys()
        if new and kept <= set(tasks(branch)) and may_be_done(branch, kept):
            every = _Reasons(all_of, (other, kept), unable, lambda _task: (), chosen=False).all()
            found.update((one.task_id, one) for one in every if one.task_id in new)
    return tuple(found[task] for task in sorted(found))


def _numbered(found: Assignment, made: AssignmentProblem, whole: AssignmentProblem) -> Assignment:
    """The assignment in the indices of the whole problem."""
    number = {(c.task_id, c.option_id): k for k, c in enumerate(whole.choices)}
    at = [number[c.task_id, c.option_id] for c in made.choices]
    placed = tuple(one._replace(candidate=at[one.candidate]) for one in found.placed)
    return replace(found, placed=placed)


class _Reasons:
    """Why the tasks that a part leaves out cannot be done in addition to it."""

    def __init__(
        self,
        all_of: Parts,
        part: Part,
        unable: Mapping[int, str],
        remedies: Callable[[int], tuple[Remedy, ...]],
        chosen: bool = True,
    ) -> None:
        """chosen: the part is of the chosen branch; otherwise of another one, which may contain tasks that
        could be done.
        """
        self.remedies, self.chosen = remedies, chosen
        self.all_of, self.part, self.unable = all_of, part, unable
        self.branch = all_of.branches[part[0]]
        self.limit = all_of.asked + MORE

    def all(self) -> tuple[LeftOut, ...]:
        """The reason for each; tasks that wait for another one are listed with it."""
        left = self.all_of.left(self.part)
        waits = {task: self._awaited(task) for task in left if task in self.all_of.able}
        found = []
        for task in left:
            waiting = tuple(other for other in left if task in _chain(waits, other))
            if task not in self.all_of.able:
                why = self.unable.get(task, "no vehicle can do it")
                found.append(LeftOut(task, why, waiting, remedies=self.remedies(task)))
            elif waits[task]:
                first = f"what it waits for is done first: {_names(waits[task])}"
                remedy = Remedy((ORDER,), first, tasks=waits[task])
                found.append(LeftOut(task, self._waits_text(task), waiting, remedies=(remedy,)))
            else:
                found.append(self._clash(task, waiting))
        return tuple(found)

    def _awaited(self, task: int) -> tuple[int, ...]:
        """The left-out tasks that a task would have to wait for."""
        kept = self.part[1]
        found: dict[int, None] = {}
        for row in rows(self.branch):
            if row.i == task and task not in self.all_of.begun and waits_for(row, kept):
                found.update(dict.fromkeys(t for t in row.group if t not in kept))
        return tuple(found)

    def _waits_text(self, task: int) -> str:
        row = next(r for r in rows(self.branch) if r.i == task and waits_for(r, self.part[1]))
        return f"it must wait for what is not done: {row.text}"

    def _clash(self, task: int, waiting: Iterable[int]) -> LeftOut:
        """A task without a schedule in addition to the planned tasks, and the planned tasks in conflict with
        it.
        """
        all_of, (k, kept) = self.all_of, self.part
        want = kept | all_of.needed(k, task)
        if not self.chosen and all_of.asked < self.limit and all_of.ask((k, want)):
            why = "it could be done, but another choice of the relations leaves out less"
            return LeftOut(task, why, tuple(waiting))
        clash = next((c for c in all_of.conflicts.get(k, ()) if task in c and c <= want), None) or (
            all_of.conflict((k, want)) if all_of.asked < self.limit else None
        )
        if clash is None or task not in clash:
            why = "no schedule was found for it beside what is planned"
            return LeftOut(task, why, tuple(waiting))
        need = all_of.needed(k, task)
        instead = tuple(t for t in tasks(self.branch) if t in clash - need)
        asked = all_of.question((k, clash))
        said = reasons.timing_reasons(asked, all_of.solve((k, clash)))
        why = "; ".join(said[:TOLD_MAX])
        wayless = reasons.is_wayless(asked)
        remedies = () if wayless else (Remedy((TIME,), f"other times: {why}"),)
        if wayless:
            why = "there is no way from task to task"
        if instead:
            why = f"not beside {_names(instead)}: {why}"
            # without them there is a schedule, or the conflict would not be minimal
            without = Remedy((TIME,), f"without {_names(instead)}", tasks=instead)
            remedies = (*remedies, without)
        return LeftOut(task, why, tuple(waiting), instead, remedies)


def _names(numbers: tuple[int, ...]) -> str:
    return f"task{'' if len(numbers) == 1 else 's'} {', '.join(map(str, numbers))}"


def _chain(waits: Mapping[int, tuple[int, ...]], task: int) -> set[int]:
    """All tasks that a task waits for, transitively."""
    found: set[int] = set()
    todo = list(waits.get(task, ()))
    while todo:
        one = todo.pop()
        if one not in found:
            found.add(one)
            todo += waits.get(one, ())
    return found
