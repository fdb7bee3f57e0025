"""The bridge counts as alive exactly when each heartbeat, and the end, came in time after the one before,
so that at no instant the last was too old, for every number of heartbeats."""

from typing import Any

from cratous.core.authority.timeliness import Beats, beats_in_time
from cratous.proofs.claim import Claim
from cratous.spec.authority.timeliness import in_time


def claim(c: Claim) -> None:
    ok, time, bound = c.boolean("all_in_time"), c.integer("time"), c.integer("bound")
    c.premise(bound >= 0)
    t, before = c.integer("t"), c.integer("before")
    when_it_comes = c.define(in_time, time, before, time, bound)
    at_any_instant = c.define(in_time, t, before, time, bound)
    c.show(c.implies(when_it_comes, at_any_instant), "when it comes decides for every instant")
    acc = Beats(c.whole("last"), c.boolean("ok"))
    model = Beats(c.whole("model_last"), ok)

    def model_step(beats: Any, now: Any, longest: Any) -> Any:
        # at no instant is a message older than when the next one comes, as was shown
        return Beats(now, in_time(now, beats.last, now, longest) and beats.ok)

    def related(one: Any, other: Any) -> Any:
        ranged = c.all_of(one.last >= -(2**61), one.last <= 2**61)
        return c.all_of(c.same(one, other), ranged)

    c.fold(
        beats_in_time,
        acc=acc,
        model=model,
        item=(time,),
        context=(bound,),
        model_start=Beats(0, True),
        model_step=model_step,
        model_finish=lambda beats: beats.ok,
        relation=related,
    )
