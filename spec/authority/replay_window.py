"""Replay protection for packets that may overtake each other, such as datagrams.

Packets are numbered from 1. The receiver keeps a mark, which no accepted number exceeds, and for each remainder
modulo WIDTH the greatest accepted number with that remainder, its `last` (0 for none). So for each of the WIDTH
numbers up to the mark it knows whether it was accepted; older numbers are refused. As in `spec.authority.replay`, the
definitions refer to any number t, and numbers lie between -2**61 and 2**61.
"""

from __future__ import annotations

WIDTH = 64
"""The number of packet numbers in the window, up to the mark."""


def may_have_come(t: int, mark: int, last: int, sequence: int) -> bool:
    """Whether number t may have been accepted, according to the state kept for a packet of number `sequence`.

    No accepted number is above the mark, and none with the remainder of the packet's number is above `last`.
    """
    return t >= 1 and t <= mark and (t % WIDTH != sequence % WIDTH or t <= last)


def is_within(mark: int, sequence: int, ahead: int) -> bool:
    """The number is one of the WIDTH up to the mark, or above it by at most `ahead`."""
    return sequence >= 1 and sequence > mark - WIDTH and sequence <= mark + ahead


def is_fresh(t: int, mark: int, last: int, sequence: int, ahead: int) -> bool:
    """The packet's number differs from that of every packet that may have been accepted, and lies within the window.

    FOR ALL t. Premises: 0 <= last <= mark, ahead >= 0.
    """
    came = may_have_come(t, mark, last, sequence)
    return is_within(mark, sequence, ahead) and not (came and t == sequence)


def is_kept_after(t: int, after: int, before: int, sequence: int, accepted: bool) -> bool:
    """Every t that was at or below the mark (or a `last`) before still is, and so is the number of a packet accepted
    now.

    FOR ALL t. The new value is the old one, or the packet's number if that was accepted.
    """
    covers = (not t <= before or t <= after) and (not (accepted and t == sequence) or t <= after)
    return covers and (after == before or (accepted and after == sequence))
