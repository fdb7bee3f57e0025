"""When the circle may be violated, for uncertain states, is a span within [0, T], or empty."""

from cratous.core.daa.uncertainty import circle_first, circle_span, circle_straight, until_left
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    es, ev, dthr, tthr, end = c.reals("es ev dthr tthr end")
    for least in (es, ev, dthr, tthr, end):
        c.premise(least >= 0)
    c.opaque(circle_first, circle_straight, until_left)
    first, last = c.use(circle_span, s, v, es, ev, dthr, tthr, end)
    ss, vv = s.x * s.x + s.y * s.y, v.x * v.x + v.y * v.y
    c.lemma(
        "daa_uncertain_worst_course_lies_within",
        s=s, v=v, ss=ss, vv=vv, es=es, ev=ev, dthr=dthr, tthr=tthr, end=end,
    )  # fmt: skip
    wide = dthr + es
    c.lemma(
        "daa_until_left_is_until_the_last", when=vv > ev * ev, t=end, end=end,
        a=vv - ev * ev, half=s.x * v.x + s.y * v.y - ev * wide, rest=ss - wide * wide,
    )  # fmt: skip
    c.show(c.implies(first <= last, c.all_of(first >= 0, last <= end)))
