"""The queue of automation requests: first come, first served, one at a time, each answered once.

A request gets the next ticket when it is taken; the ticket after the last answered one is next in turn. So two
counters, a flag and an instant represent a queue of any length. The service stores the requests by ticket, calls
`line_step` for every event, and does what the step returns. Definitions: `spec.contracts.requests`.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel

ARRIVAL, ANSWER, PUMP = 1, 2, 3
"""Events: a valid request arrives, a response or error arrives, time has passed."""
NOTHING, TAKE, PUBLISH, PASS_ON, GIVE_UP, LATE, FULL = 0, 1, 2, 3, 4, 5, 6
"""Acts of the service: nothing, store the request under its ticket, publish it, pass its answer on, answer with a
timeout, report an unexpected answer, refuse a request.
"""


class Line(NamedTuple):
    """taken: tickets issued; answered: number of them answered; busy: the next one is being planned, since sent_ms
    [ms].
    """

    taken: int
    answered: int
    busy: bool
    sent_ms: int


class Step(NamedTuple):
    """The queue afterwards, the act, and its ticket."""

    line: Line
    act: int
    ticket: int


@kernel(supports="requests_in_order")
def line_step(line: Line, event: int, ticket: int, now_ms: int, limit_ms: int) -> Step:
    """One step of the queue.

    event: 1 arrival, 2 answer (to `ticket`), 3 time has passed; now_ms: present instant [ms]; limit_ms: how long a
    request may be planned [ms]. An answer to any other ticket than the one that is being planned changes nothing.
    """
    if event == 1:
        # the counter must not overflow: 2^60 requests
        if line.taken >= 1152921504606846976:
            return Step(line, 6, line.taken)
        return Step(Line(line.taken + 1, line.answered, line.busy, line.sent_ms), 1, line.taken)
    if event == 2:
        if line.busy and ticket == line.answered:
            return Step(Line(line.taken, line.answered + 1, False, line.sent_ms), 3, ticket)
        return Step(line, 5, ticket)
    if event == 3 and line.busy:
        if now_ms - line.sent_ms >= limit_ms:
            return Step(Line(line.taken, line.answered + 1, False, line.sent_ms), 4, line.answered)
        return Step(line, 0, line.answered)
    if event == 3 and line.answered < line.taken:
        return Step(Line(line.taken, line.answered, True, now_ms), 2, line.answered)
    return Step(line, 0, line.answered)


@kernel(implements="contracts.requests.means")
def happening(act: int, about: int, ticket: int) -> int:
    """The event that a step's act, about one ticket, is for the request with that ticket: 0 if not its own."""
    if about != ticket:
        return 0
    if act == 1 or act == 2:
        return act
    if act == 3 or act == 4:
        return 3
    return 0


@kernel(implements="contracts.requests.after")
def stage_after(stage: int, what: int) -> int:
    """The stage of a request after an event; 4 if that event must not occur."""
    if what == 0:
        return stage
    if stage < 3 and what == stage + 1:
        return what
    return 4


class Watched(NamedTuple):
    """A queue, and the stages of two of its requests."""

    taken: int
    answered: int
    busy: bool
    sent_ms: int
    first: int
    second: int
    held: bool


@kernel(implements="contracts.requests.in_order")
def watched_step(
    w: Watched,
    event: int,
    ticket: int,
    now_ms: int,
    limit_ms: int,
    one: int,
    other: int,
) -> Watched:
    """One step of the queue, observing the tickets `one` and `other`."""
    line, act, about = line_step(
        Line(w.taken, w.answered, w.busy, w.sent_ms), event, ticket, now_ms, limit_ms
    )
    first = stage_after(w.first, happening(act, about, one))
    second = stage_after(w.second, happening(act, about, other))
    fine = first != 4 and second != 4 and (second < 2 or first == 3)
    return Watched(
        line.taken, line.answered, line.busy, line.sent_ms, first, second, w.held and fine
    )


@kernel(supports="requests_in_order")
def watched_result(w: Watched) -> bool:
    """Whether everything was in order throughout."""
    return w.held


requests_in_order = fold(
    name="requests_in_order",
    implements="contracts.requests.in_order",
    step=watched_step,
    start=Watched(0, 0, False, 0, 0, 0, True),
    finish=watched_result,
)
