"""Who is on the ground: by where a vehicle was, at a landing site or beside all of them.

A vehicle is on the ground where it is not above it by more than a centimetre: that of a site within its disc, the flat
terrain elsewhere. In a mission without landing sites nobody is, but who starts there and has not left it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

from cratous.judge.log import State
from cratous.judge.mission import Mission
from cratous.judge.sites import Site
from cratous.judge.tracks import Track
from cratous.judge.verdict import seconds

NEAR_M = 0.01
MOVES = "and did not stand there at the end"


class Down(NamedTuple):
    """The first contact [ms], at which site (None: beside all), and what is wrong with what followed; "" if nothing."""

    at_ms: int
    site: Site | None
    fault: str

    @property
    def good(self) -> bool:
        """It came down on a site, stayed, and stands there."""
        return self.site is not None and not self.fault

    def words(self) -> str:
        """In words."""
        where = f"on {self.site.name}" if self.site else "beside every landing site"
        return (
            f"came to the ground {where} at {seconds(self.at_ms)}{self.fault and ', ' + self.fault}"
        )


def site_at(mission: Mission, state: State) -> Site | None:
    """The site in whose disc a state is, at whatever height."""
    for site in mission.sites:
        if math.dist((state.north_m, state.east_m), (site.north_m, site.east_m)) <= site.radius_m:
            return site
    return None


def grounded(mission: Mission, state: State) -> bool:
    """Whether a vehicle is on the ground at a state."""
    if not mission.sites:
        return False
    site = site_at(mission, state)
    ground = mission.terrain_m if site is None else site.ground_m
    return state.alt_m <= ground + NEAR_M


def is_at(mission: Mission, vehicle: int, state: State) -> bool:
    """Whether a vehicle that starts on the ground is as low as there."""
    return state.alt_m <= mission.grounds[vehicle] + NEAR_M


def first_in_the_air(mission: Mission, vehicle: int, states: Sequence[State]) -> int:
    """The number of the first of its states at which a vehicle is not where it started on the ground any more."""
    if vehicle not in mission.grounds:
        return 0
    off = (k for k, state in enumerate(states) if not is_at(mission, vehicle, state))
    return next(off, len(states))


def stands_at_start(mission: Mission, vehicle: int, track: Track | None) -> bool:
    """Whether a vehicle has stood where it started on the ground to the end, and all of that was logged."""
    if track is None or track.doubt or vehicle not in mission.grounds or not track.states:
        return False
    last, states = track.states[-1], track.states
    moves = last.north_m_s or last.east_m_s or last.up_m_s
    return first_in_the_air(mission, vehicle, states) == len(states) and not moves


def on_ground(mission: Mission, vehicle: int, track: Track) -> set[int]:
    """When the legs of one of ours begin whose both ends are on the ground [ms]."""
    states, began = track.states, first_in_the_air(mission, vehicle, track.states)
    found = {state.time_ms for state in states[: max(began - 1, 0)]}
    return found | {
        state.time_ms
        for state, after in pairwise(states[began:])
        if grounded(mission, state) and grounded(mission, after)
    }


def down(mission: Mission, vehicle: int, track: Track | None) -> Down | None:
    """How a vehicle came to the ground; None if it did not."""
    states = [] if track is None else track.states
    states = states[first_in_the_air(mission, vehicle, states) :]
    first = next((k for k, state in enumerate(states) if grounded(mission, state)), None)
    if first is None:
        return None
    site, fault = site_at(mission, states[first]), ""
    for state in states[first:]:
        if not grounded(mission, state):
            fault = f"and was in the air again at {seconds(state.time_ms)}"
        elif site_at(mission, state) != site:
            fault = f"and rolled beyond it by {seconds(state.time_ms)}"
        if fault:
            break
    last = states[-1]
    if not fault and (last.north_m_s or last.east_m_s or last.up_m_s):
        fault = MOVES
    return Down(states[first].time_ms, site, fault)
