"""Where a vehicle meets what moves, by a secant kept in its bracket, against halving and repetition."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from cratous.core.kernel import Vec2
from cratous.core.routing.dubins import cut, dubins, polyline_length_m, pose_after
from cratous.core.tasks.stations import in_ring
from cratous.services.following import chase as chasing
from cratous.services.following import stations
from cratous.services.following.meeting import Look, first_met
from cratous.services.following.motion import Motion
from cratous.services.following.task_parameters import Asked, Tower
from cratous.services.planning.options import Option
from cratous.services.planning.performance_classes import Flyer, flight_ms
from cratous.spec.mission import Task, TaskKind
from cratous.spec.mission.plan import Pose

CASES = 400
LOOKS = Task(id=1, kind=TaskKind.POINT_SEARCH, label="", points=())
KINDS = ("WatchTask", "BlockadeTask", "EscortTask", "CommRelayTask")


def flyer(speed: float) -> Flyer:
    radius_m = 1.1 * speed**2 / (9.80665 * math.tan(math.radians(30)))
    return Flyer(speed, radius_m, 300.0, 3.0, ())


def case(seed: int) -> tuple[Vec2, Asked, int, Flyer, Motion]:
    """Somebody who flies 15 to 40 m/s, and what moves slower, straight on or along corners, up to 30 km away."""
    chance = random.Random(seed)

    def spot(far_m: float) -> Vec2:
        return Vec2(chance.uniform(-far_m, far_m), chance.uniform(-far_m, far_m))

    kind, one = KINDS[seed % 4], flyer(chance.uniform(15, 40))
    course, speed = chance.uniform(-4, 4), chance.choice([0, 1, 0.5, 0.95]) * (one.speed_m_s - 1)
    route = tuple(spot(20_000) for _ in range(chance.choice([0, 0, 1, 4])))
    velocity = Vec2(speed * math.cos(course), speed * math.sin(course))
    motion = Motion(spot(30_000), velocity, 0, route)
    tower = Tower(motion.at, 0.0)
    if kind == "CommRelayTask":
        tower = Tower(spot(30_000), chance.uniform(1_000, 40_000))
        motion = motion.halfway_to(tower.at)
    protected = spot(30_000) if chance.random() < 0.5 else None
    asked = Asked(
        kind, 9, 1, chance.uniform(0, 500), 0, LOOKS, route, protected,
        tower if kind == "CommRelayTask" else None,
    )  # fmt: skip
    return spot(30_000), asked, chance.randrange(3), one, motion


def halved(is_short: Callable[[float], bool], low: float, high: float) -> float:
    """The plain search: the middle of a bracket, 60 times."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if is_short(middle) else (low, middle)
    return high


def reference(start: Vec2, asked: Asked, slot: int, one: Flyer, motion: Motion) -> float | None:
    """The instant of the meeting by doubling and halving alone [s]."""
    radius_m = stations._radius_m(asked, one, 0.0)

    def way_m(seconds: float) -> float:
        there = motion._replace(at=motion.after(seconds))
        goal = stations._circle(asked, slot, radius_m, there)
        far_m = max(math.dist(start, goal.at) - goal.radius_m, 0.0)
        tower = asked.tower
        if tower is None:
            return far_m
        return halved(
            lambda m: (
                not stations.relays(
                    tower, there, stations.towards(start, goal.at, m), goal.radius_m
                )
            ),
            0.0,
            far_m,
        )

    early, late = 0.0, way_m(0.0) / one.speed_m_s
    for _ in range(16):
        if way_m(late) <= one.speed_m_s * late:
            return halved(lambda s: way_m(s) > one.speed_m_s * s, early, late)
        early, late = late, 2 * late + 1
    return None


