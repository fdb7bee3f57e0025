"""For every polygon, whatever its number of vertices, the kernel says that the boundary is nearer to
a point than the buffer, just so near, or farther, as the nearest of its edges is."""

from typing import Any

from cratous.core.geofence.distance import boundary_against, edge_against
from cratous.proofs.claim import Claim
from cratous.spec.geofence import Found, against, found_step


def model_step(found: Any, a: Any, b: Any, p: Any, d: Any) -> Any:
    verdict = edge_against(p, a, b, d)
    return found_step(found, verdict < 0, verdict <= 0)


def claim(c: Claim) -> None:
    p, a, b, d = c.vector("p"), c.vector("a"), c.vector("b"), c.real("d")
    c.opaque(edge_against)
    c.lemma("geofence_edge_verdict_is_one_of_three", p=p, a=a, b=b, d=d)

    def related(least: Any, found: Any) -> Any:
        word = c.when(found.nearer, -1, c.when(found.within, 0, 1))
        return c.all_of(c.same(least, word), c.implies(found.nearer, found.within))

    c.fold(
        boundary_against,
        acc=c.whole("least"),
        model=Found(c.boolean("nearer"), c.boolean("within")),
        item=(a, b),
        context=(p, d),
        model_start=Found(False, False),
        model_step=model_step,
        model_finish=against,
        relation=related,
    )
