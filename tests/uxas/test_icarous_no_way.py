"""What ICAROUS is asked for and cannot plan, or only with all its time and memory: it says that there is no way."""

from __future__ import annotations

import pytest

from cratous.bridge import text_protocol as tp
from cratous.services.flight.dynamics import Limits
from cratous.services.icarous_communication.routes import PLANNERS
from cratous.services.icarous_program.routes import Planner
from cratous.services.mission.frames import Projection
from cratous.spec.mission import Frame, Zone, ZoneKind

PLANE = Projection(Frame(45.0, -121.0))
LIMITS = Limits(15.0, 33.0, 0.52, 5.0)
BLOCK = ((800.0, -600.0), (800.0, 600.0), (1400.0, 600.0), (1400.0, -600.0))


@pytest.mark.parametrize("alt_m", [1e5, 1e14, -1e14])
@pytest.mark.parametrize("kind", PLANNERS)
def test_a_climb_that_would_be_all_turns(kind: str, alt_m: float) -> None:
    ends = (*PLANE.to_geodetic(0.0, 0.0), 300.0, *PLANE.to_geodetic(3000.0, 0.0), alt_m)
    asked = tp.RouteRequest(kind, *ends, 0.0, 22.0, 0.0, 4)
    lines, why = Planner(PLANE, LIMITS).answer(asked, ())
    assert lines == [tp.RouteStart(4), tp.RouteEnd(4)]
    assert "too much for this airframe" in why


@pytest.mark.parametrize(("climb_m_s", "finds"), [(5.0, True), (0.0, False)])
def test_a_climb_that_an_airframe_can_do_or_not(climb_m_s: float, finds: bool) -> None:
    ends = (*PLANE.to_geodetic(0.0, 0.0), 300.0, *PLANE.to_geodetic(3000.0, 0.0), 900.0)
    asked = tp.RouteRequest("ASTAR", *ends, 0.0, 22.0, 0.0, 4)
    lines, why = Planner(PLANE, Limits(15.0, 33.0, 0.52, climb_m_s)).answer(asked, ())
    assert (len(lines) > 2, why == "") == (finds, finds)


def test_where_our_icarous_finds_no_way_it_says_so() -> None:
    ends = (*PLANE.to_geodetic(0.0, 0.0), 300.0, *PLANE.to_geodetic(1000.0, 0.0), 300.0)
    zone = Zone(1, ZoneKind.KEEP_OUT, BLOCK, 0.0, 500.0)
    for kind in PLANNERS:
        asked = tp.RouteRequest(kind, *ends, 0.0, 22.0, 0.0, 4)
        assert Planner(PLANE, LIMITS).answer(asked, (zone,)) == (
            [tp.RouteStart(4), tp.RouteEnd(4)],
            "its end breaks keep-out zone 1",
        )
    fast = tp.RouteRequest("ASTAR", *ends, 0.0, 99.0, 0.0, 4)
    assert "expected 15 to 33 m/s" in Planner(PLANE, LIMITS).answer(fast, ())[1]
