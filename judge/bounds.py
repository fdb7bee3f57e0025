"""Time windows and their reference times, and order and timing constraints in the words of a report."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from cratous.judge.algebra import Term, Window


def bounded(term: Term, outer: Window | None) -> Term:
    """The term inside an outer window, which applies if the term has none of its own."""
    if outer is None or (term.window and not counts_from_before(term)):
        return term  # its own window is the inner one, and applies to all of it
    return Term("|", 0, (term,), outer) if term.window else replace(term, window=outer)


def counts_from_before(term: Term) -> bool:
    """Whether its window does not apply to the first operand."""
    return term.window is not None and term.window.relative and term.operator in (".", "~")


def quoted(term: Term) -> str:
    """A term as quoted in reports: long ones are shortened in the middle."""
    text = str(term)
    return f"`{text}`" if len(text) <= 64 else f"`{text[:40]}…{text[-20:]}`"


def event(operator: str, before: Term) -> str:
    """The event for which a later operand waits, in the words of a report."""
    verb, which = ("ends", "last") if operator == "." else ("starts", "first")
    names = [f"p{task}" for task in before.tasks()]
    if len(names) == 1:
        return f"{names[0]} {verb}"
    return f"the {which} of {' '.join(names[:8])}{' …' if len(names) > 8 else ''} {verb}"


class Bound(NamedTuple):
    """The bound of a task. ref_ms: reference time of the window, None: never reached; since: the
    reference in the words of a report, empty for the mission's start.
    """

    term: Term
    ref_ms: int | None
    window: Window
    since: str = ""

    def parts(self, task: int) -> tuple[str, str]:
        """Its constraints on the start and the end of a task, in the words of a report."""
        said, first, last = quoted(self.term), self.window.first, self.window.last
        if self.since:
            return (
                f"{said}: p{task} starts at least {first} ms after {self.since}",
                f"{said}: p{task} ends at most {last} ms after {self.since}",
            )
        return (
            f"{said}: p{task} starts at {first} ms or later",
            f"{said}: p{task} ends at {last} ms or earlier",
        )
