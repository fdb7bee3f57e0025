"""A way in time that an instance flies where no manoeuvre leads back."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME

from cratous.core.authority.gate import ICAROUS, Gate
from cratous.core.avoidance.manoeuvre import Motion, smallest_turn
from cratous.core.avoidance.prediction import Intruder, buffered, later
from cratous.core.avoidance.resolution import Choice, Scene
from cratous.services.icarous import cognition, link_loss, proposal, timed_way
from cratous.services.icarous.decided import Decided
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.offers import Refused
from cratous.services.icarous.permits import NONE
from cratous.services.icarous.proposal import describe, manoeuvre
from cratous.services.icarous.state import Config, Met, State
from cratous.services.icarous.timed_way import KIND, SHARE_S
from cratous.services.ways_in_time.asking import CHECKS_PER_S, Answer, Asked, Outcome
from cratous.spec.authority import cognition as meant
from cratous.spec.mission import Daa, Position, Velocity

CONFIG = Config(1, Daa(VOLUME, buffer=1.25), PROJECTION, 500)
WAY = (Position(-1000.0, 0.0, 300.0), Position(9000.0, 0.0, 300.0))
CONVOY = tuple(
    Intruder(20 + k, Position(500.0 * k, 0.0, 300.0), Velocity(18.0, 0.0, 0.0)) for k in range(1, 6)
)


def sensed(now_ms: int, motion: Motion, others: tuple[Intruder, ...]) -> Sensed:
    return Sensed(now_ms, motion, ABILITY, others, Gate(ICAROUS, 1, False))


def flown(motion: Motion, choice: Choice, beat_s: float) -> Motion:
    """The motion a heartbeat later: turn rate, acceleration and climb are limited."""
    steps, (p, heading, speed, _) = 5, motion
    for _ in range(steps):
        t = beat_s / steps
        most = ABILITY.turn_rate_rad_s * t
        heading += min(max(smallest_turn(heading, choice.heading_rad), -most), most)
        gain = ABILITY.acceleration_m_s2 * t
        speed += min(max(choice.speed_m_s - speed, -gain), gain)
        p = Position(
            p.north_m + speed * math.cos(heading) * t,
            p.east_m + speed * math.sin(heading) * t,
            p.alt_m + choice.climb_m_s * t,
        )
    return Motion(p, heading, speed, choice.climb_m_s)


def begun() -> State:
    told = Told(waypoints=WAY, next_index=1, speed_m_s=22.0)
    return State(told=told, met=tuple(Met(other.id, NONE) for other in CONVOY))


def test_five_slower_ones_ahead_are_passed_on_it() -> None:
    """It keeps clear of all of them, as simulated here, until the last is behind or the way is over."""
    state, motion, kinds, least_m = begun(), NORTH, set[str](), math.inf
    for k in range(400):
        others = tuple(later(one, 0.5 * k) for one in CONVOY)
        state, choice = manoeuvre(
            CONFIG, state, sensed(500 * k, motion, others), frozenset(), False
        )
        if k == 0:
            assert (choice.kind, choice.clear) == (KIND, True)
            assert describe(choice) == "a way in time, past all traffic"
        if choice.kind != KIND:
            break
        motion = flown(motion, choice, 0.5)
        then = [later(one, 0.5 * (k + 1)).position for one in CONVOY]
        level = [q for q in then if abs(q.alt_m - motion.position.alt_m) <= VOLUME.zthr_m]
        least_m = min([least_m, *(math.dist(motion.position[:2], q[:2]) for q in level)])
        kinds.add(choice.kind)
    assert k > 40
    assert least_m > VOLUME.dthr_m


def test_it_is_given_up_where_it_is_not_permitted_any_more() -> None:
    state, _ = manoeuvre(CONFIG, begun(), sensed(0, NORTH, CONVOY), frozenset(), False)
    assert state.timed is not None
    left = state.timed.left(500)
    there = left[len(left) // 2]
    # one that stands on the way
    blocks = Intruder(8, there.position, Velocity(0.0, 0.0, 0.0))
    motion = replace_place(left[0].position)
    kept, _ = manoeuvre(CONFIG, state, sensed(500, motion, CONVOY), frozenset(), False)
    assert kept.timed == state.timed
    lost, _ = manoeuvre(CONFIG, state, sensed(500, motion, (*CONVOY, blocks)), frozenset(), False)
    assert lost.timed != state.timed
    # far off it, or taken over anew
    away = replace_place(Position(0.0, 300.0, 300.0))
    off, _ = manoeuvre(CONFIG, state, sensed(500, away, CONVOY), frozenset(), False)
    assert off.timed != state.timed
    anew = replace(state, held=None)
    again, _ = manoeuvre(CONFIG, anew, sensed(500, motion, ()), frozenset(), True)
    assert again.timed is None


def test_it_is_flown_only_with_a_certificate(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither begun nor flown on without one: an aircraft that a way in time circles at the edge lets none be found."""
    state, choice = manoeuvre(CONFIG, begun(), sensed(0, NORTH, CONVOY), frozenset(), False)
    assert state.timed is not None
    assert choice.kind == KIND
    now = sensed(500, replace_place(state.timed.left(500)[0].position), CONVOY)
    kept, choice = manoeuvre(CONFIG, state, now, frozenset(), False)
    assert (kept.timed, choice.kind) == (state.timed, KIND)
    monkeypatch.setattr(proposal, "certified", lambda *_: Refused(21, "not permitted"))
    for before in (state, begun()):
        after, choice = manoeuvre(CONFIG, before, now, frozenset(), False)
        assert after.timed is None
        assert choice.kind != KIND


