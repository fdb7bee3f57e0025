"""Which slots a member grants, as transition kernels. Definitions: `spec.merging.grants`.

Whatever a leader proposes, or several of them: a member grants a vehicle one time for each request, apart from all that
it has granted to others, so that slots for which there is a majority are apart.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Grant(NamedTuple):
    """The last that a member has granted to a vehicle. request: of which, 0 nothing yet; time: at the fix [ms]."""

    request: int
    time: int


class Answer(NamedTuple):
    """grant: afterwards; yes: what was proposed is."""

    grant: Grant
    yes: bool


@kernel(implements="merging.grants.all_leave_room", nonnegative=("separation",))
def room_beside(so_far: bool, request: int, time: int, asked: int, separation: int) -> bool:
    """With what is granted to one more of the other vehicles. request, time: as in `Grant`; asked: the time at the fix
    that is proposed [ms]; separation: between two of them [ms], >= 0."""
    return so_far and (request == 0 or asked - time >= separation or time - asked >= separation)


has_room = fold(
    name="has_room", implements="merging.grants.leaves_room", step=room_beside, start=True
)


@kernel(implements="merging.grants.is_after_proposal")
def grant_asked(grant: Grant, asked: Grant, room: bool) -> Answer:
    """A slot is proposed for a vehicle. asked: for which request, > 0, and when; room: it is apart from what is
    granted to all others (`has_room`)."""
    if asked.request > grant.request and room:
        return Answer(asked, True)
    same = asked.request == grant.request and asked.time == grant.time
    return Answer(grant, same and asked.request != 0)
