"""For a trace of any length and any one of its samples, bounded until as it is decided step by step is what
its definition says of the whole trace: once decided, no later sample changes it."""

from typing import Any

from cratous.core.requirements.until import Times, Until, until_holds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.samples import START, any_sample, judged_as_meant
from cratous.spec.requirements.operators import until_step


def claim(c: Claim) -> None:
    sample, asked = any_sample(c)
    at, low, high = asked
    acc = Until(
        c.whole("last"),
        Times(c.whole("tainted"), c.whole("candidate")),
        c.whole("verdict"),
        c.boolean("reached"),
    )

    def related(u: Any, m: Any) -> Any:
        ranged = c.all_of(u.last >= START, u.last <= 2**61, c.same(u.last, m.last))
        past = c.all_of(u.times.tainted <= u.last, u.times.candidate <= u.last)
        bound = c.all_of(u.times.tainted >= START, u.times.candidate >= START)
        before = c.all_of(
            u.verdict == 3, c.negation(u.reached), m.hold == 2, m.value == 0, u.last < at
        )
        tainted = u.times.tainted >= at
        waits = c.all_of(
            u.last >= at,
            u.verdict == 3,
            u.last - at < high,
            c.same(u.reached, u.times.candidate >= at + low),
            m.hold == c.when(tainted, 1, 2),
            m.value == c.when(u.reached, 1, 0),
            c.negation(c.all_of(u.reached, tainted)),
        )
        final = c.any_of(
            m.hold == 0,
            u.last - at >= high,
            m.value == 2,
            c.all_of(m.value == 1, m.hold == 1),
        )
        decided = c.all_of(
            u.last >= at,
            u.verdict >= 0,
            u.verdict <= 2,
            m.hold >= 0,
            m.hold <= 2,
            c.same(u.verdict, m.value),
            final,
        )
        return c.all_of(ranged, past, bound, c.any_of(before, waits, decided))

    judged_as_meant(c, until_holds, acc, until_step, related, (sample, asked))
