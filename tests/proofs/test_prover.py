"""The prover around the solver: hashes, cache, several cores, counterexamples, refusals."""

from __future__ import annotations

import json
import os
from fractions import Fraction
from pathlib import Path

import pytest
import z3

from cratous.core import ledger as gate
from cratous.core.kernel import Vec2
from cratous.core.well_clear import vertical_violation, violation
from cratous.proofs import ledger
from cratous.proofs.claim import Claim
from cratous.proofs.engine import counterexample, prover, smtlib, theorem_files
from cratous.proofs.engine.cache import Answer, Cache
from cratous.proofs.engine.counterexample import Watched, meanings, number_text
from cratous.proofs.engine.obligation_hash import Hasher
from cratous.proofs.ledger import report_formats
from cratous.spec import well_clear as meaning
from cratous.spec.errors import BadInput

gate.load_all()
QUICK = [
    "authority_exactly_one_gives_way",
    "geofence_orient_is_the_turn",
    "geofence_straddles_is_its_definition",
]


# -- the structural hash ----------------------------------------------------------------------
def _key(*terms: z3.ExprRef) -> str:
    return Hasher().key("unsat?", terms)


def test_names_and_numbering_do_not_matter_but_structure_does():
    x, y, u, v = z3.Reals("x y u v")
    key = _key(x * x + y > 2 * x, y >= 0)
    for _ in range(50):  # other terms in between change the solver's internal numbers
        z3.simplify(z3.Real("noise") * 3 + z3.Int("k"))
    assert _key(u * u + v > 2 * u, v >= 0) == key
    for other in (
        (u * u + v > 2 * v, v >= 0),
        (u * u + v >= 2 * u, v >= 0),
        (u * u + v > 3 * u, v >= 0),
        (v >= 0, u * u + v > 2 * u),
        (u * u + v > 2 * u, u >= 0),
        (u * u - v > 2 * u, v >= 0),
    ):
        assert _key(*other) != key, other


def test_sorts_values_and_binders_count():
    assert _key(z3.Real("x") >= 0) != _key(z3.Int("x") >= 0)
    a, b = z3.BitVecs("a b", 64)
    assert _key(a & b == 0) != _key(a | b == 0)
    assert _key(z3.BitVec("a", 32) == 0) != _key(a == 0)
    assert _key(z3.RealVal("1/3") < z3.Real("x")) != _key(z3.RealVal("2/3") < z3.Real("x"))
    x, y = z3.Reals("x y")
    assert _key(z3.ForAll([x], x >= y)) == _key(z3.ForAll([y], y >= x))
    assert _key(z3.ForAll([x], x >= y)) != _key(z3.Exists([x], x >= y))
    assert Hasher().key("sat?", [x >= 0]) != _key(x >= 0)


def test_a_theorem_has_the_same_keys_in_every_process():
    one, other = (
        ledger.prove_theorems(["geofence_straddles_is_its_definition"], jobs=1)[0] for _ in range(2)
    )
    here = prover.prove_file("geofence_straddles_is_its_definition")
    keys = [[o.key for o in theorem.outcomes] for theorem in (one, other, here)]
    assert keys[0] == keys[1] == keys[2]
    assert all(len(key) == 64 for key in keys[0])


# -- the cache ----------------------------------------------------------------------------------
def test_a_second_run_asks_the_solver_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    cold = prover.prove_file("geofence_orient_is_the_turn", cache=Cache(tmp_path))
    warm = Cache(tmp_path)
    monkeypatch.setattr(prover, "_ask", lambda *_: pytest.fail("the solver was asked again"))
    assert prover.prove_file("geofence_orient_is_the_turn", cache=warm) == cold
    assert warm.hits > 0


def test_the_cache_answers_its_own_question_only(tmp_path: Path):
    cache = Cache(tmp_path)
    cache.put("k", 10, Answer("unsat", 1, 0.1, "ALL"))
    assert cache.get("k", 10) == Answer("unsat", 1, 0.1, "ALL")
    assert cache.get("k", 11) is None
    assert cache.get("l", 10) is None
    (file,) = [f for f in tmp_path.rglob("*") if f.is_file()]
    data = json.loads(file.read_text())
    for damage in (
        "",
        "{",
        "[]",
        json.dumps({**data, "result": "yes"}),
        json.dumps({**data, "question": ["other", 10]}),
        json.dumps({**data, "more": 1}),
    ):
        file.write_text(damage)
        assert Cache(tmp_path).get("k", 10) is None, damage


