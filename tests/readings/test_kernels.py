"""Kernels in their readings: run against the definitions, exact, and compiled."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core import well_clear
from cratous.core.authority import gate
from cratous.core.geofence import planar
from cratous.core.kernel import REGISTRY, Vec2, entry_of, kernel, named
from cratous.core.ledger import load_all
from cratous.core.readings.exact import exact
from cratous.core.readings.machine.compiled import compiled
from cratous.core.schedule import rows as timing
from cratous.spec import geofence
from cratous.spec import well_clear as meaning
from cratous.spec.errors import BadInput

load_all()
small = st.integers(-6, 6).map(Fraction)
positive = st.integers(0, 6).map(Fraction)
vectors = st.tuples(small, small).map(lambda t: Vec2(*t))


@given(vectors, vectors, positive, positive)
def test_horizontal_violation_is_the_definition(s, v, dthr, tthr):
    wanted = meaning.horizontal_violation(s, v, dthr, tthr)
    assert well_clear.horizontal_violation(s, v, dthr, tthr) == wanted


@given(small, small, positive, positive)
def test_vertical_violation_is_the_definition(sz, vz, zthr, tcoa):
    wanted = meaning.vertical_violation(sz, vz, zthr, tcoa)
    assert well_clear.vertical_violation(sz, vz, zthr, tcoa) == wanted


@settings(max_examples=200)
@given(vectors, vectors, small, small, st.tuples(*[positive] * 4), positive)
def test_violation_within_covers_every_instant(s, v, sz, vz, sizes, h):
    limits = well_clear.StandardThresholds(*sizes)
    predicted = well_clear.violation_within(s, v, sz, vz, limits, h)
    instants = [h * k / 24 for k in range(25)]
    seen = any(meaning.violation_at(s, v, sz, vz, limits, t) for t in instants)
    assert predicted or not seen


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize(
    ("point", "wanted"),
    [
        ((2, 2), 1), ((0, 0), 0), ((2, 0), 0), ((4, 4), 0), ((5, 2), -1), ((-1, 4), -1),
        ((-1, 0), -1), ((2, 3), 0), ((2, Fraction(7, 2)), -1), ((1, Fraction(7, 2)), 0),
    ],
)  # fmt: skip
def test_locate_in_a_polygon_with_a_notch(point, wanted, clockwise):
    vertices = [(0, 0), (4, 0), (4, 4), (2, 3), (0, 4)]
    if clockwise:
        vertices.reverse()
    assert planar.locate(planar.edges_of(vertices), Vec2(*point)) == wanted


@given(vectors, vectors, vectors, vectors)
def test_segments_meet_is_symmetric_and_sees_shared_ends(p, q, a, b):
    assert planar.segments_meet(p, q, a, b) == planar.segments_meet(b, a, q, p)
    assert planar.segments_meet(p, q, q, b)


@given(vectors, vectors, vectors, st.integers(0, 8))
def test_points_of_a_segment_are_on_it(a, b, p, k):
    at = geofence.along(a, b, Fraction(k, 8))
    assert planar.on_segment(Vec2(*at), a, b)


def test_exact_reading_decides_where_doubles_cannot():
    # the point lies just off the edge; on doubles the orientation rounds to zero
    a, b = Vec2(0.0, 0.0), Vec2(1e16, 1.0)
    p = Vec2(1.0, 1e-16 + 1e-30)
    assert exact(planar.orient, a, b, p) != 0
    square = planar.edges_of([(0.0, 0.0), (0.3, 0.0), (0.3, 0.1), (0.0, 0.1)])
    assert exact(planar.locate, square, Vec2(0.1, 0.05)) == 1


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_exact_reading_refuses_what_is_not_finite(bad):
    with pytest.raises(ValueError, match=r"not finite|NaN"):
        exact(well_clear.vertical_violation, bad, 1.0, 1.0, 1.0)


def test_compiled_reading_equals_cpython():
    rng = np.random.default_rng(7)
    s, v = rng.normal(size=(2, 2000)) * 400, rng.normal(size=(2, 2000)) * 25
    sz, vz = rng.normal(size=(2, 2000)) * np.array([[60], [3]])
    limits = well_clear.StandardThresholds(150.0, 30.0, 15.0, 5.0)
    got = compiled(well_clear.violation_within)(*s, *v, sz, vz, *limits, 60.0)
    rows = zip(*(x.tolist() for x in (*s, *v, sz, vz)), strict=True)
    wanted = [
        well_clear.violation_within(Vec2(a, b), Vec2(c, d), e, f, limits, 60.0)
        for a, b, c, d, e, f in rows
    ]
    assert got.tolist() == wanted
    assert 0 < got.sum() < got.size


def test_gate_hands_back_only_on_the_first_command_of_the_new_epoch():
    first = gate.Gate(gate.UXAS, 0, False)
    taken = gate.gate_takeover(first)
    assert not gate.gate_accepts(taken, gate.UXAS, 0)
    assert gate.gate_accepts(taken, gate.ICAROUS, 1)
    offered = gate.gate_offer(taken)
    assert gate.gate_after(offered, gate.UXAS, 1) == offered
    back = gate.gate_after(offered, gate.UXAS, 2)
    assert back == gate.Gate(gate.UXAS, 2, False)
    assert not gate.gate_accepts(back, gate.ICAROUS, 2)


def test_schedule_checker_needs_every_row():
    rows = [(5, 10, 20, 0, 5, 0), (6, 10, 20, 0, 0, 20), (1, 10, 20, 10, 0, 0)]
    assert timing.schedule_holds(rows)
    assert not timing.schedule_holds([*rows, (6, 10, 20, 0, 0, 19)])
    assert not timing.schedule_holds([(5, 20, 10, 0, 0, 0)])
    assert timing.schedule_holds([])


def test_two_kernels_of_one_qualified_name_are_refused():
    before = dict(REGISTRY)

    def made(shift: int):
        def moved(value: int) -> int:
            """value, moved."""
            return value + 1 if shift else value - 1

        return moved

    def moved(value: int) -> int:
        """Another text of the name."""
        return value

    first = made(0)
    moved.__qualname__ = first.__qualname__
    try:
        kernel(implements="schedule.later_of")(first)
        kernel(implements="schedule.later_of")(made(0))  # the same text, read again
        with pytest.raises(BadInput, match="two functions are registered under one name"):
            kernel(implements="schedule.later_of")(moved)
    finally:
        REGISTRY.clear()
        REGISTRY.update(before)


def test_a_kernel_is_found_by_the_end_of_its_name():
    assert named("later").function is timing.later
    assert (
        named("rows.later") is named("cratous.core.schedule.rows.later") is entry_of(timing.later)
    )
    with pytest.raises(
        BadInput, match=r"no such kernel; expected .*cratous.core.schedule.rows.later"
    ):
        named("latter")

    def later(best: int, value: int) -> int:
        """Another kernel of this bare name."""
        return best

    assert entry_of(later) is None
    before = dict(REGISTRY)
    try:
        assert entry_of(kernel(implements="schedule.later_of")(later)) is not None
        with pytest.raises(BadInput, match="several kernels"):
            named("later")
    finally:
        REGISTRY.clear()
        REGISTRY.update(before)
