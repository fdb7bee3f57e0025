"""A number below 0 where it means nothing is refused by the checked readings, never judged."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from cratous.core import kernel as kernels
from cratous.core.certainty import outward_margin
from cratous.core.compiled import exact
from cratous.core.enclosed import enclosed
from cratous.core.exactly import exactly
from cratous.core.timeliness import lasted, too_early
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


def test_a_name_that_is_no_argument_is_refused():
    before = dict(kernels.REGISTRY)

    def half(a_m: float) -> float:
        return a_m

    with pytest.raises(ValueError, match="half has no argument b_m"):
        kernels.kernel(implements="x.y", nonnegative=("b_m",))(half)
    assert before == kernels.REGISTRY
