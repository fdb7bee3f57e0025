"""Breadth-first search for the shortest trace to a fault, within a bound that the result states."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from typing import Any, NamedTuple, Protocol

from cratous.spec.errors import BadInput

MOST_STATES = 2_000_000


class Composition(Protocol):
    """A design to search: states with `returned`, and steps with `entry`, `after` and `wrong`."""

    def first(self) -> Any:
        """The initial state."""

    def steps(self, state: Any) -> Iterator[Any]:
        """All possible next steps."""


class Found(NamedTuple):
    """trace: the events up to the fault, or empty; wrong: the fault.

    states: the number of states visited; complete: every state within the bound was visited; back: the shortest trace
    to a state with `returned` (UxAS flies again after ICAROUS has flown), or empty.
    """

    trace: tuple[Any, ...]
    wrong: str
    states: int
    complete: bool
    back: tuple[Any, ...]

    @property
    def returned(self) -> bool:
        """Whether some state was reached in which authority or certainty has been regained."""
        return bool(self.back)


def search(design: Composition, most_steps: int, most_states: int = 100_000) -> Found:
    """The shortest trace of at most `most_steps` steps to a fault of this design.

    Raises BadInput if a bound is not positive or above what memory allows.
    """
    for name, value, most in (
        ("most_steps", most_steps, 100),
        ("most_states", most_states, MOST_STATES),
    ):
        if not 1 <= value <= most:
            raise BadInput(
                "the bound is out of range", item=name, expected=f"1 to {most}", got=str(value)
            )
    first = design.first()
    came: dict[Hashable, tuple[Any, Any] | None] = {first: None}
    edge, back = [first], tuple[Any, ...]()
    for _ in range(most_steps):
        later: list[Any] = []
        for state in edge:
            for step in design.steps(state):
                if step.wrong:
                    trace = (*_way(came, state), step.entry)
                    return Found(trace, step.wrong, len(came), False, back)
                if step.after not in came:
                    if len(came) >= most_states:
                        return Found((), "", len(came), False, back)
                    came[step.after] = (state, step)
                    later.append(step.after)
                    if step.after.returned and not back:
                        back = _way(came, step.after)
        edge = later
    return Found((), "", len(came), True, back)


def _way(came: dict[Hashable, tuple[Any, Any] | None], state: Any) -> tuple[Any, ...]:
    """The events on the path to a state, in order."""
    found: list[Any] = []
    at = came[state]
    while at is not None:
        found.append(at[1].entry)
        at = came[at[0]]
    return tuple(reversed(found))
