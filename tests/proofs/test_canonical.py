"""Names of arguments: equal ones share theirs however they came to be, others do not."""

from __future__ import annotations

import random

import z3
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.kernel import Vec2
from cratous.proofs.engine.canonical import canonical
from cratous.proofs.engine.symbolic import SymInt, SymReal
from cratous.proofs.engine.terms import Stub, normal

NAMES = ("a", "b", "c", "d")
MONOMIALS = st.dictionaries(
    st.lists(st.sampled_from(NAMES), min_size=1, max_size=3).map(
        lambda names: tuple(sorted(names))
    ),
    st.integers(-4, 4).filter(bool),
    min_size=1,
    max_size=5,
)


def built(monomials: dict[tuple[str, ...], int], seed: int) -> z3.ExprRef:
    """The polynomial, with operands and what was built before in an order of its own."""
    rng = random.Random(seed)
    names = rng.sample(NAMES, len(NAMES))
    junk = [z3.Real(x) * z3.Real(y) for x in names for y in names]
    del junk[:: rng.randint(1, 3)]
    rows = rng.sample(sorted(monomials.items()), len(monomials))
    terms = []
    for factors, number in rows:
        product = z3.RealVal(number)
        for name in rng.sample(factors, len(factors)):
            product = z3.Real(name) * product if rng.random() < 0.5 else product * z3.Real(name)
        terms.append(product)
    whole = terms[0]
    for term in terms[1:]:
        whole = whole + term if rng.random() < 0.5 else term + whole
    return whole


@given(MONOMIALS, st.integers(0, 2**32), st.integers(0, 2**32))
def test_a_polynomial_has_one_name(monomials, one, other):
    assert canonical(built(monomials, one)) == canonical(built(monomials, other))


@given(MONOMIALS, MONOMIALS)
def test_two_polynomials_have_two(one, other):
    same = canonical(built(one, 0)) == canonical(built(other, 0))
    assert same == (one == other)


def test_products_are_expanded():
    a, b, c = z3.Reals("a b c")
    assert canonical((a + b) * c) == canonical(c * b + a * c)
    assert canonical((a - b) * (a - b)) == canonical(a * a - 2 * a * b + b * b)


def test_what_does_not_commute_keeps_its_order():
    a, b = z3.Reals("a b")
    p = z3.Bool("p")
    assert canonical(a / b) != canonical(b / a)
    assert canonical(a - b) != canonical(b - a)
    assert canonical(z3.If(p, a, b)) != canonical(z3.If(p, b, a))
    assert canonical(a < b) != canonical(b < a)
    assert canonical(a >= b) == canonical(b <= a)
    assert canonical(z3.And(p, a == b)) == canonical(z3.And(b == a, p))
    assert canonical(z3.Int("a")) != canonical(a)


def test_a_name_that_was_read_once_is_that_of_its_term_alone():
    a, b = z3.Reals("a b")
    names = {canonical(a * number + b) for number in range(2, 200)}  # each term is freed at once
    assert len(names) == 198
    # terms of another context have the same numbers
    other = z3.Context()
    x, y = z3.Real("x", other), z3.Real("y", other)
    foreign = [canonical(x * number + y) for number in range(2, 200)]
    assert len({*names, *foreign}) == 2 * 198
    assert canonical(2 * a + b) == canonical((2 * a + b).translate(other)) != foreign[0]


def test_a_literal_is_of_its_argument_s_type():
    zero, one = SymReal(z3.RealVal(0)), SymReal(z3.RealVal(1))
    assert normal(0, float) == normal(zero, float)
    assert normal(Vec2(0, 1), Vec2) == normal(Vec2(zero, one), Vec2)
    assert normal(0, int) != normal(0, float)


def within(s: Vec2, radius: float, count: int) -> bool:
    """Stands for a function that is not looked into."""
    raise AssertionError(s, radius, count)


def test_equal_arguments_have_one_result():
    x, k = SymReal(z3.Real("x")), SymInt(z3.Int("k"))
    stub = Stub("within", within)
    found = stub(Vec2(x * 2, 0), x + 1, k)
    assert stub(Vec2(x + x, SymReal(z3.RealVal(0))), 1 + x, k) is found
    assert stub(Vec2(x, 0), x + 1, k) is not found
    assert len(stub.calls) == 2
