"""What the executive does with tasks is what its kernels answer, in the air too."""

from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError, replace
from typing import Any

import pytest
from flight_tools import flown, meeting, of_type, plain_steps, with_deadline

from cratous.bridge import lmcp
from cratous.core.executive.steps import Answered
from cratous.core.routing.polylines import Track
from cratous.services.flight import (
    deadlines,
    executive,
    replan_triggers,
    task_states,
    task_transitions,
)
from cratous.services.flight.chain import Chain, Phase
from cratous.services.flight.dynamics import AirState
from cratous.services.flight.executive import Executive
from cratous.services.flight.executive_state import Config, first_state
from cratous.services.flight.messages import (
    Begin,
    HeardAgain,
    NotHeard,
    NotPlanned,
    Planned,
    Stands,
    ToExecutive,
    ToVehicle,
)
from cratous.services.flight.replan_triggers import touched_by
from cratous.services.flight.vehicle import VehicleNode
from cratous.services.mission.frames import Projection
from cratous.spec.executive import (
    BEGUN,
    COMPLETE,
    DROP_LATE,
    ENDED,
    FAILED,
    FOR_NOTHING,
    GIVE_UP,
    LEFT,
    STANDS_BY,
)
from cratous.spec.mission import Change, Mission, Position, Simulation, Traffic, Velocity
from cratous.spec.mission.changes import (
    TASK_ADDED,
    TASK_REMOVED,
    VEHICLE_JOINS,
    VEHICLE_LOST,
    WIND,
    ZONE_ENDS,
    ZoneEnd,
)


def alone(limit_ms: int = 400_000) -> Mission:
    """One vehicle, one task, no traffic."""
    return replace(meeting(), traffic=(), simulation=Simulation(limit_ms=limit_ms))


@pytest.mark.parametrize(
    ("ended", "failed", "expected"),
    [((), (), LEFT), ((7,), (), ENDED), ((), (7,), FAILED), ((8,), (8,), LEFT)],
)
def test_what_has_become_of_a_task(
    ended: tuple[int, ...], failed: tuple[int, ...], expected: int
) -> None:
    assert task_states.life(7, (8,), ended, failed) == expected
    assert task_states.life(7, (7,), ended, failed) == (BEGUN if expected == LEFT else expected)


def test_no_task_begins_that_may_not(monkeypatch: pytest.MonkeyPatch) -> None:
    result, log = flown(alone())
    assert result.outcome == "complete"
    begun = result.starts[1]
    monkeypatch.setattr(task_transitions, "may_begin", lambda *_: False)
    result, log = flown(alone(begun + 60_000))
    assert (result.outcome, result.starts, result.ends) == ("limit", {}, {})
    phases = [p.Phase.name for p in of_type(log, "TaskProgress", TaskID=1)]
    assert phases == ["Transit", "Waiting", "Failed"]


@pytest.mark.parametrize(("act", "failed"), [(GIVE_UP, [1]), (STANDS_BY, [])])
def test_the_kernel_says_what_a_missed_deadline_leads_to(
    monkeypatch: pytest.MonkeyPatch, act: int, failed: list[int]
) -> None:
    mission, plan = with_deadline()
    result, _ = flown(mission, plan)
    assert (result.replans, list(result.failed)) == (1, [])
    monkeypatch.setattr(deadlines, "late_act", lambda *_: act)
    result, _ = flown(mission, plan)
    assert (result.replans, list(result.failed)) == (0, failed)


def test_the_kernel_ends_the_flight(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executive, "flight_outcome", lambda *_: COMPLETE)
    result, _ = flown(alone())
    assert (result.outcome, result.end_ms) == ("complete", 0)


