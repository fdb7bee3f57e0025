"""A manoeuvre of any number of pieces is refused exactly if one of them is surely lost where the other
aircraft is known, and free exactly if all of it is known and nothing is lost."""

from cratous.core.excuse.way_out import manoeuvre_judged
from cratous.proofs.claim import Claim
from cratous.spec import excuse


def claim(c: Claim) -> None:
    known, lost, surely = c.boolean("known"), c.boolean("lost"), c.boolean("surely")
    c.fold(
        manoeuvre_judged,
        acc=c.whole("so_far"),
        model=excuse.Flown(c.boolean("refused"), c.boolean("open")),
        item=(known, lost, surely),
        context=(),
        model_start=excuse.Flown(False, False),
        model_step=excuse.flown_step,
        model_finish=excuse.judged,
        relation=lambda m, f: c.same(m, c.when(f.refused, -1, c.when(f.open, 0, 1))),
    )
