"""Which vehicles are on the ground, by position: on a landing site or outside all of them.

A vehicle is on the ground if it is at most a centimetre above it: a site's ground within its disc,
the flat terrain elsewhere. In a mission without landing sites none is, except one that starts there
and has not left it.
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
    """Time of first contact [ms], the site (None: outside all), and faults afterwards; "" if none."""

    at_ms: int
    site: Site | None
    fault: str

    @property
    def good(self) -> bool:
        """Whether it landed on a site, stayed, and is at rest there."""
        return self.site is not None and not self.fault

    def words(self) -> str:
        """The landing in words."""
        where = f"on {self.site.name}" if self.site else "beside every landing site"
        return (
            f"came to the ground {where} at {seconds(self.at_ms)}{self.fault and ', ' + self.fault}"
        )


def site_at(mission: Mission, state: State) -> Site | None:
    """The site whose disc contains a state, at any height."""
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
    """Whether a vehicle that starts on the ground is no higher than there."""
    return state.alt_m <= mission.grounds[vehicle] + NEAR_M


def first_in_the_air(mission: Mission, vehicle: int, states: Sequence[State]) -> int:
    """Index of the first state at which a vehicle has left the ground where it started."""
    if vehicle not in mission.grounds:
        return 0
    off = (k for k, state in enumerate(states) if not is_at(mission, vehicle, state))
    return next(off, len(states))


def stands_at_start(mission: Mission, vehicle: int, track: Track | None) -> bool:
    """Whether a vehicle stood where it started on the ground until the end, with complete logging."""
    if track is None or track.doubt or vehicle not in mission.grounds or not track.states:
        return False
    last, states = track.states[-1], track.states
    moves = last.north_m_s or last.east_m_s or last.up_m_s
    return first_in_the_air(mission, vehicle, states) == len(states) and not moves


def on_ground(mission: Mission, vehicle: int, track: Track) -> set[int]:
    """Start times [ms] of a mission vehicle's legs with both ends on the ground."""
    states, began = track.states, first_in_the_air(mission, vehicle, track.states)
    found = {state.time_ms for state in states[: max(began - 1, 0)]}
    return found | {
        state.time_ms
        for state, after in pairwise(states[began:])
        if grounded(mission, state) and grounded(mission, after)
    }


def down(mission: Mission, vehicle: int, track: Track | None) -> Down | None:
    """How a vehicle landed; None if it did not."""
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
