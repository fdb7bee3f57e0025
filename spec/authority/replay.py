"""What it means that a packet is new: nobody can have it accepted a second time by sending it again.

Packets of a connection are numbered from 1; what an end keeps is a mark: no accepted number is above it. As in
`spec.authority.timeliness` the definitions speak of any number t, and their docstrings say how it is
quantified. Numbers lie between -2**61 and 2**61.
"""

from __future__ import annotations


def is_new(t: int, mark: int, sequence: int, window: int) -> bool:
    """The packet's number is that of no packet that may have been accepted, and not far ahead.

    FOR ALL t: t may have been accepted if it is from 1 to the mark. Far ahead: more than the window above
    the mark. Premises: mark >= 0, window >= 0.
    """
    accepted = t >= 1 and t <= mark
    return sequence >= 1 and sequence <= mark + window and not (accepted and t == sequence)


def is_mark_after(t: int, after: int, mark: int, sequence: int, accepted: bool) -> bool:
    """The mark afterwards is above no number but those that were accepted or lie below one.

    FOR ALL t: what was at most the mark stays so, and so is the packet's number if it was accepted; the mark is
    the former one or that number.
    """
    covers = (not t <= mark or t <= after) and (not (accepted and t == sequence) or t <= after)
    return covers and (after == sequence if accepted else after == mark)
