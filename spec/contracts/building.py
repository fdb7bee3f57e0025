"""Turning an assignment into plans: each task is asked in assignment order, and one answer is given.

A task's part begins where the part before it ends, so the next task is asked only when the one
before has answered. Source: Rasmussen et al., ICUAS 2018, VI.B.6.
"""

from typing import NamedTuple

UNASKED, ASKED, BUILT, WRONG = 0, 1, 2, 3
"""Stages of one task's part. What can happen to it bears the number of the stage it leads to."""


class Parts(NamedTuple):
    """The stages of two parts, of which the first was assigned first, and how often the request
    was answered: with a plan, or with an error."""

    first: int
    second: int
    plans: int
    errors: int


def after(stage: int, happening: int) -> int:
    """The stage of a part after something happened to it (0: nothing did)."""
    if happening == 0:
        return stage
    if stage == UNASKED and happening == ASKED:
        return ASKED
    if stage == ASKED and happening == BUILT:
        return BUILT
    return WRONG


def in_order(parts: Parts) -> bool:
    """Nothing has gone wrong, the second was not asked before the first was built, and there is at
    most one answer, a plan only with both parts built."""
    lived = parts.first != WRONG and parts.second != WRONG
    ordered = parts.second == UNASKED or parts.first == BUILT
    once = parts.plans + parts.errors <= 1
    return lived and ordered and once and (parts.plans == 0 or parts.second == BUILT)
