"""For a trace of any length and any one of its samples, bounded since as it is decided step by step is what
its definition says of the samples up to that one."""

from typing import Any

from cratous.core.requirements.since import Broken, Found, Since, since_holds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.samples import START, any_sample, judged_as_meant
from cratous.spec.requirements.operators import since_step


def claim(c: Claim) -> None:
    sample, asked = any_sample(c)
    at, _, high = asked
    acc = Since(
        c.whole("last"),
        Found(c.whole("latest_true"), c.whole("candidate")),
        Broken(c.whole("tainted"), c.whole("broken")),
        c.whole("verdict"),
    )

    def related(s: Any, m: Any) -> Any:
        ranged = c.all_of(s.last >= START, s.last <= 2**61, c.same(s.last, m.last))
        found = c.all_of(
            s.found.true >= START - 1,
            s.found.true <= s.found.candidate,
            s.found.candidate <= s.last,
        )
        broken = c.all_of(
            s.broken.broken >= START,
            s.broken.broken <= s.broken.tainted,
            s.broken.tainted <= s.last,
        )
        true = c.all_of(s.found.true >= at - high, s.found.true >= s.broken.tainted)
        open_ = c.all_of(s.found.candidate >= at - high, s.found.candidate >= s.broken.broken)
        word = c.when(true, 2, c.when(open_, 1, 0))
        return c.all_of(ranged, found, broken, s.verdict == word, c.same(s.verdict, m.value))

    judged_as_meant(c, since_holds, acc, since_step, related, (sample, asked))
