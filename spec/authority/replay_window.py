"""What it means that a packet is new where packets may overtake each other, as datagrams do.

Packets are numbered from 1. What an end keeps: a mark, which no accepted number is above, and for each remainder by
WIDTH the greatest number accepted that leaves it, its `last`, 0 for none. So it knows of each of the WIDTH numbers up
to the mark whether it was accepted, and of none that is older: those are refused. As in `spec.authority.replay` the
definitions speak of any number t, and numbers lie between -2**61 and 2**61.
"""

from __future__ import annotations

WIDTH = 64
"""How many numbers the window holds, up to the mark."""


def may_have_come(t: int, mark: int, last: int, sequence: int) -> bool:
    """Whether number t may have been accepted, by what is kept where a packet of number `sequence` is looked at.

    None is above the mark, and none that leaves the remainder of the packet's number is above last.
    """
    return t >= 1 and t <= mark and (t % WIDTH != sequence % WIDTH or t <= last)


def is_within(mark: int, sequence: int, ahead: int) -> bool:
    """The number is one of the WIDTH up to the mark, or above it by at most `ahead`."""
    return sequence >= 1 and sequence > mark - WIDTH and sequence <= mark + ahead


def is_fresh(t: int, mark: int, last: int, sequence: int, ahead: int) -> bool:
    """The packet's number is that of no packet that may have been accepted, and within the window.

    FOR ALL t. Premises: 0 <= last <= mark, ahead >= 0.
    """
    came = may_have_come(t, mark, last, sequence)
    return is_within(mark, sequence, ahead) and not (came and t == sequence)


def is_kept_after(t: int, after: int, before: int, sequence: int, accepted: bool) -> bool:
    """The mark, or a last, afterwards is below no number that it was not below, nor below one that is accepted now.

    FOR ALL t. It is the former one, or the packet's number if that was accepted.
    """
    covers = (not t <= before or t <= after) and (not (accepted and t == sequence) or t <= after)
    return covers and (after == before or (accepted and after == sequence))
