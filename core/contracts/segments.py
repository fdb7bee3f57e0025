"""The next segment of a mission path that a vehicle gets, so that together the segments are the path.

Definitions: `spec.contracts.segments`. Positions count from 0, at most 2^60 of them.
"""

from typing import NamedTuple

from cratous.core.kernel import fold, kernel


class Span(NamedTuple):
    """Positions first to last, both included."""

    first: int
    last: int


@kernel(supports="spans_serve")
def first_span(end: int, length: int) -> Span:
    """The first segment. end: last position of the path; length: positions in a segment, >= 2."""
    return Span(0, min(end, length - 1))


@kernel(supports="spans_serve")
def span_after(span: Span, end: int, length: int, overlap: int) -> Span:
    """The segment of `length` after this one; the same if it was the last, or the overlap is not possible.

    overlap: positions that the two have in common, 1 <= overlap < length.
    """
    if span.last >= end or overlap < 1 or overlap >= length:
        return span
    first = span.last + 1 - overlap
    return Span(first, min(end, first + (length - 1)))


@kernel(implements="contracts.segments.follows")
def waypoint_after(waypoint: int, count: int, back_to: int) -> int:
    """The next waypoint on a path of `count`; the last leads to back_to (its own index: the path stops there)."""
    if waypoint + 1 < count:
        return waypoint + 1
    return back_to


class Spans(NamedTuple):
    """The segment served last, and how often so far the given position was new."""

    first: int
    last: int
    times: int


@kernel(implements="contracts.segments.serve_step")
def spans_step(s: Spans, overlap: int, end: int, length: int, position: int) -> Spans:
    """Serve the next segment, observing one position; before the first, last is -1."""
    if s.last < 0:
        first, last = first_span(end, length)
    else:
        first, last = span_after(Span(s.first, s.last), end, length, overlap)
    if position > s.last and position <= last:
        return Spans(first, last, s.times + 1)
    return Spans(first, last, s.times)


@kernel(supports="spans_serve")
def spans_result(s: Spans) -> int:
    """How often the position was new."""
    return s.times


spans_serve = fold(
    name="spans_serve",
    implements="contracts.segments.times",
    step=spans_step,
    start=Spans(0, -1, 0),
    finish=spans_result,
)
