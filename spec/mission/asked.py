"""The tasks that a mission requires: those of one branch of its relations, from the mission alone.

What a planner accepted, or a vehicle flew, only helps to determine which branch of a `+` was chosen; it never reduces
the set.
"""

from __future__ import annotations

from collections.abc import Callable, Set

from cratous.spec import algebra
from cratous.spec.algebra import ALTERNATIVE, Atom, Term
from cratous.spec.algebra import meaning as algebra_meaning
from cratous.spec.mission import Mission

Worth = Callable[[int], int]


def term_of(mission: Mission) -> Term | None:
    """The mission's relations as a term; all its tasks in any order if it has no relations; None without tasks."""
    ids = [task.id for task in mission.tasks]
    if not ids:
        return None
    if not mission.relations.strip():
        return algebra.parallel_of(ids)
    return algebra.parse(mission.relations, frozenset(ids), where=mission.source)


def best_branch(term: Term, worth: Worth) -> Term:
    """The branch with the greatest total worth of its tasks; the first of equals."""
    _, number, _ = _best(term, worth)
    return algebra_meaning.branch(term, number)


def _best(term: Term, worth: Worth) -> tuple[int, int, int]:
    """The best branch as (worth, number), and the number of branches."""
    if isinstance(term, Atom):
        return worth(term.task), 0, 1
    found = [_best(operand, worth) for operand in term.operands]
    if term.op == ALTERNATIVE:
        best, before = (found[0][0], found[0][1]), 0
        for value, number, count in found:
            if value > best[0]:
                best = (value, before + number)
            before += count
        return *best, before
    total, place, counts = 0, 0, 1
    for value, number, count in found:
        total, place, counts = total + value, place * count + number, counts * count
    return total, place, counts


def asked(mission: Mission, done: Set[int], accepted: Set[int]) -> tuple[int, ...]:
    """The tasks that have to be served: those of a branch that is completely done; otherwise of the branch that
    contains most of the accepted tasks and, among those, the fewest other tasks. The first of equals; no tasks if the
    mission has none.
    """
    term = term_of(mission)
    if term is None:
        return ()
    much = 2 * len(mission.tasks) + 2
    most = much * much

    def lacking(task: int) -> int:
        return (0 if task in done else -much) + (task in accepted)

    def alike(task: int) -> int:
        return (most if task in accepted else -much) + (task in done)

    whole = algebra_meaning.tasks(best_branch(term, lacking))
    if set(whole) <= done:
        return whole
    return algebra_meaning.tasks(best_branch(term, alike))
