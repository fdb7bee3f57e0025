"""The compiled assignment search: published optima, certificates, clashes, limits, bad input."""

from __future__ import annotations

import copy
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cratous.core.assignment.compiled import is_brief
from cratous.core.assignment.instance import Instance
from cratous.core.assignment.layers import first_state, look_ahead, refute, shortest
from cratous.core.assignment.refutation import bound, place
from cratous.services.cli import main
from cratous.services.planning import assign_certificate as certificates
from cratous.services.planning import assign_problem
from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_problem import arrays, parts
from cratous.services.planning.assign_replay import replayed
from cratous.services.planning.assign_solvers import none_below, schedule_holds, why_infeasible
from cratous.services.planning.assign_vectors import read
from cratous.services.planning.partial import Parts
from cratous.services.planning.reasons import timing_reasons
from cratous.spec import algebra
from cratous.spec.algebra import runs as algebra_runs
from cratous.spec.assignment.search import ORDER, AssignmentProblem, Choice, Cost
from cratous.spec.errors import BadInput

FAR_WAY = 10


def line(
    count: int = 3, relations: str = "", vehicles: int = 2, **more: object
) -> AssignmentProblem:
    """Tasks 1..count a way of 10 apart, each of duration 5; vehicles start 10 before task 1."""
    choices = tuple(Choice(t, 1, 5, tuple(range(1, vehicles + 1))) for t in range(1, count + 1))
    rows = tuple(
        tuple(FAR_WAY * abs(a - b) for b in range(1, count + 1)) for a in (*range(1, count + 1), 0)
    )
    made = AssignmentProblem(
        "line", tuple(range(1, vehicles + 1)), (0,) * vehicles, choices, (rows,) * vehicles,
        relations,
    )  # fmt: skip
    return replace(made, **more)  # type: ignore[arg-type]


def checked(p: AssignmentProblem, **limits: object) -> tuple[object, dict]:
    found, body = certificates.certified(p, solve(p, Limits(**limits)))  # type: ignore[arg-type]
    assert certificates.verify(body).wrong == ""
    return found, body


# ---- published problems -----------------------------------------------------------------------
@pytest.mark.parametrize(
    "name", ["open-v3-t08-0", "open-v3-t10-3", "open-v3-t11-2", "open-v3-t12-3"]
)
def test_recorded_optima_are_proved(name: str, shared: Path, capsys: pytest.CaptureFixture) -> None:
    assert main(["conform", "assignment", str(shared / f"vectors/assignment/{name}.json")]) == 0
    assert "1 passed, 0 failed" in capsys.readouterr().out


@pytest.mark.parametrize(
    "shape", ["parallel", "sequence", "chains", "alternatives", "mixed", "options"]
)
def test_no_worse_than_openuxas(shape: str, shared: Path) -> None:
    files = [f"vectors/openuxas/bb/open-{shape}-{size}.json" for size in ("2v5t", "3v8t", "4v10t")]
    assert main(["conform", "assignment", *[str(shared / file) for file in files]]) == 0


def test_a_recorded_cost_that_is_wrong_fails(shared: Path, tmp_path: Path) -> None:
    data = json.loads((shared / "vectors/openuxas/bb/open-mixed-3v8t.json").read_text())
    for row in data["results"]:
        row["cost_ms"] = row.get("cost_ms", 0) - 1
    (tmp_path / "a.json").write_text(json.dumps(data))
    assert main(["conform", "assignment", str(tmp_path / "a.json")]) == 1


def test_of_too_many_alternatives_nothing_is_said_of_those_not_looked_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(assign_problem, "BRANCHES_MAX", 3)
    found, body = checked(line(4, "+(p4 p3 p2 p1)", name="four"))
    assert (found.status, found.cost, found.bound, body["proofs"]) == ("feasible", 25, 0, [])
    late = line(4, "+(p4_[0-1] p3_[0-1] p2_[0-1] p1)", name="late")
    found = solve(late)
    assert found.status == "unknown"
    cut = "of 4 ways to choose among alternatives the first 3 were looked at"
    assert cut in timing_reasons(late, found)[-1]
    assert not Parts(late, {}).sure
    able = tuple(replace(c, vehicles=(1,) if c.task_id == 1 else ()) for c in late.choices)
    assert solve(replace(late, choices=able)).status == "unknown", "another way might do"


# ---- meaning ----------------------------------------------------------------------------------
def test_order_holds_in_time_on_other_vehicles() -> None:
    in_time, _ = checked(line(2, ".(p2 p1)"))
    assert in_time.cost == 30
    assert in_time.status == "optimal"
    by_order, _ = checked(line(2, ".(p2 p1)", semantics=ORDER))
    assert by_order.cost == 25
    assert by_order.status == "optimal"


