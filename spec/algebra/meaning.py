"""What a process-algebra term means: which tasks are done, in what order, and when.

`.(a b)`: b starts no earlier than a ends; `~(a b)`: no earlier than a starts; each operand is held
against the one directly before it, and so against all before (no interval ends before it starts).
`|`: all operands, in any order. `+`: exactly one operand; tasks of the others do not start.
A composite starts with its earliest task and ends with its latest.

Timing. `E_[t1-t2]`: every task of E starts at t1 or later and ends at t2 or earlier (ms after
mission start). `E-[t1-t2]`, if E's own top operator is `.` or `~`: every task of a later operand
starts at least t1 and ends at most t2 after the end (`.`) or the start (`~`) of the operand before
it; under any other operator, or on a task, it means the same as `_`. The innermost timing that
bounds a task is the only one that counts for it; the first operand of a relative `.` or `~` is not
bounded by it. Order is never overridden.

`rows` gives the constraints of a branch to the checker kernel; `satisfied` says the same directly
of composites and is what the rows are held against.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise, product
from math import prod

from cratous.spec import constraint_rows as kinds
from cratous.spec.algebra import (
    ABSOLUTE,
    ALTERNATIVE,
    PARALLEL,
    RELATIVE,
    SEQUENTIAL,
    TILDE,
    Atom,
    Op,
    Suffix,
    Term,
    atoms,
    format_term,
)
from cratous.spec.algebra.runs import complete, next_actions, runs
from cratous.spec.constraint_rows import Row

__all__ = [
    "bounds_all",
    "branch",
    "branches",
    "complete",
    "count_branches",
    "idle_timings",
    "next_actions",
    "quote",
    "rows",
    "runs",
    "satisfied",
    "tasks",
]

Times = Mapping[int, tuple[int, int]]


def tasks(term: Term) -> tuple[int, ...]:
    """The tasks of the term, each once, in the order of the text."""
    return tuple(dict.fromkeys(atom.task for atom in atoms(term)))


def bounds_all(term: Term) -> bool:
    """Whether the term's suffix, if it has one, bounds every task in the term."""
    ordered = isinstance(term, Op) and term.op in (SEQUENTIAL, TILDE)
    return term.suffix is not None and not (term.suffix.kind == RELATIVE and ordered)


# ---- branches -------------------------------------------------------------------------------


def count_branches(term: Term) -> int:
    """The number of ways to resolve every `+` to one operand."""
    if isinstance(term, Atom):
        return 1
    counts = map(count_branches, term.operands)
    return sum(counts) if term.op == ALTERNATIVE else prod(counts)


def branches(term: Term) -> Iterator[Term]:
    """All ways to resolve every `+` to one operand, lazily, the first operands first.

    The terms have no `+`. A suffix on a `+` goes to the chosen operand as an absolute one.
    """
    for number in range(count_branches(term)):
        yield branch(term, number)


def branch(term: Term, number: int) -> Term:
    """Branch `number` of `branches(term)`, without enumerating those before it."""
    if isinstance(term, Atom):
        return term
    if term.op == ALTERNATIVE:
        for operand in term.operands:
            count = count_branches(operand)
            if number < count:
                return _also_bounded(branch(operand, number), term.suffix)
            number -= count
        raise IndexError("the term has fewer branches")
    chosen = []
    for operand in reversed(term.operands):
        number, here = divmod(number, count_branches(operand))
        chosen.append(branch(operand, here))
    return replace(term, operands=tuple(reversed(chosen)))


def _also_bounded(term: Term, outer: Suffix | None) -> Term:
    """The term with one more, outer timing on all its tasks."""
    if outer is None or bounds_all(term):
        return term
    absolute = replace(outer, kind=ABSOLUTE)
    if term.suffix is None:
        return replace(term, suffix=absolute)
    # Its own relative timing leaves the first operand to the outer one, so both must stay.
    return Op(PARALLEL, (term,), absolute, term.span)


# ---- constraint rows ------------------------------------------------------------------------


def rows(term: Term) -> tuple[Row, ...]:
    """The constraints on times that a term without `+` states, with unused bounds set to 0.

    Raises ValueError for a term with `+`: take one of its `branches`.
    """
    out: list[Row] = []
    timing: dict[int, tuple[Row, ...]] = {}
    _collect(term, out, timing)
    return (*out, *(row for task in tasks(term) for row in timing.get(task, ())))


def idle_timings(term: Term) -> tuple[Term, ...]:
    """Sub-terms of a term without `+` whose timing constrains no task because inner timings override it."""
    timing: dict[int, tuple[Row, ...]] = {}
    owners: dict[int, Term] = {}
    _collect(term, [], timing, owners)
    alive = {id(owner) for owner in owners.values()}
    return tuple(part for part in _parts(term) if part.suffix and id(part) not in alive)


def _parts(term: Term) -> Iterator[Term]:
    todo = [term]
    while todo:
        part = todo.pop()
        yield part
        if isinstance(part, Op):
            todo.extend(reversed(part.operands))


