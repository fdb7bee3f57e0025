"""Building plans from an assignment: tasks are queried in assignment order, and one answer is given.

A task's part begins where the part before it ends, so the next task is queried only when the one before has answered.
Source: Rasmussen et al., ICUAS 2018, VI.B.6.
"""

from typing import NamedTuple

UNASKED, ASKED, BUILT, WRONG = 0, 1, 2, 3
"""Stages of one task's part. Each event has the number of the stage that it leads to."""


class Parts(NamedTuple):
    """The stages of two parts, the first of which was assigned first, and how often the request was answered: with a
    plan, or with an error.
    """

    first: int
    second: int
    plans: int
    errors: int


def after(stage: int, happening: int) -> int:
    """The stage of a part after an event (0: none)."""
    if happening == 0:
        return stage
    if stage == UNASKED and happening == ASKED:
        return ASKED
    if stage == ASKED and happening == BUILT:
        return BUILT
    return WRONG


def in_order(parts: Parts) -> bool:
    """No error has occurred, the second part was not queried before the first was built, and there is at most one
    answer; it is a plan only if both parts are built.
    """
    lived = parts.first != WRONG and parts.second != WRONG
    ordered = parts.second == UNASKED or parts.first == BUILT
    once = parts.plans + parts.errors <= 1
    return lived and ordered and once and (parts.plans == 0 or parts.second == BUILT)
