"""The guarantees of CRATOUS for the vehicles that a mission declares protected.

The five guarantees, their sentences, and the content of a verdict on one of them. An unprotected vehicle is listed as
not covered; switching avoidance off removes no requirement.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any


@dataclass(frozen=True)
class Requirement:
    """A requirement: id, title and the sentence that reports print."""

    id: str
    title: str
    text: str


REQUIREMENTS = (
    Requirement(
        "G1",
        "Constraints",
        "No zone, order, timing or eligibility constraint is violated if a way exists that "
        "violates none.",
    ),
    Requirement(
        "G2",
        "Well clear",
        "Well clear is not lost, and nothing collides, if avoidance is possible.",
    ),
    Requirement(
        "G3",
        "Completion",
        "The mission completes in finite time, and complete means that every task that it asks "
        "for was served.",
    ),
    Requirement(
        "G4",
        "Authority",
        "Exactly one of UxAS and ICAROUS commands a vehicle at any time, and every takeover ends "
        "in a handback or a declared failure.",
    ),
    Requirement(
        "G5",
        "Bridge",
        "The bridge is alive (heartbeats at their period, bounded delay) or the vehicle acts "
        "safely alone.",
    ),
)


class Outcome(StrEnum):
    """The four verdicts. Unknown never counts as success; excused requires evidence."""

    HOLDS = "holds"
    VIOLATED = "violated"
    UNKNOWN = "unknown"
    EXCUSED = "excused"


class Kind(StrEnum):
    """The strength of a verdict: exact for the given doubles, enclosed by intervals, over the reals, or observed."""

    EXACT = "exact"
    OBSERVED = "observed"
    REAL_ONLY = "real-only"


@dataclass(frozen=True)
class Verdict:
    """A verdict on one requirement or one constraint.

    requirement: G1 to G5; item: the constraint (empty for the whole requirement); time_ms: first violation, or the
    time of the smallest margin; margin: in `unit`, negative when violated, None if there is no measure; checks:
    number of single checks made; method: how it was decided, in words; evidence: the basis of an excuse, or of its
    refusal, as plain data; kernels: qualified names of the kernels, folds and drivers that decided it, empty if the
    messages did.
    """

    requirement: str
    item: str
    outcome: Outcome
    kind: Kind
    note: str
    time_ms: int | None = None
    vehicles: tuple[int, ...] = ()
    margin: float | None = None
    unit: str = ""
    checks: int = 0
    method: str = ""
    evidence: dict[str, Any] | None = None
    kernels: tuple[str, ...] = ()


def worst(outcomes: list[Outcome]) -> Outcome:
    """The combined verdict: violated before unknown before excused before holds."""
    for outcome in (Outcome.VIOLATED, Outcome.UNKNOWN, Outcome.EXCUSED):
        if outcome in outcomes:
            return outcome
    return Outcome.HOLDS if outcomes else Outcome.UNKNOWN


def exit_code(outcomes: list[Outcome], *, unproved: bool = False) -> int:
    """0: all hold; 1: something is violated; 3: something is unknown or excused. unproved: kernels without a proof
    took part, whose verdict is at best unknown.
    """
    whole = worst([*outcomes, Outcome.UNKNOWN] if unproved else outcomes)
    if whole is Outcome.HOLDS:
        return 0
    return 1 if whole is Outcome.VIOLATED else 3
