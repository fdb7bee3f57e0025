"""Once the way loses a volume, every later step conflicts: no step behind a lost piece is safe."""

from cratous.core.daa.steps import lost_before
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    before, piece, next_piece = c.boolean("before"), c.boolean("piece"), c.boolean("next_piece")
    lost = c.use(lost_before, before, piece)
    c.show(c.implies(c.any_of(before, piece), lost), "a lost piece is kept")
    c.show(c.implies(lost, c.use(lost_before, lost, next_piece)), "for ever")
