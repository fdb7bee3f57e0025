"""Replay protection: whether a packet is new, or a recorded one sent again.

Definitions: `spec.authority.replay`. Whether a packet is genuine is decided by its authentication code; a genuine one
is still refused here if its number was accepted before.
"""

from cratous.core.kernel import kernel


@kernel(implements="authority.replay.is_new", nonnegative=("mark", "window"))
def packet_is_new(mark: int, sequence: int, window: int) -> bool:
    """True iff the packet may be accepted.

    mark: the greatest number accepted so far, 0 for none; sequence: the packet's number, from 1; window: by
    how much it may be above the mark.
    """
    return mark < sequence and sequence - mark <= window


@kernel(implements="authority.replay.is_mark_after", nonnegative=("mark", "window"))
def mark_after(mark: int, sequence: int, window: int) -> int:
    """The greatest number accepted after a packet has come, accepted or not.

    mark, sequence, window: as of `packet_is_new`.
    """
    if packet_is_new(mark, sequence, window):
        return sequence
    return mark
