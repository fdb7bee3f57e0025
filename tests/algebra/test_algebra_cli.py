"""`cratous algebra check|tree|runs`."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from cratous.services.cli.algebra import algebra


def run(*args: str):
    return CliRunner().invoke(algebra, list(args))


def test_check_prints_form_tasks_branches_and_constraints():
    result = run("check", ".( p1 +(p2 p3) )")
    assert result.exit_code == 0
    assert "canonical  .(p1 +(p2 p3))" in result.output
    assert "tasks      p1 p2 p3" in result.output
    assert "branches   2" in result.output
    assert "`.(p1 p3)`: p3 starts no earlier than p1 ends" in result.output


def test_check_as_json():
    data = json.loads(run("check", "p7_[5-9]", "--json").output)
    assert data["canonical"] == "p7_[5-9]"
    assert data["tasks"] == [7]
    assert data["branches"] == 1
    assert [row["kind"] for row in data["shown"][0]["rows"]] == [5, 6]


def test_check_shows_a_limit_of_branches_and_says_so():
    result = run("check", "+(p1 p2 p3)", "--limit", "1")
    assert "and 2 more branches" in result.output
    assert "branch 2" not in result.output


def test_check_notes_a_timing_that_bounds_nothing():
    result = run("check", "|(p1_[1-2])_[0-9]")
    assert "note: the timing _[0-9] of `|(p1_[1-2])_[0-9]` bounds no task" in result.output


def test_tree():
    assert run("tree", ".(p1 |(p2 p3)_[1-2] p4)-[3-4]").output.splitlines() == [
        ".  sequential  relative -[3-4]",
        "├─ p1",
        "├─ |  parallel  absolute _[1-2]",
        "│  ├─ p2",
        "│  └─ p3",
        "└─ p4",
    ]
    data = json.loads(run("tree", "~(p1 p2_[1-2])", "--json").output)
    assert data == {
        "span": [0, 14],
        "op": "~",
        "operands": [
            {"span": [2, 4], "task": 1},
            {"span": [5, 13], "task": 2,
             "timing": {"kind": "absolute", "t1_ms": 1, "t2_ms": 2}},
        ],
    }  # fmt: skip


def test_runs_and_their_limit():
    assert run("runs", "|(p1 p2)").output.splitlines() == ["p1 p2", "p2 p1"]
    shown = run("runs", "|(p1 p2 p3)", "--limit", "2").output.splitlines()
    assert shown[:2] == ["p1 p2 p3", "p1 p3 p2"]
    assert "more" in shown[2]
    data = json.loads(run("runs", "|(p1 p2)", "--limit", "2", "--json").output)
    assert data == {"runs": [[1, 2], [2, 1]], "all": True}


def test_reads_a_file(tmp_path):
    path = tmp_path / "relations.txt"
    path.write_text("|(p1\n  p2)\n", encoding="utf-8")
    assert "canonical  |(p1 p2)" in run("check", "-f", str(path)).output
    path.write_text("|(p1\n  P2)\n", encoding="utf-8")
    result = run("check", "-f", str(path))
    assert result.exit_code == 2
    assert f"{path}, line 2, column 3: " in result.stderr
    path.write_bytes(b"\xff\xfe\x00")
    result = run("check", "-f", str(path))
    assert result.exit_code == 2
    assert "not a text file" in result.stderr


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["|(p1 p9)", "--tasks", "1,2"], "unknown task p9; expected one of p1 p2; got p9"),
        (["|(p1 p9)", "--tasks", "1,x"], "--tasks: this is not a list of task ids"),
        (["|(p1 p9)", "--tasks", ""], "--tasks: this is not a list of task ids"),
        ([], "expected TEXT, or -f FILE; got neither"),
        (["p1", "-f", "somewhere"], "expected TEXT, or -f FILE; got both"),
        (["-f", "no such file"], "no such file: there is no such file"),
        ([""], "the text is empty"),
        (["|(p1 P2)"], "with a small p"),
    ],
)
@pytest.mark.parametrize("command", ["check", "tree", "runs"])
def test_bad_input_is_one_message_and_exit_code_2(command, args, message):
    result = run(command, *args)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert message in result.stderr
    assert "Traceback" not in result.stderr
    as_json = run(command, *args, "--json")
    assert as_json.exit_code == 2
    assert json.loads(as_json.stdout)["error"]


def test_errors_show_the_place():
    lines = run("check", "|(p1,p2)").stderr.splitlines()
    assert lines[1:] == ["|(p1,p2)", "    ^"]


@pytest.mark.parametrize("command", ["check", "tree", "runs"])
def test_help_explains_the_operators(command):
    result = run(command, "--help")
    assert result.exit_code == 0
    assert "p2 starts no earlier than p1 ends" in result.output
