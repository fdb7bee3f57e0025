"""For every polygon, whatever its number of vertices and their order, the kernel's location of a
point is the definition's: 0 on an edge, else 1 or -1 by the parity of the edges that the ray from
the point meets."""

from typing import Any

from cratous.core.geofence.planar import (
    Seen,
    crosses_ray,
    locate,
    on_segment,
)
from cratous.proofs.claim import Claim
from cratous.spec.geofence import Count, count_step, location


def model_step(count: Any, a: Any, b: Any, p: Any) -> Any:
    return count_step(count, on_segment(p, a, b), a, b, p)


def claim(c: Claim) -> None:
    p, a, b = c.vector("p"), c.vector("a"), c.vector("b")
    acc = Seen(c.boolean("on"), c.boolean("odd"))
    model = Count(c.boolean("model_on"), c.whole("crossings"))
    c.opaque(on_segment, crosses_ray)
    c.lemma("geofence_crosses_ray_is_its_definition", p=p, a=a, b=b)

    def related(seen: Any, count: Any) -> Any:
        odd = c.same(seen.odd, count.crossings % 2 == 1)
        return c.all_of(c.same(seen.on, count.on), odd, count.crossings >= 0)

    c.fold(
        locate,
        acc=acc,
        model=model,
        item=(a, b),
        context=(p,),
        model_start=Count(False, 0),
        model_step=model_step,
        model_finish=location,
        relation=related,
    )
