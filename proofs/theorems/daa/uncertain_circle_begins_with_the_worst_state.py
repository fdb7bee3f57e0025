"""The span of the uncertain circle begins now where the disc of the position reaches into the circle, and
with the worst state where it does not; it ends at T or when the disc last comes within the circle; and it
holds every instant from the worst state's first on until then."""

from cratous.core.daa.uncertainty import circle_first, circle_span, circle_straight, until_left
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    es, ev, dthr, tthr, end, t = c.reals("es ev dthr tthr end t")
    for least in (es, ev, dthr, tthr, end):
        c.premise(least >= 0)
    c.opaque(circle_first, circle_straight, until_left, daa_meaning.may_be_within_at)
    first, last = c.use(circle_span, s, v, es, ev, dthr, tthr, end)
    ss, vv = s.x * s.x + s.y * s.y, v.x * v.x + v.y * v.y
    wide = dthr + es
    spare, half, rest = vv - ev * ev, s.x * v.x + s.y * v.y - ev * wide, ss - wide * wide
    inside = c.define(well_clear.within, s, wide)
    drifting = c.define(well_clear.within, v, ev)
    turned = c.use(circle_first, s, v, es, ev, dthr, tthr, end)
    straight = c.use(circle_straight, ss, vv, es, ev, dthr, tthr, end)
    worst = c.when(drifting, straight.first_s, turned.first_s)
    some = c.when(drifting, straight.first_s <= straight.last_s, turned.first_s <= turned.last_s)
    there = first <= last
    size = {"s": s, "v": v, "es": es, "ev": ev, "dthr": dthr, "end": end}
    until = c.use(until_left, spare, half, rest, end, when=spare > 0)
    for instant in (until.last_s, t):
        c.lemma("daa_uncertain_disc_leaves_last", when=spare > 0, t=instant, **size)
    at = (s, v, es, ev, dthr)
    c.lemma(
        "daa_uncertain_worst_course_lies_within",
        s=s, v=v, ss=ss, vv=vv, es=es, ev=ev, dthr=dthr, tthr=tthr, end=end,
    )  # fmt: skip
    c.show(c.implies(c.all_of(there, inside), first == 0), "begins now")
    c.show(c.implies(c.all_of(there, c.negation(inside)), c.all_of(first == worst, some)), "begins")
    until_then, may = [
        c.define(daa_meaning.may_be_within_at, *at, instant) for instant in (until.last_s, t)
    ]
    c.show(
        c.implies(there, c.any_of(last == end, c.all_of(last == until.last_s, until_then))), "ends"
    )
    c.show(c.implies(c.all_of(there, drifting), last == end), "ends, if it may follow")
    begun = c.any_of(inside, c.all_of(some, worst <= t))
    held = c.define(well_clear.in_span, first, last, t)
    c.show(c.implies(c.all_of(t >= 0, t <= end, may, begun), held), "holds")
    c.show(c.implies(first > last, c.all_of(first == 1, last == 0)), "one empty span")
