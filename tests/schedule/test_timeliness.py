"""Kernels of time and right of way against their definitions, instant by instant."""

from __future__ import annotations

from itertools import pairwise, product

from hypothesis import given
from hypothesis import strategies as st

from cratous.core.authority.gate import handback
from cratous.core.authority.right_of_way import must_act
from cratous.core.authority.timeliness import beats_in_time, in_time, lasted, too_early
from cratous.spec.authority import gate as authority
from cratous.spec.authority import right_of_way, timeliness

SMALL = st.integers(-8, 8)
SPAN = st.integers(0, 8)
INSTANTS = range(-40, 41)


@given(SMALL, SMALL, SPAN)
def test_in_time_at_every_instant(last, now, bound):
    assert in_time(last, now, bound) == all(
        timeliness.in_time(t, last, now, bound) for t in {*INSTANTS, now}
    )


@given(SMALL, SPAN, SPAN)
def test_lasted_at_every_instant(since, length, least):
    now = since + length
    assert lasted(since, now, least) == all(
        timeliness.lasted(t, since, now, least) for t in INSTANTS
    )


@given(SMALL, SMALL, SPAN)
def test_too_early_at_every_instant(at, planned, margin):
    assert too_early(at, planned, margin) == all(
        timeliness.too_early(t, at, planned, margin) for t in INSTANTS
    )


@given(st.lists(SPAN, max_size=6), SPAN)
def test_heartbeats_are_in_time_iff_no_gap_is_too_long(gaps, bound):
    times = [0]
    for gap in gaps:
        times.append(times[-1] + gap)
    items = [(time,) for time in times[1:]]
    assert beats_in_time(items, bound) == all(b - a <= bound for a, b in pairwise(times))


def test_a_heartbeat_of_the_past_is_not_in_time():
    assert beats_in_time([(500,), (1000,)], 1000)
    assert not beats_in_time([(1000,), (500,)], 1000)
    assert not in_time(1000, 500, 1000)


TIMES = st.integers(0, 6)


@given(st.tuples(TIMES, TIMES, TIMES, TIMES, st.booleans(), st.booleans(), st.booleans()))
def test_who_must_act(state):
    assert must_act(*state) == right_of_way.must_act(*state)


def test_every_state_of_the_handback():
    for state in product((False, True), repeat=4):
        assert handback(*state) == authority.handback(*state)
    assert handback(True, False, True, True) == authority.WITHDRAW
    assert handback(False, True, True, False) == authority.KEEP
