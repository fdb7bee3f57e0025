"""The watcher of requests steps from stage to stage as the definition says, whatever happens."""

from cratous.core.contracts.requests import stage_after
from cratous.proofs.claim import Claim
from cratous.spec.contracts import requests


def claim(c: Claim) -> None:
    stage, what = c.integer("stage"), c.integer("what")
    c.premise(c.all_of(stage >= 0, stage <= 4))
    c.premise(c.all_of(what >= 0, what <= 3))
    c.show(
        c.same(c.use(stage_after, stage, what), c.define(requests.after, stage, what)), "the stage"
    )
