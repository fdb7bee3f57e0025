"""Requirements in C2PO: what is read means what R2U2 makes of it, the rest is refused with its place."""

from __future__ import annotations

import itertools
import json
import re
from pathlib import Path

import pytest

from cratous.services.cli import main
from cratous.services.conform import run, suite
from cratous.services.requirements.c2po import read
from cratous.services.requirements.evaluation import Evaluation
from cratous.services.requirements.specification import NotRead
from cratous.spec.errors import BadInput

HEAD = "INPUT\n a,b,c: bool;\n x: float;\nFTSPEC\n "


def one(text):
    (found,) = read(HEAD + text).requirements
    if isinstance(found.formula, NotRead):
        raise found.formula
    return found.formula


def verdicts(text, rows):
    evaluation = Evaluation(one(text))
    found = {}
    for time, row in enumerate(rows):
        found.update(evaluation.sample(time, row))
    return found


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("a || b && c", "a || (b && c)"),
        ("a -> b || c", "a -> (b || c)"),
        ("!a && b", "(!a) && b"),
        ("a && G[1,2] b", "a && (G[1,2] b)"),
        ("!a U[0,3] b", "(!a) U[0,3] b"),
        ("a R[0,3] b", "!(!a U[0,3] !b)"),
        ("a T[0,3] b", "!(!a S[0,3] !b)"),
        ("G[2] a", "G[0,2] a"),
        ("a <-> b", "(a -> b) && (b -> a)"),
        ("name: a", "a"),
    ],
)
def test_how_strongly_operators_bind(text, same):
    assert one(text) == one(same)


@pytest.mark.parametrize("bits", list(itertools.product((0.0, 1.0), repeat=8)))
def test_until_counts_phi_from_its_lower_bound(bits):
    rows = [{"a": p, "b": q} for p, q in zip(bits[:4], bits[4:], strict=True)]
    met = (rows[1]["b"], rows[1]["a"] and rows[2]["b"])
    assert verdicts("a U[1,2] b", rows)[0] == (2 if any(met) else 0)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("a &&", "line 5, column 6"),
        ("a | b", "line 5, column 4"),
        ("d", "line 5, column 2"),
        ("x", "line 5, column 2"),
        ("a >= 1.0", "line 5, column 2"),
        ("G a", "line 5, column 4"),
        ("G[3,1] a", "line 5, column 4"),
        ("G[0,99999999999] a", "line 5, column 6"),
        ("a S[1,2] b", "line 5, column 4"),
        ("a -> b -> c", "line 5, column 9"),
        ("prev(a, b)", "line 5, column 6"),
        ("x >= 1e5", "line 5"),
        ("a;\n c => a", "line 6, column 4"),
    ],
)
def test_what_is_not_read_is_refused_with_its_place(text, place):
    last = read(HEAD + text, "r.c2po").requirements[-1].formula
    assert isinstance(last, NotRead)
    assert place in last.where
    assert last.caret().endswith("^")
    assert set(last.data()) >= {"caret", "where", "expected", "got"}


@pytest.mark.parametrize("text", ["", "INPUT a: bool;", "INPUT a: bool; a: int;\nFTSPEC a;"])
def test_files_that_are_none(text):
    with pytest.raises(BadInput):
        read(text)


def _blocks(root: Path) -> list[str]:
    text = (root / "docs" / "guides" / "requirements.md").read_text(encoding="utf-8")
    return re.findall(r"^```(?:console)?\n(.*?)^```", text, re.M | re.S)


def test_the_guide_is_true(root: Path, tmp_path: Path, monkeypatch, capsys):
    spec, trace, command, early, late = _blocks(root)[-5:]
    (tmp_path / "link.c2po").write_text(spec)
    (tmp_path / "trace.csv").write_text(trace)
    monkeypatch.chdir(tmp_path)
    assert main(command.split()[2:]) == 1
    out = capsys.readouterr().out
    assert out.startswith(early + late)
    assert out.count("\n") == (early + late).count("\n") + 1


def _monitored(tmp_path: Path, spec: str, trace: str, *more: str) -> int:
    (tmp_path / "r.c2po").write_text(HEAD + spec)
    (tmp_path / "t.csv").write_text(trace)
    return main(
        ["monitor", str(tmp_path / "t.csv"), "--requirements", str(tmp_path / "r.c2po"), *more]
    )


