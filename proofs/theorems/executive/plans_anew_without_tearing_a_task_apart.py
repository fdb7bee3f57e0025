"""A task that cannot keep its deadline any more leads to another plan only where that interrupts no task,
and is waited for where it would; it is given up exactly if it is being flown or there is no planner."""

from cratous.core.executive.steps import late_act
from cratous.proofs.claim import Claim
from cratous.spec import executive


def claim(c: Claim) -> None:
    under_way, may_plan, torn = (c.boolean(n) for n in ("under_way", "may_plan", "torn"))
    act = c.use(late_act, under_way, may_plan, torn)
    c.show(act == c.define(executive.late_answer, under_way, may_plan, torn), "its definition")
    plans = act == executive.PLAN_ANEW
    whole = c.all_of(may_plan, c.negation(torn), c.negation(under_way))
    c.show(c.same(plans, whole), "no task is torn apart")
    hopeless = c.any_of(under_way, c.negation(may_plan))
    c.show(c.same(act == executive.GIVE_UP, hopeless), "given up only where no plan can help")
