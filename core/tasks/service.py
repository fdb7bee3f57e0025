"""Whether a task of a flight was served. Definition: `spec.service.served_if`."""

from typing import NamedTuple

from cratous.core.kernel import kernel


class Watched(NamedTuple):
    """Observations of a task. ended: it was flown to its end; over: the flight has ended; unseen: part of what counts
    was not observed; short: too little of a search was seen; near: the vehicle came within its standoff distance;
    missed: what its location requires was not seen.
    """

    ended: bool
    over: bool
    unseen: bool
    short: bool
    near: bool
    missed: bool


@kernel(implements="service.served_if")
def service_verdict(seen: Watched) -> int:
    """0: the task was not served, 1: it was, 2: unknown."""
    if seen.near:
        return 0
    if not seen.ended:
        if seen.over:
            return 0
        return 2
    if seen.short:
        return 0
    if seen.unseen:
        return 2
    if seen.missed:
        return 0
    return 1
