"""Traces each row of a report to the kernels that decided it, their theorems and their definitions.

The chains are read from the report alone; whether their definitions exist is checked in the
installed product, of which nothing is imported for that. Missing links are stated in words; a row
without a kernel has no chain.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from cratous.core.kernel.names import short
from cratous.core.ledger import PRODUCT
from cratous.core.ledger.module_trees import Tree
from cratous.services.certify.proofs import NOT_RECORDED
from cratous.spec.mission.guarantees import Outcome

Data = dict[str, Any]


def chains(report: Data) -> list[Data]:
    """For each constraint row of the report, in order, the chains from it to definitions."""
    return [
        {
            **{key: row[key] for key in ("requirement", "source", "item", "verdict")},
            "chains": [
                chain for name in row["kernels"] for chain in _chains(name, report["proofs"])
            ],
        }
        for row in report["constraints"]
    ]


def _chains(name: str, proofs: Data, by: str = "") -> Iterator[Data]:
    """The chain of one kernel; for a driver, those of the kernels that decide in it and were
    called.

    by: the driver that the row names.
    """
    one = proofs["kernels"].get(name)
    if one is not None and one["kind"] == "driver":
        inside = [part for part in one["checked_by"] if part in proofs["kernels"]]
        for part in inside:
            yield from _chains(part, proofs, name)
        if not inside:
            yield _link(name, None, proofs, by, "no kernel that decides in it was called")
        return
    yield _link(name, one, proofs, by)


def _link(name: str, one: Data | None, proofs: Data, by: str, lacks: str = "") -> Data:
    """The chain from a kernel to its definition; missing: missing links, in words."""
    found = one or {}
    against = list(found.get("against", []))
    missing = [lacks] if lacks else []
    if one is None and not lacks:
        recorded = proofs["calls"] != NOT_RECORDED
        missing.append("it was not called in this run" if recorded else "calls were not recorded")
    if one is not None:
        missing += _unproved(one, against, proofs["theorems"])
    return {
        "kernel": name,
        "by": by,
        "calls": found.get("count", 0),
        "within": list(found.get("within", [])),
        "status": found.get("status", ""),
        "step_of": found.get("step_of", ""),
        "theorems": against,
        "definition": found.get("definition", ""),
        "restates": found.get("restates", ""),
        "missing": missing,
    }


def _unproved(one: Data, against: list[str], theorems: Data) -> list[str]:
    """What a called kernel lacks for a proof, in words."""
    missing = []
    if "against" not in one:
        missing.append("its report was made before theorems against definitions were told apart")
    elif not against:
        missing.append("no theorem holds it against a definition")
    missing += [
        f"{name} is not among the proved theorems"
        for name in against
        if theorems.get(name, {}).get("status") != "proved"
    ]
    if not one["definition"]:
        missing.append("it names no definition")
    return missing


def traced(report: Data) -> Data:
    """The chains of a report, with the file of each definition, and the missing links row by row.

    An unknown row that names no kernel decides nothing, so nothing is missing in it.
    """
    rows = chains(report)
    definition = cache(definition_of)  # many rows share a kernel
    unproved = {problem["kernel"] for problem in report["proofs"]["problems"]}
    names = short([*report["proofs"]["kernels"], *(c["kernel"] for r in rows for c in r["chains"])])
    for row in rows:
        for chain in row["chains"]:
            chain["file"], absent = definition(chain["kernel"].split(".")[0], chain["definition"])
            chain["missing"] += [absent] if absent else []
            if {chain["kernel"], names[chain["kernel"]]} & unproved:
                chain["missing"].append("the ledger did not vouch for it in this run")
        row["undecided"] = not row["chains"] and row["verdict"] == Outcome.UNKNOWN
        row["missing"] = [
            f"{names[chain['kernel']]}: {text}"
            for chain in row["chains"]
            for text in chain["missing"]
        ]
        if not row["chains"] and not row["undecided"]:
            row["missing"].append("no kernel decided it: the messages say it")
    return {
        "rows": rows,
        "names": names,
        "missing": sum(bool(row["missing"]) for row in rows),
        "undecided": sum(row["undecided"] for row in rows),
    }


def definition_of(package: str, definition: str) -> tuple[str, str]:
    """(file of a definition, what is wrong with it)."""
    if not definition:
        return "", ""
    file = _file(package, definition)
    return (file, "") if file else ("", f"its definition {definition} does not exist")


def _file(package: str, definition: str) -> str:
    """The file of the module that contains a definition, relative to its package's parent; empty if
    there is none.

    The names come from a report, which is untrusted: no module is imported because of them.
    """
    *module, name = definition.split(".")
    root = _root(package)
    if root is None or not module or not all(part.isidentifier() for part in (*module, name)):
        return ""
    tree = Tree({PRODUCT.name: PRODUCT.root, package: root}, {})
    whole = ".".join((package, "spec", *module))
    try:
        found = [one for one in tree.meant(whole, (name,)) if isinstance(one, tuple)]
        defined = any(tree.unit(one).kind in ("function", "class") for one in found)
    except (OSError, SyntaxError, ValueError):
        return ""
    file = tree.file(whole)
    return file.relative_to(root).as_posix() if file is not None and defined else ""


def _root(package: str) -> Path | None:
    """The folder of a package, found without importing it; None if there is none."""
    if package == PRODUCT.name:
        return PRODUCT.root
    if not package.isidentifier():
        return None
    try:
        found = find_spec(package)
    except (ImportError, ValueError):
        return None
    places = [] if found is None else list(found.submodule_search_locations or ())
    return Path(places[0]).resolve() if places else None


def lines(found: Data) -> Iterator[str]:
    """The chains as text."""
    names = found["names"]
    for row in found["rows"]:
        yield f"{row['requirement']} {row['source']}: {row['item']}: {row['verdict']}"
        for chain in row["chains"]:
            calls = f"{chain['calls']} calls" if chain["calls"] else "compiled into what was called"
            by = f" (in {names.get(chain['by'], chain['by'])})" if chain["by"] else ""
            yield f"  {names[chain['kernel']]}{by}, {calls}: {chain['status'] or 'not in the report'}"
            yield from (f"    theorem {theorem}" for theorem in chain["theorems"])
            if chain["definition"]:
                again = f", restated: {chain['restates']}" if chain["restates"] else ""
                yield f"    definition {chain['definition']} in {chain['file'] or 'no file'}{again}"
        if row["undecided"]:
            yield "  undecided: nothing was observed that a kernel could judge"
        yield from (f"  MISSING {text}" for text in row["missing"])
    kept = len(found["rows"]) - found["missing"] - found["undecided"]
    yield (
        f"{kept} of {len(found['rows'])} rows trace to a definition, {found['undecided']} undecided, "
        f"{found['missing']} with something missing"
    )
