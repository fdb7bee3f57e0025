"""The meaning of a task's Composition: any term of the process algebra over its options.

A task whose composition is a choice of one option is one task of the assignment. For any other, each option
becomes a task, and the composition replaces the task in the relations: the assignment then does exactly the
options that the composition requires, in its order, with any vehicles.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import count
from typing import Any, NamedTuple

from cratous.services.planning.inputs import Inputs
from cratous.spec import algebra
from cratous.spec.errors import BadInput
from cratous.spec.mission import TaskKind

Pair = tuple[int, int]
"""(task, option)."""


class Split(NamedTuple):
    """Inputs in which options are tasks, and the ids of these tasks; no ids if there are none."""

    inputs: Inputs
    ids: Mapping[Pair, int]

    @property
    def pairs(self) -> dict[int, Pair]:
        """The (task, option) of each id."""
        return {number: pair for pair, number in self.ids.items()}

    def told(self, text: str) -> str:
        """A reason with these ids replaced by the original tasks and options."""
        pairs = self.pairs

        def named(match: re.Match[str]) -> str:
            pair = pairs.get(int(match[2]))
            return match[0] if pair is None else f"{match[1]}{pair[0]} (option {pair[1]})"

        return re.sub(r"\b(task |p)(\d+)\b", named, text)


def composition(told: Any) -> algebra.Term | None:
    """The composition in TaskPlanOptions, None without options; BadInput if it does not name exactly the
    options.
    """
    item = f"TaskPlanOptions of task {told.TaskID}"
    listed = {option.OptionID for option in told.Options}
    if not told.Composition.strip() and not listed:
        return None
    term = algebra.parse(told.Composition, where=item)
    if {atom.task for atom in algebra.atoms(term)} == listed:
        return term
    raise BadInput(
        "this is no composition of the options that are offered",
        where=item,
        item="Composition",
        expected="each of " + " ".join(f"p{n}" for n in sorted(listed)),
        got=told.Composition,
    )


def is_choice(term: algebra.Term | None) -> bool:
    """Whether a term is a choice among single options, however nested, without timing."""
    if term is None:
        return True
    if term.suffix is not None:
        return False
    if isinstance(term, algebra.Atom):
        return True
    one = len(term.operands) == 1 or term.op == algebra.ALTERNATIVE
    return one and all(is_choice(part) for part in term.operands)


def split(inputs: Inputs, composed: Mapping[int, algebra.Term]) -> Split:
    """The inputs with each option of the composed tasks as a task, related as the compositions require."""
    if not composed:
        return Split(inputs, {})
    mission = inputs.mission
    free = count(max(task.id for task in mission.tasks) + 1)
    ids = {
        (task, atom.task): next(free) for task in composed for atom in algebra.atoms(composed[task])
    }
    terms = {task: _renamed(composed[task], task, ids) for task in composed}
    tasks = [task for task in mission.tasks if task.id not in composed]
    tasks += [
        replace(mission.task(task), id=number, kind=TaskKind.OTHER)
        for (task, _), number in ids.items()
    ]
    relations = algebra.format_term(_substituted(inputs.term, terms))
    made = replace(mission, tasks=tuple(tasks), relations=relations)
    return Split(replace(inputs, mission=made), ids)


def _renamed(term: algebra.Term, task: int, ids: Mapping[Pair, int]) -> algebra.Term:
    if isinstance(term, algebra.Atom):
        return replace(term, task=ids[task, term.task])
    return replace(term, operands=tuple(_renamed(part, task, ids) for part in term.operands))


def _substituted(term: algebra.Term, terms: Mapping[int, algebra.Term]) -> algebra.Term:
    """The term with tasks replaced by terms; a task's timing then applies to its replacement."""
    if isinstance(term, algebra.Op):
        operands = tuple(_substituted(part, terms) for part in term.operands)
        return replace(term, operands=operands)
    made = terms.get(term.task)
    if made is None:
        return term
    return made if term.suffix is None else algebra.Op(algebra.PARALLEL, (made,), term.suffix)
