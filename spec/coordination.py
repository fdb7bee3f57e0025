"""When a request that several vehicles' processes plan together goes out: how long each waits for the others.

Source: the assignment coordinator of UxAS. Times in milliseconds.
"""

from __future__ import annotations


def goes_out(missing: int, since: int, now: int, limit: int) -> bool:
    """All have said where they plan from, or the time for that is over; a limit below 0 is none."""
    return missing == 0 or (limit >= 0 and now >= since + limit)