def test_on_another_route_or_without_the_link_another_is_flown() -> None:
    """It leads to a waypoint of the route that was known."""
    state, choice = manoeuvre(CONFIG, begun(), sensed(0, NORTH, CONVOY), frozenset(), False)
    assert state.timed is not None
    assert choice.kind == KIND
    motion = replace_place(state.timed.left(500)[0].position)
    now = sensed(500, motion, CONVOY)
    told_again = replace(state, told=replace(state.told, waypoints=(*WAY,)))
    kept, _ = manoeuvre(CONFIG, told_again, now, frozenset(), False)
    assert kept.timed == state.timed
    south = (NORTH.position, Position(0.0, -9000.0, 300.0))
    elsewhere = replace(state, told=replace(state.told, waypoints=south))
    left, choice = manoeuvre(CONFIG, elsewhere, now, frozenset(), False)
    assert (left.timed, choice.kind) == (None, "heading")
    alone, choice = link_loss.avoiding(CONFIG, state, now, frozenset())
    assert (alone.timed, choice.kind) == (None, "heading")
    assert alone.told == state.told


@pytest.mark.parametrize(
    ("turn_rad", "speed_m_s", "climb_m_s", "how"),
    [
        (0.5, 22.0, 0.0, meant.TURN),
        (0.0, 22.0, 3.0, meant.ALTITUDE),
        (0.0, 22.0, -3.0, meant.ALTITUDE),
        (0.0, 30.0, 0.0, meant.SPEED),
        (0.0, 15.0, 0.1, meant.SPEED),
        (0.5, 22.0, 3.0, meant.COMBINED),
        (0.0, 30.0, 3.0, meant.COMBINED),
    ],
)
def test_the_log_says_how_it_avoids(
    turn_rad: float, speed_m_s: float, climb_m_s: float, how: int
) -> None:
    """By what it differs from level flight at the announced speed."""
    held = Choice(KIND, turn_rad, speed_m_s, climb_m_s, 2.0, True, None)
    state = replace(begun(), held=held, decided=Decided(meant.TRAFFIC_CONFLICT))
    after, (said,) = cognition.told(
        CONFIG._replace(records=True), state, begun(), sensed(0, NORTH, CONVOY)
    )
    assert after.decided.resolution == said.resolution == how


def test_searches_in_vain_at_one_heartbeat_have_a_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two places are tried, the nearer one for half as long, so that a heartbeat ends in time."""
    asked: list[tuple[Position, float]] = []

    def in_vain(question: Asked, _scene: object, budget_s: float) -> Answer:
        asked.append((question.goal, budget_s))
        return Answer(Outcome.NONE_IN_TIME, "")

    monkeypatch.setattr(timed_way, "way_in_time", in_vain)
    scene = Scene(CONVOY, (), buffered(VOLUME, 1.25), 60.0)
    now = sensed(0, NORTH, CONVOY)
    for points, shares in ((WAY, (0.5, 1.0)), (WAY[1:], (1.0,))):
        asked.clear()
        assert timed_way.proposed(scene, CONFIG.daa, now, points) is None
        assert asked == [
            (place, share * SHARE_S) for place, share in zip(points, shares, strict=True)
        ]
    assert 1.5 * SHARE_S * CHECKS_PER_S < 20_000


def replace_place(place: Position) -> Motion:
    return NORTH._replace(position=place)
