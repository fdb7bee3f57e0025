"""The compiled reading: every element is what CPython computes on doubles."""

from __future__ import annotations

import math
from typing import Any, get_type_hints

import numpy as np
import pytest

from cratous.core.kernel import REGISTRY
from cratous.core.ledger import load_all
from cratous.core.readings.exact import exactly
from cratous.core.readings.graph import program
from cratous.core.readings.graph.nodes import NotInSubset, leaves
from cratous.core.readings.machine.compiled import compiled
from cratous.core.well_clear import horizontal_violation, vertical_violation
from cratous.spec.errors import BadInput

load_all()
SINGLE = sorted(
    name
    for name, entry in REGISTRY.items()
    if entry.kind == "kernel"
    and entry.function.__module__.startswith("cratous.core.")
    and len(leaves(program(entry.function).result)) == 1
    and get_type_hints(entry.function)["return"] in (bool, int, float)
)
ODD = [0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, 1e308, -1e308, math.inf, -math.inf, math.nan]


def on_cpython(kernel: Any, columns: list[np.ndarray]) -> list[Any]:
    """The kernel itself, state by state."""

    def built(kind: Any, row: list[Any]) -> Any:
        if hasattr(kind, "_fields"):
            return kind(*[built(k, row) for k in get_type_hints(kind).values()])
        return row.pop(0)

    hints = [k for n, k in get_type_hints(kernel).items() if n != "return"]
    rows = map(list, zip(*[column.tolist() for column in columns], strict=True))

    def run(row: list[Any]) -> Any:
        try:
            return kernel(*[built(k, row) for k in hints])
        except ZeroDivisionError:
            return None

    return [run(row) for row in rows]


def columns_of(kernel: Any, odd: bool) -> list[np.ndarray]:
    """Random columns; with infinities, NaN and signed zeros among them if odd."""
    rng = np.random.default_rng(4)
    made: list[np.ndarray] = []
    for column in program(kernel).columns:
        if column.kind == "float":
            values = rng.choice(np.array(ODD), 400) if odd else rng.normal(size=400) * 100
            made.append(np.where(rng.random(400) < 0.5, values, rng.integers(-3, 4, 400)))
        elif column.kind == "int":
            made.append(rng.integers(-3, 4, 400))
        else:
            made.append(rng.random(400) < 0.5)
    return made


@pytest.mark.parametrize("odd", [False, True])
@pytest.mark.parametrize("name", SINGLE)
def test_every_element_is_cpythons(name: str, odd: bool) -> None:
    kernel = REGISTRY[name].function
    columns = columns_of(kernel, odd)
    wanted = on_cpython(kernel, columns)
    defined = np.array([value is not None for value in wanted])
    assert defined.sum() > 200
    got = compiled(kernel)(*[column[defined] for column in columns]).tolist()
    wanted = [value for value in wanted if value is not None]
    # as text, so that signed zeros count and NaN equals NaN
    pairs = zip(got, wanted, strict=True)
    wrong = [(g, w) for g, w in pairs if repr(float(g)) != repr(float(w))]
    assert not wrong


def ratio(x: float, y: float) -> float:
    """A quotient, or 0 where there is none."""
    if y == 0:
        return 0
    return x / y


def test_a_kernel_with_a_division_is_compiled_from_its_source() -> None:
    x, y = np.array([1.0, 2.0, 3.0]), np.array([4.0, 0.0, -0.5])
    assert compiled(ratio)(x, y).tolist() == [0.25, 0.0, -6.0]


def test_single_values_are_not_spread_out() -> None:
    x = np.linspace(-9, 9, 7)
    spread = compiled(horizontal_violation)(x, x, x, -x, np.full(7, 4.0), np.full(7, 2.0))
    assert compiled(horizontal_violation)(x, x, x, -x, 4.0, 2.0).tolist() == spread.tolist()
    assert compiled(vertical_violation)(1.0, 0.0, 2.0, 0.0).shape == ()


def test_columns_are_checked() -> None:
    with pytest.raises(BadInput, match="wrong number of columns"):
        compiled(vertical_violation)(1.0)
    with pytest.raises(BadInput, match="one shape"):
        compiled(vertical_violation)(np.zeros(2), np.zeros(3), 1.0, 1.0)


def looped(x: float) -> bool:
    """Not in the subset."""
    while x > 1:
        x = x - 1
    return x > 0


def test_what_has_no_graph_says_where() -> None:
    with pytest.raises(NotInSubset, match=r"looped, line 3 of it: While is not in the subset"):
        program(looped)


@pytest.mark.parametrize("reading", [compiled, exactly])
def test_results_can_be_written_into_an_array(reading: Any) -> None:
    x = np.linspace(-9, 9, 7)
    out = np.ones(7, dtype=bool)
    got = reading(vertical_violation)(x, 0.0, 5.0, 0.0, out=out)
    assert got.base is out or got is out
    assert out.tolist() == (np.abs(x) <= 5).tolist()
    for wrong in (np.ones(6, dtype=bool), np.ones(7), np.ones(14, dtype=bool)[::2]):
        with pytest.raises(BadInput, match="out does not fit"):
            reading(vertical_violation)(x, 0.0, 5.0, 0.0, out=wrong)
