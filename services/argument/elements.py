"""Elements of an argument in the Goal Structuring Notation (GSN community standard, version 3).

What they are called in YAML is what gsn2x reads: the beginning of an id says the kind.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from cratous.spec.mission.guarantees import Outcome


class Kind(StrEnum):
    """What an element is; the value is how its ids begin."""

    GOAL = "G"
    STRATEGY = "S"
    SOLUTION = "Sn"
    CONTEXT = "C"
    ASSUMPTION = "A"


class State(StrEnum):
    """How a goal, or all below a strategy, stands in this run. What is not supported is said before anything else of the text."""

    SUPPORTED = "supported"
    NOTHING = "nothing to check"
    NO_THEOREM = "no theorem"
    NO_GROUND = "without ground"
    NOT_PROVED = "not proved"
    EXCUSED = "excused"
    UNKNOWN = "unknown"
    VIOLATED = "violated"


WORSE = (State.VIOLATED, State.UNKNOWN, State.EXCUSED, State.NOT_PROVED, State.NO_GROUND)
"""What a goal takes over from those below it, the worst first. NOTHING and NO_THEOREM it does not: they
support nothing, and the goal has to stand without them."""
OF_VERDICT = {
    Outcome.HOLDS: State.SUPPORTED,
    Outcome.VIOLATED: State.VIOLATED,
    Outcome.UNKNOWN: State.UNKNOWN,
    Outcome.EXCUSED: State.EXCUSED,
}


@dataclass(frozen=True)
class Element:
    """One element. supported_by, in_context_of: ids; state: of goals and strategies, SUPPORTED for all else.

    A goal or strategy with nothing below it is undeveloped.
    """

    id: str
    kind: Kind
    text: str
    supported_by: tuple[str, ...] = ()
    in_context_of: tuple[str, ...] = ()
    state: State = State.SUPPORTED

    @property
    def undeveloped(self) -> bool:
        """Whether nothing below it supports it."""
        return self.kind in (Kind.GOAL, Kind.STRATEGY) and not self.supported_by

    @property
    def shown(self) -> str:
        """The text with its state before it, unless it is supported."""
        return self.text if self.state is State.SUPPORTED else f"{self.state.upper()}: {self.text}"


def counted(number: int, what: str) -> str:
    """A number and what there is of it, as `1 call` or `2 calls`."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def worst(states: Iterable[State]) -> State:
    """The state of what rests on all of these; NOTHING where not one of them supports it."""
    found = set(states)
    for state in WORSE:
        if state in found:
            return state
    return State.SUPPORTED if State.SUPPORTED in found else State.NOTHING


class Argument:
    """The elements of an argument by id, each once, in the order in which they were added."""

    def __init__(self) -> None:
        self.elements: dict[str, Element] = {}

    def add(self, element: Element) -> str:
        """Add an element, or find the same one again; returns its id.

        RuntimeError if another element has the id: what made them is wrong.
        """
        if self.elements.setdefault(element.id, element) != element:
            raise RuntimeError(f"two elements of the argument are called {element.id}")
        return element.id

    def state(self, name: str) -> State:
        """The state of a goal that was added, see `State`."""
        return self.elements[name].state
