"""Mutation: every verdict is reached for the reason that its name says."""

from __future__ import annotations

import json
from dataclasses import asdict
from fractions import Fraction
from pathlib import Path

import pytest
import z3

from cratous.core import gate as gate_module
from cratous.core import ledger as gate
from cratous.core.kernel import REGISTRY
from cratous.proofs import mutate, mutation_judge, prover
from cratous.proofs.asking import ask
from cratous.proofs.claim import Claim
from cratous.proofs.lift import REPLACED
from cratous.proofs.mutation_inputs import compare, inputs, run
from cratous.proofs.mutation_operators import mutants
from cratous.proofs.mutation_report import MutationReport, PremiseResult, Result, document

gate.load_all()
FOLDER = prover.FOLDER


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    """No result of another run is trusted here."""
    monkeypatch.setenv("CRATOUS_CACHE", str(tmp_path))


def diffs(name):
    return {m.diff for m in mutants(REGISTRY[name].function)}


# -- the mutants ---------------------------------------------------------------------------------
def test_each_kind_of_fault_is_made():
    made = diffs("vertical_violation")
    wanted = {
        "- if abs(sz) <= zthr_m: + if abs(sz) < zthr_m:",
        "- if abs(sz) <= zthr_m: + if abs(sz) > zthr_m:",
        "- if abs(sz) <= zthr_m: + if sz <= zthr_m:",
        "- if abs(sz) <= zthr_m: + if abs(vz) <= zthr_m:",
        "- if sz * vz >= 0: + if sz * vz > 0:",
        "- if sz * vz >= 0: + if sz + vz >= 0:",
        "- if sz * vz >= 0: + if sz * vz >= 1:",
        "- if sz * vz >= 0: + if -(sz * vz) >= 0:",
        "- if sz * vz >= 0: return False",
        "- return abs(sz) <= tcoa_s * abs(vz) + return abs(sz) <= tcoa_s * vz",
    }
    assert wanted <= made
    assert "- return max(best, value) + return min(best, value)" in diffs("later")
    assert "- return mask & bit != 0 + return mask | bit != 0" in diffs("eligible")
    kept = diffs("runs_forward")
    assert "- return start >= 0 and end >= start + return start >= 0 or end >= start" in kept
    assert "- return start >= 0 and end >= start + return end >= start" in kept
    turned = "return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)"
    fields = turned.replace("(c.y - a.y)", "(c.x - a.y)")
    assert f"- {turned} + {fields}" in diffs("orient")
    assert any(
        "location_step" not in d and "on_segment(a, p, b)" in d for d in diffs("location_step")
    )


def test_mutants_are_distinct_and_in_a_fixed_order():
    for entry in REGISTRY.values():
        if entry.kind == "kernel" and entry.name < "h":
            made = [(m.line, m.operator, m.diff) for m in mutants(entry.function)]
            assert made == [(m.line, m.operator, m.diff) for m in mutants(entry.function)]
            assert len(set(made)) == len(made)
            assert all(diff.startswith("- ") and "\n" not in diff for _, _, diff in made)


def test_the_line_of_a_mutant_is_that_of_the_file():
    function = REGISTRY["gives_way"].function
    lines = Path(gate_module.__file__).read_text(encoding="utf-8").splitlines()
    (mutant,) = [m for m in mutants(function) if m.diff.endswith("+ return own_id >= intruder_id")]
    assert lines[mutant.line - 1].strip() == "return own_id > intruder_id"


def test_a_mutant_differs_from_its_original_on_a_boundary():
    function = REGISTRY["vertical_violation"].function
    rows = inputs(function, frozenset(), 2000)
    assert rows == inputs(function, frozenset(), 2000)
    results = [run(function, row) for row in rows]
    assert compare(function, rows, results).inputs == ()
    wanted = "- if abs(sz) <= zthr_m: + if abs(sz) < zthr_m:"
    (strict,) = [m for m in mutants(function) if m.diff == wanted]
    found = compare(strict.function, rows, results).inputs
    assert found
    assert all(abs(sz) == zthr for sz, _, zthr, _ in found)


def test_what_cannot_be_run_is_stillborn():
    def wrong(a, b):
        return a.missing

    assert compare(wrong, [(1, 2)], [3]).stillborn.startswith("AttributeError")


