"""Replay protection for packets that may overtake each other: a window of 64 numbers, see
`spec.authority.replay_window`.

On a connection that preserves order a mark suffices (`core.authority.replay`), and refuses more.
"""

from cratous.core.kernel import kernel

WIDTH = 64
"""As in the definition; a kernel sees nothing but its arguments, so the number is also written in it."""


@kernel(implements="authority.replay_window.is_fresh", nonnegative=("mark", "last", "ahead"))
def packet_is_fresh(mark: int, last: int, sequence: int, ahead: int) -> bool:
    """True iff the packet may be accepted.

    mark: the greatest number accepted so far; last: the greatest one with the packet's remainder by 64; 0 for none;
    sequence: the packet's number, from 1; ahead: by how much it may be above the mark.
    """
    old = mark - sequence >= 64
    return last < sequence and not old and sequence - mark <= ahead


@kernel(implements="authority.replay_window.is_kept_after", nonnegative=("mark", "last", "ahead"))
def window_mark_after(mark: int, last: int, sequence: int, ahead: int) -> int:
    """The mark after a packet has come, accepted or not.

    mark, last, sequence, ahead: as of `packet_is_fresh`.
    """
    if packet_is_fresh(mark, last, sequence, ahead):
        return max(mark, sequence)
    return mark


@kernel(implements="authority.replay_window.is_kept_after", nonnegative=("mark", "last", "ahead"))
def window_last_after(mark: int, last: int, sequence: int, ahead: int) -> int:
    """The greatest number accepted with the packet's remainder, after it has come, accepted or not.

    mark, last, sequence, ahead: as of `packet_is_fresh`.
    """
    if packet_is_fresh(mark, last, sequence, ahead):
        return sequence
    return last


class Window:
    """The state kept of one sender: the mark, and the last number accepted of each remainder."""

    def __init__(self, ahead: int) -> None:
        """ahead: by how much a number may be above the mark."""
        self.mark, self._ahead = 0, ahead
        self._last = [0] * WIDTH

    def take(self, sequence: int) -> bool:
        """Whether a packet of this number is accepted; once accepted, it is refused from then on."""
        place = sequence % WIDTH
        args = self.mark, self._last[place], sequence, self._ahead
        fresh = packet_is_fresh(*args)
        self.mark, self._last[place] = window_mark_after(*args), window_last_after(*args)
        return fresh
