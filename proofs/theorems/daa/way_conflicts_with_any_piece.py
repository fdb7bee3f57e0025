"""The way to a step loses a volume exactly if one of its pieces does, for every number of pieces."""

from cratous.core.daa.steps import way_conflicts
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    c.fold(
        way_conflicts,
        acc=c.boolean("lost"),
        model=c.whole("lost_pieces"),
        item=(c.boolean("piece"),),
        context=(),
        model_start=0,
        model_step=daa_meaning.lost_pieces,
        model_finish=daa_meaning.lost_somewhere,
        relation=lambda lost, pieces: c.all_of(pieces >= 0, c.same(lost, pieces > 0)),
    )
