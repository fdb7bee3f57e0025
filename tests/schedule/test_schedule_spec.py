"""The definitions over instants and the kernels over starts and ends say the same."""

from __future__ import annotations

from functools import reduce

from hypothesis import given
from hypothesis import strategies as st

from cratous.core.schedule import rows as timing
from cratous.spec import schedule

SMALL = st.integers(-6, 6)
INSTANTS = range(-30, 31)
KIND = st.integers(0, 7)


@given(KIND, SMALL, st.integers(0, 6), SMALL, SMALL, SMALL)
def test_row_holds_at_every_instant(kind, start, length, ref, lo, hi):
    end = start + length
    by_instants = all(schedule.row_holds(t, kind, start, end, ref, lo, hi) for t in INSTANTS)
    assert timing.row_holds(kind, start, end, ref, lo, hi) == by_instants


@given(SMALL, SMALL)
def test_interval_is_ordered(start, end):
    by_instants = any(
        all(schedule.interval_is_ordered(t, u, start, end) for u in INSTANTS) for t in INSTANTS
    )
    assert timing.runs_forward(start, end) == by_instants


@given(st.integers(-(2**63), 2**63 - 1), st.integers(0, 63))
def test_vehicle_is_eligible(mask, number):
    bit = 1 << number
    by_members = any(schedule.vehicle_is_eligible(k, mask, bit) for k in range(64))
    assert timing.eligible(mask, bit) == by_members


@given(st.booleans(), KIND, SMALL, SMALL, SMALL, SMALL, SMALL)
def test_one_step_of_the_schedule_checker(ok, kind, start, end, ref, lo, hi):
    row = schedule.Timed(kind, start, end, ref, lo, hi)
    by_instants = any(
        all(schedule.rows_hold_step(t, u, ok, row) for u in INSTANTS) for t in INSTANTS
    )
    assert timing.schedule_step(ok, kind, start, end, ref, lo, hi) == by_instants


ROW = st.tuples(
    KIND.filter(lambda k: 1 <= k <= 6), st.integers(0, 6), st.integers(0, 6), SMALL, SMALL, SMALL
)


@given(st.lists(ROW, max_size=3))
def test_the_schedule_holds_iff_each_row_does(rows):
    items = [
        (kind, start, start + length, ref, lo, hi) for kind, start, length, ref, lo, hi in rows
    ]
    by_instants = all(
        any(all(schedule.all_rows_hold(t, u, *item) for u in INSTANTS) for t in range(13))
        for item in items
    )
    assert timing.schedule_holds(items) == by_instants


@given(SMALL, SMALL)
def test_later_and_earlier(a, b):
    later, earlier = timing.later(a, b), timing.earlier(a, b)
    assert all((t <= later) == schedule.later_of(t, a, b) for t in INSTANTS)
    assert all((t >= earlier) == schedule.earlier_of(t, a, b) for t in INSTANTS)


@given(st.lists(SMALL, min_size=1, max_size=6))
def test_later_and_earlier_fold_to_the_ends_of_a_composite(values):
    assert reduce(timing.later, values) == max(values)
    assert reduce(timing.earlier, values) == min(values)


@given(
    st.lists(st.tuples(SMALL, st.integers(0, 4)), min_size=1, max_size=4), SMALL, st.integers(0, 4)
)
def test_latest_end_stands_for_every_task_of_the_group(group, start, length):
    """Order after a group means: no instant of the task before an instant of any of the group."""
    intervals = [(s, s + n) for s, n in group]
    ref = max(end for _, end in intervals)
    by_pairs = all(
        t >= u
        for s, e in intervals
        for t in INSTANTS
        for u in INSTANTS
        if schedule.runs_at(t, start, start + length) and schedule.runs_at(u, s, e)
    )
    assert timing.row_holds(schedule.AFTER_END, start, start + length, ref, 0, 0) == by_pairs


def test_times_below_the_limit_add_up_in_64_bits():
    largest = schedule.TIME_LIMIT_MS - 1
    assert largest + largest < 2**63
    assert -largest - largest >= -(2**63)


def test_each_kernel_names_a_definition_that_exists():
    from cratous.core.kernel import REGISTRY

    ours = [e for e in REGISTRY.values() if e.implements.startswith("schedule.")]
    assert len(ours) >= 7
    for entry in ours:
        assert callable(getattr(schedule, entry.implements.removeprefix("schedule.")))
