"""Two at one place and height are in one cylinder now; two that have parted when their heights meet never
are: an example of each."""

from cratous.core.daa.coordination import enters_cylinder
from cratous.core.kernel import Vec2
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    here, ahead = Vec2(0, 0), Vec2(10, 0)
    c.show(c.use(enters_cylinder, here, Vec2(0, 0), 0, 1, 5, 1), "now")
    c.show(c.negation(c.use(enters_cylinder, here, ahead, -10, 1, 20, 1)), "parted")
