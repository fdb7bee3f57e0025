"""Cost per sample of the requirement monitor, by formula and horizon, on the trace of the reference.

On its own: `python bench/requirements_monitor.py`. In CPU time of one core, without reading the CSV. Where rtamt
0.4.10 is installed (in a separate environment, see requirements.txt) it judges the same trace in the same run; it
evaluates its whole buffer at each sample, so its cost grows with the horizon. Verdicts are compared with a search of
the whole trace before anything is timed. Without ../shared a generated trace of the same shape is used. The rows
`compiled` measure the loops over whole columns, used for complete traces, over repetitions of the same trace, a
million samples; their verdicts are compared with those sample by sample.
"""

from __future__ import annotations

import gzip
import math
import random
import time
import tracemalloc
from collections.abc import Iterable
from pathlib import Path

from table import Rows, alone

from cratous.services.requirements import c2po
from cratous.services.requirements.evaluation import Evaluation
from cratous.services.requirements.finished_trace import Columns, Whole
from cratous.services.requirements.formula import Formula
from cratous.services.requirements.outcome import Outcome
from cratous.services.requirements.specification import Requirement

TRACE = Path(__file__).resolve().parents[2] / "shared/vectors/monitor/open-trace-100.csv.gz"
HEAD = """INPUT
  request, response, manoeuvre, heartbeat, keepin_margin_m, keepout_margin_m, taumod_s, dz_m: float;
FTSPEC
"""
BAR_US, BAR_COMPILED_US = 10.0, 1.0
"""The most that a sample may cost in Python and compiled [us], for any horizon."""
MANY = 1_000_000
Row = dict[str, float | None]


def formulas() -> dict[str, tuple[str, str]]:
    """By name, the formula in C2PO and in rtamt."""
    found = {}
    for h in (10, 60, 100, 1000):
        found[f"response within {h}"] = (
            f"(request >= 0.5) -> F[0,{h}] (response >= 0.5)",
            f"(request >= 0.5) implies (eventually[0:{h}](response >= 0.5))",
        )
    found["well clear, manoeuvre within 30"] = (
        "((taumod_s <= 35.0) && (dz_m <= 137.0)) -> F[0,30] (manoeuvre >= 0.5)",
        "((taumod_s <= 35.0) and (dz_m <= 137.0)) implies (eventually[0:30](manoeuvre >= 0.5))",
    )
    found["both fence margins"] = (
        "(keepin_margin_m >= 0.0) && (keepout_margin_m >= 0.0)",
        "(keepin_margin_m >= 0.0) and (keepout_margin_m >= 0.0)",
    )
    found["heartbeat within 20"] = (
        "O[0,20] (heartbeat >= 0.5)",
        "once[0:20](heartbeat >= 0.5)",
    )
    return found


def rows() -> list[Row]:
    """The samples of the reference's trace, or of a generated one."""
    if TRACE.is_file():
        with gzip.open(TRACE, "rt") as file:
            names = file.readline().strip().split(",")
            return [dict(zip(names, map(float, line.split(",")), strict=True)) for line in file]
    rng = random.Random(100)
    names = ("request", "response", "manoeuvre", "heartbeat")
    margins = ("keepin_margin_m", "keepout_margin_m", "taumod_s", "dz_m")
    return [
        {n: float(rng.random() < 0.05) for n in names} | {n: rng.uniform(-50, 500) for n in margins}
        for _ in range(20_000)
    ]


def formula_of(text: str) -> Formula:
    (one,) = c2po.read(f"{HEAD}  it: {text};\n", "bench").requirements
    assert not isinstance(one.formula, Exception)
    return one.formula


def cost_us(formula: Formula, trace: Iterable[Row]) -> float:
    """CPU time per sample [us], the least of five runs."""
    trace, best = list(trace), math.inf
    for _ in range(5):
        evaluation = Evaluation(formula)
        begun = time.process_time()
        for at, row in enumerate(trace):
            evaluation.sample(at, row)
        best = min(best, time.process_time() - begun)
    return best / len(trace) * 1e6


