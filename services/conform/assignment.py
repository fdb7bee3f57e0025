"""Suite `assignment`: recorded optima and best costs for the assignment search.

Two forms of problems (`services.planning.assign_vectors`). A case with a cost matrix is solved with
the semantics `order` and MINMAX: the cost must equal the optimum if an exhaustive result is
recorded, and never exceed the best recorded one. Any other case is solved with both semantics,
`time` and `order`, and compared with the optima of a file `optimum*.json` beside it; each has to be
proved. Every solution is replayed by the proved kernels, whatever is recorded.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cratous.services.conform import Beside, Result, failed, not_covered, passed
from cratous.services.planning.assign import Limits, solve
from cratous.services.planning.assign_vectors import read
from cratous.spec.assignment.search import ORDER, TIME, Solution
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import json_of
from cratous.spec.files.text_file import bytes_of

SECONDS = 30.0
WORDS = {"A": TIME, "B": ORDER}


def compare(case: dict[str, Any], file: Path) -> Result:
    """Solve one problem of the suite; the results of its checks."""
    name = str(case.get("name") or file.name)
    if "cost_matrix" in case:
        return _matrix(case, name)
    recorded = _recorded(file)
    wrong, checks = [], 0
    for letter, semantics in WORDS.items():
        wanted = recorded.get((file.name, letter))
        if wanted is None:
            continue
        found = solve(read(case, semantics, name=name), Limits(seconds=SECONDS))
        checks += 1
        if found.cost != wanted or found.bound != wanted:
            wrong.append(f"{semantics}: expected {wanted} ms, proved; got {_said(found)}")
    if not checks:
        return not_covered(name, "no optimum is recorded")
    if wrong:
        return failed(name, "another cost, or not proved", "; ".join(wrong), checks)
    return passed(name, checks)


def _matrix(case: dict[str, Any], name: str) -> Result:
    results = [r for r in case.get("results", ()) if "cost_ms" in r]
    if not results:
        return not_covered(name, "no result is recorded")
    found = solve(read(case, ORDER, name=name), Limits(seconds=SECONDS))
    best = min(r["cost_ms"] for r in results)
    proved = [r["cost_ms"] for r in results if r.get("proved_exhaustive")]
    if found.cost is None or found.cost > best:
        return failed(name, "worse than recorded", f"recorded {best} ms, got {_said(found)}")
    if proved and (found.cost != min(proved) or found.bound != found.cost):
        return failed(name, "not the optimum", f"optimum {min(proved)} ms, got {_said(found)}")
    return passed(name)


def _said(found: Solution) -> str:
    if found.cost is None:
        return f"no solution ({found.status})"
    return f"{found.cost} ms, proved at least {found.bound} ms"


def _recorded(file: Path) -> dict[tuple[str, str], int]:
    """Optima of the files beside it, by file name and semantics."""
    known: dict[tuple[str, str], int] = {}
    for other in sorted(file.parent.glob("optimum*.json")):
        data = json_of(bytes_of(other), str(other))
        try:
            for row in data.get("results", ()):
                if row.get("status") == "OPTIMAL":
                    known[row["problem"], row["semantics"]] = int(row["minmax_ms"])
        except (AttributeError, KeyError, TypeError, ValueError):
            raise BadInput(
                "these are no optima", where=str(other),
                expected="results with problem, semantics, status and minmax_ms",
            ) from None  # fmt: skip
    return known


judge = Beside(compare)
