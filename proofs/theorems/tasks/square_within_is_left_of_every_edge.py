"""For every polygon, whatever its number of edges, the kernel says that a square is within it exactly
when the square is left of each of the edges."""

from typing import Any

from cratous.core.tasks.coverage_steps import square_left_of, square_within
from cratous.proofs.claim import Claim
from cratous.proofs.methods.folds import verdict_is_defined
from cratous.spec.geofence import every_step


def model_step(so_far: Any, a: Any, b: Any, centre: Any, half: Any) -> Any:
    return every_step(so_far, square_left_of(a, b, centre, half))


def claim(c: Claim) -> None:
    centre, a, b = c.vector("centre"), c.vector("a"), c.vector("b")
    half = c.real("half")
    c.opaque(square_left_of)
    verdict_is_defined(c, square_within, (a, b), (centre, half), model_step, start=True)
