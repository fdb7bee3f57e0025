"""A number below 0 where it means nothing is refused by the checked readings, never judged."""

from __future__ import annotations

import inspect
from fractions import Fraction

import numpy as np
import pytest

from cratous.core import kernel as kernels
from cratous.core.authority.timeliness import lasted, too_early
from cratous.core.kernel import Vec2
from cratous.core.readings.enclosed import enclosed
from cratous.core.readings.exact import exact, exactly
from cratous.core.readings.exact.certainty import outward_margin
from cratous.core.well_clear import during as well_clear_during
from cratous.core.well_clear import interval as well_clear_interval
from cratous.core.well_clear import now as well_clear_now
from cratous.core.well_clear.thresholds import Thresholds
from cratous.spec.errors import BadInput


@pytest.mark.parametrize("least", [-1, -(2**60)])
def test_of_one_state(least):
    with pytest.raises(BadInput) as caught:
        exact(lasted, 0, 10, least)
    assert (caught.value.where, caught.value.item) == ("lasted", "least")
    assert (caught.value.expected, caught.value.got) == ("0 or more", str(least))
    assert exact(lasted, 0, 10, 0) is True
    assert exact(lasted, -5, -4, 3) is False


def test_of_rationals_and_least_doubles():
    for share in (-5e-324, Fraction(-1, 10**30)):
        with pytest.raises(BadInput, match="share: is below 0"):
            exact(outward_margin, 1.0, share, 0.0)
    assert exact(outward_margin, -1.0, 0.0, 0.0) == 0
    assert exact(outward_margin, -1.0, -0.0, 0.0) == 0


def test_in_an_array_with_its_index():
    at, margin = np.arange(5), np.array([0, 1, 2, -3, -4])
    with pytest.raises(BadInput) as caught:
        exactly(too_early)(at, 3, margin)
    assert (caught.value.item, caught.value.got) == ("margin[3]", "-3")
    assert exactly(too_early)(at, 3, 0).tolist() == [True, True, True, False, False]
    with pytest.raises(BadInput, match="margin: is below 0"):
        exactly(too_early)(at, 3, -1)


def test_in_the_enclosed_reading():
    with pytest.raises(BadInput) as caught:
        enclosed(outward_margin)([1.0, 2.0], [0.5, -0.5], 0.0)
    assert caught.value.item == "share[1]"
    low, high = enclosed(outward_margin)([-1.0, 2.0], 0.5, 0.0)
    assert np.all(low <= [0.5, 1.0])
    assert np.all(high >= [0.5, 1.0])


def test_of_a_record_all_numbers_are_meant():
    state = (Vec2(3000.0, 0.0), Vec2(-60.0, 0.0), 0.0, 0.0)
    for k, name in enumerate(Thresholds._fields):
        limits = [1222.0, 137.0, 35.0, 0.0, 0.0]
        limits[k] = -1.0
        with pytest.raises(BadInput) as caught:
            exact(well_clear_during.violation_during_taumod, *state, Thresholds(*limits), 0.0, 9.0)
        assert (caught.value.item, caught.value.got) == (f"thresholds.{name}", "-1.0")
        columns = [3000.0, 0.0, -60.0, 0.0, 0.0, 0.0, *limits, 0.0, [9.0, 10.0]]
        columns[6 + k] = [1.0, -1.0]
        for reading, function in (
            (exactly, well_clear_during.violation_during_taumod),
            (enclosed, well_clear_interval.violation_times_taumod),
        ):
            with pytest.raises(BadInput) as caught:
                reading(function)(*columns)
            assert caught.value.item == f"thresholds.{name}[1]"


def test_a_name_that_is_no_argument_is_refused():
    before = dict(kernels.REGISTRY)

    def half(a_m: float) -> float:
        return a_m

    with pytest.raises(ValueError, match="half has no argument b_m"):
        kernels.kernel(implements="x.y", nonnegative=("b_m",))(half)
    assert before == kernels.REGISTRY


THRESHOLDS = {"dthr_m", "zthr_m", "tthr_s", "tcoa_s", "vmod_s", "radius_m", "half_height_m"}


def _well_clear_kernels():
    modules = (well_clear_now, well_clear_during, well_clear_interval)
    for entry in list(kernels.REGISTRY.values()):
        if entry.kind == "kernel" and any(entry.function.__module__ == m.__name__ for m in modules):
            names = list(inspect.signature(entry.function).parameters)
            yield from ((entry.function, names, n) for n in names if n in THRESHOLDS)


@pytest.mark.parametrize(
    ("kernel", "names", "threshold"),
    [pytest.param(*row, id=f"{row[0].__name__}-{row[2]}") for row in _well_clear_kernels()],
)
def test_a_threshold_of_well_clear_below_0_has_no_verdict(kernel, names, threshold):
    vectors = {name: kernels.Vec2(1.0, 2.0) for name in ("s", "v") if name in names}
    usual = {name: vectors.get(name, 1.0) for name in names}
    for value in (-1.0, -5e-324, -1):
        with pytest.raises(BadInput) as caught:
            exact(kernel, *{**usual, threshold: value}.values())
        assert (caught.value.where, caught.value.item) == (kernel.__name__, threshold)
