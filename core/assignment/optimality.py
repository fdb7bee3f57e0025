"""Whether a proved lower bound shows that a cost is optimal. Definition: `spec.assignment.bounds.none_is_cheaper`."""

from cratous.core.kernel import kernel


@kernel(implements="assignment.bounds.none_is_cheaper")
def shows_optimal(cost: int, bound: int) -> bool:
    """True iff no schedule that respects the bound is cheaper than this cost.

    cost: of a schedule, or another bound that is claimed; bound: what no schedule is below. One unit.
    """
    return cost <= bound
