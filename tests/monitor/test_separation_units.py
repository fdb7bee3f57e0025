"""The monitor asks its kernels in whole units: the answers are those in seconds and metres."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.geofence.mission_legs import leg_ok
from cratous.core.kernel import Vec2
from cratous.core.well_clear import StandardThresholds, violation_within
from cratous.services.mission.zones import exact_leg_ok
from cratous.services.monitor.samples import Sample
from cratous.services.monitor.separation import WholeUnits
from cratous.spec.mission import Position, Zone, ZoneKind

NUMBERS = st.one_of(
    st.sampled_from([0.0, 0.1, 150.0, -150.0, 30.0, 149.99999999999997, 1e-300, 2200.7]),
    st.floats(-400, 400, allow_nan=False),
)
PLACES = st.builds(Position, NUMBERS, NUMBERS, NUMBERS)
LIMITS = st.sampled_from([0.0, 0.1, 15.0, 30.0, 35.3, 150.0])


def answered(units: WholeUnits, ends: tuple[Sample, Sample, Sample, Sample]) -> bool:
    """Of own and other at the beginning, and at the end; somebody far off, in other parts of a metre, is there too."""
    far = Position(1e6 / 3, 5e-324, -0.1)
    own, other, own_after, other_after = ends
    before = {1: own, 2: other, 3: own._replace(position=far)}
    after = {1: own_after, 2: other_after, 3: own_after._replace(position=far), 4: own}
    return units.step(before, after).lost(1, 2)


def at(time_ms: int, place: Position) -> Sample:
    return Sample(time_ms, place, 0.0, True, 0)


@given(
    st.lists(PLACES, min_size=4, max_size=4),
    st.sampled_from([1, 33, 100, 1000]),
    st.tuples(LIMITS, LIMITS, LIMITS, LIMITS),
)
def test_whole_units_answer_as_metres_and_seconds_do(
    places: list[Position], span_ms: int, limits: tuple[float, float, float, float]
) -> None:
    own, other, own_after, other_after = places
    s0, s1 = (
        [Fraction(a) - Fraction(b) for a, b in zip(p[:3], q[:3], strict=True)]
        for p, q in ((own, other), (own_after, other_after))
    )
    h: Any = Fraction(span_ms, 1000)
    v: Any = [(b - a) / h for a, b in zip(s0, s1, strict=True)]
    s: Any = s0
    exact: Any = [Fraction(x) for x in limits]
    thresholds = StandardThresholds(*exact)
    wanted = violation_within(Vec2(*s[:2]), Vec2(*v[:2]), s[2], v[2], thresholds, h)
    ends = (
        at(500, own),
        at(500, other),
        at(500 + span_ms, own_after),
        at(500 + span_ms, other_after),
    )
    assert answered(WholeUnits(StandardThresholds(*limits)), ends) == wanted


def test_touching_is_lost_and_a_hair_more_is_not() -> None:
    units = WholeUnits(StandardThresholds(150.0, 30.0, 0.0, 0.0))
    for east_m, lost in ((150.0, True), (150.00000000000003, False)):
        pair = Position(0.0, 0.0, 300.0), Position(0.0, east_m, 330.0)
        ends = at(0, pair[0]), at(0, pair[1]), at(1000, pair[0]), at(1000, pair[1])
        assert answered(units, ends) is lost


@pytest.mark.parametrize(
    ("limits", "away", "later", "lost"),
    [
        # head on at 100 m/s: TTHR before 150 m is reached at 1514.9 m
        ((150.0, 30.0, 15.0, 0.0), (0.0, 1514.0, 0.0), (0.0, 1510.7, 0.0), True),
        ((150.0, 30.0, 15.0, 0.0), (0.0, 1520.0, 0.0), (0.0, 1516.7, 0.0), False),
        # 10 m/s down: TCOA before the same altitude is at 100 m
        ((150.0, 30.0, 0.0, 10.0), (0.0, 0.0, 99.0), (0.0, 0.0, 98.67), True),
        ((150.0, 30.0, 0.0, 10.0), (0.0, 0.0, 105.0), (0.0, 0.0, 104.67), False),
        # places in whole metres, thresholds that are not
        ((1.5, 30.0, 0.0, 0.0), (1.0, 1.0, 0.0), (1.0, 1.0, 0.0), True),
        ((1.25, 30.0, 0.0, 0.0), (1.0, 1.0, 0.0), (1.0, 1.0, 0.0), False),
    ],
)
def test_thresholds_are_in_metres_and_seconds(
    limits: tuple[float, float, float, float], away: Any, later: Any, lost: bool
) -> None:
    here = Position(0.0, 0.0, 0.0)
    ends = at(0, here), at(0, Position(*away)), at(33, here), at(33, Position(*later))
    assert answered(WholeUnits(StandardThresholds(*limits)), ends) is lost


def test_a_span_without_time_is_none() -> None:
    place = at(7, Position(0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="a span of 0 ms"):
        answered(WholeUnits(StandardThresholds(150.0, 30.0, 0.0, 0.0)), (place,) * 4)


CORNERS = [(0.1, -150.0), (0.1, 149.99999999999997), (400.0, 30.0), (1 / 3, -150.0)]


@given(
    st.lists(PLACES, min_size=2, max_size=2),
    st.sampled_from([CORNERS, [*CORNERS[:2], (5e-324, 0.0)]]),
    st.sampled_from(list(ZoneKind)),
    st.sampled_from([(-1e3, 1e3), (30.0, 149.99999999999997), (0.1, 0.2)]),
)
def test_legs_are_held_to_zones_as_in_metres(
    leg: list[Position],
    corners: list[tuple[float, float]],
    kind: ZoneKind,
    heights: tuple[float, float],
) -> None:
    zone = Zone(1, kind, tuple(corners), *heights)
    exact: Any = Fraction
    whole = replace(
        zone,
        vertices=tuple((exact(n), exact(e)) for n, e in corners),
        floor_m=exact(zone.floor_m),
        ceiling_m=exact(zone.ceiling_m),
        padding_m=0,
    )
    ends: Any = [Position(*map(Fraction, place)) for place in leg]
    for p, q in ((ends[0], ends[1]), (ends[0], ends[0])):
        there = [Position(*map(float, place)) for place in (p, q)]
        assert exact_leg_ok(*there, zone) == leg_ok(p, q, whole)