@pytest.mark.parametrize(
    ("spec", "trace", "code", "word"),
    [
        ("a;", "a\n1\n1\n", 0, "holds"),
        ("a;", "a\n", 3, "unknown"),
        ("F[0,1] a;", "a\n1\n0\n", 3, "undecided"),
        ("x > 0.0;", "x\n1\nnan\n", 3, "unknown"),
        ("x > 0.0;", "x\n1\ninf\n", 3, "unknown"),
        ("x > 0.0;", "x\nnan\n-1\n", 1, "violated"),
    ],
)
def test_exit_codes(tmp_path: Path, capsys, spec, trace, code, word):
    assert _monitored(tmp_path, spec, trace, "--json") == code
    (row,) = json.loads(capsys.readouterr().out)["requirements"]
    assert row["verdict"] == word


@pytest.mark.parametrize(
    ("spec", "trace", "said"),
    [
        ("a;", "a\n2\n", "no truth value"),
        ("a;", "b\n1\n", "no column"),
        ("a;", "a\nyes\n", "no number"),
        ("a;", "a,b\n1\n", "incomplete"),
        ("a;", "a,a\n1,1\n", "no names"),
        ("a;", "", "empty"),
        ("a;", "a\n@0 1\n", "changes"),
        ("a | b;", "a,b\n1,1\n", "not in the part"),
    ],
)
def test_bad_input_is_refused_with_its_place(tmp_path: Path, capsys, spec, trace, said):
    assert _monitored(tmp_path, spec, trace) == 2
    assert said in capsys.readouterr().err


def test_verdicts_without_requirements_are_refused(tmp_path: Path, capsys):
    assert main(["monitor", str(tmp_path), "--verdicts"]) == 2
    assert "--requirements" in capsys.readouterr().err


SUITES = {
    "regression": (13, 3, 11),
    "ft_subset": (12, 0, 0),
    "long_trace": (8, 0, 0),
    "cav": (3, 0, 13),
    "all": (36, 3, 24),  # those above
}


@pytest.mark.parametrize("name", SUITES)
def test_suites_of_r2u2(shared: Path, name: str):
    file = shared / "vectors" / "monitor" / "r2u2-suite" / "suites" / f"{name}.json"
    report = run(suite("monitor"), file, 3)
    assert [r.text for r in report.shown] == []
    counts = (report.passed, report.edges.total(), report.skipped.total())
    assert (report.failed, counts) == (0, SUITES[name])


@pytest.mark.parametrize(
    "text", ['{"suites": ["../cav"]}', '{"suites": [3]}', '{"suites": "cav"}', "{}"]
)
def test_a_suite_of_suites_names_those_beside_it(tmp_path: Path, text: str):
    (tmp_path / "all.json").write_text(text)
    with pytest.raises(BadInput, match=r"suites have names|a suite has tests"):
        run(suite("monitor"), tmp_path / "all.json", 3)


def test_verdicts_of_r2u2(shared: Path):
    file = shared / "vectors" / "monitor" / "open-trace-101.r2u2-verdicts.json.gz"
    report = run(suite("monitor"), file, 3)
    assert (report.passed, report.failed, report.skipped.total()) == (7, 0, 0)
    assert report.checks > 20_000


def test_a_trace_that_is_named_with_its_verdicts_is_judged_once(tmp_path: Path, capsys):
    import gzip

    (tmp_path / "formulas.c2po").write_text(HEAD + "name: F[0,1] a;")
    trace, told = tmp_path / "t.csv.gz", tmp_path / "t.r2u2-verdicts.json.gz"
    for file, text in ((trace, "a\n0\n1\n1\n"), (told, '{"name": "TT?"}')):
        with gzip.open(file, "wt") as stream:
            stream.write(text)
    assert main(["conform", "monitor", str(trace), str(told)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "1 passed, 0 failed"
    assert main(["conform", "monitor", str(trace)]) == 3, "nothing was judged"
    told.unlink()
    assert main(["conform", "monitor", str(trace)]) == 2, "without verdicts it is no case at all"


def test_another_verdict_fails(tmp_path: Path):
    import gzip

    (tmp_path / "formulas.c2po").write_text(HEAD + "name: F[0,1] a;")
    with gzip.open(tmp_path / "t.csv.gz", "wt") as stream:
        stream.write("a\n0\n0\n1\n")
    with gzip.open(tmp_path / "t.r2u2-verdicts.json.gz", "wt") as stream:
        stream.write('{"name": "TT?"}')
    report = run(suite("monitor"), tmp_path / "t.r2u2-verdicts.json.gz", 3)
    assert (report.passed, report.failed) == (0, 1)
    assert "sample 0: expected T, got F" in report.shown[0].text
