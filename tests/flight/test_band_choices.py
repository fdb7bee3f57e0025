"""Manoeuvres that the bands propose: of the kind that the mission asks for, and where nothing keeps well clear."""

from __future__ import annotations

import math

import pytest
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.core.authority.gate import ICAROUS, Gate
from cratous.core.avoidance.manoeuvre import fly_to
from cratous.core.avoidance.prediction import Intruder
from cratous.core.avoidance.resolution import Choice, first_conflict_s, keeps_clear, resolve
from cratous.services.icarous.band_choices import of_bands, recovering
from cratous.services.icarous.bands import Whose, watched
from cratous.services.icarous.foresight import scene_of
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.proposal import manoeuvre, nmac_of
from cratous.services.icarous.state import Config, State
from cratous.spec.mission import OrderedDaa, Position, Resolution, Velocity, Zone, ZoneKind

WAY = (Position(-1000.0, 0.0, 300.0), Position(9000.0, 0.0, 300.0))
LEVEL = Choice("heading", 0.0, 22.0, 0.0, 0.0, False, None)
CROSSES = Intruder(9, Position(1100.0, 850.0, 300.0), Velocity(0.0, -20.0, 0.0))
NEAR = Intruder(9, Position(700.0, 60.0, 300.0), Velocity(-22.0, 0.0, 0.0))
"""One that crosses from the right; one ahead, so near that nothing keeps its volume."""


def daa_of(first: Resolution) -> OrderedDaa:
    return OrderedDaa(VOLUME, buffer=1.25, resolution=first)


def seen(other: Intruder) -> Sensed:
    return Sensed(0, NORTH, ABILITY, (other,), Gate(ICAROUS, 1, False))


def state_of(daa: OrderedDaa, other: Intruder, *zones: Zone, told: bool = False) -> State:
    found, _ = watched(Whose(1, daa, 500, told), None, seen(other))
    assert found is not None
    way = Told(zones, waypoints=WAY, next_index=1, speed_m_s=22.0)
    return State(told=way, bands=found)


def proposed(daa: OrderedDaa, other: Intruder, *, told: bool = False) -> tuple[Choice, ...]:
    bands = state_of(daa, other, told=told).bands
    assert bands is not None
    return of_bands(bands, daa, seen(other), LEVEL)


@pytest.mark.parametrize("first", [Resolution.ALTITUDE, Resolution.SPEED])
def test_the_bands_propose_changes_of_the_kind_that_is_asked_for(first: Resolution) -> None:
    """On course, clear, within what the airframe can do, and no larger than the largest change."""
    daa = daa_of(first)
    config = Config(1, daa, PROJECTION, 500)
    choices = proposed(daa, CROSSES)
    assert choices
    scene = scene_of(config, state_of(daa, CROSSES), seen(CROSSES))
    for one in choices:
        assert (one.kind, one.heading_rad) == (first, 0.0)
        assert ABILITY.min_speed_m_s <= one.speed_m_s <= ABILITY.max_speed_m_s
        assert abs(one.climb_m_s) in (0.0, ABILITY.max_climb_m_s)
        assert (one.climb_for_s > 0) is (first == Resolution.ALTITUDE)
        assert keeps_clear(NORTH, ABILITY, scene, one)
    # somebody who reads all bands changes nothing of it
    assert proposed(daa, CROSSES, told=True) == choices
    assert proposed(daa_of(Resolution.HEADING), CROSSES) == ()


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_where_nothing_keeps_well_clear_the_recovery_bands_are_flown(side: float) -> None:
    """The turn that regains it, to the side that the bands prefer; not the one that loses it last."""
    other = NEAR._replace(position=NEAR.position._replace(east_m=side * 60.0))
    daa = daa_of(Resolution.HEADING)
    config, now, state = Config(1, daa, PROJECTION, 500), seen(other), state_of(daa, other)
    assert state.bands is not None
    assert state.bands.recovers
    (first, *_) = recovering(state.bands, daa, now, LEVEL)
    scene = scene_of(config, state, now)
    assert not resolve(NORTH, ABILITY, scene, 0.0, 22.0, None).clear
    after, choice = manoeuvre(config, state, now, frozenset(), False)
    assert (choice.clear, choice.kind) == (False, "heading")
    assert choice.first_violation_s is not None
    assert (choice.heading_rad, after.held) == (first.heading_rad, choice)
    assert math.copysign(1.0, math.sin(choice.heading_rad)) == -side
    pieces = fly_to(NORTH, ABILITY, *choice[1:5], scene.lookahead_s)
    assert first_conflict_s(pieces, scene._replace(volume=nmac_of(VOLUME))) is None
    # without the bands another turn is flown
    _, least = manoeuvre(config, State(told=state.told), now, frozenset(), False)
    assert least.heading_rad != pytest.approx(choice.heading_rad)


def test_no_recovery_is_flown_into_a_zone() -> None:
    """To the side of the zone the bands, which know none, recover first; it is the other side that is flown."""
    daa = daa_of(Resolution.HEADING)
    beside = ((-300.0, -40.0), (900.0, -40.0), (900.0, -900.0), (-300.0, -900.0))
    zone = Zone(5, ZoneKind.KEEP_OUT, beside, 0.0, 1000.0)
    config, now = Config(1, daa, PROJECTION, 500), seen(NEAR)
    _, free = manoeuvre(config, state_of(daa, NEAR), now, frozenset(), False)
    _, choice = manoeuvre(config, state_of(daa, NEAR, zone), now, frozenset(), False)
    assert math.sin(free.heading_rad) < 0 < math.sin(choice.heading_rad)
