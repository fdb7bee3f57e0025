"""The way to a step loses a volume exactly if one of its pieces does, for every number of pieces."""

from cratous.core.daa_steps import way_conflicts
from cratous.proofs.claim import Claim
from cratous.spec import daa_meaning


def claim(c: Claim) -> None:
    c.fold(
        way_conflicts,
        acc=c.boolean("lost"),
        model=c.boolean("any_lost"),
        item=(c.boolean("piece"),),
        context=(),
        model_start=False,
        model_step=daa_meaning.step_conflicts,
        model_finish=daa_meaning.the_way,
        relation=c.same,
    )
