"""Bands made of the cells of a grid."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cratous.core.daa.bands import merged
from cratous.core.daa.state import Band


def _merged_one_by_one(edges, cells, low, high):
    bands: list[Band] = []
    for a, b, region in zip(edges[:-1], edges[1:], cells, strict=True):
        a, b = max(a, low), min(b, high)
        if a < b and bands and bands[-1].region == region:
            bands[-1] = bands[-1]._replace(high=b)
        elif a < b:
            bands.append(Band(a, b, region))
    return bands


@given(
    st.lists(st.integers(-8, 8), min_size=1, max_size=9, unique=True),
    st.data(),
    st.integers(-9, 9) | st.just(-math.inf),
    st.integers(-9, 9) | st.just(math.inf),
)
def test_neighbouring_cells_of_one_colour_are_one_band(places, data, low, high):
    edges = sorted(float(place) for place in places)
    size = len(edges) - 1
    cells = data.draw(st.lists(st.integers(0, 3), min_size=size, max_size=size))
    found = merged(np.array(edges), np.array(cells, dtype=np.int64), low, high)
    assert found == _merged_one_by_one(edges, cells, low, high)
    assert all(
        type(value) is kind
        for b in found
        for value, kind in zip(b, (float, float, int), strict=True)
    )
