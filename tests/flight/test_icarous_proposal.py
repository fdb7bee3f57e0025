"""The manoeuvre that an instance flies: the turn after which the way back is free soonest, or the least deviation."""

from __future__ import annotations

from typing import Any

import pytest
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.core.authority.gate import ICAROUS, Gate
from cratous.core.avoidance.prediction import Intruder
from cratous.core.avoidance.resolution import Choice, resolve
from cratous.services.icarous import proposal
from cratous.services.icarous.foresight import scene_of, way_back_is_free
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.permits import NONE
from cratous.services.icarous.proposal import AGAIN_MS, STEPS, TURNS_DEG, manoeuvre
from cratous.services.icarous.state import Config, Met, State
from cratous.spec.mission import Daa, Position, Velocity

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
    """The search is bounded, and is made again after AGAIN_MS, not before."""
    looks, state = Looks(monkeypatch), flying(*CONVOY)
    least = resolve(NORTH, ABILITY, scene_of(CONFIG, state, sensed(0, *CONVOY)), 0.0, 22.0, None)
    state, choice = manoeuvre(CONFIG, state, sensed(0, *CONVOY), frozenset(), False)
    assert (choice, state.search.until_ms) == (least, 0)
    most = (1 + 2 * len(TURNS_DEG)) * (2 * STEPS // 3)
    assert 0 < looks.count <= most
    for now_ms, looked in ((500, False), (AGAIN_MS - 500, False), (AGAIN_MS, True)):
        before = looks.count
        state, _ = manoeuvre(CONFIG, state, sensed(now_ms, *CONVOY), frozenset(), False)
        assert (looks.count > before) is looked


def test_nothing_is_looked_for_while_the_way_back_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    looks = Looks(monkeypatch)
    manoeuvre(CONFIG, flying(CROSSES), sensed(0, CROSSES), frozenset(), True)
    assert looks.count == 0


def free(state: State, now: Sensed) -> bool:
    return way_back_is_free(CONFIG, state, now, frozenset())