def test_every_cost_function(shared: Path) -> None:
    p = line(4, vehicles=2)
    least, _ = checked(replace(p, cost=Cost(1, 0)))
    team, _ = checked(replace(p, cost=Cost(0, 1)))
    both, _ = checked(replace(p, cost=Cost(1, 1)))
    assert (least.cost, team.cost) == (45, 60)
    assert both.cost == 60 + 60
    ways = p.travel_ms
    far = replace(p, cost=Cost(0, 0, 3), distance_mm=ways)
    assert checked(far)[0].cost == 3 * 40
    energy = replace(p, cost=Cost(0, 0, 0, 2), energy_mj=ways)
    assert checked(energy)[0].cost == 2 * 40


def test_masks_open_what_the_derivatives_allow() -> None:
    texts = [".(p1 p2 p3 p4)", "~(p1 |(p2 p3) p4)", ".(~(p1 p2) |(p3 .(p4 p5)))", "|(.(p1 p2) ~(p3 .(p4 p5)))",
             "~(.(p1 p2) |(p3 ~(p4 p5)) p6)", ".(|(p1 ~(p2 p3)) .(p4 |(p5 p6)))"]  # fmt: skip
    for text in texts:
        term = algebra.parse(text)
        count = len(
            set(algebra.tasks(term)) if hasattr(algebra, "tasks") else list(algebra.atoms(term))
        )
        p = line(count, text)
        part = parts(p)[0][0]
        i = arrays(p, part)
        start = np.array(
            [0, *[count] * 2, *[0] * 2, 0, 0, *[-1 if k == 2 else 0 for k in i.ref_kind]]
        )
        todo = [((), start)]
        while todo:
            done, state = todo.pop()
            allowed = algebra_runs.next_actions(term, done)
            for o in range(count):
                child = np.zeros_like(state)
                can = place(state, child, 0, o, i._replace(waits=1), 0)
                task = part.tasks[int(i.task[o])]
                assert can == (task in allowed), (text, done, task)
                if can:
                    todo.append(((*done, task), child))


def test_compiled_search_is_the_one_that_cpython_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    p = line(5, "|(.(p4 p2) ~(p1 p5) p3)")
    i = arrays(p, parts(p)[0][0])
    limit = 60
    with monkeypatch.context() as cpython, np.errstate(over="ignore"):
        cpython.setattr("cratous.core.assignment.compiled.machine", lambda function: function)
        slow = refute(i, limit, 1000)
    assert is_brief(i)
    mixed = refute(i, limit, 1000)
    monkeypatch.setattr("cratous.core.assignment.layers.is_brief", lambda _: False)
    fast = refute(i, limit, 1000)
    found = [(one.cost, one.moves, one.known, one.counts) for one in (slow, mixed, fast)]
    assert found[0] == found[1] == found[2]


# ---- limits -----------------------------------------------------------------------------------
def test_same_seed_same_result_and_progress_is_told(shared: Path) -> None:
    data = json.loads((shared / "vectors/assignment/open-v3-t12-3.json").read_text())
    told: list[tuple[int, int | None, int]] = []
    p = read(data, "time")
    one = solve(p, Limits(seed=3), lambda *now: told.append(now))
    two = solve(p, Limits(seed=3))
    assert (one.steps, one.nodes, one.trace) == (two.steps, two.nodes, two.trace)
    costs = [cost for _, cost, _ in told if cost is not None]
    assert costs == sorted(costs, reverse=True)
    assert told[-1][2] == one.cost
    first = solve(p, Limits(nodes=0))
    assert first.cost is not None
    assert one.cost is not None
    assert first.cost > one.cost
    assert certificates.certified(p, first)[0].status == "feasible"
    near = solve(p, Limits(gap=0.5))
    assert near.gap is not None
    assert near.gap <= 0.5


def test_narrow_search_claims_only_a_gap(shared: Path) -> None:
    data = json.loads((shared / "vectors/assignment/open-v3-t12-3.json").read_text())
    i = arrays(*(lambda p: (p, parts(p)[0][0]))(read(data, "time")))
    narrow = refute(i, 900_000, 2, look_ahead(i))
    assert narrow.known < narrow.cost <= 900_000


