"""Which entry of a list was in force at an instant, and which was the first by then: who commanded, what failed
first.

Definitions: `spec.authority.blame`. Integers, milliseconds.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Stood(NamedTuple):
    """The time of the entry in force [ms], and its index in the list, -1 if there is none."""

    since: int
    place: int


@kernel(supports="stood_at")
def stood_step(stood: Stood, time: int, place: int, at: int) -> Stood:
    """Add an entry. time: of the entry [ms]; place: its index in the list; at: the instant [ms]."""
    if time > at or time < stood.since:
        return stood
    return Stood(time, place)


stood_at = fold(
    name="stood_at",
    implements="authority.blame.stood_step",
    step=stood_step,
    start=Stood(-(2**62), -1),
)


class Broke(NamedTuple):
    """The time of the first entry by the instant [ms], and its index in the list, -1 if there is none."""

    since: int
    place: int


@kernel(supports="broke_first")
def broke_step(broke: Broke, since: int, place: int, at: int) -> Broke:
    """Add an entry. since: its time [ms]; place: its index in the list; at: the instant [ms]."""
    if since > at or since >= broke.since:
        return broke
    return Broke(since, place)


broke_first = fold(
    name="broke_first",
    implements="authority.blame.broke_step",
    step=broke_step,
    start=Broke(2**62, -1),
)
