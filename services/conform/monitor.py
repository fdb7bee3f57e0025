"""Verdicts of R2U2 compared with ours: `NAME.r2u2-verdicts.json.gz`, and suites of R2U2 with their
oracles.

For `NAME.r2u2-verdicts.json.gz` the trace is `NAME.csv.gz` and the requirements are `formulas.c2po`
beside it; a trace given together with its verdicts is judged by them. The files of a suite
`suites/NAME.json` are in `../c2po`, `../trace` and `../oracle`. A case is one requirement over one
trace: every verdict of R2U2 on a sample of the trace must be ours too. Additional verdicts of ours
are no difference, since ours come at the earliest sample. R2U2 treats numbers as equal that differ
by at most 1e-5: a difference that vanishes when they are made equal is a knife edge.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from cratous.services.conform import Result, edge, failed, not_covered, passed
from cratous.services.requirements import c2po
from cratous.services.requirements.csv_trace import Sample, TraceOfChanges, samples
from cratous.services.requirements.evaluation import Evaluation
from cratous.services.requirements.formula import Formula, Reaches, parts, signals
from cratous.services.requirements.specification import NotRead, Specification
from cratous.spec.errors import BadInput
from cratous.spec.files.limits import CONFIG_BYTES, integer_of, json_of
from cratous.spec.files.text_file import lines_of, text_of

VERDICTS = ".r2u2-verdicts.json.gz"
TRACE = ".csv.gz"
WORDS = {"F": 0, "T": 2}
LETTERS = "F?T"
OPEN = "?"
"""R2U2 has no verdict on the sample before the trace ends."""
MOST_SAMPLES = 1_000_000
TOLERANCE = 1e-5
Trace = tuple[Sample, ...]


def cases(file: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """(number, case) for each requirement of a file of verdicts or of a suite."""
    if file.name.endswith(VERDICTS):
        name = file.name.removesuffix(VERDICTS)
        beside = (file.with_name("formulas.c2po"), file.with_name(f"{name}{TRACE}"))
        found = _object(json_of("".join(line for _, line in lines_of(file)), str(file)), str(file))
        rows = [(name, requirement, told) for requirement, told in found.items()]
    elif file.suffix == ".json":
        yield from _suite(file)
        return
    elif file.name.endswith(TRACE) and _with_verdicts(file).is_file():
        yield 1, {"id": file.name.removesuffix(TRACE), "trace": True}
        return
    else:
        expected = f"NAME{VERDICTS} or suites/NAME.json"
        raise BadInput("this is no file of verdicts", where=str(file), expected=expected)
    for number, (name, requirement, told) in enumerate(rows, 1):
        if not isinstance(told, str) or not set(told) <= {*WORDS, OPEN}:
            raise BadInput("verdicts are T, F or ?", where=str(file), item=requirement)
        verdicts = {time: WORDS[letter] for time, letter in enumerate(told) if letter != OPEN}
        yield number, _case(f"{name} {requirement}", requirement, beside, verdicts)


def _with_verdicts(trace: Path) -> Path:
    """The verdict file of a trace."""
    return trace.with_name(trace.name.removesuffix(TRACE) + VERDICTS)


def _object(value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise BadInput("this is no JSON object", where=where, got=type(value).__name__)
    return value


def _case(
    name: str, requirement: str, beside: tuple[Path, Path], verdicts: dict[int, int]
) -> dict[str, Any]:
    return {"id": name, "requirement": requirement, "files": beside, "verdicts": verdicts}


def _suite(file: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """The cases of a suite, or of the suites that it names, which are beside it."""
    suite = _object(json_of(text_of(file, CONFIG_BYTES), str(file)), str(file))
    if "tests" in suite or "suites" not in suite:
        yield from enumerate(_cases(file, suite), 1)
        return
    names = suite["suites"]
    plain = isinstance(names, list) and all(isinstance(n, str) and Path(n).name == n for n in names)
    if not plain:
        expected = "a list of names"
        raise BadInput("suites have names", where=str(file), item="suites", expected=expected)
    number = 0
    for name in names:
        one = file.with_name(f"{name}.json")
        for case in _cases(one, _object(json_of(text_of(one, CONFIG_BYTES), str(one)), str(one))):
            number += 1
            yield number, case


def _cases(file: Path, suite: dict[str, Any]) -> Iterator[dict[str, Any]]:
    tests = suite.get("tests")
    if not isinstance(tests, list):
        raise BadInput("a suite has tests", where=str(file), item="tests", expected="a list")
    for at, given in enumerate(tests):
        where = f"{file}, tests[{at}]"
        test = _object(given, where)
        names = [test.get(key) for key in ("mltl", "trace", "oracle")]
        if not all(isinstance(name, str) and Path(name).name == name for name in names):
            raise BadInput("a test names its files", where=where, expected="mltl, trace, oracle")
        home = file.parent.parent
        spec, trace, oracle = (
            home / folder / str(name)
            for folder, name in zip(("c2po", "trace", "oracle"), names, strict=True)
        )
        told = _oracle(oracle)
        for index, requirement in enumerate(_specification(spec).requirements):
            name = f"{test.get('name', at)}:{requirement.name}"
            yield _case(name, str(index), (spec, trace), told.get(str(index), {}))


def _oracle(file: Path) -> dict[str, dict[int, int]]:
    """For each requirement the verdicts by sample; a line `id:t,V` applies to all samples up to t."""
    told: dict[str, dict[int, int]] = {}
    for number, line in lines_of(file):
        text = line.strip()
        if not text or text.startswith("Contract "):
            continue  # of contracts, which are not supported
        name, colon, rest = text.partition(":")
        time, comma, word = rest.partition(",")
        last = integer_of(time, 0, MOST_SAMPLES)
        if not (colon and comma and last is not None and word in WORDS):
            expected = "id:time,T or id:time,F"
            raise BadInput("no verdict", where=f"{file}:{number}", expected=expected, got=text[:40])
        mine = told.setdefault(name, {})
        for sample in range(len(mine), last + 1):
            mine[sample] = WORDS[word]
    return told


@lru_cache(4)
def _specification(file: Path) -> Specification:
    return c2po.read(text_of(file, CONFIG_BYTES), file.name)


@lru_cache(2)
def _trace(file: Path) -> Trace | None:
    """The samples of a CSV file; None for a trace of changes."""
    try:
        return tuple(row for _, row in samples(file))
    except TraceOfChanges:
        return None


def judge(case: dict[str, Any]) -> Result:
    """Compare our verdicts with R2U2's, for one requirement over one trace."""
    if case.get("trace"):
        return not_covered(case["id"], f"a trace: it is judged with its verdicts, NAME{VERDICTS}")
    spec_file, trace_file = case["files"]
    spec = _specification(spec_file)
    found = [
        one
        for index, one in enumerate(spec.requirements)
        if case["requirement"] in (str(index), one.name)
    ]
    if len(found) != 1:
        raise BadInput(
            "there is no such requirement", where=str(spec_file), got=str(case["requirement"])
        )
    formula = found[0].formula
    if isinstance(formula, NotRead):
        return not_covered(case["id"], "outside of the part of C2PO that is read")
    return _compare(case, formula, spec.types, trace_file)


