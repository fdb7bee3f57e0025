"""Alerts and bands in flight: what detect and avoid says to the pilot, when, and that it shows in proposal and record."""

from __future__ import annotations

import math
from typing import NamedTuple

import pytest
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.bridge.lmcp.jsonform import to_data
from cratous.core.authority.gate import UXAS, Gate
from cratous.core.avoidance.prediction import Intruder, Spread
from cratous.core.daa.session import Instant
from cratous.services.certify.alerts import AlertReader
from cratous.services.flight.notices import guidance
from cratous.services.icarous import proposal
from cratous.services.icarous.band_history import Bands
from cratous.services.icarous.bands import STEP_DEG, Whose, resolutions, watched
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Guides, Sensed
from cratous.services.icarous.proposal import TURNS_DEG, _soonest, _told
from cratous.services.icarous.state import Config, State
from cratous.spec.daa.parameters import MID, NONE
from cratous.spec.mission import Daa, Position, Velocity

CONFIG = Config(1, Daa(VOLUME, buffer=1.25), PROJECTION, 500, records=True)
WHOSE = Whose(1, CONFIG.daa, 500, True)
WAY = (Position(-1000.0, 0.0, 300.0), Position(9000.0, 0.0, 300.0))


def crossing(side: float, spread: Spread = Spread()) -> Intruder:
    """One that crosses in front, from the right (1.0) or the left (-1.0)."""
    return Intruder(9, Position(1100.0, side * 850.0, 300.0), Velocity(0.0, -side * 20.0, 0.0),
                    spread=spread)  # fmt: skip


def sensed(now_ms: int, *others: Intruder) -> Sensed:
    return Sensed(now_ms, NORTH, ABILITY, others, Gate(UXAS, 1, False))


class Found(NamedTuple):
    """What is remembered, and what is said."""

    bands: Bands
    instant: Instant


def look(whose: Whose, now: Sensed) -> Found:
    remembered, instant = watched(whose, None, now)
    assert remembered is not None
    assert instant is not None
    return Found(remembered, instant)


def bands(*others: Intruder) -> Found:
    return look(WHOSE, sensed(0, *others))


def said_of(one: object) -> object:
    """What can be compared: of alerts and bands without the arrays that they were made from."""
    return (
        (one.now_ms, one.instant.alerts, one.instant.guidance) if isinstance(one, Guides) else one
    )


def heading_bands(of: Found) -> list[tuple[float, float]]:
    guidance = of.instant.guidance[0]
    return [(b.low, b.high) for b in guidance.bands if b.region >= MID]


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_present_course_is_in_a_band_and_the_preferred_turn_out_of_it(side: float) -> None:
    found = bands(crossing(side))
    assert [a.level for a in found.instant.alerts] == [1]
    assert found.instant.guidance[0].region == MID
    turns = resolutions(found.bands, NORTH.heading_rad)
    # behind the one that crosses is the shorter way
    assert turns
    assert math.copysign(1.0, turns[0]) == side
    for turn in turns:
        heading = (NORTH.heading_rad + turn) % (2 * math.pi)
        assert not any(low < heading < high for low, high in heading_bands(found))
    # one step of the bands back is the edge of a band, or in it
    back = (turns[0] - math.copysign(1.01 * math.radians(STEP_DEG), turns[0])) % (2 * math.pi)
    assert any(low <= back <= high for low, high in heading_bands(found))


def test_the_mirror_image_is_the_mirror_image() -> None:
    right, left = (
        resolutions(bands(crossing(side)).bands, NORTH.heading_rad) for side in (1.0, -1.0)
    )
    assert right == pytest.approx([-turn for turn in left])


def test_who_is_known_within_bounds_only_has_wider_bands() -> None:
    def width(of: Found) -> float:
        return sum(high - low for low, high in heading_bands(of))

    exact, loose = bands(crossing(1.0)), bands(crossing(1.0, Spread(60.0, 2.0, 10.0, 0.5)))
    assert width(loose) > width(exact)

    def height(of: Found) -> float:
        return sum(b.high - b.low for b in of.instant.guidance[3].bands if b.region >= MID)

    # also of one whose height alone is not known exactly
    assert height(bands(crossing(1.0, Spread(high_m=60.0)))) > height(exact)


