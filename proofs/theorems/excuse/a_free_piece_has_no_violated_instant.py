"""A manoeuvre that is still free after a piece was known there, and no instant of the piece violates the
volume: for every kind of volume and every state."""

from cratous.core.daa.volume import in_conflict
from cratous.core.excuse.way_out import after_piece, piece_lost
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss
from cratous.spec import excuse
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    kind, so_far = c.integer("kind"), c.integer("so_far")
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    piece, t = c.reals("piece t")
    known, surely = c.boolean("known"), c.boolean("surely")
    c.premise(c.any_of(so_far == -1, so_far == 0, so_far == 1))
    c.opaque(in_conflict, daa_meaning.violated_at)
    violated = c.define(daa_meaning.violated_at, kind, s, v, sz, vz, limits, t)
    then = c.define(excuse.lost_at, violated, t, piece)
    lost = c.use(piece_lost, kind, s, v, sz, vz, limits, piece)
    c.lemma(
        "daa_conflict_misses_no_instant", when=then, kind=kind, s=s, v=v, sz=sz, vz=vz, dthr=dthr,
        zthr=zthr, tthr=tthr, tcoa=tcoa, vmod=vmod, begin=t - t, end=piece, t=t,
    )  # fmt: skip
    c.show(c.implies(then, lost), "lost")
    after = c.use(after_piece, so_far, known, lost, surely)
    c.show(c.implies(after == 1, c.all_of(known, c.negation(then))))
