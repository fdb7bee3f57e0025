"""What the executive may and must do with tasks in flight. Milliseconds.

A chain's phase: TRANSIT to the start pose of its item, WAIT there while the task may not begin, TASK,
DONE. A task's life: LEFT, BEGUN, ENDED, FAILED.
"""

from typing import NamedTuple

from cratous.spec.constraint_rows import AFTER_END, AFTER_START

TRANSIT, WAIT, TASK, DONE = 0, 1, 2, 3
LEFT, BEGUN, ENDED, FAILED = 0, 1, 2, 3
BEGIN, END, FAIL = 1, 2, 3
NOTHING, LAP, START, GO_ON, LAST_LAP = 0, 1, 2, 3, 4
"""Acts at the end of a track: nothing; a lap of the hold; begin the task; end it and go on to the next item; another
lap at the end of the chain.
"""
STANDS_BY, PLAN_ANEW, GIVE_UP = 0, 1, 2
LOST, JOINS, ADDED, REMOVED, OTHER, ZONE_ENDED = 1, 2, 3, 4, 5, 6
GOES_ON, COMPLETE, FAILED_FLIGHT, LIMIT = 0, 1, 2, 3
FOR_NOTHING, FOR_CHANGE, FOR_DEADLINE = 0, 1, 2
"""Reason for a pending plan request: none; a change; a deadline that cannot be kept."""
KEEP_ON, FLY_PLAN, DROP_LEFT, DROP_LATE = 0, 1, 2, 3
"""Effect of an answer: nothing; the plan is flown; all remaining tasks fail; the late task fails."""

FLY_WAY, FAIL_TASK, CIRCLE = 0, 1, 2
"""Acts after the search for a path: it is flown; the task fails; the vehicle circles where it is."""


class Moved(NamedTuple):
    """Phase and act."""

    phase: int
    act: int


def at_start_pose(phase: int) -> bool:
    """At the end of its track a vehicle in this phase is at the start pose of its item."""
    return not (phase < TRANSIT or phase > WAIT)


def is_after_passing(phase: int, suspended: bool, opens: bool, more: bool, moved: Moved) -> bool:
    """Nothing happens to a vehicle that UxAS does not command. At its start pose a task begins exactly if it may;
    otherwise its vehicle waits. At the end of its path a task ends, and the vehicle goes on to the next item, if
    there is one. At the end of its chain it stays.
    """
    if suspended:
        return moved == Moved(phase, NOTHING)
    if at_start_pose(phase):
        begun = moved == Moved(TASK, START)
        waits = moved == Moved(WAIT, LAP)
        return (begun and opens) or (waits and not opens)
    if phase == TASK:
        onward = moved.phase == TRANSIT and more
        over = moved.phase == DONE and not more
        return moved.act == GO_ON and (onward or over)
    return moved == Moved(DONE, LAST_LAP)


def settled(life: int) -> bool:
    """The task's state no longer changes."""
    return not (life < ENDED or life > FAILED)


def is_after_event(life: int, event: int, after: int) -> bool:
    """A settled task stays as it is. Any other may begin, again if another plan interrupted it, or fail; it ends only
    if it has begun.
    """
    if settled(life):
        return after == life
    if event == END and life != BEGUN:
        return after == life
    if event == BEGIN:
        return after == BEGUN
    if event == END:
        return after == ENDED
    if event == FAIL:
        return after == FAILED
    return after == life


def may_begin(life: int, rows_open: bool, early: bool) -> bool:
    """A settled task never begins; any other may once nothing forbids it."""
    forbidden = not rows_open or early
    return not (settled(life) or forbidden)


def preceded_by(ok: bool, known: bool, end: int, at: int, lo: int) -> bool:
    """All tasks of the row so far ended, and this one did, at least `lo` before the instant `at`."""
    early_enough = not at - lo < end
    return ok and (known and early_enough)


def followed(ok: bool, known: bool, start: int, at: int, lo: int) -> bool:
    """Some task of the row so far, or this one, began at least `lo` before the instant `at`."""
    early_enough = not at - lo < start
    return (known and early_enough) or ok


