"""Blame of requirements of one's own: what of the formula, who was in command, what had broken by then."""

from __future__ import annotations

import json
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from certify_tools import ROOT, Run
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core.requirements.verdict import both, either, negated
from cratous.services.certify.blame_own import own_blame, own_rows
from cratous.services.certify.requirement_texts import lines
from cratous.services.cli import run as command
from cratous.services.requirements import language
from cratous.services.requirements.evaluation import FALSE, UNKNOWN, Evaluation
from cratous.services.requirements.formula import Bounded, Formula, Join, Not, Reaches
from cratous.services.requirements.formula_text import facts, said
from cratous.services.requirements.outcome import Outcome
from cratous.services.requirements.specification import Specification
from cratous.services.requirements.watch import Watch, watch

HEAD = """trace every 1 s
signal x, y: m from AirVehicleState[ID=1].Location.Altitude hold 1 s
signal on: bool from GateState[VehicleID=2].Offered hold 1 s
"""
HAD = {1: [(0, "UxAS"), (1000, "ICAROUS"), (3000, "UxAS")], 2: [(0, "UxAS")]}


def seen(formula: str, rows: list[tuple[int, int, int]]) -> tuple[Specification, Outcome]:
    spec = language.read(f"{HEAD}requirement OWN: {formula}")
    watching = Watch(spec)
    for n, row in enumerate(rows):
        watching.sample(n * 10**9, dict(zip(("x", "y", "on"), row, strict=True)))
    return spec, watching.result().outcomes[0]


@pytest.mark.parametrize(
    ("formula", "wanted", "known_s"),
    [
        ("x >= 3 m and y >= 1 m", ["x < 3 m"], 1),
        ("on implies eventually within 2 s y >= 2 m", ["on", "not (eventually within 2 s y >= 2 m)"], 3),
        ("on implies always within 2 s x >= 1 m", ["on", "eventually within 2 s x < 1 m"], 2),
        ("x >= 3 m and not (on and x < y)", ["x < 3 m"], 1),
        ("not (on and x <= 2 m and y < 5 m)", ["on", "x <= 2 m", "y < 5 m"], 1),
        ("x > 2 m or (on iff x > 2 m)", ["x <= 2 m", "on"], 1),
        ("on implies (x > y or x > 8 m until within 1 s y > 1 m)",
         ["on", "y >= x", "not (x > 8 m until within 1 s y > 1 m)"], 1),
        ("x >= 3 m or historically from 0 s to 1 s y > 0 m and x > 2 m", ["x < 3 m", "x <= 2 m"], 1),
    ],
)  # fmt: skip
def test_the_parts_that_are_to_blame(formula: str, wanted: list[str], known_s: int) -> None:
    spec, one = seen(
        formula, [(3, 1, 0), (1 if "x > y" in formula else 2, 1, 1), (0, 1, 0), (0, 1, 0)]
    )
    assert (one.first_violated, one.decided_at) == (10**9, known_s * 10**9)
    assert facts(one.blamed, spec) == wanted


@pytest.mark.parametrize(
    ("sentence", "wanted"),
    [
        ("the a shall immediately satisfy x >= 3.0", ["this is the first sample", "x < 3 m"]),
        (
            "the a shall until on satisfy x >= 3.0",
            ["historically within all time not on", "x < 3 m"],
        ),
    ],
)
def test_what_has_no_bound_in_fret_is_said_without_one(sentence: str, wanted: list[str]) -> None:
    spec, one = seen(f'fretish "{sentence}"', [(2, 1, 0)])
    assert facts(one.blamed, spec) == wanted


@pytest.mark.parametrize(
    "text",
    ["x >= 3 m and (on or not on)", "on implies (x < y and y <= 2.5 m)", "once within 1500 us on",
     "always within 2 min (on until from 1 s to 3 s x >= 1 m)", "historically within 0 s not on",
     "not (eventually within 5 ns on)", "on since within 1 s (eventually within 1 s on)"],
)  # fmt: skip
def test_a_part_is_said_as_it_is_written(text: str) -> None:
    spec = language.read(f"{HEAD}requirement OWN: {text}")
    formula = spec.requirements[0].formula
    assert not isinstance(formula, Exception)
    assert said(formula, spec) == text


