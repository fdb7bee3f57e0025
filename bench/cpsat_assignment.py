"""The peer of bench/assignment.py: CP-SAT on the pairwise-disjunctive model, 2 workers.

Run by an interpreter that has ortools: reads one JSON object per line (problem, semantics, seconds) and answers with
status, cost, bound and wall time.
"""

import json
import sys
import time

from ortools.sat.python import cp_model


def solve(problem, semantics, seconds):
    """The minimal makespan by CP-SAT; semantics `time` (waiting) or `order` (assignment order only)."""
    tasks = problem["tasks"]
    n, vehicles = len(tasks), len(problem["vehicles"])
    number = {t["id"]: k for k, t in enumerate(tasks)}
    travel, first = problem["travel_ms"], problem["start_cost_ms"]
    horizon = max(max(row) for row in first) + sum(
        t["duration_ms"] + max(travel[k]) for k, t in enumerate(tasks)
    )
    m = cp_model.CpModel()
    end = [m.new_int_var(0, horizon, f"e{j}") for j in range(n)]
    span = m.new_int_var(0, horizon, "span")
    who = [[m.new_bool_var(f"a{v}_{j}") for j in range(n)] for v in range(vehicles)]
    place = [m.new_int_var(0, n - 1, f"p{j}") for j in range(n)]
    for j, t in enumerate(tasks):
        m.add_exactly_one(who[v][j] for v in range(vehicles))
        m.add(span >= end[j])
        for v, vehicle in enumerate(problem["vehicles"]):
            if vehicle["id"] not in t["eligible"]:
                m.add(who[v][j] == 0)
            m.add(end[j] >= first[v][j] + t["duration_ms"]).only_enforce_if(who[v][j])
    for a, b in problem["precedence"]:
        i, j = number[a], number[b]
        if semantics == "time":
            m.add(end[j] - tasks[j]["duration_ms"] >= end[i])
        else:
            m.add(place[i] < place[j])
    for i in range(n):
        for j in range(i + 1, n):
            before = m.new_bool_var(f"o{i}_{j}")
            for v in range(vehicles):
                both = [who[v][i], who[v][j]]
                forward = [*both, before]
                backward = [*both, before.negated()]
                m.add(end[j] >= end[i] + travel[i][j] + tasks[j]["duration_ms"]).only_enforce_if(
                    forward
                )
                m.add(end[i] >= end[j] + travel[j][i] + tasks[i]["duration_ms"]).only_enforce_if(
                    backward
                )
                if semantics == "order":
                    m.add(place[i] < place[j]).only_enforce_if(forward)
                    m.add(place[j] < place[i]).only_enforce_if(backward)
    m.minimize(span)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 2
    solver.parameters.random_seed = 1
    solver.parameters.max_time_in_seconds = seconds
    began, cpu = time.perf_counter(), time.process_time()
    status = solver.solve(m)
    return {
        "status": solver.status_name(status),
        "cost": int(solver.objective_value),
        "bound": int(solver.best_objective_bound),
        "wall_s": time.perf_counter() - began,
        "cpu_s": time.process_time() - cpu,
    }


for line in sys.stdin:
    asked = json.loads(line)
    print(json.dumps(solve(asked["problem"], asked["semantics"], asked["seconds"])), flush=True)