def test_a_refutation_is_never_taken_from_the_cache(tmp_path: Path):
    claim, cache = _broken_claim(), Cache(tmp_path)
    first = prover.prove("x", claim, "X.", cache=cache)
    again = prover.prove("x", claim, "X.", cache=cache)
    assert not first.proved
    assert [o.story for o in again.outcomes] == [o.story for o in first.outcomes]


# -- several cores ------------------------------------------------------------------------------
def test_several_processes_give_the_ledger_of_one():
    one = ledger.prove_all(QUICK, jobs=1)
    steps: list[ledger.Progress] = []
    many = ledger.prove_all(QUICK, steps.append, jobs=3)
    assert ledger.text(one) == ledger.text(many)
    assert {step.name for step in steps} == set(QUICK)
    assert [t.name for t in many.theorems] == QUICK


def test_an_error_in_a_process_comes_back_as_it_is(tmp_path: Path):
    (tmp_path / "empty.py").write_text('"""A sentence."""\n')
    with pytest.raises(BadInput, match=r"empty.py: the theorem states nothing"):
        ledger.prove_theorems(["empty"], folder=tmp_path, jobs=2)


def test_a_lemma_shows_the_same_where_it_meets_no_calls(tmp_path: Path):
    text = '''"""Of an altitude."""

from cratous.core.well_clear.interval import times_vertical, vertical_interval
from cratous.proofs.claim import Claim


def claim(c: Claim) -> None:
    a, b, d = c.reals("a b d")
    c.opaque(CLOSED)
    c.use(vertical_interval, a, b, d, d, d, d, d)
    GOAL
'''

    def write(name: str, goal: str, closed: str = "times_vertical") -> None:
        file = tmp_path / f"{name}.py"
        file.write_text(text.replace("GOAL", goal).replace("CLOSED", closed))

    # who does not look into the layer meets no calls, and "one of them" would be false there
    write("made", "c.show(c.any_of(*[x[0] == a for x in c.calls(times_vertical)]))")
    assert prover.prove_file("made", folder=tmp_path).proved
    write("user", "c.lemma('made', a=a, b=b, d=d)\n    c.show(a > a)", "vertical_interval")
    with pytest.raises(BadInput, match=r"user.py: made is no lemma"):
        prover.prove_file("user", folder=tmp_path)
    write("taken", "c.show(c.calls(times_vertical)[0][0] == a)")
    write("second", "c.lemma('taken', a=a, b=b, d=d)\n    c.show(a > a)", "times_vertical")
    with pytest.raises(BadInput, match=r"second.py: taken is no lemma"):
        prover.prove_file("second", folder=tmp_path)
    write("slip", "for x in c.calls(times_vertical):\n        c.step(x[0] == a)")
    write("fourth", "c.lemma('slip', a=a, b=b, d=d)\n    c.show(a == a)", "vertical_interval")
    with pytest.raises(BadInput, match=r"slip.py:12: the theorem cannot be stated"):
        prover.prove_file("fourth", folder=tmp_path)
    steps = "for x in c.calls(times_vertical):\n        c.step(x[0] == a, 'it')\n    c.show(a == a)"
    write("cited", steps)
    write("third", "c.lemma('cited', a=a, b=b, d=d)\n    c.show(a == a)", "vertical_interval")
    assert prover.prove_file("third", folder=tmp_path).proved


def test_a_process_that_dies_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(prover, "state", lambda *_a: os._exit(9))
    with pytest.raises(RuntimeError, match="dies ended without an answer"):
        ledger.prove_theorems(["dies"], folder=tmp_path, jobs=1)


# -- counterexamples ------------------------------------------------------------------------------
def strict_violation(s: Vec2, v: Vec2, dthr_m: float, tthr_s: float) -> bool:
    """True iff the volume is violated, but for its edge.

    s: relative position [m]; v: relative velocity [m/s]; dthr_m: distance threshold [m], >= 0;
    tthr_s: time threshold on tau_mod [s], >= 0.
    """
    ss = s.x * s.x + s.y * s.y
    vv = v.x * v.x + v.y * v.y
    sv = s.x * v.x + s.y * v.y
    cross = s.x * v.y - s.y * v.x
    dd = dthr_m * dthr_m
    if ss < dd:
        return True
    if sv >= 0:
        return False
    return cross * cross <= dd * vv and dd - ss >= tthr_s * sv


def _broken_claim() -> Watched:
    c = Watched()
    s, v = c.vector("s"), c.vector("v")
    dthr, tthr = c.reals("dthr tthr")
    c.premise(dthr >= 0)
    c.premise(tthr >= 0)
    verdict = c.use(strict_violation, s, v, dthr, tthr)
    c.show(c.same(verdict, c.define(meaning.horizontal_violation, s, v, dthr, tthr)))
    return c