# ---- certificates -----------------------------------------------------------------------------
def tampered(body: dict) -> dict[str, dict]:
    """Certificates that claim something else, with the digest made anew."""
    made = {
        name: copy.deepcopy(body) for name in ("bound", "step", "layer", "limit", "vehicle", "term")
    }
    made["bound"]["claim"]["bound"] += 1
    made["step"]["steps"][-1]["start_ms"] -= 1
    made["step"]["steps"][-1]["end_ms"] -= 1
    made["layer"]["proofs"][0]["sizes"] = [
        n - (k == 3) for k, n in enumerate(body["proofs"][0]["sizes"])
    ]
    made["limit"]["proofs"][0]["limit"] += 10_000
    first = made["vehicle"]["steps"][0]
    first["vehicle_id"] = next(v for v in body["problem"]["vehicles"] if v != first["vehicle_id"])
    made["term"]["problem"]["relations"] = ""
    for other in made.values():
        other["sha256"] = certificates._digest(other)
    return made


def test_tampered_certificates_are_refused(shared: Path, tmp_path: Path) -> None:
    data = json.loads((shared / "vectors/assignment/open-v3-t10-0.json").read_text())
    found, body = checked(read(data, "time"))
    assert found.status == "optimal"
    assert body["proofs"][0]["kind"] == "layers"
    wrong = tampered(body)
    # a whole entry left out, with the rest in place
    layers = certificates._Origins(body["proofs"][0])
    origins = [layers[k] for k in range(len(layers))]
    short = copy.deepcopy(body)
    less = [o if k != 4 else o[:-1] for k, o in enumerate(origins)]
    proof = certificates.Proof("layers", found.cost, body["proofs"][0]["limit"], tuple(less))
    short["proofs"] = [certificates._proof(proof)]
    short["sha256"] = certificates._digest(short)
    for name, other in {**wrong, "entry": short}.items():
        verdict = certificates.verify(other)
        assert verdict.wrong, name
    certificates.write(tmp_path / "good.json", body)
    certificates.write(tmp_path / "bad.json", wrong["bound"])
    assert main(["certify-plan", str(tmp_path / "good.json")]) == 0
    assert main(["certify-plan", str(tmp_path / "bad.json"), "--json"]) == 1
    (tmp_path / "none.json").write_text("{}")
    assert main(["certify-plan", str(tmp_path / "none.json")]) == 2


def test_two_solvers_prove_what_has_upper_limits_between_tasks() -> None:
    p = line(3, "|(.(p3 p1)-[10-18] p2)")
    found, body = checked(p)
    assert found.status == "infeasible" or body["proofs"]
    late = line(2, ".(p2 p1)-[0-15]", vehicles=1)
    best, shown = checked(late)
    assert best.status == "optimal"
    assert best.cost == 40
    assert none_below(late, 40)[0]
    assert not none_below(late, 41)[0]
    assert schedule_holds(late, best.steps)[0]
    assert shown["claim"]["bound"] == 40


# ---- no plan ----------------------------------------------------------------------------------
def test_a_smallest_clash_is_named() -> None:
    p = line(
        3, "|(.(p3 p1) p2)_[0-200]", vehicles=1, due_ms=((1, 30), (2, 500)), release_ms=((3, 20),)
    )
    found = solve(p)
    assert found.status == "infeasible"
    reasons, sure = why_infeasible(p)
    assert sure
    assert set(reasons) <= {
        "`|(.(p3 p1) p2)_[0-200]`: p1 ends at 200 ms or earlier",
        "task 1 is due by 30 ms",
        "`.(p3 p1)`: p1 not before `p3` ends",
        "task 3 is released at 20 ms",
    }
    assert "task 1 is due by 30 ms" in reasons
    assert "task 2 is due by 500 ms" not in reasons
    # without any one of them there is a plan
    assert solve(replace(p, due_ms=())).status != "infeasible"
    assert why_infeasible(line(2)) == ((), True)


# ---- bad input --------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"vehicles": ()}, "no vehicle"),
        ({"choices": ()}, "no task"),
        ({"semantics": "uxas"}, "semantics"),
        ({"ready_ms": (0, -1)}, "below zero"),
        ({"ready_ms": (0,)}, "ready time"),
        ({"cost": Cost(-1)}, "below zero"),
        ({"cost": Cost(0, 0, 1)}, "distance"),
        ({"travel_ms": ()}, "table"),
        ({"relations": ".(p1 p2)"}, "left out"),
        ({"relations": ".(p1 p2 p9)"}, "unknown task"),
        ({"due_ms": ((9, 5),)}, "no such task"),
        ({"release_ms": ((1, float("nan")),)}, "not an integer"),
    ],
)
def test_bad_problems_are_named(change: dict, words: str) -> None:
    with pytest.raises(BadInput, match=words):
        solve(replace(line(3), **change))


