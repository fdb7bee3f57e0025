"""Breadth-first search: the shortest way to a fault, within a bound that the answer states."""

from __future__ import annotations

from typing import NamedTuple

from cratous.proofs.system_search.authority import Design, State, steps
from cratous.spec.errors import BadInput

MOST_STATES = 2_000_000


class Found(NamedTuple):
    """trace: what happens up to the fault, or nothing; wrong: what is wrong then.

    states: how many were seen; complete: every state within the bound was; returned: whether in one of
    them UxAS flies again after ICAROUS has flown.
    """

    trace: tuple[str, ...]
    wrong: str
    states: int
    complete: bool
    returned: bool


def search(design: Design, most_steps: int, most_states: int = 100_000) -> Found:
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
    came: dict[State, tuple[State, str] | None] = {State(): None}
    edge, returned = [State()], False
    for _ in range(most_steps):
        later: list[State] = []
        for state in edge:
            for step in steps(design, state):
                if step.wrong:
                    trace = (*_way(came, state), step.text)
                    return Found(trace, step.wrong, len(came), False, returned)
                if step.after not in came:
                    if len(came) >= most_states:
                        return Found((), "", len(came), False, returned)
                    came[step.after] = (state, step.text)
                    later.append(step.after)
                    returned = returned or step.after.returned
        edge = later
    return Found((), "", len(came), True, returned)


def _way(came: dict[State, tuple[State, str] | None], state: State) -> tuple[str, ...]:
    """What happened on the way to a state, in order."""
    texts: list[str] = []
    at = came[state]
    while at is not None:
        texts.append(at[1])
        at = came[at[0]]
    return tuple(reversed(texts))
