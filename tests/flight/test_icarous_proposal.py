"""The manoeuvre that an instance flies: the turn after which the way back is free soonest, or the least deviation."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.core.authority.cycle import Cycle
from cratous.core.authority.gate import ICAROUS, Gate
from cratous.core.avoidance.prediction import Intruder
from cratous.core.avoidance.resolution import Choice, resolve
from cratous.services.icarous import instance, proposal
from cratous.services.icarous.forbidden import FREE, Forbidden
from cratous.services.icarous.foresight import scene_of, way_back_is_free
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.messages import Sensed, Wish
from cratous.services.icarous.permits import NONE
from cratous.services.icarous.proposal import AGAIN_MS, STEPS, TURNS_DEG, WIDE_DEG, manoeuvre
from cratous.services.icarous.route_requests import Asking
from cratous.services.icarous.state import Config, Met, Search, State
from cratous.services.logs.records import from_data, to_data
from cratous.spec.authority.cycle import AVOID, OFFER
from cratous.spec.mission import (
    Daa,
    OrderedDaa,
    OrderedSensedDaa,
    Position,
    Resolution,
    Velocity,
)

CONFIG = Config(1, Daa(VOLUME, buffer=1.25), PROJECTION, 500)
WAY = (Position(-1000.0, 0.0, 300.0), Position(9000.0, 0.0, 300.0))
CROSSES = Intruder(9, Position(1100.0, 1000.0, 300.0), Velocity(0.0, -20.0, 0.0))
CONVOY = tuple(
    Intruder(20 + k, Position(500.0 * k, 0.0, 300.0), Velocity(18.0, 0.0, 0.0)) for k in range(1, 6)
)
"""One that crosses from the right; five on the way ahead, slower."""


class Looks:
    """How often is looked, and the real answers."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.count = 0
        real = proposal.way_back_is_free

        def counted(*args: Any) -> bool:
            self.count += 1
            return real(*args)

        monkeypatch.setattr(proposal, "way_back_is_free", counted)


def sensed(now_ms: int, *others: Intruder) -> Sensed:
    return Sensed(now_ms, NORTH, ABILITY, others, Gate(ICAROUS, 1, False))


def flying(*others: Intruder) -> State:
    told = Told(waypoints=WAY, next_index=1, speed_m_s=22.0)
    return State(told=told, met=tuple(Met(other.id, NONE) for other in others))


@pytest.mark.parametrize("first", [Resolution.ALTITUDE, Resolution.SPEED])
def test_another_kind_of_manoeuvre_is_looked_for_first_where_the_mission_says_so(
    first: Resolution,
) -> None:
    """Both by the search for what is over soonest and without it; turns where none of the kind is free."""
    config = CONFIG._replace(daa=OrderedDaa(VOLUME, buffer=1.25, resolution=first))
    state, now = flying(CROSSES), sensed(0, CROSSES)
    _, choice = manoeuvre(config, state, now, frozenset(), False)
    assert (choice.kind, choice.clear) == (first, True)
    scene = scene_of(config, state, now)
    least = resolve(NORTH, ABILITY, scene, 0.0, 22.0, None)
    assert (least.kind, least.clear) == (first, True)
    # what is held is flown on; with the conflict over it is the course again
    assert resolve(NORTH, ABILITY, scene, 0.0, 22.0, least) == least
    assert resolve(NORTH, ABILITY, scene._replace(intruders=()), 0.0, 22.0, least).kind == "heading"
    stiff = ABILITY._replace(max_climb_m_s=0.0, min_speed_m_s=22.0, max_speed_m_s=22.0)
    assert resolve(NORTH, stiff, scene, 0.0, 22.0, None).kind == "heading"
    kept = to_data(config.daa)
    assert from_data(Daa, kept) == config.daa
    sensing = OrderedSensedDaa(VOLUME, resolution=first)
    assert from_data(Daa, to_data(sensing)) == sensing


