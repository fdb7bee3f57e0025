"""The exact reading: filter, expansions and integers against rationals; what it refuses."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, get_type_hints

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.core import exactly as reading
from cratous.core import expansions, polygon, well_clear
from cratous.core.bounds import UNIT
from cratous.core.compiled import FLAGS, compiled, exact, load
from cratous.core.domain import nonnegative
from cratous.core.exactly import exactly
from cratous.core.filtering import UNDECIDED, filtered
from cratous.core.graph import program
from cratous.core.kernel import Vec2
from cratous.core.nodes import NotInSubset, leaves
from cratous.core.well_clear import horizontal_violation
from cratous.proofs import rounding
from cratous.proofs.claim import Claim
from cratous.proofs.prover import prove
from cratous.spec.errors import BadInput

KERNELS = {
    name: kernel
    for name, (kernel, made) in rounding.filters().items()
    if len(made.results) == 1 and leaves(program(kernel).result)[0].kind != "float"
}


def on_rationals(kernel: Any, columns: list[np.ndarray]) -> list[Any]:
    """The kernel itself on the rationals that the doubles are."""

    def built(kind: Any, row: list[Any]) -> Any:
        if hasattr(kind, "_fields"):
            return kind(*[built(k, row) for k in get_type_hints(kind).values()])
        value = row.pop(0)
        return Fraction(value) if kind is float else value

    hints = [k for n, k in get_type_hints(kernel).items() if n != "return"]
    rows = zip(*[column.tolist() for column in columns], strict=True)
    return [kernel(*[built(k, left) for k in hints]) for left in map(list, rows)]


def states(kernel: Any, kind: str, n: int, seed: int) -> list[np.ndarray]:
    """Columns of one kind for any kernel."""
    rng = np.random.default_rng(seed)
    scale = {"random": 1.0, "grid": 1.0, "subnormal": 5e-324, "tiny": 2.0**-500,
             "huge": 2.0**990, "mixed": 1.0}[kind]  # fmt: skip
    columns = []
    for column in program(kernel).columns:
        if column.kind == "bool":
            columns.append(rng.random(n) < 0.5)
        elif column.kind == "int":
            columns.append(rng.integers(-1, 2, n))
        elif kind == "random":
            columns.append(rng.normal(size=n) * 100)
        elif kind == "mixed":
            columns.append(rng.integers(-3, 4, n) * 2.0 ** rng.integers(-1070, 1020, n))
        else:
            columns.append(rng.integers(-4, 5, n) * scale)
    meant = nonnegative(kernel)
    labels = program(kernel).labels
    return [np.abs(c) if n in meant else c for n, c in zip(labels, columns, strict=True)]


def on_circle(n: int, low: int = -90, high: int = 90) -> list[np.ndarray]:
    """Well-clear states within two units in the last place of the circle |s| = DTHR."""
    rng = np.random.default_rng(5)
    d = rng.uniform(1, 2, n) * 2.0 ** rng.integers(low, high, n)
    angle = rng.uniform(0.01, 0.7, n)
    x, y = d * np.cos(angle), d * np.sin(angle)
    x = (x.view(np.int64) + rng.integers(-2, 3, n)).view(np.float64)
    u, v = rng.normal(size=(2, n)) * 30
    return [x, y, u, v, d, rng.uniform(1, 30, n)]


def on_tau(n: int) -> list[np.ndarray]:
    """States within two units in the last place of tau_mod = TTHR, passing within DTHR."""
    rng = np.random.default_rng(6)
    scale = 2.0 ** rng.integers(-60, 60, n)
    x, y = rng.normal(size=(2, n)) * 1500 * scale
    u, v = -x / rng.uniform(30, 31, n), -y / rng.uniform(30, 31, n)
    d = rng.uniform(100, 1000, n) * scale
    t = (d * d - x * x - y * y) / (x * u + y * v)
    t = (t.view(np.int64) + rng.integers(-2, 3, n)).view(np.float64)
    return [column[t >= 0] for column in (x, y, u, v, d, t)]


def tangent(n: int) -> list[np.ndarray]:
    """Integer states whose course touches the circle exactly: direction (-4, 3), foot k (3, 4)."""
    k, away, speed = np.random.default_rng(7).integers(1, 1000, (3, n)).astype(float)
    return [3 * k + 4 * away, 4 * k - 3 * away, -4 * speed, 3 * speed, 5 * k, np.full(n, 1e6)]


def wide_tangent(n: int) -> list[np.ndarray]:
    """The same with integers of 53 bits: ties that no two doubles hold."""
    k, away, speed = np.random.default_rng(8).integers(2**49, 2**50, (3, n)).astype(float)
    return [3 * k + 4 * away, 4 * k - 3 * away, -4 * speed, 3 * speed, 5 * k, np.full(n, 1e6)]


BOUNDARIES = {
    "on the circle": on_circle,
    "on tau": on_tau,
    "tangent": tangent,
    "tangent, wide": wide_tangent,
}


def undecided(kernel: Any, columns: list[np.ndarray]) -> float:
    """The share of states that the filter leaves open."""
    code = np.empty(columns[0].size, dtype=np.uint8)
    reading._filter_map(reading._filter_of(kernel), frozenset())(code, *columns)
    return float((code == UNDECIDED).mean())


@pytest.mark.parametrize("kind", ["random", "grid", "subnormal", "tiny", "huge", "mixed"])
@pytest.mark.parametrize("name", sorted(KERNELS))
def test_verdicts_are_those_on_rationals(name: str, kind: str) -> None:
    kernel = KERNELS[name]
    columns = states(kernel, kind, 60, seed=len(name))
    assert exactly(kernel)(*columns).tolist() == on_rationals(kernel, columns)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["horizontal_violation", "segments_meet", "violation"])
def test_expansions_are_right(name: str) -> None:
    # more undecided states than the integers take: machine code decides them
    kernel = KERNELS[name]
    columns = states(kernel, "grid", 3000, seed=1)
    rng = np.random.default_rng(2)
    columns = [
        c * 2.0 ** rng.integers(-80, 80, c.size) if k % 3 == 0 and c.dtype == float else c
        for k, c in enumerate(columns)
    ]
    assert exactly(kernel)(*columns).tolist() == on_rationals(kernel, columns)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(BOUNDARIES))
def test_boundaries_of_the_horizontal_volume(name: str) -> None:
    columns = BOUNDARIES[name](2000)
    wanted = on_rationals(horizontal_violation, columns)
    assert exactly(horizontal_violation)(*columns).tolist() == wanted
    assert undecided(horizontal_violation, columns) > 0.5
    if name != "tangent":
        # otherwise the test would show nothing: plain doubles are wrong here
        assert compiled(horizontal_violation)(*columns).tolist() != wanted


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
        pytest.param(n, marks=pytest.mark.slow if n in EVERY_OPERATION else pytest.mark.long)
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
@pytest.mark.parametrize("count", ["sum_left_out(ar, br", "product_left_out(ar, br"])
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
    [("e + 126", "e + 400"), (" + (ONE if low < al else ZERO)", ""), (" + (middle >> HALF)", "")],
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
        caught |= machine(kernel, columns, True, wrong) != wanted
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


@pytest.mark.parametrize(("low", "high"), [(-1020, -950), (960, 1020)])
def test_boundaries_beyond_the_expansions(low: int, high: int) -> None:
    columns = on_circle(300, low, high)
    wanted = on_rationals(horizontal_violation, columns)
    assert exactly(horizontal_violation)(*columns).tolist() == wanted


def test_expansions_and_integers_agree() -> None:
    columns = on_circle(400)
    machine = exactly(horizontal_violation)(*columns)
    single = [exactly(horizontal_violation)(*row) for row in zip(*columns, strict=True)]
    assert machine.tolist() == [bool(value) for value in single]


def test_the_filter_decides_ordinary_states() -> None:
    rng = np.random.default_rng(1)
    n = 20_000
    states_ = [*(rng.normal(size=(2, n)) * 1500), *(rng.normal(size=(2, n)) * 30)]
    limits = [np.full(n, 150.0), np.full(n, 15.0)]
    assert undecided(horizontal_violation, [*states_, *limits]) < 0.001


# -- a filter that promises too much --------------------------------------------------------
def _refuted(made: Any) -> list[str]:
    claim = Claim()
    rounding.bounds(claim, [made])
    theorem = prove("bounds", claim, "bounds")
    return [o.obligation.text for o in theorem.outcomes if o.status == "refuted"]


def test_the_prover_refutes_a_bound_that_is_too_small() -> None:
    assert _refuted(filtered(horizontal_violation)) == []
    assert any("product" in text for text in _refuted(filtered(horizontal_violation, UNIT / 2)))
    signs = _refuted(filtered(horizontal_violation, shrink=0.9))
    assert signs
    assert all("sign" in text for text in signs)


def test_rationals_catch_a_bound_that_is_too_small() -> None:
    columns = on_circle(3000)
    wanted = on_rationals(horizontal_violation, columns)
    careless = exactly(horizontal_violation, filtered(horizontal_violation, shrink=1e-9))
    assert careless(*columns).tolist() != wanted


def test_the_prover_refutes_a_wrong_verdict() -> None:
    made = filtered(horizontal_violation)
    (verdict,) = made.results
    swapped = type(verdict)(verdict.no, verdict.yes)  # type: ignore[union-attr, call-arg]
    claim = Claim()
    wrong = type(made)(made.program, made.terms, (swapped,), made.sure, made.steps, made.compared,
                       made.states)  # fmt: skip
    rounding.verdicts(claim, "wrong", wrong)
    assert not prove("verdicts", claim, "verdicts").proved


def _one_test_for_two(a: float, b: float, c: float, d: float) -> bool:
    """Two comparisons whose difference is one and the same."""
    x = a * b
    y = c * d
    return x <= y or x - y <= 0


def test_one_test_may_stand_for_two_comparisons() -> None:
    claim = Claim()
    rounding.verdicts(claim, "two", filtered(_one_test_for_two))
    assert prove("verdicts", claim, "verdicts").proved


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


# -- input ----------------------------------------------------------------------------------
@pytest.mark.parametrize("bad", [float("nan"), float("inf"), float("-inf")])
@pytest.mark.parametrize("place", range(6))
def test_what_is_not_finite_is_refused(bad: float, place: int) -> None:
    columns = [c.copy() for c in on_circle(200)]
    columns[place][77] = bad
    label = program(horizontal_violation).labels[place]
    with pytest.raises(BadInput, match="finite") as caught:
        exactly(horizontal_violation)(*columns)
    assert caught.value.item == f"{label}[77]"


@pytest.mark.parametrize("name", sorted(KERNELS))
def test_no_column_hides_what_is_not_finite(name: str) -> None:
    kernel = KERNELS[name]
    source = program(kernel)
    for place, column in enumerate(source.columns):
        if column.kind == "float":
            columns: list[Any] = [float(k + 1) if c.kind == "float" else 0 if c.kind == "int" else
                                  False for k, c in enumerate(source.columns)]  # fmt: skip
            columns[place] = float("inf")
            with pytest.raises(BadInput, match=source.labels[place].replace(".", r"\.")):
                exactly(kernel)(*columns)


def test_wrong_columns_are_refused() -> None:
    read = exactly(horizontal_violation)
    with pytest.raises(BadInput, match="wrong number of columns"):
        read(1.0, 2.0)
    with pytest.raises(BadInput, match="one shape"):
        read(np.zeros(2), np.zeros(3), 0.0, 0.0, 1.0, 1.0)
    with pytest.raises(BadInput, match=r"s\.x.*float64"):
        read(2**60 + 1, 0.0, 0.0, 0.0, 1.0, 1.0)
    with pytest.raises(BadInput, match="not of type float"):
        read("1", 0.0, 0.0, 0.0, 1.0, 1.0)
    with pytest.raises(NotInSubset, match="real number"):
        exactly(polygon.orient)


def test_columns_are_broadcast() -> None:
    x = np.linspace(-300, 300, 12).reshape(3, 4)
    got = exactly(horizontal_violation)(x, 0, 0.0, 1.0, 150.0, 15.0)
    assert got.dtype == bool
    assert got.tolist() == (np.abs(x) <= 150).tolist()
    assert exactly(horizontal_violation)(np.empty(0), 0.0, 0.0, 0.0, 1.0, 1.0).shape == (0,)
    assert exactly(horizontal_violation)(1.0, 0.0, 0.0, 0.0, 1.0, 1.0).shape == ()


# -- one state at a time --------------------------------------------------------------------
def test_scalar_form_is_that_on_rationals() -> None:
    for chosen in ("violation_within", "segments_meet", "location_step", "vertical_window"):
        kernel = {**vars(well_clear), **vars(polygon)}[chosen]
        hints = {n: k for n, k in get_type_hints(kernel).items() if n != "return"}
        rng = np.random.default_rng(3)
        for _ in range(60):

            def value(kind: Any, rng: Any = rng) -> Any:
                if hasattr(kind, "_fields"):
                    return kind(*[value(k) for k in get_type_hints(kind).values()])
                return bool(rng.integers(2)) if kind is bool else float(rng.integers(-3, 4))

            meant = nonnegative(kernel)
            made = {name: value(kind) for name, kind in hints.items()}
            args = [abs(arg) if name in meant else arg for name, arg in made.items()]
            wanted = kernel(*[reading._rational(arg) for arg in args])
            got = exact(kernel, *args)
            assert got == wanted
            assert type(got) is type(wanted)


def test_scalar_form_of_a_fold() -> None:
    square = polygon.edges_of([(0.0, 0.0), (0.3, 0.0), (0.3, 0.1), (0.0, 0.1)])
    assert exact(polygon.locate, square, Vec2(0.1, 0.05)) == polygon.INSIDE
    # on the line from (0, 0) to (3, 1), as far as doubles can say
    thin = polygon.edges_of([(0.0, 0.0), (3.0, 1.0), (0.0, 1.0)])
    p = Vec2(0.3, 0.1)
    assert exact(polygon.locate, thin, p) == polygon.locate(
        [tuple(reading._rational(e)) for e in thin], reading._rational(p)
    )
    with pytest.raises(ValueError, match="finite"):
        exact(polygon.locate, square, Vec2(float("nan"), 0.0))
