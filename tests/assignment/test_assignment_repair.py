"""Neighbourhoods repaired by the exact search: nothing gets dearer, and what comes out is a schedule."""

from __future__ import annotations

import random
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from cratous.core.assignment import layers
from cratous.core.assignment.anytime import greedy, timed
from cratous.core.assignment.compiled import MODERATE_TASKS
from cratous.core.assignment.instance import Instance
from cratous.core.assignment.lower_bounds import least_until, shortest_ways, ways_hold
from cratous.core.assignment.repair import repaired
from cratous.services.certify.evidence import counted
from cratous.services.planning import assign
from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_problem import arrays, parts
from cratous.spec.assignment.search import CUMULATIVE, MINMAX, AssignmentProblem, Choice, Cost


def problem(tasks: int, vehicles: int, relations: str = "", seed: int = 1) -> AssignmentProblem:
    """Tasks and vehicles at random places of a line, one way each."""
    rng = random.Random(seed)
    at = [rng.randrange(1, 1000) for _ in range(tasks)]
    ids = tuple(range(1, vehicles + 1))
    choices = tuple(Choice(t + 1, 1, rng.randrange(5, 50), ids) for t in range(tasks))
    travel = tuple(
        tuple(tuple(abs(a - b) + 1 for b in at) for a in (*at, start))
        for start in (rng.randrange(1000) for _ in ids)
    )
    return AssignmentProblem("line", ids, (0,) * vehicles, choices, travel, relations)


def arrays_of(p: AssignmentProblem) -> Instance:
    return arrays(p, parts(p)[0][0])


def cost_of(i: Instance, moves: tuple[tuple[int, int], ...]) -> int:
    """The weighted latest end and last ends, by other code than that which found them."""
    last = {v: end for v, _, _, _, end in timed(i, moves)}
    return int(max(last.values()) * i.weight[0] + sum(last.values()) * i.weight[1])


@pytest.mark.parametrize("relations", ["", "|(.(p1 p2 p3) .(p4 p5 p6) .(p7 p8) p9 p10 p11 p12)"])
@pytest.mark.parametrize("cost", [MINMAX, CUMULATIVE])
def test_a_repair_is_a_schedule_that_is_no_dearer(relations: str, cost: Cost) -> None:
    i = arrays_of(replace(problem(12, 3, relations), cost=cost))
    _, moves = greedy(i)
    assert moves is not None
    least, better, nodes = repaired(i, moves, 60, 1)
    assert nodes > 0
    assert least == cost_of(i, better) < cost_of(i, moves)
    assert sorted(i.task[o] for _, o in better) == list(range(12))
    assert repaired(i, moves, 60, 1) == (least, better, nodes)


def test_a_neighbourhood_of_everything_gives_the_optimum() -> None:
    p = problem(8, 2, seed=3)
    best, i = solve(p), arrays_of(p)
    _, moves = greedy(i)
    assert moves is not None
    assert best.cost == best.bound < cost_of(i, moves)
    assert repaired(i, moves, 40, 1)[0] == best.cost


def test_moves_that_block_each_other_are_left_alone() -> None:
    p = problem(4, 1, ".(p1 p2 p3 p4)")
    i = arrays_of(p)
    wrong = ((0, 3), (0, 2), (0, 1), (0, 0))
    assert repaired(i, wrong, 5, 1) == (1 << 60, wrong, 0)


def test_a_way_with_a_stop_that_is_shorter_is_noticed() -> None:
    i = arrays_of(problem(5, 2))
    reach = shortest_ways(i.travel, i.duration, i.may)
    assert ways_hold(reach, i.travel, i.duration, i.may)
    longer = reach.copy()
    longer[1, 2, 3] += 10_000
    assert not ways_hold(longer, i.travel, i.duration, i.may)


def test_ways_over_stops_from_which_nothing_leads_on_are_left_out_and_no_others() -> None:
    i = arrays_of(problem(6, 2))
    travel = i.travel.copy()
    travel[:, 2] = travel[1, 4] = layers.FAR  # no way on from these
    travel[:, 6, 3] += 5_000  # over others it is shorter
    wanted = travel.copy()
    for v in range(2):
        for _ in range(6):  # as many rounds as a way may have stops
            for m in range(6):
                over = wanted[v, :, m, None] + i.duration[m] + wanted[v, m][None]
                wanted[v] = np.minimum(wanted[v], over)
    reach = shortest_ways(travel, i.duration, i.may)
    assert (reach == wanted).all()
    assert (reach < travel).any()
    assert ways_hold(reach, travel, i.duration, i.may)
    over = np.argwhere(reach < travel)[0]
    reach[tuple(over)] = travel[tuple(over)]
    assert not ways_hold(reach, travel, i.duration, i.may)


