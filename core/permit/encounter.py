"""How often one vehicle's ICAROUS takes over because of one intruder, as transition kernels.

After a handback the path that is flown is permitted against the intruder until an instant. Until then there is no
takeover because of it; one follows only if the permit no longer covers what is observed (a surprise), or has ended.
Definitions: `spec.permit.encounter`.
"""

from typing import NamedTuple

from cratous.core.kernel import kernel


class Encounter(NamedTuple):
    """takeovers: number because of the intruder; surprises, ended: number of permits that ended because of an event
    they did not cover, and because their time was over; avoiding: a takeover because of it is in progress; permitted:
    the path that UxAS flies is permitted against it until expiry_ms [ms].
    """

    takeovers: int
    surprises: int
    ended: int
    avoiding: bool
    permitted: bool
    expiry_ms: int


class Watched(NamedTuple):
    """The encounter afterwards, and whether ICAROUS takes over because of the intruder."""

    encounter: Encounter
    acts: bool


@kernel(implements="permit.encounter.is_after_look")
def encounter_looked(before: Encounter, allowed: bool, now: int) -> Encounter:
    """At a heartbeat under UxAS. allowed: what is seen now is what was permitted, or is permitted too; now: [ms]."""
    if not before.permitted:
        return before
    if now >= before.expiry_ms:
        return Encounter(
            before.takeovers, before.surprises, before.ended + 1, before.avoiding, False, 0
        )
    if not allowed:
        return Encounter(
            before.takeovers, before.surprises + 1, before.ended, before.avoiding, False, 0
        )
    return before


@kernel(implements="permit.encounter.is_after_watch")
def encounter_watched(before: Encounter, foreseen: bool) -> Watched:
    """At a heartbeat under UxAS, after `encounter_looked`. foreseen: a conflict with the intruder is predicted on
    which ICAROUS must act.
    """
    if not foreseen or before.permitted or before.avoiding:
        return Watched(before, False)
    taken = before.takeovers + 1
    return Watched(Encounter(taken, before.surprises, before.ended, True, False, 0), True)


@kernel(implements="permit.encounter.is_after_handback")
def encounter_resumed(before: Encounter, allowed: bool, expiry: int) -> Encounter:
    """UxAS has the vehicle again. allowed: the path that it flies is permitted, until expiry [ms]; if not, that too
    is a surprise, since control is offered only on a path that is.
    """
    if allowed:
        return Encounter(before.takeovers, before.surprises, before.ended, False, True, expiry)
    if before.avoiding or before.permitted:
        return Encounter(before.takeovers, before.surprises + 1, before.ended, False, False, 0)
    return before
