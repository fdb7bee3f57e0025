"""A piece that refuses a manoeuvre does so for a reason: the other aircraft is known then, and at an
instant of the piece, which the times kernel names, the volume is violated."""

from cratous.core.daa.volume import conflict_span, in_conflict
from cratous.core.excuse.way_out import after_piece, piece_lost
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_loss
from cratous.proofs.theorems.daa.conflict_has_an_instant import witnesses
from cratous.spec import excuse
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    kind, so_far = c.integer("kind"), c.integer("so_far")
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    piece = c.real("piece")
    known, surely = c.boolean("known"), c.boolean("surely")
    c.premise(c.any_of(so_far == 0, so_far == 1))
    c.opaque(in_conflict, conflict_span, daa_meaning.violated_at)
    state = (kind, s, v, sz, vz, limits)
    lost = c.use(piece_lost, *state, piece)
    zero = piece - piece
    first, _ = c.use(conflict_span, *state, zero, piece)
    some = witnesses(c, "", (s, v, sz, vz), limits, zero, piece)
    c.lemma(
        "daa_conflict_has_an_instant", kind=kind, s=s, v=v, sz=sz, vz=vz, dthr=dthr, zthr=zthr,
        tthr=tthr, tcoa=tcoa, vmod=vmod, begin=zero, end=piece, **some,
    )  # fmt: skip
    violated = c.define(daa_meaning.violated_at, *state, first)
    why = c.define(excuse.lost_at, violated, first, piece)
    after = c.use(after_piece, so_far, known, lost, surely)
    c.show(c.implies(after == -1, c.all_of(known, surely, why)))
