"""Serving a long mission path to a vehicle in segments.

The path's waypoints have positions from 0; a segment is a range of positions. The next segment begins
before the last one's end, so that the two overlap, and continues from there; together the segments are the
path: every position is served, in order, without gaps. A path that leads back into itself (its last waypoint leads to
an earlier one) has no last position; the waypoint at a position is found by following the path from waypoint to
waypoint.
"""

from typing import NamedTuple


class Piece(NamedTuple):
    """Positions first to last, both included."""

    first: int
    last: int


class Served(NamedTuple):
    """The last position served so far, and how often the given position was new."""

    last: int
    times: int


def new_here(served_to: int, piece_last: int, position: int) -> bool:
    """A position is new with the segment that ends at piece_last."""
    return served_to < position and position <= piece_last


def fresh_positions(served_to: int, length: int, overlap: int) -> int:
    """The number of positions that a segment adds if the path is long enough: its length less the overlap."""
    if served_to < 0:
        return length
    if overlap < 1 or overlap >= length:
        return 0
    return length - overlap


def serve_step(served: Served, end: int, length: int, overlap: int, position: int) -> Served:
    """Serve one more segment of a path whose last position is `end`."""
    last = min(end, served.last + fresh_positions(served.last, length, overlap))
    if new_here(served.last, last, position):
        return Served(last, served.times + 1)
    return Served(last, served.times)


def times(served: Served) -> int:
    """How often the position was new."""
    return served.times


def times_due(served_to: int, position: int) -> int:
    """How often a position must have been new: once if it was served, else never."""
    if position >= 0 and position <= served_to:
        return 1
    return 0


def follows(waypoint: int, count: int, back_to: int) -> int:
    """The next waypoint; back_to: the index that the last one leads to (its own index: the path stops there)."""
    if waypoint == count - 1:
        return back_to
    return waypoint + 1
