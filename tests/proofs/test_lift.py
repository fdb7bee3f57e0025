"""The lifter says what the function does: lifted term against running function.

Every definition and kernel is run on 200 random rational inputs beside its lifted term: of kernels
`cratous prove` compares all readings besides, on numbers that are special to them.
"""

import inspect

import pytest
import z3
from lift_checks import CHECKS, LEMMAS, PROBES, _holds, callee
from lifted import differences

from cratous.core import ledger as gate
from cratous.core.kernel import REGISTRY, qualified
from cratous.proofs.claim import Claim
from cratous.proofs.engine.lift import LiftError, lift
from cratous.proofs.engine.symbolic import SymMask, SymReal
from cratous.spec import geofence, schedule, service, well_clear
from cratous.spec.algebra import operators
from cratous.spec.authority import gate as authority

gate.load_all()
KERNELS = [e.function for e in REGISTRY.values() if e.kind == "kernel"]
DEFINITIONS = [
    function
    for module in (authority, geofence, operators, schedule, service, well_clear)
    for _, function in inspect.getmembers(module, inspect.isfunction)
    if function.__module__ == module.__name__
]


# `cratous prove`, which the gate runs too, holds every reading of every kernel against the others: here every
# fourth kernel, and none of those that take long
LONG = ("uncertain_conflict", "uncertain_span", "circle_span", "circle_first")
LIFTED = [
    pytest.param(kernel, marks=pytest.mark.long) if k % 4 or kernel.__name__ in LONG else kernel
    for k, kernel in enumerate(KERNELS)
]


@pytest.mark.parametrize("function", LIFTED, ids=lambda f: f.__name__)
def test_a_lifted_kernel_is_the_running_kernel(function):
    assert differences(function) == []


@pytest.mark.parametrize("function", DEFINITIONS, ids=lambda f: f"{f.__module__}.{f.__name__}")
def test_a_lifted_definition_is_the_running_definition(function):
    assert differences(function) == []


@pytest.mark.parametrize("function", PROBES, ids=lambda f: f.__name__)
def test_every_part_of_the_subset_is_lifted_right(function):
    assert differences(function) == []


@pytest.mark.parametrize("name", CHECKS)
def test_what_is_owed(name):
    assert CHECKS[name]()


def test_paths_are_counted_and_dead_ones_pruned():
    def state(a: float) -> int:
        if a > 1:
            if a > 0:
                return 1
            return 2
        return 3

    lifted = lift(state, SymReal(z3.Real("a")))
    assert (lifted.paths, len(lifted.branches), lifted.pruned) == (2, 2, 1)


def test_values_that_cannot_be_joined_are_refused():
    def truth_or_number(a: float) -> float:
        if a > 1:
            return a
        return a > 0

    def nothing(a: float) -> float:
        if a > 1:
            return a
        return None

    for function in (truth_or_number, nothing):
        with pytest.raises(LiftError, match="cannot be joined"):
            lift(function, SymReal(z3.Real("a")))


def test_masks_stay_in_64_bits():
    for wrong in (-1, 2**64):
        with pytest.raises(LiftError, match="no mask"):
            SymMask(z3.BitVec("m", 64)) | wrong


# -- what a theorem is about, and what it offers ----------------------------------------------------
def _closed(c):
    c.opaque(callee)
    a, b = c.reals("a b")
    c.show(c.same(c.use(callee, a, b), c.use(callee, a, b)))


def _looking(c):
    a, b = c.reals("a b")
    c.premise(b == 1)
    c.step(b * b == 1, "on the way")
    c.show(c.use(callee, a, b) == a)


def test_a_theorem_is_about_what_it_or_a_lemma_looks_into(monkeypatch):
    for name, statement, about in (
        ("closed", _closed, []),
        ("looking", _looking, [qualified(callee)]),
    ):
        monkeypatch.setitem(LEMMAS, name, statement)
        own = Claim()
        statement(own)
        assert own.kernels == about
        caller_of_it = Claim(load=lambda name: LEMMAS[name])
        caller_of_it.opaque(callee)
        x, y = caller_of_it.reals("x y")
        caller_of_it.use(callee, x, y)
        caller_of_it.lemma(name, a=x, b=y)
        assert caller_of_it.kernels == about


def test_a_step_is_owed_and_known_but_not_offered(monkeypatch):
    monkeypatch.setitem(LEMMAS, "looking", _looking)
    own = Claim()
    _looking(own)
    assert [o.text for o in own.obligations if o.kind == "goal"] == ["on the way", "the claim"]
    assert all(_holds(o.given, o.goal) for o in own.obligations)
    user = Claim(load=lambda name: LEMMAS[name])
    x, y = user.reals("x y")
    user.lemma("looking", a=x, b=y)
    assert len(user.facts) == 1


def test_what_a_lemma_hides_stays_open_outside():
    def hides(c):
        c.opaque(callee)
        c.show(True)

    claim = Claim(load=lambda name: hides)
    claim.lemma("hides")
    assert claim.stubs == {}
