"""Responses to predicted losses of well clear as a transition kernel, and whether a band contains a value.

Definitions: `spec.contracts.responses`. The service gathers the inputs of an instant (each decided by a kernel:
`gives_way` and `must_act`, `heading_blocked` and `value_blocked`, the leg kernels for zones) and does what
`response_step` returns.
"""

from typing import NamedTuple

from cratous.core.kernel import kernel


class Response(NamedTuple):
    """state: 0 on mission, 1 in conflict, 2 on hold, 3 right of way, 4 resume; off: the vehicle has
    been taken off its mission and is not back."""

    state: int
    off: bool


class Answer(NamedTuple):
    """The response afterwards, and what to do: 0 nothing, 1 command a manoeuvre, 2 continue the one being flown, 3
    refuse with the reasons, 4 leave it to the others, 5 command the mission.
    """

    response: Response
    act: int


@kernel(supports="response_step")
def manoeuvre_act(flown: bool, found: bool) -> int:
    """2 continue the manoeuvre being flown, 1 command one that was found, 3 refuse.

    flown: one is flown and is still free of conflict and of zones; found: there is one that is.
    """
    if flown:
        return 2
    if found:
        return 1
    return 3


@kernel(implements="contracts.responses.says_what_is_so")
def response_step(
    response: Response,
    conflict: bool,
    ours: bool,
    good: bool,
    found: bool,
    free: bool,
    lasted: bool,
    taken: bool,
) -> Answer:
    """One step.

    conflict: a loss is predicted soon; ours: this vehicle has to act; good: the manoeuvre that is flown is still free
    of zones and of conflicts that are ours; found: there is one that is free; free: so is the way back; lasted: for
    long enough; taken: the vehicle flies its mission.
    """
    if conflict and not ours:
        if response.off and not good:
            return Answer(Response(3, True), manoeuvre_act(False, found))
        return Answer(Response(3, response.off), 4)
    if conflict:
        act = manoeuvre_act(response.off and good, found)
        return Answer(Response(1, response.off or act == 1), act)
    if not response.off or (response.state == 4 and taken):
        return Answer(Response(0, False), 0)
    if free and lasted:
        return Answer(Response(4, True), 5)
    if free and response.state == 4:
        return Answer(Response(4, True), 0)
    return Answer(Response(2, True), manoeuvre_act(good, found))


@kernel(implements="contracts.responses.in_band")
def heading_blocked(heading_deg: float, low_deg: float, high_deg: float) -> bool:
    """True iff a heading in [0, 360) lies in an interval within [0, 360], ends included [deg]."""
    if heading_deg == 0 and high_deg == 360:
        return True
    return low_deg <= heading_deg and heading_deg <= high_deg


@kernel(implements="contracts.responses.apart")
def value_blocked(value: float, low: float, high: float) -> bool:
    """True iff a value lies in an interval, ends included; m/s or m."""
    return low <= value and value <= high


@kernel(implements="contracts.responses.soon")
def loss_is_soon(first_s: float, limit_s: float, early_s: float, answering: bool) -> bool:
    """True iff a predicted loss is a conflict: within the alerting time, or within the early alerting time during a
    conflict.

    first_s: when the loss begins [s]; limit_s, early_s: the alerting times [s]; answering: a conflict with this
    intruder was there at the last instant.
    """
    if answering:
        return first_s <= max(limit_s, early_s)
    return first_s <= limit_s
