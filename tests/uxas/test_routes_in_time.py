"""Routes that an instance answers: within its time, with the reason, and past the traffic that it knows."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import pytest

from cratous.bridge.text_protocol import RoutePoint, RouteRequest
from cratous.core.authority.gate import UXAS, Gate
from cratous.core.avoidance.manoeuvre import Ability, Motion
from cratous.core.avoidance.prediction import Intruder
from cratous.services.flight.dynamics import Limits
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous_program import routes
from cratous.services.icarous_program.routes import BUDGET_S, Planner
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Daa, Frame, Position, Velocity, WellClear, Zone, ZoneKind

PLANE = Projection(Frame(45.0, -121.0))
LIMITS = Limits(15.0, 35.0, math.radians(20), 5.0)
DAA = Daa(WellClear(150.0, 50.0, 0.0, 0.0))
ABILITY = Ability(0.16, 15.0, 35.0, 5.0, 2.0, 50.0)


def box(number: int, south: float, west: float, north: float, east: float) -> Zone:
    corners = ((south, west), (south, east), (north, east), (north, west))
    return Zone(number, ZoneKind.KEEP_OUT, corners, 0.0, 5000.0)


def wanted(kind: str = "ASTAR", north_m: float = 3000.0) -> RouteRequest:
    ends = (*PLANE.to_geodetic(0.0, 0.0), 300.0, *PLANE.to_geodetic(north_m, 0.0), 300.0)
    return RouteRequest(kind, *ends, 0.0, 22.0, 0.0, 1)


def sensed(north_m: float, *others: Intruder) -> Sensed:
    motion = Motion(Position(north_m, 0.0, 300.0), 0.0, 22.0, 0.0)
    return Sensed(0, motion, ABILITY, others, Gate(UXAS, 0, False))


@pytest.mark.parametrize("kind", ["ASTAR", "GRID", "RRT", "SPLINE"])
def test_what_zones_exclude_is_told_without_a_search(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(routes, "_searched", lambda *_: pytest.fail("a search"))
    walls = (
        box(1, 800, -1500, 900, 1500), box(2, 3200, -1500, 3300, 1500),
        box(3, 800, -1500, 3300, -1400), box(4, 800, 1400, 3300, 1500),
    )  # fmt: skip
    lines, why = Planner(PLANE, LIMITS).answer(wanted(kind), walls)
    assert len(lines) == 2
    assert why.startswith("no path exists from 300 to 300 m: zones 1, 2, 3, 4 together separate")
    _, inside = Planner(PLANE, LIMITS).answer(wanted(kind), (box(7, 2900, -90, 3100, 90),))
    assert inside == "its end breaks keep-out zone 7"


def clock(step_s: float) -> Callable[[], float]:
    """A clock that goes on by step_s at each look."""
    ticks = itertools.count()
    return lambda: next(ticks) * step_s


def test_a_search_in_vain_ends_in_time_and_says_so() -> None:
    """The way through the gap keeps no margin, so it is found late; each look at the clock takes 0.2 s here."""
    walls = box(1, 800, -9000, 1200, -1), box(2, 800, 1, 1200, 9000)
    north = box(3, 2000, -9000, 2100, 8000), box(4, 800, -9000, 2100, -8900)
    zones = (*walls, *north, box(5, 800, 7900, 2100, 8000))
    asked = wanted(north_m=1600.0)
    lines, why = Planner(PLANE, LIMITS, now_s=clock(0.2)).answer(asked, zones)
    assert (len(lines), why.split(";")[0]) == (2, f"none found in time ({BUDGET_S:g} s)")
    lines, why = Planner(PLANE, LIMITS, now_s=clock(0.0)).answer(asked, zones)
    assert (len(lines) > 2, why) == (True, "")


def test_a_route_from_the_vehicle_is_held_against_traffic() -> None:
    planner = Planner(PLANE, LIMITS, DAA, clock(0.0))
    crosses = Intruder(9, Position(1500.0, 1500.0, 300.0), Velocity(0.0, -22.0, 0.0))
    plain, _ = planner.answer(wanted(), ())
    # elsewhere, or with nobody in the way, it is the same route
    for seen in (sensed(-500.0, crosses), sensed(0.0), None):
        assert planner.answer(wanted(), (), seen) == (plain, "")
    past, why = planner.answer(wanted(), (), sensed(0.0, crosses))
    assert (why, past != plain) == ("", True)
    points = [line for line in past if isinstance(line, RoutePoint)]
    now_s, least_m, at = 0.0, math.inf, (0.0, 0.0)
    for point in points[1:]:
        to = PLANE.to_local(point.lat_deg, point.long_deg)
        took_s = math.dist(at, to) / point.speed_mps
        for k in range(20):
            t, share = now_s + took_s * k / 20, k / 20
            place = [a + share * (b - a) for a, b in zip(at, to, strict=True)]
            least_m = min(least_m, math.dist(place, (1500.0, 1500.0 - 22.0 * t)))
        now_s, at = now_s + took_s, to
    assert least_m > DAA.well_clear.dthr_m
    # one from which nobody flees: the route stays, with the reason
    near = Intruder(8, Position(100.0, 0.0, 300.0), Velocity(0.0, 0.0, 0.0))
    kept, why = planner.answer(wanted(), (), sensed(0.0, near))
    assert kept == plain
    assert "not permitted against 8; no path exists" in why
