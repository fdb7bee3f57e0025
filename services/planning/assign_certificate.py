"""Certificates: a solution with the evidence for its bound, as a file that can be checked without the search.

The file holds the problem, the steps, the claim, and per branch a proof: `layers` (the origins of all states
from which less could still have been reached; the checker recomputes the states and requires every child that
is not listed), `tables` (the checker recomputes the tables over sets), `estimate` (the bound of the first
state), `chains` (the checker enumerates all chains below it), or `solvers` (z3 and cvc5 find nothing below
the cost). A solution is called optimal only if the proved bound equals its cost.
"""

from __future__ import annotations

import base64
import hashlib
import json
import zlib
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cratous.core.assignment.anytime import NONE, Proof, estimate
from cratous.core.assignment.by_sets import by_sets, is_sets
from cratous.core.assignment.chains import chains_below
from cratous.core.assignment.optimality import shows_optimal
from cratous.core.assignment.refutation_check import least_cost
from cratous.core.files.whole_file import write_atomically
from cratous.services.logs.records import from_data
from cratous.services.planning.assign_problem import Part, arrays, check, parts, settler
from cratous.services.planning.assign_replay import replayed
from cratous.services.planning.assign_vectors import rows_of
from cratous.services.planning.assign_witness import witnessed
from cratous.spec.assignment.search import AssignmentProblem, Solution, Step
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import STATES, json_of
from cratous.spec.files.text_file import bytes_of

FORMAT = "cratous-assignment-certificate/1"
BYTES_MAX = 50_000_000
CHAINS_MAX = 20_000_000
"""Most nodes of a chain enumeration that is repeated."""
SOLVER_TASKS = 8
"""Problems of at most this many tasks are given to z3 and cvc5 if nothing else proves them."""


@dataclass(frozen=True)
class Verdict:
    """The result of a check: status, cost, bound, and the first error, or ""."""

    status: str
    cost: int | None
    bound: int
    wrong: str = ""


def certified(
    problem: AssignmentProblem, found: Solution, solvers: bool = True
) -> tuple[Solution, dict[str, Any]]:
    """The solution with the status that its certificate supports, and the certificate.

    solvers: whether z3 and cvc5 may be used where nothing else proves the optimum.
    """
    proofs = list(found.proof) if isinstance(found.proof, list) else []
    written = [_proof(proof) for proof in proofs]
    for proof in written:
        if proof["kind"] == "chains" and found.cost is not None:
            # a bound above the cost is not needed
            proof["bound"] = min(proof["bound"], found.cost)
    low = min((w["bound"] for w in written), default=0)
    # where the search claims optimality without checkable evidence
    if solvers and found.cost is not None and low < found.cost <= found.bound:
        few = len(problem.tasks) <= SOLVER_TASKS
        ends_only = not (problem.cost.distance or problem.cost.energy)
        if few and ends_only and _none_below(problem, found.cost)[0]:
            written, low = [{"kind": "solvers", "bound": found.cost}], found.cost
    if found.cost is None:
        status, low = found.status, found.bound
    else:
        low = min(low, found.cost)
        status = "optimal" if shows_optimal(found.cost, low) else "feasible"
    body: dict[str, Any] = {
        "format": FORMAT,
        "problem": _written(problem),
        "claim": {"status": status, "cost": found.cost, "bound": low},
        "steps": [asdict(step) for step in found.steps],
        "proofs": written,
    }
    text = json.dumps(body, sort_keys=True)
    if len(text) > BYTES_MAX or any(max(w.get("sizes", ()), default=0) > STATES for w in written):
        less = [w if w["kind"] != "layers" else {"kind": "estimate", "bound": 0} for w in written]
        body["proofs"] = less
        checked = _bounds(problem, less)
        low = min(low, checked[0])
        optimal = found.cost is not None and shows_optimal(found.cost, low)
        status = "optimal" if optimal else found.status
        body["claim"] = {"status": status, "cost": found.cost, "bound": low}
        text = json.dumps(body, sort_keys=True)
    body["sha256"] = hashlib.sha256(text.encode()).hexdigest()  # as `_digest` computes it
    return replace(found, status=status, bound=low), body


def _none_below(problem: AssignmentProblem, cost: int) -> tuple[bool, str]:
    """Whether z3, and cvc5 if installed, find nothing cheaper; they are loaded only on demand."""
    from cratous.services.planning.assign_solvers import none_below

    return none_below(problem, cost)


