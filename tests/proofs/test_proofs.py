"""The prover: it proves what is true, refutes what is false, and cannot be talked into more."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import z3

from cratous.core import ledger as gate
from cratous.core import well_clear
from cratous.core.kernel import Fold, Vec2, named
from cratous.proofs.claim import Claim
from cratous.proofs.engine import prover
from cratous.proofs.engine.subset import lint, lint_all
from cratous.proofs.ledger import Inventory, records
from cratous.spec import well_clear as meaning

gate.load_all()


# -- deliberately wrong kernels ---------------------------------------------------------
def strict_vertical(sz: float, vz: float, zthr_m: float, tcoa_s: float) -> bool:
    """vertical_violation with `<` for `<=`: wrong exactly on the threshold."""
    if abs(sz) < zthr_m:
        return True
    if sz * vz >= 0:
        return False
    return abs(sz) <= tcoa_s * abs(vz)


def unsafe_division(a: float, b: float) -> float:
    """Divides without looking."""
    return a / b


def overflowing(a: int, b: int) -> int:
    """A product of two times leaves 64 bits."""
    return a * b


def _vertical_claim(kernel):
    def claim(c: Claim) -> None:
        sz, vz, zthr, tcoa = c.reals("sz vz zthr tcoa")
        c.premise(zthr >= 0)
        c.premise(tcoa >= 0)
        verdict = c.use(kernel, sz, vz, zthr, tcoa)
        c.show(c.same(verdict, c.define(meaning.vertical_violation, sz, vz, zthr, tcoa)))

    return claim


def _prove(claim, **more):
    stated = Claim(load=lambda name: prover.load_claim(name)[0])
    claim(stated)
    return prover.prove("test", stated, "A test.", **more)


def test_the_right_kernel_is_proved():
    assert _prove(_vertical_claim(well_clear.vertical_violation)).proved


def test_a_broken_kernel_is_refuted_with_a_counterexample_that_shows_it():
    theorem = _prove(_vertical_claim(strict_vertical))
    assert not theorem.proved
    (bad,) = [o for o in theorem.outcomes if o.status != "proved"]
    assert bad.status == "refuted"
    values = {name: Fraction(value.rstrip("?")) for name, value in bad.counterexample}
    arguments = [values.get(name, Fraction(0)) for name in ("sz", "vz", "zthr", "tcoa")]
    assert strict_vertical(*arguments) != meaning.vertical_violation(*arguments)


def test_undefined_operations_are_obligations():
    def claim(c: Claim) -> None:
        a, b = c.reals("a b")
        quotient = c.use(unsafe_division, a, b)
        c.show(c.same(quotient, quotient))

    theorem = _prove(claim)
    assert [o.status for o in theorem.outcomes if o.obligation.kind == "defined"] == ["refuted"]
    assert not theorem.proved


def test_integers_must_stay_in_64_bits():
    def claim(c: Claim) -> None:
        product = c.use(overflowing, c.integer("a"), c.integer("b"))
        c.show(c.same(product, product))

    assert not _prove(claim).proved


def test_contradictory_premises_prove_nothing():
    def claim(c: Claim) -> None:
        x = c.real("x")
        c.premise(x > 0)
        c.premise(x < 0)
        c.show(c.same(c.use(well_clear.vertical_violation, x, x, x, x), x > 1))

    theorem = _prove(claim)
    assert theorem.premises == "contradictory"
    assert not theorem.proved


def test_too_little_effort_is_unknown_and_unknown_is_not_proved():
    claim = prover.load_claim("well_clear_horizontal_violation_within_misses_no_instant")[0]
    theorem = _prove(claim, rlimit=2000)
    assert not theorem.proved
    assert {o.status for o in theorem.outcomes} & {"unknown"}


def test_only_the_prover_makes_theorems():
    with pytest.raises(TypeError, match="only the prover"):
        prover.Theorem("t", "s", ("k",), (), "satisfiable", (), ())


def test_a_claim_without_kernel_or_goal_is_refused():
    with pytest.raises(ValueError, match="names no kernel"):
        _prove(lambda c: c.show(c.real("x") >= 0))
    with pytest.raises(ValueError, match="shows nothing"):
        _prove(lambda c: c.kernels.append("cratous.core.schedule.rows.later"))


def test_a_lemma_owes_its_premises():
    def claim(c: Claim) -> None:
        s, v = c.vector("s"), c.vector("v")
        dthr, tthr = c.reals("dthr tthr")  # no premise: DTHR may be negative here
        c.lemma("well_clear_horizontal_violation_is_its_definition", s=s, v=v, dthr=dthr, tthr=tthr)
        c.show(c.same(c.use(well_clear.horizontal_violation, s, v, dthr, tthr), True))

    theorem = _prove(claim)
    owed = [o for o in theorem.outcomes if o.obligation.kind == "lemma"]
    assert owed
    assert all(o.status == "refuted" for o in owed)


def test_an_opaque_function_is_not_taken_for_granted():
    """A contract whose arguments differ from the call's gives nothing."""

    def claim(c: Claim) -> None:
        s, v = c.vector("s"), c.vector("v")
        dthr, tthr = c.reals("dthr tthr")
        c.premise(dthr >= 0)
        c.premise(tthr >= 0)
        c.use(well_clear.vertical_violation, dthr, dthr, dthr, dthr)
        c.opaque(well_clear.horizontal_violation)
        c.lemma("well_clear_horizontal_violation_is_its_definition", s=s, v=v, dthr=dthr, tthr=tthr)
        wrong = c.use(well_clear.horizontal_violation, v, s, dthr, tthr)
        c.show(c.same(wrong, c.define(meaning.horizontal_violation, s, v, dthr, tthr)))

    assert not _prove(claim).proved


