"""Decisions of the executive on chains of tasks in flight, as transition kernels.

A vehicle flies its chain item by item: TRANSIT (0) to the start pose, WAIT (1) on a circle through it while the task
may not begin, TASK (2), DONE (3). A task is LEFT (0), BEGUN (1), ENDED (2) or FAILED (3). Definitions:
`spec.executive`.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel
from cratous.core.schedule.rows import row_holds


class Passed(NamedTuple):
    """The phase afterwards, and what to do: 0 nothing, 1 fly a lap of the hold, 2 begin the task, 3 end
    it and go on, 4 fly another lap at the end of the chain."""

    phase: int
    act: int


@kernel(implements="executive.is_after_passing")
def end_passed(phase: int, suspended: bool, opens: bool, more: bool) -> Passed:
    """A vehicle has passed the end of the track of its present phase.

    suspended: UxAS does not command it; opens: its task may begin now; more: another item follows.
    """
    if suspended:
        return Passed(phase, 0)
    if phase == 2:
        if more:
            return Passed(0, 3)
        return Passed(3, 3)
    if phase == 3:
        return Passed(3, 4)
    if opens:
        return Passed(2, 2)
    return Passed(1, 1)


@kernel(implements="executive.is_after_event")
def task_after(life: int, event: int) -> int:
    """A task's life after an event: 1 it is begun, 2 it is flown to its end, 3 it is given up."""
    if life == 2 or life == 3:
        return life
    if event == 1:
        return 1
    if event == 2 and life == 1:
        return 2
    if event == 3:
        return 3
    return life


@kernel(implements="executive.may_begin")
def may_begin(life: int, rows_open: bool, early: bool) -> bool:
    """True iff a task may begin now.

    rows_open: every lower bound of its rows holds now; early: a wait that is planned is not over.
    """
    return life < 2 and rows_open and not early


@kernel(implements="executive.preceded_by")
def ended_before(ok: bool, known: bool, end: int, at: int, lo: int) -> bool:
    """Add one task of a row `after the end`: it has ended, by at - lo.

    ok: so have all before it; known: it has ended at all; end, at: [ms]; lo: distance [ms].
    """
    return ok and known and row_holds(1, at, at, end, lo, 0)


all_ended_before = fold(
    name="all_ended_before", implements="executive.preceded_by", step=ended_before, start=True
)


@kernel(implements="executive.followed")
def begun_before(ok: bool, known: bool, start: int, at: int, lo: int) -> bool:
    """Add one task of a row `after the start`: it has begun, by at - lo, or one before it had."""
    return ok or (known and row_holds(2, at, at, start, lo, 0))


some_begun_before = fold(
    name="some_begun_before", implements="executive.followed", step=begun_before, start=False
)


@kernel(
    implements="executive.late_answer",
    restates="the rule for deadlines that cannot be kept; that another plan tears no task is proved of it",
)
def late_act(under_way: bool, may_plan: bool, torn: bool) -> int:
    """What to do about a task that can no longer meet an upper bound: 0 wait, 1 plan anew, 2 fail it.

    under_way: it is being flown; may_plan: there is a planner; torn: another plan now would interrupt some task, for
    one is under way or a vehicle is not flown by UxAS.
    """
    if under_way or not may_plan:
        return 2
    if torn:
        return 0
    return 1


@kernel(implements="executive.change_counts")
def change_counts(kind: int, left: int, ended: bool) -> bool:
    """True iff a change by itself requires a new plan.

    kind: 1 a vehicle is lost, 2 one joins, 3 a task is added, 4 a task is removed, 5 anything else, 6 a zone ends;
    left: how many tasks the vehicle has left, or the plan leaves undone, in whole or in part, that the zone may have
    forbidden; ended: the task has ended.
    """
    if kind == 1 or kind == 6:
        return left > 0
    if kind == 4:
        return not ended
    return kind == 2 or kind == 3


@kernel(implements="executive.outcome")
def flight_outcome(flying: int, away: int, expected: int, left: int, now: int, limit: int) -> int:
    """The state of a flight: 0 it goes on, 1 it is complete, 2 it has failed, 3 its time limit is reached.

    flying: vehicles with items left; away: vehicles that UxAS does not command; expected: changes to come that bring
    work; left: tasks asked for that have not ended; now, limit: [ms].
    """
    if flying == 0 and away == 0 and expected == 0:
        if left > 0:
            return 2
        return 1
    if now >= limit:
        return 3
    return 0


@kernel(implements="executive.is_safe_end")
def ends_in_safe_state(working: int, away: int, safe: int, expected: int) -> bool:
    """True iff a flight that is not over ends in the declared safe state.

    working: vehicles with items left that are not in it; away: vehicles that UxAS does not command; safe: those of them
    that are in it; expected: changes to come that bring work.
    """
    return working == 0 and safe > 0 and safe == away and expected == 0


@kernel(implements="executive.is_given_up")
def leg_given_up(takeovers: int, most: int, under: int, longest: int) -> bool:
    """True iff a leg is given up: ICAROUS has taken over too often on it, or flown for too long.

    takeovers, most: their number, and the greatest allowed; under, longest: total time, and the greatest allowed
    [ms].
    """
    return takeovers > most or under > longest


class Answered(NamedTuple):
    """The reason for the pending plan request afterwards, and what to do: 0 nothing, 1 fly the plan, 2 fail all
    remaining tasks, 3 fail the late task.
    """

    awaited: int
    act: int


@kernel(implements="executive.is_after_answer")
def answered(asked: int, found: bool) -> Answered:
    """The planner has answered.

    asked: the reason for the pending request, 0 none, 1 a change, 2 a deadline; found: there is a plan.
    """
    if asked != 1 and asked != 2:
        return Answered(asked, 0)
    if found:
        return Answered(0, 1)
    if asked == 1:
        return Answered(0, 2)
    return Answered(0, 3)


@kernel(implements="executive.on_path_again")
def rejoined(away: bool, suspended: bool, flown_m: float, join_m: float) -> bool:
    """True iff a vehicle has returned to the path of its task.

    away: it had left the path; suspended: UxAS does not fly it; flown_m: how far it is on its track [m]; join_m:
    where the path begins again on it [m].
    """
    return away and not suspended and flown_m >= join_m


@kernel(implements="executive.falls_with")
def falls_with(kind: int, named: bool, life: int) -> bool:
    """True iff a task fails because another one has failed.

    kind: of a row of the task, 1 after the end of others, 2 after their start; named: the row names the one that has
    failed; life: of the task.
    """
    return (kind == 1 or kind == 2) and named and life == 0


@kernel(implements="executive.is_after_search")
def way_act(found: bool, tasked: bool) -> int:
    """What to do after the search for a path that keeps the zones: 0 fly it, 1 fail the task, 2 circle.

    found: there is one; tasked: a task needs it.
    """
    if found:
        return 0
    if tasked:
        return 1
    return 2


@kernel(implements="executive.completes_at")
def completes(outcome: int, end: int, limit: int) -> bool:
    """True iff a mission has ended complete and in time.

    outcome: as of `flight_outcome`; end: when it ended; limit: until when it had to [ms].
    """
    return outcome == 1 and end >= 0 and end <= limit
