"""A checklist is complete exactly when every item on it is ticked off, for every number of items."""

from cratous.core.contracts.checklists import list_complete
from cratous.proofs.claim import Claim
from cratous.spec.contracts.checklists import complete, open_items


def claim(c: Claim) -> None:
    missing, ticked = c.boolean("missing"), c.boolean("ticked")
    c.fold(
        list_complete,
        acc=missing,
        model=c.whole("still_open"),
        item=(ticked,),
        context=(),
        model_start=0,
        model_step=open_items,
        model_finish=complete,
        relation=lambda any_open, number: c.all_of(number >= 0, c.same(any_open, number > 0)),
    )
