"""Which slots a member grants, as transition kernels. Definitions: `spec.merging.grants`.

For each request of a vehicle a member grants at most one time, apart from the times last granted to all other
vehicles, whatever one or several leaders propose. So any two slots with a majority are apart.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Grant(NamedTuple):
    """The last slot that a member granted to a vehicle. request: its number, 0 for none yet; time: at the fix [ms]."""

    request: int
    time: int


class Answer(NamedTuple):
    """grant: the grant afterwards; yes: whether the proposed slot is granted."""

    grant: Grant
    yes: bool


@kernel(implements="merging.grants.all_leave_room", nonnegative=("separation",))
def room_beside(so_far: bool, request: int, time: int, asked: int, separation: int) -> bool:
    """Whether the time also leaves room for one more of the other vehicles.

    so_far: the result for those before; request, time: that vehicle's `Grant`; asked: the proposed time at the
    fix [ms]; separation: least time between two slots [ms], >= 0.
    """
    return so_far and (request == 0 or asked - time >= separation or time - asked >= separation)


has_room = fold(
    name="has_room", implements="merging.grants.leaves_room", step=room_beside, start=True
)


@kernel(implements="merging.grants.is_after_proposal")
def grant_asked(grant: Grant, asked: Grant, room: bool) -> Answer:
    """The answer to a slot proposed for a vehicle.

    grant: the vehicle's grant so far; asked: the proposed slot, request > 0; room: it is apart from the grants of
    all other vehicles (`has_room`).
    """
    if asked.request > grant.request and room:
        return Answer(asked, True)
    same = asked.request == grant.request and asked.time == grant.time
    return Answer(grant, same and asked.request != 0)
