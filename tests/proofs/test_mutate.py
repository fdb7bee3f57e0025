"""Mutation: every verdict is reached for the reason that its name says."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest
import z3

from cratous.core import ledger as gate
from cratous.core.authority import gate as gate_module
from cratous.core.kernel import REGISTRY, named
from cratous.proofs.claim import Claim
from cratous.proofs.engine import prover
from cratous.proofs.engine.lift import REPLACED
from cratous.proofs.engine.symbolic import wrap
from cratous.proofs.mutation import judgement as mutation_judge
from cratous.proofs.mutation import mutate
from cratous.proofs.mutation.inputs import compare, inputs, run
from cratous.proofs.mutation.keys import Keys, Store
from cratous.proofs.mutation.operators import mutants
from cratous.proofs.mutation.premises import judge_premises
from cratous.proofs.mutation.report import MutationReport
from cratous.proofs.mutation.solver_queries import ask
from cratous.proofs.mutation.statements import targets
from cratous.proofs.mutation.terms import equal, with_values
from cratous.spec.errors import BadInput

gate.load_all()
KEYS, NOWHERE = Keys(), Store(None)


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    """No result of another run is trusted here."""
    monkeypatch.setenv("CRATOUS_CACHE", str(tmp_path))


def diffs(name):
    return {m.diff for m in mutants(named(name).function)}


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


# by the first letters of their names; all of them take a minute
@pytest.mark.parametrize("last", ["c", pytest.param("~", marks=pytest.mark.long)])
def test_mutants_are_distinct_and_in_a_fixed_order(last: str):
    chosen = [e for e in REGISTRY.values() if e.kind == "kernel" and e.function.__name__ < last]
    assert len(chosen) > 15
    for entry in chosen:
        made = [(m.line, m.operator, m.diff) for m in mutants(entry.function)]
        assert made == [(m.line, m.operator, m.diff) for m in mutants(entry.function)]
        assert len(set(made)) == len(made)
        assert all(diff.startswith("- ") and "\n" not in diff for _, _, diff in made)


def test_the_line_of_a_mutant_is_that_of_the_file():
    function = named("gives_way").function
    lines = Path(gate_module.__file__).read_text(encoding="utf-8").splitlines()
    (mutant,) = [m for m in mutants(function) if m.diff.endswith("+ return own_id >= intruder_id")]
    assert lines[mutant.line - 1].strip() == "return own_id > intruder_id"


def test_a_mutant_differs_from_its_original_on_a_boundary():
    function = named("vertical_violation").function
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


@pytest.mark.long
def test_faults_are_killed_by_the_theorem_that_they_break():
    report = mutate.run(
        ["vertical_violation"],
        keys=Keys(theorems=["well_clear_vertical_violation_is_its_definition"]),
    )
    kernel = [
        r for r in report.results if r.target == "cratous.core.well_clear.now.vertical_violation"
    ]
    assert {r.verdict for r in kernel} <= {"killed", "equivalent"}
    assert {r.by for r in kernel if r.verdict == "killed"} == {
        "well_clear_vertical_violation_is_its_definition"
    }
    assert all(r.note for r in kernel if r.verdict == "equivalent")
    definition = [
        r for r in report.results if r.target == "cratous.spec.well_clear.vertical_violation"
    ]
    assert definition
    assert all(r.kind == "definition" for r in definition)
    assert not REPLACED


@pytest.mark.long
def test_a_missing_theorem_shows_as_a_survivor_with_its_diff_and_a_witness():
    weak = mutate.run(
        ["gives_way"], keys=Keys(theorems=["authority_exactly_one_gives_way"]), premises=False
    )
    survivor = by_diff(weak, "+ return own_id < intruder_id")
    assert survivor.verdict == "survived"
    assert survivor.diff == "- return own_id > intruder_id + return own_id < intruder_id"
    assert survivor.place.startswith("core/authority/gate.py:")
    assert survivor.note.startswith("differs at ")
    assert not weak.holds
    both = ["authority_exactly_one_gives_way", "authority_the_greater_id_gives_way"]
    strong = mutate.run(["gives_way"], keys=Keys(theorems=both), premises=False)
    assert by_diff(strong, "+ return own_id < intruder_id").verdict == "killed"
    assert strong.of("survived") == ()


def judged(key, theorems, *ends):
    """The verdicts on chosen mutants of one function."""
    original = targets(theorems)[key][0]
    target = mutation_judge.Target(key, original, theorems, dict.fromkeys(theorems, 100_000))
    made = {m.diff: m for m in mutants(original)}
    chosen = [next(m for diff, m in made.items() if diff.endswith(end)) for end in ends]
    return [target.judge(mutant) for mutant in chosen]


def test_equivalent_is_a_proof_and_says_where():
    everywhere, within, other = judged(
        "cratous.core.authority.gate.gate_accepts",
        ["authority_gate_has_exactly_one_commander"],
        "+ if -sender == 0:",
        "+ return gate.owner <= 0 or gate.offered",
        "+ return gate.owner != 0 or gate.offered",
    )
    assert (everywhere.verdict, everywhere.note) == ("equivalent", "equal everywhere")
    assert within.verdict == "equivalent"
    assert within.note.startswith("equal wherever ")
    assert "owner" in within.note
    assert (other.verdict, other.by) == ("killed", "authority_gate_has_exactly_one_commander")


def test_a_difference_that_no_grid_shows_is_found_by_the_solver(monkeypatch):
    monkeypatch.setattr(mutation_judge, "inputs", lambda *more: [])
    (survivor,) = judged(
        "cratous.core.authority.gate.gives_way",
        ["authority_exactly_one_gives_way"],
        "+ return own_id < intruder_id",
    )
    assert survivor.verdict == "survived"
    assert survivor.note.startswith("differs at ")


def test_a_mask_has_no_order_so_such_a_mutant_is_stillborn():
    ordered, joined = judged(
        "cratous.core.schedule.rows.eligible",
        ["schedule_eligible_is_its_definition"],
        "+ return mask & bit < 0",
        "+ return mask | bit != 0",
    )
    assert ordered.verdict == "stillborn"
    assert joined.verdict == "killed"


def test_a_definition_that_takes_literals_alone_is_judged_where_theorems_give_them():
    (turned,) = judged(
        "cratous.spec.schedule.vehicle_is_eligible",
        ["schedule_eligible_is_its_definition"],
        "+ return mask >> k & 1 == 1 and bit >> k & 1 == 2",
    )
    assert turned.verdict == "killed"


def test_a_literal_of_a_theorem_stands_for_the_real_that_it_is():
    half, two = (Fraction(1, 2),), (Fraction(2),)
    literal = (wrap(z3.IntVal(2)),)
    assert ask(equal(literal, half), 100_000) == "unsat"
    assert ask(equal(literal, two), 100_000) == "sat"
    x, y = wrap(z3.Real("x")), wrap(z3.Real("y"))
    above, mixed, other = x.term > 1, x.term > y.term, y.term > 1
    assert with_values([above, other], (x,), two) is True
    assert with_values([above, other], (x,), half) is False
    assert with_values([above, mixed], (x,), two) is None
    assert with_values([above], (x + y,), two) is None


def test_an_error_of_the_judge_is_not_taken_for_a_stillborn_mutant(monkeypatch):
    def broken(*more):
        raise TypeError("a defect")

    monkeypatch.setattr(mutation_judge, "equal", broken)
    with pytest.raises(TypeError, match="a defect"):
        judged(
            "cratous.core.authority.gate.gives_way",
            ["authority_exactly_one_gives_way"],
            "+ return own_id < intruder_id",
        )


@pytest.mark.long
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
        for p in judge_premises("schedule_runs_forward_is_its_definition", 10**5, KEYS, NOWHERE)
    }
    assert found["start has at most 62 bits"].dropped == "unused"


def test_a_premise_that_matters_is_noticed():
    judged = judge_premises("authority_the_greater_id_gives_way", 10**5, KEYS, NOWHERE)
    (found,) = [p for p in judged if "62 bits" not in p.premise]
    assert (found.dropped, found.weakened) == ("matters", "matters")


def test_a_theorem_made_from_the_kernel_itself_never_kills():
    theorems = ["authority_exactly_one_gives_way", "filter_graphs_are_the_kernels"]
    report = mutate.run(["gives_way"], keys=Keys(theorems=theorems), premises=False)
    assert {r.by for r in report.of("killed")} == {"authority_exactly_one_gives_way"}


def test_no_mutant_is_judged_by_a_theorem_that_does_not_hold(monkeypatch):
    def claim(c: Claim) -> None:
        c.show(c.use(gate_module.gives_way, c.integer("a"), c.integer("b"), True))

    monkeypatch.setattr(prover, "load_claim", lambda name, *more: (claim, "A sentence."))
    with pytest.raises(ValueError, match="not proved as they stand"):
        mutate.run(
            ["gives_way"], keys=Keys(theorems=["authority_exactly_one_gives_way"]), premises=False
        )


@pytest.mark.long
def test_what_is_skipped_is_not_judged():
    theorems = ["authority_exactly_one_gives_way", "authority_the_greater_id_gives_way"]
    whole = mutate.run(["gives_way"], keys=Keys(theorems=theorems), store=NOWHERE)
    assert whole.judged == tuple(theorems)
    premises = mutate.run(
        ["gives_way"],
        keys=Keys(theorems=theorems),
        store=NOWHERE,
        skip={"cratous.core.authority.gate.gives_way"},
    )
    assert premises.judged == tuple(theorems)
    assert premises.premises == whole.premises
    assert not premises.results
    mutants = mutate.run(
        ["gives_way"], keys=Keys(theorems=theorems), store=NOWHERE, skip=set(theorems)
    )
    assert mutants.results == whole.results
    assert not mutants.judged
    everything = {"cratous.core.authority.gate.gives_way", *theorems}
    nothing = mutate.run(
        ["gives_way"], keys=Keys(theorems=theorems), store=NOWHERE, skip=everything
    )
    assert nothing == MutationReport((), ())


@pytest.mark.long
def test_premises_count_where_a_theorem_looks_into_nothing():
    """All that it is about is opaque, so it meets no mutant; its premises may be idle all the same."""
    name = "well_clear_tep_is_convex"
    report = mutate.run(["violation_tep_at"], keys=Keys(theorems=[name]), store=NOWHERE)
    assert not report.results
    assert report.judged == (name,)
    assert len(report.premises) > 3


def test_a_mutant_that_python_cannot_compute_is_told(monkeypatch):
    def divides(*more):
        raise ZeroDivisionError("Fraction(1, 0)")

    monkeypatch.setattr(mutate, "judge_target", divides)
    with pytest.raises(
        BadInput, match=r"cratous.core.authority.gate.gives_way: its mutants .* symbolic numbers"
    ):
        mutate.run(
            ["gives_way"],
            keys=Keys(theorems=["authority_exactly_one_gives_way"]),
            premises=False,
            store=NOWHERE,
        )


@pytest.mark.long
def test_results_are_stored_and_the_same_in_two_processes(monkeypatch):
    names = ["later", "runs_forward", "gives_way"]
    first = mutate.run(names, jobs=2)

    def judged_again(*more):
        raise AssertionError("a stored verdict was asked again")

    monkeypatch.setattr(mutation_judge.Target, "judge", judged_again)
    assert mutate.run(names) == first


@pytest.mark.long
def test_a_run_that_was_stopped_goes_on_where_it_was(monkeypatch, tmp_path):
    store = Store(tmp_path / "verdicts")
    whole = mutate.run(["gives_way"], premises=False, store=store)
    files = sorted(p for p in store.folder.rglob("*") if p.is_file())
    assert len(files) == len(whole.results) > 3
    files[0].unlink()
    files[1].write_text("{damaged")
    files[2].write_text(files[3].read_text())
    again = mutate.run(["gives_way"], premises=False, store=store)
    assert again == whole
    assert len([p for p in store.folder.rglob("*") if p.is_file()]) == len(files)


def test_a_verdict_depends_on_function_theorems_judge_and_solver(monkeypatch):
    function = named("gives_way").function
    key = KEYS.target("cratous.core.authority.gate.gives_way", function)
    assert Keys().target("cratous.core.authority.gate.gives_way", function) == key
    other = named("gate_offer").function
    assert key != KEYS.target("cratous.core.authority.gate.gate_offer", other)
    fewer = Keys(theorems=["authority_exactly_one_gives_way"])
    assert fewer.target("cratous.core.authority.gate.gives_way", function) != key
    unrelated = [name for name in KEYS.theorems if name != "geofence_orient_is_the_turn"]
    assert Keys(theorems=unrelated).target("cratous.core.authority.gate.gives_way", function) == key
    assert KEYS.mutant(key, "a") != KEYS.mutant(key, "b")
    monkeypatch.setattr(KEYS, "judging", "another")
    assert KEYS.target("cratous.core.authority.gate.gives_way", function) != key


# every fortieth; stating all of them takes minutes
@pytest.mark.parametrize("step", [40, pytest.param(1, marks=pytest.mark.long)])
def test_what_a_theorem_meets_is_within_what_it_names(step: int):
    """A key must cover every theorem that can judge, also those that meet a function indirectly."""
    from cratous.core.kernel import qualified

    chosen = KEYS.theorems[::step]
    met = targets(chosen)
    # more theorems have come and will: how many are met depends on which ones the step hits
    assert len({name for _, users in met.values() for name in users}) > len(chosen) / 2
    for target, users in met.values():
        for name in users:
            assert qualified(target) in KEYS.reach(name), (name, target)


# -- asking ----------------------------------------------------------------------------------
def test_answers_are_sat_unsat_or_unknown_within_the_budget():
    x, y = z3.Reals("x y")
    n = z3.Int("n")
    assert ask([x * x == 2, x > 0], 100_000) == "sat"
    assert ask([x * x < 0], 100_000) == "unsat"
    assert ask([2 * n == 1], 100_000) == "unsat"
    hard = [x**7 + y**5 * x**3 + x * y == 3, y**9 - x**4 * y > 7, x * y**6 + x**5 < -1]
    assert ask(hard, 50) == "unknown"
