"""The status of kernels and drivers: what it rests on, and that nothing claims more."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cratous.core import ledger
from cratous.core.assignment import earliest_times
from cratous.core.assignment.earliest_times import Times, Unmet, Visit, earliest, keeps
from cratous.core.kernel import REGISTRY, Entry, Refusal
from cratous.core.ledger import records, status
from cratous.core.schedule.rows import runs_forward, schedule_holds
from cratous.proofs.statements.rechecked import rechecked_by
from cratous.spec.constraint_rows import AFTER_END, Row
from cratous.spec.errors import Refused

FORWARD = "cratous.core.schedule.rows.runs_forward"
HOLDS = "cratous.core.schedule.rows.schedule_holds"


class Found(NamedTuple):
    end: int


class Nothing(NamedTuple):
    why: str


@dataclass(frozen=True)
class Unfit(Refusal):
    why: str


class Loose:
    end: int


def _entry(function: Callable[..., Any]) -> Entry:
    return Entry("pkg.search", "driver", "", function, ("runs_forward",))


# -- drivers whose output is re-checked ------------------------------------------------------------
def where_it_holds(x: int) -> int | None:
    found = x + 1
    if runs_forward(0, found):
        return found
    return None


def refuses_first(x: int) -> Found:
    found = Found(x)
    if not runs_forward(0, found.end):
        raise ValueError("no")
    return found


def the_first_of_several(items: tuple[int, ...]) -> int | None:
    for item in items:
        if runs_forward(0, item):
            return item
    return None


def with_a_refusal(x: int) -> tuple[int, int] | Unfit:
    found = x + 1
    if x < 0 or not runs_forward(0, found):
        return Unfit(str(x))
    return found, x


def of_rows(items: tuple[tuple[int, int, int, int, int, int], ...]) -> tuple[int, ...] | None:
    found = tuple(sum(item) for item in items)
    if found and schedule_holds([(1, f, f, 0, 0, 0) for f in found]):
        return found
    return None


# -- drivers whose output is not -------------------------------------------------------------------
def unchecked(x: int) -> int:
    runs_forward(0, x)
    return x + 1


def another_value(x: int) -> int | None:
    found = x + 1
    if runs_forward(0, found):
        return found + 1
    return None


def changed_since(x: int) -> int | None:
    found = x + 1
    if runs_forward(0, found):
        found -= 9
        return found
    return None


def on_one_way(x: int) -> int:
    found = x + 1
    if x > 3 and not runs_forward(0, found):
        raise ValueError("no")
    return found


def denied(x: int) -> int | None:
    found = x + 1
    if runs_forward(0, found):
        return None
    return found


def either(x: int) -> int | None:
    found = x + 1
    if runs_forward(0, found) or x > 3:
        return found
    return None


def a_constant() -> bool:
    return runs_forward(0, 1) and True


def says_yes(x: int) -> bool:
    said = runs_forward(0, x)
    if said:
        return True
    return x < 0


def can_be_changed(x: int) -> list[int] | None:
    found = [x]
    if runs_forward(0, found[0]):
        return found
    return None


def can_be_changed_too(x: int) -> Loose | None:
    found = Loose()
    if runs_forward(0, found.end):
        return found
    return None


def of_unknown_type(x: int):  # type: ignore[no-untyped-def]
    found = x + 1
    if runs_forward(0, found):
        return found
    return None


def by_its_own_judge(x: int, runs_forward: Callable[[int, int], bool]) -> int | None:
    found = x + 1
    if runs_forward(0, found):
        return found
    return None


def in_the_next_round(items: tuple[int, ...]) -> int | None:
    best = 0
    for item in items:
        if runs_forward(0, best):
            best = item
    return best


def another_is_asked(x: int) -> int | None:
    found, other = x + 1, x + 2
    if runs_forward(0, other):
        return found
    return None


def a_record_that_claims(x: int) -> Found | Nothing:
    found = Found(x)
    if runs_forward(0, found.end):
        return found
    return Nothing(str(x))


def changed_by_an_inner_function(x: int) -> int | None:
    found = x + 1

    def change() -> None:
        nonlocal found
        found = -9

    if not runs_forward(0, found):
        return None
    change()
    return found


def bound_by_the_condition(x: int) -> int | None:
    found = x + 1
    if runs_forward(0, found) and (found := x - 9):
        return found
    return None


def another_is_computed(x: int) -> int | None:
    found = x - 9
    if runs_forward(0, found * found):
        return found
    return None


def under_its_name(x: int) -> int | None:
    found = x + 1
    if runs_forward(0, found):
        return found
    return None


REPLACED, under_its_name = under_its_name, unchecked

GOOD = {where_it_holds: FORWARD, refuses_first: FORWARD, the_first_of_several: FORWARD,
        of_rows: HOLDS, with_a_refusal: FORWARD}  # fmt: skip
BAD = (
    unchecked, another_value, changed_since, on_one_way, denied, either, a_constant, says_yes,
    can_be_changed, can_be_changed_too, of_unknown_type, by_its_own_judge, in_the_next_round,
    another_is_asked, a_record_that_claims, changed_by_an_inner_function, bound_by_the_condition,
    another_is_computed, REPLACED,
)  # fmt: skip


@pytest.mark.parametrize("driver", GOOD, ids=lambda f: f.__name__)
def test_what_is_put_to_a_kernel_on_every_way_is_re_checked(driver: Any) -> None:
    assert rechecked_by(_entry(driver)) == (GOOD[driver],)


@pytest.mark.parametrize("driver", BAD, ids=lambda f: f.__name__)
def test_what_can_leave_without_a_yes_is_not(driver: Any) -> None:
    assert rechecked_by(_entry(driver)) == ()


# -- the search that is broken ---------------------------------------------------------------------
VISITS = (
    Visit(1, -1, 100, 50, 40, 80),
    Visit(2, 0, 30, 20, 40, 80),
    Visit(3, -1, 10, 50, 40, 80, 5),
)
ROWS = (Row(AFTER_END, 3, (1,), 0, 0, "3 after 1"),)


@given(st.lists(st.integers(-50, 400), min_size=3, max_size=3))
def test_of_a_search_that_goes_wrong_nothing_wrong_comes_out(starts: list[int]) -> None:
    with pytest.MonkeyPatch.context() as patch:

        def search(best: Any, start: Any, moved: Any) -> None:
            best.best = list(starts)

        patch.setattr(earliest_times._Best, "search", search)
        times = earliest(VISITS, ROWS)
    one, two, three = starts
    right = one >= 100 and two >= one + 80 and three >= max(15, one + 50)
    assert isinstance(times, Times if right else Unmet)
    if right:
        assert times.start_ms == tuple(starts)


def test_times_that_are_not_of_the_visits_are_refused() -> None:
    times = earliest(VISITS, ROWS)
    assert isinstance(times, Times)
    assert keeps(times, VISITS, ROWS)
    ends = times.end_ms
    assert not keeps(Times(times.arrive_ms, times.start_ms, (ends[0] - 1, *ends[1:])), VISITS, ROWS)
    twice = (*VISITS[:2], VISITS[2]._replace(previous=0))
    assert not keeps(times, twice, ()), "two visits after one"


# -- the ledger ------------------------------------------------------------------------------------
BARE: dict[str, Any] = {
    "kind": "kernel", "proved": True, "against": ["t"], "restates": "", "rechecked_by": [],
}  # fmt: skip


@pytest.mark.parametrize(
    ("facts", "wanted"),
    [
        ({}, status.AGAINST),
        ({"restates": "a rule"}, status.RESTATED),
        ({"against": []}, status.PROPERTIES),
        ({"proved": False}, status.NOT_PROVED),
        ({"kind": "driver", "against": []}, status.USES),
        ({"kind": "driver", "against": [], "rechecked_by": ["k"]}, status.RECHECKED),
        ({"kind": "driver", "rechecked_by": ["k"], "proved": False}, status.NOT_PROVED),
    ],
)
def test_a_status_follows_from_the_facts(facts: dict[str, Any], wanted: str) -> None:
    assert status.status_of({**BARE, **facts}) == wanted


def test_the_products_statuses_are_those_of_its_text() -> None:
    kept = ledger.read()["kernels"]
    entries = ledger.load_all()
    for name, record in kept.items():
        entry = entries[name]
        if entry.kind == "driver":
            assert tuple(record["rechecked_by"]) == rechecked_by(REGISTRY[name])
        elif entry.supports:
            assert record["status"] == status.PROPERTIES
        else:
            wanted = status.RESTATED if entry.restates else status.AGAINST
            assert record["status"] == wanted, name
    rechecked = {n for n, record in kept.items() if record["status"] == status.RECHECKED}
    assert "cratous.core.assignment.earliest_times.earliest" in rechecked


@pytest.mark.parametrize(
    ("name", "edit", "said"),
    [
        ("cratous.core.geofence.mission_legs.leg_ok", {"status": status.RECHECKED}, "facts give"),
        ("cratous.core.schedule.rows.row_holds", {"proved": False}, "facts give"),
        ("cratous.core.schedule.rows.row_holds", {"more": 1}, "another format: more"),
    ],
)
def test_a_record_that_claims_more_than_its_facts_is_refused(
    tmp_path: Any, name: str, edit: dict[str, Any], said: str
) -> None:
    data = ledger.read()
    data["kernels"][name] = records.sealed(name, {**data["kernels"][name], **edit})
    records.write(records.texts(data), tmp_path)
    with pytest.raises(Refused, match=said):
        records.read(tmp_path)
