"""Arbitrary values for theorems on responses to conflicts: a response so far, and the next input."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.contracts.responses import Response
from cratous.proofs.claim import Claim
from cratous.spec.contracts import responses


class Told(NamedTuple):
    """The inputs of a step of a response, in the kernel's order."""

    conflict: Any
    ours: Any
    good: Any
    found: Any
    free: Any
    lasted: Any
    taken: Any


def any_response(c: Claim) -> tuple[Response, Told]:
    """An arbitrary consistent response, and arbitrary inputs of the next step."""
    before = Response(c.integer("state"), c.boolean("off"))
    c.premise(c.define(responses.consistent, before.state, before.off))
    return before, Told(*[c.boolean(name) for name in Told._fields])
