"""The exact reading's machine code: pairs, residues and expansions against rationals, one by one."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from exact_states import BOUNDARIES, KERNELS, on_circle, on_rationals, states, wide_tangent
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.readings import exact as reading
from cratous.core.readings.exact import exactly, expansions
from cratous.core.readings.exact.float_filter import UNDECIDED
from cratous.core.readings.graph.nodes import leaves
from cratous.core.readings.machine.compiled import FLAGS, load
from cratous.core.well_clear import horizontal_violation


@pytest.mark.slow
@pytest.mark.parametrize("name", ["horizontal_violation", "segments_meet", "violation"])
def test_expansions_are_right(name: str) -> None:
    # more undecided states than the integers take: machine code decides them
    (kernel,) = (k for n, k in KERNELS.items() if n.rpartition(".")[2] == name)
    columns = states(kernel, "grid", 3000, seed=1)
    rng = np.random.default_rng(2)
    columns = [
        c * 2.0 ** rng.integers(-80, 80, c.size) if k % 3 == 0 and c.dtype == float else c
        for k, c in enumerate(columns)
    ]
    assert exactly(kernel)(*columns).tolist() == on_rationals(kernel, columns)


def machine(kernel: Any, columns: list[np.ndarray], pairs_too: bool, shared: str) -> list[Any]:
    """The verdicts of machine code alone, for every state."""
    found = reading._filter_of(kernel)
    made = expansions.text(found, frozenset(), FLAGS, load(shared).__name__, pairs_too)
    assert made is not None
    code = np.ones(columns[0].size, dtype=np.uint8)
    truth = leaves(found.program.result)[0].kind == "bool"
    out = code if truth else np.ones(code.size, dtype=np.int64)
    work, lengths = np.zeros(made[1]), np.ones(made[2], dtype=np.int64)
    load(made[0])._map(out, code, np.arange(code.size), work, lengths, *columns)
    assert code.max(initial=0) < UNDECIDED
    return out.tolist()


def near_ties(kernel: Any, n: int) -> list[np.ndarray]:
    """Small integers at scales of their own, some a unit or two in the last place away."""
    rng = np.random.default_rng(len(kernel.__name__))
    scale = 2.0 ** rng.integers(-20, 20, n)
    found = []
    for k, column in enumerate(states(kernel, "grid", n, seed=3)):
        if column.dtype == float:
            # one scale for all of a state, mostly
            column = column * np.where(rng.random(n) < 0.9, scale, scale * 2.0**-k)
            column = column * (1 + rng.integers(-1, 2, n) * (rng.random(n) < 0.2) * 2.0**-51)
        found.append(column)
    return found


# absolute values, the greater, choices, a choice that hangs on a sign, and an integer as result
EVERY_OPERATION = ("layer_violation", "violation_tcpa", "square_left_of", "repels", "edge_against")


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(
            n,
            marks=pytest.mark.slow if n.rpartition(".")[2] in EVERY_OPERATION else pytest.mark.long,
        )
        for n in sorted(KERNELS)
    ],
)
def test_machine_code_decides_as_rationals_do(name: str) -> None:
    kernel = KERNELS[name]
    columns = near_ties(kernel, 400)
    assert machine(kernel, columns, True, reading.SHARED) == on_rationals(kernel, columns)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(BOUNDARIES))
def test_expansions_alone_and_behind_pairs_are_right(name: str) -> None:
    columns = BOUNDARIES[name](1000)
    wanted = on_rationals(horizontal_violation, columns)
    for pairs_too in (False, True):
        assert machine(horizontal_violation, columns, pairs_too, reading.SHARED) == wanted


@pytest.mark.slow
@pytest.mark.parametrize(
    "count",
    ["sum_left_out(ar, br", pytest.param("product_left_out(left, c, d", marks=pytest.mark.long)],
)
def test_rationals_catch_pairs_that_forget_what_they_left_out(count: str) -> None:
    columns = wide_tangent(300)
    wanted = on_rationals(horizontal_violation, columns)
    assert count in reading.SHARED
    shared = reading.SHARED.replace(count, f"0.0 * {count}")
    assert machine(horizontal_violation, columns, True, shared) != wanted


def _nearly_even(a: float, b: float, c: float, d: float, e: float) -> bool:
    """Products that are equal, and something far below them."""
    return a * a * (b * b) - c * c * (d * d) + e * e * (e * e) > 0


@pytest.mark.slow
@pytest.mark.parametrize(
    "careless",
    [
        ("e + 126", "e + 400"),
        # each of these compiles all of it anew
        pytest.param((" + (ONE if low < al else ZERO)", ""), marks=pytest.mark.long),
        pytest.param((" + (middle >> HALF)", ""), marks=pytest.mark.long),
    ],
)
def test_rationals_catch_careless_residues(careless: tuple[str, str]) -> None:
    rng = np.random.default_rng(9)
    a, b, e = rng.uniform(1, 2, (3, 200))
    cases = [(horizontal_violation, wide_tangent(200)), (_nearly_even, [a, b, a, b, e * 2.0**-60])]
    assert careless[0] in reading.SHARED
    wrong = reading.SHARED.replace(*careless)
    caught = False
    for kernel, columns in cases:
        wanted = on_rationals(kernel, columns)
        assert machine(kernel, columns, True, reading.SHARED) == wanted
        # one that catches it will do: the other need not be compiled
        caught = caught or machine(kernel, columns, True, wrong) != wanted
    assert caught


WORDS = st.integers(-(2**126), 2**126)


@pytest.mark.slow
@given(a=WORDS, b=WORDS, m=st.integers(-300, 300), n=st.integers(-300, 300), x=st.floats(
    allow_nan=False, allow_infinity=False, allow_subnormal=False))  # fmt: skip
def test_residues_are_those_of_integers(a: int, b: int, m: int, n: int, x: float) -> None:
    made = load(reading.SHARED)

    def words(value: int, exponent: int) -> tuple[Any, Any, int]:
        return np.uint64(value >> 64 & 2**64 - 1), np.uint64(value & 2**64 - 1), exponent

    def value(found: tuple[int, int, int]) -> int:
        return (int(found[0]) << 64) + int(found[1])

    one, other = words(a, m), words(b, n)
    least = min(m, n)
    total = made.sum_of_residues(*one, *other)
    assert total[2] == least
    assert (value(total) - (a << m - least) - (b << n - least)) % 2**128 == 0
    product = made.product_of_residues(*one, *other)
    assert product[2] == m + n
    assert (value(product) - a * b) % 2**128 == 0
    assert (value(made.negative_residue(*one)) + a) % 2**128 == 0
    alone = made.residue(x)
    signed = value(alone) - (2**128 if value(alone) >> 127 else 0)
    assert signed == 0 == x or Fraction(signed) * Fraction(2) ** alone[2] == Fraction(x)
    size = float(abs(a) or 1)
    assert made.sign_of_residue(*words(a, 0), size) in ((a > 0) - (a < 0), 2)
    assert made.sign_of_residue(*words(a, 0), 2.0**126) == 2


def test_nothing_is_fused() -> None:
    columns = on_circle(300)
    exactly(horizontal_violation)(*columns)
    found = reading._filter_of(horizontal_violation)
    made = reading._expansion_map(found, frozenset())
    assert made is not None
    plain = reading._filter_map(found, frozenset())
    for function in (made[0], plain):
        options = {k: v for k, v in function.targetoptions.items() if k != "nopython"}
        fresh = function.py_func.__globals__["njit"](**options)(function.py_func)
        if function is plain:
            fresh(np.empty(300, dtype=np.uint8), *columns)
        else:
            code = np.ones(300, dtype=np.uint8)
            work, lengths = np.zeros(made[1]), np.ones(made[2], dtype=np.int64)
            fresh(code, code, np.arange(300), work, lengths, *columns)
        texts = list(fresh.inspect_asm().values())
        assert len(texts) == 1
        assert "mul" in texts[0]
        assert "vfmadd" not in texts[0]
        assert "vfmsub" not in texts[0]
        assert "vfnmadd" not in texts[0]
