"""Why no plan exists, in the user's terms: conflicting constraint rows.

Tasks without any able vehicle are reported by `without_vehicles`. A minimal set of conflicting rows is sought
(deletion filter: without any one of them there is a plan). A latest end is reported with the earliest end
that the task can reach.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from cratous.core.assignment.anytime import NONE
from cratous.services.planning.assign import Limits, search
from cratous.services.planning.assign_problem import Part, not_all_of, parts, term_of
from cratous.spec.assignment.search import MINMAX, AssignmentProblem, Solution
from cratous.spec.constraint_rows import NOT_AFTER, NOT_BEFORE, WITHIN_END, WITHIN_START, Row

PROBES = 20_000
"""Search nodes per query while looking for reasons."""
ROWS_MAX = 60
"""Up to this many rows are tried one by one; otherwise only the upper bounds."""
UPPER = (WITHIN_END, WITHIN_START, NOT_AFTER)
Question = tuple[bool | None, int | None]
"""(whether there is a schedule, None if undecided; latest end found)."""


class _Rows:
    """Queries about a problem with only some of its rows."""

    def __init__(self, problem: AssignmentProblem) -> None:
        self.problem = replace(problem, cost=MINMAX)
        self.branches, self.complete = parts(problem)
        self.rows: dict[Row, None] = {}
        for part in self.branches:
            bound = part.rows if problem.semantics == "time" else part.rows[part.orders :]
            self.rows.update(dict.fromkeys(row for row in bound if _says(row)))

    def ask(self, keep: Iterable[Row], end: Row | None = None) -> tuple[bool | None, Solution]:
        """Whether there is a schedule under these rows and, if given, with that latest end."""
        kept = set(keep)
        branches = [self._with(part, kept, end) for part in self.branches]
        found = search(self.problem, Limits(nodes=PROBES, gap=1.0), branches, self.complete)
        if found.cost is not None:
            return True, found
        return (False if found.bound >= NONE else None), found

    def _with(self, part: Part, keep: set[Row], end: Row | None) -> Part:
        order = self.problem.semantics != "time"
        said = [
            (k < part.orders, row)
            for k, row in enumerate(part.rows)
            if row in keep or (order and k < part.orders)
        ]
        rows = [row for _, row in said]
        if end is not None and end.i in part.tasks:
            rows.append(end)
        return replace(part, rows=tuple(rows), orders=sum(first for first, _ in said))

    def earliest_end(self, task: int, keep: Sequence[Row]) -> tuple[int | None, bool]:
        """The earliest end of one task under these rows [ms], and whether that is certain.

        The search starts just below the end that was found, since that is often the earliest; the step is
        doubled with each success, and finally the interval is halved.
        """
        yes, found = self.ask(keep)
        if not yes:
            return None, False
        best, low, sure, step = _end(found, task), 0, True, 1
        while best is not None and best > low:
            limit = max((low + best) // 2, best - step)
            yes, found = self.ask(keep, Row(NOT_AFTER, task, (), 0, limit, ""))
            got = _end(found, task) if yes else None
            if got is not None:
                best, step = got, 2 * step
            else:
                low, sure = limit + 1, sure and yes is False
        return best, sure


def _says(row: Row) -> bool:
    return not (row.kind == NOT_BEFORE and row.lo <= 0)


def _end(found: Solution, task: int) -> int | None:
    return next((step.end_ms for step in found.steps if step.task_id == task), None)


def is_wayless(problem: AssignmentProblem) -> bool:
    """Whether there is no schedule even without any time constraint."""
    questions = _Rows(problem)
    return not questions.rows or questions.ask([])[0] is False


def timing_reasons(problem: AssignmentProblem, found: Solution) -> tuple[str, ...]:
    """The conflicting rows, and what remains open if that is not certain."""
    questions = _Rows(problem)
    certain = found.status == "infeasible"
    none = f"no schedule was found in {found.nodes} search nodes"
    cut = not_all_of(term_of(problem))
    open_end = () if certain else (f"{none}; {cut}" if cut else none,)
    keep = [row for row in questions.rows if row.kind in UPPER]
    lower = [row for row in questions.rows if row.kind not in UPPER]
    few = len(questions.rows) <= ROWS_MAX
    yes, _ = questions.ask(lower)
    if not yes:
        keep = [] if yes is None else list(questions.rows)
        if questions.ask([])[0] is False:
            return ("no order of the tasks satisfies the relations", *open_end)
    for row in list(keep):
        trial = [other for other in keep if other is not row]
        yes, _ = questions.ask([*lower, *trial])
        certain = certain and yes is not None
        keep = trial if yes is False else keep
    for row in list(lower) if few else ():
        trial = [other for other in lower if other is not row]
        yes, _ = questions.ask([*trial, *keep])
        certain = certain and yes is not None
        lower = trial if yes is False else lower
    said = [_sentence(questions, row, [*lower, *keep]) for row in keep if row.kind in UPPER]
    if few:
        said += [f"and {row.text}" for row in lower]
    said += [] if certain or open_end else ["that these are the fewest is not certain"]
    return tuple(said) + open_end


def _sentence(questions: _Rows, row: Row, keep: Sequence[Row]) -> str:
    """The requirement of a latest end, and the earliest end that its task can reach without it."""
    best, sure = questions.earliest_end(row.i, [other for other in keep if other is not row])
    got = "no schedule was found"
    if best is not None:
        found = "" if sure else " that was found"
        got = f"the earliest end on any eligible vehicle{found} is {best / 1000:.1f} s"
    if row.kind == NOT_AFTER:
        bound = f"task {row.i} must end by {row.hi / 1000:.3f} s"
    else:
        what = "end" if row.kind == WITHIN_END else "start"
        names = ", ".join(f"task {task}" for task in row.group)
        bound = f"task {row.i} must end within {row.hi / 1000:.3f} s of the {what} of {names}"
    return f"{bound} ({row.text}), but {got}"
