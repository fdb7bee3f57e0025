"""The uncertainty of the horizontal velocity is the far one from the distance on, the near one at no
range, linear between, and always one of the two or between them."""

from cratous.core.daa.uncertainty import speed_error
from cratous.proofs.claim import Claim
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    range_, near, far, distance = c.reals("range near far distance")
    error = c.use(speed_error, range_, near, far, distance)
    c.show(c.define(daa_meaning.speed_error, range_, near, far, distance, error))
    c.show(
        c.any_of(c.all_of(near <= error, error <= far), c.all_of(far <= error, error <= near)),
        "between",
    )