def test_a_counterexample_speaks_of_positions_and_speeds():
    theorem = prover.prove("strict", _broken_claim(), "A broken kernel.")
    (bad,) = [o for o in theorem.outcomes if o.status == "refuted"]
    text = "\n".join(bad.story)
    assert "relative position" in text
    assert "dthr_m = " in text
    assert " m/s" in text
    assert "kernel strict_violation says clear" in text
    assert "definition well_clear.horizontal_violation says violated" in text
    assert "(confirmed: the functions, run on these numbers, say the same)" in text
    assert "?" not in text
    assert "/" not in text.replace("m/s", "")
    assert "strict_violation says clear" in report_formats.failure_text(theorem)


def test_an_opaque_function_makes_a_counterexample_unconfirmed():
    c = Watched()
    sz, vz, zthr, tcoa = c.reals("sz vz zthr tcoa")
    c.premise(sz > zthr)
    c.premise(zthr >= 0)
    c.opaque(vertical_violation)
    c.kernels.append("violation")
    c.show(c.negation(c.all_of(c.use(vertical_violation, sz, vz, zthr, tcoa), vz == 0)))
    (bad,) = prover.prove("x", c, "X.").outcomes
    assert bad.status == "refuted"
    assert "says clear (the theorem allows violated)" in "\n".join(bad.story)
    assert "not confirmed by running" in bad.story[-1]


def test_arguments_have_units_and_meanings():
    known = meanings(violation)
    assert known["dthr_m"].unit == "m"
    assert known["tthr_s"].unit == "s"
    known = meanings(strict_violation)
    assert (known["s"].unit, known["s"].text) == ("m", "relative position")
    assert (known["v"].unit, known["v"].text) == ("m/s", "relative velocity")
    assert known["tthr_s"].text == "time threshold on tau_mod"
    assert meanings(lambda a_ms, b: a_ms)["a_ms"].unit == "ms"


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (Fraction(120), "m", "120 m"),
        (Fraction(-5, 2), "m", "-2.5 m"),
        (Fraction(1, 3), "s", "0.333333 (exactly 1/3) s"),
        (Fraction(-1, 400), "", "-0.0025"),
        (True, "", "yes"),
        (7, "ms", "7 ms"),
        (Vec2(Fraction(1), Fraction(-1, 2)), "m", "(1 m, -0.5 m)"),
    ],
)
def test_numbers_are_decimals_with_the_fraction_where_it_is_not_finite(value, unit, text):
    assert number_text(value, unit) == text


def test_irrational_values_are_said_to_be_rounded():
    x = z3.Real("x")
    context = z3.Context()
    solver = z3.Solver(ctx=context)
    solver.add((x * x == 2).translate(context))
    assert solver.check() == z3.sat
    model = counterexample.Model(solver.model(), context)
    ((name, value),) = model.variables()
    assert name == "x"
    assert abs(value * value - 2) < Fraction(1, 10**6)
    assert model.rounded


# -- what is no theorem ---------------------------------------------------------------------------
def test_contradictory_assumptions_prove_nothing():
    c = Claim()
    x = c.real("x")
    c.assume(x > 0, owner="nobody", reason="a test")
    c.assume(x < 0, owner="nobody", reason="a test")
    c.show(c.use(vertical_violation, x, x, x, x))
    theorem = prover.prove("x", c, "X.")
    assert theorem.premises == "contradictory"
    assert not theorem.proved


def test_two_theorems_of_one_name_are_refused_with_both_places(tmp_path: Path):
    (tmp_path / "geofence_orient_is_the_turn.py").write_text(
        '"""Mine."""\n\n\ndef claim(c):\n    pass\n'
    )
    with pytest.raises(BadInput, match="two theorems are called") as caught:
        theorem_files.load_lemma("geofence_orient_is_the_turn", tmp_path)
    assert "proofs/theorems/geofence/orient_is_the_turn.py" in caught.value.where


def test_an_unknown_theorem_is_refused():
    with pytest.raises(BadInput, match="no theorem called 'nonsense'"):
        prover.load_claim("nonsense")


def test_a_theorem_runs_from_its_text_not_from_byte_code(tmp_path: Path):
    file = tmp_path / "mine.py"
    file.write_text('"""One."""\n\n\ndef claim(c):\n    c.real("one")\n')
    claim = Claim()
    prover.load_claim("mine", tmp_path)[0](claim)
    assert not (tmp_path / "__pycache__").exists()
    assert claim.names == {"one"}


