"""What it means to be heard in time, to have lasted, and to begin too early. Milliseconds.

The definitions speak of instants: each takes the instant that it quantifies over as its first
argument, and its docstring says how it is quantified; instants are integers. The kernels
(`core.authority.timeliness`) speak of ends of intervals. Comparisons, `and`, `or`, `not` alone, so they can
be run on numbers and on symbolic values alike. Times and bounds lie between -2**61 and 2**61.
"""

from __future__ import annotations


def in_time(t: int, last: int, now: int, bound: int) -> bool:
    """At the instant t, from the last message to now, the last was not older than the bound.

    FOR ALL t. A message that came after `now` is none: then nothing is in time. Premise: bound >= 0.
    """
    return last <= now and not (last <= t and t <= now and t > last + bound)


def lasted(t: int, since: int, now: int, least: int) -> bool:
    """If t lies in the last `least` milliseconds, then it was so at t already.

    FOR ALL t. since: it has been so at every instant from this one to now. Premises: since <= now,
    least >= 0.
    """
    return not (now - least <= t and t <= now) or since <= t


def too_early(t: int, at: int, planned: int, margin: int) -> bool:
    """Neither at the instant `at` nor within the margin after it the planned time has come.

    FOR ALL t. Premise: margin >= 0.
    """
    return not (at <= t and t <= at + margin) or t < planned