def _written(problem: AssignmentProblem) -> dict[str, Any]:
    """The problem's fields; tables are tuples already and are not copied."""
    return {
        **vars(problem),
        "choices": [asdict(choice) for choice in problem.choices],
        "cost": asdict(problem.cost),
        "unable": sorted(problem.unable),
    }


def _proof(proof: Proof) -> dict[str, Any]:
    found: dict[str, Any] = {"kind": proof.kind, "bound": proof.bound}
    if proof.kind == "chains":
        found["nodes"] = proof.limit
    if proof.kind == "layers":
        small = [np.ascontiguousarray(o, np.int32).tobytes() for o in proof.origins]
        found["limit"] = proof.limit
        found["sizes"] = [len(o) for o in proof.origins]
        found["origins"] = base64.b64encode(zlib.compress(b"".join(small), 6)).decode("ascii")
    return found


def _digest(body: dict[str, Any]) -> str:
    rest = {key: value for key, value in body.items() if key != "sha256"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


def write(file: Path, certificate: dict[str, Any]) -> None:
    """Write a certificate atomically."""
    write_atomically(file, json.dumps(certificate, sort_keys=True) + "\n", "the certificate")


def read(file: Path) -> dict[str, Any]:
    """Read a certificate from a file; BadInput for an invalid one."""
    body = json_of(bytes_of(file, BYTES_MAX + 1_000, "a certificate"), str(file))
    if not isinstance(body, dict) or body.get("format") != FORMAT:
        raise BadInput("this is no certificate", where=str(file), expected=FORMAT)
    return body


def verify(body: dict[str, Any]) -> Verdict:
    """Check a certificate completely: digest, schedule by kernels and by its meaning, bounds, claim."""
    status, cost, bound = "", None, 0
    try:
        status, cost, bound = from_data(_Claim, body.get("claim"), "claim")
        problem, steps, proofs = _problem(body.get("problem")), *_evidence(body)
        if body.get("sha256") != _digest(body):
            return Verdict(status, cost, bound, "the digest is not that of the content")
        check(problem)
        if cost is not None:
            got = replayed(problem, steps)
            if got != cost:
                return Verdict(status, cost, bound, f"the schedule costs {got}, not {cost}")
            if text := _what_fails(problem, steps):
                return Verdict(status, cost, bound, f"z3 finds that it does not hold: {text}")
        low, wrong = _bounds(problem, proofs, cost)
    except BadInput as error:
        return Verdict(status, cost, bound, str(error))
    except (ValueError, OverflowError, zlib.error) as error:
        return Verdict(status, cost, bound, f"a proof is not readable: {error}")
    if wrong:
        return Verdict(status, cost, bound, wrong)
    return Verdict(status, cost, bound, _claims(status, cost, bound, low))


def _what_fails(problem: AssignmentProblem, steps: Sequence[Step]) -> str:
    """The first constraint, by its meaning, that the schedule violates, in words; "" if none."""
    if witnessed(problem, steps):
        return ""
    from cratous.services.planning.assign_solvers import schedule_holds

    return schedule_holds(problem, steps)[1]


class _Claim(NamedTuple):
    status: str
    cost: int | None
    bound: int


class _Unable(NamedTuple):
    unable: tuple[int, ...]


class _Proof(NamedTuple):
    """The fields of all kinds of proofs."""

    kind: str
    bound: int = 0
    limit: int = 0
    nodes: int = 0
    sizes: tuple[int, ...] = ()
    origins: str = ""


def _evidence(body: dict[str, Any]) -> tuple[list[Step], list[dict[str, Any]]]:
    """Steps and proofs; BadInput with the field of the wrong type."""
    found = []
    for name in ("steps", "proofs"):
        if not isinstance(body.get(name), list):
            raise BadInput("does not fit", item=name, expected="a list")
        found.append(body[name])
    steps = [from_data(Step, step, f"steps[{k}]") for k, step in enumerate(found[0])]
    proofs = [from_data(_Proof, proof, f"proofs[{k}]") for k, proof in enumerate(found[1])]
    return steps, [proof._asdict() for proof in proofs]


def _claims(status: str, cost: int | None, bound: int, low: int) -> str:
    """The part of the claim that does not follow from the proved bound, in words; "" if all does."""
    if not shows_optimal(bound, low):
        return f"the proofs show a bound of {low}, not {bound}"
    if status == "optimal" and (cost is None or not shows_optimal(cost, low)):
        return "it is said to be optimal, but the bound is below its cost"
    if status == "infeasible" and not shows_optimal(NONE, low):
        return "that nothing exists is not shown"
    if status not in ("optimal", "feasible", "infeasible", "unknown"):
        return f"there is no status {status!r}"
    return (
        "" if (cost is None) == (status in ("infeasible", "unknown")) else "cost and status clash"
    )


def _bounds(
    problem: AssignmentProblem, proofs: list[dict[str, Any]], cost: int | None = None
) -> tuple[int, str]:
    """(bound proved for all branches, error in one of the proofs)."""
    branches, all_of_them = parts(problem)
    if any(p["kind"] == "solvers" for p in proofs):
        if len(proofs) != 1 or cost is None:
            return 0, "solvers' evidence is for the whole problem"
        agreed, said = _none_below(problem, cost)
        return (cost, "") if agreed else (0, f"the solvers do not agree: {said}")
    if not proofs:
        return 0, ""
    if len(proofs) != len(branches) or not all_of_them:
        return 0, "there is not one proof for each branch"
    low: int = NONE
    for number, (branch, proof) in enumerate(zip(branches, proofs, strict=True)):
        shown, wrong = _shown(problem, branch, proof)
        if wrong:
            return 0, f"branch {number + 1}: {wrong}"
        low = min(low, shown)
    return low, ""


def _shown(problem: AssignmentProblem, branch: Part, proof: dict[str, Any]) -> tuple[int, str]:
    """(bound proved for one branch, error in its proof)."""
    instance = arrays(problem, branch)
    if proof["kind"] == "layers":
        return least_cost(instance, int(proof["limit"]), _Origins(proof))
    if proof["kind"] == "tables":
        return (by_sets(instance)[0], "") if is_sets(instance) else (0, "no tables here")
    if proof["kind"] == "estimate":
        return estimate(instance), ""
    if proof["kind"] == "chains":
        return _no_chain_below(problem, branch, int(proof["bound"]), int(proof["nodes"]))
    return 0, "no such kind of proof"


def _no_chain_below(
    problem: AssignmentProblem, branch: Part, bound: int, nodes: int
) -> tuple[int, str]:
    """Enumerate all chains again: none costs less than the bound."""
    instance = arrays(problem, branch)
    rules = settler(problem, branch, instance)
    if rules.ahead is None:
        return 0, "too many tasks for listing chains"
    # below the bound fewer chains exist than the search enumerated; twice as many means another problem
    most = 2 * min(nodes, CHAINS_MAX) + 1_000
    found = chains_below(instance, bound, rules.judge, most, ahead=rules.ahead)
    if found.moves is not None:
        return 0, f"chains of cost {found.cost} were found"
    if not found.complete or rules.unsure:
        return 0, "not all chains could be looked at"
    return bound, ""


class _Origins(Sequence[np.ndarray]):
    """The origins by layer: each layer is unpacked when the checker reaches it, in order."""

    def __init__(self, proof: dict[str, Any]) -> None:
        self._sizes = [int(size) for size in proof["sizes"]]
        if not all(0 <= size <= STATES for size in self._sizes):
            raise ValueError(f"a layer has more than {STATES} states, or fewer than none")
        self._left = base64.b64decode(proof["origins"], validate=True)
        self._unpacker, self._next = zlib.decompressobj(), 0

    def __len__(self) -> int:
        return len(self._sizes)

    def __getitem__(self, depth: Any) -> Any:
        if depth != self._next:
            raise IndexError(f"layer {depth} out of order")
        self._next += 1
        parts, wanted = [], 12 * self._sizes[depth]
        while wanted > 0:
            part = self._unpacker.decompress(self._left, wanted)
            self._left = self._unpacker.unconsumed_tail
            wanted -= len(part)
            parts.append(part)
            if not part:
                raise ValueError("the origins have a wrong length")
        return np.frombuffer(b"".join(parts), np.int32).reshape(-1, 3)


def _problem(data: Any) -> AssignmentProblem:
    """The problem of a certificate; BadInput with the field of the wrong type."""
    if not isinstance(data, dict):
        raise BadInput("does not fit", item="problem", expected="an object")
    tables = ("travel_ms", "distance_mm", "energy_mj")
    fields = {name: part for name, part in data.items() if name not in ("unable", *tables)}
    problem = from_data(AssignmentProblem, {**fields, "travel_ms": []}, "problem")
    unable = from_data(_Unable, {"unable": data.get("unable", [])}, "problem").unable
    travel, distance, energy = (rows_of(data.get(name, []), name) for name in tables)
    return replace(
        problem,
        unable=frozenset(unable),
        travel_ms=travel,
        distance_mm=distance,
        energy_mj=energy,
    )
