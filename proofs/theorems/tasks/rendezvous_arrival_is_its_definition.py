"""Who counts as arrived in company was within the tolerance of the common time, so two who were are no farther
apart than two of it; who counts as beyond a place is not behind the line across his way."""

from cratous.core.tasks.rendezvous import beyond, in_company
from cratous.proofs.claim import Claim
from cratous.spec import rendezvous


def claim(c: Claim) -> None:
    one, two, common, tolerance = (
        c.integer(name) for name in ("one", "two", "common", "tolerance")
    )
    c.premise(tolerance >= 0)
    first = c.use(in_company, one, common, tolerance)
    second = c.use(in_company, two, common, tolerance)
    c.show(c.same(first, c.define(rendezvous.near_to, one, common, tolerance)), "its definition")
    near = c.all_of(one - two <= 2 * tolerance, two - one <= 2 * tolerance)
    c.show(c.implies(c.all_of(first, second), near), "two who are, are near to each other")
    here, place, ahead = c.vector("here"), c.vector("place"), c.vector("ahead")
    said = c.use(beyond, here, place, ahead)
    north, east = here.x - place.x, here.y - place.y
    past = c.define(rendezvous.beyond_line, north, east, ahead.x, ahead.y)
    c.show(c.same(said, past), "beyond the line")
