"""Against tubes that grow steadily a hold is refused only if there are instants, which can be named, at which it is
not above the tube with the cylinder, not below it, and not beside it."""

from cratous.core.permit.for_ever import above_for_ever, beside_for_ever, hold_clear
from cratous.core.permit.pieces import Growth, Tube
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state
from cratous.proofs.methods.meetings import about, any_margins
from cratous.spec.permit import motion


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    margins = any_margins(c)
    wide_start, wide_rate, high_start, high_rate = c.reals(
        "wide_start wide_rate high_start high_rate"
    )
    down, up, far, vertex, root = c.reals("down up far vertex root")
    c.premise(c.all_of(wide_start >= 0, wide_rate >= 0, high_start >= 0, high_rate >= 0))
    none = far - far
    tube = Tube(Growth(wide_start, wide_rate, none), Growth(high_start, high_rate, none))
    around, layer = about(tube, margins)
    c.opaque(above_for_ever, beside_for_ever, motion.reached_at, motion.levelled_at)
    clear = c.use(hold_clear, s, v, sz, vz, tube, margins)
    met = []
    # where the layer climbs faster, or sinks, it is there at an instant, which is named
    for z, w, then in ((sz, vz, down), (0 - sz, 0 - vz, up)):
        c.premise(
            c.implies(
                c.all_of(w < high_rate, z > layer.start_m),
                then * (high_rate - w) == z - layer.start_m,
            )
        )
        c.lemma(
            "permit_above_for_ever_that_is_refused_is_levelled",
            sz=z, vz=w, start=layer.start_m, rate=high_rate, far=then,
        )  # fmt: skip
        some = [
            c.all_of(t >= 0, c.define(motion.levelled_at, z, w, layer, t)) for t in (none, then)
        ]
        met.append(c.any_of(*some))
    a = v.x * v.x + v.y * v.y - wide_rate * wide_rate
    b = 2 * (s.x * v.x + s.y * v.y - around.start_m * wide_rate)
    k = s.x * s.x + s.y * s.y - around.start_m * around.start_m
    size = c.when(b >= 0, b, 0 - b) + c.when(k >= 0, k, 0 - k)
    c.premise(c.implies(a < 0, c.all_of(far >= 1, far * (0 - a) >= size)))
    c.premise(c.implies(a > 0, 2 * a * vertex + b == 0))
    c.premise(c.implies(c.all_of(a == 0, b < 0), root * b + k == 0))
    c.lemma(
        "permit_beside_for_ever_that_is_refused_is_reached",
        s=s, v=v, start=around.start_m, rate=wide_rate, far=far, vertex=vertex, root=root,
    )  # fmt: skip
    some = [
        c.all_of(t >= 0, c.define(motion.reached_at, s, v, around, t))
        for t in (none, far, vertex, root)
    ]
    met.append(c.any_of(*some))
    c.show(c.implies(c.negation(clear), c.all_of(*met)))