def columns(trace: list[Row], most: int = MANY) -> Columns:
    """A repeated trace, as whole columns."""
    found = Columns(trace[0])
    for k in range(most):
        found.add(k, trace[k % len(trace)])
    return found


def compiled_us(formula: Formula, whole: Whole) -> float:
    """CPU time per sample when the whole trace is available [us], the least of five runs."""
    best = math.inf
    for _ in range(5):
        begun = time.process_time()
        whole.fill(Outcome(Requirement("it", "", formula), 0), formula)
        best = min(best, time.process_time() - begun)
    return best / whole.count * 1e6


def same(formula: Formula, trace: list[Row]) -> None:
    """Compare the counts of verdicts over whole columns with those sample by sample."""
    one_by_one, at_once = (Outcome(Requirement("it", "", formula), 0) for _ in range(2))
    evaluation = Evaluation(formula, blames=True)
    for at, row in enumerate(trace):
        for sample, verdict in evaluation.sample(at, row):
            one_by_one.add(sample, verdict, at)
    one_by_one.blamed = evaluation.blamed
    Whole(columns(trace, len(trace))).fill(at_once, formula)
    assert one_by_one == at_once


def rtamt_us(text: str, trace: list[Row]) -> float | None:
    """The same for rtamt's online monitor in Python; None where it is not installed."""
    try:
        import rtamt
    except ImportError:
        return None
    best = math.inf
    for _ in range(3):
        spec = rtamt.StlDiscreteTimeOnlineSpecification()
        names = [name for name in trace[0] if name in text]
        for name in names:
            spec.declare_var(name, "float")
        spec.spec = text
        spec.parse()
        spec.pastify()
        samples = [[(name, row[name]) for name in names] for row in trace]
        begun = time.process_time()
        for at, sample in enumerate(samples):
            spec.update(at, sample)
        best = min(best, time.process_time() - begun)
    return best / len(trace) * 1e6


def checked(trace: list[Row]) -> None:
    """Compare the verdicts of one formula with a search of the whole trace."""
    evaluation, got = Evaluation(formula_of(formulas()["response within 60"][0])), {}
    for at, row in enumerate(trace):
        got |= dict(evaluation.sample(at, row))
    for at in range(len(trace) - 61):
        wanted = trace[at]["request"] < 0.5 or any(
            later["response"] >= 0.5 for later in trace[at : at + 61]
        )
        assert got[at] == (2 if wanted else 0), at


def memory_kb(formula: Formula, samples: int) -> float:
    """Peak memory of the evaluation over this many samples [kB]."""
    evaluation = Evaluation(formula)
    row: Row = {"request": 1.0, "response": 0.0}
    tracemalloc.start()
    for at in range(samples):
        evaluation.sample(at, row)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return most / 1e3


def measured() -> Rows:
    """The rows of the table."""
    trace = rows()
    checked(trace)
    table: Rows = []
    for name, (ours, theirs) in formulas().items():
        us = cost_us(formula_of(ours), trace)
        peer = rtamt_us(theirs, trace)
        what = "bar" if peer is None else "rtamt 0.4.10, Python"
        table.append((f"requirement, a sample: {name}", us * 1e3, what, (peer or BAR_US) * 1e3))
    whole = Whole(columns(trace))
    for name, (ours, _) in formulas().items():
        same(formula_of(ours), trace)
        us, bar = compiled_us(formula_of(ours), whole), BAR_COMPILED_US
        row = (
            f"requirement, a sample, compiled: {name}",
            us * 1e3,
            "bar: 1 microsecond",
            bar * 1e3,
        )
        table.append(row)
    return table


if __name__ == "__main__":
    alone(measured)
    formula = formula_of(formulas()["response within 1000"][0])
    few, many = (memory_kb(formula, n) for n in (20_000, 200_000))
    print(f"memory: {few:.0f} kB over 20,000 samples, {many:.0f} kB over 200,000")
