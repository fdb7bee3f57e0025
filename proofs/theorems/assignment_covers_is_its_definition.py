"""A state covers another for the kernel exactly when none of its times is later, for every number of
times."""

from cratous.core.assignment_steps import covers
from cratous.proofs.claim import Claim
from cratous.spec import assignment


def claim(c: Claim) -> None:
    c.fold(
        covers,
        acc=c.boolean("ok"),
        model=c.boolean("covered"),
        item=(c.integer("mine"), c.integer("other")),
        context=(),
        model_start=True,
        model_step=assignment.is_covered_step,
        model_finish=assignment.covered_result,
        relation=c.same,
    )
