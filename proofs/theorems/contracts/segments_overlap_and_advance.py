"""The next piece of a mission path has exactly the overlap asked for in common with the one before, is
as long as asked for or ends with the path, and always goes further, until the path's last position
is served; the path may lead back into itself."""

from cratous.core.contracts.segments import Span, first_span, span_after, waypoint_after
from cratous.proofs.claim import Claim
from cratous.spec.contracts import segments


def claim(c: Claim) -> None:
    end, length, overlap = c.integer("end"), c.integer("length"), c.integer("overlap")
    c.premise(c.all_of(end >= 0, end <= 2**60, length >= 2, length <= 2**60))
    c.premise(c.all_of(overlap >= 1, overlap < length))
    span = Span(c.integer("first"), c.integer("last"))
    c.premise(c.all_of(span.first >= 0, span.first <= span.last, span.last <= end))
    full = c.any_of(span.last - span.first == length - 1, span.last == end)
    c.premise(full)
    begin = c.use(first_span, end, length)
    size = c.any_of(begin.last == length - 1, begin.last == end)
    within = c.all_of(begin.last <= end, begin.last <= length - 1)
    c.show(c.all_of(begin.first == 0, size, within), "the first piece")
    after = c.use(span_after, span, end, length, overlap)
    over = span.last == end
    c.show(c.implies(over, c.same(after, span)), "after the last there is none")
    on = c.negation(over)
    c.show(c.implies(on, span.last - after.first + 1 == overlap), "the overlap")
    c.show(c.implies(on, after.last > span.last), "it goes further")
    c.show(c.all_of(after.first >= span.first, after.last <= end), "it stays on the path")
    whole = c.any_of(after.last - after.first == length - 1, after.last == end)
    c.show(c.implies(on, c.all_of(whole, after.last - after.first <= length - 1)), "its length")
    bad = c.integer("bad")
    c.premise(c.any_of(bad < 1, bad >= length))
    c.show(c.same(c.use(span_after, span, end, length, bad), span), "an overlap that cannot be")
    short = Span(2, 3)
    c.show(c.same(c.use(span_after, short, 9, 4, 4), short), "an example: nor after a short piece")
    waypoint, count, back = c.integer("waypoint"), c.integer("count"), c.integer("back_to")
    c.premise(c.all_of(waypoint >= 0, waypoint < count))
    c.show(
        c.use(waypoint_after, waypoint, count, back)
        == c.define(segments.follows, waypoint, count, back),
        "from waypoint to waypoint",
    )