# -- the verdicts ----------------------------------------------------------------------------------
def by_diff(report, end):
    (result,) = [r for r in report.results if r.diff.endswith(end)]
    return result


def test_faults_are_killed_by_the_theorem_that_they_break():
    report = mutate.run(
        ["vertical_violation"], theorems=["well_clear_vertical_violation_is_its_definition"]
    )
    kernel = [r for r in report.results if r.target == "core.well_clear.vertical_violation"]
    assert {r.verdict for r in kernel} <= {"killed", "equivalent"}
    assert {r.by for r in kernel if r.verdict == "killed"} == {
        "well_clear_vertical_violation_is_its_definition"
    }
    assert all(r.note for r in kernel if r.verdict == "equivalent")
    definition = [r for r in report.results if r.target == "spec.well_clear.vertical_violation"]
    assert definition
    assert all(r.kind == "definition" for r in definition)
    assert not REPLACED


def test_a_missing_theorem_shows_as_a_survivor_with_its_diff_and_a_witness():
    weak = mutate.run(["gives_way"], theorems=["exactly_one_gives_way"], premises=False)
    survivor = by_diff(weak, "+ return own_id < intruder_id")
    assert survivor.verdict == "survived"
    assert survivor.diff == "- return own_id > intruder_id + return own_id < intruder_id"
    assert survivor.place.startswith("core/gate.py:")
    assert survivor.note.startswith("differs at ")
    assert not weak.holds
    both = ["exactly_one_gives_way", "the_greater_id_gives_way"]
    strong = mutate.run(["gives_way"], theorems=both, premises=False)
    assert by_diff(strong, "+ return own_id < intruder_id").verdict == "killed"
    assert strong.of("survived") == ()


def judged(key, theorems, *ends):
    """The verdicts on chosen mutants of one function."""
    original = mutation_judge.targets(theorems)[key][0]
    target = mutation_judge.Target(key, original, theorems, dict.fromkeys(theorems, 100_000))
    made = {m.diff: m for m in mutants(original)}
    chosen = [next(m for diff, m in made.items() if diff.endswith(end)) for end in ends]
    return [target.judge(mutant) for mutant in chosen]


def test_equivalent_is_a_proof_and_says_where():
    everywhere, within, other = judged(
        "core.gate.gate_accepts",
        ["gate_has_exactly_one_commander"],
        "+ if -sender == 0:",
        "+ return gate.owner <= 0 or gate.offered",
        "+ return gate.owner != 0 or gate.offered",
    )
    assert (everywhere.verdict, everywhere.note) == ("equivalent", "equal everywhere")
    assert within.verdict == "equivalent"
    assert within.note.startswith("equal wherever ")
    assert "owner" in within.note
    assert (other.verdict, other.by) == ("killed", "gate_has_exactly_one_commander")


def test_a_difference_that_no_grid_shows_is_found_by_the_solver(monkeypatch):
    monkeypatch.setattr(mutation_judge, "inputs", lambda *more: [])
    (survivor,) = judged(
        "core.gate.gives_way", ["exactly_one_gives_way"], "+ return own_id < intruder_id"
    )
    assert survivor.verdict == "survived"
    assert survivor.note.startswith("differs at ")


def test_a_mask_has_no_order_so_such_a_mutant_is_stillborn():
    ordered, joined = judged(
        "core.timing.eligible",
        ["eligible_is_its_definition"],
        "+ return mask & bit < 0",
        "+ return mask | bit != 0",
    )
    assert ordered.verdict == "stillborn"
    assert joined.verdict == "killed"


def test_the_starts_of_folds_are_mutated():
    report = mutate.run(["locate", "schedule_holds"], premises=False)
    starts = [r for r in report.results if r.kind == "fold"]
    assert [r.diff.split(" + ")[1] for r in starts] == [
        "start=Seen(on=True, odd=False)",
        "start=Seen(on=False, odd=True)",
        "start=False",
    ]
    assert {r.verdict for r in starts} == {"killed"}


