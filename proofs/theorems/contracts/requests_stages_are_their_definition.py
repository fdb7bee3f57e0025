"""The watcher of requests takes each act for what it is and steps from stage to stage as the definition says, whatever happens."""

from cratous.core.contracts.requests import happening, stage_after
from cratous.proofs.claim import Claim
from cratous.spec.contracts import requests


def claim(c: Claim) -> None:
    stage, what = c.integer("stage"), c.integer("what")
    c.premise(c.all_of(stage >= 0, stage <= 4))
    c.premise(c.all_of(what >= 0, what <= 3))
    c.show(
        c.same(c.use(stage_after, stage, what), c.define(requests.after, stage, what)), "the stage"
    )
    act, about, ticket = c.integer("act"), c.integer("about"), c.integer("ticket")
    own = c.use(happening, act, ticket, ticket)
    c.show(own == c.define(requests.means, act), "what an act is for its own request")
    mine = c.when(about == ticket, c.define(requests.means, act), 0)
    c.show(c.use(happening, act, about, ticket) == mine, "what an act is for a request")