def test_assumptions_stay_visible():
    def claim(c: Claim) -> None:
        x = c.real("x")
        c.assume(x > 0, owner="nobody", reason="to see whether it shows")
        c.show(c.same(c.use(well_clear.vertical_violation, x, x, x, x), True))

    theorem = _prove(claim)
    assert theorem.assumptions == (("x > 0", "nobody", "to see whether it shows"),) or (
        theorem.assumptions[0][1:] == ("nobody", "to see whether it shows")
    )
    data = records(Inventory((theorem,), (), ()))
    assert data["theorems"]["test"]["assumptions"][0][1] == "nobody"


def _fold_statuses(fold: Any, model_step: Any, weak: bool = False) -> dict[str, str]:
    """What comes of each obligation where a fold over edges is to be its model; weak: related to anything."""

    def claim(c: Claim) -> None:
        p, q, a, b = (c.vector(n) for n in "pqab")
        c.fold(
            fold,
            acc=c.boolean("met"),
            model=c.boolean("model"),
            item=(a, b),
            context=(p, q),
            model_start=False,
            model_step=model_step,
            relation=(lambda met, model: c.same(met, met)) if weak else c.same,
        )

    return {o.obligation.kind: o.status for o in _prove(claim).outcomes}


@pytest.mark.parametrize(
    ("parts", "said"),
    [
        ({"model_start": False}, "an induction needs model_step"),
        ({"model_start": 0, "model_step": max, "model_end": max}, "is not given model_end"),
    ],
)
def test_a_fold_is_held_against_a_whole_definition(parts: dict[str, Any], said: str) -> None:
    c = Claim()
    kept = {"acc": c.boolean("met"), "model": c.boolean("model"), "item": (), "context": ()}
    with pytest.raises(TypeError, match=said):
        c.fold(named("meets_boundary").function, relation=c.same, **kept, **parts)


def test_a_wrong_fold_is_refuted():
    locate = named("meets_boundary").function
    assert isinstance(locate, Fold)
    broken = Fold(locate.name, locate.implements, locate.step, True)

    statuses = _fold_statuses(broken, locate.step)
    assert statuses["base"] == "refuted"
    assert statuses["use"] == "proved"


@pytest.mark.parametrize(("weak", "use"), [(False, "proved"), (True, "refuted")])
def test_a_fold_without_a_finish_gives_its_accumulator(weak: bool, use: str) -> None:
    meets = named("meets_boundary").function
    assert isinstance(meets, Fold)
    assert meets.finish is None

    assert _fold_statuses(meets, meets.step, weak)["use"] == use


# -- the subset -----------------------------------------------------------------------------
def test_all_kernels_are_in_the_subset():
    assert [str(f) for f in lint_all()] == []


LIMIT = 3


def outside(a: float, b: float) -> float:
    """Not in the subset, in each of its lines."""
    _half = 0.5 * a
    for k in range(3):
        a = a + k
    a += b
    _c, _d = a, b
    _least = LIMIT
    if b:
        return a
    if a is b:
        return b
    return a // b


def untyped(a: float, b) -> float:
    """An argument has no type."""
    return a


def test_the_lint_names_what_is_outside_of_the_subset():
    text = "\n".join(str(f) for f in lint(outside))
    for part in (
        "0.5",
        "fold",
        "x = x + y",
        "no bare tuples",
        "'LIMIT' is neither",
        "a condition is a truth value",
        "`is`",
        "//",
    ):
        assert part in text, part
    assert "'b' has no type" in "\n".join(str(f) for f in lint(untyped))


def test_smt2_export_says_what_it_is():
    claim = Claim()
    _vertical_claim(well_clear.vertical_violation)(claim)
    text = prover.smt2(claim.obligations[-1], "A title.")
    assert text.startswith("; A title.")
    solver = z3.Solver()
    solver.from_string(text)
    assert str(solver.check()) == "unsat"


def test_vectors_are_free_in_every_component():
    claim = Claim()
    vector = claim.vector("s")
    assert isinstance(vector, Vec2)
    assert str(vector.x.term) == "s.x"
