"""Who comes straight on, nearer by all that the position may be off and faster by all that the velocity may
be, may violate the volume at exactly the instants of the uncertain circle's span at which altitude and climb
rate, as far off as they may be, violate the layer; a state that is farther off does not count."""

from itertools import combinations

from cratous.core.daa.records import Relative
from cratous.core.daa.uncertainty import Uncertainty, circle_straight
from cratous.core.kernel import Vec2
from cratous.core.well_clear.interval import horizontal_interval_taumod
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    distance, speed, es, ev, dthr, tthr, end, t = c.reals("distance speed es ev dthr tthr end t")
    sz, vz, dz, dw, ez, ew, zthr, tcoa, vmod = c.reals("sz vz dz dw ez ew zthr tcoa vmod")
    ahead, ds, dv = c.vector("ahead"), c.vector("ds"), c.vector("dv")
    for least in (distance, speed, es, ev, dthr, tthr, t):
        c.premise(least >= 0)
    c.premise(t <= end)
    # from the intruder to ownship, in any direction
    c.premise(ahead.x * ahead.x + ahead.y * ahead.y == 1)
    c.opaque(
        horizontal_interval_taumod, well_clear.horizontal_violation, well_clear.layer_violation_at
    )
    span = c.use(circle_straight, distance * distance, speed * speed, es, ev, dthr, tthr, end)
    c.lemma(
        "daa_uncertain_straight_course_is_the_nearest_and_fastest",
        distance=distance, speed=speed, es=es, ev=ev, dthr=dthr, tthr=tthr, end=end, t=t,
    )  # fmt: skip
    near, fast = distance - es, speed + ev
    c.lemma(
        "well_clear_horizontal_violation_is_alike_in_every_direction",
        s=Vec2(near - t * fast, 0), v=Vec2(-fast, 0), by=ahead, dthr=dthr, tthr=tthr,
    )  # fmt: skip

    def may_be_violated(nearer: Vec2, faster: Vec2) -> object:
        s, v = [Vec2(size * ahead.x, size * ahead.y) for size in (distance, -speed)]
        return c.define(
            daa_meaning.may_be_violated_at,
            Relative(s, v, sz, vz),
            Relative(nearer, faster, dz, dw),
            Uncertainty(es, ez, ev, ew),
            Thresholds(dthr, zthr, tthr, tcoa, vmod),
            t,
        )

    worst = may_be_violated(*[Vec2(size * ahead.x, size * ahead.y) for size in (-es, -ev)])
    for one, other in combinations(c.calls(well_clear.horizontal_violation), 2):
        c.congruence(well_clear.horizontal_violation, one, other)
    up, off, error = (
        daa_meaning.Vertical(sz, vz),
        daa_meaning.Vertical(dz, dw),
        daa_meaning.Vertical(ez, ew),
    )
    layer = c.define(daa_meaning.layer_may_be_violated_at, up, off, error, zthr, tcoa, vmod, t)
    held = c.define(well_clear.in_span, *span, t)
    c.show(c.same(worst, c.all_of(held, layer)), "the worst state")
    known = c.all_of(c.define(well_clear.within, ds, es), c.define(well_clear.within, dv, ev))
    c.show(c.implies(may_be_violated(ds, dv), known), "no state farther off")
