"""Suite `polygon`: where a point lies, by the exact reading of the fold `locate`.

A case gives `polygon` (a list of [x, y], either order, not closed), `point` [x, y] and the truth
`exact.location`: inside, outside or boundary. Each is located with both orders of the vertices.
Nearness with a buffer, space, moving polygons and recovery points are not covered.
"""

from __future__ import annotations

from typing import Any

from cratous.core.compiled import exact
from cratous.core.kernel import Vec2
from cratous.core.polygon import edges_of, locate
from cratous.services.conform import Result, failed, not_covered, passed
from cratous.services.conform.values import identity, numbers, vector
from cratous.spec.errors import BadInput

WORDS = {-1: "outside", 0: "boundary", 1: "inside"}
COVERED = "contain2d"


def judge(case: dict[str, Any]) -> Result:
    """Compare one case."""
    name = identity(case)
    kind = str(case.get("kind", COVERED))
    if kind != COVERED:
        return not_covered(name, kind)
    truth = case.get("exact")
    if not isinstance(truth, dict) or "location" not in truth:
        return not_covered(name, "no exact location given")
    wanted = truth["location"]
    if wanted not in WORDS.values():
        raise BadInput(
            "no location",
            item="exact.location",
            expected=", ".join(WORDS.values()),
            got=repr(wanted),
        )
    corners = case.get("polygon")
    if not isinstance(corners, list) or len(corners) < 3:
        raise BadInput("not a polygon", item="polygon", expected="a list of 3 or more [x, y]")
    vertices = [numbers(c, f"polygon[{k}]", 2) for k, c in enumerate(corners)]
    x, y = vector(case, "point", 2)
    for order, ring in (("as given", vertices), ("reversed", vertices[::-1])):
        edges = edges_of([(a, b) for a, b in ring])
        got = WORDS[exact(locate, edges, Vec2(x, y))]
        if got != wanted:
            text = f"expected {wanted}, got {got} (vertices {order}); point ({x!r}, {y!r}), "
            return failed(name, f"{wanted} taken for {got}", f"{text}{len(vertices)} vertices", 2)
    return passed(name, 2)
