"""Requirements from FRET: its formulas and its sentences say the same, and what is not read says why."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from certify_tools import Run
from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.services.cli.monitor_requirements import read as monitored
from cratous.services.requirements import fret, language
from cratous.services.requirements.evaluation import Evaluation
from cratous.services.requirements.formula import Formula
from cratous.services.requirements.fret_terms import Names, Unread
from cratous.services.requirements.fretish import sentence
from cratous.services.requirements.specification import NotRead, Requirement, Signal
from cratous.services.requirements.watch import watch
from cratous.spec.errors import BadInput

BOOLS = ("c", "r", "s", "m")
VARIABLES = [
    *({"variable_name": name, "idType": "Input", "dataType": "boolean"} for name in BOOLS),
    {"variable_name": "alt", "idType": "Output", "dataType": "double"},
    {"variable_name": "FLOOR", "idType": "Internal", "dataType": "double", "assignment": "90.0"},
    {"variable_name": "busy", "idType": "Mode", "dataType": "boolean", "modeRequirement": "c or r"},
    {"variable_name": "far", "idType": "Function", "dataType": ""},
    {"variable_name": "odd", "idType": "Input", "dataType": ""},
    {"variable_name": "port", "portType": "In", "dataType": ["boolean"]},
]
SAME = {
    "the a shall always satisfy r": ("(G r)", "(H r)"),
    "the a shall never satisfy r": ("(G (! r))", "(H (! r))"),
    "the a shall immediately satisfy r": ("r", "(H ((Z FALSE) -> r))"),
    "the a shall within 2 ticks satisfy r": ("(F[0,2] r)", "(H ((H (! r)) -> (O[0,1] (! (Y TRUE)))))"),
    "the a shall for 2 ticks satisfy r": ("((G[<=2] r) | (G r))", "(H ((O[<=2] FTP) -> r))"),
    "the a shall until s satisfy r": ("", "(H ((H (! s)) -> r))"),
    "the a shall before s satisfy r": ("", "(H (s -> (Y (O r))))"),
    "whenever c the a shall immediately satisfy r": ("(G (c -> r))", "(H (c -> r))"),
    "whenever c the a shall within 2 ticks satisfy r": (
        "(G (c -> (F[<=2] r)))",
        "(H ((O[=2] (c & (! r))) -> (O[<2] ((Z FALSE) | r))))",
    ),
    "whenever c the a shall at the next timepoint satisfy r": (
        "(G (c -> (X r)))",
        "(H ((Y c) -> (r | (! (Y TRUE)))))",
    ),
    "whenever c the a shall always satisfy r": ("", "(H ((H (! c)) | r))"),
    "whenever c the a shall until s satisfy r": (
        "",
        "(H ((H (! c)) | (((! s) S ((! s) & c)) -> r)))",
    ),
    "when c the a shall immediately satisfy r": (
        "((G (((! c) & (X c)) -> (X r))) & (c -> r))",
        "(H ((c & (Z (! c))) -> r))",
    ),
    "unless c, the a shall within 2 ticks satisfy r": (
        "((G (((! (! c)) & (X (! c))) -> (X (F[0,2] r)))) & ((! c) -> (F[0,2] r)))",
        "(H ((O[=2] (((! c) & (Z c)) & (! r))) -> (O[<2] (FTP | r))))",
    ),
    "whenever m the a shall after 1 tick satisfy r": (
        "(G (m -> (((G[<=1] (! r)) | (G (! r))) & (F[<=2] r))))",
        "((H ((O[<=1] m) -> ((H (! m)) | (! r)))) & (H ((O[=2] (m & (! r))) -> (O[<2] (FTP | r)))))",
    ),
    "in m mode the a shall always satisfy r": ("(G (m -> r))", "(H (m -> r))"),
    "in m the a shall immediately satisfy r": ("", "(H ((m & (Z (! m))) -> r))"),
    "while m, whenever c the a shall immediately satisfy r": ("(G ((m & c) -> r))", ""),
    "the a shall always satisfy if c then (r xor s)": (
        "(G (c -> (! (r <-> s))))",
        "(H (c -> (r xor s)))",
    ),
}  # fmt: skip
"""What FRET makes of a sentence: looking ahead, and looking back."""


def _export(**said: Any) -> str:
    row = {"reqid": "R1", "project": "P", "fulltext": "", "semantics": {}, **said}
    return json.dumps({"requirements": [row], "variables": VARIABLES})


def _one(**said: Any) -> Requirement:
    (found,) = fret.read(_export(**said), "e.json").requirements
    return found


def _formula(found: Requirement) -> Formula:
    assert not isinstance(found.formula, NotRead), str(found.formula)
    return found.formula


def _verdicts(formula: Formula, rows: list[dict[str, float]], step: int = 1) -> dict[int, int]:
    evaluation, found = Evaluation(formula), {}
    for n, row in enumerate(rows):
        found.update(evaluation.sample(n * step, row))
    return found


@settings(max_examples=25, deadline=None)
@given(rows=st.lists(st.tuples(*[st.sampled_from((0.0, 1.0))] * 4), min_size=1, max_size=7))
def test_a_sentence_and_both_formulas_are_violated_by_the_same_traces(rows) -> None:
    # after a while in which nothing more is asked for and all is given, nothing is owed
    ended = [*rows, (0.0, 1.0, 1.0, 0.0), *[(1.0, 1.0, 1.0, 0.0)] * 3]
    trace = [dict(zip(BOOLS, row, strict=True)) for row in ended]
    for text, (ahead, back) in SAME.items():
        ways = [_one(fulltext=text)]
        ways += [_one(semantics={"ftInfAUExpanded": ahead})] if ahead else []
        ways += [_one(semantics={"ptExpanded": back})] if back else []
        bad = [0 in _verdicts(_formula(one), trace).values() for one in ways]
        assert len(set(bad)) == 1, (text, bad)


FORMS = [
    "x > 3 m or y <= 2 m", "req implies (not resp or x < y)", "req implies always within 2 s resp",
    "(x > 2 m and req) implies eventually within 1500 us resp", "eventually within 3 s (y >= x)",
    "not (x > 3 m) and not not resp",
]  # fmt: skip


@settings(max_examples=40, deadline=None)
@given(
    form=st.sampled_from(FORMS),
    rows=st.lists(st.tuples(*[st.sampled_from((None, 0.0, 1.0, 2.0, 3.0))] * 4), min_size=1),
)
def test_our_own_sentences_read_back_give_the_same_verdicts(form, rows) -> None:
    head = "signal req, resp: bool\nsignal x, y: m\n"
    spec = language.read(f"{head}requirement A: {form}")
    said = sentence(_formula(spec.requirements[0]), spec)
    (back,) = language.read(f'{head}requirement B: fretish "{said}"').requirements
    cells = [(*(v and min(v, 1.0) for v in row[:2]), *row[2:]) for row in rows]
    trace = [dict(zip(("req", "resp", "x", "y"), row, strict=True)) for row in cells]
    step = 5 * 10**8
    assert _verdicts(_formula(back), trace, step) == _verdicts(
        _formula(spec.requirements[0]), trace, step
    )


@pytest.mark.parametrize("timing", ["within 2000 ticks", "for 1 ticks", "immediately"])
def test_a_sentence_of_an_export_is_said_with_its_ticks(timing) -> None:
    text = f"Whenever c the system shall {timing} satisfy r"
    spec = fret.read(_export(fulltext=text))
    assert sentence(_formula(spec.requirements[0]), spec) == text


@pytest.mark.parametrize(
    ("text", "why", "place"),
    [
        ("(G (alt ^ 2.0 > FLOOR))", "operator of numbers", "column 9"),
        ("(G far(alt))", "this function is not read; got far", "column 4"),
        ("(G (det (alt, 1.0) > 0.0))", "this function is not read; got det", "column 5"),
        ("(G (r r))", "outside", "column 7"),
        ("(H <b><i>(mag ( alt ) > 1.0)</i></b>)", "FRET itself has not read", "column 4"),
        ("(G far)", "a function", "column 4"),
        ("(G busy)", "a mode that is defined", "column 4"),
        ("(G odd)", "no type", "column 4"),
        ("(G lost)", "nothing says which signal", "column 4"),
        ("(G (c > r))", "a truth value is compared", "column 7"),
        ("(G (FLOOR > 3.0))", "no signal is compared", "column 11"),
        ("(G alt)", "no truth value", "column 4"),
        ("(G (c -> (F r)))", "ahead has no bound", "column 11"),
        ("(G (c U[1,3] r))", "not sure from where", "column 7"),
        ("(G (F[3,1] r))", "bounds are empty", "column 7"),
        ("(G (O[<0] r))", "bounds are empty", "column 8"),
        ("(LAST V (r | (X LAST)))", "the last", "column 17"),
        ("TRUE", "says nothing", "column 1"),
        ("(G r", "outside", "column 5"),
        ("(G " + "(" * 300 + "r" + ")" * 301, "nested too deeply", "column"),
        ("(G (alt > 1" + "0" * 301 + "))", "too long", "column"),
    ],
)
def test_what_cannot_be_said_names_requirement_formula_and_place(text, why, place) -> None:
    no = _one(semantics={"ftInfAUExpanded": text}).formula
    assert isinstance(no, NotRead)
    assert why in str(no)
    assert no.where.startswith("e.json, requirement R1, ftInfAUExpanded, ")
    assert place in no.where
    assert no.caret().endswith("^")


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("the a shall eventually satisfy r", "by when"),
        ("the a shall satisfy r", "by when"),
        ("the a shall within 5 seconds satisfy r", "samples are counted"),
        ("after m the a shall always satisfy r", "outside"),
        ("in m the a shall within 5 ticks satisfy r", "within a scope"),
        ("when c the a shall before s satisfy r", "after a condition"),
        ("", "neither formula nor sentence"),
    ],
)
def test_sentences_that_are_not_read(text, why) -> None:
    no = _one(fulltext=text).formula
    assert isinstance(no, NotRead)
    assert why in str(no)


@pytest.mark.parametrize(
    "text",
    ["3", "{", '{"requirements": 3}', '{"requirements": [3]}', '[{"reqid": ""}]', "[]",
     '[{"reqid": "A"}, {"reqid": "A"}]'],
)  # fmt: skip
def test_files_that_are_no_export(text) -> None:
    with pytest.raises(BadInput):
        fret.read(text)


@pytest.mark.parametrize("time", ["5 Seconds", "5seconds"])
def test_a_time_is_not_taken_for_ticks(time) -> None:
    text = f"whenever c the a shall within {time} satisfy r"
    no = _one(fulltext=text, semantics={"ftInfAUExpanded": "(G (c -> (F[0,5] r)))"}).formula
    assert isinstance(no, NotRead)
    assert "fulltext, column 31: samples are counted" in str(no)


@pytest.mark.parametrize(
    "said",
    [
        {"fulltext": "the a shall with probability < 0.1 always satisfy r"},
        {"semantics": {"ptExpanded": "(H r)", "probability": "bound"}},
    ],
)
def test_a_probability_is_not_left_out(said) -> None:
    row = {"reqid": "A", "semantics": {"ptExpanded": "(H r)"}, **said}
    export = fret.read_export(json.dumps([row]), "e.json")
    names = Names({"r": Signal("bool")}, {})
    for timed in (False, True):
        no = fret.requirement(export.requirements[0], names, "e.json", timed=timed).formula
        assert isinstance(no, NotRead)
        assert "probabilities are not read" in str(no)


def test_an_input_is_not_what_it_was_defined_as_before() -> None:
    row = {"variable_name": "alt", "idType": "Input", "dataType": "double", "assignment": "90.0"}
    export = fret.read_export(json.dumps({"requirements": [], "variables": [row]}), "e.json")
    assert (set(export.variables), export.defined) == ({"alt"}, {})


@pytest.mark.parametrize("text", ["1/0", "1/3", "1_0", "a + 1", "1" * 301])
def test_what_is_no_number_defines_none(text) -> None:
    row = {"variable_name": "k", "idType": "Internal", "dataType": "double", "assignment": text}
    export = fret.read_export(json.dumps({"requirements": [], "variables": [row]}), "e.json")
    assert isinstance(export.defined["k"], Unread)


def test_a_variable_that_is_declared_in_two_ways_is_refused() -> None:
    other = {"variable_name": "c", "idType": "Input", "dataType": "double", "component_name": "b"}
    row = {"reqid": "A", "semantics": {"ft": "(LAST V c)"}}
    text = json.dumps({"requirements": [row], "variables": [*VARIABLES, other, VARIABLES[0]]})
    no = fret.read(text).requirements[0].formula
    assert isinstance(no, NotRead)
    assert "in two ways" in str(no)


def test_a_trace_against_an_export_that_the_commands_read(run: Run, tmp_path: Path) -> None:
    said = {"ftInfAUExpanded": "(G (c -> (F[0,1] (alt >= FLOOR))))"}
    file, trace, lines = tmp_path / "e.json", tmp_path / "t.csv", []
    file.write_text(_export(semantics=said))
    assert run("check", file) == (0, f"{file}: can be read\n", "")
    trace.write_text("c,alt\n1,80\n0,95\n1,80\n0,85\n")
    (one,) = watch(monitored(file), trace, lines).outcomes
    assert (one.verdict, lines) == ("violated", ["R1:0,T", "R1:1,T", "R1:2,F", "R1:3,T"])
    assert one.requirement.source == "FRET, P, ftInfAUExpanded"
    file.write_text(_export(semantics={"ftInfAUExpanded": "(G busy)"}))
    code, out, err = run("check", file)
    assert (code, out) == (2, "")
    assert "requirement R1, ftInfAUExpanded, column 4: this is a mode" in err


def test_an_import_says_what_variables_are(tmp_path: Path) -> None:
    rows = [
        {"reqid": "A", "fulltext": "Whenever c a shall within 5 sec satisfy alt >= FLOOR"},
        {"reqid": "B&C", "semantics": {"pt": "(H (alt >= low))"}},
        {"reqid": "D", "semantics": {"pt": "(H (O[<3] r))"}},
        {"reqid": "E", "fulltext": "when c a shall immediately satisfy r"},
    ]
    text = json.dumps({"requirements": rows, "variables": VARIABLES})
    (tmp_path / "e.json").write_text(text)
    head = "signal c, r: bool\nsignal height: m\n"
    given_ = f'{head}fret "e.json" with alt is height, low is 0.1 km'
    spec = language.read(given_, "own.req", tmp_path)
    a, b, d, e = (one.formula for one in spec.requirements)
    own = "requirement X: c implies eventually within 5 s (height >= 90 m)"
    assert a == language.read(head + own).requirements[0].formula
    assert b == language.read(head + "requirement X: height >= 100 m").requirements[0].formula
    assert isinstance(d, NotRead)
    assert "no unit" in str(d)
    assert isinstance(e, NotRead)
    assert "none is the one before" in str(e)
    only = f'{head}fret "e.json" only "B&C" with alt is height, low is 9 V'
    (one,) = language.read(only, "own.req", tmp_path).requirements
    assert "units that do not fit" in str(one.formula)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ('fret "e.json"', "in no folder"),
        ('requirement A: fretish "c shall"', "line 2, column 32"),
        ('requirement A: fretish "b shall always satisfy d"', "line 2, column 48"),
    ],
)
def test_a_file_of_requirements_refuses_with_the_place(text, why) -> None:
    with pytest.raises(NotRead, match=why):
        language.read(f"signal c: bool\n{text}")


@pytest.mark.parametrize(
    ("more", "why"),
    [
        ("only B", "no such requirement"),
        ("with c is d", "this is no signal"),
        ("with c is c, c is true", "given twice"),
        ("requirement R1: c", "id is given twice"),
    ],
)
def test_an_import_that_does_not_fit(more, why, tmp_path: Path) -> None:
    (tmp_path / "e.json").write_text(_export(semantics={"pt": "(H c)"}))
    with pytest.raises(NotRead, match=why):
        language.read(f'signal c: bool\nfret "e.json" {more}', "own.req", tmp_path)