def test_any_number_of_negations_is_said() -> None:
    spec, one = seen(f"once within 1 s {'not ' * 5001}x >= 0 m", [(2, 1, 0)])
    assert facts(one.blamed, spec) == ["historically within 1 s x >= 0 m"]


LEAVES = st.builds(Reaches, st.sampled_from("xy"), st.sampled_from([1.0, 2.0]))
FORMULAS = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.builds(Not, inner),
        st.builds(Join, inner, inner, st.booleans()),
        st.builds(lambda p, q, h, past: Bounded(p, q, 0, h, past), LEAVES, inner,
                  st.integers(0, 2), st.booleans()),
    ),
    max_leaves=6,
)  # fmt: skip


def _with(formula: Formula, known: dict[Formula, int]) -> int:
    """The verdict where of the parts with a time and the comparisons only some are known."""
    if isinstance(formula, Not):
        return negated(_with(formula.phi, known))
    if isinstance(formula, Join):
        sides = [_with(side, known) for side in (formula.phi, formula.psi)]
        return (both if formula.is_and else either)(*sides)
    return known.get(formula, UNKNOWN)


@settings(max_examples=80, deadline=None)
@given(
    formula=FORMULAS,
    rows=st.lists(st.tuples(*[st.sampled_from((0.0, 1.0, 2.0, None))] * 2), min_size=1, max_size=5),
)
def test_they_are_as_said_and_violate_the_whole_alone(formula: Formula, rows: Any) -> None:
    evaluation, found = Evaluation(formula, blames=True), {}
    trace = [dict(zip("xy", row, strict=True)) for row in rows]
    for n, row in enumerate(trace):
        for time, verdict in evaluation.sample(n, row):
            found[time] = verdict
    first = min((time for time, verdict in found.items() if verdict == FALSE), default=None)
    assert bool(evaluation.blamed) == (first is not None)
    if first is None:
        return
    for part, verdict in evaluation.blamed:
        alone, told = Evaluation(part), {}
        for n, row in enumerate(trace):
            told.update(alone.sample(n, row))
        assert told[first] == verdict
    assert _with(formula, dict(evaluation.blamed)) == FALSE


def test_what_is_known_of_parts_is_kept_until_the_whole_is_decided() -> None:
    spec = language.read(f"{HEAD}requirement OWN: on implies eventually within 3 s y >= 2 m")
    formula = spec.requirements[0].formula
    assert not isinstance(formula, Exception)
    evaluation = Evaluation(formula, blames=True)
    for n in range(100):  # decided at once, and its second part 3 s later
        evaluation.sample(n * 10**9, {"on": 0.0, "y": 1.0})
    assert evaluation.parts
    assert max(len(known) for known in evaluation.parts.kept if known is not None) < 5


def test_who_had_the_vehicle_that_a_signal_names_and_what_broke_by_then() -> None:
    spec, one = seen(
        "x >= 1 m implies always within 2 s x >= 1 m", [(2, 1, 0), (2, 1, 0), (0, 1, 0)]
    )
    broken = {
        "name": "tracking",
        "state": "broken",
        "since_ms": 1500,
        "vehicle": 1,
        "guarantees": [],
    }
    late = {**broken, "name": "late", "since_ms": 2001}
    unseen = {**broken, "name": "dark", "state": "not observed", "since_ms": None}
    (row,) = own_rows([one], spec, HAD, [late, broken, unseen])
    assert row["command"] == [{"vehicle": 1, "side": "UxAS", "since_ms": 0}]
    assert row["command_known"] == [{"vehicle": 1, "side": "ICAROUS", "since_ms": 1000}]
    assert (row["at_s"], row["known_s"]) == (0, 2)
    assert (row["broken_first"]["name"], row["not_observed"]) == ("tracking", ["dark"])
    assert list(lines([row])) == [
        "blame, OWN at 0 s: x >= 1 m and eventually within 2 s x < 1 m; UxAS had vehicle 1, since 0.00 s; "
        "ICAROUS had vehicle 1 when it was known, since 1.00 s; first broken assumption: tracking at 1.50 s; "
        "not observed: dark"
    ]