def test_the_turn_is_flown_after_which_the_way_back_is_free_soonest() -> None:
    """It is free when the search says so; after the least deviation it would be much later."""
    state, now = flying(CROSSES), sensed(0, CROSSES)
    assert not way_back_is_free(CONFIG, state, now, frozenset())
    after, choice = manoeuvre(CONFIG, state, now, frozenset(), False)
    least = resolve(NORTH, ABILITY, scene_of(CONFIG, state, now), 0.0, 22.0, None)
    step_s = CONFIG.daa.lookahead_s / STEPS

    def free_s(one: Choice) -> float:
        return next(
            k * step_s for k in range(1, 5 * STEPS) if free(state, later_by(one, k * step_s))
        )

    def later_by(one: Choice, t_s: float) -> Sensed:
        return proposal._later(now, one, t_s)

    assert choice.clear
    assert after.held == choice
    assert (free_s(choice), free_s(least)) == (12.0, 44.0)
    # flown as it is until the way is free and has been so for long enough, then a new one is looked for
    assert 12_000 < after.search.until_ms < 16_000


def test_the_turn_is_flown_on_while_it_keeps_clear(monkeypatch: pytest.MonkeyPatch) -> None:
    state, choice = manoeuvre(CONFIG, flying(CROSSES), sensed(0, CROSSES), frozenset(), False)
    looks = Looks(monkeypatch)
    again, same = manoeuvre(CONFIG, state, sensed(5000, CROSSES), frozenset(), False)
    assert (same, again.search, looks.count) == (choice, state.search, 0)
    # its time is over, or somebody is in its way
    blocks = Intruder(8, Position(600.0, 1000.0, 300.0), Velocity(-10.0, -17.0, 0.0))
    for now in (sensed(state.search.until_ms, CROSSES), sensed(5000, CROSSES, blocks)):
        before = looks.count
        manoeuvre(CONFIG, state, now, frozenset(), False)
        assert looks.count > before