# -- dead paths -----------------------------------------------------------------------------------
def test_a_path_that_no_premise_allows_is_named():
    def claim(more: bool) -> Claim:
        c = Claim()
        sz, vz, zthr, tcoa = c.reals("sz vz zthr tcoa")
        c.premise(zthr >= 0)
        if not more:
            c.premise(sz == 0)
        verdict = c.use(vertical_violation, sz, vz, zthr, tcoa)
        c.show(c.same(verdict, verdict))
        return c

    narrow = prover.prove("narrow", claim(False), "N.")
    wide = prover.prove("wide", claim(True), "W.")
    reached = [(name, sum(seen)) for t in (narrow, wide) for name, seen in t.paths]
    name = "cratous.core.well_clear.now.vertical_violation"
    assert reached == [(name, 1), (name, 3)]
    found = ledger.dead_paths([narrow])
    assert len(found) == 2
    assert all("vertical_violation" in line for line in found)
    assert ledger.dead_paths([narrow, wide]) == []


# -- export and views -----------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("name", "logic"),
    [
        ("geofence_orient_is_the_turn", "QF_NRA"),
        ("schedule_eligible_is_its_definition", "QF_BV"),
        ("authority_exactly_one_gives_way", "QF_LIA"),
    ],
)
def test_the_export_names_its_exact_logic(name: str, logic: str):
    claim, sentence = prover.state(name)
    texts = [prover.smt2(o, sentence) for o in claim.obligations]
    assert any(f"(set-logic {logic})" in text for text in texts), texts[0][:300]
    for text in texts:
        assert text.count("(set-logic") == 1
        assert text.count("(set-info :status unsat)") == 1


def test_nonlinear_integers_and_mixtures_have_their_logic():
    def logic(*terms: z3.BoolRef) -> str:
        return prover.logic_of(prover.Obligation("goal", "x", terms[:-1], terms[-1]))

    k, m = z3.Ints("k m")
    x, y = z3.Reals("x y")
    assert logic(k * m > 0) == "QF_NIA"
    assert logic(2 * k > m) == "QF_LIA"
    assert logic(x + 2 * y > 0) == "QF_LRA"
    assert logic(x / y > 0) == "QF_NRA"
    assert logic(x / 3 > 0) == "QF_LRA"
    assert logic(x * y > 0, k > 0) == "QF_NIRA"
    assert logic(z3.Or(z3.Bool("p"), z3.Not(z3.Bool("p")))) == "QF_UF"
    assert logic(z3.ForAll([x], x * x >= 0)) == "NRA"


def test_junit_and_sarif_say_what_failed_and_where():
    import xml.etree.ElementTree as ET

    good = prover.prove_file("geofence_straddles_is_its_definition")
    bad = prover.prove("geofence_orient_is_the_turn", _broken_claim(), "Broken.")
    problem = "core/authority/gate.py:24: gate_takeover: no theorem is about this kernel"
    suite = ET.fromstring(report_formats.junit([good, bad], [problem]).encode())
    assert (suite.get("tests"), suite.get("failures")) == ("3", "2")
    assert "relative position" in "".join(suite.itertext())
    data = json.loads(report_formats.sarif([good, bad], [problem]))
    first, second = data["runs"][0]["results"]
    uri = first["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    assert uri == "proofs/theorems/geofence/orient_is_the_turn.py"
    place = second["locations"][0]["physicalLocation"]
    assert place["artifactLocation"]["uri"] == "core/authority/gate.py"
    assert place["region"]["startLine"] == 24


def test_a_lemma_is_looked_for_once_however_often_it_is_used(monkeypatch: pytest.MonkeyPatch):
    real, loaded = prover.load_lemma, []
    monkeypatch.setattr(prover, "load_lemma", lambda n, at: loaded.append(n) or real(n, at))
    claim, _ = prover.state("well_clear_cylinder_is_convex")
    assert sorted(loaded) == sorted(set(loaded))
    assert {*claim.lemmas} <= {*loaded} != set()


def test_what_occurs_in_terms_is_the_same_with_what_was_found_before():
    x, n, mask = z3.Real("x"), z3.Int("n"), z3.BitVec("mask", 64)
    f = z3.Function("f", z3.RealSort(), z3.RealSort())
    some = [x * x > 0, n > 1, mask == 3, f(x) > 0, z3.ForAll([x], x > 0), z3.And(x > 0, n > 2)]
    seen: smtlib.Seen = {}
    for _ in range(2):
        for number in range(1, len(some) + 1):
            assert smtlib.sorts(some[:number], seen) == smtlib.sorts(some[:number])
            assert smtlib.sorts(some[number - 1 : number], seen) == smtlib.sorts([some[number - 1]])