def test_meetings_are_those_of_halving_to_the_millisecond_in_a_fifth_of_the_looks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    looked, met = [0], 0
    pace = stations.pace

    def counted(*given: float) -> Any:
        looked[0] += 1
        return pace(*given)

    monkeypatch.setattr(stations, "pace", counted)
    for seed in range(CASES):
        start, asked, slot, one, motion = case(seed)
        found = stations.reached_from(start, asked, slot, one, motion, 0.0)
        seconds = reference(start, asked, slot, one, motion)
        assert (found is None) == (seconds is None), seed
        if found is None or seconds is None:
            continue
        met += 1
        there = motion.after(seconds)
        assert math.dist(found[0].at, there) <= 1e-3 * one.speed_m_s, seed
        assert found[1] == pytest.approx(one.speed_m_s * seconds, abs=1e-3 * one.speed_m_s), seed
    assert met > 0.9 * CASES
    assert looked[0] < 8 * CASES, "by halving, 42 each"


def options(one: Flyer) -> Option:
    pose = Pose(0.0, 0.0, one.alt_m, 0.0)
    return Option(1, 1, (1,), one, pose, pose, (), 0, (), "slot 1")


def repeated(
    motion: Motion, begin: Pose, usual: Option, fast: float, asked: Asked, rounds: int
) -> float | None:
    """The duration of a chase by putting in again what came out [s], as often as it needs."""
    one = usual.flyer
    gate = pose_after(begin, 0, chasing.LEAD_S * one.speed_m_s, 1.0)
    wide_m = one.radius_m * (fast / one.speed_m_s) ** 2
    slow_m = max(one.radius_m, (fast**2 - one.speed_m_s**2) / 2)
    seconds = 0.0
    for _ in range(rounds):
        there = motion._replace(at=motion.after(chasing.LEAD_S + seconds))
        goal = stations.station(asked, 0, one, there, 0.0)
        if in_ring(goal.at, Vec2(*gate[:2]), 0, goal.radius_m + 2 * wide_m):
            return None
        heading = math.atan2(goal.at.y - gate.east_m, goal.at.x - gate.north_m)
        rim = pose_after(Pose(*goal.at, one.alt_m, heading), 0, -goal.radius_m, 1.0)
        way_m = polyline_length_m(tuple(cut(dubins(gate, rim, wide_m), rim)))
        last_m = min(way_m, slow_m)
        before, seconds = seconds, (way_m - last_m) / fast + last_m / one.speed_m_s
    return seconds if abs(seconds - before) <= chasing.SETTLED_S else None


def test_chases_are_those_of_repetition_to_the_millisecond() -> None:
    """Where repetition settles; it may come too near on its way, or swing, where there is a chase all the same."""
    chased = more = 0
    for seed in range(CASES):
        start, asked, _, one, motion = case(seed)
        asked = asked._replace(kind=("WatchTask", "BlockadeTask")[seed % 2], tower=None)
        fast, begin = 1.5 * one.speed_m_s, Pose(*start, one.alt_m, seed % 7)
        frame = SimpleNamespace(terrain_m=0.0)
        inputs = SimpleNamespace(starts={1: begin}, zones=(), mission=SimpleNamespace(frame=frame))
        context: Any = SimpleNamespace(inputs=inputs)
        vehicle: Any = SimpleNamespace(id=1, max_speed_m_s=fast)
        found = chasing.chase(context, asked, motion, options(one), vehicle)
        seconds = repeated(motion, begin, options(one), fast, asked, 80)
        if motion.velocity == (0.0, 0.0):
            assert found is None
        elif seconds is None:
            more += found is not None
        else:
            assert found is not None, seed
            chased += 1
            assert found.duration_ms == pytest.approx(flight_ms(seconds, 1.0), abs=2), seed
    assert chased > CASES / 2
    assert more < CASES / 20


@pytest.mark.parametrize("by", [1.0, 1e-12, math.inf])
def test_what_guides_may_be_of_no_use_and_the_answer_is_the_same(by: float) -> None:
    """The kernel alone decides; a guide that says nothing, or no number, leaves the search to halving."""
    found = first_met(lambda at: Look(at < 7, by if at < 7 else -by), 1.0)
    assert found is not None
    assert found == pytest.approx(7, abs=1e-8)
    assert found >= 7


def test_who_is_never_in_time_meets_nothing_and_who_is_there_need_not_fly() -> None:
    assert first_met(lambda at: Look(True, 1.0), 1.0) is None
    assert first_met(lambda at: Look(False, -1.0), 1.0) == 0