def test_where_no_way_back_is_free_in_time_the_least_deviation_is_flown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The search is bounded, and is made again after AGAIN_MS, not before. Here no way in time is found either."""
    monkeypatch.setattr(proposal, "proposed", lambda *_: None)
    looks, state = Looks(monkeypatch), flying(*CONVOY)
    least = resolve(NORTH, ABILITY, scene_of(CONFIG, state, sensed(0, *CONVOY)), 0.0, 22.0, None)
    state, choice = manoeuvre(CONFIG, state, sensed(0, *CONVOY), frozenset(), False)
    assert (choice, state.search.until_ms) == (least, 0)
    # each turn at each instant: whether it is free for good, or for the look-ahead
    most = 2 * (1 + 2 * len(TURNS_DEG + WIDE_DEG)) * (2 * STEPS // 3)
    assert 0 < looks.count <= most
    for now_ms, looked in ((500, False), (AGAIN_MS - 500, False), (AGAIN_MS, True)):
        before = looks.count
        state, _ = manoeuvre(CONFIG, state, sensed(now_ms, *CONVOY), frozenset(), False)
        assert (looks.count > before) is looked


def test_the_turn_after_which_nobody_else_is_met_goes_before_a_sooner_one() -> None:
    """After the turn that one alone asks for, the second would be met on the way back, beyond the look-ahead."""
    second = Intruder(8, Position(3000.0, 3000.0, 300.0), Velocity(0.0, -22.0, 0.0))
    state, alone, both = flying(CROSSES), sensed(0, CROSSES), sensed(0, CROSSES, second)
    for now, turn_deg, free_ms in ((alone, 60, 12_000), (both, 50, 16_000)):
        after, choice = manoeuvre(CONFIG, state, now, frozenset(), False)
        assert round(math.degrees(choice.heading_rad)) == turn_deg
        assert after.search == Search(0, free_ms + 2500, True)
        assert later_free(state, now, turn_deg, free_ms // 4000, True)
    # the sooner one leads back for the look-ahead alone
    assert later_free(state, both, 60, 3, False)
    assert not later_free(state, both, 60, 3, True)


def later_free(state: State, now: Sensed, turn_deg: float, step: int, lasting: bool) -> bool:
    """Whether the way back is free after a turn, at one of the instants that are looked at."""
    turn = Choice("heading", math.radians(turn_deg), 22.0, 0.0, 0.0, True, None)
    then = proposal._later(now, turn, step * CONFIG.daa.lookahead_s / STEPS)
    return way_back_is_free(CONFIG, state, then, frozenset(), lasting)


@pytest.mark.parametrize(
    ("free", "turn_deg"),
    [
        ({(60, 6, True), (75, 2, True)}, 75),
        ({(60, 6, True), (75, 3, True)}, 60),  # not so much sooner
        ({(60, 1, False), (75, 10, True)}, 75),
        ({(60, 6, False), (75, 1, False)}, 60),  # not for good
        ({(75, 1, False)}, None),
    ],
)
def test_a_wide_turn_is_flown_only_for_a_way_back_for_good(
    monkeypatch: pytest.MonkeyPatch, free: set[tuple[int, int, bool]], turn_deg: int | None
) -> None:
    """free: after which turn [deg] the way back is free, at which instant, and whether for good."""
    step_s = CONFIG.daa.lookahead_s / STEPS

    def then(_: Sensed, choice: Choice, t_s: float) -> tuple[int, int]:
        return round(math.degrees(choice.heading_rad)), round(t_s / step_s)

    def is_free(_: Any, __: Any, at: tuple[int, int], ___: Any, lasting: bool = False) -> bool:
        return (*at, lasting) in free

    monkeypatch.setattr(proposal, "_later", then)
    monkeypatch.setattr(proposal, "way_back_is_free", is_free)
    state, choice = manoeuvre(CONFIG, flying(), sensed(0), frozenset(), False)
    assert (state.search.until_ms > 0) is (turn_deg is not None)
    assert round(math.degrees(choice.heading_rad)) == (turn_deg or 0)


@pytest.mark.parametrize("of_uxas", [True, False])
@pytest.mark.parametrize("lasting", [True, False])
def test_control_waits_for_the_way_that_was_looked_for_and_no_longer(
    monkeypatch: pytest.MonkeyPatch, lasting: bool, of_uxas: bool
) -> None:
    """Until its instant has come a way that is free for the look-ahead alone is not taken; of_uxas: one that UxAS's
    planner proposes."""
    shut = Forbidden(True, False)

    def forbidden(*args: Any) -> Forbidden:
        return shut if of_uxas or args[4] else FREE

    monkeypatch.setattr(instance, "way_back_forbidden", forbidden)
    monkeypatch.setattr(instance, "way_is_free", lambda *args: not args[5])
    turn = Choice("heading", 1.0, 22.0, 0.0, 0.0, True, None)
    cycle = Cycle(AVOID, 0, False, 0, True, 0)
    asking = Asking(allowed=of_uxas, number=7, next_ms=9000, proposal=WAY, answered=7)
    for now_ms in (4500, 5000):
        told = replace(flying().told, heard_ms=now_ms)
        search = Search(0, 5000, lasting)
        state = State(told=told, cycle=cycle, held=turn, search=search, asking=asking)
        _, said = Instance(CONFIG).handle(state, sensed(now_ms))
        offers = [one.act for one in said if isinstance(one, Wish)]
        assert offers == [OFFER] * (not lasting or now_ms == 5000)


def test_nothing_is_looked_for_while_the_way_back_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    looks = Looks(monkeypatch)
    manoeuvre(CONFIG, flying(CROSSES), sensed(0, CROSSES), frozenset(), True)
    assert looks.count == 0


def free(state: State, now: Sensed) -> bool:
    return way_back_is_free(CONFIG, state, now, frozenset())