def test_premises_matter_or_are_named_as_unused():
    found = {
        p.premise: p
        for p in mutation_judge.judge_premises("runs_forward_is_its_definition", 10**5, FOLDER)
    }
    assert found["start has at most 62 bits"].dropped == "unused"


def test_a_premise_that_matters_is_noticed():
    judged = mutation_judge.judge_premises("the_greater_id_gives_way", 10**5, FOLDER)
    (found,) = [p for p in judged if "62 bits" not in p.premise]
    assert (found.dropped, found.weakened) == ("matters", "matters")


def test_a_theorem_made_from_the_kernel_itself_never_kills():
    theorems = ["exactly_one_gives_way", "filter_graphs_are_the_kernels"]
    report = mutate.run(["gives_way"], theorems=theorems, premises=False)
    assert {r.by for r in report.of("killed")} == {"exactly_one_gives_way"}


def test_no_mutant_is_judged_by_a_theorem_that_does_not_hold(monkeypatch):
    def claim(c: Claim) -> None:
        c.show(c.use(gate_module.gives_way, c.integer("a"), c.integer("b"), True))

    monkeypatch.setattr(prover, "load_claim", lambda name, *more: (claim, "A sentence."))
    mutation_judge.stated.cache_clear()
    try:
        with pytest.raises(ValueError, match="not proved as they stand"):
            mutate.run(["gives_way"], theorems=["exactly_one_gives_way"], premises=False)
    finally:
        mutation_judge.stated.cache_clear()


def test_results_are_cached_and_the_same_in_two_processes():
    names = ["later", "runs_forward", "gives_way"]
    heard = []
    first = mutate.run(names, lambda target, _: heard.append(target), 2)
    assert heard
    heard.clear()
    assert mutate.run(names, lambda target, _: heard.append(target)) == first
    assert heard == []


def test_a_cached_result_of_another_engine_is_not_used(monkeypatch, tmp_path):
    mutate.run(["later"], premises=False)
    monkeypatch.setattr(mutate.gate, "solver_version", lambda: "z3 0.0")
    heard = []
    mutate.run(["later"], lambda target, _: heard.append(target), premises=False)
    assert "core.timing.later" in heard


# -- the report --------------------------------------------------------------------------------------
def result(verdict, kind="kernel"):
    """Some mutant with this verdict."""
    return Result("core.m.f", kind, "sign", "core/m.py:3", "- a + -a", verdict, note="why")


def test_the_score_counts_the_undecided_as_not_killed():
    results = [result("killed")] * 97 + [result("undecided")] * 2 + [result("equivalent")] * 50
    report = MutationReport((*results, result("stillborn")), ())
    assert report.score == Fraction(97, 99)
    assert not report.holds
    assert "97 killed" in report.line
    assert "97.9 % killed" in report.line
    assert MutationReport((result("killed"),) * 99 + (result("undecided"),), ()).holds
    assert not MutationReport((result("killed"),) * 999 + (result("survived"),), ()).holds
    assert MutationReport((), ()).score == 1


def test_the_document_lists_what_was_not_killed():
    premises = (
        PremiseResult("t", "x >= 0", "unused", "-"),
        PremiseResult("t", "y >= 0", "matters", "unused"),
    )
    text = document(MutationReport((result("survived"), result("killed")), premises))
    assert "`core/m.py:3` `- a + -a`: why" in text
    assert "| `core.m.f` | 1 | 1 | 0 | 0 | 0 |" in text
    assert "`t`: `x >= 0`" in text
    assert "slightly weaker" in text


def test_a_report_is_plain_data():
    report = MutationReport((result("killed"),), ())
    assert json.loads(json.dumps(asdict(report)))["results"][0]["verdict"] == "killed"


# -- asking ----------------------------------------------------------------------------------
def test_answers_are_sat_unsat_or_unknown_within_the_budget():
    x, y = z3.Reals("x y")
    n = z3.Int("n")
    assert ask([x * x == 2, x > 0], 100_000) == "sat"
    assert ask([x * x < 0], 100_000) == "unsat"
    assert ask([2 * n == 1], 100_000) == "unsat"
    hard = [x**7 + y**5 * x**3 + x * y == 3, y**9 - x**4 * y > 7, x * y**6 + x**5 < -1]
    assert ask(hard, 50) == "unknown"
