"""How the solution of a large assignment problem improves with time: cost, bound, CPU seconds and memory.

`python bench/assignment_large.py [--tasks 127] [--vehicles 6] [--seconds 60] [--chains 4]`: random places in a square
of 30 km (fixed seed), 25 m/s, tasks of 30 to 300 s; with --chains the tasks come in sequences of that length, on any
vehicles. CPU seconds, since wall seconds on a shared machine are not meaningful.
"""

from __future__ import annotations

import argparse
import random
import resource
import time

from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_warm import warm
from cratous.spec.assignment.search import AssignmentProblem, Choice

SIDE_M, SPEED_M_S = 30_000.0, 25.0


def problem(tasks: int, vehicles: int, chains: int, seed: int = 1) -> AssignmentProblem:
    """A random problem."""
    rng = random.Random(seed)
    places = [(rng.uniform(0, SIDE_M), rng.uniform(0, SIDE_M)) for _ in range(tasks)]
    starts = [(rng.uniform(0, SIDE_M), rng.uniform(0, SIDE_M)) for _ in range(vehicles)]
    ids = tuple(range(1, vehicles + 1))
    choices = tuple(Choice(t + 1, 1, rng.randrange(30_000, 300_000), ids) for t in range(tasks))

    def way_ms(a: tuple[float, float], b: tuple[float, float]) -> int:
        return int(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5 / SPEED_M_S * 1000)

    travel = tuple(
        tuple(tuple(way_ms(a, b) for b in places) for a in (*places, start)) for start in starts
    )
    relations = ""
    if chains > 1:
        rows = [range(a, min(a + chains, tasks + 1)) for a in range(1, tasks + 1, chains)]
        relations = "|(" + " ".join(f".({' '.join(f'p{t}' for t in row)})" for row in rows) + ")"
    return AssignmentProblem("large", ids, (0,) * vehicles, choices, travel, relations)


def main() -> None:
    """Print each improvement, then the final result."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tasks", type=int, default=127)
    parser.add_argument("--vehicles", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--chains", type=int, default=0)
    given = parser.parse_args()
    of = problem(given.tasks, given.vehicles, given.chains)
    warm()
    began = time.process_time()

    def tell(nodes: int, cost: int | None, bound: int) -> None:
        print(f"{time.process_time() - began:.2f} CPU s, {nodes} nodes: cost {cost}, bound {bound}")

    found = solve(of, Limits(seconds=given.seconds), tell)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    print(f"cost {found.cost}, bound {found.bound}, gap {found.gap}, peak memory {memory} MB")


if __name__ == "__main__":
    main()
