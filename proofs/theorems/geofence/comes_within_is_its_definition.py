"""For every polygon, whatever its number of vertices, the kernel says that a leg comes within a buffer
of the boundary exactly when it comes within it of one of the edges."""

from typing import Any

from cratous.core.geofence.distance import comes_within, leg_within
from cratous.proofs.claim import Claim
from cratous.proofs.methods.folds import verdict_is_defined
from cratous.spec.geofence import any_step


def model_step(near: Any, a: Any, b: Any, p: Any, q: Any, d: Any) -> Any:
    return any_step(near, leg_within(p, q, a, b, d))


def claim(c: Claim) -> None:
    p, q, a, b, d = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b"), c.real("d")
    c.opaque(leg_within)
    verdict_is_defined(c, comes_within, (a, b), (p, q, d), model_step, start=False)
