"""A step is not called safe if a volume is violated at any instant of a piece on the way to it, or of
the straight flight from it within the horizon: for every kind of volume and every state."""

from cratous.core.daa.steps import piece_counts, straight_from
from cratous.core.daa.volume import in_conflict
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss, by_name
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    kind = c.integer("kind")
    s, v, sz, vz, limits = any_loss(c)
    piece, at, begin, end, t = c.reals("piece at begin end t")
    c.opaque(in_conflict, daa_meaning.violated_at)
    state = {"kind": kind, "s": s, "v": v, "sz": sz, "vz": vz, "t": t}
    size = by_name(limits)
    violated = c.define(daa_meaning.violated_at, kind, s, v, sz, vz, limits, t)
    on_piece = c.define(daa_meaning.lost_on_piece, violated, t, piece, at, begin, end)
    blocked = c.all_of(
        c.use(piece_counts, at, begin, end),
        c.use(in_conflict, kind, s, v, sz, vz, limits, at - at, piece),
    )
    c.lemma(
        "daa_conflict_misses_no_instant", when=on_piece, begin=at - at, end=piece, **state, **size
    )
    c.show(c.implies(on_piece, blocked), "on the way")
    later = c.define(daa_meaning.lost_from_step, violated, t, at, begin, end)
    since = c.use(straight_from, at, begin)
    red = c.use(in_conflict, kind, s, v, sz, vz, limits, since, end - at)
    c.lemma(
        "daa_conflict_misses_no_instant", when=later, begin=since, end=end - at, **state, **size
    )
    c.show(c.implies(later, red), "straight on")
