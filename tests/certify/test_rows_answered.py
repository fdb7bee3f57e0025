"""`certify --verify` on rows that the judge does not know: of the plan, of assumptions, and the limits."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from certify_tools import ROOT, Run, meta, read

pytest.importorskip("cryptography", reason="the extra `sign` is not installed")

from signing import retell, sign_whole, verify, verify_edited

from cratous.services.assumptions.listing import LISTING
from cratous.services.attestation.assumptions_check import assumption_faults
from cratous.services.attestation.planned import PART, WHOLE, is_settled, plan_faults
from cratous.services.certify.rejudge import subject
from cratous.services.certify.verdicts import plan_rows
from cratous.services.loading import load
from cratous.services.logs.records import to_data
from cratous.services.mission.wind import known_at
from cratous.services.monitor.plan_check import check_plan
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Change
from cratous.spec.mission.changes import ZONE, ZONE_ENDS, ZoneEnd

Report = dict[str, Any]
Edit = Callable[[Report], None]
SENTENCE = "`.(p1 p2)`: p2 starts no earlier than p1 ends"


def renamed(item: str, other: str) -> Edit:
    def edit(report: Report) -> None:
        next(row for row in report["constraints"] if row["item"] == item)["item"] = other

    return edit


def dropped(item: str) -> Edit:
    def edit(report: Report) -> None:
        rows = report["constraints"]
        rows.remove(next(row for row in rows if row["item"] == item))

    return edit


def invented(item: str) -> Edit:
    def edit(report: Report) -> None:
        row = next(row for row in report["constraints"] if row["item"] == WHOLE)
        report["constraints"].append({**row, "item": item})

    return edit


PLANNED: dict[str, tuple[Edit, str]] = {
    "a chain is left out": (
        dropped("chain: vehicle 1"), "G1 lacks the row on the plan: chain: vehicle 1",
    ),
    "a task is left out": (
        dropped("eligibility: task 2"), "G1 lacks the row on the plan: eligibility: task 2",
    ),
    "another vehicle": (
        renamed("chain: vehicle 1", "chain: vehicle 7"),
        "G1 has a row on the plan that no check writes: chain: vehicle 7",
    ),
    "words of its own": (
        invented("plan: it is the best"),
        "G1 has a row on the plan that no check writes: plan: it is the best",
    ),
    "a zone that is none": (
        invented("zone: keep_out 5, planned route of vehicle 1"),
        "G1 has a row on the plan that no check writes: zone: keep_out 5",
    ),
    "a whole plan is said to be a part": (
        renamed(WHOLE, PART), f"the plan is whole, and G1 has the row on it: {PART}",
    ),
    "both": (invented(PART), "G1 has to have one row on the plan of these"),
    "an order that nobody asked for": (
        invented(f"plan: {SENTENCE}"), f"which the flight has not: plan: {SENTENCE}",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", PLANNED)
def test_rows_on_a_plan_are_those_of_its_check(flown: Path, case: str) -> None:
    report = read(flown)
    assert plan_faults(report) == []
    edit, said = PLANNED[case]
    edit(report)
    assert any(said in line for line in plan_faults(report)), plan_faults(report)


def test_verification_refuses_a_plan_without_one_of_its_rows(run: Run, home: Path) -> None:
    retell(home, dropped("chain: vehicle 1"))
    code, out, err = verify(run, home)
    assert (code, "verified" in out) == (1, False)
    assert "refused: report.json: G1 lacks the row on the plan: chain: vehicle 1" in err


def ordered(report: Report) -> Report:
    """As of a mission with one order, which plan and flight kept."""
    found = copy.deepcopy(report)
    found["mission"]["relations"] = ".(p1 p2)"
    row = next(row for row in found["constraints"] if row["item"] == WHOLE)
    for source in ("plan", "flight"):
        new = {**row, "source": source, "item": f"{source}: {SENTENCE}"}
        found["constraints"].append(new)
    return found


def test_an_order_that_the_plan_leaves_out_is_missed(flown: Path) -> None:
    report = ordered(read(flown))
    assert plan_faults(report) == []
    other = copy.deepcopy(report)
    renamed(f"flight: {SENTENCE}", SENTENCE)(other)  # no row of a flight
    has_not = f"G1 has a row on the plan, which the flight has not: plan: {SENTENCE}"
    assert plan_faults(other) == [f"report.json: {has_not}"]
    dropped(f"plan: {SENTENCE}")(report)
    said = f"G1 lacks the row on the plan, which the flight has: plan: {SENTENCE}"
    assert plan_faults(report) == [f"report.json: {said}"]
    report["mission"]["relations"] = ".(p1 +(p2 p3))"
    assert not is_settled(report)
    assert plan_faults(report) == []  # another branch may have been flown: it is said to be open
    report["mission"].update(relations=".(p1 p2)", changes=[{"at_ms": 9, "vehicle": 1}])
    assert not is_settled(report)
    assert plan_faults(report) == []  # and so may another plan


def without_a_task(report: Report) -> None:
    report["mission"]["tasks"].append({**report["mission"]["tasks"][0], "id": 99})


def with_a_part(report: Report) -> None:
    report["plan"]["in_part"] = [{"task_id": report["plan"]["items"][0]["task_id"], "share": 0.5}]


@pytest.mark.parametrize("edit", [without_a_task, with_a_part])
def test_a_plan_without_all_of_its_tasks_is_not_whole(flown: Path, edit: Edit) -> None:
    report = read(flown)
    edit(report)
    said = f"report.json: by the tasks of the plan this does not hold: {WHOLE}"
    assert plan_faults(report) == [said]
    part = copy.deepcopy(report)
    renamed(WHOLE, PART)(part)
    next(row for row in report["constraints"] if row["item"] == WHOLE)["verdict"] = "violated"
    assert plan_faults(part) == plan_faults(report) == []


def test_the_check_of_a_plan_writes_the_rows_that_are_expected(flown: Path) -> None:
    """Against the check itself, so that neither changes alone."""
    report = read(flown)
    rows = [
        {**row, "source": "plan"} for row in plan_rows(check_plan(*subject(flown / "log.sqlite")))
    ]
    report["constraints"] = [*rows, *(r for r in report["constraints"] if r["source"] != "plan")]
    assert plan_faults(report) == []


@pytest.fixture(scope="module")
def zoned() -> Report:
    """What a report says of a plan made when zone 12 has ended, 13 has appeared, and 14 is to come."""
    mission = load(ROOT / "tests" / "missions" / "zone_ends.yaml")
    (zone,) = mission.zones
    far = tuple((north + 9000.0, east) for north, east in zone.vertices)
    others = (
        Change(0, ZONE, zone=replace(zone, id=13, vertices=far)),
        Change(100_000, ZONE, zone=replace(zone, id=14, vertices=far)),
    )
    kept, ends = replace(zone, id=11, vertices=far), ZoneEnd(0, ZONE_ENDS, zone_id=12)
    mission = replace(mission, zones=(kept, zone), changes=(ends, *others))
    known = known_at(mission, 0)
    plan = make_plan(known)
    rows = plan_rows(check_plan(known, plan))
    return {"mission": to_data(mission), "plan": to_data(plan), "constraints": rows}


@pytest.mark.parametrize("zone", [11, 13])
def test_each_zone_known_when_a_plan_is_made_has_its_row(zoned: Report, zone: int) -> None:
    assert plan_faults(zoned) == []
    report, item = copy.deepcopy(zoned), f"zone: keep_out {zone}, planned route of vehicle 1"
    dropped(item)(report)
    assert plan_faults(report) == [f"report.json: G1 lacks the row on the plan: {item}"]


@pytest.mark.parametrize("zone", [12, 14])
def test_a_zone_that_is_over_or_to_come_has_none(zoned: Report, zone: int) -> None:
    report, item = copy.deepcopy(zoned), f"zone: keep_out {zone}, planned route of vehicle 1"
    invented(item)(report)
    said = f"report.json: G1 has a row on the plan that no check writes: {item}"
    assert plan_faults(report) == [said]


# ---- assumptions ---------------------------------------------------------------------------------


def entry(name: str, /, **entries: Any) -> Edit:
    def edit(report: Report) -> None:
        next(row for row in report["assumptions"] if row["name"] == name).update(entries)

    return edit


ASSUMED: dict[str, tuple[Edit, str]] = {
    "one is left out": (
        lambda r: r["assumptions"].pop(1), "the assumption epochs told stands where reports of the gate",
    ),
    "the last is left out": (
        lambda r: r["assumptions"].pop(), "the assumption none stands where permitted as offered belongs",
    ),
    "one is invented": (
        lambda r: r["assumptions"].append({**r["assumptions"][0], "name": "all is well"}),
        "the assumption all is well stands where none belongs",
    ),
    "another name": (entry("clock", name="time"), "time stands where clock belongs"),
    "another text": (entry("clock", text="clocks are good"), "clock has another text"),
    "more guarantees": (entry("clock", guarantees=["G1"]), "clock has another text, other theorems"),
    "fewer theorems": (entry("clock", theorems=[]), "clock has another text, other theorems"),
    "held without a check": (
        entry("clock", state="held", note="", checks=0), "clock is held without a check",
    ),
    "held with a reason why not": (
        entry("clock", state="held", note="no end", checks=1), "clock is held, with the note 'no end'",
    ),
    "not observed, and nobody says why": (
        entry("clock", state="not observed", note=""), "clock is not observed, with the note 'none'",
    ),
    "held since an instant": (entry("clock", since_ms=3), "clock is held, since 3 ms"),
    "what is lost": (entry("clock", lost="nothing"), "clock says otherwise what is lost"),
}  # fmt: skip


@pytest.mark.parametrize("case", ASSUMED)
def test_assumptions_are_those_that_there_are(flown: Path, case: str) -> None:
    report = read(flown)
    assert assumption_faults(report, {}) == []
    edit, said = ASSUMED[case]
    edit(report)
    assert any(said in line for line in assumption_faults(report, {}))


def test_what_broke_is_what_the_log_recorded(run: Run, home: Path) -> None:
    """A signer who says of a broken assumption that it held."""
    report = read(home / "run")
    row = next(row for row in report["assumptions"] if row["name"] == "clock")
    one = next(one for one in LISTING if one.name == "clock")
    more = {"since_ms": 9, "note": "it went back", "lost": one.lost, "stands": one.stands}
    meta(home / "run", "assumptions", [{**row, **more, "state": "broken"}])
    sign_whole(home, report)
    code, out, err = verify(run, home)
    assert (code, "verified" in out) == (1, False)
    said = "report.json: the broken assumptions are not those that the log recorded"
    assert f"refused: {said}" in err
    del report["assumptions"]
    told = {"assumptions": [row]}
    assert assumption_faults(report, told) == [
        "report.json: it lacks the assumptions that the log recorded"
    ]


# ---- limits, and what is open --------------------------------------------------------------------

LIMITED: dict[str, Edit] = {
    "one is left out": lambda r: r["limits"].pop(0),
    "one is weaker": lambda r: r["limits"].__setitem__(0, "Python and z3 are qualified tools."),
    "none on the frame": lambda r: r["limits"].pop(),
    "none at all": lambda r: r["limits"].clear(),
    "one more": lambda r: r["limits"].append("It is safe."),
}


@pytest.mark.parametrize("case", LIMITED)
def test_the_limits_are_those_of_every_report(run: Run, home: Path, case: str) -> None:
    code, _, err = verify_edited(run, home, LIMITED[case])
    assert code == 1
    assert "refused: report.json: its limits are not those that every report has" in err


def test_what_nobody_looked_into_is_named(run: Run, home: Path) -> None:
    """Of the rows: verdicts on the plan, checks, notes, kernels, and what held of the assumptions."""
    code, out, err = verify(run, home)
    assert err == ""
    told = "\n".join(line for line in out.splitlines() if line.startswith("not judged: "))
    number = len(read(home / "run")["assumptions"])
    assert f"{number} assumptions that held or were not observed: whether it is so" in told
    for word in ("margins", "notes", "checks", "kernels", "tracks", "verdicts on the plan"):
        assert word in told, word
    assert code in (0, 3)
