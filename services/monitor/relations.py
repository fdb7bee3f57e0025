"""A mission's task relations for plan check and monitor: whether tasks form a branch, and which
rows apply.

The kernels of `core.algebra` decide on the term as data: whether tasks are those of one branch,
whether a part of one may be done, whether everything was done as the term permits, and which
operand of each `+` is kept. The constraint rows of that branch state what was kept and what was
not; where they disagree with the kernels, the verdict is unknown.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from typing import NamedTuple

from cratous.core.algebra.terms import kept_operands, may_be_done, term_parts
from cratous.core.kernel import qualified
from cratous.core.schedule.rows import runs_forward
from cratous.services.mission.term_data import mission_nodes
from cratous.services.mission.times import Times, all_hold, row_verdict
from cratous.spec.algebra import ALTERNATIVE, Atom, Term
from cratous.spec.algebra import partial as algebra_partial
from cratous.spec.algebra.meaning import branch, branches, rows, tasks
from cratous.spec.constraint_rows import Row
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission
from cratous.spec.mission.asked import term_of
from cratous.spec.mission.guarantees import Outcome, Verdict

CHOICES_MAX = 4096
"""Maximum number of branches with the same tasks that are searched for one whose rows hold, where
the term itself cannot be judged yet.
"""


class Kept(NamedTuple):
    """The rows that apply. kernels: those that decided on the term; doubt: why the verdicts are unknown."""

    rows: tuple[Row, ...]
    kernels: tuple[str, ...] = ()
    doubt: str = ""

    def verdict(self, row: Row, times: Times, what: str) -> Verdict:
        """The verdict on one row all of whose tasks have times."""
        found = row_verdict(row, times, what)
        return self.judged(replace(found, kernels=(*found.kernels, *self.kernels)))

    def judged(self, verdict: Verdict) -> Verdict:
        """The verdict, or unknown if there is a doubt."""
        if not self.doubt:
            return verdict
        note = f"{verdict.note}; {self.doubt}"
        return replace(verdict, outcome=Outcome.UNKNOWN, note=note, margin=None, unit="")


def by_term(mission: Mission) -> tuple[str, ...]:
    """The kernels that decide the relations of a mission; empty if it has no tasks."""
    return (qualified(term_parts),) if mission.tasks else ()


def is_choice(mission: Mission, chosen: frozenset[int]) -> bool:
    """Whether these are exactly the tasks of one branch of the relations."""
    nodes = mission_nodes(mission)
    if not nodes:
        return not chosen
    return chosen <= {node.task for node in nodes} and may_be_done(nodes, chosen, True)


def is_part(mission: Mission, chosen: frozenset[int]) -> bool:
    """Whether the relations permit that exactly these tasks, at least one, are done."""
    nodes = mission_nodes(mission)
    known = bool(chosen) and chosen <= {node.task for node in nodes}
    return known and may_be_done(nodes, chosen, False)


def branch_rows(
    mission: Mission, chosen: frozenset[int], times: Times, *, part: bool = False
) -> Kept | None:
    """The rows that apply to the chosen tasks; None if they form no branch (part: nor a part of
    one).

    times: of the finished tasks [ms]. If several branches have these tasks, the result is one that
    was kept; if none was, the first of those with the fewest violated rows. Rows on tasks without
    times are skipped.
    """
    if not (is_part if part else is_choice)(mission, chosen):
        return None
    term = term_of(mission)
    if term is None:
        return Kept(())
    ran = {task: times[task] for task in chosen if task in times}
    choices = part_choices(mission, chosen) if part else row_choices(mission, chosen)
    if len(ran) < len(chosen):
        return _by_rows(choices, times)
    nodes = mission_nodes(mission)
    try:
        found = term_parts(nodes, ran, not part)
    except BadInput as error:
        # times from messages outside the range for which the kernels are proved
        return _by_rows(choices, times)._replace(doubt=str(error))
    kept = kept_operands(nodes, found)
    if kept is not None:
        one = branch(_resolved(term, kept), 0)
        said = algebra_partial.kept_rows(one, chosen) if part else rows(one)
    else:
        said = _by_rows(choices, times).rows
    forward = all(runs_forward(*ran[task]) for task in sorted(ran))
    agree = (all_hold(said, times) and forward) == (kept is not None and forward)
    doubt = "" if agree else "the rows and the relations as a whole do not say the same"
    return Kept(said, by_term(mission), doubt)


def _resolved(term: Term, kept: dict[int, int]) -> Term:
    """The term with each `+` replaced by its kept operand; kept: by the `+`'s position in postfix order."""
    place = -1

    def made(part: Term) -> Term:
        nonlocal place
        operands = () if isinstance(part, Atom) else tuple(made(one) for one in part.operands)
        place += 1
        if isinstance(part, Atom):
            return part
        mine = (operands[kept[place]],) if place in kept else operands
        return replace(part, operands=mine)

    return made(term)


def _by_rows(choices: Iterator[tuple[Row, ...]], times: Times) -> Kept:
    """The first rows of which none is violated, else the first with the fewest violated among the known ones."""
    best: tuple[Row, ...] = ()
    least, count = math.inf, 0
    for count, choice in enumerate(choices, 1):
        known = [row for row in choice if all(t in times for t in (row.i, *row.group))]
        broken = sum(row_verdict(row, times, "").outcome is not Outcome.HOLDS for row in known)
        if broken < least:
            best, least = choice, broken
        if broken == 0 or count == CHOICES_MAX:
            break
    more = least > 0 and next(choices, None) is not None
    return Kept(best, (), f"only {count} of the branches were looked at" if more else "")


# ---- iteration over branches --------------------------------------------------------------


def row_choices(mission: Mission, chosen: frozenset[int]) -> Iterator[tuple[Row, ...]]:
    """The constraint rows of each branch that consists of the chosen tasks, in the order of the
    text.

    Several branches may have the same tasks, as in `+(.(p1 p2) .(p2 p1))`. Empty if no branch has
    exactly these tasks.
    """
    term = term_of(mission)
    if term is None:
        yield from () if chosen else ((),)
        return
    within = _within(term, chosen)
    made = branches(within) if within is not None else iter(())
    yield from (rows(one) for one in made if frozenset(tasks(one)) == chosen)


def _within(term: Term, chosen: frozenset[int]) -> Term | None:
    """The term without the operands of `+` that need another task; None if nothing is left.

    This avoids building branches that cannot consist of the chosen tasks: with twenty choices
    between two tasks, one branch of a million is left.
    """
    if isinstance(term, Atom):
        return term if term.task in chosen else None
    inside = [_within(operand, chosen) for operand in term.operands]
    kept = tuple(operand for operand in inside if operand is not None)
    if not kept or (term.op != ALTERNATIVE and len(kept) < len(inside)):
        return None
    return replace(term, operands=kept)


def part_choices(mission: Mission, chosen: frozenset[int]) -> Iterator[tuple[Row, ...]]:
    """The rows on the chosen tasks for each branch that permits exactly these of its tasks to be
    done.

    At most CHOICES_MAX branches are searched.
    """
    term = term_of(mission)
    if term is None or not chosen:
        return
    for one in islice(branches(algebra_partial.after_choices(term, chosen)), CHOICES_MAX):
        if chosen <= set(tasks(one)) and algebra_partial.may_be_done(one, chosen):
            yield algebra_partial.kept_rows(one, chosen)


def first_choices(mission: Mission, chosen: frozenset[int]) -> Iterator[tuple[Row, ...]]:
    """The first CHOICES_MAX of `row_choices`."""
    return islice(row_choices(mission, chosen), CHOICES_MAX)
