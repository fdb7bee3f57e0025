"""Which entry of a list stood at an instant, and which came first by then: who commanded, what broke first.

Definitions: `spec.authority.blame`. Integers, milliseconds.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Stood(NamedTuple):
    """When the entry that stands was told [ms], and its place in the list, -1 if none stands."""

    since: int
    place: int


@kernel(supports="stood_at")
def stood_step(stood: Stood, time: int, place: int, at: int) -> Stood:
    """An entry more. time: when it was told [ms]; place: its number in the list; at: the instant [ms]."""
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
    """When the first entry by the instant was [ms], and its place in the list, -1 if none was."""

    since: int
    place: int


@kernel(supports="broke_first")
def broke_step(broke: Broke, since: int, place: int, at: int) -> Broke:
    """An entry more. since: when it was [ms]; place: its number in the list; at: the instant [ms]."""
    if since > at or since >= broke.since:
        return broke
    return Broke(since, place)


broke_first = fold(
    name="broke_first",
    implements="authority.blame.broke_step",
    step=broke_step,
    start=Broke(2**62, -1),
)