def _collect(
    term: Term,
    order: list[Row],
    timing: dict[int, tuple[Row, ...]],
    owners: dict[int, Term] | None = None,
) -> None:
    """Add the order rows to `order` and set the timing rows of each task; inner terms come later and override."""
    said = quote(term) if isinstance(term, Op) or term.suffix else ""
    if isinstance(term, Op):
        if term.op == ALTERNATIVE:
            raise ValueError(f"resolve {said} to one operand first")
        if term.op in (SEQUENTIAL, TILDE):
            kind = kinds.AFTER_END if term.op == SEQUENTIAL else kinds.AFTER_START
            for before, later in pairwise(term.operands):
                group = tasks(before)
                event = _event(term.op, group)
                for task in tasks(later):
                    text = f"{said}: p{task} starts no earlier than {event}"
                    order.append(Row(kind, task, group, 0, 0, text))
    bound = _absolute_rows(term, said) if bounds_all(term) else _relative_rows(term, said)
    timing.update(bound)
    if owners is not None:
        owners.update(dict.fromkeys(bound, term))
    if isinstance(term, Op):
        for operand in term.operands:
            _collect(operand, order, timing, owners)


def _absolute_rows(term: Term, said: str) -> dict[int, tuple[Row, ...]]:
    assert term.suffix is not None
    t1, t2 = term.suffix.t1_ms, term.suffix.t2_ms
    return {
        task: (
            Row(kinds.NOT_BEFORE, task, (), t1, 0, f"{said}: p{task} starts at {t1} ms or later"),
            Row(kinds.NOT_AFTER, task, (), 0, t2, f"{said}: p{task} ends at {t2} ms or earlier"),
        )
        for task in tasks(term)
    }


def _relative_rows(term: Term, said: str) -> dict[int, tuple[Row, ...]]:
    found: dict[int, tuple[Row, ...]] = {}
    if isinstance(term, Atom) or term.suffix is None:
        return found
    t1, t2 = term.suffix.t1_ms, term.suffix.t2_ms
    after, within = (
        (kinds.AFTER_END, kinds.WITHIN_END)
        if term.op == SEQUENTIAL
        else (kinds.AFTER_START, kinds.WITHIN_START)
    )
    for before, later in pairwise(term.operands):
        group = tasks(before)
        event = _event(term.op, group)
        for task in tasks(later):
            found[task] = (
                Row(after, task, group, t1, 0,
                    f"{said}: p{task} starts at least {t1} ms after {event}"),
                Row(within, task, group, 0, t2,
                    f"{said}: p{task} ends at most {t2} ms after {event}"),
            )  # fmt: skip
    return found


def quote(term: Term) -> str:
    """The canonical text of a term in back quotes, shortened in the middle if it is long."""
    text = format_term(term)
    return f"`{text}`" if len(text) <= 64 else f"`{text[:40]}…{text[-20:]}`"


def _event(op: str, group: tuple[int, ...]) -> str:
    verb, which = ("ends", "last") if op == SEQUENTIAL else ("starts", "first")
    if len(group) == 1:
        return f"p{group[0]} {verb}"
    names = " ".join(f"p{task}" for task in group[:8]) + (" …" if len(group) > 8 else "")
    return f"the {which} of {names} {verb}"


# ---- satisfaction ---------------------------------------------------------------------------

Free = frozenset[int]


def satisfied(term: Term, times: Times) -> bool:
    """Whether the tasks that ran, with their start and end times [ms], satisfy the term.

    times: the tasks that have started; tasks that do not occur in the term are ignored. Written directly from the
    definition on composites, deliberately without `branches` and `rows`.
    """
    ran = [times[task] for task in tasks(term) if task in times]
    return all(start <= end for start, end in ran) and bool(_ways(term, times))


def _ways(term: Term, times: Times) -> set[Free]:
    """The ways in which the term has been done; each is the set of its tasks that no timing constrains yet."""
    parts: list[set[Free]] = []
    if isinstance(term, Atom):
        parts.append({frozenset({term.task})} if term.task in times else set())
    elif term.op == ALTERNATIVE:
        started = set(tasks(term)) & set(times)
        chosen: set[Free] = set()
        for operand in term.operands:
            if started <= set(tasks(operand)):
                chosen |= _ways(operand, times)
        parts.append(chosen)
    else:
        for operand in term.operands:
            parts.append(_ways(operand, times))
    if not all(parts):
        return set()
    moments: list[int] = []
    if isinstance(term, Op) and term.op in (SEQUENTIAL, TILDE):
        ran = [[times[task] for task in tasks(part) if task in times] for part in term.operands]
        which = 1 if term.op == SEQUENTIAL else 0
        moments = [(max if which else min)(span[which] for span in spans) for spans in ran]
        if any(min(spans)[0] < moment for spans, moment in zip(ran[1:], moments, strict=False)):
            return set()
    if term.suffix is None:
        return {frozenset().union(*choice) for choice in product(*parts)}
    if bounds_all(term):
        fits = all(_fits(part, times, 0, term.suffix) for part in parts)
        return {frozenset()} if fits else set()
    later = zip(parts[1:], moments, strict=False)
    fits = all(_fits(part, times, moment, term.suffix) for part, moment in later)
    return parts[0] if fits else set()


def _fits(ways: set[Free], times: Times, moment: int, window: Suffix) -> bool:
    """Whether, in one of the ways, all tasks not yet constrained lie in the window after `moment`."""
    first, last = moment + window.t1_ms, moment + window.t2_ms
    return any(all(first <= times[x][0] and times[x][1] <= last for x in way) for way in ways)
