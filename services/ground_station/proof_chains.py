"""From a verdict of a report to its proofs: kernels, theorems, answers of both solvers, mutants.

Chains, theorems and z3's answers are those of the report. cvc5's answers on the same theorems, and
the mutants, come from the product's current records; nothing is proved or judged here.
"""

from __future__ import annotations

import json
from collections import Counter
from functools import cache
from typing import Any

from cratous.core import ledger
from cratous.core.kernel.sources import ROOT
from cratous.services.certify.trace import traced
from cratous.spec.errors import BadInput

Data = dict[str, Any]
OF_CHAIN = (
    "kernel", "by", "calls", "within", "status", "theorems", "definition", "file", "restates",
)  # fmt: skip
OF_THEOREM = (
    "sentence", "statement", "status", "obligations", "premises", "assumptions", "lemmas",
)  # fmt: skip


def proofs_of(report: Data, where: str) -> Data:
    """The chains of each constraint of a report, in order, with everything they refer to.

    rows: chains, missing links, and whether the row decides nothing; names: short names of kernels;
    theorems: those of the chains and their lemmas, each with the number of obligations by cvc5's
    answer; mutants: of a kernel, by result; solvers: the first and the second; same_ledger: whether
    the ledger is still that of the report. Raises BadInput if the report lacks something.
    """
    try:
        return _proofs(report)
    except (AttributeError, LookupError, TypeError, ValueError) as error:
        raise BadInput(
            "a report lacks what its proofs are told by", where=where, item="proofs",
            expected="a report of this version", got=f"{type(error).__name__}: {error}"[:120],
        ) from None  # fmt: skip


def _proofs(report: Data) -> Data:
    found, proofs = traced(report), report["proofs"]
    rows = [
        {
            "undecided": row["undecided"],
            "missing": row["missing"],
            "chains": [{key: chain[key] for key in OF_CHAIN} for chain in row["chains"]],
        }
        for row in found["rows"]
    ]
    chains = [chain for row in rows for chain in row["chains"]]
    second = _second()
    return {
        "rows": rows,
        "names": found["names"],
        "theorems": {
            name: {
                **{key: proofs["theorems"][name].get(key) for key in OF_THEOREM},
                "cvc5": dict(second["theorems"].get(name, {})),
            }
            for name in _reached([t for chain in chains for t in chain["theorems"]], proofs)
        },
        "mutants": _mutants({chain["kernel"] for chain in chains}),
        "solvers": [str(proofs["solver"]), second["solver"]],
        "line": str(proofs["line"]),
        "same_ledger": proofs.get("seal") == ledger.read()["seal"],
    }


def _reached(names: list[str], proofs: Data) -> list[str]:
    """These theorems and the lemmas they depend on, as far as the report has them."""
    todo, found = list(names), set[str]()
    while todo:
        name = todo.pop()
        if name not in found and name in proofs["theorems"]:
            found.add(name)
            todo += proofs["theorems"][name].get("lemmas", [])
    return sorted(found)


def _record(name: str) -> Data:
    """A record beside the proofs; empty if the product has none."""
    path = ROOT / "proofs" / name
    return dict(json.loads(path.read_text(encoding="utf-8"))) if path.is_file() else {}


@cache
def _second() -> Data:
    """The second solver, and for each theorem the number of obligations by its answer."""
    record, theorems = _record("recheck.json"), dict[str, Counter[str]]()
    for one in record.get("obligations", {}).values():
        for of in one["of"]:
            theorems.setdefault(of.partition(" ")[0], Counter())[one["cvc5"]] += 1
    return {"solver": record.get("solver", ""), "theorems": theorems}


def _mutants(kernels: set[str]) -> Data:
    targets = _record("mutation/mutation.json").get("targets", {})
    return {name: targets[name]["counts"] for name in sorted(kernels) if name in targets}
