"""A step is called unsafe only for a reason: an instant of a piece on the way to it, or of the straight
flight from it within the horizon, at which the volume is violated; the times kernel names it."""

from cratous.core.daa.steps import piece_counts, straight_from
from cratous.core.daa.volume import conflict_span, in_conflict
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss
from cratous.proofs.theorems.daa.conflict_has_an_instant import witnesses
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    piece, at, begin, end = c.reals("piece at begin end")
    c.opaque(in_conflict, conflict_span, daa_meaning.violated_at)
    state = (kind, s, v, sz, vz, limits)
    known = {
        "kind": kind, "s": s, "v": v, "sz": sz, "vz": vz, "dthr": dthr, "zthr": zthr, "tthr": tthr,
        "tcoa": tcoa, "vmod": vmod,
    }  # fmt: skip
    zero = at - at
    blocked = c.all_of(c.use(piece_counts, at, begin, end), c.use(in_conflict, *state, zero, piece))
    first, _ = c.use(conflict_span, *state, zero, piece)
    some = witnesses(c, "_way", (s, v, sz, vz), limits, zero, piece)
    c.lemma("daa_conflict_has_an_instant", begin=zero, end=piece, **some, **known)
    violated = c.define(daa_meaning.violated_at, *state, first)
    why = c.define(daa_meaning.lost_on_piece, violated, first, piece, at, begin, end)
    c.show(c.implies(blocked, why), "on the way")
    since = c.use(straight_from, at, begin)
    red = c.use(in_conflict, *state, since, end - at)
    when, _ = c.use(conflict_span, *state, since, end - at)
    more = witnesses(c, "_on", (s, v, sz, vz), limits, since, end - at)
    c.lemma("daa_conflict_has_an_instant", begin=since, end=end - at, **more, **known)
    then = c.define(daa_meaning.violated_at, *state, when)
    why = c.define(daa_meaning.lost_from_step, then, when, at, begin, end)
    c.show(c.implies(red, why), "straight on")
