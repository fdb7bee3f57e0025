"""Put together without their overlaps, the pieces of a mission path are the path: every position up to
the last one served was new exactly once and in order, none was skipped, and none beyond it was
served; for every path, length, overlap and number of pieces."""

from typing import Any

from cratous.core.contracts.segments import Spans, spans_serve, spans_step
from cratous.proofs.claim import Claim
from cratous.spec.contracts.segments import Served, serve_step, times, times_due


def serve(served: Any, overlap: Any, end: Any, length: Any, position: Any) -> Any:
    return serve_step(served, end, length, overlap, position)


def claim(c: Claim) -> None:
    end, length, overlap = c.integer("end"), c.integer("length"), c.integer("overlap")
    position = c.integer("position")
    c.premise(c.all_of(end >= 0, end <= 2**60, length >= 2, length <= 2**60))
    acc = Spans(c.whole("first"), c.whole("last"), c.whole("times"))
    c.premise(c.all_of(overlap >= 0, overlap <= 2**60))
    # after position 0 a piece of 6 with an overlap of 2 adds 4, whatever was new before
    more = c.define(serve_step, Served(0, 3), 9, 6, 2, 1)
    c.show(c.all_of(c.same(more.last, 4), c.same(more.times, 4)), "an example")
    found = c.use(spans_step, Spans(0, 0, 3), 2, 9, 6, 1)
    c.show(c.all_of(c.same(found.last, 4), c.same(found.times, 4)), "the example for the kernel")

    def related(s: Any, served: Any) -> Any:
        place = c.all_of(s.first >= 0, s.last >= -1, s.last <= end, s.first <= s.last + 1)
        due = c.define(times_due, s.last, position)
        alike = c.all_of(c.same(served.last, s.last), c.same(served.times, s.times))
        full = c.any_of(s.last == end, s.last < 0, s.last - s.first == length - 1)
        return c.all_of(place, alike, s.times == due, full)

    c.fold(
        spans_serve,
        acc=acc,
        model=Served(c.whole("served_to"), c.whole("new")),
        item=(overlap,),
        context=(end, length, position),
        model_start=Served(-1, 0),
        model_step=serve,
        model_finish=times,
        relation=related,
    )
