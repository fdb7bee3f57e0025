"""The model of rounding allows exactly the real values that lie within the outward margin of a result,
so no theorem about rounding rests on a model that is stricter than the margin that is used."""

from cratous.core.readings.exact.certainty import outward_margin
from cratous.proofs.claim import Claim
from cratous.spec import rounding


def claim(c: Claim) -> None:
    result, real, unit, tiny = c.reals("result real unit tiny")
    margin = c.use(outward_margin, result, unit, tiny)
    inside = c.define(rounding.between, result - margin, real, result + margin)
    c.show(c.same(c.define(rounding.rounded, result, real, unit, tiny), inside))