def test_of_a_vehicle_without_a_gate_that_is_said_and_no_theorem_is_on_ones_own() -> None:
    text = f"{HEAD}signal z: m from AirVehicleState[ID=3].Location.Altitude\nrequirement G1: z >= x"
    spec = language.read(text)
    watching = Watch(spec)
    watching.sample(0, {"x": 2.0, "z": 1.0})
    broken = {"name": "tracking", "state": "broken", "since_ms": 0, "vehicle": 1}
    (row,) = own_rows(watching.result().outcomes, spec, HAD, [{**broken, "guarantees": ["G1"]}])
    assert [one["vehicle"] for one in row["command"]] == [1]
    assert "; vehicle 3 has no gate, which would tell who had it; " in next(lines([row]))
    assert "bears" not in row["broken_first"], "G1 is here the name of a requirement of one's own"


def test_of_a_trace_that_is_no_mission_it_is_said_that_nobody_knows(tmp_path: Path) -> None:
    spec, one = seen("x >= 3 m", [(2, 1, 0)])
    (tmp_path / "t.csv").write_text("time_s,x\n0,2\n")
    for trace, why in ((tmp_path / "t.csv", "no log of a mission"), (None, "running system")):
        (row,) = own_blame([one], spec, trace)
        assert (row["command"], row["broken_first"]) == ([], None)
        assert why in row["why_unknown"]
        assert "who was in command is not told" in next(lines([row]))
    assert own_blame([], spec, tmp_path / "none") == []


@pytest.fixture(scope="module")
def crossing(fly_once: Callable[[Path], Path]) -> Path:
    return fly_once(ROOT / "examples" / "crossing" / "mission.yaml")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("signal r: bool\nrequirement A: r", "nothing says where a log has this signal"),
        ('signal r: bool\nfret "e.json"', "by when"),
    ],
)
def test_what_no_log_can_be_held_against_is_refused_before_the_flight(
    text: str, why: str, tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = {"reqid": "A", "fulltext": "the a shall eventually satisfy r"}
    (tmp_path / "e.json").write_text(json.dumps([asked]))
    (tmp_path / "own.req").write_text(text)
    flown: list[object] = []
    monkeypatch.setattr(command, "run_one", lambda *_: flown.append(1))
    code, _, err = run("run", "mission.yaml", "--requirements", tmp_path / "own.req")
    assert (code, flown) == (2, [])
    assert why in err


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ("insert into meta values ('selected', 'true')", "not have all messages"),
        ("delete from messages where seq = 9; delete from closing", "not have all messages"),
        ("update meta set value = '{}' where key = 'plan'", "mission of the log is not read"),
    ],
)
def test_of_what_is_no_whole_log_nobody_is_said_to_be_in_command(
    crossing: Path, tmp_path: Path, change: str, why: str
) -> None:
    file = Path(shutil.copy(crossing / "log.sqlite", tmp_path))
    with closing(sqlite3.connect(file)) as log:
        log.executescript(change)
    spec, one = seen("x >= 3 m", [(2, 1, 0)])
    (row,) = own_blame([one], spec, file)
    assert (row["command"], row["broken_first"]) == ([], None)
    assert why in row["why_unknown"]


def test_over_a_flight_the_gate_tells_who_had_it(crossing: Path, tmp_path: Path) -> None:
    report = json.loads((crossing / "report.json").read_text())
    takeover = next(one for one in report["flight"]["authority"] if one["owner"] == "ICAROUS")
    file = tmp_path / "own.req"
    of = f"AirVehicleState[ID={takeover['vehicle']}]"
    file.write_text(
        f"trace every 500 ms\nsignal z: m from {of}.Location.Altitude hold 1 s\n"
        f"signal heading: deg from {of}.Heading hold 1 s\nrequirement Z: z >= 0 m\n"
        "requirement TURN: historically within 2 s heading <= 90.5 deg\n"
    )
    spec = language.read(file.read_text())
    found = watch(spec, crossing).outcomes
    rows = own_blame(found, spec, crossing)
    for row in rows:
        at_ms = row["at_s"] * 1000
        had = [
            one for one in report["flight"]["authority"] if one["vehicle"] == takeover["vehicle"]
        ]
        owner = [one["owner"] for one in had if one["time_ms"] <= at_ms][-1:] or ["UxAS"]
        assert [one["side"] for one in row["command"]] == owner
    assert rows
