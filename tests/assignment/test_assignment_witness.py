"""A schedule judged on its own numbers is judged as z3 judges it, right ones and wrong ones."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace

import pytest

from cratous.services.planning.assign import solve
from cratous.services.planning.assign_certificate import certified, verify
from cratous.services.planning.assign_solvers import schedule_holds
from cratous.services.planning.assign_witness import witnessed
from cratous.spec.assignment.search import ORDER, AssignmentProblem, Choice, Step
from cratous.spec.errors import BadInput


def problem(relations: str, **more: object) -> AssignmentProblem:
    """Three tasks on a line, two vehicles; the second can do tasks 1 and 3 alone."""
    able = {1: (1, 2), 2: (1,), 3: (1, 2)}
    choices = tuple(Choice(t, 1, 5, able[t], lap_ms=20, lap_max_ms=23) for t in able)
    table = tuple(tuple(10 * abs(a - b) for b in able) for a in (*able, 0))
    made = AssignmentProblem("line", (1, 2), (0, 3), choices, (table, table), relations)
    return replace(made, **more)  # type: ignore[arg-type]


PROBLEMS = {
    "any order": problem(""),
    "a sequence in a window": problem("|(.(p3 p1) p2)_[0-200]"),
    "a wait between two": problem("|(.(p2 p1)-[30-300] p3)"),
    "one branch": problem("+(.(p1 p2) ~(p3 p1))"),
    "releases and due times": problem("~(p1 p2 p3)", release_ms=((2, 47),), due_ms=((1, 300),)),
    "by order alone": problem(".(p3 |(p1 p2))", semantics=ORDER),
    "one task is flown": problem(".(p9 |(p1 p2 p3))", done=((9, 0, 31),)),
}


def others(steps: Sequence[Step]) -> Iterator[tuple[Step, ...]]:
    """Schedules beside one: a step at another time, of another length, by another vehicle, or elsewhere."""
    for n, step in enumerate(steps):
        for change in (
            {"start_ms": step.start_ms - 1, "end_ms": step.end_ms - 1},
            {"start_ms": step.start_ms + 21, "end_ms": step.end_ms + 21},
            {"end_ms": step.end_ms + 1},
            {"vehicle_id": 3 - step.vehicle_id},
        ):
            yield (*steps[:n], replace(step, **change), *steps[n + 1 :])
    yield tuple(reversed(steps))


@pytest.mark.parametrize("name", PROBLEMS)
def test_numbers_say_what_z3_says(name: str) -> None:
    p = PROBLEMS[name]
    steps = solve(p).steps
    assert witnessed(p, steps)
    assert schedule_holds(p, steps)[0]
    for other in others(steps):
        try:
            right, _ = schedule_holds(p, other)
        except BadInput:  # of no branch
            continue
        assert witnessed(p, other) == right, other


def test_what_fails_is_still_named_by_its_words() -> None:
    p = PROBLEMS["releases and due times"]
    _, body = certified(p, solve(p))
    assert verify(body).wrong == ""
    early = replace(p, release_ms=((2, 900),))
    assert not witnessed(early, solve(p).steps)
    assert schedule_holds(early, solve(p).steps) == (False, "task 2 is released at 900 ms")


def test_a_right_schedule_is_checked_without_a_solver() -> None:
    code = (
        "import sys\n"
        "from pathlib import Path\n"
        "from cratous.services.planning.assign import solve\n"
        "from cratous.services.planning.assign_certificate import certified, verify\n"
        "from cratous.spec.assignment.search import AssignmentProblem, Choice\n"
        "p = AssignmentProblem('one', (1,), (0,), (Choice(1, 1, 5, (1,)),), (((0,), (7,)),), '')\n"
        "found, body = certified(p, solve(p))\n"
        "assert (verify(body).wrong, found.cost) == ('', 12)\n"
        "assert 'z3' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=300)
