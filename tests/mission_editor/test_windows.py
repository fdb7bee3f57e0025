"""When the tasks of a plan may be done, by what its relations ask for."""

from __future__ import annotations

from typing import Any

from cratous.services.mission.windows import windows
from cratous.spec import algebra as pa
from cratous.spec.algebra import meaning
from cratous.spec.mission.plan import Plan, PlanItem

TIMES = {1: (5_000, 30_000), 2: (60_000, 90_000), 3: (10_000, 20_000)}


def made(relations: str, times: dict[int, tuple[int, int]] | None = None) -> Plan:
    """A plan with these times for a term without `+`."""
    times = TIMES if times is None else times
    nothing: dict[str, Any] = {
        "option_id": 1, "vehicle_id": 1, "transit": (), "path": (), "hold": None, "speed_m_s": 20.0,
        "depart_ms": 0, "arrive_ms": 0, "wait_ms": 0, "end_heading_rad": 0.0,
    }  # fmt: skip
    items = tuple(
        PlanItem(task_id=task, start_ms=start, end_ms=end, **nothing)
        for task, (start, end) in times.items()
    )
    rows = meaning.rows(pa.parse(relations, frozenset(TIMES)))
    return Plan("m", items, rows, (), 90_000, "MINMAX", 1, True)


def bounds(plan: Plan) -> dict[int, tuple[int, int]]:
    return {one.task: (one.from_ms, one.to_ms) for one in windows(plan)}


def test_a_task_without_timing_has_no_window() -> None:
    assert windows(made("|(p1 p2 p3)")) == ()
    assert windows(made(".(p1 p2 p3)")) == ()  # an order alone bounds no end


def test_an_absolute_window_is_as_written() -> None:
    (one,) = windows(made("|(p1 p2_[50000-95000] p3)"))
    assert (one.task, one.from_ms, one.to_ms) == (2, 50_000, 95_000)
    assert one.texts == (
        "`p2_[50000-95000]`: p2 starts at 50000 ms or later",
        "`p2_[50000-95000]`: p2 ends at 95000 ms or earlier",
    )


def test_a_relative_window_counts_from_what_the_plan_gives() -> None:
    assert bounds(made("|(.(p1 p2)-[10000-70000] p3)")) == {2: (40_000, 100_000)}
    assert bounds(made("|(~(p1 p2)-[10000-90000] p3)")) == {2: (15_000, 95_000)}
    # of two before it, the latest end
    assert bounds(made(".(|(p1 p3) p2)-[0-70000]")) == {2: (30_000, 100_000)}


def test_an_order_shortens_a_window() -> None:
    assert bounds(made(".(p1 p2_[20000-95000] p3)")) == {2: (30_000, 95_000)}


def test_what_refers_to_a_task_that_is_not_planned_gives_no_window() -> None:
    times = {2: TIMES[2]}
    assert bounds(made("|(.(p1 p2)-[10000-70000] p3)", times)) == {}
