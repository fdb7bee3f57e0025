"""Routes that ICAROUS requests from UxAS during a takeover: WPREQ, answered by RPRSP from UxAS's in-flight
planner.

UxAS plans live if configured (`UseUxasRoutePlanner`): each instance is told by COMND UXAS_PLANS, and by
ICAROUS_PLANS when an OwnRoutePlanner message says that UxAS's planner leaves planning to others. An answer is
only a proposal: ICAROUS has its kernels check it, and hands back on it by its number, or not at all.
"""

from __future__ import annotations

import math

from cratous.bridge.text_protocol import (
    IcarousPlans,
    RouteEnd,
    RoutePoint,
    RouteRequest,
    RouteStart,
    SetMode,
    UxasPlans,
)
from cratous.core.authority.timeliness import in_time
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.messages import Down
from cratous.services.flight.rejoining import Router
from cratous.services.icarous.return_to_path import bearing_rad
from cratous.services.icarous.route_requests import MOST_POINTS
from cratous.services.icarous_communication.state import (
    Note,
    Out,
    Refuse,
    State,
    plane,
    tellable,
    turn_radius_of,
)
from cratous.spec.errors import CratousError
from cratous.spec.mission import Position, Zone
from cratous.spec.mission.plan import Pose

KEPT = 4
"""Answers kept per vehicle, for a handback on one of them."""
MOST, WITHIN_MS = 4, 2000
"""At most this many routes are planned for an instance in this time [ms]; ours requests one per second."""
Places = tuple[tuple[float, float, float], ...]


class Proposals:
    """Route proposals of one service."""

    def __init__(self) -> None:
        self._on, self._zones, self._router = True, tuple[Zone, ...](), Router(())
        self._given: dict[int, dict[int, Places]] = {}
        self._planned_ms: dict[int, tuple[int, ...]] = {}

    def connected(self, vid: int) -> list[Out]:
        """An instance has connected: tell it who plans in flight; earlier proposals to it are void."""
        self._given.pop(vid, None)
        return [Down(vid, (UxasPlans() if self._on else IcarousPlans(),))]

    def planner_says(self, plans: bool, seated: list[int]) -> list[Out]:
        """UxAS's planner starts or stops planning. seated: vehicles whose instances are connected."""
        if plans == self._on:
            return []
        self._on = plans
        who = "UxAS" if plans else "each ICAROUS itself"
        out: list[Out] = [Note("INFO", f"ways back in flight are planned by {who}")]
        return [*out, *(one for vid in seated for one in self.connected(vid))]

    def asked(self, state: State, vid: int, line: RouteRequest, now_ms: int) -> list[Out]:
        """A WPREQ of an instance: answered with a route only while ICAROUS has the vehicle. state: of the
        service.
        """
        number, away = line.request, state.craft(vid).away is not None
        if number is None or not (self._on and away):
            why = "WPREQ without a number" if number is None else "WPREQ that is not for now"
            return [Refuse(why, f"vehicle {vid}: {line}"), *_answer(vid, number, (), 0.0)]
        last = self._planned_ms.get(vid, ())  # kept across connections
        if len(last) >= MOST and in_time(last[0], now_ms, WITHIN_MS):
            why = f"more than {MOST} WPREQ in {WITHIN_MS / 1000:g} s"
            return [Refuse(why, f"vehicle {vid}: {line}"), *_answer(vid, number, (), 0.0)]
        self._planned_ms[vid] = (*last, now_ms)[-MOST:]
        places, why = self._found(state, vid, line)
        if places:
            given = {**self._given.get(vid, {}), number: places}
            self._given[vid] = dict(list(given.items())[-KEPT:])
        text = f"vehicle {vid}: ICAROUS asks for a way back (request {number})"
        note = Note("WARN" if why else "INFO", f"{text}: {why or f'{len(places)} places'}")
        return [note, *_answer(vid, number, places, line.horizontal_mps)]

    def chosen(self, vid: int, line: SetMode) -> Places:
        """The proposal on which an instance hands back, if it names one that it was given; else ()."""
        if line.mode != "PASSIVE" or line.request is None:
            return ()
        return self._given.get(vid, {}).get(line.request, ())

    def _found(self, state: State, vid: int, line: RouteRequest) -> tuple[Places, str]:
        """The points of a route around the zones known to the instance, or () and the reason."""
        craft = state.craft(vid)
        if state.frame is None or craft.air is None:
            return (), "nothing is known of the vehicle"
        projection, air = plane(state.frame), craft.air
        start = projection.to_local(line.start_lat_deg, line.start_long_deg)
        end = Position(*projection.to_local(line.end_lat_deg, line.end_long_deg), line.end_alt_m)
        if craft.plan is None:
            heading_rad = bearing_rad(Position(*start, line.start_alt_m), end)
        else:  # the vehicle's track direction there
            track = craft.plan.track
            heading_rad = track.heading_rad(track.nearest(end, 0.0, track.length_m).s_m)
        zones, _ = tellable(state.frame, state.zones.values())
        if zones != self._zones:
            self._zones, self._router = zones, Router(tuple(zones))
        begins = Position(*start, line.start_alt_m)
        now = AirState(begins, math.radians(line.track_deg), air.speed_m_s, 0.0)
        try:
            way = self._router.way_to(now, turn_radius_of(craft, air), Pose(*end, heading_rad))
        except (CratousError, MemoryError) as error:
            return (), f"it cannot be planned: {error}"
        if len(way) not in range(1, MOST_POINTS + 1):
            return (), f"none is found of at most {MOST_POINTS} places that keeps the zones"
        return tuple((*projection.to_geodetic(p.north_m, p.east_m), p.alt_m) for p in way), ""


def _answer(vid: int, number: int | None, places: Places, speed_m_s: float) -> list[Out]:
    points = (RoutePoint(*place, speed_m_s, number) for place in places)
    return [Down(vid, (RouteStart(number), *points, RouteEnd(number)))]