def test_what_looks_ahead_is_made_once_for_the_same_instance(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made: list[Instance] = []
    really = layers._look_ahead

    def counted(instance: Instance) -> layers.Ahead:
        made.append(instance)
        return really(instance)

    monkeypatch.setattr(layers, "_look_ahead", counted)
    monkeypatch.setattr(layers, "_AHEAD", layers._Found(16))
    for number, i in enumerate((arrays_of(problem(3, 2)), arrays_of(problem(6, 2))), 1):
        first = layers.look_ahead(i)
        again = layers.look_ahead(i._replace(travel=i.travel.copy()))
        assert len(made) == number
        assert all((one == other).all() for one, other in zip(first, again, strict=True))
        again.head[:] = 0  # what one does with it is not seen by the next
        assert (layers.look_ahead(i).head == first.head).all()
    # whatever of it is another, it is another question
    for k, name in enumerate(i._fields):
        value = getattr(i, name)
        other = 1 - value if name == "waits" else value + 1
        if name in ("travel", "added", "duration", "ready", "release", "due", "weight", "waits"):
            before = len(made)
            layers.look_ahead(i._replace(**{name: other}))
            assert len(made) == before + 1, (k, name)


def test_the_same_ways_are_gone_over_once(monkeypatch: pytest.MonkeyPatch) -> None:
    gone_over = []

    def counted(instance: object, function: object, _: int) -> object:
        gone_over.append(function)
        return function

    monkeypatch.setattr(layers, "machine_for", counted)
    monkeypatch.setattr(layers, "_FOUND", layers._Found(2))
    i = arrays_of(problem(3, 2))
    first = layers.shortest(i, i.may)
    asked = len(gone_over)
    assert asked == 2
    again = layers.shortest(i._replace(due=i.due + 1), i.may)
    assert len(gone_over) == asked
    assert (first == again).all()
    # what one does with its ways is not seen by the next
    again[:] = 0
    assert (layers.shortest(i, i.may) == first).all()
    # another way, duration or option is another question
    for k, other in enumerate(
        (i._replace(travel=i.travel + 1), i._replace(duration=i.duration + 1)), 1
    ):
        layers.shortest(other, other.may)
        assert len(gone_over) == asked + 2 * k
    fewer = np.zeros_like(i.may)
    assert (layers.shortest(i, fewer) == 1 << 40).all()
    # two are kept, the oldest is gone
    before = len(gone_over)
    layers.shortest(i, i.may)
    assert len(gone_over) == before + 2


def test_what_is_counted_of_a_flight_is_the_same_after_another() -> None:
    i = arrays_of(problem(3, 2))
    found = []
    for _ in range(2):
        with counted() as calls:
            layers.shortest(i, i.may)
        found.append(calls.data())
    assert found[0] == found[1]
    assert any(name.endswith(".no_shortcut") for name in found[0]["within"])


def test_ways_of_large_assignments_are_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    kept = layers._Found(2)
    monkeypatch.setattr(layers, "_FOUND", kept)
    i = arrays_of(problem(MODERATE_TASKS + 1, 2))
    layers.shortest(i, i.may)
    assert kept._made == {}


def test_what_is_kept_has_a_limit_in_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layers, "KEPT_BYTES", 100)
    kept = layers._Found(16)
    keys = [np.full(2, k) for k in range(6)]
    for key in keys:
        kept.put((key,), (np.zeros(5, np.int64),))  # 40 bytes
    assert [kept.of((key,)) is not None for key in keys] == [False] * 4 + [True] * 2
    kept.put((keys[5],), (np.ones(10, np.int64),))  # what is kept anew takes no place twice
    assert [kept.of((key,)) is not None for key in keys] == [False] * 5 + [True]
    kept.put((keys[0],), (np.zeros(13, np.int64),))
    assert kept.of((keys[0],)) is None, "larger than all that may be kept"
    (found,) = kept.of((keys[5],)) or ()
    assert (found == 1).all()
    kept.forget_all()
    kept.put((keys[1],), (np.zeros(12, np.int64),))
    assert kept.of((keys[1],)) is not None


def test_vehicles_without_work_are_no_bound() -> None:
    i = arrays_of(problem(4, 2))
    assert least_until(0, i.ready) == -1
    assert least_until(11, i.ready) == 6


def test_a_problem_of_many_tasks_is_repaired_on_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def spy(*given: Any) -> Any:
        asked.append(repaired(*given))
        return asked[-1]

    monkeypatch.setattr(assign, "repaired", spy)
    found = solve(problem(64, 3), Limits(nodes=1_200_000))
    assert found.cost is not None
    assert asked
    assert 0 < found.bound <= found.cost <= min(cost for cost, _, _ in asked)
