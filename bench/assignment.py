"""Time to a proved optimum of assignment problems, compared with CP-SAT, problem by problem in one run.

`python bench/assignment.py FOLDER [--ortools PYTHON] [--only PART]`: FOLDER holds the problems (open-v*-t*.json);
PYTHON is an interpreter with ortools (bench/requirements.txt). Each problem is solved by both, one after the other,
so that load on the machine affects both; times are wall seconds, CP-SAT with 2 workers, ours with one thread; CPU
seconds are listed too.
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
import subprocess
import time
from pathlib import Path

from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_certificate import certified, verify
from cratous.services.planning.assign_vectors import read
from cratous.services.planning.assign_warm import warm


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--ortools", default="")
    parser.add_argument("--only", default="open-v")
    parser.add_argument("--semantics", default="time")
    parser.add_argument("--seconds", type=float, default=30.0)
    given = parser.parse_args()
    warm()
    peer = None
    if given.ortools:
        script = Path(__file__).with_name("cpsat_assignment.py")
        peer = subprocess.Popen(
            [given.ortools, str(script)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
    groups: dict[str, list[tuple[float, float]]] = {}
    print("| problem | ours s (CPU) | gap % | check s | CP-SAT s (CPU) | gap % | CP-SAT / ours |")
    print("|---|---|---|---|---|---|---|")
    for file in sorted(given.folder.glob("open-v*.json")):
        if given.only not in file.name:
            continue
        data = json.loads(file.read_text())
        problem = read(data, given.semantics)
        began, cpu = time.perf_counter(), time.process_time()
        found = solve(problem, Limits(seconds=given.seconds))
        ours, ours_cpu = time.perf_counter() - began, time.process_time() - cpu
        solution, body = certified(problem, found)
        began = time.perf_counter()
        verdict = verify(body)
        check = time.perf_counter() - began
        assert not verdict.wrong, verdict.wrong
        theirs: dict[str, float] = {
            "wall_s": float("nan"),
            "cpu_s": float("nan"),
            "cost": 0,
            "bound": 0,
        }
        if peer is not None and peer.stdin is not None and peer.stdout is not None:
            ask = {"problem": data, "semantics": given.semantics, "seconds": given.seconds}
            peer.stdin.write(json.dumps(ask) + "\n")
            peer.stdin.flush()
            theirs = json.loads(peer.stdout.readline())
            groups.setdefault(file.name[5:11], []).append((ours, theirs["wall_s"]))
            if solution.status == "optimal" and theirs["bound"] == theirs["cost"]:
                assert theirs["cost"] == solution.cost, (file.name, theirs, solution.cost)
        gap = 100 * (theirs["cost"] - theirs["bound"]) / theirs["cost"] if theirs["cost"] else 0.0
        print(
            f"| {file.name[5:-5]} | {ours:.3f} ({ours_cpu:.3f}) | {100 * (solution.gap or 0):.2f} "
            f"| {check:.3f} | {theirs['wall_s']:.3f} ({theirs['cpu_s']:.3f}) | {gap:.2f} "
            f"| {theirs['wall_s'] / ours:.1f} |",
            flush=True,
        )
    for name, pairs in groups.items():
        a, b = (statistics.median(pair[k] for pair in pairs) for k in (0, 1))
        print(f"median {name}: ours {a:.3f} s, CP-SAT {b:.3f} s, CP-SAT / ours {b / a:.1f}")
    rss = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(f"peak memory {rss // 1024} MB")
    if peer is not None and peer.stdin is not None:
        peer.stdin.close()
        peer.wait(timeout=60)


if __name__ == "__main__":
    main()
