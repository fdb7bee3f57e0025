"""The plan builder's progress with one request: which task is queried next, and when it answers.

Definitions: `spec.contracts.building`. Stages: 0 awaits the assignment, 1 builds, 2 answered.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Building(NamedTuple):
    """stage; parts: number of parts of the assignment; at: the part requested last."""

    stage: int
    parts: int
    at: int


class Built(NamedTuple):
    """The progress afterwards, and what to do.

    act: 0 nothing, 1 request part `part`, 2 answer with the plan, 3 answer with an error, 4 report an unexpected
    message; done: part `part` has just been built.
    """

    building: Building
    act: int
    part: int
    done: bool


@kernel(supports="parts_in_order")
def building_step(b: Building, event: int, number: int) -> Built:
    """One step.

    event: 1 the assignment of `number` parts, 2 part `number` was built, 3 it failed. An empty assignment is answered
    with an error. Parts are numbered from 0, at most 2^60 of them.
    """
    if event == 1 and b.stage == 0:
        if number < 1 or number > 1152921504606846976:
            return Built(Building(2, 0, 0), 3, 0, False)
        return Built(Building(1, number, 0), 1, 0, False)
    if event == 2 and b.stage == 1 and number == b.at:
        if b.at + 1 < b.parts:
            return Built(Building(1, b.parts, b.at + 1), 1, b.at + 1, True)
        return Built(Building(2, b.parts, b.at), 2, b.at, True)
    if event == 3 and b.stage < 2:
        return Built(Building(2, b.parts, b.at), 3, b.at, False)
    return Built(b, 4, number, False)


@kernel(implements="contracts.building.after")
def part_after(stage: int, asked: bool, built: bool) -> int:
    """The stage of one part after it was requested, or built, or neither: 3 if that is an error."""
    if not asked and not built:
        return stage
    if asked and not built and stage == 0:
        return 1
    if built and not asked and stage == 1:
        return 2
    return 3


@kernel(supports="parts_in_order")
def part_seen(stage: int, part: int, act: int, asked: int, done: bool, built: int) -> int:
    """The stage of part `part` after a step that requested `asked` (if act is 1) and built `built`."""
    return part_after(stage, act == 1 and asked == part, done and built == part)


@kernel(implements="contracts.building.in_order")
def parts_orderly(first: int, second: int, due: bool, again: bool) -> bool:
    """Whether two parts are in order.

    due: the request was answered with a plan, which must contain both; again: it was answered twice.
    """
    if again or first == 3 or second == 3:
        return False
    if second != 0 and first != 2:
        return False
    return second == 2 or not due


class WatchedParts(NamedTuple):
    """A builder's progress, the stages of two of its parts, and its answers."""

    stage: int
    parts: int
    at: int
    first: int
    second: int
    planned: bool
    failed: bool
    held: bool


@kernel(implements="contracts.building.in_order")
def watched_parts_step(
    w: WatchedParts, event: int, number: int, one: int, other: int
) -> WatchedParts:
    """One step, observing the parts `one` and `other`."""
    b, act, part, done = building_step(Building(w.stage, w.parts, w.at), event, number)
    first = part_seen(w.first, one, act, part, done, number)
    second = part_seen(w.second, other, act, part, done, number)
    planned = w.planned or act == 2
    failed = w.failed or act == 3
    again = (w.planned or w.failed) and (act == 2 or act == 3)
    held = w.held and parts_orderly(first, second, planned and other < b.parts, again)
    return WatchedParts(b.stage, b.parts, b.at, first, second, planned, failed, held)


@kernel(supports="parts_in_order")
def watched_parts_result(w: WatchedParts) -> bool:
    """Whether everything was in order throughout."""
    return w.held


parts_in_order = fold(
    name="parts_in_order",
    implements="contracts.building.in_order",
    step=watched_parts_step,
    start=WatchedParts(0, 0, 0, 0, 0, False, False, True),
    finish=watched_parts_result,
)
