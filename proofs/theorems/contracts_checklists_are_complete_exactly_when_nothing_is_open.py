"""A checklist is complete exactly when every item on it is ticked off, for every number of items."""

from cratous.core.contracts.checklists import list_complete
from cratous.proofs.claim import Claim
from cratous.spec.contracts.checklists import complete, open_step


def claim(c: Claim) -> None:
    missing, any_open, ticked = c.boolean("missing"), c.boolean("any_open"), c.boolean("ticked")
    c.fold(
        list_complete,
        acc=missing,
        model=any_open,
        item=(ticked,),
        context=(),
        model_start=False,
        model_step=open_step,
        model_finish=complete,
        relation=c.same,
    )
