"""A mission without relations is the one with `|` of all its tasks: plans, checks, flights, verdicts;
and no task that is asked for is missing from what is judged."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from mission_tools import flown_text, vehicle_text

from cratous.bridge import lmcp
from cratous.services.bus import Bus
from cratous.services.certify.verdicts import constraint_rows
from cratous.services.cli.job import plan_and_check
from cratous.services.flight.loop import fly
from cratous.services.loading import load
from cratous.services.logs.records import to_data
from cratous.services.monitor import Monitor
from cratous.spec.errors import NoPlan
from cratous.spec.mission.guarantees import exit_code

HEAD = (
    flown_text("forms", vehicle_text(1, 0, 400), vehicle_text(2, 2000, 600, "SLOW", "FAST"))
    + """tasks:
  - {id: 1, kind: must_fly, points: [{north_m: 1000, east_m: 0, alt_m: 400}], eligible: ONE}
  - {id: 2, kind: must_fly, points: [{north_m: 1000, east_m: 2000, alt_m: 600}], eligible: TWO}
  - {id: 3, kind: must_fly, points: [{north_m: 1800, east_m: 0, alt_m: 400}], eligible: THREE}
"""
)


def wind(at_s: int, north_m_s: int) -> str:
    return f"  - {{at_s: {at_s}, wind: {{north_m_s: {north_m_s}, east_m_s: 0}}}}"


def ring(at_s: int, north_m: int) -> str:
    corners = f"[{north_m - 150}, -150], [{north_m - 150}, 150], [{north_m + 150}, 0]"
    return f"  - {{at_s: {at_s}, zone: {{id: 7, kind: keep_out, vertices: [{corners}]}}}}"


@dataclass(frozen=True)
class Case:
    """A mission and what must come of it: the tasks served and not served; `says` stands in what is
    told of changes or of the plan. planned: whether there is a plan at the start."""

    served: tuple[int, ...] = ()
    unserved: tuple[int, ...] = ()
    says: tuple[str, ...] = ()
    changes: tuple[str, ...] = ()
    eligible: tuple[str, str, str] = ("[]", "[]", "[]")
    planned: bool = True
    speeds: tuple[int, int] = (18, 35)

    def text(self, relations: str) -> str:
        head = HEAD
        for word, value in zip(("ONE", "TWO", "THREE"), self.eligible, strict=True):
            head = head.replace(f"eligible: {word}", f"eligible: {value}")
        for word, speed in zip(("SLOW", "FAST"), self.speeds, strict=True):
            head = head.replace(word, str(speed))
        head = head.replace(", eligible: []", "")
        later = "changes:\n" + "\n".join(self.changes) + "\n" if self.changes else ""
        return head + (f'relations: "{relations}"\n' if relations else "") + later


OWN = ("[1]", "[2]", "[1]")
LOST = "  - {at_s: 10, vehicle_lost: 2}"
CASES = {
    "nothing happens": Case((1, 2, 3)),
    "lost, another may do its task": Case(
        (1, 2, 3), (), ("vehicle 2 leaves task 2; task 2 to vehicle 1",), (LOST,)
    ),
    "lost, nobody else may do its task": Case(
        (1, 3), (2,),
        ("left out: task 2 (no vehicle can do it", "vehicle 2: it was lost at 10.00 s)"),
        (LOST,), OWN,
    ),
    "lost at the start, nobody else may": Case(
        (1, 3), (2,), (), ("  - {at_s: 0, vehicle_lost: 2}",), OWN,
    ),
    "lost when its task is done": Case(
        (1, 2, 3), (), ("the plan holds as it is",), ("  - {at_s: 60, vehicle_lost: 2}",), OWN
    ),
    "lost and back": Case(
        (1, 2, 3), (), ("task 2 to vehicle 1",),
        ("  - {at_s: 5, vehicle_lost: 2}", "  - {at_s: 8, vehicle_joins: 2}"),
    ),
    "both lost": Case(
        (), (1, 2, 3), ("vehicle 1: it was lost at 10.00 s",), (LOST, "  - {at_s: 10, vehicle_lost: 1}")
    ),
    "a late task": Case((1, 2, 3), (), (), ("  - {at_s: 20, task_added: 3}",)),
    "a late task when all others are done": Case(
        (1, 2, 3), (), (), ("  - {at_s: 150, task_added: 3}",)
    ),
    "a late task that nobody may do any more": Case(
        (1, 2), (3,), ("no vehicle that takes part may do task 3",),
        ("  - {at_s: 120, vehicle_lost: 1}", "  - {at_s: 150, task_added: 3}"), ("[1]", "[2]", "[1]"),
    ),
    "a task is withdrawn": Case((1, 2), (), ("task 3 left out",), ("  - {at_s: 5, task_removed: 3}",)),
    "all tasks are withdrawn": Case(
        (), (), ("left out",), tuple(f"  - {{at_s: 5, task_removed: {k}}}" for k in (1, 2, 3))
    ),
    "a zone on a task": Case((1, 2), (3,), ("keep-out zone 7",), (ring(10, 1800),), OWN),
    "a zone on the way": Case((1, 2, 3), (), ("planned anew",), (ring(10, 1400),), OWN),
    "wind that nobody can hold, from the start": Case(
        says=("vehicle 1: it can hold no speed over the ground in every direction in a wind of 10 m/s",
              "vehicle 2: it can hold no speed", "task 3"),
        changes=(wind(0, 10),), planned=False,
    ),
    "wind that nobody can hold": Case(
        (), (1, 2, 3), ("vehicle 1 can hold no speed over the ground in every direction",),
        (wind(10, 10),),
    ),
    "wind that nobody can hold, then calm": Case(
        (1, 2, 3), (), ("vehicle 2: it can hold no speed",), (wind(10, 10), wind(15, 0))
    ),
    "wind that one cannot hold": Case(
        (1, 2, 3), (), ("tasks 1, 3 to vehicle 2",), (wind(10, 10),), speeds=(15, 50)
    ),
    "wind that one cannot hold, from the start": Case(
        (1, 2, 3), (), ("planned with it; vehicle 1 can hold no speed",), (wind(0, 10),),
        speeds=(15, 50),
    ),
    "wind that one cannot hold, and nobody else may": Case(
        (2,), (1, 3), ("task 1 (no vehicle can do it", "vehicle 1: it can hold no speed"), (wind(10, 10),), OWN,
        speeds=(15, 50),
    ),
    "wind that one cannot hold, then calm": Case(
        (1, 2, 3), (), ("vehicle 1 holds 25 m/s over the ground",), (wind(10, 10), wind(15, 0)),
        speeds=(15, 50),
    ),
}  # fmt: skip


def answers(case: Case, relations: str, folder: Path) -> dict[str, Any]:
    """Everything that is said of a mission in one of its forms."""
    file = folder / "mission.yaml"
    file.write_text(case.text(relations), encoding="utf-8")
    mission, bus = replace(load(file), instances=()), Bus(lmcp.full_names)
    try:
        plan, checks = plan_and_check(mission, bus)
    except NoPlan as error:
        return {"reasons": error.reasons}
    monitor, told = Monitor(mission, plan), list[Any]()
    bus.tap(monitor.tap)
    bus.tap(lambda e: told.append(e.body) if e.topic == "cratous.MissionChange" else None)
    result = fly(mission, plan, bus, daa=False)
    return {
        "items": [to_data(item) for item in plan.items],
        "plan": (plan.rows, plan.chosen, plan.makespan_ms, plan.status, plan.bound),
        "checks": constraint_rows(checks, "plan"),
        "told": [(body.Time, body.What, body.Consequence) for body in told],
        "flight": (result.outcome, result.end_ms, result.starts, result.ends, result.failed),
        "rows": constraint_rows(monitor.verdicts(), "flight"),
    }


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=pytest.mark.long if k % 2 else ()) for k, n in enumerate(CASES)],
)
def test_both_forms_give_the_same_answers_and_judge_every_task(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    empty, explicit = (answers(case, text, tmp_path) for text in ("", "|(p1 p2 p3)"))
    assert empty == explicit
    if not case.planned:
        said = " ".join(empty["reasons"])
        assert all(text in said for text in case.says), said
        return
    said = " ".join(consequence for _, _, consequence in empty["told"])
    assert all(text in said for text in case.says), said
    rows = {row["item"]: row for row in empty["rows"] if row["requirement"] == "G3"}
    wanted = {f"task {k} served": "holds" for k in case.served}
    wanted |= {f"task {k} served": "violated" for k in case.unserved}
    wanted["end of mission"] = "violated" if case.unserved else "holds"
    assert {item: row["verdict"] for item, row in rows.items()} == wanted
    for k in case.unserved:
        row = rows[f"task {k} served"]
        assert row["evidence"]["could_be_served"] in ("no", "not determined")
        assert [v["vehicle"] for v in row["evidence"]["vehicles"]] == [1, 2]
    assert empty["flight"][0] == ("failed" if case.unserved else "complete")
    broken = [
        row for row in empty["rows"] if row["requirement"] == "G1" and row["verdict"] == "violated"
    ]
    assert not broken
    assert exit_code([row["verdict"] for row in empty["rows"]]) != 0  # no instance: G5 is unknown


def test_beside_an_unserved_task_stands_who_could_have_done_it(tmp_path: Path) -> None:
    lost = answers(CASES["lost, nobody else may do its task"], "", tmp_path)
    rows = {row["item"]: row for row in lost["rows"]}
    two = rows["task 2 served"]
    assert two["evidence"] == {
        "could_be_served": "not determined",
        "since_ms": 10_000,
        "vehicles": [
            {"vehicle": 1, "unable": "it is not eligible"},
            {"vehicle": 2, "unable": "it was lost at 10.00 s"},
        ],
    }
    assert "no vehicle could do it from 10.00 s on" in two["note"]
    assert "whether it could have been done before is not determined" in two["note"]
    late = answers(CASES["a late task that nobody may do any more"], "", tmp_path)
    three = {row["item"]: row for row in late["rows"]}["task 3 served"]
    assert three["evidence"]["could_be_served"] == "no"
    assert "from 150.00 s on" in three["note"]
    assert three["vehicles"] == []
