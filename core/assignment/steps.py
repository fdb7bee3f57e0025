"""The steps of an assignment search, each a kernel: start times, dominance, capacity.

Integers, milliseconds after mission start. Definitions: `spec.assignment.search`. The compiled searches
(`core.assignment.refutation`, `core.assignment.tables`) and the checker of certificates
(`core.assignment.refutation_check`) call these same functions.
"""

from __future__ import annotations

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


@kernel(implements="assignment.search.may_start")
def earliest_start(free: int, travel: int, floor: int, ref: int) -> int:
    """The earliest instant at which a vehicle can start a task [ms].

    free: when it is free; travel: its leg to the task; floor: no task placed later starts before; ref: what order and
    timing rows demand. All in ms.
    """
    return max(max(free + travel, floor), ref)


@kernel(implements="assignment.search.leaves_in_time")
def latest_departure(due: int, after: int, release: int, duration: int, travel: int) -> int:
    """The latest departure [ms] from which a task, and then all that follows it, is on time.

    due: the task's latest end; after: latest departure from the task for what follows; release: its earliest start;
    duration, travel: of the task and of the leg to it. -2**60: there is none.
    """
    end = min(due, after)
    if release + duration > end:
        return -1152921504606846976
    return end - duration - travel


@kernel(implements="assignment.search.work_is_done")
def room_step(room: int, until: int, free: int) -> int:
    """Add one vehicle's remaining time, if any, to the capacity for work until an instant.

    room: of the vehicles so far [ms]; until: the instant; free: when the vehicle is free [ms].
    """
    return room + max(0, until - free)


@kernel(implements="assignment.search.all_is_done")
def lacks_room(room: int, work: int) -> bool:
    """True iff the work [ms] exceeds the capacity `room` [ms]."""
    return room < work


@kernel(implements="assignment.search.task_may_end")
def soonest_end(soonest: int, head: int, least: int) -> int:
    """The earliest end of a task [ms].

    soonest: when any vehicle can have finished it; head: its earliest start by the rows; least: its shortest
    duration. All in ms.
    """
    return max(soonest, head + least)


@kernel(implements="assignment.search.all_may_leave_at")
def keeps_step(ok: bool, free: int, latest: int) -> bool:
    """Whether all vehicles, with one more, leave in time: it is free at `free`, must leave by `latest`."""
    return ok and free <= latest


@kernel(implements="assignment.search.is_covered_step")
def covers_step(ok: bool, mine: int, other: int) -> bool:
    """Whether a state is nowhere later than another, with one more time: `mine` against `other` [ms]."""
    return ok and mine <= other


covers = fold(
    name="covers", implements="assignment.search.is_covered_step", step=covers_step, start=True
)


@kernel(
    implements="assignment.search.weighted",
    restates="what the mission weighs: the meaning is the formula itself",
)
def weighted(makespan: int, team: int, added: int, per_makespan: int, per_team: int) -> int:
    """The cost: weighted latest end, weighted sum of the vehicles' last ends, and what legs cost.

    makespan, team: [ms]; added: weighted distances and energies so far; per_*: weights, >= 0.
    """
    return makespan * per_makespan + team * per_team + added


class Chain(NamedTuple):
    """A vehicle's chain so far: all legs held, and when the vehicle is free [ms]."""

    ok: bool
    free: int


@kernel(implements="assignment.search.chain_step")
def chain_step(chain: Chain, travel: int, start: int, end: int, duration: int) -> Chain:
    """Add one task to a chain: the vehicle has arrived by its start, and it takes its full duration.

    travel: leg from the task before (for the first: from mission start, with the time until the vehicle is ready);
    start, end: of the task; duration: of the task. All in ms.
    """
    ok = chain.ok and start >= chain.free + travel and end == start + duration
    return Chain(ok, end)


@kernel(supports="chain_holds")
def chain_result(chain: Chain) -> bool:
    """Whether every leg of the chain held."""
    return chain.ok


chain_holds = fold(
    name="chain_holds",
    implements="assignment.search.chain_step",
    step=chain_step,
    start=Chain(True, 0),
    finish=chain_result,
)


@kernel(implements="assignment.search.row_is_raised")
def raised(start: int, ref: int, lo: int) -> int:
    """The earliest start [ms] that is not before `start` and keeps lo [ms] from the reference."""
    return max(start, ref + lo)


@kernel(implements="assignment.search.all_needed_done")
def opened(done: int, need: int) -> bool:
    """True iff all tasks of the mask `need` are among those of the mask `done`."""
    return done & need == need


@kernel(implements="assignment.search.is_flown_in_laps")
def wait_holds(wait: int, laps: int, lap: int, lap_max: int) -> bool:
    """True iff a vehicle can wait this long: not at all, or in a number of laps of a circle.

    wait: [ms]; laps: how many; lap, lap_max: shortest and longest time of one lap [ms], >= 0.
    """
    if wait == 0:
        return True
    return laps >= 1 and laps * lap <= wait and wait <= laps * lap_max