def test_the_kernel_says_what_an_answer_of_the_planner_leads_to(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    mission, plan = with_deadline()
    monkeypatch.setattr(executive, "answered", lambda *_: Answered(FOR_NOTHING, DROP_LATE))
    result, _ = flown(mission, plan)
    assert (result.replans, list(result.failed)) == (0, [1])


def test_an_answer_that_nobody_waits_for_changes_nothing() -> None:
    mission, plan = with_deadline()
    actor = Executive(Config(mission, Projection(mission.frame), ()))
    state = first_state(mission, plan)
    for answer in (Planned(plan), NotPlanned("no way")):
        assert actor.handle(state, answer) == (state, ())


def test_a_step_changes_nothing_but_its_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a flight with a takeover, a change, a deadline and a failure: every step, taken twice."""
    seen: dict[str, set[str]] = {"Executive": set(), "VehicleNode": set()}

    def checked(actor_type: type[Any]) -> None:
        handle = actor_type.handle

        def twice(actor: Any, state: Any, message: Any) -> Any:
            before = pickle.dumps(state)
            after, out = handle(actor, state, message)
            again, same = handle(actor, pickle.loads(before), message)
            assert pickle.dumps(state) == before
            assert (again, repr(same)) == (after, repr(out))
            seen[actor_type.__name__].add(type(message).__name__)
            return after, out

        monkeypatch.setattr(actor_type, "handle", twice)

    checked(Executive)
    checked(VehicleNode)
    mission, plan = with_deadline()
    near = Traffic(90, Position(600.0, -600.0, 300.0), Velocity(0.0, 22.0, 0.0))
    lost = Change(100_000, VEHICLE_LOST, vehicle=1)
    mission = replace(mission, traffic=(near,), changes=(lost,))
    result, _ = flown(mission, plan)
    assert (result.takeovers, list(result.failed)) == (1, [1])
    # ways back are asked for where UxAS plans live alone (test_ways_back_asked)
    # and that a link is lost, or somebody lands, means something with `link_loss:` alone (below),
    # a declared failure with `on_failure:` (test_on_failure)
    others = {"RouteAsked", "NotHeard", "HeardAgain", "Stands", "Fails", "WithoutLink"}
    assert seen["Executive"] == {m.__name__ for m in ToExecutive.__args__} - others
    assert seen["VehicleNode"] == {m.__name__ for m in ToVehicle.__args__} - {"LimitsAre"}


def test_that_a_vehicle_is_not_heard_is_a_step_like_any_other() -> None:
    mission, plan = with_deadline()
    actor = Executive(Config(mission, Projection(mission.frame), ()))
    start = AirState(mission.vehicles[0].position, 0.0, 22.0, 0.0)
    messages = (Begin(0, ((1, start),)), NotHeard(1, 0), HeardAgain(1, 500, False))
    steps = plain_steps(actor, first_state(mission, plan), (*messages, Stands(1, "field")))
    *chains, landed = [state.find(1) for state in steps]
    assert landed == chains[-1]
    assert [(c.unlinked, c.suspended) for c in chains if c is not None] == [
        (False, False),
        (True, True),
        (False, True),
    ]


def test_a_settled_task_does_not_fail_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A change that leaves no plan fails what is left, once, and by the kernel."""
    lost = Change(5000, VEHICLE_LOST, vehicle=1)
    mission = replace(alone(60_000), changes=(lost,))
    result, log = flown(mission)
    assert list(result.failed) == [1]
    assert len(of_type(log, "TaskProgress", Phase=lmcp.enums["TaskPhase"].Failed)) == 1
    monkeypatch.setattr(task_states, "task_after", lambda before, event: before)
    result, _ = flown(mission)
    assert list(result.failed) == []


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (Change(0, VEHICLE_LOST, vehicle=1), ""),
        (Change(0, VEHICLE_JOINS, vehicle=1), "what is left is shared out again"),
        (Change(0, TASK_ADDED, task=1), "what is left is shared out again"),
        (Change(0, TASK_REMOVED, task=1), "task 1 is left out"),
        (Change(0, TASK_REMOVED, task=2), ""),
        (Change(0, WIND), ""),
        (ZoneEnd(0, ZONE_ENDS, zone_id=9), "task 3 may be done, or done whole, without it"),
        (ZoneEnd(0, ZONE_ENDS, zone_id=8), ""),
    ],
)
def test_which_changes_ask_for_another_plan(
    monkeypatch: pytest.MonkeyPatch, change: Change, why: str
) -> None:
    undone = {ZoneEnd(0, ZONE_ENDS, zone_id=9): [3]}
    assert touched_by([change], (), {}, {2}, {}, undone) == why
    monkeypatch.setattr(replan_triggers, "change_counts", lambda *_: False)
    assert touched_by([change], (), {}, {2}, {}, undone) == ""


def test_a_chain_is_left_as_it_is_by_what_follows_it() -> None:
    track = Track((Position(0.0, 0.0, 300.0), Position(100.0, 0.0, 300.0)))
    chain = Chain(meeting().vehicles[0], (), 0, Phase.TRANSIT, track, 22.0)
    before = pickle.dumps(chain)
    state = AirState(Position(80.0, 0.0, 300.0), 0.0, 22.0, 0.0)
    moved, at_ms = replace(chain, s_m=60.0).measure(state, 1000, 1.0)
    assert (moved.s_m, moved.since_ms, at_ms) == (80.0, 1000, None)
    entered = moved.enter(Phase.WAIT, track, 1500)
    assert (entered.phase, entered.s_m, entered.since_ms) == (Phase.WAIT, 0.0, 1500)
    assert (entered.version, entered.route_version) == (1, 1)
    assert pickle.dumps(chain) == before
    assert moved.s_m == 80.0
    past = AirState(Position(104.0, 0.0, 300.0), 0.0, 22.0, 0.0)
    assert moved.measure(past, 2000, 1.0)[1] == 1834  # 20 of 24 m in a second
    with pytest.raises(FrozenInstanceError):
        chain.s_m = 1.0  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError):
        track.points = ()  # type: ignore[misc]
