"""The life of one automation request, as whoever sent it sees it.

A request is taken, published as UniqueAutomationRequest when its turn comes, and answered once: by
a response, by an error, or because its time ran out. Of two requests the one taken first is
published first, and the second is not published before the first is answered, so that at most one
is being planned. Everything else is WRONG, and stays so. Source: Rasmussen, Kingston, Humphrey,
"A Brief Introduction to Unmanned Systems Autonomy Services (UxAS)", ICUAS 2018, VI.B.1.
"""

from typing import NamedTuple

NEW, TAKEN, PUBLISHED, ANSWERED, WRONG = 0, 1, 2, 3, 4
"""Stages of a request. What can happen to it bears the number of the stage that it leads to."""


class Pair(NamedTuple):
    """The stages of two requests, of which the first was taken first."""

    first: int
    second: int


def after(stage: int, happening: int) -> int:
    """The stage after something happened to the request (0: nothing did)."""
    if happening == 0:
        return stage
    if stage == NEW and happening == TAKEN:
        return TAKEN
    if stage == TAKEN and happening == PUBLISHED:
        return PUBLISHED
    if stage == PUBLISHED and happening == ANSWERED:
        return ANSWERED
    return WRONG


def means(act: int) -> int:
    """What an act of the line (taken, published, passed on, given up) is for its request.

    An answer that is passed on (3) and one that says that the time ran out (4) are both answers.
    """
    if act == 4:
        return ANSWERED
    if act >= TAKEN and act <= ANSWERED:
        return act
    return 0


def in_order(pair: Pair) -> bool:
    """Neither has gone wrong, and the second has not been published before the first's answer."""
    lived = pair.first != WRONG and pair.second != WRONG
    return lived and (pair.second == NEW or pair.second == TAKEN or pair.first == ANSWERED)


def steps_left(ahead: int, being_planned: bool) -> int:
    """How many publications and answers a request waits for, with so many unanswered before it."""
    if being_planned:
        return 2 * ahead + 1
    return 2 * ahead + 2
