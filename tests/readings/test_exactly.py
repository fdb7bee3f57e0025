"""The exact reading: filter, expansions and integers against rationals; what it refuses."""

from __future__ import annotations

from typing import Any, get_type_hints

import numpy as np
import pytest
from exact_states import BOUNDARIES, KERNELS, on_circle, on_rationals, states, undecided

from cratous.core import well_clear
from cratous.core.geofence import planar
from cratous.core.kernel import Vec2
from cratous.core.readings import exact as reading
from cratous.core.readings.exact import exact, exactly
from cratous.core.readings.exact.error_bounds import UNIT
from cratous.core.readings.exact.float_filter import filtered
from cratous.core.readings.graph import program
from cratous.core.readings.graph.nodes import NotInSubset
from cratous.core.readings.machine.compiled import compiled
from cratous.core.readings.machine.domain import nonnegative
from cratous.core.well_clear import horizontal_violation
from cratous.proofs.claim import Claim
from cratous.proofs.engine.prover import prove
from cratous.proofs.methods import rounding
from cratous.spec.errors import BadInput


@pytest.mark.parametrize("kind", ["random", "grid", "subnormal", "tiny", "huge", "mixed"])
@pytest.mark.parametrize("name", sorted(KERNELS))
def test_verdicts_are_those_on_rationals(name: str, kind: str) -> None:
    kernel = KERNELS[name]
    columns = states(kernel, kind, 60, seed=len(name))
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
    numbers = [float(k + 1) if c.kind == "float" else 0 if c.kind == "int" else False
               for k, c in enumerate(source.columns)]  # fmt: skip
    # with columns of one number another loop is compiled, and asks what is finite as this one does
    alone = kernel is horizontal_violation
    for place, column in enumerate(source.columns):
        if column.kind == "float":
            columns: list[Any] = [np.array([number, number]) for number in numbers]
            columns[place][1] = np.inf
            label = source.labels[place].replace(".", r"\.")
            with pytest.raises(BadInput, match=rf"{label}\[1\]"):
                exactly(kernel)(*columns)
            if alone:
                columns = [*numbers[:place], np.inf, *numbers[place + 1 :]]
                with pytest.raises(BadInput, match=label):
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
        exactly(planar.orient)


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
        kernel = {**vars(well_clear), **vars(planar)}[chosen]
        hints = {n: k for n, k in get_type_hints(kernel).items() if n != "return"}
        rng = np.random.default_rng(3)
        for _ in range(60):

            def value(kind: Any, rng: Any = rng) -> Any:
                if hasattr(kind, "_fields"):
                    return kind(*[value(k) for k in get_type_hints(kind).values()])
                return bool(rng.integers(2)) if kind is bool else float(rng.integers(-3, 4))

            meant = nonnegative(kernel)
            made = {name: value(kind) for name, kind in hints.items()}

            def at_least_0(arg: Any) -> Any:
                return type(arg)(*map(abs, arg)) if isinstance(arg, tuple) else abs(arg)

            args = [at_least_0(arg) if name in meant else arg for name, arg in made.items()]
            wanted = kernel(*[reading._rational(arg) for arg in args])
            got = exact(kernel, *args)
            assert got == wanted
            assert type(got) is type(wanted)


def test_scalar_form_of_a_fold() -> None:
    square = planar.edges_of([(0.0, 0.0), (0.3, 0.0), (0.3, 0.1), (0.0, 0.1)])
    assert exact(planar.locate, square, Vec2(0.1, 0.05)) == planar.INSIDE
    # on the line from (0, 0) to (3, 1), as far as doubles can say
    thin = planar.edges_of([(0.0, 0.0), (3.0, 1.0), (0.0, 1.0)])
    p = Vec2(0.3, 0.1)
    assert exact(planar.locate, thin, p) == planar.locate(
        [tuple(reading._rational(e)) for e in thin], reading._rational(p)
    )
    with pytest.raises(ValueError, match="finite"):
        exact(planar.locate, square, Vec2(float("nan"), 0.0))
