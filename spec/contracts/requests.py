"""The life cycle of one automation request, as its sender sees it.

A request is taken, published as UniqueAutomationRequest when its turn comes, and answered once: by a response, by an
error, or by a timeout. Of two requests, the one taken first is published first, and the second is not published
before the first is answered, so that at most one is being planned. Any other sequence is WRONG, which is final.
Source: Rasmussen, Kingston, Humphrey, "A Brief Introduction to Unmanned Systems Autonomy Services (UxAS)", ICUAS
2018, VI.B.1.
"""

from typing import NamedTuple

NEW, TAKEN, PUBLISHED, ANSWERED, WRONG = 0, 1, 2, 3, 4
"""Stages of a request. Each event has the number of the stage that it leads to."""


class Pair(NamedTuple):
    """The stages of two requests, the first of which was taken first."""

    first: int
    second: int


def after(stage: int, happening: int) -> int:
    """The stage after an event of the request (0: none)."""
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
    """The event that an act of the request queue (taken, published, passed on, given up) is for its request.

    An answer that is passed on (3) and one that reports a timeout (4) are both answers.
    """
    if act == 4:
        return ANSWERED
    if act >= TAKEN and act <= ANSWERED:
        return act
    return 0


def in_order(pair: Pair) -> bool:
    """No error has occurred, and the second request was not published before the first was answered."""
    lived = pair.first != WRONG and pair.second != WRONG
    return lived and (pair.second == NEW or pair.second == TAKEN or pair.first == ANSWERED)


def steps_left(ahead: int, being_planned: bool) -> int:
    """The number of publications and answers that a request waits for, with `ahead` unanswered requests before it."""
    if being_planned:
        return 2 * ahead + 1
    return 2 * ahead + 2
