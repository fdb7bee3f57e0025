"""Tasks are found to be done as often as is asked for exactly when each has an n-th time for every n up
to its least number and none for any n beyond its greatest, for every number of tasks."""

from typing import Any

from cratous.core.schedule.choice import as_asked, as_asked_step
from cratous.proofs.claim import Claim
from cratous.spec.schedule import flown_as_asked


def model_step(ok: Any, least: Any, most: Any, times: Any) -> Any:
    # the last time that has to be, and the first that may not be, are the witnesses
    last = flown_as_asked(least, ok, least, most, times)
    return last and flown_as_asked(most + 1, ok, least, most, times)


def claim(c: Claim) -> None:
    least, most, times, n = (c.integer(name) for name in ("least", "most", "times", "n"))
    ok = c.boolean("ok")
    c.premise(times >= 0)
    step = c.use(as_asked_step, ok, least, most, times)
    at_n = c.define(flown_as_asked, n, ok, least, most, times)
    c.show(c.implies(step, at_n), "if it is so, it is so for every n")
    last = c.define(flown_as_asked, least, ok, least, most, times)
    beyond = c.define(flown_as_asked, most + 1, ok, least, most, times)
    c.show(c.implies(c.all_of(last, beyond), step), "if not, one of two numbers shows it")
    # once, where it is asked for once; twice; not at all; and where it is not asked for
    c.show(c.define(flown_as_asked, 1, True, 1, 1, 1), "an example: once")
    c.show(c.negation(c.define(flown_as_asked, 2, True, 1, 1, 2)), "an example: twice")
    c.show(c.define(flown_as_asked, 1, True, 0, 1, 2), "an example: the first of two is no fault")
    c.show(c.negation(c.define(flown_as_asked, 1, True, 1, 1, 0)), "an example: left out")
    c.show(c.negation(c.define(flown_as_asked, 1, True, 0, 0, 1)), "an example: not asked for")
    c.fold(
        as_asked,
        acc=c.boolean("all_so_far"),
        model=c.boolean("all_meant"),
        item=(least, most, times),
        context=(),
        model_start=True,
        model_step=model_step,
        relation=c.same,
    )
