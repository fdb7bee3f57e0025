"""Elements of an argument in the Goal Structuring Notation (GSN community standard, version 3).

Names in YAML are those that gsn2x reads: the prefix of an id gives the kind.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from cratous.spec.mission.guarantees import Outcome


class Kind(StrEnum):
    """Kind of an element; the value is the prefix of its ids."""

    GOAL = "G"
    STRATEGY = "S"
    SOLUTION = "Sn"
    CONTEXT = "C"
    ASSUMPTION = "A"


class State(StrEnum):
    """State of a goal or strategy in this run. Any state other than supported is put before the text."""

    SUPPORTED = "supported"
    NOTHING = "nothing to check"
    NO_THEOREM = "no theorem"
    NO_GROUND = "without ground"
    NOT_PROVED = "not proved"
    EXCUSED = "excused"
    UNKNOWN = "unknown"
    VIOLATED = "violated"


WORSE = (State.VIOLATED, State.UNKNOWN, State.EXCUSED, State.NOT_PROVED, State.NO_GROUND)
"""States that a goal inherits from those below it, worst first. NOTHING and NO_THEOREM are not
inherited: such goals support nothing, and the parent goal has to hold without them.
"""
OF_VERDICT = {
    Outcome.HOLDS: State.SUPPORTED,
    Outcome.VIOLATED: State.VIOLATED,
    Outcome.UNKNOWN: State.UNKNOWN,
    Outcome.EXCUSED: State.EXCUSED,
}


@dataclass(frozen=True)
class Element:
    """One element. supported_by, in_context_of: ids; state: of goals and strategies, SUPPORTED for
    all others.

    A goal or strategy without supporting elements is undeveloped.
    """

    id: str
    kind: Kind
    text: str
    supported_by: tuple[str, ...] = ()
    in_context_of: tuple[str, ...] = ()
    state: State = State.SUPPORTED

    @property
    def undeveloped(self) -> bool:
        """Whether it has no supporting elements."""
        return self.kind in (Kind.GOAL, Kind.STRATEGY) and not self.supported_by

    @property
    def shown(self) -> str:
        """The text, preceded by its state unless it is supported."""
        return self.text if self.state is State.SUPPORTED else f"{self.state.upper()}: {self.text}"


def counted(number: int, what: str) -> str:
    """A count with its noun, as `1 call` or `2 calls`."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def worst(states: Iterable[State]) -> State:
    """The state of an element supported by all of these; NOTHING if none supports it."""
    found = set(states)
    for state in WORSE:
        if state in found:
            return state
    return State.SUPPORTED if State.SUPPORTED in found else State.NOTHING


class Argument:
    """The elements of an argument by id, in the order of addition, without duplicates."""

    def __init__(self) -> None:
        self.elements: dict[str, Element] = {}

    def add(self, element: Element) -> str:
        """Add an element unless it is already there; returns its id.

        RuntimeError if a different element has the id: this is a program error.
        """
        if self.elements.setdefault(element.id, element) != element:
            raise RuntimeError(f"two elements of the argument are called {element.id}")
        return element.id

    def state(self, name: str) -> State:
        """The state of an added goal, see `State`."""
        return self.elements[name].state
