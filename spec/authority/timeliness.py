"""When a message is in time, a condition has lasted, and a time is too early. Milliseconds.

The definitions refer to instants: each takes the instant that it quantifies over as its first argument, and its
docstring states how it is quantified; instants are integers. The kernels (`core.authority.timeliness`) use ends of
intervals. The definitions use only comparisons, `and`, `or`, `not`, so that they can be run on numbers and on
symbolic values alike. Times and bounds lie between -2**61 and 2**61.
"""

from __future__ import annotations


def in_time(t: int, last: int, now: int, bound: int) -> bool:
    """At the instant t, between the last message and now, the last message was not older than the bound.

    FOR ALL t. A message later than `now` does not count: then nothing is in time. Premise: bound >= 0.
    """
    return last <= now and not (last <= t and t <= now and t > last + bound)


def lasted(t: int, since: int, now: int, least: int) -> bool:
    """If t lies in the last `least` milliseconds, then the condition was already true at t.

    FOR ALL t. since: it has been true at every instant from this one to now. Premises: since <= now, least >= 0.
    """
    return not (now - least <= t and t <= now) or since <= t


def too_early(t: int, at: int, planned: int, margin: int) -> bool:
    """The planned time is reached neither at the instant `at` nor within the margin after it.

    FOR ALL t. Premise: margin >= 0.
    """
    return not (at <= t and t <= at + margin) or t < planned
