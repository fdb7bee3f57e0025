"""How an entity moves, from its newest state, and where it will be. Frame: a request's, metres; seconds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.services.pipeline.places import RequestPlaces
from cratous.spec.errors import BadInput

STALE_MS = 5_000
"""Of an entity whose newest state is older nobody knows where it is."""
SPEED_MOST_M_S = 1_000.0
"""Of an entity that is said to be faster nobody knows where it will be."""
ROUNDS = 30
"""Steps to where a vehicle meets an entity; each halves the error at least where it flies twice as fast."""


class Motion(NamedTuple):
    """at: north and east [m]; velocity [m/s]; when [ms]; route: corners that it will fly along, () none."""

    at: Vec2
    velocity: Vec2
    time_ms: int
    route: tuple[Vec2, ...] = ()

    def after(self, seconds: float) -> Vec2:
        """Where it is so much later [s]: along its route, which it enters where it is nearest; else straight on."""
        way_m = math.hypot(*self.velocity) * seconds
        if not self.route:
            v = self.velocity
            return Vec2(self.at.x + v.x * seconds, self.at.y + v.y * seconds)
        here = self.at
        for corner in _rest(self.at, self.route):
            leg_m = math.dist(here, corner)
            step_m = min(way_m, leg_m)
            share = step_m / (leg_m or 1.0)
            here = Vec2(here.x + share * (corner.x - here.x), here.y + share * (corner.y - here.y))
            way_m -= step_m
        return here

    def halfway_to(self, place: Vec2) -> Motion:
        """The motion of the middle between it and a place that stands."""

        def middle(p: Vec2) -> Vec2:
            return Vec2((p.x + place.x) / 2, (p.y + place.y) / 2)

        slow = Vec2(self.velocity.x / 2, self.velocity.y / 2)
        return Motion(middle(self.at), slow, self.time_ms, tuple(map(middle, self.route)))

    def met_from(self, start: Vec2, speed_m_s: float) -> tuple[Vec2, float]:
        """Where and in how many seconds one who flies straight at this speed, the greater one, meets it."""
        seconds = 0.0
        for _ in range(ROUNDS):
            seconds = math.dist(start, self.after(seconds)) / speed_m_s
        return self.after(seconds), seconds


def _rest(at: Vec2, route: Sequence[Vec2]) -> Sequence[Vec2]:
    """The corners of a route that are still to come, seen from a place."""
    if len(route) == 1:
        return route
    gaps = []
    for k, (a, b) in enumerate(pairwise(route)):
        n, e = b.x - a.x, b.y - a.y
        t = ((at.x - a.x) * n + (at.y - a.y) * e) / (n * n + e * e or 1.0)
        t = min(max(t, 0.0), 1.0)
        gaps.append((math.dist(at, (a.x + t * n, a.y + t * e)), k))
    return route[min(gaps)[1] + 1 :]


def motion_of(
    state: Any, places: RequestPlaces, where: str, route: tuple[Vec2, ...] = ()
) -> Motion:
    """The motion that an EntityState tells: over ground by speed and course, else by speed ahead and heading.

    BadInput for one at no place, of no speed or of no direction.
    """
    pose = places.pose(state.Location, 0.0, where, "Location")
    names, speed, course = "Groundspeed, Course", state.Groundspeed, state.Course
    if speed == 0:
        names, speed, course = "u, Heading", state.u, state.Heading
    if not (abs(speed) <= SPEED_MOST_M_S and math.isfinite(course)):
        raise BadInput(
            "a state without a velocity", where=where, item=names,
            expected=f"finite numbers, at most {SPEED_MOST_M_S:g} m/s", got=f"{speed:g}, {course:g}",
        )  # fmt: skip
    at = math.radians(course)
    velocity = Vec2(speed * math.cos(at), speed * math.sin(at))
    return Motion(Vec2(pose.north_m, pose.east_m), velocity, max(0, state.Time), route)
