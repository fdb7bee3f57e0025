"""The worst state of the uncertain circle is nearer and faster by as much as is not known, and its course
is turned towards the line of sight by the angles that the discs of position and velocity span; it comes
straight on where they reach it."""

from cratous.core.daa.turn import turned
from cratous.core.daa.uncertainty import circle_first, circle_straight
from cratous.core.well_clear.interval import horizontal_interval_taumod
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    s, v = c.vector("s"), c.vector("v")
    es, ev, dthr, tthr, end = c.reals("es ev dthr tthr end")
    distance, speed, beside, ahead = c.reals("distance speed beside ahead")
    for least in (es, ev, dthr, tthr, distance, speed, beside, ahead):
        c.premise(least >= 0)
    ss, vv = s.x * s.x + s.y * s.y, v.x * v.x + v.y * v.y
    c.premise(ss == distance * distance)
    c.premise(vv == speed * speed)
    # what is left of distance and speed across their tangents to the discs
    c.premise(ss == beside * beside + es * es)
    c.premise(vv == ahead * ahead + ev * ev)
    c.opaque(turned, circle_straight, horizontal_interval_taumod)
    found = c.use(circle_first, s, v, es, ev, dthr, tthr, end)
    straight = c.use(circle_straight, ss, vv, es, ev, dthr, tthr, end)
    turns = c.calls(turned)
    c.show(len(turns) == 2, "turned twice")
    angles = ((beside, es), (ahead, ev))
    course = c.define(daa_meaning.sighted, s, v)
    for (before, cosine, sine), (across, radius) in zip(turns, angles, strict=False):
        c.show(c.same(before, course), "the course so far")
        c.show(c.all_of(cosine == across, sine == radius), "by the angle of the disc")
        course = c.use(turned, before, cosine, sine)
    reached = c.any_of(course.y <= 0, distance == 0, speed == 0)
    c.show(c.implies(reached, c.same(found, straight)), "straight on")
    judgements = c.calls(horizontal_interval_taumod)
    c.show(len(judgements) == 1, "one state is judged")
    for at, course_m_s, *others in judgements:
        c.show(c.same(tuple(others), (dthr, tthr, 0, end)), "judged as it is")
        c.show(c.all_of(at.x == es - distance, at.y == 0), "nearer")
        moves = c.all_of(distance > 0, speed > 0)
        for part, wanted in ((course_m_s.x, course.x), (course_m_s.y, course.y)):
            along = part * ss * vv == (speed + ev) * wanted
            c.show(c.implies(moves, along), "faster, on that course")
        judged = c.use(horizontal_interval_taumod, at, course_m_s, *others)
        c.show(c.implies(c.negation(reached), c.same(found, judged)), "on that course")