def test_ineligible_missing_rows_and_timeless_tasks_are_named() -> None:
    p = line(2)
    nobody = tuple(replace(c, vehicles=()) for c in p.choices)
    with pytest.raises(BadInput, match="no vehicle is eligible for task 1"):
        solve(replace(p, choices=nobody))
    with pytest.raises(BadInput, match="row of the table is missing"):
        solve(replace(p, travel_ms=(p.travel_ms[0][:-1], p.travel_ms[1])))
    timeless = tuple(replace(c, duration_ms=0) for c in p.choices)
    here = tuple((0,) * 2 for _ in range(3))
    with pytest.raises(BadInput, match="without duration"):
        solve(replace(p, choices=timeless, travel_ms=(here, here)))
    with pytest.raises(BadInput, match="a field is missing"):
        read({"vehicles": []}, "time")


def test_a_schedule_that_is_none_is_refused() -> None:
    p = line(2, ".(p1 p2)")
    steps = solve(p).steps
    early = tuple(replace(s, start_ms=s.start_ms - 1, end_ms=s.end_ms - 1) for s in steps)
    for wrong in (early, steps[:1], (*steps, steps[0])):
        with pytest.raises(BadInput, match="no solution"):
            replayed(p, wrong)
    assert not schedule_holds(p, (steps[0], replace(steps[1], start_ms=1, end_ms=6)))[0]


# ---- many tasks -------------------------------------------------------------------------------
def test_more_than_62_tasks_are_planned_and_replayed() -> None:
    p = line(70, vehicles=3)
    found = solve(p, Limits(nodes=100_000))
    assert found.cost is not None
    assert len(found.steps) == 70
    assert replayed(p, found.steps) == found.cost
    assert found.bound < found.cost


def test_command_solves_and_explains(
    shared: Path, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    file = shared / "vectors/assignment/open-v3-t08-0.json"
    out = tmp_path / "c.json"
    assert main(["assign", str(file), "--certificate", str(out), "--progress"]) == 0
    assert "optimal (time): cost 494275" in capsys.readouterr().out
    assert main(["certify-plan", str(out)]) == 0
    data = json.loads(file.read_text())
    data["process_algebra"] = data["process_algebra"] + "_[0-1000]"
    (tmp_path / "late.json").write_text(json.dumps(data))
    assert main(["assign", str(tmp_path / "late.json")]) == 1
    assert "contradict each other" in capsys.readouterr().out
    assert main(["assign", str(file), "--cost", "x"]) == 2


# ---- bounds -----------------------------------------------------------------------------------
def test_the_bound_takes_the_least_of_every_option_of_every_task() -> None:
    """Tables by task give what asking every pair of options gives."""
    rng = np.random.default_rng(7)
    for vehicles, n, options in ((2, 4, 9), (3, 5, 5), (1, 3, 8)):
        task = np.array([*range(n), *rng.integers(0, n, options - n)])
        able = rng.random((vehicles, options)) < 0.8
        able[0, :n] = True
        choices = tuple(
            Choice(int(task[o]) + 1, o, int(rng.integers(0, 50)),
                   tuple(v + 1 for v in range(vehicles) if able[v, o]))
            for o in range(options)
        )  # fmt: skip
        travel = tuple(
            tuple(
                tuple(int(w) if able[v, o] else None for o, w in enumerate(row))
                for row in rng.integers(0, 100, (options + 1, options))
            )
            for v in range(vehicles)
        )
        p = AssignmentProblem("", (*range(1, vehicles + 1),), (0,) * vehicles, choices, travel, "")
        i = arrays(p, parts(p)[0][0])
        ahead = look_ahead(i)
        for _ in range(20):
            state, done = first_state(i), rng.random(n) < 0.4
            state[0] = sum(1 << j for j in range(n) if done[j])
            for v in range(vehicles):
                at = [o for o in range(options) if i.may[v, o] and done[i.task[o]]]
                if at and rng.random() < 0.7:
                    state[1 + v], state[1 + vehicles + v] = rng.choice(at), rng.integers(0, 500)
            found = bound(state, i._replace(weight=np.array([0, 1])), ahead)
            assert found == least_sum(i, state)


def least_sum(i: Instance, state: np.ndarray) -> int:
    """Ends of what flies, and for each open task the cheapest leg and stay there is."""
    v_s, k = range(i.vehicles), i.duration.size
    reach = shortest(i, i.may)
    is_open = [not (int(state[0]) >> int(j)) & 1 for j in i.task]
    total = sum(int(state[1 + i.vehicles + v]) for v in v_s if state[1 + v] != k)
    for j in {int(t) for t, open_ in zip(i.task, is_open, strict=True) if open_}:
        total += min(
            int(reach[v, a, o] + i.duration[o])
            for v in v_s
            for o in range(k)
            if i.task[o] == j and i.may[v, o]
            for a in [int(state[1 + v]), *[b for b in range(k) if is_open[b] and i.task[b] != j]]
        )
    return total