def test_it_is_said_once_a_second_while_a_loss_is_foreseen_and_the_state_before_is_left_alone() -> (
    None
):
    told = Told(waypoints=WAY, next_index=1, speed_m_s=22.0)
    instance, state = Instance(CONFIG), State(told=told)
    said = []
    for now_ms in range(0, 3000, 500):
        before = state
        state, out = instance.handle(before, sensed(now_ms, crossing(1.0)))
        again = instance.handle(before, sensed(now_ms, crossing(1.0)))
        assert [said_of(one) for one in again[1]] == [said_of(one) for one in out]
        said += [one.now_ms for one in out if isinstance(one, Guides)]
    assert said == [0, 1000, 2000]
    state = State(told=told, bands=state.bands)
    away = Intruder(9, Position(-5000.0, 0.0, 300.0), Velocity(-20.0, 0.0, 0.0))
    state, out = instance.handle(state, sensed(3000, away))
    assert state.bands is None
    assert not any(isinstance(one, Guides) for one in out)


def test_the_proposal_tries_what_the_bands_prefer_first_and_no_wide_turn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tried = list[float]()
    monkeypatch.setattr(proposal, "keeps_clear", lambda *given: tried.append(given[-1].heading_rad))
    for side in (1.0, -1.0):
        found = bands(crossing(side))
        turns = _told(State(bands=found.bands), NORTH.heading_rad)
        assert turns
        assert math.copysign(1.0, turns[0]) == side
        assert all(abs(turn) <= math.radians(TURNS_DEG[-1]) for turn in turns)
        tried.clear()
        state, now = State(bands=found.bands), sensed(0, crossing(side))
        assert _soonest(CONFIG, state, now, frozenset(), (NORTH.heading_rad, 22.0)) is None
        begin, small = [0.0, *turns], math.radians(TURNS_DEG[0])
        assert tried[: len(begin) + 2] == pytest.approx([*begin, side * small, -side * small])
    assert _told(State(), 0.0) == ()


def test_the_record_has_the_alert_and_the_bands() -> None:
    found = bands(crossing(1.0))
    message = guidance(Guides(1, 0, NORTH, found.instant), PROJECTION)
    assert (message.EntityId, message.EntityList, message.AlertLevelList) == (1, [9], [1.0])
    assert message.WCVGroundHeadingRegions
    assert message.CurrentHeading == 0.0
    reader, data = AlertReader(), to_data(message)
    for time_ms in (0, 1000):
        reader.add(data, time_ms)
    quiet = {**data, "EntityList": [], "AlertLevelList": [], "TimeToViolationList": []}
    reader.add(quiet, 2000)
    reader.add(data, 3000)
    assert [(a["from_ms"], a["to_ms"], a["level"]) for a in reader.found] == [
        (0, 1000, 1),
        (3000, 3000, 1),
    ]


def test_an_airframe_that_cannot_climb_has_no_bands_of_climbs() -> None:
    level = sensed(0, crossing(1.0))
    level = level._replace(ability=level.ability._replace(max_climb_m_s=0.0))
    found = look(WHOSE, level)
    assert [g.dimension for g in found.instant.guidance] == ["hdir", "hs"]
    assert all(b.region >= NONE for g in found.instant.guidance for b in g.bands)


def test_where_nobody_reads_them_headings_alone_are_looked_at_and_the_turns_are_the_same() -> None:
    untold = look(WHOSE._replace(told=False), sensed(0, crossing(1.0)))
    assert [g.dimension for g in untold.instant.guidance] == ["hdir"]
    assert resolutions(untold.bands, 0.3) == resolutions(bands(crossing(1.0)).bands, 0.3)
    state = State(told=Told(waypoints=WAY, next_index=1, speed_m_s=22.0))
    _, out = Instance(CONFIG._replace(records=False)).handle(state, sensed(0, crossing(1.0)))
    assert not any(isinstance(one, Guides) for one in out)
