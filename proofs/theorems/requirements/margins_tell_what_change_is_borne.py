"""A signal is at least its bound exactly when its margin is not negative, and the margin is how far it may
fall, or has to rise, until that changes."""

from cratous.core.requirements.verdict import margin, reaches
from cratous.proofs.claim import Claim
from cratous.spec.requirements.operators import at_least


def claim(c: Claim) -> None:
    value, bound, change = c.reals("value bound change")
    far = c.use(margin, value, bound)
    said = c.use(reaches, value, bound)
    c.show(c.same(said, c.define(at_least, 0, value, bound)), "as it is")
    c.show(c.same(said, far >= 0), "the margin's sign is the verdict")
    changed = c.define(at_least, change, value, bound)
    c.show(c.same(changed, change >= -far), "after any change")