def late_answer(under_way: bool, may_plan: bool, torn: bool) -> int:
    """A new plan is made only if it interrupts no task; if it would, it is postponed; a task that is being flown, or
    that no planner can save, is given up.
    """
    if may_plan and not under_way:
        if not torn:
            return PLAN_ANEW
        return STANDS_BY
    return GIVE_UP


def change_counts(kind: int, left: int, ended: bool) -> bool:
    """The change calls for a new plan: a vehicle with remaining work is lost, an unfinished task is removed, a task
    or a vehicle is added, or a zone ends while work remains.
    """
    orphaned = kind == LOST and left > 0
    freed = kind == ZONE_ENDED and not left <= 0
    withdrawn = kind == REMOVED and not ended
    hands = kind == JOINS
    return orphaned or withdrawn or hands or freed or kind == ADDED


def all_over(flying: int, away: int, expected: int) -> bool:
    """No vehicle has anything left to fly, UxAS commands all vehicles, and nothing more is expected."""
    return flying <= 0 and away <= 0 and expected <= 0


def outcome(flying: int, away: int, expected: int, left: int, now: int, limit: int) -> int:
    """A flight is complete only when it is over and no requested task remains; if some remain it has failed; if it is
    not over it goes on up to its time limit.
    """
    if all_over(flying, away, expected) and left <= 0:
        return COMPLETE
    if all_over(flying, away, expected):
        return FAILED_FLIGHT
    if now < limit:
        return GOES_ON
    return LIMIT


def is_safe_end(working: int, away: int, safe: int, expected: int, ends: bool) -> bool:
    """A flight ends in the declared safe state exactly if some vehicle is in it, none is away elsewhere, and nothing
    is left to do for the others, nor expected.
    """
    idle = all_over(working, away - safe, expected) and not away < safe
    return ends == (idle and safe >= 1)


def is_given_up(takeovers: int, most: int, under: int, longest: int, given_up: bool) -> bool:
    """A leg is given up exactly if ICAROUS has taken the vehicle over more than `most` times on it, or has flown it
    for more than `longest` in total.
    """
    within = not (takeovers > most) and not under > longest
    return given_up != within


class Answer(NamedTuple):
    """The reason for the pending plan request afterwards, and the act."""

    awaited: int
    act: int


def is_asked(asked: int) -> bool:
    """A plan has been requested and is awaited."""
    return not (asked < FOR_CHANGE or asked > FOR_DEADLINE)


def is_after_answer(asked: int, found: bool, answer: Answer) -> bool:
    """An answer that is not awaited changes nothing. An awaited one ends the request: a plan found is flown; without
    one, after a change all remaining tasks fail, after a deadline the late task fails.
    """
    if not is_asked(asked):
        return answer == Answer(asked, KEEP_ON)
    flown = answer.act == FLY_PLAN and found
    all_lost = answer.act == DROP_LEFT and asked == FOR_CHANGE
    one_lost = answer.act == DROP_LATE and asked == FOR_DEADLINE
    return answer.awaited == FOR_NOTHING and (flown or (not found and (all_lost or one_lost)))


def on_path_again(away: bool, suspended: bool, flown_m: float, join_m: float) -> bool:
    """UxAS commands the vehicle, which had left the path of its task, and the point where the way back joins that
    path is no longer ahead of it [m].
    """
    ahead_m = join_m - flown_m
    return away and not (suspended or ahead_m > 0)


def falls_with(kind: int, named: bool, life: int) -> bool:
    """A task that has not begun can no longer begin after another one has failed, if a row makes it wait for the end
    or the start of that task.
    """
    waits = not (kind < AFTER_END or kind > AFTER_START)
    begun = life != LEFT
    return waits and named and not begun


def is_after_search(found: bool, tasked: bool, act: int) -> bool:
    """A path that was found is flown, and no other. Without one the vehicle stays: if it is there for a task, that
    task fails, so that nothing waits for it indefinitely.
    """
    flies, fails = act == FLY_WAY, act == FAIL_TASK
    return flies == found and fails == (tasked and not flies) and not (act < 0 or act > CIRCLE)


def completes_at(t: int, outcome: int, end: int, limit: int) -> bool:
    """The mission completes at the instant t, and t lies between its beginning and its limit. THERE IS an instant t."""
    in_time = t >= 0 and t <= limit
    return in_time and t == end and outcome == COMPLETE
