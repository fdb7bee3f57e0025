"""What a mutation run says: the report, the record beside the proofs, and their document."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from fractions import Fraction

from cratous.core import ledger as gate
from cratous.proofs.mutation import record as mutation_record
from cratous.proofs.mutation.keys import Keys
from cratous.proofs.mutation.report import MutationReport
from cratous.proofs.mutation.results import PremiseResult, Result

gate.load_all()
KEYS = Keys()


def result(verdict, kind="kernel"):
    """Some mutant with this verdict."""
    return Result("cratous.core.m.f", kind, "sign", "core/m.py:3", "- a + -a", verdict, note="why")


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
    name, theorem = "cratous.core.authority.gate.gives_way", "authority_exactly_one_gives_way"
    results = tuple(replace(result(v), target=name) for v in ("survived", "killed"))
    premises = tuple(replace(p, theorem=theorem) for p in premises)
    data = mutation_record.merged(mutation_record.EMPTY, MutationReport(results, premises), KEYS)
    text = mutation_record.document(data, KEYS)
    assert f"- `{name}` `- a + -a`: why" in text
    assert f"| `{name}` | kernel | 2 | 1 | 1 | 0 | 0 | 0 |  |" in text
    assert f"`{theorem}`: `x >= 0`" in text
    assert "slightly weaker" in text
    assert "- `cratous.core.authority.gate.gate_offer`: it was never mutated" in text


def test_the_record_tells_what_holds_for_the_code_as_it_is():
    name, bare, theorem = (
        "cratous.core.authority.gate.gives_way",
        "daa_climb_in_numbers",
        "authority_exactly_one_gives_way",
    )
    survivor = replace(result("survived"), target=name)
    premise = PremiseResult(theorem, "x >= 0", "unused", "-")
    report = MutationReport((survivor,), (premise,), (theorem, bare))
    data = mutation_record.merged(mutation_record.EMPTY, report, KEYS)
    assert data["premises"][bare]["rows"] == []
    faultless = mutation_record.fresh(mutation_record.EMPTY, KEYS)
    assert mutation_record.fresh(data, KEYS) - faultless == {name, theorem, bare}
    assert mutation_record.survivors(data, {name}) == [(name, "kernel", "- a + -a")]
    assert mutation_record.survivors(data, {theorem}) == []
    open_ = mutation_record.stale_premises(data, KEYS)
    assert open_["authority_the_greater_id_gives_way"] == "its premises were never judged"
    assert not {theorem, bare} & set(open_)
    data["premises"][theorem]["key"] = "of other code"
    assert theorem in mutation_record.stale_premises(data, KEYS)
    assert mutation_record.fresh(data, KEYS) - faultless == {name, bare}
    assert faultless == set(), "in every kernel of the product there is a fault to look for"
    text = mutation_record.document(data, KEYS)
    assert f"- `{theorem}`: it, what it is about, or the judging code has changed since" in text
    assert f"`{theorem}`: `x >= 0`" not in text, "what is stale counts for nothing"


def test_a_stale_result_is_listed_as_stale():
    name = "cratous.core.authority.gate.gives_way"
    report = MutationReport((replace(result("killed"), target=name),), ())
    data = mutation_record.merged(mutation_record.EMPTY, report, KEYS)
    bare = mutation_record.stale(mutation_record.EMPTY, KEYS)
    assert bare["cratous.core.geofence.planar.orient"] == "it was never mutated"
    assert name not in mutation_record.stale(data, KEYS)
    fewer = Keys(theorems=["authority_exactly_one_gives_way"])
    assert "changed since" in mutation_record.stale(data, fewer)[name]
    assert f"| `{name}` | kernel | 1 | 1 | 0 | 0 | 0 | 0 | stale |" in mutation_record.document(
        data, fewer
    )
    gone = {"targets": {"cratous.core.authority.gate.gone": data["targets"][name]}, "premises": {}}
    assert (
        "no longer there" in mutation_record.stale(gone, KEYS)["cratous.core.authority.gate.gone"]
    )


def test_a_report_replaces_its_own_targets_in_the_record_alone(tmp_path):
    file = tmp_path / "mutation.json"
    one, other = "cratous.core.authority.gate.gives_way", "cratous.core.schedule.rows.later"
    for name in (one, other):
        report = MutationReport((replace(result("killed"), target=name),), ())
        mutation_record.write(report, KEYS, file)
    survivor = MutationReport((replace(result("survived"), target=one),), ())
    mutation_record.write(survivor, KEYS, file)
    targets_now = mutation_record.read(file)["targets"]
    assert targets_now[one]["counts"]["survived"] == 1
    assert targets_now[other]["counts"]["killed"] == 1


def test_a_report_is_plain_data():
    report = MutationReport((result("killed"),), ())
    assert json.loads(json.dumps(asdict(report)))["results"][0]["verdict"] == "killed"
