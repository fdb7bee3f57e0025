"""A task counts as served exactly if it is whatever was not seen and is still to come, as not served exactly
if it is not whatever that is, and else as not known."""

from cratous.core.tasks.service import Watched, service_verdict
from cratous.proofs.claim import Claim
from cratous.spec import service

WAYS = (False, True)


def claim(c: Claim) -> None:
    ends, helped, harmed = c.boolean("ends"), c.boolean("helped"), c.boolean("harmed")
    ended, over, unseen = c.boolean("ended"), c.boolean("over"), c.boolean("unseen")
    seen = Watched(ended, over, unseen, c.boolean("short"), c.boolean("near"), c.boolean("missed"))
    verdict = c.use(service_verdict, seen)
    served = c.define(service.served_if, ends, helped, harmed, seen)
    c.show(c.implies(verdict == service.SERVED, served), "served whatever was not seen")
    not_served = c.negation(served)
    c.show(c.implies(verdict == service.NOT_SERVED, not_served), "not served whatever that was")
    every = [
        c.define(service.served_if, one, two, three, seen)
        for one in WAYS
        for two in WAYS
        for three in WAYS
    ]
    none = c.negation(c.any_of(*every))
    c.show(c.implies(c.all_of(*every), verdict == service.SERVED), "if it is so, it is said")
    c.show(c.implies(none, verdict == service.NOT_SERVED), "if it never is, that is said")
    known = c.any_of(verdict == service.SERVED, verdict == service.NOT_SERVED)
    c.show(c.any_of(known, verdict == service.NOT_KNOWN), "else it is not known")
