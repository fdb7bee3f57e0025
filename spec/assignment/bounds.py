"""What a lower bound of an assignment means, step by step. Integers; times in milliseconds.

A bound is admissible if every completion spends at least as much. The definitions refer to any amount `x` that a
completion could spend; the kernels of `core.assignment.lower_bounds` are proved against them.
"""


def undercuts_none(x: int, best: int, counts: bool, value: int) -> bool:
    """No choice is less than x: none of those considered so far (least: `best`), nor this value if it counts. FOR ALL
    x: this holds exactly up to the least of the choices.
    """
    if counts and value < x:
        return False
    return not (best < x)


def can_be_spent(x: int, total: int, is_open: bool, least: int) -> bool:
    """A completion can spend x in total: at least the total of the tasks so far plus, for a task that is still open,
    at least its minimum. FOR ALL x.
    """
    rest = x - total
    if is_open:
        return rest >= least
    return rest >= 0


def stop_is_no_shortcut(direct: int, first: int, stay: int, second: int) -> bool:
    """A route with a stop takes at least as long as the stated time of the direct route."""
    return not (first + stay + second < direct)


def may_be_last(last: int, end: int, tail: int, lag: int, least: int, after: int) -> bool:
    """Everything may be over at `last`, where a task ends at `end`. What had to follow it so far takes `tail`;
    another task, which takes `least` and has `after` to follow it, starts no earlier than `end + lag`. FOR ALL
    instants.
    """
    soonest = end + lag
    return last >= end + tail and last - after >= soonest + least


def none_is_cheaper(other: int, cost: int, bound: int) -> bool:
    """A schedule of this other cost, if it is not below the bound, is not cheaper than `cost`.

    FOR ALL other: as no schedule is below a proved bound, none is cheaper: `cost` is optimal.
    """
    return not (other >= bound and other < cost)
