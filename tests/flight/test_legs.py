"""A leg that ICAROUS does not leave is given up by name, and its vehicle is handed back."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from flight_tools import flown, meeting, of_type
from hypothesis import given
from hypothesis import strategies as st
from mission_tools import must_fly

from cratous.core.executive.steps import leg_given_up
from cratous.services.campaign.changed_missions import changing_mission
from cratous.services.flight import legs
from cratous.services.flight.chain import Leg
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.executive import Executive
from cratous.services.flight.executive_state import Config, first_state
from cratous.services.flight.messages import Begin, Route, SetOut, Suspend, Tick
from cratous.services.loading import load
from cratous.services.mission.frames import Projection
from cratous.services.mission.leg_bounds import MOST_TAKEOVERS
from cratous.services.pipeline.plan import make_plan
from cratous.spec.authority.link_end import SUSPEND
from cratous.spec.mission import Change, Position
from cratous.spec.mission.changes import TASK_ADDED

MISSION = Path(__file__).resolve().parents[1] / "missions" / "hovering_behind.yaml"


@pytest.mark.parametrize(
    ("takeovers", "under_ms", "over"),
    [(0, 0, False), (3, 5000, False), (4, 0, True), (0, 5001, True)],
)
def test_when_a_leg_is_given_up(takeovers: int, under_ms: int, over: bool) -> None:
    assert leg_given_up(takeovers, 3, under_ms, 5000) is over


@given(st.lists(st.tuples(st.integers(0, 9000), st.integers(0, 9000)), max_size=8))
def test_a_leg_counts_takeovers_and_the_time_under_icarous(times: list[tuple[int, int]]) -> None:
    leg, now, under = Leg(), 0, 0
    for flies, avoids in times:
        now += flies
        assert leg.flown_ms(False, now) == under
        leg = leg.taken(now)
        now, under = now + avoids, under + avoids
        assert leg.flown_ms(True, now) == under
        leg = leg.given_back(now)
    assert (leg.takeovers, leg.under_ms) == (len(times), under)
    assert leg.begun_anew(now).flown_ms(True, now + 7) == 7
    assert leg.to(None, now) == leg
    assert leg.to(5, now).flown_ms(True, now + 7) == 7
    assert leg.to(5, now).takeovers == 0


def test_a_goal_that_cannot_be_reached_clear_is_blocked() -> None:
    """A drone hovers 350 m behind the only goal: on the way there well clear would be lost 38 m before it."""
    mission = load(MISSION)
    (drone,) = mission.traffic
    behind = replace(drone, position=Position(1500.0 + 350.0, 0.0, 300.0))
    limit = replace(mission.simulation, limit_ms=1_000_000)
    result, log = flown(replace(mission, traffic=(behind,), simulation=limit))
    assert result.outcome == "failed"
    assert result.end_ms < 400_000  # before: at its limit
    assert result.takeovers <= MOST_TAKEOVERS
    (why,) = result.failed.values()
    assert why.startswith("blocked: ICAROUS took vehicle 1 over ")
    assert why.endswith(" with 90")
    last = of_type(log, "AuthorityChange")[-1]
    assert last.Owner.name == "UxAS"


def test_few_takeovers_are_allowed_where_few_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """A way that ICAROUS takes over again and again is given up after as many takeovers as it may have."""
    monkeypatch.setattr(legs, "MOST_TAKEOVERS", 0)
    mission = load(MISSION)
    (drone,) = mission.traffic
    behind = replace(drone, position=Position(1500.0 + 350.0, 0.0, 300.0))
    result, log = flown(replace(mission, traffic=(behind,)))
    (why,) = result.failed.values()
    assert "over once on this leg" in why
    taken = of_type(log, "AuthorityChange")
    failed = next(b.Time for b in of_type(log, "TaskProgress") if b.Phase.name == "Failed")
    assert sum(b.Owner.name == "ICAROUS" and failed >= b.Time for b in taken) == 1


def test_a_vehicle_with_nothing_left_under_icarous_circles_where_it_is() -> None:
    """Every 10 s ICAROUS is told a circle about the place to which it has taken the vehicle meanwhile."""
    mission = replace(meeting(), traffic=())
    actor = Executive(Config(mission, Projection(mission.frame), (1,)))
    state = first_state(mission, replace(make_plan(mission), items=()))
    air = AirState(Position(0.0, 0.0, 300.0), 0.0, 22.0, 0.0)
    for message in (Begin(0, ((1, air),)), SetOut(), Suspend(1, 500, SUSPEND)):
        state, _ = actor.handle(state, message)
    told = dict[int, tuple[float, float]]()
    for now_ms in range(500, 32_000, 500):
        place = Position(22.0 * now_ms / 1000, 1500.0, 300.0)
        state, out = actor.handle(state, Tick(now_ms, ((1, air._replace(position=place)),)))
        for route in (one for one in out if isinstance(one, Route)):
            off = [math.dist(point[:2], place[:2]) for point in route.points]
            told[now_ms] = (min(off), max(off))
    assert list(told) == [11_000, 21_500]
    assert all(near < 1.0 and far < 250.0 for near, far in told.values())


def blocked(*, plans_change: bool, plans: int = 20) -> tuple[int, str]:
    """When the task of vehicle 1 failed behind which a drone hovers, and why. plans_change: every 20 s there is
    another plan in flight, so many in all, for a task of a vehicle that is far away."""
    mission = load(MISSION)
    (drone,) = mission.traffic
    (one,) = mission.vehicles
    two = replace(one, id=2, position=Position(0.0, 20_000.0, 300.0))
    tasks = [
        must_fly(2 + k, (2000.0, 20_000.0 + 40 * k, 300.0), eligible=(2,)) for k in range(plans)
    ]
    changes = [Change(20_000 * (1 + k), TASK_ADDED, task=t.id) for k, t in enumerate(tasks)]
    mission = replace(
        mission,
        vehicles=(one, two),
        tasks=(replace(mission.tasks[0], eligible=(1,)), *(tasks if plans_change else ())),
        traffic=(replace(drone, position=Position(1500.0 + 350.0, 0.0, 300.0)),),
        changes=tuple(changes if plans_change else ()),
        simulation=replace(mission.simulation, limit_ms=20_000 * (plans + 1)),
    )
    result, log = flown(mission)
    assert result.replans == len(changes if plans_change else ())
    failed = next(b for b in of_type(log, "TaskProgress", TaskID=1) if b.Phase.name == "Failed")
    return failed.Time, result.failed[1]


def test_other_plans_in_flight_do_not_begin_a_leg_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """With another plan every 20 s, a leg on which ICAROUS flies for a look-ahead of 60 s is given up."""
    monkeypatch.setattr(legs, "LONGEST_LOOKAHEADS", 1)
    at_ms, why = blocked(plans_change=True, plans=6)
    assert why.startswith("blocked: ICAROUS took vehicle 1 over ")
    assert at_ms < 20_000 * 6


@pytest.mark.long
def test_another_plan_in_flight_does_not_free_a_leg_that_is_blocked() -> None:
    """What ICAROUS did on a leg counts on where the vehicle makes for the same task by another plan."""
    at_ms, why = blocked(plans_change=False)
    anew_ms, why_anew = blocked(plans_change=True)
    assert why.startswith("blocked: ICAROUS took vehicle 1 over ")
    assert anew_ms == at_ms
    # only how soon it foresaw the loss may differ, by what it was told of the way
    assert why_anew.partition(", last because")[0] == why.partition(", last because")[0]


def test_a_changed_mission_ends_beside_a_zone(tmp_path: Path) -> None:
    """Seed 49 of the changed missions ended at its limit, at the end of a way before a zone."""
    import yaml

    path = tmp_path / "49.yaml"
    path.write_text(yaml.safe_dump(changing_mission("changes", 49, 6)))
    result, _ = flown(load(path))
    # its search was flown in part, so its word is not complete
    assert (result.outcome, result.takeovers) == ("failed", 0)
    assert result.end_ms < 180_000
