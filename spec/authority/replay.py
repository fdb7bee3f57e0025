"""Replay protection: what makes a packet new, so that no packet is accepted a second time.

Packets of a connection are numbered from 1; the receiver keeps a mark, and no accepted number is above it. As in
`spec.authority.timeliness`, the definitions refer to any number t, and their docstrings state how it is quantified.
Numbers lie between -2**61 and 2**61.
"""

from __future__ import annotations


def is_new(t: int, mark: int, sequence: int, window: int) -> bool:
    """The packet's number differs from that of every packet that may have been accepted, and is not too far ahead.

    FOR ALL t: t may have been accepted if it is from 1 to the mark. Too far ahead: more than the window above the
    mark. Premises: mark >= 0, window >= 0.
    """
    accepted = t >= 1 and t <= mark
    return sequence >= 1 and sequence <= mark + window and not (accepted and t == sequence)


def is_mark_after(t: int, after: int, mark: int, sequence: int, accepted: bool) -> bool:
    """The new mark covers every number that the old mark covered and an accepted packet's number, and no other reason
    raises it.

    FOR ALL t: what was at most the mark stays so, and so is the packet's number if it was accepted; the new mark is
    that number if it was accepted, else the old mark.
    """
    covers = (not t <= mark or t <= after) and (not (accepted and t == sequence) or t <= after)
    return covers and (after == sequence if accepted else after == mark)
