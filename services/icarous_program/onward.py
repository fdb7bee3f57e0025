"""With which waypoint ICAROUS goes on as it hands back: GOTOWP, said before SETMOD PASSIVE."""

from __future__ import annotations

from cratous.bridge.text_protocol import Dialect, GoToWaypoint
from cratous.services.icarous.foresight import points_back
from cratous.services.icarous.messages import FromInstance, Sensed, Wish
from cratous.services.icarous.state import State
from cratous.spec.authority.cycle import OFFER


def onward(
    said: tuple[FromInstance, ...], state: State, sensed: Sensed, dialect: Dialect
) -> tuple[GoToWaypoint, ...]:
    """The waypoint at which the way back that was found free begins, if control is offered now and it is one of the plan's.

    None where UxAS has told a place between two waypoints to resume at, and to the original's UxAS, which reads the
    number as noise.
    """
    offers = any(isinstance(one, Wish) and one.act == OFFER for one in said)
    told = state.told
    if not offers or not told.waypoints or dialect is Dialect.ORIGINAL:
        return ()
    begins = points_back(state, sensed)[0]
    ahead = range(min(told.next_index, len(told.waypoints) - 1), len(told.waypoints))
    return tuple(GoToWaypoint(k) for k in ahead if told.waypoints[k] == begins)[:1]
