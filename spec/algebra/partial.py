"""What a term permits when some of its tasks are not done: which tasks still count, and which must wait.

A task that ended undone, or never began, satisfies nothing. So in `.`, a task of a later operand may be done only if
the operand before was completely done (`.(p1 p2)`: without p1 no p2); in `~`, only if some task of the operand before
was begun. Under `|` the other operands are unaffected. Of `+`, still at most one operand is begun. Order and timing
apply to the tasks that were done: a relative timing refers to those tasks of the operand before that ran. A line or
an area of which only a part was flown, because zones cover the rest, counts as done here (whether that part serves
the task is judged separately).

`permits` defines this on composites and times; `may_be_done` on sets of tasks, considering order alone. `kept_rows`
gives the time constraints of the remaining tasks, `only` the remaining term.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import replace
from itertools import pairwise, product

from cratous.spec.algebra import ALTERNATIVE, PARALLEL, SEQUENTIAL, TILDE, Atom, Op, Suffix, Term
from cratous.spec.algebra.meaning import bounds_all, rows, tasks
from cratous.spec.constraint_rows import AFTER_END, AFTER_START, WITHIN_END, WITHIN_START, Row

Times = Mapping[int, tuple[int, int]]
ORDERED = (SEQUENTIAL, TILDE)


def is_whole(term: Term, done: Set[int]) -> bool:
    """Whether a term is completely done if exactly these tasks are done."""
    if isinstance(term, Atom):
        return term.task in done
    if term.op == ALTERNATIVE:
        mine = done & set(tasks(term))
        return any(mine <= set(tasks(part)) and is_whole(part, done) for part in term.operands)
    return all(is_whole(part, done) for part in term.operands)


def may_be_done(term: Term, done: Set[int]) -> bool:
    """Whether exactly these tasks of a term may be done and the others left undone."""
    if isinstance(term, Atom):
        return True
    if term.op == ALTERNATIVE:
        mine = done & set(tasks(term))
        return any(mine <= set(tasks(part)) and may_be_done(part, done) for part in term.operands)
    if not all(may_be_done(part, done) for part in term.operands):
        return False
    return term.op not in ORDERED or all(
        not done & set(tasks(later)) or _opens(term.op, before, done)
        for before, later in pairwise(term.operands)
    )


def _opens(op: str, before: Term, done: Set[int]) -> bool:
    """Whether what was done of an operand permits the next one to begin."""
    return is_whole(before, done) if op == SEQUENTIAL else bool(done & set(tasks(before)))


# ---- times ------------------------------------------------------------------------------------


def permits(term: Term, times: Times) -> bool:
    """Whether a term permits that exactly these of its tasks ran, from start to end [ms].

    Written directly from the definition on composites, deliberately without `branches` and `rows`.
    """
    ran = [times[task] for task in tasks(term) if task in times]
    return all(start <= end for start, end in ran) and bool(_ways(term, times))


def _ways(term: Term, times: Times) -> set[frozenset[int]]:
    """The ways in which a part of the term has been done; each is the set of its tasks not yet constrained."""
    began = set(tasks(term)) & set(times)
    if isinstance(term, Atom):
        parts = [{frozenset(began)}]
    elif term.op == ALTERNATIVE:
        fitting = (part for part in term.operands if began <= set(tasks(part)))
        parts = [set().union(*(_ways(part, times) for part in fitting))]
    else:
        parts = [_ways(part, times) for part in term.operands]
    if not all(parts):
        return set()
    windows: list[tuple[set[frozenset[int]], int]] = []
    if isinstance(term, Op) and term.op in ORDERED:
        for k, (before, later) in enumerate(pairwise(term.operands), 1):
            spans = [times[task] for task in tasks(later) if task in times]
            if not spans:
                continue
            if not _opens(term.op, before, began):
                return set()
            moment = _moment(term.op, before, times)
            if min(spans)[0] < moment:
                return set()
            windows.append((parts[k], moment))
    if term.suffix is None:
        return {frozenset().union(*choice) for choice in product(*parts)}
    if bounds_all(term):
        fits = all(_fits(part, times, 0, term.suffix) for part in parts)
        return {frozenset()} if fits else set()
    fits = all(_fits(part, times, moment, term.suffix) for part, moment in windows)
    return parts[0] if fits else set()


def _moment(op: str, before: Term, times: Times) -> int:
    """The latest end, or the earliest start, of what ran of an operand."""
    ran = [times[task] for task in tasks(before) if task in times]
    return max(end for _, end in ran) if op == SEQUENTIAL else min(start for start, _ in ran)


def _fits(ways: set[frozenset[int]], times: Times, moment: int, window: Suffix) -> bool:
    """Whether, in one of the ways, all tasks not yet constrained lie in the window after `moment`."""
    first, last = moment + window.t1_ms, moment + window.t2_ms
    return any(all(first <= times[x][0] and times[x][1] <= last for x in way) for way in ways)


# ---- rows and terms ---------------------------------------------------------------------------


def waits_for(row: Row, kept: Set[int]) -> bool:
    """Whether a row blocks its task for ever if only the kept tasks are ever done: the row waits for the end of a
    task that is not kept, or for the start of a group with no kept task.
    """
    if row.kind == AFTER_END:
        return not set(row.group) <= kept
    return row.kind == AFTER_START and not set(row.group) & kept


def largest_part(branch: Term, able: Set[int], begun: Set[int] = frozenset()) -> frozenset[int]:
    """The largest set of tasks of a term without `+` that may be done if only the able tasks can be: those that wait
    for no task outside the set. It contains every set of able tasks that may be done.

    begun: tasks that have already begun, which no order constraint holds back.
    """
    kept = set(tasks(branch)) & able
    order = [row for row in rows(branch) if row.kind in (AFTER_END, AFTER_START)]
    while True:
        held = {row.i for row in order if row.i in kept - begun and waits_for(row, kept)}
        if not held:
            return frozenset(kept)
        kept -= held


def kept_rows(branch: Term, kept: Set[int]) -> tuple[Row, ...]:
    """The constraint rows of a term without `+` on the times of the kept tasks.

    Each row refers to the kept tasks of its group; a row without any is dropped.
    """
    found = []
    for row in rows(branch):
        group = tuple(task for task in row.group if task in kept)
        refers = row.kind in (AFTER_END, AFTER_START, WITHIN_END, WITHIN_START)
        if row.i in kept and (group or not refers):
            found.append(row._replace(group=group))
    return tuple(found)


def only(branch: Term, kept: Set[int]) -> Term | None:
    """The term without `+` restricted to the kept tasks; None if there are none.

    For tasks that satisfy `may_be_done`, its rows are `kept_rows`.
    """
    if isinstance(branch, Atom):
        return branch if branch.task in kept else None
    parts = tuple(part for part in (only(a, kept) for a in branch.operands) if part is not None)
    if not parts:
        return None
    if only(branch.operands[0], kept) is None and not bounds_all(branch) and branch.suffix:
        # a task begun earlier may stand alone: its relative timing no longer refers to anything
        return Op(PARALLEL, parts, None, branch.span)
    return replace(branch, operands=parts)


def after_choices(term: Term, begun: Set[int]) -> Term:
    """The term in which each `+` keeps only the operands that contain all of its tasks that were begun.

    A `+` with no such operand stays unchanged.
    """
    if isinstance(term, Atom):
        return term
    operands = term.operands
    if term.op == ALTERNATIVE:
        mine = begun & set(tasks(term))
        fitting = tuple(part for part in operands if mine <= set(tasks(part)))
        operands = fitting or operands
    return replace(term, operands=tuple(after_choices(part, begun) for part in operands))
