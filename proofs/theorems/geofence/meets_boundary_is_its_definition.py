"""For every polygon, whatever its number of vertices, the kernel says that a leg meets the boundary
exactly when it meets one of the edges."""

from typing import Any

from cratous.core.geofence.planar import meets_boundary, segments_meet
from cratous.proofs.claim import Claim
from cratous.proofs.methods.folds import verdict_is_defined
from cratous.spec.geofence import any_step


def model_step(met: Any, a: Any, b: Any, p: Any, q: Any) -> Any:
    return any_step(met, segments_meet(p, q, a, b))


def claim(c: Claim) -> None:
    p, q, a, b = c.vector("p"), c.vector("q"), c.vector("a"), c.vector("b")
    c.opaque(segments_meet)
    verdict_is_defined(c, meets_boundary, (a, b), (p, q), model_step, start=False)
