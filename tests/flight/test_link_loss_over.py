"""What was chosen without the link and is over costs nothing more, in a flight and in those after it."""

from __future__ import annotations

from typing import Any

from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.core.authority.gate import ICAROUS, Gate
from cratous.core.authority.link_loss import OVER, RETURN, Loss
from cratous.services.flight import lost_link
from cratous.services.icarous import link_loss
from cratous.services.icarous.lost_link import LostLink, NoLink
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.state import Config, State
from cratous.spec.mission import Daa, Position


def test_what_is_over_looks_for_no_way() -> None:
    def never(*_given: Any) -> tuple[Position, ...]:
        raise AssertionError("nothing is flown any more")

    plan = LostLink(RETURN, 3000, "return", never, Position(900.0, 900.0, 300.0))
    config = Config(1, Daa(VOLUME), PROJECTION, 500, lost_link=plan)
    state = State(no_link=NoLink(Loss(OVER, 1000)))
    now = Sensed(60_000, NORTH, ABILITY, (), Gate(ICAROUS, 1, False))
    after, said = link_loss.heartbeat(config, state, now)
    assert (after.no_link.loss, said) == (Loss(OVER, 1000), ())
    assert after.no_link.course is not None


def test_the_ways_around_zones_of_missions_that_are_over_are_let_go() -> None:
    assert lost_link._router.cache_info().maxsize is not None