def _compare(
    case: dict[str, Any], formula: Formula, types: dict[str, str], trace_file: Path
) -> Result:
    trace = _trace(trace_file)
    if trace is None:
        return not_covered(case["id"], "a trace of changes")
    for name in signals(formula):
        wrong = [row.get(name) for row in trace if row.get(name) not in (0.0, 1.0)]
        if any(value is None for value in wrong) or (types[name] == "bool" and wrong):
            expected = f"a {types[name]} in every sample"
            raise BadInput("a signal", where=str(trace_file), item=name, expected=expected)
    told = {time: v for time, v in case["verdicts"].items() if time < len(trace)}
    if not told:
        return not_covered(case["id"], "no verdict of R2U2")
    ours = _verdicts(formula, trace)
    differ = [time for time, verdict in told.items() if ours.get(time) != verdict]
    if not differ:
        return passed(case["id"], len(told))
    time = differ[0]
    mine = LETTERS[ours[time]] if time in ours else "none yet"
    text = f"sample {time}: expected {LETTERS[told[time]]}, got {mine}; {len(differ)} such samples"
    near = _verdicts(formula, _equalised(formula, trace))
    if all(near.get(time) == verdict for time, verdict in told.items()):
        return edge(case["id"], "numbers within R2U2's tolerance", text, len(told))
    return failed(case["id"], "another verdict", text, len(told))


def _verdicts(formula: Formula, trace: Trace) -> dict[int, int]:
    """The verdict of each decided sample."""
    evaluation = Evaluation(formula)
    found: dict[int, int] = {}
    for time, row in enumerate(trace):
        found.update(evaluation.sample(time, row))
    return found


def _equalised(formula: Formula, trace: Trace) -> Trace:
    """The trace with signals set equal to their comparands where they differ by at most the tolerance."""
    compared = {part for part in parts(formula) if isinstance(part, Reaches)}
    rows = []
    for row in trace:
        near = dict(row)
        for one in sorted(compared, key=str):
            left, right = (near[s] if isinstance(s, str) else s for s in (one.left, one.right))
            if left is None or right is None:
                continue
            name, value = (one.left, right) if isinstance(one.left, str) else (one.right, left)
            if isinstance(name, str) and abs(left - right) <= TOLERANCE:
                near[name] = value
        rows.append(near)
    return tuple(rows)
