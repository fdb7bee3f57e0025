"""Results of the prover for other tools: JSON, JUnit XML for CI, SARIF for code review.

All three are views of the same theorems and problems; nothing is decided here.
"""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from cratous.core.files.whole_file import write_atomically
from cratous.core.kernel import REGISTRY
from cratous.core.kernel.sources import place, position
from cratous.core.ledger.package_home import PRODUCT, Home
from cratous.proofs.engine.prover import Outcome, Theorem, theorem_files


def theorem_data(theorem: Theorem, second: str | None = None) -> dict[str, Any]:
    """A theorem as plain data; second: what the second solver said, if it was asked."""
    outcomes = [
        {
            "kind": outcome.obligation.kind,
            "text": outcome.obligation.text,
            "status": outcome.status,
            "key": outcome.key,
            "rlimit": outcome.rlimit,
            "seconds": outcome.seconds,
            "logic": outcome.logic,
            "counterexample": dict(outcome.counterexample),
            "story": list(outcome.story),
        }
        for outcome in theorem.outcomes
    ]
    data: dict[str, Any] = {
        "name": theorem.name,
        "sentence": theorem.sentence,
        "proved": theorem.proved,
        "kernels": sorted(theorem.kernels),
        "lemmas": sorted(set(theorem.lemmas)),
        "premises": theorem.premises,
        "ran": None if theorem.ran is None else asdict(theorem.ran),
        "assumptions": [list(a) for a in theorem.assumptions],
        "rlimit": theorem.rlimit,
        "seconds": round(theorem.seconds, 3),
        "obligations": outcomes,
    }
    if second is not None:
        data["second_solver"] = second
    return data


def failure_text(theorem: Theorem) -> str:
    """Why a theorem is not proved, for people; empty if it is."""
    lines = []
    if theorem.premises != "satisfiable":
        lines.append(f"its premises are {theorem.premises}: nothing follows from them")
    lines += [f"a question about its premises or paths was {why}" for why in theorem.ended]
    for outcome in theorem.outcomes:
        if outcome.status != "proved":
            lines.append(f"{outcome.status}: {outcome.obligation.kind}: {outcome.obligation.text}")
            if outcome.status == "unknown":
                why = outcome.ended or "the solver gave no answer within its budget"
                lines.append(f"  {why}, which is no proof")
            lines += [f"  {line}" for line in example(outcome)]
    lines += theorem.ran.differences if theorem.ran is not None else ()
    return "\n".join(lines)


def example(outcome: Outcome) -> list[str]:
    """The counterexample in the user's terms, or else the solver's values."""
    if outcome.story:
        return list(outcome.story)
    return [f"{name} = {value}" for name, value in outcome.counterexample if "!" not in name]


def junit(theorems: Iterable[Theorem], problems: Iterable[str]) -> str:
    """JUnit XML: one test case for each theorem and each problem."""
    shown, found = list(theorems), list(problems)
    failures = sum(not theorem.proved for theorem in shown) + len(found)
    suite = ET.Element(
        "testsuite",
        name="cratous prove",
        tests=str(len(shown) + len(found)),
        failures=str(failures),
        errors="0",
        time=f"{sum(theorem.seconds for theorem in shown):.3f}",
    )
    for theorem in shown:
        case = ET.SubElement(
            suite,
            "testcase",
            classname="theorems",
            name=theorem.name,
            time=f"{theorem.seconds:.3f}",
        )
        if not theorem.proved:
            failure = ET.SubElement(case, "failure", message=theorem.sentence)
            failure.text = failure_text(theorem)
    for problem in found:
        case = ET.SubElement(suite, "testcase", classname="problems", name=problem)
        ET.SubElement(case, "failure", message=problem)
    ET.indent(suite)
    return (
        '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(suite, encoding="unicode") + "\n"
    )


def _location(where: str) -> dict[str, Any]:
    file, _, line = where.rpartition(":") if where.rpartition(":")[2].isdigit() else (where, "", "")
    physical: dict[str, Any] = {"artifactLocation": {"uri": file}}
    if line:
        physical["region"] = {"startLine": int(line)}
    return {"physicalLocation": physical}


def sarif(theorems: Iterable[Theorem], problems: Iterable[str], home: Home = PRODUCT) -> str:
    """SARIF 2.1.0: one result for each theorem that is not proved and each problem.

    A result points to the theorem's file and to the kernels that it is about.
    """
    files = theorem_files(home.theorems)
    results: list[dict[str, Any]] = []
    for theorem in theorems:
        if theorem.proved:
            continue
        kernels = [REGISTRY[k] for k in sorted(theorem.kernels) if k in REGISTRY]
        results.append(
            {
                "ruleId": "theorem-not-proved",
                "level": "error",
                "message": {"text": f"{theorem.name}: {failure_text(theorem)}"},
                "locations": [_location(place(files[theorem.name]))],
                "relatedLocations": [_location(position(k.function)) for k in kernels],
            }
        )
    for problem in problems:
        where = problem.split(": ")[0]
        results.append(
            {
                "ruleId": "kernel-not-bound",
                "level": "error",
                "message": {"text": problem},
                "locations": [_location(where)] if "/" in where else [],
            }
        )
    rules = [
        {"id": "theorem-not-proved", "shortDescription": {"text": "A theorem is not proved."}},
        {"id": "kernel-not-bound", "shortDescription": {"text": "No proof vouches for a kernel."}},
    ]
    driver = {"name": "cratous prove", "rules": rules}
    data = {
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [{"tool": {"driver": driver}, "results": results}],
    }
    return json.dumps(data, indent=1) + "\n"


def write(path: Path, text: str) -> None:
    """Write a result file; creates its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, text)
