"""When a request that several vehicles' processes plan together is released: how long each waits for the others.

Source: the assignment coordinator of UxAS. Times in milliseconds.
"""

from __future__ import annotations


def goes_out(missing: int, since: int, now: int, limit: int) -> bool:
    """All vehicles have reported their planning state, or the time limit has passed; a limit below 0 means no limit."""
    return missing == 0 or (limit >= 0 and now >= since + limit)
