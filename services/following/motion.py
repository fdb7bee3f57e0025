"""Motion of an entity from its newest state, and its prediction. Frame: that of the request; metres, seconds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from cratous.core.kernel import Vec2
from cratous.services.pipeline.coordinates import RequestPlaces
from cratous.spec.errors import BadInput

STALE_MS = 5_000
"""If its newest state is older than this, the entity's position counts as unknown [ms]."""
SPEED_MOST_M_S = 1_000.0
"""A state with a higher speed is rejected [m/s]."""


class Motion(NamedTuple):
    """at: north and east [m]; velocity [m/s]; time_ms: of the state; route: corners that it will follow, ()
    for none.
    """

    at: Vec2
    velocity: Vec2
    time_ms: int
    route: tuple[Vec2, ...] = ()

    def after(self, seconds: float) -> Vec2:
        """Position after `seconds` [s]: along its route from the nearest point on, else in a straight line."""
        return self._along(math.hypot(*self.velocity) * seconds)

    def ahead(self, far_m: float) -> Vec2:
        """The position far_m [m] ahead on its route; behind it if negative: back along the route, at most to
        the route's beginning, or along its course if it has not entered the route yet.
        """
        back_m = max(-far_m, 0.0)
        if not (back_m and self.route):
            return self._along(far_m)
        route = self.route if len(self.route) > 1 else (*self.route, *self.route)
        k, t = _nearest(self.at, route)
        if (k, t) == (0, 0.0):
            return self._replace(route=())._along(far_m)
        a, b = route[k], route[k + 1]
        entered = Vec2(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y))
        return _walked(entered, route[k::-1], back_m)

    def _along(self, far_m: float) -> Vec2:
        """The position after far_m [m] of its way; straight back if negative."""
        if self.route:
            return _walked(self.at, _rest(self.at, self.route), far_m)
        speed = math.hypot(*self.velocity)
        share = far_m / speed if speed else 0.0
        return Vec2(self.at.x + share * self.velocity.x, self.at.y + share * self.velocity.y)

    def halfway_to(self, place: Vec2) -> Motion:
        """The motion of the midpoint between it and a fixed position."""

        def middle(p: Vec2) -> Vec2:
            return Vec2((p.x + place.x) / 2, (p.y + place.y) / 2)

        slow = Vec2(self.velocity.x / 2, self.velocity.y / 2)
        return Motion(middle(self.at), slow, self.time_ms, tuple(map(middle, self.route)))


def _walked(here: Vec2, corners: Sequence[Vec2], far_m: float) -> Vec2:
    """The position far_m [m] along corners from here, at most the last corner."""
    for corner in corners:
        leg_m = math.dist(here, corner)
        step_m = min(far_m, leg_m)
        share = step_m / (leg_m or 1.0)
        here = Vec2(here.x + share * (corner.x - here.x), here.y + share * (corner.y - here.y))
        far_m -= step_m
    return here


def _rest(at: Vec2, route: Sequence[Vec2]) -> Sequence[Vec2]:
    """The corners of a route that are still ahead of a place."""
    if len(route) == 1:
        return route
    k, t = _nearest(at, route)
    return route if (k, t) == (0, 0.0) else route[k + 1 :]


def _nearest(at: Vec2, route: Sequence[Vec2]) -> tuple[int, float]:
    """Leg and fraction of it at which a route of at least two corners is nearest to a place."""
    gaps = []
    for k, (a, b) in enumerate(pairwise(route)):
        n, e = b.x - a.x, b.y - a.y
        t = ((at.x - a.x) * n + (at.y - a.y) * e) / (n * n + e * e or 1.0)
        t = min(max(t, 0.0), 1.0)
        gaps.append((math.dist(at, (a.x + t * n, a.y + t * e)), k, t))
    _, k, t = min(gaps)
    return k, t


def motion_of(
    state: Any, places: RequestPlaces, where: str, route: tuple[Vec2, ...] = ()
) -> Motion:
    """The motion in an EntityState: ground speed and course, else forward speed and heading.

    BadInput for one without a valid place, speed or direction.
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
