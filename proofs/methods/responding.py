"""What theorems on answers to conflicts are about: any response so far, and whatever is told next."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.contracts.responses import Response
from cratous.proofs.claim import Claim
from cratous.spec.contracts import responses


class Told(NamedTuple):
    """What a step of a response is told, in the kernel's order."""

    conflict: Any
    ours: Any
    good: Any
    found: Any
    free: Any
    lasted: Any
    taken: Any


def any_response(c: Claim) -> tuple[Response, Told]:
    """Any response that is consistent, and what the next step is told, which may be anything."""
    before = Response(c.integer("state"), c.boolean("off"))
    c.premise(c.define(responses.consistent, before.state, before.off))
    return before, Told(*[c.boolean(name) for name in Told._fields])
